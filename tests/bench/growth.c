/* growth.c - how the time of a frame grows: with slices, samples, pixels, the shadow map and the scene; and what more cores
 * would make of it, by a model of its jobs.
 *
 *     bench-growth [REPEATS]      7 repeats */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage.h"

static int repeats = 7;
static pool *one, *two;

static void heading(const char *text)
{
    printf("\n%s\n  %-22s %8s %8s %8s %8s %8s %8s %8s %9s %9s %7s %6s %5s\n", text, "", "samples", "rows", "rays", "lines",
           "unwarp", "correct", "compose", "ms", "rays", "L1 %", "dB", "/255");
}

static record time_row(stage *s, const char *name, const tyn_config *config)
{
    tyn_context *context = stage_context(config);
    record r = {0};
    const tyn_stats *t = &r.stats;
    gap g;
    for (int i = 0; i < repeats; i++)
        stage_time(s, context, one, &r);
    g = stage_compare(s, context, one);
    free(context);
    printf("  %-22s %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %9.2f %9lld %7.3f %6.1f %5d\n", name, (double)t->sample_ns * 1e-6,
           (double)t->row_ns * 1e-6, (double)t->ray_ns * 1e-6, (double)t->line_ns * 1e-6, (double)t->unwarp_ns * 1e-6,
           (double)t->correct_ns * 1e-6, (double)t->composite_ns * 1e-6, r.ms, (long long)t->rays, g.l1_percent, g.psnr,
           g.worst);
    fflush(stdout);
    return r;
}

static void open_stage(stage *s, const char *picture, int32_t width, int32_t height, int32_t map)
{
    stage_set_up(s, picture, width, height, map, two);
    stage_truth(s, two);
}

static void by_scene(void)
{
    static const char *const scenes[] = {"simple-on", "simple-off", "leafy-on", "leafy-off"};
    double low = 1e9, high = 0;
    heading("by scene: 1920x1080, map 2048, quality");
    for (int i = 0; i < 4; i++) {
        stage s;
        tyn_config config;
        record r;
        open_stage(&s, scenes[i], 1920, 1080, 2048);
        config = stage_config(&s, 1);
        r = time_row(&s, scenes[i], &config);
        low = fmin(low, r.ms);
        high = fmax(high, r.ms);
        stage_tear_down(&s);
    }
    printf("  the slowest takes %.2f x as long as the fastest (goal 1.6)\n", high / low);
}

static void by_config(void)
{
    stage s;
    char name[64];
    open_stage(&s, "leafy-off", 1920, 1080, 2048);
    heading("by slices: leafy-off, 1920x1080, map 2048");
    for (int32_t n = 128; n <= 4096; n *= 2) {
        tyn_config config = stage_config(&s, 1);
        config.slices = n;
        snprintf(name, sizeof name, "%d slices", (int)n);
        time_row(&s, name, &config);
    }
    heading("by samples of a line");
    for (int32_t n = 240; n <= 1920; n *= 2) {
        tyn_config config = stage_config(&s, 1);
        config.samples = n;
        snprintf(name, sizeof name, "%d samples", (int)n);
        time_row(&s, name, &config);
    }
    stage_tear_down(&s);
}

static void by_size(void)
{
    static const int32_t sizes[][2] = {{480, 270}, {960, 540}, {1920, 1080}, {3840, 2160}};
    char name[64];
    stage s;
    tyn_config config;
    heading("by pixels: leafy-off, map 2048, 1024 slices of 480 samples at most");
    for (int i = 0; i < 4; i++) {
        record r;
        open_stage(&s, "leafy-off", sizes[i][0], sizes[i][1], 2048);
        config = stage_config(&s, 1);
        config.slices = 1024;
        config.samples = 480;
        snprintf(name, sizeof name, "%dx%d", (int)s.width, (int)s.height);
        r = time_row(&s, name, &config);
        printf("  %22.1f ns a pixel beside the slices\n", (double)r.stats.gather_ns / (double)s.pixels);
        stage_tear_down(&s);
    }
    heading("by shadow map: leafy-off, 1920x1080");
    for (int32_t map = 512; map <= 4096; map *= 2) {
        open_stage(&s, "leafy-off", 1920, 1080, map);
        config = stage_config(&s, 1);
        snprintf(name, sizeof name, "map %d", (int)map);
        time_row(&s, name, &config);
        stage_tear_down(&s);
    }
}

/* ---- cores -------------------------------------------------------------------------------------------------------------- */

#define RUNS 8
#define JOBS 8192

/* An executor that runs jobs one after the other, and keeps how long each took, the least of all frames. */
typedef struct recorder {
    int runs;
    int32_t count[RUNS];
    uint64_t ns[RUNS][JOBS];
} recorder;

