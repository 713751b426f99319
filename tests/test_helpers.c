/* test_helpers.c - cameras from matrices, air from the weather report, cascades, and maps that do not crawl. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

/* ---- weather -------------------------------------------------------------------------------------------------------- */

static void test_weather(void)
{
    static const struct {
        float turbidity, visibility, angstrom;
    } bad[] = {{0.9f, 1000, 1},    {(float)NAN, 1000, 1},   {(float)INFINITY, 1000, 1}, {2, -1, 1},
               {2, (float)NAN, 1}, {2, (float)INFINITY, 1}, {2, 1000, -0.1f},           {2, 1000, 4.1f},
               {2, 1e-35f, 1},     {2, 1e-13f, 1},          {2, 1000, (float)NAN},      {3e38f, 0, 1}};
    tyn_medium media[2], air[2], before[2];
    TEST("tyn_medium_weather: Koschmieder, Angstrom, and the earth's air");
    CHECK(tyn_medium_air(air, 1) == TYN_OK);
    CHECK(tyn_medium_weather(media, 1, 0, 0) == TYN_OK); /* molecules alone */
    for (int c = 0; c < 3; c++)
        CHECK(media[1].scatter[c] == 0.0f && fabs((double)(media[0].scatter[c] / air[0].scatter[c]) - 1) < 1e-6);
    CHECK(media[0].phase == TYN_PHASE_RAYLEIGH && media[1].phase == TYN_PHASE_HG && media[1].g == air[1].g);
    for (float turbidity = 1; turbidity < 100; turbidity *= 1.7f)
        for (float visibility = 10; visibility < 2e5f; visibility *= 6) {
            float angstrom = test_random_float(0, 4);
            double air_550, haze_550;
            CHECK(tyn_medium_weather(media, turbidity, visibility, angstrom) == TYN_OK);
            air_550 = (double)media[0].scatter[1];
            haze_550 = (double)media[1].scatter[1];
            /* 2 % of contrast at the visibility, shared as the turbidity says */
            CHECK_NEAR(exp(-(air_550 + haze_550) * (double)visibility), 0.02, 1e-5);
            CHECK_NEAR((air_550 + haze_550) / air_550, turbidity, 1e-5 * (double)turbidity);
            CHECK_NEAR((double)media[0].scatter[2] / air_550, 33.1 / 13.5, 1e-5);
            if (haze_550 > 0) {
                CHECK_NEAR((double)media[1].scatter[0] / haze_550, pow(550.0 / 680, (double)angstrom), 1e-5);
                CHECK_NEAR((double)media[1].scatter[2] / haze_550, pow(550.0 / 440, (double)angstrom), 1e-5);
            }
        }
    memcpy(before, media, sizeof before);
    CHECK(tyn_medium_weather(NULL, 2, 1000, 1) == TYN_E_NULL);
    for (size_t n = 0; n < sizeof bad / sizeof *bad; n++)
        CHECK(tyn_medium_weather(media, bad[n].turbidity, bad[n].visibility, bad[n].angstrom) == TYN_E_MEDIUM);
    CHECK(memcmp(media, before, sizeof media) == 0);
}

/* ---- matrices ------------------------------------------------------------------------------------------------------- */

static tyn_camera any_camera(void)
{
    static const float up[3] = {0, 1, 0};
    float position[3], target[3];
    tyn_camera c;
    for (int k = 0; k < 3; k++) {
        position[k] = test_random_float(-50, 50);
        target[k] = position[k] + test_random_float(-1, 1);
    }
    target[0] += 1.5f;
    memset(&c, 0, sizeof c);
    CHECK(tyn_camera_look(&c, position, target, up, test_random_float(0.3f, 2), 0.25f, 80, 16, 9) == TYN_OK);
    c.left_edge -= test_random_float(0, 1); /* off-centre */
    c.top_edge += test_random_float(0, 1);
    return c;
}

