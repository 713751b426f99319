/* papers.c - the tables of the two epipolar papers on our scenes, with their settings, and tyndall's own best beside them. Each
 * row has its time by stage, its counts and its error against the exact march of the same shadow map: no speed without it.
 *
 *     bench-papers [SCENE] [REPEATS]      scenes: simple-on simple-off leafy-on (the default) leafy-off; 3 repeats */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage.h"

static double ms(uint64_t ns)
{
    return (double)ns * 1e-6;
}

static void heading(const char *text)
{
    printf("\n%s\n  %-34s %8s %8s %8s %8s %8s %8s %8s %9s %9s %6s %7s %7s %7s %6s %5s\n", text, "", "lines", "rows", "rays",
           "along", "unwarp", "correct", "upscale", "shafts", "rays", "%", "looked", "own", "L1 %", "dB", "/255");
}

/* Times by stage and in all (with the composite), counts, error. `own`: pixels with a ray of their own. */
static void print_row(const char *name, const record *r, const gap *g)
{
    const tyn_stats *s = &r->stats;
    printf("  %-34s %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %9.2f %9lld %6.2f %7.1f %7lld %7.3f %6.1f %5d\n", name,
           ms(s->sample_ns), ms(s->row_ns), ms(s->ray_ns), ms(s->line_ns), ms(s->unwarp_ns), ms(s->correct_ns),
           ms(s->upscale_ns), r->ms, (long long)s->rays, (double)s->rays_percent, (double)s->looked_per_ray,
           (long long)(s->rejected + s->corrected), g->l1_percent, g->psnr, g->worst);
    fflush(stdout);
}

static record run(stage *s, const tyn_config *config, pool *threads, int repeats, gap *g)
{
    tyn_context *context = stage_context(config);
    record r = {0};
    for (int i = 0; i < repeats; i++)
        stage_time(s, context, threads, &r);
    *g = stage_compare(s, context, threads);
    free(context);
    return r;
}

static gap table_row(stage *s, const char *name, const tyn_config *config, pool *threads, int repeats, record *out)
{
    gap g;
    record r = run(s, config, threads, repeats, &g);
    print_row(name, &r, &g);
    if (out)
        *out = r;
    return g;
}

/* The fewest slices, and with them samples and rays, at which tyndall's default is as near to the truth as `goal`. */
static void equal_quality(stage *s, const gap *goal, pool *threads, int repeats)
{
    static const struct {
        int32_t slices, divisor;
        float tolerance;
    } ladder[] = {{96, 1, 0.1f},   {128, 1, 0.05f},  {192, 1, 0.05f},  {256, 1, 0.03f},  {384, 1, 0.02f},
                  {512, 1, 0.02f}, {768, 1, 0.015f}, {1024, 1, 0.01f}, {2048, 1, 0.005f}};
    const int count = sizeof ladder / sizeof *ladder;
    for (int i = 0; i < count; i++) {
        tyn_config config = stage_config(s, 1);
        char name[64];
        record r;
        gap g;
        config.slices = ladder[i].slices;
        config.samples = (s->width > s->height ? s->width : s->height) / ladder[i].divisor;
        config.tolerance = ladder[i].tolerance;
        r = run(s, &config, threads, repeats, &g);
        if (g.psnr < goal->psnr && i + 1 < count)
            continue;
        snprintf(name, sizeof name, "tyndall, %s quality: %d slices", g.psnr < goal->psnr ? "best" : "equal",
                 (int)config.slices);
        print_row(name, &r, &g);
        return;
    }
}

/* ED10's line of section 6: 1024 lines, 32 initial samples, 500 steps, 1920x1080. No refinement on light, which it has not. */
static tyn_config ed10(const stage *s, int32_t lines, int32_t steps)
{
    tyn_config config = stage_config(s, 1);
    config.gather = TYN_GATHER_ED10;
    config.rays = TYN_RAYS_STEPS;
    config.slices = lines;
    config.samples = 1024;
    config.initial_step = 32;
    config.tolerance = 1.0f;
    config.steps = steps;
    return config;
}

static void table_ed10(const char *picture, pool *one, int repeats)
{
    stage s;
    tyn_config config;
    record r;
    gap published;
    stage_set_up(&s, picture, 1920, 1080, 1024, one);
    stage_truth(&s, one);
    heading("ED10, section 6: 1920x1080, 1024 lines, 32 initial samples, 500 steps, map 1024 (HD 4850: lines 1.2, search 6.0, "
            "march "
            "16.7, interpolation 4.4 ms; 5.8 % rays)");
    config = ed10(&s, 1024, 500);
    published = table_row(&s, "as published", &config, one, repeats, &r);
    config.kernel = TYN_KERNEL_SHEPARD;
    table_row(&s, "  Shepard's weights", &config, one, 1, NULL);
    config.kernel = TYN_KERNEL_THRESHOLD;
    table_row(&s, "  threshold weights", &config, one, 1, NULL);
    config.kernel = TYN_KERNEL_GAUSSIAN;
    config.taps = 5;
    table_row(&s, "  5 taps", &config, one, 1, NULL);
    config.taps = 3;
    config.method = TYN_METHOD_SUBSAMPLE;
    config.budget = (int32_t)(r.stats.rays + r.stats.rejected);
    table_row(&s, "naive sub-sampling, as many rays", &config, one, repeats, NULL);
    config = ed10(&s, 1024, 500);
    config.rays = TYN_RAYS_WORDS;
    table_row(&s, "ED10's lines, rows in words", &config, one, repeats, NULL);
    equal_quality(&s, &published, one, repeats);
    config = stage_config(&s, 1);
    table_row(&s, "tyndall, quality", &config, one, repeats, NULL);
    heading("ED10, figure 10: 150 steps; lines (HD 4850: 256 lines 200 k samples 54 fps, 512 273 k 48 fps, 1024 443 k 36 fps)");
    for (int32_t lines = 256; lines <= 1024; lines *= 2) {
        char name[64];
        config = ed10(&s, lines, 150);
        snprintf(name, sizeof name, "%d lines", (int)lines);
        table_row(&s, name, &config, one, 1, NULL);
    }
    stage_tear_down(&s);
}

