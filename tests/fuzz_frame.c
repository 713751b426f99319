/* fuzz_frame.c - any config and any frame to tyn_render, tyn_query and tyn_encode. An input is the size, kinds of content, and
 * what is changed in a plain frame. */
#include "fuzz.h"

#include <float.h>
#include <stddef.h>
#include <string.h>

enum { LIGHTS = 3, MORE = TYN_MAX_MAPS - 1, IMAGES = 5, POINTS = 5, MOST_BYTES = 4 << 20 };
enum { DEPTH, COLOUR, TARGET, SCATTER, SHARE };

/* Flags of an input. */
enum { IN_PLACE = 1, NO_COLOUR = 2, NO_TARGET = 4, NO_SCATTER = 8, NO_SHARE = 16, NO_MAPS = 32, AGAIN = 64, SCALAR = 128 };

typedef struct given {
    fuzz_bytes in;
    uint32_t flags, random;
    tyn_config config;
    tyn_frame frame;
    tyn_light lights[TYN_MAX_LIGHTS];
    tyn_shadow more[MORE];
    tyn_medium media[TYN_MAX_MEDIA];
    tyn_image textures[6];
    fuzz_picture picture[IMAGES];
    int has[IMAGES]; /* frame's image i is picture[i] */
    tyn_stats stats;
} given;

static tyn_image *image_of(tyn_frame *f, int i)
{
    tyn_image *images[IMAGES] = {&f->depth, &f->colour, &f->target, &f->scatter, &f->transmittance};
    return images[i];
}

/* ---- the plain case ---- */

/* Made once: to fit a map takes longer than a frame. */
static void plain_matrices(const tyn_camera *camera, tyn_light *lights, tyn_shadow cube[6])
{
    static tyn_shadow kept[LIGHTS], faces[6];
    static int made;
    for (int i = 0; i < LIGHTS && !made; i++) {
        tyn_light light = lights[i];
        if (light.kind == TYN_LIGHT_POINT)
            tyn_shadow_fit_cube(faces, light.position, 30);
        else
            tyn_shadow_fit(&light, camera, NULL, NULL);
        kept[i] = light.kind == TYN_LIGHT_POINT ? faces[0] : light.shadow;
    }
    made = 1;
    for (int i = 0; i < LIGHTS; i++)
        memcpy(lights[i].shadow.matrix, kept[i].matrix, sizeof kept[i].matrix);
    memcpy(cube, faces, sizeof faces);
}

static void plain_lights(given *g)
{
    tyn_shadow cube[6];
    for (int i = 0; i < TYN_MAX_LIGHTS; i++) {
        tyn_light *l = &g->lights[i];
        l->kind = (tyn_light_kind)(i % 3);
        l->position[0] = 1;
        l->position[1] = 3;
        l->direction[1] = -0.8f;
        l->direction[2] = -0.6f;
        l->colour[0] = l->colour[1] = l->colour[2] = 5;
        l->angle = 1;
        l->up[0] = 1;
        l->extent[0] = l->extent[1] = 4;
        l->shadow.size = 16 + i % 3;
        l->more = g->more;
        l->more_count = l->kind == TYN_LIGHT_POINT ? 5 : 0;
    }
    plain_matrices(&g->frame.camera, g->lights, cube);
    for (int k = 0; k < MORE; k++) {
        g->more[k].size = 9 + k;
        if (k < 5)
            memcpy(g->more[k].matrix, cube[k + 1].matrix, sizeof cube[k + 1].matrix);
    }
}

