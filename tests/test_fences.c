/* test_fences.c - frames whose inputs end where memory does: see fence.h. Every format, on random scenes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "fence.h"
#include "test.h"

enum { LIGHTS = 2, FACES = 6, POINTS = 21 };

/* A frame whose every input is of some format, in plain memory and then behind fences. */
typedef struct inputs {
    drawn d;
    void *depth, *colour, *maps[LIGHTS][FACES];
    tyn_light light[LIGHTS];
    tyn_shadow more[LIGHTS][FACES - 1];
    tyn_image texture[FACES];
    uint8_t pixels[FACES][12 * 7 * 5];
    tyn_query_point points[POINTS];
} inputs;

static void *halves(const float *from, size_t count, float scale)
{
    uint16_t *to = malloc(count * sizeof *to);
    if (!to)
        abort();
    for (size_t i = 0; i < count; i++) {
        float value = from[i] * scale;
        to[i] = (uint16_t)(value < 0 ? 0 : value > 65535 ? 65535 : value);
    }
    return to;
}

static void set_depth(inputs *in)
{
    tyn_frame *f = &in->d.frame;
    const size_t count = in->d.count / 3;
    uint32_t *words;
    switch (draw_one_of(3)) {
    case 0:
        in->depth = draw_copy(in->d.r->depth, count);
        break;
    case 1:
        f->depth.format = TYN_DEPTH_U16;
        f->depth_coding.scale = 0.001f;
        in->depth = halves(in->d.r->depth, count, 1000);
        break;
    default:
        f->depth.format = TYN_DEPTH_U24;
        f->depth_coding.scale = 1e-5f;
        in->depth = words = malloc(count * sizeof *words);
        if (!words)
            abort();
        for (size_t i = 0; i < count; i++)
            words[i] = (uint32_t)(in->d.r->depth[i] * 1e5f);
    }
    f->depth.pixels = in->depth;
}

static void set_colour(inputs *in)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    const tyn_display plain = {1, TYN_TONE_CLAMP, 0};
    tyn_image from = in->d.frame.colour, to = from;
    to.format = formats[draw_one_of(4)];
    to.pixels = in->colour = malloc(in->d.count / 3 * (size_t)tyn_format_bytes(to.format));
    CHECK(in->colour && tyn_encode(&from, &plain, &to) == TYN_OK);
    in->d.frame.colour = to;
}

static void set_textures(inputs *in, tyn_light *l)
{
    static const tyn_format formats[] = {TYN_RGB8_LINEAR, TYN_RGB16_LINEAR, TYN_RGB_F32};
    const tyn_format format = formats[draw_one_of(3)];
    uint32_t random = 1 + draw_one_of(1000);
    for (int i = 0; i < FACES; i++) {
        tyn_image image = {in->pixels[i], 1 + (int32_t)draw_one_of(7), 1 + (int32_t)draw_one_of(5), 0, format};
        for (size_t k = 0; k < sizeof in->pixels[i] / 4; k++) { /* bytes, halves and floats that are all good */
            float value = (float)(random = random * 1664525 + 1013904223) / 4294967296.0f;
            memcpy(in->pixels[i] + 4 * k, &value, 4);
        }
        in->texture[i] = image;
    }
    l->textures = in->texture;
    l->texture_count = l->kind == TYN_LIGHT_POINT ? FACES : 1;
    l->up[0] = 0.3f;
    l->up[1] = 0.9f;
    l->up[2] = 0.2f;
    l->extent[0] = l->extent[1] = 5;
    l->shadow.tint = draw_one_of(2) ? &in->texture[0] : NULL;
    in->d.config.textured = 1;
}

static inputs *inputs_new(void)
{
    inputs *in = calloc(1, sizeof *in);
    if (!in)
        abort();
    in->d = draw_one();
    set_depth(in);
    set_colour(in);
    for (int i = 0; i < in->d.r->lights; i++) {
        tyn_light *l = &in->light[i];
        const size_t count = (size_t)in->d.r->shadow_size * (size_t)in->d.r->shadow_size;
        const uint32_t half = draw_one_of(2);
        *l = in->d.r->light[i];
        for (int k = 0; k <= l->more_count; k++) {
            tyn_shadow *s = k ? &in->more[i][k - 1] : &l->shadow;
            if (k)
                *s = l->more[k - 1];
            in->maps[i][k] = half ? halves(s->depth, count, 65535) : draw_copy(s->depth, count);
            s->format = half ? TYN_DEPTH_U16 : TYN_DEPTH_F32;
            s->depth = in->maps[i][k];
        }
        l->more = l->more_count ? in->more[i] : NULL;
        if (draw_one_of(3) == 0)
            set_textures(in, l);
    }
    for (int i = 0; i < POINTS; i++) {
        tyn_query_point point = {(float)draw_between(-5, 60), (float)draw_between(-5, 50), (float)draw_between(0, 40)};
        in->points[i] = point;
    }
    in->d.frame.lights = in->light;
    return in;
}

