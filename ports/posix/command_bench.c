/* command_bench.c - tyndall bench: times of a frame's stages, with its error. */
#include "commands.h"
#include "options.h"
#include "shafts.h"
#include "stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHADOW 2048

typedef struct bench {
    const options *o;
    const char *scene;
    int32_t width, height;
    int repeats;
    pool *one, *two, *asked;
    stage stage;
} bench;

static double least(double a, double b)
{
    return a > 0 && a < b ? a : b;
}

/* What the command line asks for, at the stage's size. */
static tyn_config config_of(const bench *b, int32_t workers)
{
    tyn_config config;
    bench_need(shafts_config(&config, &b->o->settings, b->stage.width, b->stage.height), "config");
    config.shadow_size = b->stage.shadow_size;
    config.workers = workers;
    return config;
}

static record run(bench *b, const tyn_config *config, pool *threads, int repeats, gap *g)
{
    tyn_context *context = stage_context(config);
    record r = {0};
    for (int i = 0; i < repeats; i++)
        stage_time(&b->stage, context, threads, &r);
    if (g)
        *g = stage_compare(&b->stage, context, threads);
    free(context);
    return r;
}

/* 500 steps a pixel: on a sixteenth of the pixels, times that. */
static double march_ms(const bench *whole)
{
    bench b = *whole;
    tyn_config config;
    record r;
    stage_set_up(&b.stage, b.scene, (b.width + 3) / 4, (b.height + 3) / 4, whole->stage.shadow_size, b.one);
    config = config_of(&b, 1);
    config.method = TYN_METHOD_MARCH;
    config.rays = TYN_RAYS_STEPS;
    config.steps = 500;
    config.downscale = 1;
    r = run(&b, &config, b.one, 2, NULL);
    r.ms *= (double)whole->stage.pixels / (double)b.stage.pixels;
    stage_tear_down(&b.stage);
    return r.ms;
}

static void print_stages(const tyn_stats *s)
{
    const struct {
        const char *room;
        uint64_t ns;
    } stages[] = {
        {"sample", s->sample_ns}, {"row", s->row_ns},         {"ray", s->ray_ns},         {"line", s->line_ns},
        {"unwarp", s->unwarp_ns}, {"correct", s->correct_ns}, {"upscale", s->upscale_ns}, {"composite", s->composite_ns}};
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        printf("stage_%s_ms %.3f\n", stages[i].room, (double)stages[i].ns * 1e-6);
}

static void brief(bench *b)
{
    tyn_config config = config_of(b, b->o->threads ? b->o->threads : 1);
    double floor_ms = 0;
    record r, two, prefiltered;
    gap g, p;
    for (int i = 0; i < 3 * b->repeats; i++)
        floor_ms = least(floor_ms, stage_floor(&b->stage, b->one));
    stage_truth(&b->stage, b->two);
    r = run(b, &config, b->asked, b->repeats, &g);
    config.workers = 2;
    two = run(b, &config, b->two, b->repeats, NULL);
    config.workers = 1;
    config.method = TYN_METHOD_PREFILTERED;
    config.downscale = 1;
    prefiltered = run(b, &config, b->one, 2, &p);
    printf("floor_ms %.3f\n", floor_ms);
    printf("march_500_ms %.3f\n", march_ms(b));
    printf("shafts_ms %.3f\nshafts_2_threads_ms %.3f\n", r.ms, two.ms);
    print_stages(&r.stats);
    printf("rays_percent %.4g\npsnr_db %.2f\nmax_8bit %d\n", (double)r.stats.rays_percent, g.psnr, g.worst);
    printf("mean_l1 %.6f\nmemory_bytes %llu\n", 0.01 * g.l1_percent, (unsigned long long)r.stats.memory);
    printf("raster_ms %.3f\nshadow_ms %.3f\n", b->stage.raster_ms, b->stage.shadow_ms);
    printf("prefiltered_ms %.3f\nprefiltered_mean_l1 %.6f\n", prefiltered.ms, 0.01 * p.l1_percent);
    fflush(stdout);
}

static void print_machine(void)
{
    char line[256], *name;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0 && (name = strchr(line, ':')) != NULL) {
            printf("cpu%s", name + 1);
            break;
        }
    if (file)
        fclose(file);
#ifdef __VERSION__
    printf("compiler %s\n", __VERSION__);
#endif
}

static void print_row(const char *name, const record *r, const gap *g, double base_ms)
{
    printf("  %-22s %9.2f ms %7.2f x %9.3f %% L1 %6.1f dB %4d / 255 %9.1f KiB\n", name, r->ms, base_ms / r->ms, g->l1_percent,
           g->psnr, g->worst, (double)r->stats.memory / 1024);
    fflush(stdout);
}

/* ISAs, threads, presets; growth with slices and pixels is in the preset's and the size's hands. */
static void tables(bench *b)
{
    static const char *const presets[] = {"handheld", "balanced", "quality", "reference"};
    tyn_config config = config_of(b, 1);
    double scalar_ms = 0;
    record r;
    gap g;
    printf("one thread, by instruction set; times scalar's\n");
    for (int32_t isa = 1; isa <= tyn_isa_available(); isa *= 2)
        if (tyn_isa_available() & isa) {
            config.isa = isa;
            r = run(b, &config, b->one, b->repeats, &g);
            scalar_ms = isa == TYN_ISA_SCALAR ? r.ms : scalar_ms;
            print_row(tyn_isa_name(isa), &r, &g, scalar_ms);
        }
    printf("one thread, by preset; times the scalar quality\n");
    for (int i = 0; i < 4; i++) {
        bench_need(tyn_config_preset(&config, (tyn_preset)i, b->width, b->height), "preset");
        config.shadow_size = b->stage.shadow_size;
        r = run(b, &config, b->one, b->repeats < 5 ? b->repeats : 5, &g);
        print_row(presets[i], &r, &g, scalar_ms);
    }
}

int command_bench(int argc, char **argv)
{
    options o;
    bench b;
    memset(&b, 0, sizeof b);
    if (options_parse_bench(&o, argc, argv) != 0)
        return 2;
    if (o.help) {
        options_help_bench();
        return 0;
    }
    b.o = &o;
    b.scene = o.bench_scene ? o.bench_scene : "leafy-off";
    b.width = o.settings.width ? o.settings.width : 1920;
    b.height = o.settings.height ? o.settings.height : 1080;
    b.repeats = o.repeats ? o.repeats : 15;
    b.one = pool_create(1);
    b.two = pool_create(2);
    b.asked = pool_create(o.threads ? o.threads : 1);
    if (!b.one || !b.two || !b.asked)
        bench_die("no threads");
    stage_set_up(&b.stage, b.scene, b.width, b.height, o.settings.shadow_size ? o.settings.shadow_size : SHADOW, b.two);
    if (!o.brief) {
        print_machine();
        printf("scene %s %dx%d, %d repeats\n", b.scene, (int)b.width, (int)b.height, b.repeats);
    }
    brief(&b);
    if (!o.brief)
        tables(&b);
    stage_tear_down(&b.stage);
    pool_free(b.one);
    pool_free(b.two);
    pool_free(b.asked);
    return 0;
}
