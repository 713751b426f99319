/* test_api.c - every public call at its door: each status is reached, nothing is written with it, and bands stay whole. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

#define BIG_NAN ((float)NAN)
#define BIG_INF ((float)INFINITY)

/* ---- small calls ---------------------------------------------------------------------------------------------------- */

static void test_names(void)
{
    static const char *const names[] = {"TYN_OK",        "TYN_E_NULL",   "TYN_E_CONFIG",   "TYN_E_MEMORY", "TYN_E_ALIGN",
                                        "TYN_E_IMAGE",   "TYN_E_CAMERA", "TYN_E_LIGHT",    "TYN_E_MEDIUM", "TYN_E_MESH",
                                        "TYN_E_DISPLAY", "TYN_E_LIMIT",  "TYN_E_EXECUTOR", "TYN_E_ISA"};
    static const int32_t bytes[] = {0, 12, 4, 4, 2, 4, 3, 6, 1, 2, 4, 0};
    TEST("names, version, bytes of a pixel");
    for (int i = 0; i < 14; i++)
        CHECK(strcmp(tyn_status_name((tyn_status)-i), names[i]) == 0);
    CHECK(strcmp(tyn_status_name((tyn_status)-14), "TYN_E_UNKNOWN") == 0);
    CHECK(strcmp(tyn_status_name((tyn_status)1), "TYN_E_UNKNOWN") == 0);
    CHECK(strcmp(tyn_status_name((tyn_status)-1000000), "TYN_E_UNKNOWN") == 0);
    CHECK(strcmp(tyn_version(), TYN_VERSION) == 0);
    for (int i = 0; i < 12; i++)
        CHECK(tyn_format_bytes((tyn_format)i) == bytes[i]);
    CHECK(tyn_format_bytes((tyn_format)-1) == 0);
}

static void test_camera(void)
{
    const float from[3] = {1, 2, 3}, to[3] = {4, 3, -6}, up[3] = {0, 2, 0}, skew[3] = {3, 1, -9}, not_a[3] = {0, BIG_NAN, 0};
    tyn_camera camera, before;
    double forward = 0, right = 0;
    TEST("tyn_camera_look");
    memset(&camera, 0x5a, sizeof camera);
    before = camera;
#define REFUSED(status, ...)                                                                                                   \
    do {                                                                                                                       \
        CHECK(tyn_camera_look(__VA_ARGS__) == (status));                                                                       \
        CHECK(memcmp(&camera, &before, sizeof camera) == 0);                                                                   \
    } while (0)
    REFUSED(TYN_E_NULL, NULL, from, to, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_NULL, &camera, NULL, to, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_NULL, &camera, from, NULL, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_NULL, &camera, from, to, NULL, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, from, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, skew, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, not_a, to, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, not_a, up, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, not_a, 1, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 0, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 3.1416f, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, BIG_NAN, 1, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 1, 0, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 1, 2, 2, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 1, 1, BIG_INF, 4, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 1, 1, 2, 0, 3);
    REFUSED(TYN_E_CAMERA, &camera, from, to, up, 1, 1, 2, 4, -3);
#undef REFUSED
    CHECK(tyn_camera_look(&camera, from, to, up, 1.2f, 0.5f, 70, 640, 480) == TYN_OK);
    CHECK_NEAR(camera.top_edge, tan(0.6), 1e-6);
    CHECK_NEAR(camera.right_edge, tan(0.6) * 640 / 480, 1e-6);
    CHECK(camera.left_edge == -camera.right_edge && camera.bottom_edge == -camera.top_edge);
    CHECK(camera.near_depth == 0.5f && camera.far_depth == 70 && memcmp(camera.position, from, sizeof from) == 0);
    for (int k = 0; k < 3; k++) {
        forward += (double)camera.forward[k] * (double)(to[k] - from[k]);
        right += (double)camera.right[k] * (double)(to[k] - from[k]);
    }
    CHECK_NEAR(forward, sqrt(9 + 1 + 81), 1e-4);
    CHECK_NEAR(right, 0, 1e-4);
    CHECK_NEAR(camera.right[1], 0, 1e-6);
    CHECK(camera.up[1] > 0 && camera.right[0] > 0);
}