static void plain(given *g)
{
    const float eye[3] = {0.2f, 1.5f, 4}, at[3] = {0, 1, -6}, up[3] = {0, 1, 0};
    static const tyn_format formats[IMAGES] = {TYN_DEPTH_F32, TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_RGB_F32, TYN_RGB_F32};
    const int32_t width = 1 + (int32_t)(fuzz_byte(&g->in) % 40), height = 1 + (int32_t)(fuzz_byte(&g->in) % 30);
    tyn_frame *f = &g->frame;
    g->flags = fuzz_byte(&g->in);
    if (g->flags & (NO_COLOUR | NO_TARGET))
        g->flags &= ~(uint32_t)IN_PLACE;
    g->random = 1 + fuzz_byte(&g->in);
    g->config.width = width;
    g->config.height = height;
    g->config.lights = LIGHTS;
    g->config.maps = TYN_MAX_MAPS;
    g->config.shadow_size = 32;
    g->config.slices = 16;
    g->config.textured = 1;
    g->config.workers = 2;
    g->config.steps = 20;
    tyn_camera_look(&f->camera, eye, at, up, 1, 0.1f, 40, 40, 30);
    for (int i = 0; i < IMAGES; i++) {
        tyn_image *image = image_of(f, i);
        image->width = width;
        image->height = height;
        image->format = formats[i];
    }
    plain_lights(g);
    f->lights = g->lights;
    f->light_count = 1;
    for (int i = 0; i < TYN_MAX_MEDIA; i++) {
        g->media[i].scatter[0] = g->media[i].scatter[1] = g->media[i].scatter[2] = 0.04f;
        g->media[i].phase = (tyn_phase)(i % 3);
    }
    f->media = g->media;
    f->medium_count = 1;
    f->stats = &g->stats;
    for (int i = 0; i < 6; i++) {
        g->textures[i].width = 3 + i;
        g->textures[i].height = 2;
        g->textures[i].format = TYN_RGB8_LINEAR;
    }
}

/* ---- what may be changed ---- */

static void slots_image(fuzz_slots *s, tyn_image *image, int32_t *stride)
{
    fuzz_int_slots(s, &image->width, 1);
    fuzz_int_slots(s, &image->height, 1);
    fuzz_int_slots(s, &image->format, 1);
    fuzz_int_slots(s, stride, 1);
}

static void slots_frame(fuzz_slots *s, tyn_frame *f)
{
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
    fuzz_int_slots(s, &f->depth_coding.kind, 1);
    fuzz_floats(s, &f->depth_coding.scale, 1);
    fuzz_floats(s, &f->depth_coding.at_near, 1);
    fuzz_floats(s, &f->depth_coding.at_far, 1);
    fuzz_floats(s, &f->depth_coding.near_depth, 1);
    fuzz_floats(s, &f->depth_coding.far_depth, 1);
    fuzz_int_slots(s, &f->depth_coding.has_sky, 1);
    fuzz_floats(s, &f->depth_coding.sky, 1);
    fuzz_int_slots(s, &f->light_count, 1);
    fuzz_int_slots(s, &f->medium_count, 1);
    fuzz_floats(s, &f->display.exposure, 1);
    fuzz_int_slots(s, &f->display.tone, 1);
    fuzz_int_slots(s, &f->display.dither, 1);
    fuzz_int_slots(s, &f->debug, 1);
    fuzz_floats(s, &f->debug_x, 1);
    fuzz_floats(s, &f->debug_y, 1);
    fuzz_floats(s, &f->shaft_contrast, 1);
    fuzz_floats(s, &f->fog_scale, 1);
    fuzz_floats(s, &f->max_distance, 1);
}

/* Config: every field is 4 bytes; two of them are floats. */
static void slots_config(fuzz_slots *s, tyn_config *c)
{
    fuzz_int_slots(s, &c->width, 5);
    fuzz_floats(s, &c->break_threshold, 1);
    fuzz_floats(s, &c->tolerance, 1);
    fuzz_int_slots(s, &c->shadow_size, (int)((sizeof *c - offsetof(tyn_config, shadow_size)) / 4));
}

