/* render.c - shadow maps, surfaces, shafts. */
#include "render.h"
#include "progress.h"
#include "shafts.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    tyn_light lights[TYN_MAX_LIGHTS]; /* light_count of them: the scene's and those that are there twice */
    int32_t light_count;
    tyn_raster *raster;
    void *raster_block;
} work;

static int fail(const work *w, int32_t line, const char *what, tyn_status status)
{
    return error_set(w->error, w->name, line, NULL, 0, "%s: %s", what, tyn_status_name(status));
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

/* How much of light i comes through rectified maps. Whether there is room does not depend on the weights, or it would pop. */
static float rectified(const work *w, int32_t i)
{
    tyn_light light = shafts_light(&w->s->lights[i]);
    float weight = 0.0f;
    if (w->settings->rectify >= RENDER_PROJECTIVE && i < TYN_MAX_LIGHTS - w->s->light_count)
        weight = tyn_shadow_rectifiable(&light, &w->camera);
    return w->settings->rectify == RENDER_FORCED && weight > 0.0f ? 1.0f : weight;
}

static int make_config(work *w)
{
    const render_settings *r = w->settings;
    tyn_config *c = &w->config;
    int32_t width = r->width ? r->width : w->s->width, height = r->height ? r->height : w->s->height;
    tyn_status status = shafts_config(c, r, width, height);
    if (status != TYN_OK)
        return fail(w, 0, "image", status);
    if (r->rectify >= RENDER_PROJECTIVE)
        c->maps = (r->splits ? r->splits : 4) + 1;
    for (int32_t i = 0; i < w->s->light_count; i++) {
        c->maps = w->s->lights[i].point && c->maps < RENDER_FACES ? RENDER_FACES : c->maps;
        c->textured = w->s->lights[i].texture ? 1 : c->textured;
    }
    c->workers = pool_executor(w->threads)->workers;
    w->pixels = (size_t)width * (size_t)height;
    status = scene_camera_make(w->s, width, height, &w->camera);
    w->out->camera = w->camera;
    if (status != TYN_OK)
        return fail(w, w->s->camera.line, "camera", status);
    c->lights = w->s->light_count > 0 ? w->s->light_count : 1;
    for (int32_t i = 0; i < w->s->light_count; i++)
        c->lights += rectified(w, i) > 0.0f && rectified(w, i) < 1.0f;
    return 0;
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

static void set_light(work *w, int32_t i)
{
    tyn_light *l = &w->lights[i];
    *l = shafts_light(&w->s->lights[i]);
    if (w->s->lights[i].point) {
        l->shadow = w->out->lights[i].faces[0];
        l->more = &w->out->lights[i].faces[1];
        l->more_count = RENDER_FACES - 1;
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

/* Room for a map, and its stride: what is written to files has no gaps. NULL: no memory. */
static float *map_new(work *w, tyn_shadow *shadow)
{
    const size_t rows = (size_t)shadow->size,
                 bytes = w->settings->want_maps ? rows * sizeof(float) : (size_t)shafts_map_stride(shadow->size);
    float *map = bytes < SIZE_MAX / rows ? malloc(bytes * rows) : NULL;
    shadow->stride = (ptrdiff_t)bytes;
    w->out->shadow_bytes += map ? bytes * rows : 0;
    return map;
}

/* After the depth is known: a map that covers just what is seen makes the best of its texels. */
static int draw_shadow(work *w, int32_t i, const tyn_image *depth)
{
    const scene *s = w->s;
    tyn_light *l = &w->lights[i];
    render_light *r = &w->out->lights[i];
    int32_t faces = s->lights[i].point ? RENDER_FACES : 1;
    tyn_status status;
    for (int32_t k = 0; k < faces; k++)
        r->faces[k].size = w->config.shadow_size;
    r->count = faces;
    set_light(w, i);
    l->shadow.size = w->config.shadow_size;
    if (s->lights[i].point)
        status = tyn_shadow_fit_cube(r->faces, l->position, reach_from(s, l->position, s->camera.far_depth));
    else
        status = tyn_shadow_fit_scene(l, &w->camera, depth, s->meshes, s->mesh_count);
    if (status != TYN_OK)
        return fail(w, s->lights[i].line, "light", status);
    if (faces == 1)
        r->faces[0] = l->shadow;
    for (int32_t k = 0; k < faces; k++) {
        float **map = &r->maps[k];
        *map = map_new(w, &r->faces[k]);
        if (!*map)
            return error_memory(w->error);
        status = tyn_raster_shadow(w->raster, &r->faces[k], *map, s->meshes, s->mesh_count, pool_executor(w->threads), NULL,
                                   NULL, NULL);
        if (status != TYN_OK)
            return fail(w, s->lights[i].line, "shadow map", status);
        r->faces[k].depth = *map;
    }
    l->shadow = r->faces[0];
    return 0;
}

static int draw_rectified_maps(work *w, int32_t i, render_light *r)
{
    tyn_status status;
    for (int32_t k = 0; k < r->count; k++) {
        tyn_shadow blank = {0};
        blank.size = w->config.shadow_size;
        r->faces[k] = blank;
    }
    status = tyn_shadow_fit_rectified(r->faces, r->count, &w->lights[i], &w->camera, 0.0f, 0.0f);
    for (int32_t k = 0; k < r->count && status == TYN_OK; k++) {
        r->maps[k] = map_new(w, &r->faces[k]);
        if (!r->maps[k])
            return error_memory(w->error);
        status = tyn_raster_shadow(w->raster, &r->faces[k], r->maps[k], w->s->meshes, w->s->mesh_count,
                                   pool_executor(w->threads), NULL, NULL, NULL);
        r->faces[k].depth = r->maps[k];
    }
    return status == TYN_OK ? 0 : fail(w, w->s->lights[i].line, "rectified shadow map", status);
}

/* The maps of `--rectify projective`: before the one that the surfaces had, or, for a part of the light, as another light. */
static int draw_rectified(work *w, int32_t i)
{
    tyn_light *l = &w->lights[i];
    render_light *r = &w->out->lights[i];
    float weight = rectified(w, i), *map = r->maps[0];
    tyn_shadow fitted = r->faces[0];
    if (!(weight > 0.0f))
        return 0;
    if (weight < 1.0f) {
        r = &w->out->lights[w->light_count];
        l = &w->lights[w->light_count++];
        *l = w->lights[i];
        for (int c = 0; c < 3; c++) {
            w->lights[i].colour[c] *= 1.0f - weight;
            l->colour[c] *= weight;
        }
        map = NULL; /* the other's to free */
    } else {
        r->maps[0] = NULL;
    }
    r->count = w->settings->splits ? w->settings->splits : 4;
    r->maps[r->count] = map;
    if (draw_rectified_maps(w, i, r) != 0)
        return -1;
    r->faces[r->count] = fitted;
    l->shadow = r->faces[0];
    l->more = &r->faces[1];
    l->more_count = r->count;
    r->count++;
    return 0;
}

static int rectify(work *w)
{
    uint64_t start = clock_now(NULL);
    int status = 0;
    for (int32_t i = 0; i < w->s->light_count && w->settings->rectify >= RENDER_PROJECTIVE && !status; i++)
        status = draw_rectified(w, i);
    w->out->times.shadow_ns += clock_now(NULL) - start;
    return status;
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
    tyn_frame f;
    memset(&f, 0, sizeof f);
    f.camera = w->camera;
    f.depth = image_of(w, w->out->depth, TYN_DEPTH_F32);
    f.colour = image_of(w, w->out->surface, TYN_RGB_F32);
    f.lights = w->light_count ? w->lights : NULL;
    f.light_count = w->light_count;
    f.media = w->s->medium_count ? w->s->media : NULL;
    f.medium_count = w->s->medium_count;
    return shafts_draw(&w->config, &f, w->settings, w->threads, w->out, w->name, w->error);
}

static int allocate(work *w)
{
    const render_settings *r = w->settings;
    render_result *out = w->out;
    if (shafts_allocate(out, &w->config, r, w->error) != 0)
        return -1;
    out->depth = pixels_for(w, sizeof(float));
    /* Shafts can go over the surface in place; unless somebody needs that afterwards. */
    out->surface = r->want_surface || r->debug ? pixels_for(w, 3 * sizeof(float)) : out->radiance;
    return out->depth && out->surface ? 0 : error_memory(w->error);
}

int render_scene(const scene *s, const char *name, const render_settings *settings, pool *threads, render_result *result,
                 tool_error *error)
{
    work w;
    int status;
    memset(&w, 0, sizeof w);
    memset(result, 0, sizeof *result);
    w.s = s;
    w.light_count = s->light_count;
    w.name = name;
    w.settings = settings;
    w.threads = threads;
    w.out = result;
    w.error = error;
    pool_watch(threads, progress_jobs);
    status = make_config(&w) != 0 || allocate(&w) != 0 ||
             shafts_raster(&w.raster, &w.config, &w.raster_block, &result->raster_bytes, name, error) != 0 ||
             draw_surface(&w, "depth", NULL, 0) != 0 || draw_shadows(&w) != 0 ||
             draw_surface(&w, "surfaces", result->surface, s->light_count) != 0 || rectify(&w) != 0 || draw_shafts(&w) != 0;
    if (!settings->want_maps)
        render_free_maps(result);
    free(w.raster_block);
    if (result->surface == result->radiance)
        result->surface = NULL;
    if (status)
        render_free(result);
    progress_end();
    return status ? -1 : 0;
}

void render_free_maps(render_result *result)
{
    for (int i = 0; i < TYN_MAX_LIGHTS; i++)
        for (int k = 0; k < RENDER_MAPS; k++) {
            free(result->lights[i].maps[k]);
            result->lights[i].maps[k] = NULL;
            result->lights[i].faces[k].depth = NULL;
        }
}

void render_free(render_result *result)
{
    render_free_maps(result);
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