static void view_of(const tyn_camera *c, float m[16])
{
    for (int k = 0; k < 3; k++) {
        m[k] = c->right[k];
        m[4 + k] = c->up[k];
        m[8 + k] = -c->forward[k];
        m[12 + k] = 0;
    }
    for (int r = 0; r < 3; r++)
        m[4 * r + 3] = -(m[4 * r] * c->position[0] + m[4 * r + 1] * c->position[1] + m[4 * r + 2] * c->position[2]);
    m[15] = 1;
}

enum { GL, D3D, REVERSED, INFINITE, VULKAN, CONVENTIONS };

/* The textbook's matrix, times any factor. */
static void projection_of(const tyn_camera *c, int convention, float factor, float m[16])
{
    float w = c->right_edge - c->left_edge, h = c->top_edge - c->bottom_edge, n = c->near_depth, f = c->far_depth;
    int flat = c->kind == TYN_CAMERA_ORTHOGRAPHIC;
    memset(m, 0, 16 * sizeof *m);
    m[0] = 2 / w;
    m[5] = 2 / h;
    m[flat ? 3 : 2] = (flat ? -1.0f : 1.0f) * (c->right_edge + c->left_edge) / w;
    m[flat ? 7 : 6] = (flat ? -1.0f : 1.0f) * (c->top_edge + c->bottom_edge) / h;
    if (convention == VULKAN) {
        m[5] = -m[5];
        m[flat ? 7 : 6] = -m[flat ? 7 : 6];
    }
    m[10] = convention == GL         ? -(f + n) / (f - n)
            : convention == REVERSED ? n / (f - n)
            : convention == INFINITE ? -1
                                     : -f / (f - n);
    m[11] = convention == GL         ? -2 * f * n / (f - n)
            : convention == REVERSED ? f * n / (f - n)
            : convention == INFINITE ? -n
                                     : -f * n / (f - n);
    m[flat ? 15 : 14] = flat ? 1 : -1;
    for (int i = 0; i < 16; i++)
        m[i] *= factor;
}

static void test_matrices(void)
{
    TEST("tyn_camera_from_matrices: every convention gives the camera back");
    for (int n = 0; n < 40 * CONVENTIONS; n++) {
        tyn_camera want = any_camera(), got;
        float view[16], projection[16];
        if (n % 3 == 0) {
            want.kind = TYN_CAMERA_ORTHOGRAPHIC;
            want.left_edge *= 8;
        }
        memset(&got, 0x5a, sizeof got);
        view_of(&want, view);
        projection_of(&want, n % CONVENTIONS, n % 2 ? 1 : test_random_float(0.1f, 10), projection);
        CHECK(tyn_camera_from_matrices(&got, view, projection, want.near_depth, want.far_depth) == TYN_OK);
        CHECK(got.kind == want.kind && got.near_depth == want.near_depth && got.far_depth == want.far_depth);
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(got.position[k], want.position[k], 1e-4);
            CHECK_NEAR(got.right[k], want.right[k], 1e-6);
            CHECK_NEAR(got.up[k], want.up[k], 1e-6);
            CHECK_NEAR(got.forward[k], want.forward[k], 1e-6);
        }
        CHECK_NEAR(got.left_edge, want.left_edge, 2e-5);
        CHECK_NEAR(got.right_edge, want.right_edge, 2e-5);
        CHECK_NEAR(got.bottom_edge, want.bottom_edge, 2e-5);
        CHECK_NEAR(got.top_edge, want.top_edge, 2e-5);
    }
}

/* And a picture made through them is the picture. */
static void test_matrix_picture(void)
{
    enum { W = 40, H = 30 };
    rig *r = rig_stock("sun ahead", W, H, 128);
    tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    static float first[3 * W * H];
    float view[16], projection[16];
    TEST("tyn_camera_from_matrices: the same picture");
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(first, r->scatter, sizeof first);
    view_of(&r->camera, view);
    projection_of(&r->camera, INFINITE, 1, projection);
    CHECK(tyn_camera_from_matrices(&frame.camera, view, projection, r->camera.near_depth, r->camera.far_depth) == TYN_OK);
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK_NEAR(rig_l1(r->scatter, first, 3 * W * H), 0, 1e-4);
    rig_free(r);
}

