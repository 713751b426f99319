/* rig.c - see rig.h */
#include "rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stock.h"

const rig_way rig_ways[RIG_WAYS] = {{"slices", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
                                    {"slices in steps", TYN_METHOD_EPIPOLAR, TYN_RAYS_STEPS, TYN_GATHER_SHEAR, 1},
                                    {"march", TYN_METHOD_MARCH, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
                                    {"subsample", TYN_METHOD_SUBSAMPLE, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
                                    {"IVB, half size", TYN_METHOD_EPIPOLAR, TYN_RAYS_TREE, TYN_GATHER_IVB, 2},
                                    {"ED10", TYN_METHOD_EPIPOLAR, TYN_RAYS_SWEEP, TYN_GATHER_ED10, 1},
                                    {"prefiltered", TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
                                    {"hybrid", TYN_METHOD_HYBRID, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1},
                                    {"none", TYN_METHOD_NONE, TYN_RAYS_WORDS, TYN_GATHER_SHEAR, 1}};
void *rig_block(size_t bytes)
{
    void *block = NULL;
    return posix_memalign(&block, TYN_ALIGNMENT, bytes ? bytes : 1) ? NULL : block;
}

static void narrow(float *to, const double *from, int count)
{
    for (int i = 0; i < count; i++)
        to[i] = (float)from[i];
}

static void make_camera(tyn_camera *to, const oracle_camera *from)
{
    narrow(to->position, from->position, 3);
    narrow(to->right, from->right, 3);
    narrow(to->up, from->up, 3);
    narrow(to->forward, from->forward, 3);
    to->left_edge = (float)from->left_edge;
    to->right_edge = (float)from->right_edge;
    to->bottom_edge = (float)from->bottom_edge;
    to->top_edge = (float)from->top_edge;
    to->near_depth = (float)from->near_depth;
    to->far_depth = (float)from->far_depth;
}

static void make_meshes(rig *r, const oracle_scene *scene)
{
    static const uint32_t fan[6] = {0, 1, 2, 0, 2, 3};
    for (int k = 0; k < 3; k++) {
        r->bounds_min[k] = HUGE_VALF;
        r->bounds_max[k] = -HUGE_VALF;
    }
    for (int i = 0; i < scene->polygons; i++) {
        const oracle_polygon *p = &scene->polygon[i];
        tyn_mesh *mesh = &r->mesh[i];
        float *at = r->positions + 12 * i;
        for (int j = 0; j < p->corners; j++)
            for (int k = 0; k < 3; k++) {
                float x = at[3 * j + k] = (float)p->corner[j][k];
                r->bounds_min[k] = fminf(r->bounds_min[k], x);
                r->bounds_max[k] = fmaxf(r->bounds_max[k], x);
            }
        mesh->positions = at;
        mesh->vertices = (uint32_t)p->corners;
        mesh->indices = fan;
        mesh->triangles = (uint32_t)p->corners - 2;
        narrow(mesh->material.albedo, p->albedo, 3);
    }
    r->meshes = scene->polygons;
}

static void make_lights(rig *r, const oracle_scene *scene)
{
    static const tyn_light_kind kinds[] = {
        [ORACLE_DIRECTIONAL] = TYN_LIGHT_DIRECTIONAL, [ORACLE_SPOT] = TYN_LIGHT_SPOT, [ORACLE_POINT] = TYN_LIGHT_POINT};
    for (int i = 0; i < scene->lights; i++) {
        const oracle_light *from = &scene->light[i];
        tyn_light *to = &r->light[i];
        to->kind = kinds[from->kind];
        narrow(to->position, from->position, 3);
        narrow(to->direction, from->direction, 3);
        narrow(to->colour, from->colour, 3);
        to->angle = from->kind == ORACLE_SPOT ? (float)(2 * acos(from->cosine)) : 0.0f;
        if (from->texture.rgb) {
            tyn_image image = {from->texture.rgb, from->texture.width, from->texture.height, 0, TYN_RGB_F32};
            r->texture[i] = image;
            to->textures = &r->texture[i];
            to->texture_count = 1;
            narrow(to->up, from->texture.up, 3);
            narrow(to->extent, from->texture.extent, 2);
        }
    }
    for (int i = 0; i < scene->media; i++) {
        const oracle_medium *from = &scene->medium[i];
        narrow(r->medium[i].scatter, from->scatter, 3);
        narrow(r->medium[i].absorb, from->absorb, 3);
        r->medium[i].phase = from->phase;
        r->medium[i].g = (float)from->g;
    }
    r->lights = scene->lights;
    r->media = scene->media;
}

static int failed(tyn_status status, const char *call)
{
    if (status != TYN_OK)
        printf("rig: %s: %s\n", call, tyn_status_name(status));
    return status != TYN_OK;
}

/* The maps of a light: one, or a cube's six. */
static int draw_maps(rig *r, tyn_raster *raster, int i)
{
    const size_t texels = (size_t)r->shadow_size * (size_t)r->shadow_size;
    tyn_light *light = &r->light[i];
    tyn_shadow *face = r->face[i];
    int faces = light->kind == TYN_LIGHT_POINT ? 6 : 1, bad = 0;
    for (int f = 0; f < faces; f++) {
        face[f].size = r->shadow_size;
        face[f].depth = r->map[i] + texels * (size_t)f;
    }
    light->shadow = face[0];
    if (faces == 6) {
        bad = failed(tyn_shadow_fit_cube(face, light->position, r->camera.far_depth), "tyn_shadow_fit_cube");
        light->shadow = face[0];
        light->more = face + 1;
        light->more_count = 5;
    } else {
        bad = failed(tyn_shadow_fit(light, &r->camera, r->bounds_min, r->bounds_max), "tyn_shadow_fit");
        face[0] = light->shadow;
    }
    for (int f = 0; f < faces && !bad; f++)
        bad = failed(
            tyn_raster_shadow(raster, &face[f], r->map[i] + texels * (size_t)f, r->mesh, r->meshes, NULL, NULL, NULL, NULL),
            "tyn_raster_shadow");
    return !bad;
}

/* Shadow maps, then the picture without a medium. */
static int draw(rig *r, const oracle_scene *scene)
{
    tyn_raster_config config = {0};
    tyn_raster *raster;
    tyn_surface surface;
    size_t bytes = 0;
    void *block;
    int bad;
    config.width = r->width > r->shadow_size ? r->width : r->shadow_size;
    config.height = r->height > r->shadow_size ? r->height : r->shadow_size;
    if (failed(tyn_raster_measure(&config, &bytes), "tyn_raster_measure"))
        return 0;
    block = rig_block(bytes);
    bad = !block || failed(tyn_raster_init(&raster, &config, block, bytes), "tyn_raster_init");
    for (int i = 0; !bad && i < r->lights; i++)
        bad = !draw_maps(r, raster, i);
    memset(&surface, 0, sizeof surface);
    surface.camera = r->camera;
    surface.meshes = r->mesh;
    surface.mesh_count = r->meshes;
    surface.lights = r->light;
    surface.light_count = r->lights;
    surface.media = r->medium;
    surface.medium_count = r->media;
    narrow(surface.ambient, scene->ambient, 3);
    narrow(surface.background, scene->background, 3);
    surface.colour.pixels = r->colour;
    surface.depth.pixels = r->depth;
    surface.colour.width = surface.depth.width = r->width;
    surface.colour.height = surface.depth.height = r->height;
    surface.colour.format = TYN_RGB_F32;
    surface.depth.format = TYN_DEPTH_F32;
    bad = bad || failed(tyn_raster_surface(raster, &surface), "tyn_raster_surface");
    free(block);
    return !bad;
}

rig *rig_new(const oracle_scene *scene, int32_t shadow_size)
{
    rig *r = calloc(1, sizeof *r);
    size_t pixels = (size_t)scene->width * (size_t)scene->height, texels = (size_t)shadow_size * (size_t)shadow_size;
    int ready;
    if (!r)
        return NULL;
    r->width = scene->width;
    r->height = scene->height;
    r->shadow_size = shadow_size;
    r->mesh = calloc((size_t)scene->polygons + 1, sizeof *r->mesh);
    r->positions = calloc((size_t)scene->polygons + 1, 12 * sizeof *r->positions);
    r->depth = calloc(pixels, sizeof *r->depth);
    r->colour = calloc(pixels, 3 * sizeof *r->colour);
    r->scatter = calloc(pixels, 3 * sizeof *r->scatter);
    r->target = calloc(pixels, 4);
    ready = r->mesh && r->positions && r->depth && r->colour && r->scatter && r->target;
    for (int i = 0; i < scene->lights; i++) {
        r->map[i] = calloc(texels, (scene->light[i].kind == ORACLE_POINT ? 6 : 1) * sizeof *r->map[i]);
        ready = ready && r->map[i];
    }
    if (ready) {
        make_camera(&r->camera, &scene->camera);
        make_meshes(r, scene);
        make_lights(r, scene);
        ready = draw(r, scene);
    }
    if (!ready) {
        rig_free(r);
        return NULL;
    }
    return r;
}

void rig_free(rig *r)
{
    if (!r)
        return;
    for (int i = 0; i < ORACLE_LIGHTS; i++)
        free(r->map[i]);
    free(r->mesh);
    free(r->positions);
    free(r->depth);
    free(r->colour);
    free(r->scatter);
    free(r->target);
    free(r);
}

rig *rig_stock(const char *name, int width, int height, int32_t shadow_size)
{
    oracle_scene *scene = stock_new(name, width, height);
    rig *r = scene ? rig_new(scene, shadow_size) : NULL;
    model_free(scene);
    if (!r) {
        printf("no rig of %s\n", name);
        exit(1);
    }
    return r;
}

void rig_fill(const rig *r, tyn_config *config)
{
    config->shadow_size = r->shadow_size;
    config->lights = r->lights > 1 ? r->lights : 1;
    config->maps = 1;
    for (int i = 0; i < r->lights; i++) {
        config->maps = r->light[i].more_count + 1 > config->maps ? r->light[i].more_count + 1 : config->maps;
        config->textured |= r->light[i].texture_count > 0;
    }
}

tyn_config rig_config(const rig *r, tyn_method method, tyn_rays rays)
{
    tyn_config config;
    memset(&config, 0, sizeof config);
    config.width = r->width;
    config.height = r->height;
    rig_fill(r, &config);
    config.method = method;
    config.rays = rays;
    return config;
}

tyn_config rig_way_config(const rig *r, const rig_way *way)
{
    tyn_config config = rig_config(r, way->method, way->rays);
    config.gather = way->gather;
    config.downscale = way->downscale;
    return config;
}

tyn_frame rig_frame(rig *r)
{
    tyn_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.camera = r->camera;
    frame.depth.pixels = r->depth;
    frame.colour.pixels = r->colour;
    frame.scatter.pixels = r->scatter;
    frame.target.pixels = r->target;
    frame.depth.width = frame.colour.width = frame.scatter.width = frame.target.width = r->width;
    frame.depth.height = frame.colour.height = frame.scatter.height = frame.target.height = r->height;
    frame.depth.format = TYN_DEPTH_F32;
    frame.colour.format = frame.scatter.format = TYN_RGB_F32;
    frame.target.format = TYN_RGBA8_SRGB;
    frame.lights = r->light;
    frame.light_count = r->lights;
    frame.media = r->medium;
    frame.medium_count = r->media;
    frame.display.exposure = 1.0f;
    frame.display.tone = TYN_TONE_FILM;
    frame.stats = &r->stats;
    return frame;
}

tyn_context *rig_context(const tyn_config *config)
{
    size_t bytes = 0;
    tyn_context *context = NULL;
    void *block;
    if (failed(tyn_measure(config, &bytes), "tyn_measure"))
        return NULL;
    block = rig_block(bytes);
    if (block)
        memset(block, 0xa5, bytes); /* what a context finds in its block must not matter */
    if (!block || failed(tyn_init(&context, config, block, bytes), "tyn_init")) {
        free(block);
        return NULL;
    }
    return context;
}

tyn_status rig_render(rig *r, const tyn_config *config, const tyn_frame *frame)
{
    tyn_context *context = rig_context(config);
    tyn_status status = context ? tyn_render(context, frame) : TYN_E_MEMORY;
    (void)r;
    free(context);
    return status;
}

double rig_l1(const float *a, const float *b, size_t count)
{
    double gap = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        gap += fabs((double)a[i] - (double)b[i]);
        sum += fabs((double)b[i]);
    }
    return sum > 0 ? gap / sum : gap;
}

/* No fmax: gcc 12 breaks down over two of them in a loop, on AArch64. */
double rig_worst(const float *a, const float *b, size_t count)
{
    double worst = 0, most = 0;
    for (size_t i = 0; i < count; i++) {
        const double gap = fabs((double)a[i] - (double)b[i]);
        worst = gap <= worst || worst != worst ? worst : gap; /* NaN stays */
        most = (double)b[i] > most ? (double)b[i] : most;
    }
    return worst / most;
}

double rig_psnr(const uint8_t *a, const uint8_t *b, size_t pixels)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * pixels; i++)
        if (i % 4 != 3)
            sum += (double)((a[i] - b[i]) * (a[i] - b[i]));
    return sum > 0 ? 10 * log10(255.0 * 255.0 * 3.0 * (double)pixels / sum) : 99.0;
}

static uint64_t fnv(uint64_t hash, const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

uint64_t rig_hash(const void *data, size_t size)
{
    return fnv(0xcbf29ce484222325u, data, size);
}

uint64_t rig_hash_floats(const float *x, size_t count)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        uint8_t bytes[4];
        memcpy(&bits, x + i, sizeof bits);
        for (int k = 0; k < 4; k++)
            bytes[k] = (uint8_t)(bits >> (8 * k) & 255u);
        hash = fnv(hash, bytes, sizeof bytes);
    }
    return hash;
}

double rig_levels(tyn_format format)
{
    return format == TYN_DEPTH_U16 ? 65535.0 : format == TYN_DEPTH_U24 ? 16777215.0 : 0.0;
}

/* ---- scene depth, written and read again in double precision ---------------------------------------------------------- */
