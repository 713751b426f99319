/* post.c */
#include "post.h"
#include "progress.h"
#include "relief.h"
#include "shafts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct job {
    foreign *f;
    const char *name;
    const render_settings *settings;
    pool *threads;
    render_result *out;
    tool_error *error;
    tyn_config config;
    tyn_frame frame;
    tyn_light lights[TYN_MAX_LIGHTS];
    tyn_raster *raster;
    void *raster_block;
    uint8_t *known; /* of out->depth */
} job;

static int fail(const job *j, int32_t line, const char *what, tyn_status status)
{
    return error_set(j->error, j->name, line, NULL, 0, "%s: %s", what, tyn_status_name(status));
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static int make_config(job *j)
{
    const scene *s = &j->f->s;
    tyn_config *c = &j->config;
    int32_t texels = 1;
    tyn_status status = shafts_config(c, j->settings, s->width, s->height);
    if (status != TYN_OK)
        return fail(j, 0, "image", status);
    for (int32_t i = 0; i < s->light_count; i++) {
        foreign_light *l = &j->f->lights[i];
        if (l->from_depth) {
            l->size = l->size ? l->size : c->shadow_size;
            l->count = s->lights[i].point ? RENDER_FACES : 1;
            texels = larger(texels, l->size);
        }
        c->maps = larger(c->maps, l->count);
        c->textured = s->lights[i].texture ? 1 : c->textured;
        for (int32_t k = 0; k < l->count; k++) {
            texels = larger(texels, larger(l->maps[k].size, l->maps[k].height));
            c->textured = l->maps[k].tint ? 1 : c->textured;
        }
    }
    c->shadow_size = texels;
    c->lights = s->light_count > 0 ? s->light_count : 1;
    c->workers = pool_executor(j->threads)->workers;
    return 0;
}

/* Depth as it came, unless it has to be known here: for the holes in it, or to make shadows of it. */
static int make_depth(job *j)
{
    foreign *f = j->f;
    size_t count = (size_t)f->s.width * (size_t)f->s.height;
    int wanted = f->has_unknown;
    for (int32_t i = 0; i < f->s.light_count; i++)
        wanted |= f->lights[i].from_depth;
    j->frame.depth = f->depth;
    j->frame.depth_coding = f->coding;
    if (!wanted)
        return 0;
    j->out->depth = malloc(count * sizeof(float));
    j->known = malloc(count);
    if (!j->out->depth || !j->known || relief_depths(f, j->out->depth, j->known) != 0)
        return error_memory(j->error);
    j->frame.depth.pixels = j->out->depth;
    j->frame.depth.format = TYN_DEPTH_F32;
    memset(&j->frame.depth_coding, 0, sizeof j->frame.depth_coding);
    return 0;
}

/* The farthest corner of what the camera can see. */
static float reach_from(const tyn_camera *c, const float position[3])
{
    double most = 0.0;
    for (int i = 0; i < 4; i++) {
        double x = (double)(i & 1 ? c->right_edge : c->left_edge), y = (double)(i & 2 ? c->top_edge : c->bottom_edge);
        double size = c->kind == TYN_CAMERA_ORTHOGRAPHIC ? 1.0 : (double)c->far_depth, sum = 0.0;
        for (int k = 0; k < 3; k++) {
            double d = (double)c->position[k] - (double)position[k] + (double)c->far_depth * (double)c->forward[k] +
                       size * (x * (double)c->right[k] + y * (double)c->up[k]);
            sum += d * d;
        }
        most = sum > most ? sum : most;
    }
    return (float)sqrt(most);
}

static int draw_shadow(job *j, int32_t i, const tyn_mesh *mesh)
{
    foreign_light *l = &j->f->lights[i];
    tyn_light *light = &j->lights[i];
    int32_t line = j->f->s.lights[i].line;
    tyn_status status;
    for (int32_t k = 0; k < l->count; k++)
        l->maps[k].size = l->size;
    light->shadow = l->maps[0];
    if (l->count == RENDER_FACES) {
        status = tyn_shadow_fit_cube(l->maps, light->position, reach_from(&j->frame.camera, light->position));
    } else {
        status = tyn_shadow_fit_scene(light, &j->frame.camera, &j->frame.depth, mesh, 1);
        l->maps[0] = light->shadow;
    }
    for (int32_t k = 0; k < l->count && status == TYN_OK; k++) {
        tyn_image *map = scene_add_image(&j->f->s, l->size, l->size, TYN_DEPTH_F32);
        if (!map)
            return error_memory(j->error);
        status = tyn_raster_shadow(j->raster, &l->maps[k], map->pixels, mesh, 1, pool_executor(j->threads), NULL, NULL, NULL);
        l->maps[k].depth = map->pixels;
    }
    return status == TYN_OK ? 0 : fail(j, line, "shadow depth", status);
}

static int draw_shadows(job *j)
{
    foreign *f = j->f;
    int32_t first = -1;
    uint64_t start = clock_now(NULL);
    for (int32_t i = 0; i < f->s.light_count; i++) {
        const foreign_light *l = &f->lights[i];
        if (!l->from_depth)
            continue;
        if (!j->raster &&
            shafts_raster(&j->raster, &j->config, &j->raster_block, &j->out->raster_bytes, j->name, j->error) != 0)
            return -1;
        progress_stage("shadow maps");
        /* Lights that want the same surface share it. */
        if (first < 0 || memcmp(&l->jump, &f->lights[first].jump, sizeof l->jump) != 0 ||
            memcmp(&l->thickness, &f->lights[first].thickness, sizeof l->thickness) != 0) {
            if (relief_mesh(f, j->out->depth, j->known, l->jump, l->thickness) != 0)
                return error_memory(j->error);
            first = i;
        }
        if (draw_shadow(j, i, &f->s.meshes[f->s.mesh_count - 1]) != 0)
            return -1;
    }
    j->out->times.shadow_ns = clock_now(NULL) - start;
    return 0;
}

static void set_lights(job *j)
{
    for (int32_t i = 0; i < j->f->s.light_count; i++) {
        const foreign_light *l = &j->f->lights[i];
        if (l->count == 0)
            continue;
        j->lights[i].shadow = l->maps[0];
        j->lights[i].more = l->count > 1 ? &l->maps[1] : NULL;
        j->lights[i].more_count = l->count - 1;
    }
}

static void set_frame(job *j)
{
    foreign *f = j->f;
    tyn_frame *to = &j->frame;
    to->camera = f->camera;
    to->colour = f->colour;
    to->lights = f->s.light_count ? j->lights : NULL;
    to->light_count = f->s.light_count;
    to->media = f->s.medium_count ? f->s.media : NULL;
    to->medium_count = f->s.medium_count;
    to->shaft_contrast = f->shaft_contrast;
    to->fog_scale = f->fog_scale;
    to->max_distance = f->max_distance;
    for (int32_t i = 0; i < f->s.light_count; i++)
        j->lights[i] = shafts_light(&f->s.lights[i]);
}

int post_frame(foreign *f, const char *name, const render_settings *settings, pool *threads, render_result *result,
               tool_error *error)
{
    job j;
    int status;
    memset(&j, 0, sizeof j);
    memset(result, 0, sizeof *result);
    j.f = f;
    j.name = name;
    j.settings = settings;
    j.threads = threads;
    j.out = result;
    j.error = error;
    pool_watch(threads, progress_jobs);
    set_frame(&j);
    status = make_config(&j) != 0 || shafts_allocate(result, &j.config, settings, error) != 0 || make_depth(&j) != 0 ||
             draw_shadows(&j) != 0;
    if (!status) {
        set_lights(&j);
        status = shafts_draw(&j.config, &j.frame, settings, threads, result, name, error);
    }
    free(j.raster_block);
    free(j.known);
    if (status)
        render_free(result);
    progress_end();
    return status ? -1 : 0;
}
