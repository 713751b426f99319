/* fuzz_raster.c - any meshes, cameras and lights to the rasterizer. An input is the size, counts, and what is changed in a
 * plain scene. */
#include "fuzz.h"

#include <float.h>
#include <stddef.h>
#include <string.h>

enum { MESHES = 3, LIGHTS = 3, MORE = TYN_MAX_MAPS - 1, MOST_VERTICES = 24, MOST_TRIANGLES = 20, MOST_BYTES = 4 << 20 };

typedef struct given {
    fuzz_bytes in;
    uint32_t random;
    int32_t width, height;
    tyn_raster_config config;
    tyn_surface surface;
    tyn_mesh mesh[MESHES];
    float positions[MESHES][3 * MOST_VERTICES], texcoords[MESHES][2 * MOST_VERTICES];
    uint32_t indices[MESHES][3 * MOST_TRIANGLES];
    tyn_image texture, mask;
    tyn_light lights[TYN_MAX_LIGHTS];
    tyn_shadow more[MORE], target; /* target: of the map that is drawn */
    tyn_medium media[TYN_MAX_MEDIA];
    fuzz_picture depth, colour;
    tyn_raster_stats stats;
} given;

/* ---- the plain case ---- */

static void plain_meshes(given *g)
{
    for (int i = 0; i < MESHES; i++) {
        tyn_mesh *m = &g->mesh[i];
        fuzz_fill(g->positions[i], sizeof g->positions[i], 4, 3, &g->random);
        fuzz_fill(g->texcoords[i], sizeof g->texcoords[i], 4, 19, &g->random);
        for (int k = 0; k < 3 * MOST_VERTICES; k++)
            g->positions[i][k] = 8 * g->positions[i][k] - (k % 3 == 2 ? 9.0f : 4.0f);
        m->vertices = 3 + fuzz_byte(&g->in) % (MOST_VERTICES - 2);
        m->triangles = fuzz_byte(&g->in) % (MOST_TRIANGLES + 1);
        for (uint32_t k = 0; k < 3 * MOST_TRIANGLES; k++)
            g->indices[i][k] = (k + k / 3 * 5) % m->vertices;
        m->material.albedo[0] = m->material.albedo[1] = m->material.albedo[2] = 0.5f;
    }
}

static void plain(given *g)
{
    const float eye[3] = {0, 0, 2}, at[3] = {0, 0, -6}, up[3] = {0, 1, 0};
    tyn_surface *s = &g->surface;
    g->width = 1 + (int32_t)(fuzz_byte(&g->in) % 40);
    g->height = 1 + (int32_t)(fuzz_byte(&g->in) % 30);
    g->random = 1 + fuzz_byte(&g->in);
    g->config.width = g->config.height = 64;
    g->config.batch = 64;
    g->config.workers = 1;
    tyn_camera_look(&s->camera, eye, at, up, 1, 0.1f, 40, 40, 30);
    plain_meshes(g);
    s->meshes = g->mesh;
    s->mesh_count = 1;
    for (int i = 0; i < TYN_MAX_LIGHTS; i++) {
        tyn_light *l = &g->lights[i];
        l->kind = (tyn_light_kind)(i % 3);
        l->position[1] = 5;
        l->direction[1] = -1;
        l->colour[0] = l->colour[1] = l->colour[2] = 5;
        l->angle = 1;
        l->up[0] = 1;
        l->extent[0] = l->extent[1] = 4;
        l->more = g->more;
        l->shadow.size = i < LIGHTS ? 16 : 0;
        for (int k = 0; k < 16; k += 5)
            l->shadow.matrix[k] = k < 15 ? 0.1f : 1;
    }
    for (int i = 0; i < MORE; i++) {
        g->more[i] = g->lights[0].shadow;
        g->more[i].size = 5 + i;
    }
    g->target = g->lights[0].shadow;
    g->target.size = 23;
    s->lights = g->lights;
    s->light_count = 1;
    s->media = g->media;
    s->ambient[0] = s->background[1] = 0.2f;
    s->depth.width = s->colour.width = g->width;
    s->depth.height = s->colour.height = g->height;
    s->depth.format = TYN_DEPTH_F32;
    s->colour.format = TYN_RGB_F32;
    s->stats = &g->stats;
    g->texture.width = g->mask.height = 4;
    g->texture.height = g->mask.width = 3;
    g->texture.format = TYN_RGB8_LINEAR;
    g->mask.format = TYN_MASK8;
}

/* ---- what may be changed ---- */

