/* test_leaves.c - light among leaves, where what is near in depth is not alike in light: a lamp within a bush, a low sun in
 * coloured air behind one, the sky through its holes. Against the march of the same shadow map. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tyndall.h"

enum { SIZE = 96, PIXELS = SIZE * SIZE, MAP = 512, LEAVES = 160 };

typedef struct bush {
    float corner[4 * LEAVES][3];
    uint32_t index[6 * LEAVES];
    int leaves;
    tyn_mesh mesh;
    tyn_camera camera;
    float depth[PIXELS], map[MAP * MAP], light[2][3 * PIXELS];
    uint8_t colour[4 * PIXELS], target[2][4 * PIXELS];
    tyn_raster *raster;
    void *memory;
} bush;

static bush *bush_new(void)
{
    const float eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    bush *b = calloc(1, sizeof *b);
    tyn_raster_config raster = {.width = MAP, .height = MAP};
    size_t bytes = 0;
    if (!b)
        abort();
    CHECK(tyn_camera_look(&b->camera, eye, ahead, up, 1.0f, 0.1f, 40.0f, SIZE, SIZE) == TYN_OK);
    CHECK(tyn_raster_measure(&raster, &bytes) == TYN_OK);
    b->memory = malloc(bytes + TYN_ALIGNMENT);
    CHECK(tyn_raster_init(&b->raster, &raster, test_aligned(b->memory), bytes) == TYN_OK);
    return b;
}

static void bush_free(bush *b)
{
    free(b->memory);
    free(b);
}

/* A square that faces the camera. */
static void leaf(bush *b, float x, float y, float z, float half)
{
    static const uint32_t fan[6] = {0, 1, 2, 0, 2, 3};
    for (int i = 0; i < 4; i++) {
        b->corner[4 * b->leaves + i][0] = x + (i == 1 || i == 2 ? half : -half);
        b->corner[4 * b->leaves + i][1] = y + (i > 1 ? half : -half);
        b->corner[4 * b->leaves + i][2] = z;
    }
    for (int i = 0; i < 6; i++)
        b->index[6 * b->leaves + i] = (uint32_t)(4 * b->leaves) + fan[i];
    b->leaves++;
}

static float some(uint32_t *seed, float low, float high)
{
    *seed = *seed * 1664525u + 1013904223u;
    return low + (high - low) * (float)(*seed >> 8) / 16777216.0f;
}

