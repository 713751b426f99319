/* test_raster_light.c - level (a), light: textures, masks, Lambert, spots, against formulas in double precision. Shadows are in
 * test_raster_shadow.c. */
#include <math.h>
#include <string.h>

#include "pane.h"
#include "test.h"

/* ---- textures and masks --------------------------------------------------------------------------------------------- */

static double texel(const tyn_image *image, int64_t x, int64_t y, int c)
{
    const int32_t i = (int32_t)(((x % image->width) + image->width) % image->width);
    const int32_t j = (int32_t)(((y % image->height) + image->height) % image->height);
    const uint8_t *row = (const uint8_t *)image->pixels + image->stride * j;
    if (image->format == TYN_RGB8_LINEAR)
        return row[3 * i + c] / 255.0;
    if (image->format == TYN_RGB16_LINEAR)
        return ((const uint16_t *)(const void *)row)[3 * i + c] / 65535.0;
    return (double)((const float *)(const void *)row)[3 * i + c];
}

static double bilinear(const tyn_image *image, double u, double v, int c)
{
    const double x = u * image->width - 0.5, y = (1 - v) * image->height - 0.5, fx = x - floor(x), fy = y - floor(y);
    const int64_t i = (int64_t)floor(x), j = (int64_t)floor(y);
    return (texel(image, i, j, c) * (1 - fx) + texel(image, i + 1, j, c) * fx) * (1 - fy) +
           (texel(image, i, j + 1, c) * (1 - fx) + texel(image, i + 1, j + 1, c) * fx) * fy;
}

static void test_textures(void)
{
    static const tyn_format formats[] = {TYN_RGB8_LINEAR, TYN_RGB16_LINEAR, TYN_RGB_F32};
    easel e = easel_new(48, 40, 64, 1, 0);
    double worst = 0;
    int seen = 0;
    TEST("raster: textures against bilinear in double precision");
    for (int c = 0; c < 3; c++)
        e.surface.ambient[c] = 1;
    for (int round = 0; round < 60; round++) {
        const int32_t w = 1 + (int32_t)(test_random() % 9), h = 1 + (int32_t)(test_random() % 9);
        guard picture = guard_new(w, h, formats[round % 3], round & 1);
        const float u0 = test_random_float(-3, 3), du = test_random_float(-4, 4), v0 = test_random_float(-3, 3),
                    dv = test_random_float(-4, 4);
        pane q;
        uint8_t *row = picture.image.pixels;
        pane_lean(&q, (double)test_random_float(2, 20));
        for (int32_t y = 0; y < h; y++, row += picture.image.stride)
            for (int32_t i = 0; i < 3 * w; i++) {
                const float r = test_random_float(0, 1);
                if (round % 3 == 0)
                    row[i] = (uint8_t)(r * 255);
                else if (round % 3 == 1)
                    ((uint16_t *)(void *)row)[i] = (uint16_t)(r * 65535);
                else
                    ((float *)(void *)row)[i] = r;
            }
        pane_map(&q, u0, du, v0, dv);
        q.mesh.material.texture = &picture.image;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < 40; y++)
            for (int32_t x = 0; x < 48; x++) {
                double point[3], s, t;
                if (!pane_hit(&q, &e, x, y, point, &s, &t))
                    continue;
                seen++;
                for (int c = 0; c < 3; c++) {
                    const double u = (double)u0 + s * (double)du, v = (double)v0 + t * (double)dv;
                    const double want = bilinear(&picture.image, u, v, c) * (0.25 * (c + 1)) / PANE_PI;
                    const double error = fabs((double)easel_colour(&e, x, y)[c] - want);
                    worst = error > worst ? error : worst;
                }
            }
        guard_free(&picture);
    }
    CHECK(seen > 20000);
    CHECK_NEAR(worst, 0, 3e-5); /* of a texel's contrast: coordinates of up to 40 texels in single precision */
    easel_free(&e);
}