static void slots_surface(fuzz_slots *s, given *g)
{
    tyn_surface *f = &g->surface;
    fuzz_int_slots(s, &f->camera.kind, 1);
    fuzz_floats(s, f->camera.position, 3);
    fuzz_floats(s, f->camera.right, 3);
    fuzz_floats(s, f->camera.up, 3);
    fuzz_floats(s, f->camera.forward, 3);
    fuzz_floats(s, &f->camera.left_edge, 1);
    fuzz_floats(s, &f->camera.right_edge, 1);
    fuzz_floats(s, &f->camera.bottom_edge, 1);
    fuzz_floats(s, &f->camera.top_edge, 1);
    fuzz_floats(s, &f->camera.near_depth, 1);
    fuzz_floats(s, &f->camera.far_depth, 1);
    fuzz_floats(s, f->ambient, 3);
    fuzz_floats(s, f->background, 3);
    fuzz_floats(s, &f->shadow_bias, 1);
    fuzz_int_slots(s, &f->light_count, 1);
    fuzz_int_slots(s, &f->medium_count, 1);
    for (int i = 0; i < 2; i++) {
        fuzz_floats(s, g->media[i].scatter, 3);
        fuzz_floats(s, g->media[i].absorb, 3);
        fuzz_int_slots(s, &g->media[i].phase, 1);
    }
    for (int i = 0; i < MESHES; i++)
        fuzz_floats(s, g->mesh[i].material.albedo, 3);
}

static void change(given *g)
{
    static fuzz_slots s;
    int32_t strides[4 + LIGHTS + MORE + 1] = {0}, mesh_count = 1;
    tyn_image *images[4] = {&g->surface.depth, &g->surface.colour, &g->texture, &g->mask};
    int n = 0;
    s.count = 0;
    fuzz_int_slots(&s, &g->config, (int)(sizeof g->config / 4));
    slots_surface(&s, g);
    for (int i = 0; i < MESHES; i++) {
        fuzz_floats(&s, g->positions[i], 30);
        fuzz_floats(&s, g->texcoords[i], 8);
        fuzz_int_slots(&s, g->indices[i], 9);
    }
    fuzz_int_slots(&s, &mesh_count, 1);
    fuzz_shadow_slots(&s, &g->target, &strides[4 + LIGHTS + MORE]);
    for (int i = 0; i < 4; i++) {
        fuzz_int_slots(&s, &images[i]->width, 1);
        fuzz_int_slots(&s, &images[i]->height, 1);
        fuzz_int_slots(&s, &images[i]->format, 1);
        fuzz_int_slots(&s, &strides[n++], 1);
    }
    for (int i = 0; i < LIGHTS; i++) {
        fuzz_light_slots(&s, &g->lights[i]);
        fuzz_shadow_slots(&s, &g->lights[i].shadow, &strides[n++]);
    }
    for (int i = 0; i < MORE; i++)
        fuzz_shadow_slots(&s, &g->more[i], &strides[n++]);
    fuzz_edit(&g->in, &s);
    g->surface.mesh_count = mesh_count > MESHES ? MESHES : mesh_count;
    n = 0;
    for (int i = 0; i < 4; i++)
        images[i]->stride = strides[n++];
    for (int i = 0; i < LIGHTS; i++)
        g->lights[i].shadow.stride = strides[n++];
    for (int i = 0; i < MORE; i++)
        g->more[i].stride = strides[n++];
    g->target.stride = strides[n];
}

/* ---- content ---- */

static const void *exact(const void *from, size_t bytes)
{
    void *to = fuzz_memory(bytes);
    memcpy(to, from, bytes);
    return to;
}

static void make_content(given *g)
{
    const uint32_t flags = fuzz_byte(&g->in);
    fuzz_picture texture = fuzz_picture_new(&g->texture), mask = fuzz_picture_new(&g->mask);
    fuzz_fill(texture.block, texture.size, g->texture.format == TYN_RGB_F32 ? 4 : 1, fuzz_byte(&g->in), &g->random);
    fuzz_fill(mask.block, mask.size, 1, 3, &g->random);
    g->depth = fuzz_picture_new(&g->surface.depth);
    g->colour = fuzz_picture_new(&g->surface.colour);
    for (int i = 0; i < MESHES; i++) {
        tyn_mesh *m = &g->mesh[i];
        m->positions = exact(g->positions[i], m->vertices * 3 * sizeof(float));
        m->texcoords = flags & 1 ? NULL : exact(g->texcoords[i], m->vertices * 2 * sizeof(float));
        m->indices = exact(g->indices[i], m->triangles * 3 * sizeof(uint32_t));
        m->material.texture = flags & 2 ? &g->texture : NULL;
        m->material.mask = flags & 4 ? &g->mask : NULL;
    }
    for (int i = 0; i < MORE; i++)
        fuzz_shadow_texels(&g->more[i], &g->random, fuzz_byte(&g->in));
    for (int i = 0; i < TYN_MAX_LIGHTS; i++) {
        g->lights[i].textures = &g->texture;
        if (i < LIGHTS && !(flags & 8))
            fuzz_shadow_texels(&g->lights[i].shadow, &g->random, fuzz_byte(&g->in));
        else
            g->lights[i].more_count = 0;
        if (g->lights[i].texture_count > 1) /* there is one */
            g->lights[i].texture_count = -1;
    }
    if (flags & 16)
        g->surface.colour.pixels = NULL;
}

/* ---- calls ---- */

