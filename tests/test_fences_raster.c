/* test_fences_raster.c - meshes, textures, maps and pictures that end where memory does: see fence.h. */
#include <stdio.h>
#include <string.h>

#include "draw.h"
#include "easel.h"
#include "fence.h"
#include "test.h"

enum { W = 37, H = 23, CORNERS = 3 * 40 };

typedef struct drawing {
    easel e;
    tyn_mesh mesh[2];
    tyn_image texture, mask, depth; /* depth: for fits */
    tyn_light light;
    tyn_shadow map;
    float texels[41 * 19]; /* of `map` */
    tyn_status status;
    int64_t drawn;
    float matrix[16]; /* of a fit */
} drawing;

static void run_drawing(void *argument)
{
    drawing *w = argument;
    tyn_light fit = w->light;
    w->status = easel_draw(&w->e, w->mesh, 2);
    w->drawn = w->e.stats.drawn;
    if (w->status == TYN_OK)
        w->status = easel_shadow(&w->e, &w->map, w->texels, w->mesh, 2);
    if (w->status == TYN_OK)
        w->status = tyn_shadow_fit_scene(&fit, &w->e.surface.camera, &w->depth, w->mesh, 2);
    memcpy(w->matrix, fit.shadow.matrix, sizeof w->matrix);
}

static uint64_t drawing_outcome(const drawing *w)
{
    return rig_hash(w->e.depth.block, w->e.depth.size) ^ rig_hash(w->e.colour.block, w->e.colour.size) * 3 ^
           rig_hash(w->texels, sizeof w->texels) * 5 ^ rig_hash(w->matrix, sizeof w->matrix) * 7;
}

static void fence_drawing(fence_yard *yard, drawing *w)
{
    tyn_image images[2];
    fence_image(yard, &w->depth);
    fence_image(yard, &w->texture);
    fence_image(yard, &w->mask);
    images[0] = w->texture;
    images[1] = w->mask;
    for (int i = 0; i < 2; i++) {
        tyn_mesh *m = &w->mesh[i];
        const tyn_image *fenced = fence_copy(yard, images, sizeof images);
        m->positions = fence_copy(yard, m->positions, m->vertices * 3 * sizeof(float));
        m->indices = fence_copy(yard, m->indices, m->triangles * 3 * sizeof(uint32_t));
        if (m->texcoords)
            m->texcoords = fence_copy(yard, m->texcoords, m->vertices * 2 * sizeof(float));
        m->material.texture = m->material.texture ? &fenced[0] : NULL;
        m->material.mask = m->material.mask ? &fenced[1] : NULL;
    }
    fence_shadow(yard, &w->light.shadow);
    w->e.surface.lights = &w->light;
}