static void test_matrix_errors(void)
{
    TEST("tyn_camera_from_matrices: what is no such matrix");
    for (int flat = 0; flat < 2; flat++)
        for (int n = 0; n < 22; n++) {
            tyn_camera c = any_camera(), got, before;
            float view[16], p[16], n0 = c.near_depth, f0 = c.far_depth;
            tyn_status want = TYN_E_CAMERA;
            c.kind = flat ? TYN_CAMERA_ORTHOGRAPHIC : TYN_CAMERA_PERSPECTIVE;
            view_of(&c, view);
            projection_of(&c, GL, 1, p);
            switch (n) {
            case 0:
                view[5] = (float)NAN;
                break;
            case 1:
                view[3] = (float)INFINITY;
                break;
            case 2:
                p[0] = (float)NAN;
                break;
            case 3:
                view[0] *= 1.1f, view[1] *= 1.1f, view[2] *= 1.1f;
                break; /* scaled */
            case 4:
                view[4] += 0.2f;
                view[5] += 0.1f;
                break; /* sheared */
            case 5:
                view[0] = -view[0], view[1] = -view[1], view[2] = -view[2];
                break; /* mirrored */
            case 6:
                view[12] = 0.1f;
                break;
            case 7:
                view[15] = 2;
                break;
            case 8:
                p[0] = 0;
                break;
            case 9:
                p[0] = -p[0];
                break;
            case 10:
                p[5] = 0;
                break;
            case 11:
                p[1] = 0.1f;
                break;
            case 12:
                p[4] = 0.1f;
                break;
            case 13:
                p[flat ? 2 : 3] = 0.1f;
                break;
            case 14:
                p[flat ? 6 : 7] = 0.1f;
                break;
            case 15:
                p[12] = 0.1f;
                break;
            case 16:
                p[13] = 0.1f;
                break;
            case 17:
                p[flat ? 14 : 15] = 0.3f;
                break;
            case 18:
                p[14] = flat ? -1.0f : 1.0f;
                break; /* along +Z, or neither kind */
            case 19:
                n0 = 0;
                break;
            case 20:
                f0 = n0;
                break;
            default:
                p[8] = p[10] = (float)NAN;
                want = TYN_OK; /* the depth's row is not read */
            }
            memset(&got, 0x5a, sizeof got);
            before = got;
            CHECK(tyn_camera_from_matrices(&got, view, p, n0, f0) == want);
            CHECK((memcmp(&got, &before, sizeof got) == 0) == (want != TYN_OK));
            CHECK(tyn_camera_from_matrices(NULL, view, p, n0, f0) == TYN_E_NULL);
            CHECK(tyn_camera_from_matrices(&got, NULL, p, n0, f0) == TYN_E_NULL);
            CHECK(tyn_camera_from_matrices(&got, view, NULL, n0, f0) == TYN_E_NULL);
        }
}

/* ---- maps that do not crawl ------------------------------------------------------------------------------------------ */

static void map_point(const float m[16], const double p[3], double out[3])
{
    double w = (double)m[12] * p[0] + (double)m[13] * p[1] + (double)m[14] * p[2] + (double)m[15];
    for (int k = 0; k < 3; k++)
        out[k] =
            ((double)m[4 * k] * p[0] + (double)m[4 * k + 1] * p[1] + (double)m[4 * k + 2] * p[2] + (double)m[4 * k + 3]) / w;
}

/* A point that the camera sees, at a depth. */
static void seen_point(const tyn_camera *c, float depth, double p[3])
{
    double size = c->kind == TYN_CAMERA_ORTHOGRAPHIC ? 1 : (double)depth;
    double x = size * (double)test_random_float(c->left_edge, c->right_edge);
    double y = size * (double)test_random_float(c->bottom_edge, c->top_edge);
    for (int k = 0; k < 3; k++)
        p[k] = (double)c->position[k] + x * (double)c->right[k] + y * (double)c->up[k] + (double)depth * (double)c->forward[k];
}