static void test_air(void)
{
    tyn_medium media[2], before[2];
    TEST("tyn_medium_air");
    memset(media, 0x5a, sizeof media);
    memcpy(before, media, sizeof media);
    CHECK(tyn_medium_air(NULL, 1) == TYN_E_NULL);
    CHECK(tyn_medium_air(media, -1) == TYN_E_MEDIUM);
    CHECK(tyn_medium_air(media, -1e-45f) == TYN_E_MEDIUM);
    CHECK(tyn_medium_air(media, 1e24f) == TYN_E_MEDIUM);
    CHECK(tyn_medium_air(media, BIG_NAN) == TYN_E_MEDIUM);
    CHECK(tyn_medium_air(media, BIG_INF) == TYN_E_MEDIUM);
    CHECK(memcmp(before, media, sizeof media) == 0);
    CHECK(tyn_medium_air(media, 10) == TYN_OK);
    CHECK_NEAR(media[0].scatter[2], 33.1e-5, 1e-9);
    CHECK(media[0].phase == TYN_PHASE_RAYLEIGH && media[1].phase == TYN_PHASE_HG && media[1].g == 0.76f);
    CHECK_NEAR(media[1].scatter[0], 2e-4, 1e-9);
}

static void test_fit(void)
{
    const float low[3] = {-5, 0, -9}, high[3] = {5, 4, 2}, bad[3] = {0, BIG_INF, 0};
    const float from[3] = {0, 1, 8}, to[3] = {0, 1, 0}, up[3] = {0, 1, 0};
    tyn_camera camera, wrong;
    tyn_light light, before;
    TEST("tyn_shadow_fit");
    CHECK(tyn_camera_look(&camera, from, to, up, 1, 0.1f, 50, 64, 48) == TYN_OK);
    wrong = camera;
    wrong.up[1] = 0.5f;
    memset(&light, 0, sizeof light);
    light.direction[1] = -1;
    light.colour[0] = 1;
    light.shadow.matrix[7] = 123;
    before = light;
    CHECK(tyn_shadow_fit(NULL, &camera, low, high) == TYN_E_NULL);
    CHECK(tyn_shadow_fit(&light, NULL, low, high) == TYN_E_NULL);
    CHECK(tyn_shadow_fit(&light, &camera, low, NULL) == TYN_E_NULL);
    CHECK(tyn_shadow_fit(&light, &camera, NULL, high) == TYN_E_NULL);
    CHECK(tyn_shadow_fit(&light, &wrong, low, high) == TYN_E_CAMERA);
    CHECK(tyn_shadow_fit(&light, &camera, high, low) == TYN_E_MESH);
    CHECK(tyn_shadow_fit(&light, &camera, low, bad) == TYN_E_MESH);
    CHECK(memcmp(&light, &before, sizeof light) == 0);
    light.direction[1] = -2;
    before = light;
    CHECK(tyn_shadow_fit(&light, &camera, low, high) == TYN_E_LIGHT);
    CHECK(memcmp(&light, &before, sizeof light) == 0);
    light.kind = TYN_LIGHT_SPOT;
    light.direction[1] = -1;
    light.angle = 3.0f;
    before = light;
    CHECK(tyn_shadow_fit(&light, &camera, low, high) == TYN_E_LIGHT);
    CHECK(memcmp(&light, &before, sizeof light) == 0);
    for (int kind = 0; kind < 2; kind++)
        for (int bounds = 0; bounds < 2; bounds++) {
            float *m = light.shadow.matrix;
            light.kind = (tyn_light_kind)kind;
            light.angle = 1.0f;
            light.position[1] = 9;
            memset(m, 0, sizeof light.shadow.matrix);
            before = light;
            CHECK(tyn_shadow_fit(&light, &camera, bounds ? low : NULL, bounds ? high : NULL) == TYN_OK);
            /* the ground before the camera is in the map, in front of the light, and darker than what hangs above it */
            for (int i = 0; i < 20; i++) {
                float x = test_random_float(-1, 1), z = test_random_float(-2, 2);
                float W = m[12] * x + m[14] * z + m[15], Z = m[8] * x + m[10] * z + m[11];
                float u = (m[0] * x + m[2] * z + m[3]) / W, v = (m[4] * x + m[6] * z + m[7]) / W;
                float higher = (Z + m[9]) / (W + m[13]);
                CHECK(W > 0 && u > 0 && u < 1 && v > 0 && v < 1);
                CHECK(Z / W >= 0 && Z / W <= 1 && higher > Z / W);
            }
            memcpy(before.shadow.matrix, m, sizeof before.shadow.matrix);
            CHECK(memcmp(&before, &light, sizeof light) == 0);
        }
}

