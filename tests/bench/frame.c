/* frame.c - a built-in scene's frame over and over, on one thread: for profilers, and for counting instructions
 * (tests/instructions.sh).
 *
 *     bench-frame SCENE WIDTHxHEIGHT PRESET MAP [FRAMES [ISA [METHOD]]]
 *
 * ISA: scalar, ...; without it or with "any" the best. METHOD: epipolar, march, prefiltered or hybrid. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage.h"

static tyn_preset preset_of(const char *name)
{
    static const char *const names[] = {"handheld", "balanced", "quality", "reference"};
    for (int i = 0; i < 4; i++)
        if (strcmp(name, names[i]) == 0)
            return (tyn_preset)i;
    bench_die("a preset is handheld, balanced, quality or reference");
    return TYN_PRESET_QUALITY;
}

static int32_t isa_of(const char *name)
{
    for (int32_t isa = 1; isa <= tyn_isa_available(); isa *= 2)
        if ((tyn_isa_available() & isa) && strcmp(name, tyn_isa_name(isa)) == 0)
            return isa;
    bench_die("not an instruction set of this machine");
    return 0;
}

static tyn_method method_of(const char *name)
{
    static const struct {
        const char *name;
        tyn_method method;
    } all[] = {{"epipolar", TYN_METHOD_EPIPOLAR},
               {"march", TYN_METHOD_MARCH},
               {"prefiltered", TYN_METHOD_PREFILTERED},
               {"hybrid", TYN_METHOD_HYBRID}};
    for (int i = 0; i < 4; i++)
        if (strcmp(name, all[i].name) == 0)
            return all[i].method;
    bench_die("a method is epipolar, march, prefiltered or hybrid");
    return TYN_METHOD_EPIPOLAR;
}

int main(int argc, char **argv)
{
    int width, height, map = argc > 4 ? atoi(argv[4]) : 0, frames = argc > 5 ? atoi(argv[5]) : 1;
    pool *one = pool_create(1);
    tyn_config config;
    tyn_context *context;
    record r = {0};
    stage s;
    if (argc < 5 || sscanf(argv[2], "%dx%d", &width, &height) != 2 || map < 1 || frames < 1 || !one)
        bench_die("usage: bench-frame SCENE WIDTHxHEIGHT PRESET MAP [FRAMES [ISA [METHOD]]]");
    stage_set_up(&s, argv[1], width, height, map, one);
    bench_need(tyn_config_preset(&config, preset_of(argv[3]), width, height), "tyn_config_preset");
    config.shadow_size = map;
    config.workers = 1;
    config.isa = argc > 6 && strcmp(argv[6], "any") != 0 ? isa_of(argv[6]) : 0;
    config.method = argc > 7 ? method_of(argv[7]) : TYN_METHOD_EPIPOLAR;
    context = stage_context(&config);
    for (int i = 0; i < frames; i++)
        stage_time(&s, context, one, &r);
    printf(
        "%s %dx%d %s: %.3f ms; samples %.3f, rows %.3f, rays %.3f, lines %.3f, unwarp %.3f, correction %.3f, composite %.3f; "
        "%lld rays, %lld walks, %lld rejected\n",
        argv[1], width, height, argv[3], r.ms, (double)r.stats.sample_ns * 1e-6, (double)r.stats.row_ns * 1e-6,
        (double)r.stats.ray_ns * 1e-6, (double)r.stats.line_ns * 1e-6, (double)r.stats.unwarp_ns * 1e-6,
        (double)r.stats.correct_ns * 1e-6, (double)r.stats.composite_ns * 1e-6, (long long)r.stats.rays,
        (long long)r.stats.walks, (long long)r.stats.rejected);
    free(context);
    stage_tear_down(&s);
    pool_free(one);
    return 0;
}
