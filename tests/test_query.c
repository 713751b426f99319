/* test_query.c - tyn_query: what the medium does up to any point, held against the picture, the oracle and the closed form. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 48, H = 36, PIXELS = W * H };

static tyn_query_point point[PIXELS];
static tyn_query_result result[PIXELS];

/* A point on each pixel's surface. */
static void surface_points(const rig *r)
{
    for (int i = 0; i < PIXELS; i++) {
        point[i].x = (float)(i % W) + 0.5f;
        point[i].y = (float)(i / W) + 0.5f;
        point[i].depth = r->depth[i];
    }
}

/* A window of eight colours, for a gobo, a slide or a cube. */
static tyn_image window(void)
{
    static const uint8_t texel[24] = {255, 0,   0,   250, 240, 10,  0,   0,  0,   255, 255, 255,
                                      20,  200, 100, 128, 128, 128, 255, 30, 255, 0,   60,  255};
    tyn_image image = {(void *)(uintptr_t)texel, 4, 2, 0, TYN_RGB8_LINEAR};
    return image;
}

/* ---- the picture ---------------------------------------------------------------------------------------------------- */

/* At the pixels' own surfaces: the march's light to rounding, the slices' within their error. */
static void against_pictures(rig *r, const tyn_frame *frame, int textured, const char *name)
{
    static float queried[3 * PIXELS];
    CHECK(tyn_query(frame, point, result, PIXELS) == TYN_OK);
    for (int i = 0; i < PIXELS; i++)
        memcpy(queried + 3 * i, result[i].scatter, sizeof result[i].scatter);
    for (int way = 0; way < 3; way += 2) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        double gap;
        config.textured = textured;
        CHECK(rig_render(r, &config, frame) == TYN_OK);
        gap = rig_l1(queried, r->scatter, 3 * PIXELS);
        if (gap > (way ? 1e-6 : 0.02))
            printf("  %s, method %d: %g\n", name, (int)rig_ways[way].method, gap);
        CHECK(gap <= (way ? 1e-6 : 0.02));
        if (way)
            CHECK_NEAR(rig_worst(queried, r->scatter, 3 * PIXELS), 0, 1e-5);
    }
}

static void test_pictures_agree(void)
{
    static const char *const names[] = {"sun ahead",    "sun off the left",      "sun behind the camera",
                                        "lamp in view", "lamp off the left",     "lamp behind the camera",
                                        "bulb in view", "bulb behind the camera"};
    tyn_image panes[6];
    TEST("tyn_query: the light of the picture, at its surfaces");
    for (int i = 0; i < 6; i++)
        panes[i] = window();
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        rig *r = rig_stock(names[n], W, H, 256);
        tyn_frame frame = rig_frame(r);
        surface_points(r);
        against_pictures(r, &frame, 0, names[n]);
        /* the same light through coloured panes */
        r->light[0].textures = panes;
        r->light[0].texture_count = r->light[0].kind == TYN_LIGHT_POINT ? 6 : 1;
        r->light[0].up[1] = 1;
        r->light[0].extent[0] = r->light[0].extent[1] = 20;
        against_pictures(r, &frame, 1, names[n]);
        rig_free(r);
    }
}

/* Several lights, a stained map, an orthographic camera, a picture of one pixel. */
static void test_combinations(void)
{
    rig *r = rig_stock("sun off the left", W, H, 256), *other = rig_stock("bulb in view", W, H, 128);
    tyn_light lights[3];
    tyn_image pane = window();
    tyn_frame frame = rig_frame(r);
    tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
    TEST("tyn_query: several lights, stained glass, orthographic cameras");
    surface_points(r);
    lights[0] = r->light[0];
    lights[1] = other->light[0];
    lights[2] = r->light[0];
    lights[2].kind = TYN_LIGHT_SPOT;
    lights[2].position[1] = 6;
    lights[2].angle = 1.2f;
    lights[2].colour[0] = 150;
    memset(&lights[2].shadow, 0, sizeof lights[2].shadow);
    lights[0].shadow.tint = &pane;
    frame.lights = lights;
    frame.light_count = 3;
    config.lights = 3;
    config.maps = 6;
    config.textured = 1;
    for (int kind = 0; kind < 2; kind++) {
        frame.camera.kind = kind ? TYN_CAMERA_ORTHOGRAPHIC : TYN_CAMERA_PERSPECTIVE;
        if (kind) {
            frame.camera.left_edge = -5;
            frame.camera.right_edge = 4;
            frame.camera.bottom_edge = -1.4f;
            frame.camera.top_edge = 5;
        }
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(tyn_query(&frame, point, result, PIXELS) == TYN_OK);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(result[i].scatter[c], r->scatter[3 * i + c], 1e-5 * (1e-3 + (double)r->scatter[3 * i + c]));
    }
    rig_free(r);
    rig_free(other);
}

