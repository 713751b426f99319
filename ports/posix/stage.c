/* stage.c */
#define _DEFAULT_SOURCE /* madvise */
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#include "shafts.h"
#include "showcase.h"

void bench_die(const char *what)
{
    fprintf(stderr, "bench: %s\n", what);
    exit(1);
}

void bench_need(tyn_status status, const char *what)
{
    if (status == TYN_OK)
        return;
    fprintf(stderr, "bench: %s: %s\n", what, tyn_status_name(status));
    exit(1);
}

static void *block_of(size_t bytes)
{
    const size_t page = 2u << 20;
    void *block = NULL;
    if (posix_memalign(&block, bytes < page ? TYN_ALIGNMENT : page, bytes) || !block)
        bench_die("no memory");
#ifdef MADV_HUGEPAGE
    madvise(block, bytes, MADV_HUGEPAGE); /* lines and maps are read across: a page for each row is more than TLBs hold */
#endif
    memset(block, 0, bytes); /* touched: page faults are no part of the times */
    return block;
}

uint64_t bench_now(void *context)
{
    struct timespec t;
    (void)context;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

double bench_ms_since(uint64_t start)
{
    return (double)(bench_now(NULL) - start) * 1e-6;
}

void stage_shadow(stage *s, pool *threads)
{
    float low[3], high[3];
    uint64_t start = bench_now(NULL);
    scene_bounds(&s->scene, low, high);
    bench_need(tyn_shadow_fit(&s->light, &s->camera, low, high), "tyn_shadow_fit");
    bench_need(tyn_raster_shadow(s->raster, &s->light.shadow, s->map, s->scene.meshes, s->scene.mesh_count,
                                 pool_executor(threads), NULL, NULL, NULL),
               "tyn_raster_shadow");
    s->shadow_ms = bench_ms_since(start);
    s->light.shadow.depth = s->map;
}

void stage_surface(stage *s, pool *threads)
{
    tyn_display display = {1, TYN_TONE_CLAMP, 0};
    tyn_surface surface;
    tyn_image bytes8;
    uint64_t start = bench_now(NULL);
    memset(&surface, 0, sizeof surface);
    surface.camera = s->camera;
    surface.meshes = s->scene.meshes;
    surface.mesh_count = s->scene.mesh_count;
    surface.lights = &s->light;
    surface.light_count = 1;
    memcpy(surface.ambient, s->scene.ambient, sizeof surface.ambient);
    memcpy(surface.background, s->scene.background, sizeof surface.background);
    surface.colour.pixels = s->colour;
    surface.depth.pixels = s->depth;
    surface.colour.width = surface.depth.width = s->width;
    surface.colour.height = surface.depth.height = s->height;
    surface.colour.format = TYN_RGB_F32;
    surface.depth.format = TYN_DEPTH_F32;
    surface.executor = pool_executor(threads);
    bench_need(tyn_raster_surface(s->raster, &surface), "tyn_raster_surface");
    s->raster_ms = bench_ms_since(start);
    bytes8 = surface.colour;
    bytes8.pixels = s->colour8;
    bytes8.format = TYN_RGBA8_SRGB;
    bench_need(tyn_encode(&surface.colour, &display, &bytes8), "tyn_encode");
}

void stage_set_up(stage *s, const char *name, int32_t width, int32_t height, int32_t shadow_size, pool *threads)
{
    tyn_raster_config config = {0};
    size_t bytes;
    memset(s, 0, sizeof *s);
    s->width = width;
    s->height = height;
    s->shadow_size = shadow_size;
    scene_init(&s->scene);
    if (showcase_scene(name, &s->scene))
        bench_die("no such scene");
    s->pixels = (size_t)s->width * (size_t)s->height;
    s->map = block_of((size_t)shafts_map_stride(shadow_size) * (size_t)shadow_size);
    s->depth = block_of(s->pixels * sizeof *s->depth);
    s->colour = block_of(s->pixels * 3 * sizeof *s->colour);
    s->colour8 = block_of(s->pixels * 4);
    s->target = block_of(s->pixels * 4);
    s->truth = block_of(s->pixels * 4);
    s->scatter = block_of(s->pixels * 3 * sizeof *s->scatter);
    s->truth_scatter = block_of(s->pixels * 3 * sizeof *s->truth_scatter);
    config.width = s->width > shadow_size ? s->width : shadow_size;
    config.height = s->height > shadow_size ? s->height : shadow_size;
    config.workers = pool_executor(threads)->workers;
    bench_need(tyn_raster_measure(&config, &bytes), "tyn_raster_measure");
    s->raster_memory = block_of(bytes);
    bench_need(tyn_raster_init(&s->raster, &config, s->raster_memory, bytes), "tyn_raster_init");
    bench_need(scene_camera_make(&s->scene, s->width, s->height, &s->camera), "camera");
    s->light = s->scene.lights[0].light;
    s->light.shadow.size = shadow_size;
    s->light.shadow.stride = shafts_map_stride(shadow_size);
    stage_shadow(s, threads);
    stage_surface(s, threads);
}

void stage_tear_down(stage *s)
{
    free(s->map);
    free(s->depth);
    free(s->colour);
    free(s->colour8);
    free(s->target);
    free(s->truth);
    free(s->scatter);
    free(s->truth_scatter);
    free(s->raster_memory);
    scene_free(&s->scene);
}

/* The compiler's vectors at their best, whatever the flags of the build. */
#if defined(__GNUC__) && !defined(__clang__)
__attribute__((optimize("O3")))
#endif
static void
floor_rows(const float *restrict depth, const uint32_t *restrict from, uint32_t *restrict to, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = depth[i] > 1.0f ? from[i] : ~from[i];
}

/* Rows of the floor as jobs, so that it can be had with threads too. */
static void floor_job(void *argument, int32_t index, int32_t worker)
{
    const stage *s = argument;
    size_t at = (size_t)index * 8 * (size_t)s->width, end = at + 8 * (size_t)s->width;
    (void)worker;
    end = end < s->pixels ? end : s->pixels;
    floor_rows(s->depth + at, (const uint32_t *)(const void *)s->colour8 + at, (uint32_t *)(void *)s->target + at, end - at);
}

double stage_floor(stage *s, pool *threads)
{
    const tyn_executor *e = pool_executor(threads);
    uint64_t start = bench_now(NULL);
    e->run(e->context, floor_job, s, (s->height + 7) / 8);
    return bench_ms_since(start);
}

tyn_config stage_config(const stage *s, int32_t workers)
{
    tyn_config config;
    bench_need(tyn_config_preset(&config, TYN_PRESET_QUALITY, s->width, s->height), "tyn_config_preset");
    config.shadow_size = s->shadow_size;
    config.workers = workers;
    return config;
}

tyn_context *stage_context(const tyn_config *config)
{
    tyn_context *context;
    size_t bytes;
    bench_need(tyn_measure(config, &bytes), "tyn_measure");
    bench_need(tyn_init(&context, config, block_of(bytes), bytes), "tyn_init");
    return context;
}

/* `scatter`: wanted too, which is not timed. */
static void render(stage *s, tyn_context *context, const tyn_executor *executor, int scatter, tyn_stats *stats)
{
    tyn_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.camera = s->camera;
    frame.depth.pixels = s->depth;
    frame.colour.pixels = s->colour8;
    frame.target.pixels = s->target;
    frame.depth.width = frame.colour.width = frame.target.width = frame.scatter.width = s->width;
    frame.depth.height = frame.colour.height = frame.target.height = frame.scatter.height = s->height;
    frame.depth.format = TYN_DEPTH_F32;
    frame.colour.format = frame.target.format = TYN_RGBA8_SRGB;
    frame.scatter.format = TYN_RGB_F32;
    frame.scatter.pixels = scatter ? s->scatter : NULL;
    frame.lights = &s->light;
    frame.light_count = 1;
    frame.media = s->scene.media;
    frame.medium_count = s->scene.medium_count;
    frame.executor = executor;
    frame.clock = bench_now;
    frame.stats = stats;
    bench_need(tyn_render(context, &frame), "tyn_render");
}

void stage_time(stage *s, tyn_context *context, pool *threads, record *best)
{
    stage_time_by(s, context, pool_executor(threads), best);
}

void stage_time_by(stage *s, tyn_context *context, const tyn_executor *executor, record *best)
{
    tyn_stats stats;
    uint64_t start = bench_now(NULL);
    double ms;
    render(s, context, executor, 0, &stats);
    ms = bench_ms_since(start);
    if (best->ms <= 0 || ms < best->ms) {
        best->ms = ms;
        best->stats = stats;
    }
}

record stage_truth(stage *s, pool *threads)
{
    tyn_config config = stage_config(s, pool_executor(threads)->workers);
    tyn_context *context;
    record r = {0};
    uint64_t start;
    config.method = TYN_METHOD_MARCH;
    context = stage_context(&config);
    start = bench_now(NULL);
    render(s, context, pool_executor(threads), 1, &r.stats);
    r.ms = bench_ms_since(start);
    memcpy(s->truth, s->target, 4 * s->pixels);
    memcpy(s->truth_scatter, s->scatter, 3 * s->pixels * sizeof *s->scatter);
    free(context);
    return r;
}

gap stage_compare(stage *s, tyn_context *context, pool *threads)
{
    double sum = 0, off = 0, all = 0;
    gap g = {0, 99, 0};
    tyn_stats stats;
    render(s, context, pool_executor(threads), 1, &stats);
    for (size_t i = 0; i < 4 * s->pixels; i++) {
        int apart = abs(s->target[i] - s->truth[i]);
        sum += apart * apart;
        g.worst = apart > g.worst ? apart : g.worst;
    }
    for (size_t i = 0; i < 3 * s->pixels; i++) {
        off += fabs((double)s->scatter[i] - (double)s->truth_scatter[i]);
        all += (double)s->truth_scatter[i];
    }
    g.psnr = sum > 0 ? 10 * log10(255.0 * 255.0 * 3 * (double)s->pixels / sum) : 99;
    g.l1_percent = all > 0 ? 100 * off / all : 100 * off;
    return g;
}