static void inputs_free(inputs *in, int holds)
{
    for (int i = 0; i < LIGHTS; i++)
        for (int k = 0; k < FACES; k++)
            free(in->maps[i][k]);
    free(in->depth);
    free(in->colour);
    draw_done(&in->d, holds);
    free(in);
}

/* The frame with all that it points at behind fences. */
static tyn_frame fence_frame(fence_yard *yard, const inputs *in)
{
    tyn_frame f = in->d.frame;
    tyn_light light[LIGHTS];
    tyn_image texture[FACES], *textures;
    memcpy(light, in->light, sizeof light);
    memcpy(texture, in->texture, sizeof texture);
    fence_image(yard, &f.depth);
    fence_image(yard, &f.colour);
    for (int i = 0; i < FACES && texture[i].pixels; i++)
        fence_image(yard, &texture[i]);
    textures = fence_copy(yard, texture, sizeof texture);
    for (int i = 0; i < f.light_count; i++) {
        tyn_light *l = &light[i];
        tyn_shadow more[FACES - 1];
        fence_shadow(yard, &l->shadow);
        l->shadow.tint = l->shadow.tint ? textures : NULL;
        for (int k = 0; k < l->more_count; k++) {
            more[k] = l->more[k];
            fence_shadow(yard, &more[k]);
        }
        l->more = l->more_count ? fence_copy(yard, more, (size_t)l->more_count * sizeof *more) : NULL;
        l->textures = l->texture_count ? textures : NULL;
    }
    f.lights = fence_copy(yard, light, (size_t)f.light_count * sizeof *light);
    f.media = fence_copy(yard, f.media, (size_t)f.medium_count * sizeof *f.media);
    return f;
}

typedef struct call {
    const inputs *in;
    tyn_context *context;
    const tyn_frame *frame;
    const tyn_query_point *points;
    tyn_query_result results[POINTS];
    tyn_status status[2];
} call;

static void run_frame(void *argument)
{
    call *c = argument;
    c->status[0] = c->context ? tyn_render(c->context, c->frame) : TYN_E_MEMORY;
    c->status[1] = tyn_query(c->frame, c->points, c->results, POINTS);
}

static uint64_t outcome(const call *c)
{
    const rig *r = c->in->d.r;
    return rig_hash(r->scatter, c->in->d.count * sizeof *r->scatter) ^ rig_hash(r->target, c->in->d.count / 3 * 4) * 3 ^
           rig_hash(c->results, sizeof c->results) * 7;
}

static int fenced(inputs *in, fence_side side)
{
    fence_yard yard = {side, 0, {{NULL, 0}}};
    uint64_t plain;
    tyn_frame behind;
    call c;
    int holds;
    memset(&c, 0, sizeof c);
    c.in = in;
    c.frame = &in->d.frame;
    c.points = in->points;
    in->d.config.isa = 0;
    c.context = rig_context(&in->d.config);
    run_frame(&c);
    free(c.context);
    holds = c.status[0] == TYN_OK && c.status[1] == TYN_OK;
    plain = outcome(&c);
    behind = fence_frame(&yard, in);
    c.frame = fence_copy(&yard, &behind, sizeof behind);
    c.points = fence_copy(&yard, in->points, sizeof in->points);
    for (int32_t isa = 1; isa <= TYN_ISA_WASM && holds; isa *= 2) {
        if (!(tyn_isa_available() & isa))
            continue;
        in->d.config.isa = isa;
        c.context = rig_context(&in->d.config);
        memset(in->d.r->scatter, 0x5a, in->d.count * sizeof(float));
        holds = fence_try(run_frame, &c);
        if (!holds)
            printf("  a fault with %s\n", tyn_isa_name(isa));
        holds = holds && c.status[0] == TYN_OK && c.status[1] == TYN_OK && outcome(&c) == plain;
        free(c.context);
    }
    fence_free(&yard);
    return holds;
}

static void check_frames(void)
{
    TEST("frames: nothing is read beside an input, nor written into it");
    for (int n = draw_rounds(2); n--;) {
        inputs *in = inputs_new();
        int holds = fenced(in, FENCE_AFTER) && fenced(in, FENCE_BEFORE);
        inputs_free(in, holds);
    }
}

static void read_beside(void *argument)
{
    const volatile uint8_t *const *p = argument;
    (void)**p;
}

static void write_into(void *argument)
{
    uint8_t **p = argument;
    **p = 1;
}

/* They do hold. */
static void check_fence(void)
{
    static const uint8_t bytes[5] = {1, 2, 3, 4, 5};
    TEST("fences");
    for (int side = FENCE_AFTER; side <= FENCE_BEFORE; side++) {
        fence_yard yard = {(fence_side)side, 0, {{NULL, 0}}};
        uint8_t *copy = fence_copy(&yard, bytes, 5), *first = copy, *beside = side == FENCE_AFTER ? copy + 5 : copy - 1;
        CHECK(memcmp(copy, bytes, 5) == 0 && fence_try(read_beside, &first));
        CHECK(!fence_try(read_beside, &beside) && !fence_try(write_into, &first));
        fence_free(&yard);
    }
}

void test_fences(void)
{
    check_fence();
    check_frames();
}
