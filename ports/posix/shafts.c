/* shafts.c */
#include "shafts.h"
#include "progress.h"

#include <stdlib.h>
#include <string.h>

#define DEFAULT_SHADOW 2048

static int fail(tool_error *error, const char *name, const char *what, tyn_status status)
{
    return error_set(error, name, 0, NULL, 0, "%s: %s", what, tyn_status_name(status));
}

void *shafts_aligned(size_t bytes, void **block)
{
    *block = bytes < SIZE_MAX - TYN_ALIGNMENT ? malloc(bytes + TYN_ALIGNMENT) : NULL;
    return *block ? (void *)(((uintptr_t)*block + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT) : NULL;
}

static void choose(int32_t *to, int32_t from)
{
    if (from)
        *to = from;
}

tyn_status shafts_config(tyn_config *c, const render_settings *r, int32_t width, int32_t height)
{
    tyn_status status = tyn_config_preset(c, r->preset ? (tyn_preset)(r->preset - 1) : TYN_PRESET_QUALITY, width, height);
    if (status != TYN_OK)
        return status;
    c->method = r->method ? (tyn_method)(r->method - 1) : c->method;
    c->rays = r->rays ? (tyn_rays)(r->rays - 1) : c->rays;
    if (r->debug == TYN_DEBUG_TREE + 1)
        c->rays = TYN_RAYS_TREE;
    if (r->debug == TYN_DEBUG_BASIS + 1)
        c->method = TYN_METHOD_PREFILTERED;
    c->gather = r->gather ? (tyn_gather)(r->gather - 1) : c->gather;
    c->kernel = r->kernel ? (tyn_kernel)(r->kernel - 1) : c->kernel;
    choose(&c->steps, r->steps);
    choose(&c->slices, r->slices);
    choose(&c->samples, r->samples);
    choose(&c->initial_step, r->initial_step);
    choose(&c->taps, r->taps);
    choose(&c->downscale, r->downscale);
    choose(&c->budget, r->budget);
    choose(&c->bases, r->bases);
    choose(&c->columns, r->columns);
    choose(&c->references, r->references);
    c->weights = r->weights ? (tyn_weights)(r->weights - 1) : c->weights;
    choose(&c->shadow_size, r->shadow_size);
    if (r->break_threshold > 0.0f)
        c->break_threshold = r->break_threshold;
    if (r->tolerance > 0.0f)
        c->tolerance = r->tolerance;
    c->isa = r->isa ? r->isa - 1 : 0;
    if (c->shadow_size == 0)
        c->shadow_size = DEFAULT_SHADOW;
    return TYN_OK;
}

ptrdiff_t shafts_map_stride(int32_t size)
{
    const ptrdiff_t bytes = (ptrdiff_t)size * (ptrdiff_t)sizeof(float);
    return bytes % 4096 ? bytes : bytes + 64;
}

tyn_light shafts_light(const scene_light *from)
{
    tyn_light l = from->light;
    if (from->point) {
        l.kind = TYN_LIGHT_POINT;
    } else if (from->texture) {
        l.textures = from->texture;
        l.texture_count = 1;
        memcpy(l.up, from->texture_up, sizeof l.up);
        memcpy(l.extent, from->extent, sizeof l.extent);
    }
    return l;
}

int shafts_raster(tyn_raster **raster, const tyn_config *config, void **block, size_t *bytes, const char *name,
                  tool_error *error)
{
    tyn_raster_config c;
    void *at;
    tyn_status status;
    memset(&c, 0, sizeof c);
    c.width = config->width > config->shadow_size ? config->width : config->shadow_size;
    c.height = config->height > config->shadow_size ? config->height : config->shadow_size;
    c.workers = config->workers;
    c.isa = config->isa;
    status = tyn_raster_measure(&c, bytes);
    if (status != TYN_OK)
        return fail(error, name, "rasterizer", status);
    at = shafts_aligned(*bytes, block);
    if (!at)
        return error_memory(error);
    status = tyn_raster_init(raster, &c, at, *bytes);
    return status == TYN_OK ? 0 : fail(error, name, "rasterizer", status);
}

static void *pixels_for(const render_result *r, size_t bytes)
{
    size_t pixels = (size_t)r->width * (size_t)r->height;
    return pixels < SIZE_MAX / bytes ? malloc(pixels * bytes) : NULL;
}

int shafts_allocate(render_result *result, const tyn_config *config, const render_settings *settings, tool_error *error)
{
    result->width = config->width;
    result->height = config->height;
    result->radiance = pixels_for(result, 3 * sizeof(float));
    if (settings->want_scatter)
        result->scatter = pixels_for(result, 3 * sizeof(float));
    if (settings->debug)
        result->debug = pixels_for(result, (size_t)tyn_format_bytes(settings->debug_format));
    if (!result->radiance || (settings->want_scatter && !result->scatter) || (settings->debug && !result->debug))
        return error_memory(error);
    return 0;
}

static tyn_image image_of(const render_result *r, void *pixels, tyn_format format)
{
    tyn_image image = {pixels, r->width, r->height, 0, format};
    return image;
}

static tyn_status draw_debug(tyn_context *context, tyn_frame *f, const render_settings *r, render_result *out)
{
    f->target = image_of(out, out->debug, r->debug_format);
    memset(&f->scatter, 0, sizeof f->scatter);
    f->display.exposure = r->debug_format == TYN_RGB_F32 && !(r->exposure > 0.0f) ? 1.0f : out->exposure;
    f->display.tone = TYN_TONE_FILM;
    f->display.dither = 1;
    f->debug = (tyn_debug)(r->debug - 1);
    f->debug_x = r->debug_x;
    f->debug_y = r->debug_y;
    f->stats = NULL;
    return tyn_render(context, f);
}

int shafts_draw(const tyn_config *config, tyn_frame *f, const render_settings *r, pool *threads, render_result *out,
                const char *name, tool_error *error)
{
    uint64_t start = clock_now(NULL);
    size_t bytes = 0;
    tyn_context *context;
    void *at, *block = NULL;
    tyn_status status = tyn_measure(config, &bytes);
    if (status != TYN_OK)
        return fail(error, name, "shafts", status);
    at = shafts_aligned(bytes, &block);
    if (!at)
        return error_memory(error);
    progress_stage("shafts");
    f->target = image_of(out, out->radiance, TYN_RGB_F32);
    if (out->scatter)
        f->scatter = image_of(out, out->scatter, TYN_RGB_F32);
    f->executor = pool_executor(threads);
    f->clock = clock_now;
    f->stats = &out->stats;
    status = tyn_init(&context, config, at, bytes);
    if (status == TYN_OK)
        status = tyn_render(context, f);
    out->times.shafts_ns = clock_now(NULL) - start;
    if (status == TYN_OK) {
        out->exposure = r->exposure > 0.0f ? r->exposure : render_exposure(out->radiance, out->width, out->height);
        if (r->debug)
            status = draw_debug(context, f, r, out);
    }
    free(block);
    return status == TYN_OK ? 0 : fail(error, name, "shafts", status);
}
