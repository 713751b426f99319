/* render.c - shadow maps, surfaces, shafts. */
#include "render.h"
#include "progress.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_SHADOW 2048
#define FACES 6 /* of a point light's cube */

typedef struct work {
    const scene *s;
    const char *name;
    const render_settings *settings;
    pool *threads;
    render_result *out;
    tool_error *error;
    size_t pixels;
    tyn_config config;
    tyn_camera camera;
    tyn_light lights[TYN_MAX_LIGHTS];
    tyn_shadow faces[TYN_MAX_LIGHTS][FACES];
    float *maps[TYN_MAX_LIGHTS][FACES];
    tyn_raster *raster;
    void *raster_block, *shafts_block;
} work;

static int fail(const work *w, int32_t line, const char *what, tyn_status status)
{
    return error_set(w->error, w->name, line, NULL, 0, "%s: %s", what, tyn_status_name(status));
}

/* What aligned_alloc would do. *block is to be freed. */
static void *aligned(size_t bytes, void **block)
{
    *block = bytes < SIZE_MAX - TYN_ALIGNMENT ? malloc(bytes + TYN_ALIGNMENT) : NULL;
    return *block ? (void *)(((uintptr_t)*block + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT) : NULL;
}

static void *pixels_for(const work *w, size_t bytes)
{
    return w->pixels < SIZE_MAX / bytes ? malloc(w->pixels * bytes) : NULL;
}

static tyn_image image_of(const work *w, void *pixels, tyn_format format)
{
    tyn_image image = {pixels, w->config.width, w->config.height, 0, format};
    return image;
}

static int make_config(work *w)
{
    const render_settings *r = w->settings;
    tyn_config *c = &w->config;
    int32_t width = r->width ? r->width : w->s->width, height = r->height ? r->height : w->s->height;
    tyn_status status = tyn_config_preset(c, r->preset_given ? r->preset : TYN_PRESET_QUALITY, width, height);
    if (status != TYN_OK)
        return fail(w, 0, "image", status);
    if (r->method_given)
        c->method = r->method;
    if (r->rays_given)
        c->rays = r->rays;
    if (r->steps)
        c->steps = r->steps;
    if (r->slices)
        c->slices = r->slices;
    if (r->samples)
        c->samples = r->samples;
    if (r->initial_step)
        c->initial_step = r->initial_step;
    if (r->break_threshold > 0.0f)
        c->break_threshold = r->break_threshold;
    if (r->shadow_size)
        c->shadow_size = r->shadow_size;
    if (c->shadow_size == 0)
        c->shadow_size = DEFAULT_SHADOW;
    for (int32_t i = 0; i < w->s->light_count; i++) {
        c->maps = w->s->lights[i].point ? FACES : c->maps;
        c->textured = w->s->lights[i].texture ? 1 : c->textured;
    }
    c->lights = w->s->light_count > 0 ? w->s->light_count : 1;
    c->workers = pool_executor(w->threads)->workers;
    w->pixels = (size_t)width * (size_t)height;
    status = scene_camera_make(w->s, width, height, &w->camera);
    return status == TYN_OK ? 0 : fail(w, w->s->camera.line, "camera", status);
}

static int make_raster(work *w)
{
    tyn_raster_config c;
    size_t bytes = 0;
    void *block;
    tyn_status status;
    memset(&c, 0, sizeof c);
    c.width = w->config.width > w->config.shadow_size ? w->config.width : w->config.shadow_size;
    c.height = w->config.height > w->config.shadow_size ? w->config.height : w->config.shadow_size;
    c.workers = w->config.workers;
    status = tyn_raster_measure(&c, &bytes);
    if (status != TYN_OK)
        return fail(w, 0, "rasterizer", status);
    w->out->raster_bytes = bytes;
    block = aligned(bytes, &w->raster_block);
    if (!block)
        return error_memory(w->error);
    status = tyn_raster_init(&w->raster, &c, block, bytes);
    return status == TYN_OK ? 0 : fail(w, 0, "rasterizer", status);
}

static int draw_surface(work *w, const char *stage, void *colour, int32_t light_count)
{
    uint64_t start = clock_now(NULL);
    tyn_surface f;
    tyn_status status;
    progress_stage(stage);
    memset(&f, 0, sizeof f);
    f.camera = w->camera;
    f.meshes = w->s->meshes;
    f.mesh_count = w->s->mesh_count;
    f.lights = light_count ? w->lights : NULL;
    f.light_count = light_count;
    f.media = w->s->medium_count ? w->s->media : NULL;
    f.medium_count = w->s->medium_count;
    memcpy(f.ambient, w->s->ambient, sizeof f.ambient);
    memcpy(f.background, w->s->background, sizeof f.background);
    f.colour = image_of(w, colour, TYN_RGB_F32);
    f.depth = image_of(w, w->out->depth, TYN_DEPTH_F32);
    f.executor = pool_executor(w->threads);
    status = tyn_raster_surface(w->raster, &f);
    w->out->times.surface_ns += clock_now(NULL) - start;
    return status == TYN_OK ? 0 : fail(w, 0, stage, status);
}

/* What the light is, but for its shadow maps. */
static void set_light(work *w, int32_t i)
{
    const scene_light *from = &w->s->lights[i];
    tyn_light *l = &w->lights[i];
    *l = from->light;
    if (from->point) {
        l->kind = TYN_LIGHT_POINT;
        l->shadow = w->faces[i][0];
        l->more = &w->faces[i][1];
        l->more_count = FACES - 1;
    } else if (from->texture) {
        l->textures = from->texture;
        l->texture_count = 1;
        memcpy(l->up, from->texture_up, sizeof l->up);
        memcpy(l->extent, from->extent, sizeof l->extent);
    }
}

/* The farthest corner of the scene from a point. */
static float reach_from(const scene *s, const float position[3], float otherwise)
{
    float min[3], max[3], sum = 0.0f;
    if (!scene_bounds(s, min, max))
        return otherwise;
    for (int i = 0; i < 3; i++) {
        float a = fabsf(min[i] - position[i]), b = fabsf(max[i] - position[i]), most = a > b ? a : b;
        sum += most * most;
    }
    return sqrtf(sum) > 0.0f && sqrtf(sum) <= FLT_MAX ? sqrtf(sum) : otherwise;
}

/* After the depth is known: a map that covers just what is seen makes the best of its texels. */
static int draw_shadow(work *w, int32_t i, const tyn_image *depth)
{
    const scene *s = w->s;
    tyn_light *l = &w->lights[i];
    size_t texels = (size_t)w->config.shadow_size * (size_t)w->config.shadow_size;
    int32_t faces = s->lights[i].point ? FACES : 1;
    tyn_status status;
    for (int32_t k = 0; k < faces; k++)
        w->faces[i][k].size = w->config.shadow_size;
    set_light(w, i);
    l->shadow.size = w->config.shadow_size;
    if (s->lights[i].point)
        status = tyn_shadow_fit_cube(w->faces[i], l->position, reach_from(s, l->position, s->camera.far_depth));
    else
        status = tyn_shadow_fit_scene(l, &w->camera, depth, s->meshes, s->mesh_count);
    if (status != TYN_OK)
        return fail(w, s->lights[i].line, "light", status);
    if (faces == 1)
        w->faces[i][0] = l->shadow;
    for (int32_t k = 0; k < faces; k++) {
        float **map = &w->maps[i][k];
        *map = texels < SIZE_MAX / sizeof(float) ? malloc(texels * sizeof(float)) : NULL;
        if (!*map)
            return error_memory(w->error);
        w->out->shadow_bytes += texels * sizeof(float);
        status = tyn_raster_shadow(w->raster, &w->faces[i][k], *map, s->meshes, s->mesh_count, pool_executor(w->threads), NULL,
                                   NULL, NULL);
        if (status != TYN_OK)
            return fail(w, s->lights[i].line, "shadow map", status);
        w->faces[i][k].depth = *map;
    }
    l->shadow = w->faces[i][0];
    return 0;
}

static int draw_shadows(work *w)
{
    tyn_image depth = image_of(w, w->out->depth, TYN_DEPTH_F32);
    uint64_t start = clock_now(NULL);
    int status = 0;
    progress_stage("shadow maps");
    for (int32_t i = 0; i < w->s->light_count && !status; i++)
        status = draw_shadow(w, i, &depth);
    w->out->times.shadow_ns = clock_now(NULL) - start;
    return status;
}

static int draw_shafts(work *w)
{
    const render_settings *r = w->settings;
    render_result *out = w->out;
    uint64_t start = clock_now(NULL);
    size_t bytes = 0;
    tyn_context *context;
    tyn_frame f;
    void *block;
    tyn_status status = tyn_measure(&w->config, &bytes);
    if (status != TYN_OK)
        return fail(w, 0, "shafts", status);
    block = aligned(bytes, &w->shafts_block);
    if (!block)
        return error_memory(w->error);
    status = tyn_init(&context, &w->config, block, bytes);
    if (status != TYN_OK)
        return fail(w, 0, "shafts", status);
    progress_stage("shafts");
    memset(&f, 0, sizeof f);
    f.camera = w->camera;
    f.depth = image_of(w, out->depth, TYN_DEPTH_F32);
    f.colour = image_of(w, out->surface, TYN_RGB_F32);
    f.target = image_of(w, out->radiance, TYN_RGB_F32);
    if (out->scatter)
        f.scatter = image_of(w, out->scatter, TYN_RGB_F32);
    f.lights = w->s->light_count ? w->lights : NULL;
    f.light_count = w->s->light_count;
    f.media = w->s->medium_count ? w->s->media : NULL;
    f.medium_count = w->s->medium_count;
    f.executor = pool_executor(w->threads);
    f.clock = clock_now;
    f.stats = &out->stats;
    status = tyn_render(context, &f);
    out->times.shafts_ns = clock_now(NULL) - start;
    if (status != TYN_OK)
        return fail(w, 0, "shafts", status);
    out->exposure = r->exposure > 0.0f ? r->exposure : render_exposure(out->radiance, out->width, out->height);
    if (r->debug == TYN_DEBUG_NONE)
        return 0;
    f.target = image_of(w, out->debug, r->debug_format);
    memset(&f.scatter, 0, sizeof f.scatter);
    f.display.exposure = r->debug_format == TYN_RGB_F32 && !(r->exposure > 0.0f) ? 1.0f : out->exposure;
    f.display.tone = TYN_TONE_FILM;
    f.display.dither = 1;
    f.debug = r->debug;
    f.stats = NULL;
    status = tyn_render(context, &f);
    return status == TYN_OK ? 0 : fail(w, 0, "debug picture", status);
}

static int allocate(work *w)
{
    const render_settings *r = w->settings;
    render_result *out = w->out;
    out->width = w->config.width;
    out->height = w->config.height;
    out->radiance = pixels_for(w, 3 * sizeof(float));
    out->depth = pixels_for(w, sizeof(float));
    /* Shafts can go over the surface in place; unless somebody needs that afterwards. */
    out->surface = r->want_surface || r->debug ? pixels_for(w, 3 * sizeof(float)) : out->radiance;
    if (r->want_scatter)
        out->scatter = pixels_for(w, 3 * sizeof(float));
    if (r->debug)
        out->debug = pixels_for(w, (size_t)tyn_format_bytes(r->debug_format));
    if (!out->radiance || !out->depth || !out->surface || (r->want_scatter && !out->scatter) || (r->debug && !out->debug))
        return error_memory(w->error);
    return 0;
}

int render_scene(const scene *s, const char *name, const render_settings *settings, pool *threads, render_result *result,
                 tool_error *error)
{
    work w;
    int status;
    memset(&w, 0, sizeof w);
    memset(result, 0, sizeof *result);
    w.s = s;
    w.name = name;
    w.settings = settings;
    w.threads = threads;
    w.out = result;
    w.error = error;
    pool_watch(threads, progress_jobs);
    status = make_config(&w) != 0 || allocate(&w) != 0 || make_raster(&w) != 0 || draw_surface(&w, "depth", NULL, 0) != 0 ||
             draw_shadows(&w) != 0 || draw_surface(&w, "surfaces", result->surface, s->light_count) != 0 ||
             draw_shafts(&w) != 0;
    for (int i = 0; i < TYN_MAX_LIGHTS; i++)
        for (int k = 0; k < FACES; k++)
            free(w.maps[i][k]);
    free(w.raster_block);
    free(w.shafts_block);
    if (result->surface == result->radiance)
        result->surface = NULL;
    if (status)
        render_free(result);
    progress_end();
    return status ? -1 : 0;
}

void render_free(render_result *result)
{
    free(result->radiance);
    free(result->surface);
    free(result->scatter);
    free(result->depth);
    free(result->debug);
    memset(result, 0, sizeof *result);
}

void *render_display(const render_result *result, float exposure, tyn_format format, tool_error *error)
{
    size_t bytes = (size_t)tyn_format_bytes(format), count = (size_t)result->width * (size_t)result->height;
    void *pixels = count < SIZE_MAX / bytes ? malloc(count * bytes) : NULL;
    tyn_image linear = {result->radiance, result->width, result->height, 0, TYN_RGB_F32};
    tyn_image target = {pixels, result->width, result->height, 0, format};
    tyn_display display = {exposure, TYN_TONE_FILM, 1};
    tyn_status status;
    if (!pixels) {
        error_memory(error);
        return NULL;
    }
    status = tyn_encode(&linear, &display, &target);
    if (status != TYN_OK) {
        error_set(error, "picture", 0, NULL, 0, "%s", tyn_status_name(status));
        free(pixels);
        return NULL;
    }
    return pixels;
}
