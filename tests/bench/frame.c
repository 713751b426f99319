/* frame.c - a built-in scene's frame over and over, on one thread: for profilers, and for counting instructions
 * (tests/instructions.sh).
 *
 *     bench-frame SCENE WIDTHxHEIGHT PRESET MAP [FRAMES [ISA [METHOD]]]
 *
 * All as tyndall bench has them, and ISA may be "any": the best. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "shafts.h"
#include "stage.h"

/* The arguments behind the scene as options of tyndall bench. */
static void parse(options *o, int argc, char **argv)
{
    static char names[][16] = {"--size", "--preset", "--shadow-size", "--repeats", "--isa", "--method"};
    enum { NAMES = sizeof names / sizeof *names };
    char *list[2 * NAMES];
    int count = 0;
    for (int i = 2; i < argc && i < NAMES + 2; i++) {
        if (strcmp(argv[i], "any") == 0)
            continue;
        list[count++] = names[i - 2];
        list[count++] = argv[i];
    }
    if (argc < 5 || argc > NAMES + 2 || options_parse_bench(o, count, list) != 0)
        bench_die("usage: bench-frame SCENE WIDTHxHEIGHT PRESET MAP [FRAMES [ISA [METHOD]]]");
}

int main(int argc, char **argv)
{
    pool *one = pool_create(1);
    tyn_config config;
    tyn_context *context;
    record r = {0};
    options o;
    stage s;
    parse(&o, argc, argv);
    if (!one)
        bench_die("no threads");
    stage_set_up(&s, argv[1], o.settings.width, o.settings.height, o.settings.shadow_size, one);
    bench_need(shafts_config(&config, &o.settings, s.width, s.height), "shafts_config");
    config.workers = 1;
    context = stage_context(&config);
    for (int i = 0; i < (o.repeats ? o.repeats : 1); i++)
        stage_time(&s, context, one, &r);
    printf(
        "%s %dx%d %s: %.3f ms; samples %.3f, rows %.3f, rays %.3f, lines %.3f, unwarp %.3f, correction %.3f, composite %.3f; "
        "%lld rays, %lld walks, %lld rejected\n",
        argv[1], s.width, s.height, argv[3], r.ms, (double)r.stats.sample_ns * 1e-6, (double)r.stats.row_ns * 1e-6,
        (double)r.stats.ray_ns * 1e-6, (double)r.stats.line_ns * 1e-6, (double)r.stats.unwarp_ns * 1e-6,
        (double)r.stats.correct_ns * 1e-6, (double)r.stats.composite_ns * 1e-6, (long long)r.stats.rays,
        (long long)r.stats.walks, (long long)r.stats.rejected);
    free(context);
    stage_tear_down(&s);
    pool_free(one);
    return 0;
}