static void record_jobs(void *context, tyn_job job, void *argument, int32_t count)
{
    recorder *r = context;
    for (int32_t i = 0; i < count; i++) {
        uint64_t start = bench_now(NULL), took;
        job(argument, i, 0);
        took = bench_now(NULL) - start;
        if (r->runs < RUNS && i < JOBS && (r->count[r->runs] != count || took < r->ns[r->runs][i]))
            r->ns[r->runs][i] = took;
    }
    if (r->runs < RUNS) {
        r->count[r->runs] = count < JOBS ? count : JOBS;
        r->runs++;
    }
}

/* Jobs in order, each to the core that is free first: as the pool hands them out. Returns when the last one ends. */
static double schedule(const uint64_t *ns, int32_t count, int32_t cores, double dispatch_ns)
{
    double free_at[TYN_MAX_WORKERS] = {0}, end = 0;
    for (int32_t i = 0; i < count; i++) {
        int32_t best = 0;
        for (int32_t k = 1; k < cores; k++)
            best = free_at[k] < free_at[best] ? k : best;
        free_at[best] += (double)ns[i] + dispatch_ns;
        end = fmax(end, free_at[best]);
    }
    return end;
}

static void nothing(void *argument, int32_t index, int32_t worker)
{
    (void)argument;
    (void)index;
    (void)worker;
}

/* What handing out a job costs, and what a run costs before and after, by two threads. */
static void overheads(double *job_ns, double *run_ns)
{
    const tyn_executor *e = pool_executor(two);
    double many = 1e18, few = 1e18;
    for (int i = 0; i < 200; i++) {
        uint64_t start = bench_now(NULL);
        e->run(e->context, nothing, NULL, 4096);
        many = fmin(many, (double)(bench_now(NULL) - start));
        start = bench_now(NULL);
        e->run(e->context, nothing, NULL, 2);
        few = fmin(few, (double)(bench_now(NULL) - start));
    }
    *run_ns = few;
    *job_ns = fmax(many - few, 0) / 4094;
}

static void by_cores(const char *picture)
{
    static recorder r;
    tyn_executor e = {record_jobs, &r, 1};
    stage s;
    tyn_config config;
    tyn_context *context;
    record alone = {0}, both = {0};
    double job_ns, run_ns, inside = 0, serial, first = 0;
    memset(&r, 0, sizeof r);
    stage_set_up(&s, picture, 1920, 1080, 2048, two);
    config = stage_config(&s, 2);
    context = stage_context(&config);
    for (int i = 0; i < repeats; i++) {
        r.runs = 0;
        stage_time_by(&s, context, &e, &alone);
        stage_time(&s, context, two, &both);
    }
    overheads(&job_ns, &run_ns);
    for (int k = 0; k < r.runs; k++)
        inside += schedule(r.ns[k], r.count[k], 1, 0);
    serial = fmax(alone.ms * 1e6 - inside, 0);
    printf(
        "\ncores: %s, 1920x1080. A model: the frame's jobs as measured, handed out in order to whoever is free; %.2f us a job, "
        "%.0f us a run for\nthe pool, %.0f us outside of jobs. Measured: 1 thread %.2f ms, 2 threads %.2f ms.\n  %5s %9s %8s",
        picture, job_ns * 1e-3, run_ns * 1e-3, serial * 1e-3, alone.ms, both.ms, "cores", "ms", "x");
    for (int k = 0; k < r.runs; k++)
        if (r.count[k])
            printf("   stage %d: %5d jobs, busy", k, (int)r.count[k]);
    printf("\n");
    for (int32_t cores = 1; cores <= 64; cores *= 2) {
        double end[RUNS], sum = serial;
        for (int k = 0; k < r.runs; k++) {
            end[k] = schedule(r.ns[k], r.count[k], cores, cores > 1 ? job_ns : 0) + (cores > 1 && r.count[k] ? run_ns : 0);
            sum += end[k];
        }
        first = cores == 1 ? sum : first;
        printf("  %5d %9.2f %8.1f", (int)cores, sum * 1e-6, first / sum);
        for (int k = 0; k < r.runs; k++)
            if (r.count[k])
                printf("   %19.0f %%     ", 100 * schedule(r.ns[k], r.count[k], 1, 0) / (end[k] * cores));
        printf("\n");
    }
    fflush(stdout);
    free(context);
    stage_tear_down(&s);
}

int main(int argc, char **argv)
{
    if (argc > 1)
        repeats = atoi(argv[1]);
    if (repeats < 1)
        bench_die("repeats are 1 or more");
    one = pool_create(1);
    two = pool_create(2);
    if (!one || !two)
        bench_die("no threads");
    printf("one thread; ms by stage, minima over %d repeats; error against the exact march of the same map\n", repeats);
    by_scene();
    by_config();
    by_size();
    by_cores("simple-on");
    by_cores("leafy-off");
    pool_free(one);
    pool_free(two);
    return 0;
}