/* IVB's settings: 512 slices, 256 samples, a ray each 16. */
static tyn_config ivb(const stage *s, tyn_rays rays, int32_t downscale)
{
    tyn_config config = stage_config(s, 1);
    config.gather = TYN_GATHER_IVB;
    config.rays = rays;
    config.slices = 512;
    config.samples = 256;
    config.initial_step = 16;
    config.tolerance = 1.0f;
    config.downscale = downscale;
    return config;
}

static void table_ivb(const char *picture, pool *one, int repeats)
{
    static const struct {
        const char *name;
        tyn_rays rays;
        int32_t downscale;
    } rows[] = {{"no tree, downscale 4", TYN_RAYS_COLUMNS, 4}, {"tree, downscale 4", TYN_RAYS_TREE, 4},
                {"words, downscale 4", TYN_RAYS_WORDS, 4},     {"sweep, downscale 4", TYN_RAYS_SWEEP, 4},
                {"tree, downscale 2", TYN_RAYS_TREE, 2},       {"tree, downscale 1", TYN_RAYS_TREE, 1}};
    for (int32_t map = 1024; map <= 4096; map *= 2) {
        stage s;
        char text[256];
        gap published = {0, 0, 0}, g;
        tyn_config config;
        stage_set_up(&s, picture, 1024, 768, map, one);
        stage_truth(&s, one);
        snprintf(text, sizeof text, "IVB: 1024x768, 512 slices, 256 samples, step 16, map %d%s", (int)map,
                 map == 1024
                     ? " (HD Graphics: depth 0.39, refinement 0.56, tree 0.74, march 2.64 (5.65 without tree), interpolation "
                       "0.14, unwarp 0.31 + fix 1.02, up-scaling 2.50 + fix 1.03: 9.9 ms)"
                     : "");
        heading(text);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            config = ivb(&s, rows[i].rays, rows[i].downscale);
            g = table_row(&s, rows[i].name, &config, one, repeats, NULL);
            if (rows[i].rays == TYN_RAYS_TREE && rows[i].downscale == 4)
                published = g;
        }
        equal_quality(&s, &published, one, repeats);
        config = stage_config(&s, 1);
        table_row(&s, "tyndall, quality", &config, one, repeats, NULL);
        stage_tear_down(&s);
    }
}

/* What a ray more buys, by each of the two ways of placing them. */
static void table_refinement(const char *picture, pool *one, int repeats)
{
    static const float tolerances[] = {0.1f, 0.05f, 0.02f, 0.01f, 0.005f, 0.002f, 0.001f};
    stage s;
    tyn_config config;
    char name[64];
    stage_set_up(&s, picture, 1024, 768, 1024, one);
    stage_truth(&s, one);
    heading("Refinement on light: tolerance (initial step 16)");
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        config = stage_config(&s, 1);
        config.initial_step = 16;
        config.tolerance = tolerances[i];
        snprintf(name, sizeof name, "tolerance %g", (double)tolerances[i]);
        table_row(&s, name, &config, one, repeats, NULL);
    }
    heading("Rays at depth breaks alone: initial step (no refinement on light)");
    for (int32_t step = 64; step >= 1; step /= 2) {
        config = stage_config(&s, 1);
        config.initial_step = step;
        config.tolerance = 1.0f;
        snprintf(name, sizeof name, "step %d", (int)step);
        table_row(&s, name, &config, one, repeats, NULL);
    }
    stage_tear_down(&s);
}

int main(int argc, char **argv)
{
    const char *picture = argc > 1 ? argv[1] : "leafy-on";
    int repeats = argc > 2 ? atoi(argv[2]) : 3;
    pool *one = pool_create(1);
    if (!one)
        bench_die("no threads");
    if (repeats < 1)
        bench_die("repeats are 1 or more");
    printf("%s, one thread; ms by stage, minima over %d repeats. rays along slices, in percent of the pixels with those of "
           "rejected "
           "pixels; looked: nodes,\nwords or columns a ray looked at; own: pixels with a ray of their own; error against the "
           "exact "
           "march of the same map.\n",
           picture, repeats);
    table_ed10(picture, one, repeats);
    table_ivb(picture, one, repeats);
    table_refinement(picture, one, repeats);
    pool_free(one);
    return 0;
}