static tyn_light any_sun(void)
{
    tyn_light light;
    double length = 0;
    memset(&light, 0, sizeof light);
    for (int k = 0; k < 3; k++) {
        light.direction[k] = test_random_float(-1, 1);
        length += (double)light.direction[k] * (double)light.direction[k];
    }
    for (int k = 0; k < 3; k++)
        light.direction[k] = (float)((double)light.direction[k] / sqrt(length));
    return light;
}

static void test_snap(void)
{
    TEST("tyn_shadow_snap: all that is seen is covered, and the grid stays where it is");
    for (int n = 0; n < 24; n++) {
        const tyn_light light = any_sun();
        const double fixed[3] = {3.3, 1.7, -4.1};
        tyn_camera camera = any_camera();
        tyn_shadow map, first;
        double at[3], p[3], home[3];
        float distance = n % 3 ? 25 : 0, far_end = n % 3 ? 25 : 80;
        if (n % 4 == 0)
            camera.kind = TYN_CAMERA_ORTHOGRAPHIC;
        memset(&map, 0, sizeof map);
        map.size = n % 2 ? 512 : 1000;
        CHECK(tyn_shadow_snap(&map, &light, &camera, distance) == TYN_OK);
        first = map;
        map_point(first.matrix, fixed, home);
        for (int step = 0; step < 60; step++) {
            const float up[3] = {0, 1, 0};
            float target[3];
            tyn_camera moved = camera;
            for (int k = 0; k < 3; k++) { /* walk and look around */
                camera.position[k] += test_random_float(-0.3f, 0.3f);
                target[k] = camera.position[k] + camera.forward[k] + test_random_float(-0.05f, 0.05f);
            }
            CHECK(tyn_camera_look(&moved, camera.position, target, up, 1, camera.near_depth, camera.far_depth, 1, 1) == TYN_OK);
            memcpy(camera.right, moved.right, sizeof camera.right);
            memcpy(camera.up, moved.up, sizeof camera.up);
            memcpy(camera.forward, moved.forward, sizeof camera.forward);
            CHECK(tyn_shadow_snap(&map, &light, &camera, distance) == TYN_OK);
            for (int i = 0; i < 16; i++) /* a shift is all that differs */
                CHECK((i % 4 == 3 && i < 12) || map.matrix[i] == first.matrix[i]);
            for (int i = 3; i < 12; i += 4) {
                double texels = (double)(map.matrix[i] - first.matrix[i]) * (double)map.size;
                CHECK_NEAR(texels, floor(texels + 0.5), 2e-3);
            }
            map_point(map.matrix, fixed, at); /* so a place stays at its place in a texel */
            for (int k = 0; k < 2; k++) {
                double texels = (at[k] - home[k]) * (double)map.size;
                CHECK_NEAR(texels, floor(texels + 0.5), 2e-3);
            }
            for (int i = 0; i < 40; i++) {
                seen_point(&camera, test_random_float(0, far_end), p);
                map_point(map.matrix, p, at);
                for (int k = 0; k < 2; k++)
                    CHECK(at[k] * map.size >= 1.9 && at[k] * map.size <= map.size - 1.9);
                CHECK(at[2] > 0 && at[2] < 1);
            }
        }
        CHECK(map.depth == NULL && map.size == first.size);
    }
}