/* ---- the truth ------------------------------------------------------------------------------------------------------ */

/* The i-th of points that fill 0 .. 1 evenly. */
static float spread(int i, double step)
{
    double x = 0.5 + step * (double)i;
    return (float)(x - floor(x));
}

/* Points anywhere, on the screen and beside it, before and behind surfaces, against the oracle; and their transmittance. */
static void test_truth(void)
{
    static const char *const names[] = {"sun ahead", "lamp off the left", "bulb off the right"};
    TEST("tyn_query: points in the air, on the screen and beside it, against the oracle");
    for (int n = 0; n < 6; n++) {
        int shadows = n % 2;
        oracle_scene *scene = stock_new(names[n / 2], W, H);
        rig *r = rig_new(scene, shadows ? 1024 : 16);
        tyn_frame frame;
        double gap = 0, sum = 0, forward, v[3], out[3];
        CHECK(r != NULL);
        if (!r)
            return;
        frame = rig_frame(r);
        if (!shadows) {
            scene->polygons = 0;
            r->light[0].shadow.depth = NULL;
            r->light[0].shadow.size = 0;
            r->light[0].more_count = 0;
        }
        CHECK(oracle_prepare(scene));
        for (int i = 0; i < PIXELS; i++) {
            /* not by chance: a sliver of light may keep the oracle busy for ages */
            point[i].x = W * (2 * spread(i, 0.75487766624669) - 0.5f);
            point[i].y = H * (2 * spread(i, 0.56984029099805) - 0.5f);
            point[i].depth = 20 * spread(i, 0.81917251339616);
        }
        frame.depth.pixels = NULL; /* its size is all that counts */
        CHECK(tyn_query(&frame, point, result, PIXELS) == TYN_OK);
        for (int i = 0; i < PIXELS; i++) {
            oracle_ray(scene, (double)point[i].x, (double)point[i].y, v);
            forward = 0;
            for (int k = 0; k < 3; k++)
                forward += v[k] * scene->camera.forward[k];
            oracle_scatter(scene, v, (double)point[i].depth / forward, out);
            for (int c = 0; c < 3; c++) {
                double sigma = 0;
                for (int k = 0; k < scene->media; k++)
                    sigma += scene->medium[k].scatter[c] + scene->medium[k].absorb[c];
                CHECK_NEAR(result[i].transmittance[c], exp(-sigma * (double)point[i].depth / forward), 2e-6);
                gap += fabs(out[c] - (double)result[i].scatter[c]);
                sum += out[c];
            }
        }
        /* a ray may pass a bulb so closely that the table of its light shows */
        CHECK_NEAR(gap / sum, 0, shadows ? 0.02 : n ? 3e-4 : 3e-5);
        rig_free(r);
        model_free(scene);
    }
}

/* Light only grows along a ray, and what is left of a surface behind it only falls. */
static void test_along_a_ray(void)
{
    rig *r = rig_stock("lamp in view", W, H, 256);
    tyn_frame frame = rig_frame(r);
    enum { COUNT = 500 };
    TEST("tyn_query: along one ray");
    for (int i = 0; i < COUNT; i++) {
        point[i].x = 20.3f;
        point[i].y = 15.8f;
        point[i].depth = 0.08f * (float)i;
    }
    CHECK(tyn_query(&frame, point, result, COUNT) == TYN_OK);
    for (int c = 0; c < 3; c++) {
        CHECK(result[0].scatter[c] == 0.0f && result[0].transmittance[c] == 1.0f);
        for (int i = 1; i < COUNT; i++) {
            CHECK(result[i].scatter[c] >= result[i - 1].scatter[c] * 0.9995f);
            CHECK(result[i].transmittance[c] < result[i - 1].transmittance[c]);
        }
    }
    rig_free(r);
}

/* ---- the door ------------------------------------------------------------------------------------------------------- */