/* Holes for the camera and in the shadow map; texels of 4 x 3, so that a mirrored or turned one shows. */
static void test_masks(void)
{
    enum { SIZE = 40 };
    static uint8_t bytes[12] = {255, 0, 128, 127, 0, 200, 0, 255, 255, 255, 0, 0};
    static float map[SIZE * SIZE];
    const tyn_image mask = {bytes, 4, 3, 0, TYN_MASK8};
    easel e = easel_new(SIZE, SIZE, 64, 1, 0);
    int wrong = 0, seen = 0;
    TEST("raster: masks cut holes for the camera and for shadows");
    for (int round = 0; round < 40; round++) {
        const float u0 = test_random_float(-2, 2), v0 = test_random_float(-2, 2);
        pane q;
        tyn_shadow shadow = {.size = SIZE};
        pane_lean(&q, (double)test_random_float(2, 9));
        pane_map(&q, u0, 1.5f, v0, -1.25f);
        q.mesh.material.mask = &mask;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        /* The camera as a perspective light: the same pixels. */
        shadow.matrix[0] = 0.5f / e.surface.camera.right_edge;
        shadow.matrix[5] = -0.5f / e.surface.camera.top_edge;
        shadow.matrix[2] = shadow.matrix[6] = -0.5f;
        shadow.matrix[11] = 0.1f;
        shadow.matrix[14] = -1.0f;
        CHECK(easel_shadow(&e, &shadow, map, &q.mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < SIZE; y++)
            for (int32_t x = 0; x < SIZE; x++) {
                double point[3], s, t, u, v;
                int32_t i, j;
                if (!pane_hit(&q, &e, x, y, point, &s, &t))
                    continue;
                u = ((double)u0 + 1.5 * s) * 4;
                v = (1 - ((double)v0 - 1.25 * t)) * 3;
                if (fabs(u - floor(u + 0.5)) < 1e-4 || fabs(v - floor(v + 0.5)) < 1e-4)
                    continue;
                i = (((int32_t)floor(u) % 4) + 4) % 4;
                j = (((int32_t)floor(v) % 3) + 3) % 3;
                seen++;
                wrong += (easel_depth(&e, x, y) < 1000.0f) != (bytes[4 * j + i] >= 128);
                wrong += (map[y * SIZE + x] > 0) != (bytes[4 * j + i] >= 128);
            }
    }
    CHECK(seen > 10000);
    CHECK_NEAR(wrong, 0, 0);
    {
        pane q; /* without coordinates neither counts */
        pane_lean(&q, 5);
        bytes[0] = 0;
        q.mesh.material.mask = &mask;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        CHECK(e.stats.pixels > SIZE * SIZE / 2);
    }
    easel_free(&e);
}

/* ---- light ---------------------------------------------------------------------------------------------------------- */

static void test_lambert(void)
{
    easel e = easel_new(40, 32, 64, 1, 0);
    double worst = 0;
    int seen = 0, lit = 0, dark = 0;
    TEST("raster: Lambert, two-sided, suns, spots and points in haze");
    for (int round = 0; round < 80; round++) {
        tyn_light light[3];
        tyn_medium medium[2];
        double sigma[3], n[3];
        pane q;
        pane_lean(&q, (double)test_random_float(1, 9));
        memset(medium, 0, sizeof medium);
        for (int i = 0; i < 3; i++)
            light[i] = pane_light((tyn_light_kind)i);
        light[2].position[2] = test_random_float(-20, 2); /* before the surface or behind it */
        for (int c = 0; c < 3; c++) {
            medium[0].scatter[c] = test_random_float(0, 0.1f);
            medium[1].absorb[c] = test_random_float(0, 0.1f);
            sigma[c] = (double)medium[0].scatter[c] + (double)medium[1].absorb[c];
            e.surface.ambient[c] = test_random_float(0, 1);
            e.surface.background[c] = test_random_float(0, 1);
        }
        e.surface.lights = light;
        e.surface.light_count = 3;
        e.surface.media = medium;
        e.surface.medium_count = 2;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        pane_normal(&q, n);
        for (int32_t y = 0; y < 32; y++)
            for (int32_t x = 0; x < 40; x++) {
                double point[3], s, t, sum[3], edge = 1;
                const float *got = easel_colour(&e, x, y);
                if (easel_depth(&e, x, y) == 1000.0f)
                    CHECK(memcmp(got, e.surface.background, 12) == 0);
                if (!pane_hit(&q, &e, x, y, point, &s, &t))
                    continue;
                for (int c = 0; c < 3; c++)
                    sum[c] = (double)e.surface.ambient[c];
                for (int i = 0; i < 3; i++)
                    pane_add_light(&light[i], point, n, sigma, sum, &edge);
                if (edge < 1e-5)
                    continue;
                seen++;
                lit += sum[0] > (double)e.surface.ambient[0];
                dark += sum[0] == (double)e.surface.ambient[0];
                for (int c = 0; c < 3; c++) {
                    const double want = sum[c] * (0.25 * (c + 1)) / PANE_PI,
                                 error = fabs((double)got[c] - want) / (want + 0.01);
                    worst = error > worst ? error : worst;
                }
            }
    }
    CHECK(seen > 20000 && lit > 2000 && dark > 50);
    CHECK_NEAR(worst, 0, 2e-4); /* spots a hand before the surface among them */
    easel_free(&e);
}

void test_raster_light(void)
{
    test_textures();
    test_masks();
    test_lambert();
}