static void test_snap_errors(void)
{
    tyn_camera camera = any_camera(), odd;
    tyn_light light = any_sun();
    tyn_shadow map, before;
    TEST("tyn_shadow_snap: statuses");
    memset(&map, 0, sizeof map);
    map.size = 256;
    before = map;
    CHECK(tyn_shadow_snap(NULL, &light, &camera, 10) == TYN_E_NULL);
    CHECK(tyn_shadow_snap(&map, NULL, &camera, 10) == TYN_E_NULL);
    CHECK(tyn_shadow_snap(&map, &light, NULL, 10) == TYN_E_NULL);
    CHECK(tyn_shadow_snap(&map, &light, &camera, -1) == TYN_E_CAMERA);
    CHECK(tyn_shadow_snap(&map, &light, &camera, (float)NAN) == TYN_E_CAMERA);
    CHECK(tyn_shadow_snap(&map, &light, &camera, camera.near_depth) == TYN_E_CAMERA);
    odd = camera;
    odd.up[0] += 1;
    CHECK(tyn_shadow_snap(&map, &light, &odd, 10) == TYN_E_CAMERA);
    light.kind = TYN_LIGHT_POINT;
    CHECK(tyn_shadow_snap(&map, &light, &camera, 10) == TYN_E_LIGHT);
    light.kind = TYN_LIGHT_DIRECTIONAL;
    light.direction[0] = 3;
    CHECK(tyn_shadow_snap(&map, &light, &camera, 10) == TYN_E_LIGHT);
    light = any_sun();
    CHECK(memcmp(&map, &before, sizeof map) == 0);
    map.size = 15;
    CHECK(tyn_shadow_snap(&map, &light, &camera, 10) == TYN_E_LIGHT);
    map.size = TYN_MAX_SHADOW + 1;
    CHECK(tyn_shadow_snap(&map, &light, &camera, 10) == TYN_E_LIGHT);
    map.size = 16;
    CHECK(tyn_shadow_snap(&map, &light, &camera, 1e30f) == TYN_OK);
}

/* ---- cascades ------------------------------------------------------------------------------------------------------- */

static void test_splits(void)
{
    TEST("tyn_shadow_fit_cascades: each covers what is seen up to its split");
    for (int n = 0; n < 40; n++) {
        const tyn_light light = any_sun();
        const tyn_camera camera = any_camera();
        tyn_shadow map[TYN_MAX_MAPS];
        int count = 1 + n % TYN_MAX_MAPS, snapped = n / 8 % 2;
        float lambda = n < 8 ? 0 : n < 16 ? 1 : test_random_float(0, 1), distance = n % 3 ? 30.0f : 0.0f;
        double end = n % 3 ? 30 : (double)camera.far_depth, near = (double)camera.near_depth, width = 0, p[3], at[3];
        memset(map, 0, sizeof map);
        for (int i = 0; i < count; i++)
            map[i].size = 256;
        CHECK(tyn_shadow_fit_cascades(map, count, &light, &camera, NULL, NULL, distance, lambda, snapped) == TYN_OK);
        for (int i = 0; i < count; i++) {
            double x = (i + 1.0) / count, own;
            double split = (double)lambda * near * pow(end / near, x) + (1 - (double)lambda) * (near + (end - near) * x);
            int beyond = 0;
            for (int k = 0; k < 200; k++) {
                seen_point(&camera, test_random_float(0, (float)(split * 0.9999)), p);
                map_point(map[i].matrix, p, at);
                CHECK(at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1 && at[2] > 0 && at[2] < 1);
                seen_point(&camera, (float)(split * 10), p);
                map_point(map[i].matrix, p, at);
                beyond += at[0] < 0 || at[0] > 1 || at[1] < 0 || at[1] > 1 || at[2] < 0 || at[2] > 1;
            }
            CHECK(beyond > 0); /* and no more than that */
            own = 1 / sqrt((double)(map[i].matrix[0] * map[i].matrix[0] + map[i].matrix[1] * map[i].matrix[1] +
                                    map[i].matrix[2] * map[i].matrix[2]));
            CHECK(own > width); /* finest first */
            width = own;
        }
    }
}