static void test_odd_points(void)
{
    static const float odd[] = {0.0f, -1.0f, 1e30f, -3e38f, 12.5f, 1e-30f};
    enum { ODDS = 8, COUNT = ODDS * ODDS * ODDS };
    rig *r = rig_stock("lamp in view", W, H, 64);
    tyn_frame frame = rig_frame(r);
    float value[ODDS];
    TEST("tyn_query: points that are none");
    memcpy(value, odd, sizeof odd);
    value[6] = (float)NAN;
    value[7] = (float)INFINITY;
    for (int i = 0; i < COUNT; i++) {
        point[i].x = value[i % ODDS];
        point[i].y = value[i / ODDS % ODDS];
        point[i].depth = value[i / ODDS / ODDS];
    }
    CHECK(tyn_query(&frame, point, result, COUNT) == TYN_OK);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) {
            CHECK(result[i].scatter[c] >= 0.0f && result[i].scatter[c] < 1e6f);
            CHECK(result[i].transmittance[c] >= 0.0f && result[i].transmittance[c] <= 1.0f);
            if (!isfinite(point[i].x) || !isfinite(point[i].y))
                CHECK(result[i].scatter[c] == 0.0f && result[i].transmittance[c] == 1.0f);
        }
    /* what is no depth is far, what is behind the camera is at it */
    for (int i = 0; i < 5; i++) {
        point[i].x = 30;
        point[i].y = 9;
        point[i].depth = i == 0 ? r->camera.far_depth : i == 1 ? 1e9f : i == 2 ? (float)NAN : i == 3 ? (float)INFINITY : -3.0f;
    }
    CHECK(tyn_query(&frame, point, result, 5) == TYN_OK);
    for (int i = 1; i < 4; i++)
        CHECK(memcmp(&result[0], &result[i], sizeof result[0]) == 0);
    CHECK(result[4].scatter[1] == 0.0f && result[4].transmittance[1] == 1.0f);
    rig_free(r);
}

/* Executors that run backwards, not at all, twice, or with workers that are none. */
static void run_backwards(void *context, tyn_job job, void *argument, int32_t count)
{
    int32_t workers = *(int32_t *)context;
    for (int32_t i = count - 1; i >= 0; i--)
        job(argument, i, i % workers);
}

static void run_badly(void *context, tyn_job job, void *argument, int32_t count)
{
    int32_t kind = *(int32_t *)context;
    for (int32_t i = 0; i < count; i++) {
        if (kind == 3 || (kind == 0 && i == 1)) /* 3: refuses */
            continue;
        job(argument, i, kind == 1 ? 2 : 0);
        if (kind == 2)
            job(argument, i, 0);
    }
}

static void test_executors(void)
{
    rig *r = rig_stock("sun ahead", W, H, 128);
    static tyn_query_result serial[PIXELS];
    int32_t knob;
    tyn_executor executor = {run_backwards, NULL, 1};
    tyn_frame frame = rig_frame(r);
    TEST("tyn_query: executors, good and bad");
    executor.context = &knob;
    surface_points(r);
    CHECK(tyn_query(&frame, point, serial, PIXELS) == TYN_OK);
    frame.executor = &executor;
    for (knob = 1; knob <= TYN_MAX_WORKERS; knob += 21)
        for (int32_t count = 0; count <= PIXELS; count += 193) { /* whole batches and parts of one */
            executor.workers = knob;
            memset(result, 0x5a, sizeof result);
            CHECK(tyn_query(&frame, point, result, count) == TYN_OK);
            CHECK(memcmp(result, serial, (size_t)count * sizeof *result) == 0);
            CHECK(count == PIXELS || ((const uint8_t *)&result[count])[0] == 0x5a);
        }
    executor.run = run_badly;
    executor.workers = 2;
    for (knob = 0; knob < 4; knob++)
        CHECK(tyn_query(&frame, point, result, PIXELS) == TYN_E_EXECUTOR);
    rig_free(r);
}

static void gobo(tyn_light *light)
{
    static tyn_image pane;
    pane = window();
    light->texture_count = 1;
    light->textures = &pane;
    light->up[1] = 1;
    light->extent[0] = light->extent[1] = 20;
}