static void change(given *g)
{
    static fuzz_slots s;
    int32_t strides[IMAGES + LIGHTS + MORE + 6] = {0};
    int n = 0;
    s.count = 0;
    slots_config(&s, &g->config);
    slots_frame(&s, &g->frame);
    for (int i = 0; i < IMAGES; i++)
        slots_image(&s, image_of(&g->frame, i), &strides[n++]);
    for (int i = 0; i < LIGHTS; i++) {
        fuzz_light_slots(&s, &g->lights[i]);
        fuzz_floats(&s, &g->lights[i].scale, 1);
        fuzz_floats(&s, g->lights[i].tint, 3);
        fuzz_shadow_slots(&s, &g->lights[i].shadow, &strides[n++]);
    }
    for (int i = 0; i < TYN_MAX_MEDIA; i++) {
        fuzz_floats(&s, g->media[i].scatter, 3);
        fuzz_floats(&s, g->media[i].absorb, 3);
        fuzz_int_slots(&s, &g->media[i].phase, 1);
        fuzz_floats(&s, &g->media[i].g, 1);
    }
    for (int i = 0; i < MORE; i++)
        fuzz_shadow_slots(&s, &g->more[i], &strides[n++]);
    for (int i = 0; i < 6; i++)
        slots_image(&s, &g->textures[i], &strides[n++]);
    fuzz_edit(&g->in, &s);
    n = 0;
    for (int i = 0; i < IMAGES; i++)
        image_of(&g->frame, i)->stride = strides[n++];
    for (int i = 0; i < LIGHTS; i++)
        g->lights[i].shadow.stride = strides[n++];
    for (int i = 0; i < MORE; i++)
        g->more[i].stride = strides[n++];
    for (int i = 0; i < 6; i++)
        g->textures[i].stride = strides[n++];
}

/* ---- content ---- */

static void fill_picture(given *g, fuzz_picture *p)
{
    uint32_t kind = fuzz_byte(&g->in);
    int component = 1;
    switch (p->image->format) {
    case TYN_RGB_F32:
    case TYN_DEPTH_F32:
        component = 4;
        break;
    case TYN_DEPTH_U16:
    case TYN_RGB16_LINEAR:
        component = 2;
        break;
    default:
        break;
    }
    fuzz_fill(p->block, p->size, component, kind, &g->random);
    fuzz_keep(p);
}

static void make_content(given *g)
{
    static const uint32_t without[IMAGES] = {0, NO_COLOUR, NO_TARGET, NO_SCATTER, NO_SHARE};
    tyn_frame *f = &g->frame;
    for (int i = 0; i < IMAGES; i++) {
        tyn_image *image = image_of(f, i);
        if (g->flags & without[i] || (i == TARGET && g->flags & IN_PLACE)) {
            if (i == TARGET && !(g->flags & NO_TARGET))
                *image = f->colour;
            continue;
        }
        g->picture[i] = fuzz_picture_new(image);
        g->has[i] = 1;
        if (i <= COLOUR)
            fill_picture(g, &g->picture[i]);
    }
    for (int i = 0; i < 6; i++) {
        fuzz_picture p = fuzz_picture_new(&g->textures[i]);
        fill_picture(g, &p);
    }
    for (int i = 0; i < MORE; i++)
        fuzz_shadow_texels(&g->more[i], &g->random, fuzz_byte(&g->in));
    for (int i = 0; i < TYN_MAX_LIGHTS; i++) {
        tyn_light *l = &g->lights[i];
        l->textures = g->textures;
        if (i < LIGHTS && !(g->flags & NO_MAPS)) {
            fuzz_shadow_texels(&l->shadow, &g->random, fuzz_byte(&g->in));
        } else {
            l->shadow.size = 0;
            l->more_count = 0;
        }
    }
    if (fuzz_byte(&g->in) & 1)
        g->lights[0].shadow.tint = &g->textures[5];
}

/* ---- calls ---- */

static tyn_status render(given *g, size_t bytes, int fill, int reversed)
{
    uint8_t *block = fuzz_block(bytes), *before = fuzz_memory(bytes);
    tyn_context *context = NULL;
    int32_t workers = g->config.workers ? g->config.workers : 1;
    tyn_executor executor = fuzz_reversed(&workers);
    tyn_status status;
    memset(block, fill, bytes);
    FUZZ_CHECK(tyn_init(&context, &g->config, block, bytes - 1) == TYN_E_MEMORY);
    status = tyn_init(&context, &g->config, block, bytes);
    FUZZ_CHECK(status == TYN_OK || status == TYN_E_ISA);
    if (status != TYN_OK)
        return status;
    memcpy(before, block, bytes);
    g->frame.executor = reversed ? &executor : NULL;
    status = tyn_render(context, &g->frame);
    g->frame.executor = NULL;
    if (status != TYN_OK)
        FUZZ_CHECK(memcmp(before, block, bytes) == 0);
    return status;
}

