/* test_art.c - the art controls: each method and tyn_query against what plain physics adds up to. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 24, H = 18, PIXELS = W * H, COUNT = 3 * PIXELS };

/* Zeros everywhere are physics. */
typedef struct art {
    const char *name;
    float scale, tint[3], contrast, fog, distance;
} art;

static const art arts[] = {
    {"nothing", 0, {0, 0, 0}, 0, 0, 0},
    {"half the light", 0.5f, {0, 0, 0}, 0, 0, 0},
    {"none of it", -1, {0, 0, 0}, 0, 0, 0},
    {"tint", 3, {1, 0, 0.25f}, 0, 0, 0},
    {"soft shadows", 0, {0, 0, 0}, 0.4f, 0, 0},
    {"hard shadows", 0, {0, 0, 0}, 1.5f, 0, 0},
    {"no shadows", 0, {0, 0, 0}, -1, 0, 0},
    {"thin fog", 0, {0, 0, 0}, 0, 0.3f, 0},
    {"no fog", 0, {0, 0, 0}, 0, -2, 0},
    {"the first seven metres", 0, {0, 0, 0}, 0, 0, 7},
    {"an end behind everything", 0, {0, 0, 0}, 0, 0, 1e9f},
    {"all at once", 2, {0.5f, 1, 0.1f}, 0.7f, 2.5f, 9},
};
enum { ARTS = (int)(sizeof arts / sizeof *arts) };

static const char *const names[] = {"sun ahead", "sun off the left", "lamp in view", "lamp off the left", "bulb in view"};
enum { NAMES = (int)(sizeof names / sizeof *names) };

static double factor(float control)
{
    return control > 0 ? (double)control : control < 0 ? 0 : 1;
}

static double light_factor(const art *a, int c)
{
    double white = a->tint[0] + a->tint[1] + a->tint[2] > 0 ? (double)a->tint[c] : 1;
    return factor(a->scale) * white;
}

static void put(const art *a, tyn_frame *frame, tyn_light *light)
{
    light->scale = a->scale;
    memcpy(light->tint, a->tint, sizeof light->tint);
    frame->shaft_contrast = a->contrast;
    frame->fog_scale = a->fog;
    frame->max_distance = a->distance;
}

/* Metres of a pixel's ray per metre of depth. */
static double ray_length(const tyn_camera *c, int i)
{
    double x = (double)c->left_edge + (i % W + 0.5) / W * (double)(c->right_edge - c->left_edge);
    double y = (double)c->top_edge - (i / W + 0.5) / H * (double)(c->top_edge - c->bottom_edge);
    return sqrt(1 + x * x + y * y);
}

static tyn_image panes[6];

/* A rig's light through coloured panes. */
static void colour(tyn_light *light)
{
    static const uint8_t texel[12] = {255, 40, 0, 20, 240, 10, 0, 80, 255, 200, 200, 200};
    for (int i = 0; i < 6; i++) {
        tyn_image image = {(void *)(uintptr_t)texel, 2, 2, 0, TYN_RGB8_LINEAR};
        panes[i] = image;
    }
    light->textures = panes;
    light->texture_count = light->kind == TYN_LIGHT_POINT ? 6 : 1;
    light->up[1] = 1;
    light->extent[0] = light->extent[1] = 20;
}

/* ---- pictures ------------------------------------------------------------------------------------------------------- */

static float shadowed[COUNT], open[COUNT], wanted[COUNT], seen[PIXELS];
static double left[COUNT]; /* transmittance */

/* What physics gives to the depth that the control leaves: with shadows, without, and what is left of the surface. */
static void plain(rig *r, const tyn_config *config, const art *a)
{
    tyn_frame frame = rig_frame(r);
    tyn_light light = r->light[0];
    for (int i = 0; i < PIXELS; i++) {
        double length = ray_length(&r->camera, i), s = (double)r->depth[i] * length;
        s = a->distance > 0 ? fmin(s, (double)a->distance) : s;
        seen[i] = (float)(s / length);
        for (int c = 0; c < 3; c++) {
            double sigma = 0;
            for (int k = 0; k < r->media; k++)
                sigma += (double)(r->medium[k].scatter[c] + r->medium[k].absorb[c]);
            left[3 * i + c] = exp(-sigma * factor(a->fog) * s);
        }
    }
    frame.lights = &light;
    frame.depth.pixels = seen;
    frame.scatter.pixels = shadowed;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    memset(&light.shadow, 0, sizeof light.shadow);
    light.more_count = 0;
    frame.scatter.pixels = open;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
}