static tyn_status spoil(tyn_frame *f, tyn_light *light, tyn_medium *medium, tyn_executor *executor, int n)
{
    switch (n) {
#define CASE(n, status, change)                                                                                                \
    case n:                                                                                                                    \
        change;                                                                                                                \
        return status;
        CASE(0, TYN_E_IMAGE, f->depth.width = 0)
        CASE(1, TYN_E_IMAGE, f->depth.height = TYN_MAX_SIZE + 1)
        CASE(2, TYN_E_CAMERA, f->camera.far_depth = f->camera.near_depth)
        CASE(3, TYN_E_CAMERA, f->camera.position[0] = (float)NAN)
        CASE(4, TYN_E_NULL, f->lights = NULL)
        CASE(5, TYN_E_LIMIT, f->light_count = TYN_MAX_LIGHTS + 1)
        CASE(6, TYN_E_LIMIT, f->light_count = -1)
        CASE(7, TYN_E_LIGHT, light->colour[1] = -1)
        CASE(8, TYN_E_LIGHT, light->scale = (float)NAN)
        CASE(9, TYN_E_LIGHT, light->tint[2] = -1)
        CASE(10, TYN_E_LIGHT, light->texture_count = 2)
        CASE(11, TYN_E_NULL, f->media = NULL)
        CASE(12, TYN_E_MEDIUM, medium->scatter[0] = -1)
        CASE(13, TYN_E_MEDIUM, f->shaft_contrast = (float)INFINITY)
        CASE(14, TYN_E_MEDIUM, f->fog_scale = (float)NAN)
        CASE(15, TYN_E_MEDIUM, f->max_distance = -1)
        CASE(16, TYN_E_EXECUTOR, f->executor = executor; executor->run = NULL)
        CASE(17, TYN_E_EXECUTOR, f->executor = executor; executor->workers = TYN_MAX_WORKERS + 1)
        CASE(18, TYN_E_EXECUTOR, f->executor = executor; executor->workers = 0)
        CASE(19, TYN_E_CAMERA, f->camera.position[0] = 1e30f)
        CASE(20, TYN_E_NULL, light->texture_count = 1; light->textures = NULL)
        CASE(21, TYN_E_LIGHT, gobo(light); memcpy(light->up, light->direction, sizeof light->up))
        CASE(22, TYN_E_LIGHT, gobo(light); light->extent[0] = 0)
#undef CASE
    default:
        return TYN_OK;
    }
}

static void test_statuses(void)
{
    rig *r = rig_stock("sun ahead", W, H, 64);
    tyn_frame frame = rig_frame(r);
    static tyn_query_result before[PIXELS];
    tyn_status want = TYN_E_NULL;
    TEST("tyn_query: every status, and nothing written with it");
    surface_points(r);
    memset(result, 0x5a, sizeof result);
    memcpy(before, result, sizeof before);
    CHECK(tyn_query(NULL, point, result, 1) == TYN_E_NULL);
    CHECK(tyn_query(&frame, NULL, result, 1) == TYN_E_NULL);
    CHECK(tyn_query(&frame, point, NULL, 1) == TYN_E_NULL);
    CHECK(tyn_query(&frame, point, result, -1) == TYN_E_LIMIT);
    CHECK(tyn_query(&frame, (const void *)((const char *)point + 1), result, 1) == TYN_E_ALIGN);
    CHECK(tyn_query(&frame, point, (void *)((char *)result + 2), 1) == TYN_E_ALIGN);
    CHECK(tyn_query(&frame, NULL, NULL, 0) == TYN_OK);
    for (int n = 0; want != TYN_OK; n++) {
        tyn_light light = r->light[0];
        tyn_medium medium = r->medium[0];
        tyn_executor executor = {run_badly, NULL, 1};
        tyn_status got;
        frame = rig_frame(r);
        frame.lights = &light;
        frame.media = &medium;
        frame.medium_count = 1;
        want = spoil(&frame, &light, &medium, &executor, n);
        if (want == TYN_OK)
            break;
        got = tyn_query(&frame, point, result, PIXELS);
        if (got != want)
            printf("  case %d: %s, not %s\n", n, tyn_status_name(got), tyn_status_name(want));
        CHECK(got == want && memcmp(result, before, sizeof result) == 0);
    }
    /* nothing that scatters is no error */
    frame = rig_frame(r);
    frame.light_count = 0;
    frame.lights = NULL;
    CHECK(tyn_query(&frame, point, result, 1) == TYN_OK && result[0].scatter[0] == 0.0f && result[0].transmittance[0] < 1.0f);
    frame = rig_frame(r);
    frame.medium_count = 0;
    CHECK(tyn_query(&frame, point, result, 1) == TYN_OK && result[0].scatter[0] == 0.0f && result[0].transmittance[0] == 1.0f);
    rig_free(r);
}

void test_query(void)
{
    test_pictures_agree();
    test_combinations();
    test_truth();
    test_along_a_ray();
    test_odd_points();
    test_executors();
    test_statuses();
}