static tyn_raster *make(const tyn_raster_config *config, int fill)
{
    size_t bytes = 0;
    tyn_raster *raster = NULL;
    tyn_status status = tyn_raster_measure(config, &bytes);
    uint8_t *block;
    FUZZ_CHECK(status == TYN_OK ? bytes > 0 : bytes == 0);
    if (status != TYN_OK || bytes > MOST_BYTES)
        return NULL;
    block = fuzz_block(bytes);
    memset(block, fill, bytes);
    FUZZ_CHECK(tyn_raster_init(&raster, config, block, bytes - 1) == TYN_E_MEMORY && raster == NULL);
    status = tyn_raster_init(&raster, config, block, bytes);
    FUZZ_CHECK(status == TYN_OK || status == TYN_E_ISA);
    return raster;
}

static void check_depth(given *g)
{
    const tyn_image *image = g->depth.image;
    const ptrdiff_t apart = image->stride ? image->stride : (ptrdiff_t)image->width * 4;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            float value;
            memcpy(&value, (const char *)image->pixels + y * apart + 4 * x, sizeof value);
            FUZZ_CHECK(value >= 0 && value <= g->surface.camera.far_depth);
        }
}

static void draw_surface(given *g, tyn_raster *raster, tyn_raster *other, const tyn_executor *executor)
{
    const int coloured = g->surface.colour.pixels != NULL;
    uint8_t *depth, *colour;
    tyn_status status = tyn_raster_surface(raster, &g->surface);
    if (status != TYN_OK) {
        FUZZ_CHECK(fuzz_untouched(&g->depth) && fuzz_untouched(&g->colour));
        return;
    }
    FUZZ_CHECK(fuzz_framed(&g->depth));
    FUZZ_CHECK(coloured ? fuzz_framed(&g->colour) && fuzz_good(&g->colour, FLT_MAX) : fuzz_untouched(&g->colour));
    check_depth(g);
    depth = fuzz_memory(g->depth.size);
    colour = fuzz_memory(g->colour.size);
    memcpy(depth, g->depth.block, g->depth.size);
    memcpy(colour, g->colour.block, g->colour.size);
    fuzz_restore(&g->depth);
    fuzz_restore(&g->colour);
    g->surface.executor = executor;
    FUZZ_CHECK(tyn_raster_surface(other, &g->surface) == TYN_OK);
    FUZZ_CHECK(memcmp(depth, g->depth.block, g->depth.size) == 0);
    FUZZ_CHECK(memcmp(colour, g->colour.block, g->colour.size) == 0);
}

static void draw_shadow(given *g, tyn_raster *raster, tyn_raster *other, const tyn_executor *executor)
{
    tyn_shadow *t = &g->target;
    int32_t height = t->height ? t->height : t->size;
    const int here = t->size > 0 && t->size <= 64 && height > 0 && height <= 64;
    ptrdiff_t apart = t->stride < 0 ? -t->stride : t->stride;
    float *map[2], *first[2];
    tyn_status status;
    size_t bytes;
    if (!here && t->size > 64 && t->size <= TYN_MAX_SHADOW) /* legal, but there is no room here */
        t->size = 0;
    if (!here && height > 64 && height <= TYN_MAX_SHADOW)
        t->height = -1;
    if (apart > 1024)
        t->stride = apart = 0;
    apart = apart ? apart : here ? 4 * (ptrdiff_t)t->size : 0;
    bytes = here ? (size_t)(apart * height) : 0;
    for (int i = 0; i < 2; i++) {
        map[i] = fuzz_memory(bytes);
        memset(map[i], 0x5a, bytes);
        first[i] = t->stride < 0 && here ? (float *)(void *)((uint8_t *)map[i] + apart / 4 * 4 * (height - 1)) : map[i];
    }
    status = tyn_raster_shadow(raster, t, first[0], g->mesh, g->surface.mesh_count, NULL, NULL, NULL, &g->stats);
    if (status != TYN_OK) {
        FUZZ_CHECK(memcmp(map[0], map[1], bytes) == 0);
        return;
    }
    FUZZ_CHECK(bytes > 0);
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < apart / 4; x++) {
            const float texel = map[0][apart / 4 * y + x];
            FUZZ_CHECK(x < t->size ? texel >= 0 && texel <= 1 : texel > 1);
        }
    FUZZ_CHECK(tyn_raster_shadow(other, t, first[1], g->mesh, g->surface.mesh_count, executor, NULL, NULL, NULL) == TYN_OK);
    FUZZ_CHECK(memcmp(map[0], map[1], bytes) == 0);
}

void fuzz_raster(const uint8_t *data, size_t size)
{
    static given g;
    tyn_raster *raster, *other;
    tyn_raster_config second = {64, 64, 4096, 3, TYN_ISA_SCALAR};
    int32_t workers = 3;
    tyn_executor executor = fuzz_reversed(&workers);
    memset(&g, 0, sizeof g);
    g.in.at = data;
    g.in.left = size;
    plain(&g);
    change(&g);
    make_content(&g);
    raster = make(&g.config, 0);
    other = make(&second, 0xff);
    if (raster && other) {
        if (g.config.width >= 64 && g.config.height >= 64) {
            draw_surface(&g, raster, other, &executor);
            draw_shadow(&g, raster, other, &executor);
        } else { /* what does not fit into the one may into the other */
            draw_surface(&g, raster, raster, NULL);
            draw_shadow(&g, raster, raster, NULL);
        }
    }
    fuzz_release();
}
