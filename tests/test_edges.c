/* test_edges.c - what readings and fuzzing of the library found, each kept as a test. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tyndall.h"

enum { SIZE = 64, PIXELS = SIZE * SIZE };

typedef struct bench {
    void *memory;
    tyn_context *context;
    tyn_frame frame;
    tyn_light light[2];
    tyn_medium medium;
    float depth[PIXELS], scatter[3 * PIXELS], target[3 * PIXELS];
} bench;

static bench *bench_new(tyn_method method, float far)
{
    const float eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    bench *b = calloc(1, sizeof *b);
    tyn_config config;
    size_t bytes = 0;
    if (!b)
        abort();
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, SIZE, SIZE) == TYN_OK);
    config.method = method;
    config.lights = 2;
    config.workers = 2;
    CHECK(tyn_measure(&config, &bytes) == TYN_OK);
    b->memory = malloc(bytes + TYN_ALIGNMENT);
    CHECK(tyn_init(&b->context, &config, test_aligned(b->memory), bytes) == TYN_OK);
    CHECK(tyn_camera_look(&b->frame.camera, eye, ahead, up, 1.0f, 0.1f, far, SIZE, SIZE) == TYN_OK);
    for (int i = 0; i < 2; i++) {
        b->light[i].direction[1] = -1;
        b->light[i].colour[0] = b->light[i].colour[1] = b->light[i].colour[2] = 1;
    }
    for (int i = 0; i < 3; i++)
        b->medium.scatter[i] = 0.02f;
    for (int i = 0; i < PIXELS; i++)
        b->depth[i] = 5;
    b->frame.depth = (tyn_image){b->depth, SIZE, SIZE, 0, TYN_DEPTH_F32};
    b->frame.scatter = (tyn_image){b->scatter, SIZE, SIZE, 0, TYN_RGB_F32};
    b->frame.target = (tyn_image){b->target, SIZE, SIZE, 0, TYN_RGB_F32};
    b->frame.lights = b->light;
    b->frame.light_count = 1;
    b->frame.media = &b->medium;
    b->frame.medium_count = 1;
    return b;
}

static void bench_free(bench *b)
{
    free(b->memory);
    free(b);
}

/* A lamp 5 m off, `angle` from the ray; fine steps in double against the library's table. */
static void peaked(float g, float angle)
{
    bench *b = bench_new(TYN_METHOD_MARCH, 100);
    tyn_query_point point = {0.5f * SIZE, 0.5f * SIZE, 50};
    tyn_query_result result;
    const int steps = 400000;
    double sum = 0, x = 5 * sin((double)angle), z = 5 * cos((double)angle), gg = (double)g;
    b->light[0].kind = TYN_LIGHT_POINT;
    b->light[0].position[0] = (float)x;
    b->light[0].position[2] = (float)-z;
    b->medium.phase = TYN_PHASE_HG;
    b->medium.g = g;
    for (int i = 0; i < steps; i++) {
        double t = 50 * (i + 0.5) / steps, along = z - t, r2 = x * x + along * along, r = sqrt(r2);
        double p = (1 - gg * gg) / (12.566370614 * pow(1 + gg * gg - 2 * gg * along / r, 1.5));
        sum += exp(-0.02 * (t + r)) * 0.02 * p / r2 * 50 / steps;
    }
    CHECK(tyn_query(&b->frame, &point, &result, 1) == TYN_OK);
    CHECK_NEAR((double)result.scatter[0] / sum, 1, 0.02);
    bench_free(b);
}

static void check_peaked(void)
{
    TEST("a phase function with a sharp peak near a lamp");
    peaked(0.99f, 0.02f);
    peaked(0.99f, 0.3f);
    peaked(-0.99f, 0.02f);
    peaked(-0.99f, 0.3f);
    peaked(0.9f, 0.1f);
}

/* Runs the first job twice and never the last. */
static void careless(void *context, tyn_job job, void *argument, int32_t count)
{
    (void)context;
    for (int32_t i = 0; i < count; i++)
        job(argument, i < count - 1 ? i : 0, 0);
}

static void check_careless(void)
{
    bench *b = bench_new(TYN_METHOD_EPIPOLAR, 100);
    tyn_executor executor = {careless, NULL, 2};
    TEST("a job run twice does not stand for one not run");
    b->frame.executor = &executor;
    CHECK(tyn_render(b->context, &b->frame) == TYN_E_EXECUTOR);
    bench_free(b);
}

/* A debug view shows the first light, whatever follows, also over the colour that it is drawn on. */
static void check_debug(void)
{
    static const float black[16];
    bench *b = bench_new(TYN_METHOD_EPIPOLAR, 100);
    int magenta = 0;
    TEST("debug views of several lights, in place");
    b->light[0].shadow.depth = black; /* far off: all is outside */
    b->light[0].shadow.size = 4;
    b->light[0].shadow.matrix[0] = b->light[0].shadow.matrix[5] = b->light[0].shadow.matrix[10] = 1;
    b->light[0].shadow.matrix[3] = b->light[0].shadow.matrix[7] = 1000;
    b->light[0].shadow.matrix[15] = 1;
    b->frame.light_count = 2;
    b->frame.colour = b->frame.target;
    b->frame.debug = TYN_DEBUG_OUTSIDE;
    CHECK(tyn_render(b->context, &b->frame) == TYN_OK);
    for (int i = 0; i < PIXELS; i++)
        magenta += b->target[3 * i] > 2 && b->target[3 * i + 1] == 0;
    CHECK(magenta == PIXELS);
    for (int i = 0; i < 3 * PIXELS; i++)
        b->target[i] = 1;
    b->frame.debug = TYN_DEBUG_REJECTED;
    CHECK(tyn_render(b->context, &b->frame) == TYN_OK);
    CHECK_NEAR(b->target[0], 0.5, 1e-6);
    bench_free(b);
}

/* What is nearer than the samples' depth code can tell must not be computed pixel by pixel. */
static void check_deep(void)
{
    bench *b = bench_new(TYN_METHOD_EPIPOLAR, 1e6f);
    tyn_stats stats = {.rejected = PIXELS};
    TEST("near pixels of a deep scene are not all rejected");
    b->frame.stats = &stats;
    CHECK(tyn_render(b->context, &b->frame) == TYN_OK);
    CHECK(stats.rejected < PIXELS / 50);
    bench_free(b);
}

static void check_door(void)
{
    bench *b = bench_new(TYN_METHOD_MARCH, 100);
    tyn_mesh empty = {.vertices = 3};
    tyn_light spot = {.kind = TYN_LIGHT_SPOT, .direction = {0, -1, 0}, .angle = 1, .shadow = {.size = 16}};
    TEST("empty meshes, slides without a picture, and what is too large");
    CHECK(tyn_shadow_fit_scene(&spot, &b->frame.camera, NULL, &empty, 1) == TYN_OK);
    spot.texture_count = 1;
    CHECK(tyn_shadow_fit(&spot, &b->frame.camera, NULL, NULL) == TYN_E_NULL);
    b->frame.camera.far_depth = 1e20f;
    CHECK(tyn_render(b->context, &b->frame) == TYN_E_CAMERA);
    b->frame.camera.far_depth = 100;
    b->light[0].kind = TYN_LIGHT_POINT;
    b->light[0].position[0] = 1e20f;
    CHECK(tyn_render(b->context, &b->frame) == TYN_E_LIGHT);
    bench_free(b);
}

void test_edges(void)
{
    check_peaked();
    check_careless();
    check_debug();
    check_deep();
    check_door();
}