static void compare(const char *light, const char *control, const char *way, const float *got, double tolerance)
{
    double gap = rig_l1(got, wanted, COUNT);
    if (!(gap <= tolerance))
        printf("  %s, %s, %s: %g\n", light, control, way, gap);
    CHECK(gap <= tolerance);
}

static void one(rig *r, const char *name, const art *a, int textured)
{
    static tyn_query_point point[PIXELS];
    static tyn_query_result result[PIXELS];
    static float target[COUNT], share[COUNT];
    tyn_light light = r->light[0];
    tyn_frame frame = rig_frame(r);
    frame.lights = &light;
    frame.target.pixels = target;
    frame.target.format = TYN_RGB_F32;
    put(a, &frame, &light);
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        int march = config.method == TYN_METHOD_MARCH;
        if (textured && !march && way) /* coloured light is slow, and one code for all lines */
            continue;
        config.textured = textured;
        config.steps = 60;
        plain(r, &config, a);
        for (int i = 0; i < COUNT; i++) {
            double k = factor(a->contrast), v = (double)open[i] - k * (double)(open[i] - shadowed[i]);
            wanted[i] = (float)(light_factor(a, i % 3) * fmax(v, 0));
        }
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        /* refinement sees other values, and depth ends elsewhere: only a ray for each pixel is the same to rounding */
        compare(name, a->name, rig_ways[way].name, r->scatter, march ? 1e-5 : a->contrast > 1 ? 0.04 : 0.015);
        for (int i = 0; i < COUNT; i++) /* the picture */
            CHECK_NEAR(target[i], left[i] * (double)r->colour[i] + (double)r->scatter[i], 1e-5 * (1 + (double)target[i]));
        if (!march)
            continue;
        for (int i = 0; i < PIXELS; i++) {
            point[i].x = (float)(i % W) + 0.5f;
            point[i].y = (float)(i / W) + 0.5f;
            point[i].depth = r->depth[i];
        }
        CHECK(tyn_query(&frame, point, result, PIXELS) == TYN_OK);
        for (int i = 0; i < COUNT; i++) {
            share[i] = result[i / 3].scatter[i % 3];
            CHECK_NEAR(result[i / 3].transmittance[i % 3], left[i], 2e-6);
        }
        compare(name, a->name, "query", share, 1e-5);
    }
}

static void test_each(void)
{
    TEST("art controls: every one, every light, every method and tyn_query");
    for (int n = 0; n < NAMES; n++) {
        rig *r = rig_stock(names[n], W, H, 128);
        for (int a = 0; a < ARTS; a++)
            one(r, names[n], &arts[a], 0);
        colour(&r->light[0]);
        for (int a = 5; a < ARTS; a += 3) /* hard shadows, no fog, all at once: each kind of control */
            one(r, names[n], &arts[a], 1);
        rig_free(r);
    }
}

/* Saying what zeros say changes no byte. */
static void test_neutral(void)
{
    static const art neutral = {"", 1, {1, 1, 1}, 1, 1, 1e30f};
    static float scatter[COUNT];
    static uint8_t target[4 * PIXELS];
    TEST("art controls: ones are what zeros are, to the byte");
    for (int n = 0; n < NAMES; n++)
        for (int way = 0; way < RIG_WAYS; way++) {
            rig *r = rig_stock(names[n], W, H, 128);
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            memcpy(scatter, r->scatter, sizeof scatter);
            memcpy(target, r->target, sizeof target);
            put(&neutral, &frame, &r->light[0]);
            /* an end beyond everything still has depth looked at: the same but for rounding in the slices */
            frame.max_distance = config.method == TYN_METHOD_EPIPOLAR && r->light[0].kind != TYN_LIGHT_SPOT ? 0 : 1e30f;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            CHECK(memcmp(scatter, r->scatter, sizeof scatter) == 0 && memcmp(target, r->target, sizeof target) == 0);
            rig_free(r);
        }
}

