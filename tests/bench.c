/* bench.c - times of the post process, as ratios: to a plain pass over the pixels (the floor) and to a march of every pixel.
 * Minima over the repeats, all in one run: absolute times say little on a shared machine.
 *
 *     bench [SCENE|all] [WIDTHxHEIGHT] [REPEATS]      scenes: simple-on simple-off leafy-on leafy-off (the default) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "pool.h"
#include "scene.h"
#include "showcase.h"
#include "tyndall.h"

#define SHADOW 2048

/* All that a frame reads, made once. */
typedef struct stage {
    scene scene;
    int32_t width, height;
    size_t pixels;
    tyn_camera camera;
    tyn_light light;
    float *map, *depth, *colour;
    uint8_t *colour8, *target, *truth;
    double raster_ms, shadow_ms;
} stage;

static void die(const char *what)
{
    fprintf(stderr, "bench: %s\n", what);
    exit(1);
}

static void need(tyn_status status, const char *what)
{
    if (status == TYN_OK)
        return;
    fprintf(stderr, "bench: %s: %s\n", what, tyn_status_name(status));
    exit(1);
}

static void *block_of(size_t bytes)
{
    void *block = NULL;
    if (posix_memalign(&block, TYN_ALIGNMENT, bytes) || !block)
        die("no memory");
    memset(block, 0, bytes); /* touched: page faults are no part of the times */
    return block;
}

