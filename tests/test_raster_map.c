/* test_raster_map.c - level (a): what a shadow map holds. */
#include <math.h>
#include <stdlib.h>

#include "easel.h"
#include "test.h"

static double square(const double a[3], const double b[3])
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = b[k] - a[k];
    return easel_dot(d, d);
}

static void test_shadow_values(int perspective)
{
    enum { SIZE = 48 };
    static float map[SIZE * SIZE];
    easel e = easel_new(SIZE, SIZE, 64, 1, 0);
    const double step[2] = {1.0 / SIZE, 1.0 / SIZE};
    int missed = 0, extra = 0, seen = 0, clamped = 0;
    double worst = 0;
    TEST(perspective ? "raster: a spot's map against exact rays" : "raster: a sun's map against exact rays");
    for (int round = 0; round < 1000; round++) {
        tyn_shadow s = {.size = SIZE};
        float p[9];
        double v[3][3], z[3], broad;
        easel_exact t;
        tyn_mesh mesh = easel_mesh(p, 1);
        easel_random_matrix(s.matrix, perspective);
        for (int i = 0; i < 9; i++)
            p[i] = test_random_float(-4, 4);
        for (int i = 0; i < 3; i++) {
            double h[4];
            for (int r = 0; r < 4; r++) {
                h[r] = (double)s.matrix[4 * r + 3];
                for (int k = 0; k < 3; k++)
                    h[r] += (double)s.matrix[4 * r + k] * (double)p[3 * i + k];
            }
            v[i][0] = h[0];
            v[i][1] = h[1];
            v[i][2] = h[3];
            z[i] = h[2];
        }
        t = easel_exact_new(v);
        broad = sqrt(easel_dot(t.normal, t.normal) / (square(v[0], v[1]) * square(v[0], v[2]))); /* 0: in a line */
        CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < SIZE; y++)
            for (int32_t x = 0; x < SIZE; x++) {
                const double r[3] = {(x + 0.5) / SIZE, (y + 0.5) / SIZE, 1}, got = (double)map[y * SIZE + x];
                double w = easel_exact_hit(&t, r, step, 0.02), want = 0, weight = 0, scale = 0;
                if (w < 0 || (w > 0 && w < 1e-3))
                    continue;
                if (w == 0) {
                    extra += got != 0;
                    continue;
                }
                for (int k = 0; k < 3; k++) { /* weights of the corners where w r lies; z = Z / w there */
                    const double b = easel_dot(t.edge[(k + 1) % 3], r) * w / t.distance;
                    want += b * z[k];
                    weight += b;
                    scale = fabs(z[k]) > scale ? fabs(z[k]) : scale;
                }
                want /= weight * w;
                if (fabs(want) < 1e-4)
                    continue;
                if (want < 0 || want > 1) {
                    clamped++;
                    extra += got != (want < 0 ? 0 : 1) && fabs(want - got) > 1e-4;
                    continue;
                }
                missed += got == 0;
                seen++;
                /* as for depth: the bound grows where the plane is seen edge on */
                {
                    const double sine = fabs(t.distance) / (w * sqrt(easel_dot(r, r) * easel_dot(t.normal, t.normal)));
                    const double error = fabs(got - want) / (scale / w + want) * (sine < 1 ? sine : 1) * broad;
                    worst = error > worst ? error : worst;
                }
            }
    }
    CHECK_NEAR(missed, 0, 0);
    CHECK_NEAR(extra, 0, 0);
    CHECK(seen > 10000 && clamped > 1000);
    CHECK_NEAR(worst, 0, 1e-5);
    easel_free(&e);
}

static void test_shadow_limits(void)
{
    easel e = easel_new(8, 8, 64, 1, 0);
    const tyn_shadow s = easel_plain_map(8);
    float p[18], map[64];
    const tyn_mesh mesh = easel_mesh(p, 2);
    TEST("raster: a map holds the largest z, at most 1, 0 for nothing");
    for (int i = 0; i < 2; i++) {
        easel_set_corner(p + 9 * i, -9, -9, i ? 7.0 : 0.25);
        easel_set_corner(p + 9 * i + 3, 99, -9, i ? 7.0 : 0.25);
        easel_set_corner(p + 9 * i + 6, -9, 99, i ? 7.0 : 0.25);
    }
    CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
    CHECK(map[0] == 1.0f && map[63] == 1.0f);
    p[11] = p[14] = p[17] = -3.0f;
    CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
    CHECK(map[0] == 0.25f && map[63] == 0.25f);
    p[2] = p[5] = p[8] = 0.0f;
    CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
    CHECK_NEAR(easel_count_set(map, 8), 0, 0);
    CHECK(easel_shadow(&e, &s, map, NULL, 0) == TYN_OK);
    CHECK_NEAR(easel_count_set(map, 8), 0, 0);
    easel_free(&e);
}

void test_raster_map(void)
{
    test_shadow_values(0);
    test_shadow_values(1);
    test_shadow_limits();
}