static void test_fit_scene(void)
{
    static const float corners[12] = {-5, 0, 5, 5, 0, 5, 0, 0, -9, 0, 4, 0};
    static const float far_corners[12] = {-5, 0, 1e24f, 5, 0, 5, 0, 0, -9, 0, 4, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 1, 3};
    static float depth_pixels[4] = {3, 9, 50, 20};
    const float from[3] = {0, 1, 8}, to[3] = {0, 1, 0}, up[3] = {0, 1, 0};
    tyn_image depth = {depth_pixels, 2, 2, 0, TYN_DEPTH_F32}, odd;
    tyn_mesh mesh, bad;
    tyn_camera camera;
    tyn_light light, before, spot;
    TEST("tyn_shadow_fit_scene");
    memset(&mesh, 0, sizeof mesh);
    mesh.positions = corners;
    mesh.indices = indices;
    mesh.vertices = 4;
    mesh.triangles = 2;
    CHECK(tyn_camera_look(&camera, from, to, up, 1, 0.1f, 50, 64, 48) == TYN_OK);
    memset(&light, 0, sizeof light);
    light.direction[1] = -1;
    before = light;
    CHECK(tyn_shadow_fit_scene(NULL, &camera, &depth, &mesh, 1) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_scene(&light, NULL, &depth, &mesh, 1) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, NULL, 1) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &mesh, -1) == TYN_E_LIMIT);
    bad = mesh, bad.vertices = 3;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &bad, 1) == TYN_E_MESH);
    bad = mesh, bad.positions = NULL;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &bad, 1) == TYN_E_NULL);
    bad = mesh, bad.indices = NULL;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &bad, 1) == TYN_E_NULL);
    odd = depth, odd.format = TYN_RGB_F32;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &odd, &mesh, 1) == TYN_E_IMAGE);
    odd = depth, odd.pixels = (char *)depth_pixels + 1;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &odd, &mesh, 1) == TYN_E_ALIGN);
    light.direction[1] = -3, before = light;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &mesh, 1) == TYN_E_LIGHT);
    light.direction[1] = -1, before.direction[1] = -1;
    camera.near_depth = -1;
    CHECK(tyn_shadow_fit_scene(&light, &camera, &depth, &mesh, 1) == TYN_E_CAMERA);
    camera.near_depth = 0.1f;
    CHECK(memcmp(&light, &before, sizeof light) == 0);
    spot = light;
    spot.kind = TYN_LIGHT_SPOT;
    spot.angle = 1;
    bad = mesh, bad.positions = far_corners; /* finite, but its square is not */
    CHECK(tyn_shadow_fit_scene(&spot, &camera, &depth, &bad, 1) == TYN_OK);
    for (int i = 0; i < 16; i++)
        CHECK(isfinite(spot.shadow.matrix[i]));
    /* the board's top and the ground under it are in the map, whatever the depth buffer and the meshes are */
    for (int n = 0; n < 4; n++) {
        float *m = light.shadow.matrix, z[2];
        memset(m, 0, sizeof light.shadow.matrix);
        CHECK(tyn_shadow_fit_scene(&light, &camera, n & 1 ? &depth : NULL, &mesh, n & 2 ? 1 : 0) == TYN_OK);
        for (int i = 0; i < 2 && n == 2; i++) {
            float y = i ? 3.9f : 0.05f, W = m[13] * y + m[15];
            float u = (m[1] * y + m[3]) / W, v = (m[5] * y + m[7]) / W;
            z[i] = (m[9] * y + m[11]) / W;
            CHECK(W > 0 && u > 0 && u < 1 && v > 0 && v < 1);
            if (i)
                CHECK(z[1] > z[0]);
        }
        for (int i = 0; i < 16; i++)
            CHECK(isfinite(m[i]));
    }
}