/* Lights have controls of their own; a light without shafts costs no rays. */
static void test_lights(void)
{
    static float sun[COUNT], lamp[COUNT];
    rig *r = rig_stock("sun ahead", W, H, 128), *other = rig_stock("lamp off the left", W, H, 128);
    TEST("art controls: each light by itself");
    for (int way = 0; way < RIG_WAYS - 1; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        tyn_light light[2];
        int64_t rays;
        light[0] = r->light[0];
        light[1] = other->light[0];
        config.lights = 2;
        frame.scatter.pixels = sun;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        rays = r->stats.rays;
        frame.lights = &light[1];
        frame.scatter.pixels = lamp;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        frame = rig_frame(r);
        frame.lights = light;
        frame.light_count = 2;
        for (int n = 0; n < 3; n++) {
            light[0].scale = n == 2 ? -1 : 0.5f;
            light[1].scale = n == 1 ? -0.001f : 0;
            light[1].tint[1] = 2;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            for (int i = 0; i < COUNT; i++)
                wanted[i] = (n == 2 ? 0 : 0.5f) * sun[i] + (n == 1 || i % 3 != 1 ? 0 : 2.0f) * lamp[i];
            CHECK_NEAR(rig_l1(r->scatter, wanted, COUNT), 0, 1e-6);
            CHECK(n != 1 || r->stats.rays == rays);
        }
    }
    rig_free(r);
    rig_free(other);
}

/* Slices see depth end where the medium does: what lies behind breaks nothing and is not rejected. */
static void test_reach(void)
{
    TEST("art controls: an end of the medium costs nothing");
    for (int n = 0; n < NAMES; n++) {
        rig *r = rig_stock(names[n], W, H, 128);
        tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
        tyn_frame frame = rig_frame(r);
        tyn_stats before;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        before = r->stats;
        frame.max_distance = 3; /* before all but a corner of the court */
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(r->stats.breaks <= before.breaks / 4 && r->stats.rejected <= before.rejected / 4 + 4);
        rig_free(r);
    }
}

/* ---- the door ------------------------------------------------------------------------------------------------------- */

static void test_statuses(void)
{
    static const float odd[] = {(float)NAN, (float)INFINITY, -(float)INFINITY};
    rig *r = rig_stock("sun ahead", 16, 12, 64);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_context *context = rig_context(&config);
    const tyn_query_point point = {7, 5, 9};
    tyn_query_result result;
    TEST("art controls: out of range");
    CHECK(context != NULL);
    for (int n = 0; context && n < 3; n++)
        for (int field = 0; field < 6; field++) {
            tyn_light light = r->light[0];
            tyn_frame frame = rig_frame(r);
            float *at[6];
            frame.lights = &light;
            at[0] = &light.scale;
            at[1] = &light.tint[0];
            at[2] = &light.tint[2];
            at[3] = &frame.shaft_contrast;
            at[4] = &frame.fog_scale;
            at[5] = &frame.max_distance;
            *at[field] = odd[n];
            CHECK(tyn_render(context, &frame) == (field < 3 ? TYN_E_LIGHT : TYN_E_MEDIUM));
            *at[field] = -1e-3f; /* negative: none where that makes sense */
            CHECK(tyn_render(context, &frame) == (field == 1 || field == 2 ? TYN_E_LIGHT : field == 5 ? TYN_E_MEDIUM : TYN_OK));
            *at[field] = 3e38f; /* finite in, finite out */
            CHECK(tyn_render(context, &frame) == TYN_OK);
            for (int i = 0; i < 3 * 16 * 12; i++)
                CHECK(r->scatter[i] >= 0 && r->scatter[i] <= 3e38f);
            CHECK(tyn_query(&frame, &point, &result, 1) == TYN_OK);
            for (int k = 0; k < 3; k++)
                CHECK(result.scatter[k] >= 0 && result.scatter[k] <= 3e38f);
        }
    free(context);
    rig_free(r);
}

void test_art(void)
{
    test_each();
    test_neutral();
    test_lights();
    test_reach();
    test_statuses();
}
