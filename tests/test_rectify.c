/* test_rectify.c - projective rectification: its maps, and that nothing pops where they take over. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"
#include "rig.h"
#include "showcase.h"
#include "stock.h"
#include "test.h"

static void apply(const float *m, const float p[3], float out[4])
{
    for (int i = 0; i < 4; i++)
        out[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}

/* Along every view ray the row and the depth stay, u rises, and the splits follow one another without a gap. */
static void check_rays(const tyn_shadow *maps, int count, const tyn_camera *c)
{
    for (int n = 0; n < 200; n++) {
        float u = test_random_float(c->left_edge, c->right_edge), v = test_random_float(c->bottom_edge, c->top_edge);
        float row = -1, deep = -1, last = -1;
        int map = 0, fine = 1;
        for (float depth = c->near_depth; depth <= c->far_depth; depth *= 1.3f) {
            float p[3], out[4], at;
            int k = 0;
            for (int i = 0; i < 3; i++)
                p[i] = c->position[i] + depth * (c->forward[i] + u * c->right[i] + v * c->up[i]);
            for (; k < count; k++) {
                apply(maps[k].matrix, p, out);
                if (out[3] > 0 && out[0] >= -1e-4f * out[3] && out[0] <= 1.0001f * out[3])
                    break;
            }
            fine &= k < count && k >= map && out[1] > 0 && out[1] < out[3] && out[2] > 0 && out[2] < out[3];
            if (k >= count)
                break;
            at = (float)k + out[0] / out[3];
            fine &= at > last - 1e-4f;
            if (row >= 0)
                fine &= fabsf(out[1] / out[3] - row) < 2e-4f && fabsf(out[2] / out[3] - deep) < 2e-4f;
            row = out[1] / out[3];
            deep = out[2] / out[3];
            last = at;
            map = k;
        }
        CHECK(fine);
    }
}

static void test_maps(void)
{
    static const char *const off[] = {"sun off the left", "sun off the right", "sun off the top",
                                      "sun parallel to the picture"};
    static const char *const on[] = {"sun ahead", "sun in the corner of the view", "sun behind the camera", "lamp above"};
    tyn_shadow maps[TYN_MAX_MAPS], before[TYN_MAX_MAPS];
    TEST("projective rectification");
    for (int n = 0; n < 4; n++) {
        rig *r = rig_stock(off[n], 64, 48, 64);
        tyn_light *l = &r->light[0];
        CHECK(tyn_shadow_rectifiable(l, &r->camera) > 0.0f && tyn_shadow_rectifiable(l, &r->camera) <= 1.0f);
        for (int count = 1; count <= TYN_MAX_MAPS; count++) {
            memset(maps, 0, sizeof maps);
            CHECK(tyn_shadow_fit_rectified(maps, count, l, &r->camera, 0, 0) == TYN_OK);
            check_rays(maps, count, &r->camera);
        }
        memcpy(before, maps, sizeof maps);
        CHECK(tyn_shadow_fit_rectified(maps, 0, l, &r->camera, 0, 0) == TYN_E_LIMIT);
        CHECK(tyn_shadow_fit_rectified(maps, TYN_MAX_MAPS + 1, l, &r->camera, 0, 0) == TYN_E_LIMIT);
        CHECK(tyn_shadow_fit_rectified(NULL, 1, l, &r->camera, 0, 0) == TYN_E_NULL);
        CHECK(tyn_shadow_fit_rectified(maps, 1, NULL, &r->camera, 0, 0) == TYN_E_NULL);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, NULL, 0, 0) == TYN_E_NULL);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, -1, 0) == TYN_E_CAMERA);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 1e-40f, 0) == TYN_E_CAMERA);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 5, 4) == TYN_E_CAMERA);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 0, -4) == TYN_E_CAMERA);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, (float)NAN, 0) == TYN_E_CAMERA);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 0, (float)NAN) == TYN_E_CAMERA);
        maps[0].size = -1;
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 0, 0) == TYN_E_LIGHT);
        maps[0].size = before[0].size;
        CHECK(memcmp(before, maps, sizeof maps) == 0);
        r->camera.kind = TYN_CAMERA_ORTHOGRAPHIC;
        CHECK(tyn_shadow_rectifiable(l, &r->camera) == 0.0f);
        CHECK(tyn_shadow_fit_rectified(maps, 1, l, &r->camera, 0, 0) == TYN_E_CAMERA);
        rig_free(r);
    }
    for (int n = 0; n < 4; n++) {
        rig *r = rig_stock(on[n], 64, 48, 64);
        memset(maps, 0, sizeof maps);
        CHECK(tyn_shadow_rectifiable(&r->light[0], &r->camera) == 0.0f);
        CHECK(tyn_shadow_fit_rectified(maps, 4, &r->light[0], &r->camera, 0, 0) == TYN_E_LIGHT);
        rig_free(r);
    }
    CHECK(tyn_shadow_rectifiable(NULL, NULL) == 0.0f);
}