/* Four small maps by cascades against one large: pictures of the same scene. */
static void test_cascade_picture(void)
{
    enum { W = 64, H = 48, COUNT = 3 * W * H, MAPS = 4, SIZE = 256 };
    static float truth[COUNT], single[COUNT], depth[MAPS][SIZE * SIZE];
    TEST("tyn_shadow_fit_cascades: a picture");
    for (int snapped = 0; snapped < 2; snapped++) {
        rig *r = rig_stock("sun off the left", W, H, 2048), *coarse = rig_stock("sun off the left", W, H, SIZE);
        tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
        tyn_frame frame = rig_frame(r);
        tyn_raster_config raster_config = {SIZE, SIZE, 0, 0, 0};
        tyn_raster *raster = NULL;
        tyn_shadow map[MAPS];
        tyn_light light = r->light[0];
        size_t bytes = 0;
        void *block;
        frame.scatter.pixels = truth;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        frame.lights = coarse->light;
        frame.scatter.pixels = single;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(tyn_raster_measure(&raster_config, &bytes) == TYN_OK);
        block = rig_block(bytes);
        CHECK(block && tyn_raster_init(&raster, &raster_config, block, bytes) == TYN_OK);
        memset(map, 0, sizeof map);
        for (int i = 0; i < MAPS; i++) {
            map[i].size = SIZE;
            map[i].depth = depth[i];
        }
        CHECK(tyn_shadow_fit_cascades(map, MAPS, &light, &r->camera, r->bounds_min, r->bounds_max, 0, 0.8f, snapped) == TYN_OK);
        for (int i = 0; i < MAPS && raster; i++)
            CHECK(tyn_raster_shadow(raster, &map[i], depth[i], r->mesh, r->meshes, NULL, NULL, NULL, NULL) == TYN_OK);
        light.shadow = map[0];
        light.more = map + 1;
        light.more_count = MAPS - 1;
        frame.lights = &light;
        frame.scatter.pixels = r->scatter;
        for (int way = 0; way < 3; way += 2) {
            config.method = rig_ways[way].method;
            config.maps = MAPS;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            /* texels four times as many: fitted ones show less than a third of the error, snapped ones about the same */
            CHECK_NEAR(rig_l1(r->scatter, truth, COUNT), 0, snapped ? 0.006 : way ? 0.3 * rig_l1(single, truth, COUNT) : 0.004);
        }
        free(block);
        rig_free(r);
        rig_free(coarse);
    }
}

static void test_cascade_errors(void)
{
    const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    tyn_camera camera = any_camera();
    tyn_light light = any_sun();
    tyn_shadow map[TYN_MAX_MAPS], before[TYN_MAX_MAPS];
    TEST("tyn_shadow_fit_cascades: statuses");
    memset(map, 0, sizeof map);
    memcpy(before, map, sizeof map);
    CHECK(tyn_shadow_fit_cascades(NULL, 2, &light, &camera, low, high, 0, 0.5f, 0) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cascades(map, 2, NULL, &camera, low, high, 0, 0.5f, 0) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, NULL, low, high, 0, 0.5f, 0) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, NULL, 0, 0.5f, 0) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, NULL, high, 0, 0.5f, 0) == TYN_E_NULL);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, high, low, 0, 0.5f, 0) == TYN_E_MESH);
    CHECK(tyn_shadow_fit_cascades(map, 0, &light, &camera, low, high, 0, 0.5f, 0) == TYN_E_LIMIT);
    CHECK(tyn_shadow_fit_cascades(map, TYN_MAX_MAPS + 1, &light, &camera, low, high, 0, 0.5f, 0) == TYN_E_LIMIT);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, 1.01f, 0) == TYN_E_CONFIG);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, -0.01f, 0) == TYN_E_CONFIG);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, (float)NAN, 0) == TYN_E_CONFIG);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0.01f, 0.5f, 0) == TYN_E_CAMERA);
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, 0.5f, 1) == TYN_E_LIGHT); /* no sizes */
    map[1].size = before[1].size = -1;
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, 0.5f, 0) == TYN_E_LIGHT);
    map[1].size = before[1].size = 0;
    light.kind = TYN_LIGHT_SPOT;
    light.angle = 1;
    CHECK(tyn_shadow_fit_cascades(map, 2, &light, &camera, low, high, 0, 0.5f, 0) == TYN_E_LIGHT);
    CHECK(memcmp(map, before, sizeof map) == 0);
}

void test_helpers(void)
{
    test_weather();
    test_matrices();
    test_matrix_picture();
    test_matrix_errors();
    test_snap();
    test_snap_errors();
    test_splits();
    test_cascade_picture();
    test_cascade_errors();
}