/* Where a cube's six faces meet there is no gap, and each face looks along its axis. */
static void test_fit_cube(void)
{
    const float at[3] = {1, 2, 3}, bad[3] = {0, BIG_NAN, 0}, far_off[3] = {0, 0, -1.01f * TYN_MAX_LENGTH};
    tyn_shadow faces[6], before[6];
    TEST("tyn_shadow_fit_cube");
    memset(faces, 0, sizeof faces);
    memcpy(before, faces, sizeof faces);
    CHECK(tyn_shadow_fit_cube(NULL, at, 5) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cube(faces, NULL, 5) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cube(faces, bad, 5) == TYN_E_LIGHT);
    CHECK(tyn_shadow_fit_cube(faces, far_off, 5) == TYN_E_LIGHT);
    CHECK(tyn_shadow_fit_cube(faces, at, 0) == TYN_E_LIGHT);
    CHECK(tyn_shadow_fit_cube(faces, at, BIG_INF) == TYN_E_LIGHT);
    CHECK(memcmp(before, faces, sizeof faces) == 0);
    for (int size = 0; size <= 64; size += 64) {
        for (int f = 0; f < 6; f++)
            faces[f].size = size;
        CHECK(tyn_shadow_fit_cube(faces, at, 50) == TYN_OK);
        for (int n = 0; n < 2000; n++) {
            float p[3];
            int covered = 0, ahead = 0;
            for (int k = 0; k < 3; k++)
                p[k] = at[k] + test_random_float(-9, 9);
            for (int f = 0; f < 6; f++) {
                const float *m = faces[f].matrix;
                float out[4];
                for (int i = 0; i < 4; i++)
                    out[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
                if (!(out[3] > 0))
                    continue;
                ahead += (p[f / 2] > at[f / 2]) == (f % 2 == 0);
                covered += out[0] >= -1e-5f * out[3] && out[0] <= 1.00001f * out[3] && out[1] >= -1e-5f * out[3] &&
                           out[1] <= 1.00001f * out[3];
            }
            CHECK(covered >= 1 && covered <= 3 && ahead == 3);
        }
    }
}

/* ---- configs and memory --------------------------------------------------------------------------------------------- */

/* The macro's sum, which must be tyn_measure's. */
static size_t memory_of(const tyn_config *c)
{
    size_t width = (size_t)c->width, height = (size_t)c->height, slices = (size_t)c->slices, samples = (size_t)c->samples;
    size_t shadow = (size_t)c->shadow_size, lights = (size_t)c->lights, workers = (size_t)c->workers;
    size_t maps = (size_t)c->maps;
    size_t sum, factor = (size_t)(c->downscale ? c->downscale : 1);
    sum = TYN_MEMORY_FULL(width, height, slices, samples, shadow, lights, workers, maps, c->textured);
    if (c->rays == TYN_RAYS_TREE)
        sum += TYN_MEMORY_TREE(shadow, maps, workers);
    if (c->rays == TYN_RAYS_SWEEP)
        sum += TYN_MEMORY_SWEEP(width, height, samples, shadow, maps, workers);
    if (c->gather != TYN_GATHER_SHEAR)
        sum += TYN_MEMORY_BORDER(slices);
    if (factor > 1)
        sum += TYN_MEMORY_DOWNSCALE(width, height, samples, factor, workers, c->textured);
    return sum;
}

static void test_preset(void)
{
    tyn_config config, before;
    TEST("tyn_config_preset");
    memset(&config, 0x5a, sizeof config);
    before = config;
    CHECK(tyn_config_preset(NULL, TYN_PRESET_QUALITY, 64, 48) == TYN_E_NULL);
    CHECK(tyn_config_preset(&config, (tyn_preset)4, 64, 48) == TYN_E_CONFIG);
    CHECK(tyn_config_preset(&config, (tyn_preset)-1, 64, 48) == TYN_E_CONFIG);
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, 0, 48) == TYN_E_CONFIG);
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, 64, -1) == TYN_E_CONFIG);
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, TYN_MAX_SIZE + 1, 48) == TYN_E_CONFIG);
    CHECK(memcmp(&config, &before, sizeof config) == 0);
    for (int preset = 0; preset < 4; preset++) {
        static const int32_t sizes[][2] = {{1, 1}, {320, 240}, {1920, 1080}, {3, 4000}};
        for (int i = 0; i < 4; i++) {
            size_t bytes = 0;
            CHECK(tyn_config_preset(&config, (tyn_preset)preset, sizes[i][0], sizes[i][1]) == TYN_OK);
            CHECK(config.width == sizes[i][0] && config.height == sizes[i][1]);
            CHECK(tyn_measure(&config, &bytes) == TYN_OK);
            CHECK(memory_of(&config) == bytes);
            config.lights = 3;
            config.workers = 5;
            config.maps = 6;
            config.textured = 1;
            CHECK(tyn_measure(&config, &bytes) == TYN_OK && memory_of(&config) == bytes);
            for (int way = 0; way < 5 * 3 * 4; way++) {
                config.rays = (tyn_rays)(way % 5);
                config.gather = (tyn_gather)(way / 5 % 3);
                config.downscale = 1 << way / 15;
                config.samples = way & 1 ? config.samples : 2;
                config.textured = way & 1;
                CHECK(tyn_measure(&config, &bytes) == TYN_OK && memory_of(&config) == bytes);
            }
        }
    }
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, 1920, 1080) == TYN_OK);
    CHECK(memory_of(&config) <= 10u << 20);
    CHECK(tyn_config_preset(&config, TYN_PRESET_HANDHELD, 320, 240) == TYN_OK);
    CHECK(memory_of(&config) <= 64u << 10);
    CHECK(tyn_config_preset(&config, TYN_PRESET_HANDHELD, 160, 120) == TYN_OK);
    CHECK(memory_of(&config) <= 24u << 10);
}