/* Depth, and the light's shadow map. */
static void see(bush *b, tyn_light *light)
{
    const float low[3] = {-8, -8, -10.6f}, high[3] = {8, 8, 0};
    tyn_surface surface = {.camera = b->camera, .meshes = &b->mesh, .mesh_count = 1};
    b->mesh = (tyn_mesh){&b->corner[0][0],
                         NULL,
                         b->index,
                         (uint32_t)(4 * b->leaves),
                         (uint32_t)(2 * b->leaves),
                         {{0.5f, 0.5f, 0.5f}, NULL, NULL}};
    surface.depth = (tyn_image){b->depth, SIZE, SIZE, 0, TYN_DEPTH_F32};
    CHECK(tyn_raster_surface(b->raster, &surface) == TYN_OK);
    light->shadow.size = MAP;
    CHECK(tyn_shadow_fit(light, &b->camera, low, high) == TYN_OK);
    CHECK(tyn_raster_shadow(b->raster, &light->shadow, b->map, &b->mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
    light->shadow.depth = b->map;
}

/* By a config and by the march. */
static void render(bush *b, tyn_config config, const tyn_light *light, const tyn_medium *air)
{
    tyn_frame frame = {.camera = b->camera, .lights = light, .light_count = 1, .media = air, .medium_count = 1};
    frame.depth = (tyn_image){b->depth, SIZE, SIZE, 0, TYN_DEPTH_F32};
    frame.colour = (tyn_image){b->colour, SIZE, SIZE, 0, TYN_RGBA8_SRGB};
    config.shadow_size = MAP;
    for (int i = 0; i < 2; i++) {
        tyn_context *context;
        size_t bytes;
        void *memory;
        config.method = i ? TYN_METHOD_MARCH : TYN_METHOD_EPIPOLAR;
        frame.scatter = (tyn_image){b->light[i], SIZE, SIZE, 0, TYN_RGB_F32};
        frame.target = (tyn_image){b->target[i], SIZE, SIZE, 0, TYN_RGBA8_SRGB};
        CHECK(tyn_measure(&config, &bytes) == TYN_OK);
        memory = malloc(bytes + TYN_ALIGNMENT);
        CHECK(tyn_init(&context, &config, test_aligned(memory), bytes) == TYN_OK);
        CHECK(tyn_render(context, &frame) == TYN_OK);
        free(memory);
    }
}

/* Relative L1 of channel c. */
static double off(const bush *b, int c)
{
    double sum = 0, all = 0;
    for (int i = c; i < 3 * PIXELS; i += 3) {
        sum += fabs((double)b->light[0][i] - (double)b->light[1][i]);
        all += (double)b->light[1][i];
    }
    return sum / all;
}

/* The largest difference of 8 bits. */
static int worst(const bush *b)
{
    int most = 0;
    for (int i = 0; i < 4 * PIXELS; i++) {
        int apart = abs(b->target[0][i] - b->target[1][i]);
        most = apart > most ? apart : most;
    }
    return most;
}

/* Depths of leaves on both sides of the lamp differ by less than makes a break from the camera. */
static void lamp_in_a_bush(tyn_preset preset, const char *name, double most_off, int most)
{
    const tyn_medium haze = {{0.02f, 0.02f, 0.02f}, {0, 0, 0}, TYN_PHASE_HG, 0.5f};
    tyn_light light = {
        .kind = TYN_LIGHT_SPOT, .colour = {40, 40, 40}, .position = {0.3f, 0.2f, -10}, .direction = {0, 0, -1}, .angle = 2.4f};
    tyn_config config;
    bush *b = bush_new();
    uint32_t seed = 3;
    test_begin(name);
    leaf(b, 0, 0, -10.5f, 8);
    while (b->leaves < LEAVES) {
        float x = some(&seed, -1.5f, 1.5f), y = some(&seed, -1.5f, 1.5f), z = some(&seed, -10.2f, -9.6f);
        leaf(b, x, y, z, some(&seed, 0.04f, 0.1f));
    }
    see(b, &light);
    CHECK(tyn_config_preset(&config, preset, SIZE, SIZE) == TYN_OK);
    config.initial_step = 16;
    config.tolerance = 1; /* nothing is refined: rays are at breaks alone */
    render(b, config, &light, &haze);
    printf("  %-28s relative L1 to the march %.5f, of 255 at most %d\n", name, off(b, 1), worst(b));
    CHECK(off(b, 1) < most_off);
    CHECK(worst(b) <= most);
    bush_free(b);
}

/* Leaves side by side with holes between them, and a sun behind. */
static void hedge(bush *b, tyn_light *light)
{
    uint32_t seed = 7;
    for (int i = 0; i < LEAVES; i++) {
        float x = -3.6f + 0.48f * (float)(i % 16), y = 1.8f - 0.48f * (float)(i / 16), z = some(&seed, -6, -5);
        leaf(b, x, y, z, some(&seed, 0.18f, 0.28f));
    }
    *light = (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .colour = {6, 6, 6}, .direction = {0.2408f, 0.0963f, 0.9658f}};
    see(b, light);
}

/* Two channels are marched, the third lies between them: it must not be worse by much. */
static void coloured_air(void)
{
    const tyn_medium air = {{0.04f, 0.052f, 0.082f}, {0, 0, 0}, TYN_PHASE_RAYLEIGH, 0};
    tyn_light light;
    tyn_config config;
    bush *b = bush_new();
    TEST("the third channel of coloured air");
    hedge(b, &light);
    CHECK(tyn_config_preset(&config, TYN_PRESET_REFERENCE, SIZE, SIZE) == TYN_OK);
    render(b, config, &light, &air);
    printf("  coloured air behind a hedge  relative L1 to the march %.5f, %.5f, %.5f\n", off(b, 0), off(b, 1), off(b, 2));
    CHECK(2 * off(b, 1) < 1.2 * (off(b, 0) + off(b, 2)));
    bush_free(b);
}

/* No sample lies behind the leaves on either line: what the sky's pixels there have is a guess or a ray. */
static void holes(void)
{
    const tyn_medium haze = {{0.03f, 0.03f, 0.03f}, {0, 0, 0}, TYN_PHASE_HG, 0.6f};
    tyn_light light;
    tyn_config config;
    bush *b = bush_new();
    TEST("the sky through holes of a hedge");
    hedge(b, &light);
    light.colour[0] = light.colour[1] = light.colour[2] = 1.4f; /* so dim that no ray is spent on them */
    CHECK(tyn_config_preset(&config, TYN_PRESET_HANDHELD, SIZE, SIZE) == TYN_OK);
    render(b, config, &light, &haze);
    printf("  the sky through a hedge      relative L1 to the march %.5f, of 255 at most %d\n", off(b, 1), worst(b));
    CHECK(worst(b) <= 60);
    bush_free(b);
}

void test_leaves(void)
{
    lamp_in_a_bush(TYN_PRESET_QUALITY, "a lamp in a bush", 0.0045, 6);
    lamp_in_a_bush(TYN_PRESET_BALANCED, "a lamp in a bush, balanced", 0.027, 9);
    coloured_air();
    holes();
}