/* Random triangles, textured and not, in the light of a map; by all instruction sets the same as in plain memory. */
static int drawing_fenced(fence_side side, tyn_format format, tyn_format map_format)
{
    static float positions[3 * CORNERS], texcoords[2 * CORNERS], pixels[3 * 7 * 5], shadow[31 * 31], depth[W * H];
    static uint8_t holes[5 * 9];
    fence_yard yard = {side, 0, {{NULL, 0}}};
    drawing w;
    uint64_t plain = 0;
    int holds = 1;
    memset(&w, 0, sizeof w);
    for (int i = 0; i < 3 * CORNERS; i++)
        positions[i] = i % 3 == 2 ? test_random_float(-9, -0.5f) : test_random_float(-4, 4);
    for (int i = 0; i < 2 * CORNERS; i++)
        texcoords[i] = test_random_float(-2, 3);
    for (int i = 0; i < 3 * 7 * 5; i++)
        pixels[i] = test_random_float(0, 1);
    for (int i = 0; i < 5 * 9; i++)
        holes[i] = (uint8_t)test_random();
    for (int i = 0; i < 31 * 31; i++)
        shadow[i] = test_random_float(0, 1);
    for (int i = 0; i < W * H; i++)
        depth[i] = test_random_float(1, 9);
    w.texture = (tyn_image){pixels, 7, 5, 0, format};
    w.mask = (tyn_image){holes, 5, 9, 0, TYN_MASK8};
    w.depth = (tyn_image){depth, W, H, 0, TYN_DEPTH_F32};
    w.mesh[0] = w.mesh[1] = easel_mesh(positions, CORNERS / 3);
    w.mesh[1].texcoords = texcoords;
    w.mesh[1].material.texture = &w.texture;
    w.mesh[1].material.mask = &w.mask;
    w.light.direction[1] = -1;
    w.light.colour[0] = w.light.colour[1] = w.light.colour[2] = 3;
    w.light.shadow.depth = shadow;
    w.light.shadow.size = 31;
    w.light.shadow.format = map_format;
    easel_random_matrix(w.light.shadow.matrix, 0);
    easel_random_matrix(w.map.matrix, 0);
    w.map.size = 41;
    w.map.height = 19;
    for (int32_t isa = 0; isa <= TYN_ISA_WASM && holds; isa = isa ? 2 * isa : 1) { /* 0: the best, in plain memory */
        tyn_raster_config config = {64, 64, 64, 1, isa};
        if (isa && !(tyn_isa_available() & isa))
            continue;
        w.e = easel_new(W, H, 64, 1, 0);
        CHECK(tyn_raster_init(&w.e.raster, &config, w.e.raster, w.e.bytes) == TYN_OK);
        w.e.surface.lights = &w.light;
        w.e.surface.light_count = 1;
        if (isa == TYN_ISA_SCALAR)
            fence_drawing(&yard, &w);
        holds = fence_try(run_drawing, &w) && w.status == TYN_OK && w.drawn > 10 && easel_intact(&w.e);
        if (!isa)
            plain = drawing_outcome(&w);
        holds = holds && drawing_outcome(&w) == plain;
        if (!holds)
            printf("  %s\n", isa ? tyn_isa_name(isa) : "in plain memory");
        easel_free(&w.e);
    }
    fence_free(&yard);
    return holds;
}

static void check_drawings(void)
{
    static const tyn_format formats[] = {TYN_RGB8_LINEAR, TYN_RGB16_LINEAR, TYN_RGB_F32};
    TEST("rasterizer: nothing is read beside an input, nor written into it");
    for (int n = draw_rounds(6); n--;)
        CHECK(drawing_fenced(n & 1 ? FENCE_AFTER : FENCE_BEFORE, formats[n % 3], n & 2 ? TYN_DEPTH_U16 : TYN_DEPTH_F32));
}

/* ---- encoding -------------------------------------------------------------------------------------------------------- */

typedef struct encoding {
    tyn_image from, to;
    tyn_display display;
    tyn_status status;
} encoding;

static void run_encoding(void *argument)
{
    encoding *c = argument;
    c->status = tyn_encode(&c->from, &c->display, &c->to);
}

static void check_encoding(void)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    static float linear[3 * 70 * 3];
    static uint8_t out[12 * 70 * 3];
    TEST("tyn_encode: nothing is read beside the picture");
    for (int n = 0; n < 3 * 70 * 3; n++)
        linear[n] = test_random_float(0, 1);
    for (int32_t width = 1; width <= 70; width++)
        for (int n = 0; n < 8; n++) {
            fence_yard yard = {n & 1 ? FENCE_AFTER : FENCE_BEFORE, 0, {{NULL, 0}}};
            encoding c = {
                {linear, width, 3, 0, TYN_RGB_F32}, {out, width, 3, 0, formats[n / 2]}, {1, TYN_TONE_FILM, 1}, TYN_OK};
            fence_image(&yard, &c.from);
            CHECK(fence_try(run_encoding, &c) && c.status == TYN_OK);
            fence_free(&yard);
        }
}

void test_fences_raster(void)
{
    check_drawings();
    check_encoding();
}