static void check_pictures(given *g, tyn_status status)
{
    const tyn_frame *f = &g->frame;
    for (int i = 0; i < IMAGES; i++) {
        const tyn_image *image = image_of(&g->frame, i);
        if (!g->has[i])
            continue;
        if (status != TYN_OK || i == DEPTH || (i == COLOUR && !(g->flags & IN_PLACE))) {
            FUZZ_CHECK(fuzz_untouched(&g->picture[i]));
            continue;
        }
        FUZZ_CHECK(fuzz_framed(&g->picture[i]));
        if (image->format == TYN_RGB_F32 && (f->debug == TYN_DEBUG_NONE || i == SHARE))
            FUZZ_CHECK(fuzz_good(&g->picture[i], i == SHARE ? 1.0f : FLT_MAX));
    }
}

/* Another filling of the block, instruction set and order of jobs: the same bytes. */
static void again(given *g, size_t bytes)
{
    uint8_t *first[IMAGES] = {NULL};
    for (int i = 0; i < IMAGES; i++)
        if (g->has[i]) {
            first[i] = fuzz_memory(g->picture[i].size);
            memcpy(first[i], g->picture[i].block, g->picture[i].size);
            fuzz_restore(&g->picture[i]);
        }
    g->config.isa = g->flags & SCALAR ? 0 : TYN_ISA_SCALAR;
    FUZZ_CHECK(render(g, bytes, 0xff, 1) == TYN_OK);
    for (int i = 0; i < IMAGES; i++)
        if (g->has[i] && (i != SCATTER || g->frame.debug == TYN_DEBUG_NONE))
            FUZZ_CHECK(memcmp(first[i], g->picture[i].block, g->picture[i].size) == 0);
}

static void query(given *g)
{
    tyn_query_point points[POINTS];
    tyn_query_result results[POINTS];
    memset(results, 0x5a, sizeof results);
    for (int i = 0; i < POINTS; i++) {
        points[i].x = fuzz_float(&g->in);
        points[i].y = fuzz_float(&g->in);
        points[i].depth = fuzz_float(&g->in);
    }
    if (tyn_query(&g->frame, points, results, POINTS) != TYN_OK) {
        for (size_t i = 0; i < sizeof results; i++)
            FUZZ_CHECK(((const uint8_t *)results)[i] == 0x5a);
        return;
    }
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++) {
            FUZZ_CHECK(results[i].scatter[k] >= 0 && results[i].scatter[k] <= FLT_MAX);
            FUZZ_CHECK(results[i].transmittance[k] >= 0 && results[i].transmittance[k] <= 1);
        }
}

/* The surfaces' colour into the target, without a medium. */
static void encode(given *g)
{
    const tyn_image *from = &g->frame.colour;
    tyn_status status;
    if (!g->has[COLOUR] || !g->has[TARGET])
        return;
    fuzz_restore(&g->picture[COLOUR]);
    fuzz_restore(&g->picture[TARGET]);
    status = tyn_encode(from, &g->frame.display, &g->frame.target);
    FUZZ_CHECK(fuzz_untouched(&g->picture[COLOUR]));
    FUZZ_CHECK(status == TYN_OK ? fuzz_framed(&g->picture[TARGET]) : fuzz_untouched(&g->picture[TARGET]));
}

void fuzz_frame(const uint8_t *data, size_t size)
{
    static given g;
    size_t bytes = 0;
    tyn_status status;
    memset(&g, 0, sizeof g);
    g.in.at = data;
    g.in.left = size;
    plain(&g);
    change(&g);
    make_content(&g);
    status = tyn_measure(&g.config, &bytes);
    FUZZ_CHECK(status == TYN_OK ? bytes > 0 : bytes == 0);
    if (status == TYN_OK && bytes <= MOST_BYTES) {
        if (g.flags & SCALAR)
            g.config.isa = TYN_ISA_SCALAR;
        status = render(&g, bytes, 0, 0);
        check_pictures(&g, status);
        if (status == TYN_OK && g.flags & AGAIN)
            again(&g, bytes);
    }
    query(&g);
    encode(&g);
    fuzz_release();
}