static uint64_t now(void *context)
{
    struct timespec t;
    (void)context;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static double ms_since(uint64_t start)
{
    return (double)(now(NULL) - start) * 1e-6;
}

static void set_up(stage *s, const char *name, pool *threads)
{
    tyn_raster_config config = {0};
    tyn_surface surface;
    tyn_raster *raster;
    tyn_display display = {1, TYN_TONE_CLAMP, 0};
    tyn_image linear, bytes8;
    float low[3], high[3];
    size_t bytes;
    void *block;
    uint64_t start;
    scene_init(&s->scene);
    if (showcase_scene(name, &s->scene))
        die("no such scene");
    s->pixels = (size_t)s->width * (size_t)s->height;
    s->map = block_of((size_t)SHADOW * SHADOW * sizeof *s->map);
    s->depth = block_of(s->pixels * sizeof *s->depth);
    s->colour = block_of(s->pixels * 3 * sizeof *s->colour);
    s->colour8 = block_of(s->pixels * 4);
    s->target = block_of(s->pixels * 4);
    s->truth = block_of(s->pixels * 4);
    config.width = s->width > SHADOW ? s->width : SHADOW;
    config.height = s->height > SHADOW ? s->height : SHADOW;
    config.workers = pool_executor(threads)->workers;
    need(tyn_raster_measure(&config, &bytes), "tyn_raster_measure");
    block = block_of(bytes);
    need(tyn_raster_init(&raster, &config, block, bytes), "tyn_raster_init");
    need(scene_camera_make(&s->scene, s->width, s->height, &s->camera), "camera");
    s->light = s->scene.lights[0].light;
    scene_bounds(&s->scene, low, high);
    need(tyn_shadow_fit(&s->light, &s->camera, low, high), "tyn_shadow_fit");
    s->light.shadow.size = SHADOW;
    start = now(NULL);
    need(tyn_raster_shadow(raster, &s->light.shadow, s->map, s->scene.meshes, s->scene.mesh_count, pool_executor(threads), NULL,
                           NULL, NULL),
         "tyn_raster_shadow");
    s->shadow_ms = ms_since(start);
    s->light.shadow.depth = s->map;
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
    start = now(NULL);
    need(tyn_raster_surface(raster, &surface), "tyn_raster_surface");
    s->raster_ms = ms_since(start);
    linear = surface.colour;
    bytes8 = linear;
    bytes8.pixels = s->colour8;
    bytes8.format = TYN_RGBA8_SRGB;
    need(tyn_encode(&linear, &display, &bytes8), "tyn_encode");
    free(block);
}

static void tear_down(stage *s)
{
    free(s->map);
    free(s->depth);
    free(s->colour);
    free(s->colour8);
    free(s->target);
    free(s->truth);
    scene_free(&s->scene);
}

/* ---- what is timed -------------------------------------------------------------------------------------------------- */

/* Rows of the floor as jobs, so that it can be had with threads too. */
static void floor_job(void *argument, int32_t index, int32_t worker)
{
    const stage *s = argument;
    size_t at = (size_t)index * 8 * (size_t)s->width, end = at + 8 * (size_t)s->width;
    const uint32_t *from = (const uint32_t *)(const void *)s->colour8;
    uint32_t *to = (uint32_t *)(void *)s->target;
    (void)worker;
    end = end < s->pixels ? end : s->pixels;
    for (; at < end; at++)
        to[at] = s->depth[at] > 1.0f ? from[at] : ~from[at];
}

static double time_floor(stage *s, pool *threads)
{
    const tyn_executor *e = pool_executor(threads);
    uint64_t start = now(NULL);
    e->run(e->context, floor_job, s, (s->height + 7) / 8);
    return ms_since(start);
}

/* A frame's time and stages, the least of all repeats. */
typedef struct record {
    double ms, slice_ms, gather_ms;
    tyn_stats stats;
} record;

static tyn_context *make_context(const stage *s, tyn_method method, tyn_rays rays, int32_t steps, int32_t workers)
{
    tyn_config config;
    tyn_context *context;
    size_t bytes;
    need(tyn_config_preset(&config, TYN_PRESET_QUALITY, s->width, s->height), "tyn_config_preset");
    config.method = method;
    config.rays = rays;
    config.steps = steps;
    config.shadow_size = SHADOW;
    config.workers = workers;
    need(tyn_measure(&config, &bytes), "tyn_measure");
    need(tyn_init(&context, &config, block_of(bytes), bytes), "tyn_init");
    return context;
}

static void time_frame(stage *s, tyn_context *context, pool *threads, record *best)
{
    tyn_frame frame;
    tyn_stats stats;
    double ms;
    uint64_t start;
    memset(&frame, 0, sizeof frame);
    frame.camera = s->camera;
    frame.depth.pixels = s->depth;
    frame.colour.pixels = s->colour8;
    frame.target.pixels = s->target;
    frame.depth.width = frame.colour.width = frame.target.width = s->width;
    frame.depth.height = frame.colour.height = frame.target.height = s->height;
    frame.depth.format = TYN_DEPTH_F32;
    frame.colour.format = frame.target.format = TYN_RGBA8_SRGB;
    frame.lights = &s->light;
    frame.light_count = 1;
    frame.media = s->scene.media;
    frame.medium_count = s->scene.medium_count;
    frame.executor = pool_executor(threads);
    frame.clock = now;
    frame.stats = &stats;
    start = now(NULL);
    need(tyn_render(context, &frame), "tyn_render");
    ms = ms_since(start);
    if (best->ms <= 0 || ms < best->ms) {
        best->ms = ms;
        best->slice_ms = (double)stats.slice_ns * 1e-6;
        best->gather_ms = (double)stats.gather_ns * 1e-6;
        best->stats = stats;
    }
}

static void compare(const stage *s, double *psnr, int *worst)
{
    double sum = 0;
    *worst = 0;
    for (size_t i = 0; i < 4 * s->pixels; i++) {
        int gap = abs(s->target[i] - s->truth[i]);
        sum += gap * gap;
        *worst = gap > *worst ? gap : *worst;
    }
    *psnr = sum > 0 ? 10 * log10(255.0 * 255.0 * 3 * (double)s->pixels / sum) : 99;
}

/* ---- the table ------------------------------------------------------------------------------------------------------ */

/* The march with 500 steps takes most of a minute at full size: timed on a sixteenth of the pixels, times that. */
static record time_march(const char *name, int32_t width, int32_t height, pool *one)
{
    stage s;
    record r = {0};
    tyn_context *context;
    double scale;
    memset(&s, 0, sizeof s);
    s.width = (width + 3) / 4;
    s.height = (height + 3) / 4;
    set_up(&s, name, one);
    context = make_context(&s, TYN_METHOD_MARCH, TYN_RAYS_STEPS, 500, 1);
    time_frame(&s, context, one, &r);
    scale = (double)width * height / (double)s.pixels;
    r.ms *= scale;
    r.gather_ms *= scale;
    free(context);
    tear_down(&s);
    return r;
}

static void row(const char *name, const record *r, double floor_ms, double march_ms)
{
    printf("  %-26s %9.2f %9.2f %9.2f %8.1f %9.1f %7.2f\n", name, r->ms, r->slice_ms, r->gather_ms, r->ms / floor_ms,
           march_ms / r->ms, (double)r->stats.rays_percent);
}

static void bench(const char *name, int32_t width, int32_t height, int repeats)
{
    stage s;
    pool *one = pool_create(1), *two = pool_create(2);
    record epipolar = {0}, epipolar2 = {0}, words = {0}, subsample = {0}, steps;
    tyn_context *contexts[4];
    double floor_ms = 1e9, floor2_ms = 1e9, psnr;
    int worst;
    if (!one || !two)
        die("no threads");
    memset(&s, 0, sizeof s);
    s.width = width;
    s.height = height;
    set_up(&s, name, two);
    contexts[0] = make_context(&s, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, 500, 1);
    contexts[1] = make_context(&s, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, 500, 2);
    contexts[2] = make_context(&s, TYN_METHOD_MARCH, TYN_RAYS_WORDS, 500, 1);
    contexts[3] = make_context(&s, TYN_METHOD_SUBSAMPLE, TYN_RAYS_WORDS, 500, 1);
    steps = time_march(name, width, height, one);
    time_frame(&s, contexts[2], one, &words);
    memcpy(s.truth, s.target, 4 * s.pixels);
    for (int i = 0; i < repeats; i++) { /* in turn, so that a busy moment hits all alike */
        floor_ms = fmin(floor_ms, time_floor(&s, one));
        floor2_ms = fmin(floor2_ms, time_floor(&s, two));
        time_frame(&s, contexts[3], one, &subsample);
        time_frame(&s, contexts[1], two, &epipolar2);
        time_frame(&s, contexts[0], one, &epipolar);
    }
    compare(&s, &psnr, &worst);
    printf("%s, %dx%d, shadow map %d, %d repeats; floor %.2f ms (2 threads %.2f); rasterizer, 2 threads: map %.1f ms, "
           "surfaces %.1f ms\n",
           name, (int)width, (int)height, SHADOW, repeats, floor_ms, floor2_ms, s.shadow_ms, s.raster_ms);
    printf("  %-26s %9s %9s %9s %8s %9s %7s\n", "", "ms", "slices", "pixels", "x floor", "march/x", "rays %");
    row("march, 500 steps (scaled)", &steps, floor_ms, steps.ms);
    row("march, exact", &words, floor_ms, steps.ms);
    row("subsample", &subsample, floor_ms, steps.ms);
    row("epipolar", &epipolar, floor_ms, steps.ms);
    row("epipolar, 2 threads", &epipolar2, floor2_ms, steps.ms);
    printf("  2 threads are %.2f x as fast; epipolar against the exact march: %.1f dB, largest error %d / 255; "
           "%lld slices, %lld rays, %lld rejected, %.1f MB\n",
           epipolar.ms / epipolar2.ms, psnr, worst, (long long)epipolar.stats.slices, (long long)epipolar.stats.rays,
           (long long)epipolar.stats.rejected, (double)epipolar.stats.memory / 1048576.0);
    fflush(stdout);
    for (int i = 0; i < 4; i++)
        free(contexts[i]);
    tear_down(&s);
    pool_free(one);
    pool_free(two);
}

int main(int argc, char **argv)
{
    static const char *const all[] = {"simple-on", "simple-off", "leafy-on", "leafy-off"};
    const char *name = argc > 1 ? argv[1] : "leafy-off";
    int width = 1920, height = 1080, repeats = argc > 3 ? atoi(argv[3]) : 15;
    if (argc > 2 && sscanf(argv[2], "%dx%d", &width, &height) != 2)
        die("a size is WIDTHxHEIGHT");
    if (repeats < 1)
        die("repeats are 1 or more");
    for (int i = 0; i < 4; i++)
        if (strcmp(name, "all") == 0)
            bench(all[i], width, height, repeats);
    if (strcmp(name, "all") != 0)
        bench(name, width, height, repeats);
    return 0;
}
