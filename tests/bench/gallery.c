/* gallery.c - see gallery.h */
#include "gallery.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "parse.h"
#include "png.h"
#include "shafts.h"
#include "showcase.h"

static void die(const char *what, const char *why)
{
    fprintf(stderr, "bench: %s: %s\n", what, why);
    exit(1);
}

static void need(tyn_status status, const char *what)
{
    if (status != TYN_OK)
        die(what, tyn_status_name(status));
}

static uint64_t now(void *context)
{
    struct timespec t;
    (void)context;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void *floats(size_t count)
{
    void *block = calloc(count, sizeof(float));
    if (!block)
        die("memory", "none");
    return block;
}

static void render(gallery *g, const tyn_config *config, tyn_stats *stats)
{
    tyn_frame f;
    tyn_context *context;
    size_t bytes;
    void *block, *aligned;
    need(tyn_measure(config, &bytes), "tyn_measure");
    aligned = shafts_aligned(bytes, &block);
    if (!aligned)
        die("memory", "none");
    memset(aligned, 0, bytes);
    need(tyn_init(&context, config, aligned, bytes), "tyn_init");
    memset(&f, 0, sizeof f);
    f.camera = g->drawn.camera;
    f.depth.pixels = g->drawn.depth;
    f.colour.pixels = g->drawn.surface;
    f.scatter.pixels = g->scatter;
    f.target.pixels = g->picture;
    f.depth.width = f.colour.width = f.scatter.width = f.target.width = g->width;
    f.depth.height = f.colour.height = f.scatter.height = f.target.height = g->height;
    f.depth.format = TYN_DEPTH_F32;
    f.colour.format = f.scatter.format = f.target.format = TYN_RGB_F32;
    f.lights = &g->light;
    f.light_count = 1;
    f.media = g->media;
    f.medium_count = g->scene.medium_count;
    f.executor = pool_executor(g->threads);
    f.clock = now;
    f.stats = stats;
    need(tyn_render(context, &f), "tyn_render");
    free(block);
}

tyn_config gallery_config(const gallery *g, tyn_method method)
{
    tyn_config c;
    need(tyn_config_preset(&c, TYN_PRESET_QUALITY, g->width, g->height), "tyn_config_preset");
    c.shadow_size = g->shadow_size;
    c.method = method;
    c.maps = g->light.more_count + 1;
    c.textured = g->light.texture_count > 0;
    c.workers = pool_executor(g->threads)->workers;
    return c;
}

void gallery_march(gallery *g)
{
    tyn_config c = gallery_config(g, TYN_METHOD_MARCH);
    tyn_stats stats;
    render(g, &c, &stats);
}

static void make_truth(gallery *g)
{
    gallery_threads(g, 2);
    gallery_march(g);
    gallery_threads(g, 1);
    memcpy(g->truth, g->scatter, 3 * g->pixels * sizeof *g->truth);
    g->exposure = render_exposure(g->picture, g->width, g->height);
}

void gallery_open(gallery *g, const char *name, int32_t width, int32_t height, int32_t shadow_size)
{
    render_settings settings;
    tool_error error;
    int status;
    memset(g, 0, sizeof *g);
    memset(&settings, 0, sizeof settings);
    memset(&error, 0, sizeof error);
    scene_init(&g->scene);
    status = showcase_scene(name, &g->scene);
    if (status == 1) {
        char path[256];
        snprintf(path, sizeof path, "../shared/reference/%s.scene", name);
        status = scene_load(&g->scene, path, &error);
    }
    if (status != 0)
        die(name, "cannot be loaded");
    g->threads = pool_create(2);
    if (!g->threads)
        die("threads", "none");
    g->width = settings.width = width;
    g->height = settings.height = height;
    g->shadow_size = settings.shadow_size = shadow_size;
    g->pixels = (size_t)width * (size_t)height;
    settings.method = TYN_METHOD_NONE + 1;
    settings.want_maps = settings.want_surface = 1;
    if (render_scene(&g->scene, name, &settings, g->threads, &g->drawn, &error) != 0)
        die(name, "cannot be drawn");
    g->light = shafts_light(&g->scene.lights[0]);
    g->light.shadow = g->drawn.lights[0].faces[0];
    if (g->drawn.lights[0].count > 1) {
        g->light.more = g->drawn.lights[0].faces + 1;
        g->light.more_count = g->drawn.lights[0].count - 1;
    }
    memcpy(g->media, g->scene.media, sizeof g->media);
    g->truth = floats(3 * g->pixels);
    g->scatter = floats(3 * g->pixels);
    g->picture = floats(3 * g->pixels);
    make_truth(g);
}

void gallery_close(gallery *g)
{
    render_free(&g->drawn);
    scene_free(&g->scene);
    pool_free(g->threads);
    free(g->truth);
    free(g->scatter);
    free(g->picture);
}

void gallery_thicken(gallery *g, float factor)
{
    for (int i = 0; i < TYN_MAX_MEDIA; i++)
        for (int c = 0; c < 3; c++) {
            g->media[i].scatter[c] = g->scene.media[i].scatter[c] * factor;
            g->media[i].absorb[c] = g->scene.media[i].absorb[c] * factor;
        }
    make_truth(g);
}

void gallery_threads(gallery *g, int threads)
{
    pool_free(g->threads);
    g->threads = pool_create(threads);
    if (!g->threads)
        die("threads", "none");
}

void gallery_shoot(gallery *g, const tyn_config *config, int repeats, gallery_shot *shot)
{
    tyn_config c = *config;
    double gap = 0, sum = 0;
    memset(shot, 0, sizeof *shot);
    c.workers = pool_executor(g->threads)->workers;
    for (int i = 0; i < repeats; i++) {
        tyn_stats stats;
        render(g, &c, &stats);
        if (i == 0) {
            shot->stats = stats;
            continue;
        }
        shot->stats.slice_ns = stats.slice_ns < shot->stats.slice_ns ? stats.slice_ns : shot->stats.slice_ns;
        shot->stats.gather_ns = stats.gather_ns < shot->stats.gather_ns ? stats.gather_ns : shot->stats.gather_ns;
    }
    for (size_t i = 0; i < 3 * g->pixels; i++) {
        gap += fabs((double)g->scatter[i] - (double)g->truth[i]);
        sum += (double)g->truth[i];
    }
    shot->gap = sum > 0 ? gap / sum : gap;
    shot->ms = (double)(shot->stats.slice_ns + shot->stats.gather_ns) * 1e-6;
    shot->slice_us = (double)shot->stats.slice_ns * 1e-3 / (double)(shot->stats.slices > 0 ? shot->stats.slices : 1);
    shot->pixel_ns = (double)shot->stats.gather_ns / (double)g->pixels;
}

void gallery_picture(const gallery *g, const char *folder, const char *name)
{
    tyn_image linear = {g->picture, g->width, g->height, 0, TYN_RGB_F32}, bytes = linear;
    tyn_display display = {g->exposure, TYN_TONE_FILM, 1};
    char path[512];
    FILE *file;
    bytes.pixels = floats(g->pixels);
    bytes.format = TYN_RGBA8_SRGB;
    need(tyn_encode(&linear, &display, &bytes), "tyn_encode");
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    file = fopen(path, "wb");
    if (!file || png_write(file, bytes.pixels, g->width, g->height) != 0 || fclose(file) != 0)
        die(path, "cannot be written");
    free(bytes.pixels);
}