enum { W = 96, H = 54 };

/* The camera looks along -z, 60 degrees high at 16 : 9. The sun so many degrees to its right, past the border at 45.7. */
static void turn_sun(tyn_light *light, double degrees)
{
    double angle = degrees * 0.017453292519943295, d[3], length;
    d[0] = -sin(angle);
    d[1] = -0.35 * cos(angle);
    d[2] = cos(angle);
    length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; i++)
        light->direction[i] = (float)(d[i] / length);
}

static int draw(const scene *s, int rectify, pool *threads, float *out)
{
    render_settings settings;
    render_result result;
    tool_error error;
    memset(&settings, 0, sizeof settings);
    settings.width = W;
    settings.height = H;
    settings.method = TYN_METHOD_PREFILTERED + 1;
    settings.want_scatter = 1;
    settings.shadow_size = 512;
    settings.slices = 128;
    settings.columns = 64;
    settings.rectify = rectify;
    if (render_scene(s, "scene", &settings, threads, &result, &error) != 0)
        return -1;
    memcpy(out, result.scatter, 3 * W * H * sizeof *out);
    render_free(&result);
    return 0;
}

static void walk(const char *name, pool *threads)
{
    static float now[3 * W * H], last[3 * W * H];
    double inside = 0, outside = 0, most_inside = 0, most_outside = 0;
    int in = 0, out = 0, full = 0;
    float before = -1;
    scene s;
    scene_init(&s);
    CHECK(showcase_scene(name, &s) == 0);
    for (int n = 0; n <= 44; n++) {
        tyn_camera camera;
        double change;
        float weight;
        turn_sun(&s.lights[0].light, 47.5 + 0.2 * n);
        CHECK(scene_camera_make(&s, W, H, &camera) == TYN_OK);
        weight = tyn_shadow_rectifiable(&s.lights[0].light, &camera);
        CHECK(weight >= before && (before < 0 || weight < before + 0.2f));
        CHECK(draw(&s, RENDER_PROJECTIVE, threads, now) == 0);
        change = rig_l1(now, last, 3 * W * H);
        if (getenv("TYN_SAY"))
            printf("  %s: weight %.3f, change %.5f\n", name, (double)weight, n ? change : 0);
        if (before >= 0 && weight > before) {
            inside += change;
            most_inside = fmax(most_inside, change);
            in++;
        } else if (before >= 0) {
            outside += change;
            most_outside = fmax(most_outside, change);
            out++;
        }
        full += weight >= 1.0f;
        memcpy(last, now, sizeof now);
        before = weight;
    }
    CHECK(in > 10 && out > 10 && full > 10);
    printf("  %s: change per step of 0.2 degrees, in the band mean %.5f, most %.5f; outside %.5f, %.5f\n", name, inside / in,
           most_inside, outside / out, most_outside);
    CHECK(inside / in < outside / out && most_inside < most_outside);
    scene_free(&s);
}

/* The sun comes to the screen in small steps: inside the band where both kinds of maps are drawn the picture changes no more
 * from step to step than outside of it. */
static void test_band(void)
{
    pool *threads = pool_create(1);
    TEST("projective rectification sets in without a pop");
    CHECK(threads != NULL);
    if (threads) {
        walk("simple-off", threads);
        walk("leafy-off", threads);
    }
    pool_free(threads);
}

void test_rectify(void)
{
    test_maps();
    test_band();
}