/* Every field out of its range, below and above. */
static void test_ranges(void)
{
    static const struct {
        size_t offset;
        int32_t bad[4];
    } fields[] = {{offsetof(tyn_config, width), {0, -1, TYN_MAX_SIZE + 1, INT32_MIN}},
                  {offsetof(tyn_config, height), {0, -1, TYN_MAX_SIZE + 1, INT32_MAX}},
                  {offsetof(tyn_config, slices), {-1, 1, 65537, INT32_MIN}},
                  {offsetof(tyn_config, samples), {-1, 1, 65537, INT32_MAX}},
                  {offsetof(tyn_config, initial_step), {-1, 3, 65, 128}},
                  {offsetof(tyn_config, shadow_size), {-1, TYN_MAX_SHADOW + 1, INT32_MAX, INT32_MIN}},
                  {offsetof(tyn_config, steps), {-1, 4097, INT32_MAX, INT32_MIN}},
                  {offsetof(tyn_config, method), {-1, 6, 1000, INT32_MIN}},
                  {offsetof(tyn_config, bases), {-1, 2, 30, 132}},
                  {offsetof(tyn_config, columns), {-1, 3, 4097, INT32_MIN}},
                  {offsetof(tyn_config, references), {-1, 5, INT32_MAX, INT32_MIN}},
                  {offsetof(tyn_config, weights), {-1, 2, 1000, INT32_MIN}},
                  {offsetof(tyn_config, reference), {-1, 2, 1000, INT32_MIN}},
                  {offsetof(tyn_config, paper), {-1, 16, 1000, INT32_MIN}},
                  {offsetof(tyn_config, rays), {-1, 5, 1000, INT32_MIN}},
                  {offsetof(tyn_config, gather), {-1, 3, 1000, INT32_MIN}},
                  {offsetof(tyn_config, kernel), {-1, 3, 1000, INT32_MIN}},
                  {offsetof(tyn_config, taps), {-1, 2, 6, INT32_MAX}},
                  {offsetof(tyn_config, downscale), {-1, 3, 16, INT32_MIN}},
                  {offsetof(tyn_config, budget), {-1, -2, -1000, INT32_MIN}},
                  {offsetof(tyn_config, maps), {-1, TYN_MAX_MAPS + 1, INT32_MAX, INT32_MIN}},
                  {offsetof(tyn_config, lights), {-1, TYN_MAX_LIGHTS + 1, INT32_MAX, INT32_MIN}},
                  {offsetof(tyn_config, workers), {-1, TYN_MAX_WORKERS + 1, INT32_MAX, INT32_MIN}}};
    static const float breaks[] = {-0.1f, 1.01f, BIG_NAN, BIG_INF};
    tyn_config good, config;
    size_t bytes = 77, need;
    tyn_context *context = NULL;
    uint8_t *block;
    TEST("tyn_measure and tyn_init refuse");
    memset(&good, 0, sizeof good);
    good.width = 33;
    good.height = 20;
    CHECK(tyn_measure(&good, &need) == TYN_OK && need > 0 && need % TYN_ALIGNMENT == 0);
    block = rig_block(need + TYN_ALIGNMENT);
    CHECK(block != NULL);
    if (!block)
        return;
    memset(block, 0x5a, need + TYN_ALIGNMENT);
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++)
        for (int i = 0; i < 4; i++) {
            config = good;
            memcpy((char *)&config + fields[f].offset, &fields[f].bad[i], sizeof(int32_t));
            CHECK(tyn_measure(&config, &bytes) == TYN_E_CONFIG && bytes == 77);
            CHECK(tyn_init(&context, &config, block, need) == TYN_E_CONFIG);
        }
    for (int i = 0; i < 4; i++) {
        config = good;
        config.break_threshold = breaks[i];
        CHECK(tyn_measure(&config, &bytes) == TYN_E_CONFIG && bytes == 77);
        config = good;
        config.tolerance = breaks[i];
        CHECK(tyn_measure(&config, &bytes) == TYN_E_CONFIG && bytes == 77);
    }
    CHECK(tyn_measure(NULL, &bytes) == TYN_E_NULL && bytes == 77);
    CHECK(tyn_measure(&good, NULL) == TYN_E_NULL);
    CHECK(tyn_init(NULL, &good, block, need) == TYN_E_NULL);
    CHECK(tyn_init(&context, NULL, block, need) == TYN_E_NULL);
    CHECK(tyn_init(&context, &good, NULL, need) == TYN_E_NULL);
    CHECK(tyn_init(&context, &good, block, need - 1) == TYN_E_MEMORY);
    CHECK(tyn_init(&context, &good, block, 0) == TYN_E_MEMORY);
    good.isa = 63 & ~tyn_isa_available();
    CHECK(tyn_init(&context, &good, block, need) == TYN_E_ISA);
    good.isa = 64;
    CHECK(tyn_init(&context, &good, block, need) == TYN_E_CONFIG);
    good.isa = -1;
    CHECK(tyn_measure(&good, &need) == TYN_E_CONFIG);
    good.isa = 0;
    CHECK(tyn_init(&context, &good, block + 32, need) == TYN_E_ALIGN);
    CHECK(tyn_init(&context, &good, block + 1, need) == TYN_E_ALIGN);
    CHECK(context == NULL);
    for (size_t i = 0; i < need + TYN_ALIGNMENT; i++)
        CHECK(block[i] == 0x5a);
    for (int32_t isa = 1; isa <= TYN_ISA_WASM; isa *= 2) { /* one of those that are allowed is enough */
        good.isa = isa;
        CHECK(tyn_init(&context, &good, block, need) == (tyn_isa_available() & isa ? TYN_OK : TYN_E_ISA));
        good.isa = isa | TYN_ISA_SCALAR;
        CHECK(tyn_init(&context, &good, block, need) == TYN_OK);
    }
    good.isa = 0;
    CHECK(tyn_init(&context, &good, block, need) == TYN_OK && (void *)context == (void *)block);
    for (size_t i = need; i < need + TYN_ALIGNMENT; i++)
        CHECK(block[i] == 0x5a);
    free(block);
}

void test_api(void)
{
    test_names();
    test_camera();
    test_air();
    test_fit();
    test_fit_scene();
    test_fit_cube();
    test_preset();
    test_ranges();
}
