/* bench.c - times of the post process, as ratios: to a plain pass over the pixels (the floor) and to a march of every pixel.
 * Minima over the repeats, all in one run: absolute times say little on a shared machine.
 *
 *     bench [SCENE|all] [WIDTHxHEIGHT] [REPEATS]      scenes: simple-on simple-off leafy-on leafy-off (the default) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage.h"

#define SHADOW 2048

/* The march with 500 steps takes most of a minute at full size: timed on a sixteenth of the pixels, times that. */
static record time_march(const char *name, int32_t width, int32_t height, pool *one)
{
    stage s;
    record r = {0};
    tyn_config config;
    tyn_context *context;
    double scale;
    stage_set_up(&s, name, (width + 3) / 4, (height + 3) / 4, SHADOW, one);
    config = stage_config(&s, 1);
    config.method = TYN_METHOD_MARCH;
    config.rays = TYN_RAYS_STEPS;
    config.steps = 500;
    context = stage_context(&config);
    stage_time(&s, context, one, &r);
    scale = (double)width * height / (double)s.pixels;
    r.ms *= scale;
    r.stats.gather_ns = (uint64_t)((double)r.stats.gather_ns * scale);
    free(context);
    stage_tear_down(&s);
    return r;
}

static void row(const char *name, const record *r, const gap *g, double floor_ms, double march_ms)
{
    printf("  %-26s %9.2f %9.2f %9.2f %8.1f %9.1f %7.2f", name, r->ms, (double)r->stats.slice_ns * 1e-6,
           (double)r->stats.gather_ns * 1e-6, r->ms / floor_ms, march_ms / r->ms, (double)r->stats.rays_percent);
    if (g)
        printf(" %7.3f %6.1f %5d", g->l1_percent, g->psnr, g->worst);
    printf("\n");
}

static const struct {
    const char *name;
    tyn_method method;
    tyn_rays rays;
    tyn_gather gather;
    int workers;
} ways[] = {{"sub-sampling", TYN_METHOD_SUBSAMPLE, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
            {"epipolar", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
            {"epipolar, tree", TYN_METHOD_EPIPOLAR, TYN_RAYS_TREE, TYN_GATHER_SHEAR, 1},
            {"epipolar, sweep", TYN_METHOD_EPIPOLAR, TYN_RAYS_SWEEP, TYN_GATHER_SHEAR, 1},
            {"epipolar, 2 threads", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 2}};
enum { WAYS = sizeof ways / sizeof *ways, EPIPOLAR = 1, EPIPOLAR_2 = WAYS - 1 };

static void stages(const tyn_stats *s)
{
    printf("  epipolar by stage, ms: samples %.2f, rows %.2f, rays %.2f, lines %.2f, unwarp %.2f, correction %.2f, composite "
           "%.2f\n",
           (double)s->sample_ns * 1e-6, (double)s->row_ns * 1e-6, (double)s->ray_ns * 1e-6, (double)s->line_ns * 1e-6,
           (double)s->unwarp_ns * 1e-6, (double)s->correct_ns * 1e-6, (double)s->composite_ns * 1e-6);
    printf("  %lld slices, %lld samples, %lld breaks, %lld rays, %lld walks, %lld rejected, %.1f MB\n", (long long)s->slices,
           (long long)s->samples, (long long)s->breaks, (long long)s->rays, (long long)s->walks, (long long)s->rejected,
           (double)s->memory / 1048576.0);
}

static void bench(const char *name, int32_t width, int32_t height, int repeats)
{
    stage s;
    pool *one = pool_create(1), *two = pool_create(2);
    record records[WAYS], steps, words;
    tyn_context *contexts[WAYS];
    double floor_ms = 1e9, floor2_ms = 1e9;
    if (!one || !two)
        bench_die("no threads");
    memset(records, 0, sizeof records);
    stage_set_up(&s, name, width, height, SHADOW, two);
    steps = time_march(name, width, height, one);
    words = stage_truth(&s, one);
    for (int w = 0; w < WAYS; w++) {
        tyn_config config = stage_config(&s, ways[w].workers);
        config.method = ways[w].method;
        config.rays = ways[w].rays;
        config.gather = ways[w].gather;
        contexts[w] = stage_context(&config);
    }
    for (int i = 0; i < repeats; i++) { /* in turn, so that a busy moment hits all alike */
        floor_ms = fmin(floor_ms, stage_floor(&s, one));
        floor2_ms = fmin(floor2_ms, stage_floor(&s, two));
        for (int w = 0; w < WAYS; w++)
            stage_time(&s, contexts[w], ways[w].workers == 2 ? two : one, &records[w]);
    }
    printf("%s, %dx%d, shadow map %d, %d repeats; floor %.2f ms (2 threads %.2f); rasterizer, 2 threads: map %.1f ms, "
           "surfaces %.1f ms\n",
           name, (int)width, (int)height, SHADOW, repeats, floor_ms, floor2_ms, s.shadow_ms, s.raster_ms);
    printf("  %-26s %9s %9s %9s %8s %9s %7s %7s %6s %5s\n", "", "ms", "slices", "pixels", "x floor", "march/x", "rays %",
           "L1 %", "dB", "/255");
    row("march, 500 steps (scaled)", &steps, NULL, floor_ms, steps.ms);
    row("march, exact", &words, NULL, floor_ms, steps.ms);
    for (int w = 0; w < WAYS; w++) {
        gap g = stage_compare(&s, contexts[w], ways[w].workers == 2 ? two : one);
        row(ways[w].name, &records[w], &g, ways[w].workers == 2 ? floor2_ms : floor_ms, steps.ms);
        free(contexts[w]);
    }
    printf("  2 threads are %.2f x as fast\n", records[EPIPOLAR].ms / records[EPIPOLAR_2].ms);
    stages(&records[EPIPOLAR].stats);
    fflush(stdout);
    stage_tear_down(&s);
    pool_free(one);
    pool_free(two);
}

int main(int argc, char **argv)
{
    static const char *const all[] = {"simple-on", "simple-off", "leafy-on", "leafy-off"};
    const char *name = argc > 1 ? argv[1] : "leafy-off";
    int width = 1920, height = 1080, repeats = argc > 3 ? atoi(argv[3]) : 15;
    if (argc > 2 && sscanf(argv[2], "%dx%d", &width, &height) != 2)
        bench_die("a size is WIDTHxHEIGHT");
    if (repeats < 1)
        bench_die("repeats are 1 or more");
    for (int i = 0; i < 4; i++)
        if (strcmp(name, "all") == 0)
            bench(all[i], width, height, repeats);
    if (strcmp(name, "all") != 0)
        bench(name, width, height, repeats);
    return 0;
}
