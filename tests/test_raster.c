/* test_raster.c - level (a), geometry: what is covered, how deep it is, what clipping leaves, limits, order, errors.
 * Colour and light are in test_raster_light.c and test_raster_shadow.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "easel.h"
#include "test.h"

#define FAR 1000.0f

/* ---- coverage ------------------------------------------------------------------------------------------------------- */

/* Later triangles lie nearer to the light, so that each hit passes the test and is counted. */
static void test_rule(void)
{
    static const struct {
        float a[2], b[2], c[2];
        int32_t texels;
    } cases[] = {
        {{0.5f, 0.5f}, {4.5f, 0.5f}, {0.5f, 4.5f}, 10}, /* centres on all edges: top and left ones count */
        {{4.5f, 0.5f}, {4.5f, 4.5f}, {0.5f, 4.5f}, 6},  /* the other half of the square */
        {{0.5f, 0.5f}, {0.5f, 4.5f}, {4.5f, 0.5f}, 10}, /* turned over */
        {{1.0f, 1.0f}, {3.0f, 1.0f}, {1.0f, 3.0f}, 1},  /* a diagonal through centres belongs to the other side */
        {{2.6f, 2.6f}, {3.4f, 2.6f}, {3.0f, 3.4f}, 0},  /* between centres */
        {{2.4f, 2.4f}, {2.6f, 2.45f}, {2.5f, 2.6f}, 1}, /* around one */
        {{-9.0f, -9.0f}, {99.0f, -9.0f}, {-9.0f, 99.0f}, 64},
        {{3.5f, -8.0f}, {3.5f, 16.0f}, {4.5f, 4.0f}, 8}, /* a sliver whose left edge runs through centres: one column */
        {{1.0f, 1.0f}, {5.0f, 5.0f}, {3.0f, 3.0f}, 0},   /* no area */
        {{1.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 1.0f}, 0},
    };
    easel e = easel_new(8, 8, 64, 1, 0);
    const tyn_shadow s = easel_plain_map(8);
    float map[64];
    TEST("raster: top-left rule");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float p[9];
        tyn_mesh mesh = easel_mesh(p, 1);
        easel_set_corner(p, (double)cases[i].a[0], (double)cases[i].a[1], 0.5);
        easel_set_corner(p + 3, (double)cases[i].b[0], (double)cases[i].b[1], 0.5);
        easel_set_corner(p + 6, (double)cases[i].c[0], (double)cases[i].c[1], 0.5);
        CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
        CHECK_NEAR(easel_count_set(map, 8), cases[i].texels, 0);
        CHECK_NEAR(e.stats.pixels, cases[i].texels, 0);
        CHECK(e.stats.drawn == (cases[i].texels > 0) && e.stats.bad == 0 && e.stats.triangles == 1);
    }
    easel_free(&e);
}

#define MOST 400

/* Fans around a point: rim corners near and far (thousands of texels: clipped), slivers among them. Four corners are at most
 * 0.9 half turns apart, and the rim between two at 10 sizes is 10 cos(81 degrees) = 1.56 sizes away: all of the map is inside.
 */
static uint32_t make_fan(float *p, double size, int far)
{
    const double x = (double)test_random_float(0, (float)size), y = (double)test_random_float(0, (float)size);
    const uint32_t n = 4 + test_random() % 60;
    double angle[64];
    float rim[64][2];
    for (uint32_t i = 0; i < n; i++) /* steps below a half turn; some tiny */
        angle[i] = 6.283185307 * (i + 0.8 * (double)test_random_float(0, 1)) / n;
    for (uint32_t i = 0; i < n; i++) {
        double reach = size * (far ? exp((double)test_random_float(3, 16)) : (double)test_random_float(10, 16));
        rim[i][0] = (float)(x + reach * cos(angle[i]));
        rim[i][1] = (float)(y + reach * sin(angle[i]));
    }
    for (uint32_t i = 0; i < n; i++) {
        const double z = (i + 1.0) / (n + 1.0);
        const uint32_t k = (i + 1) % n;
        easel_set_corner(p + 9 * i, x, y, z);
        easel_set_corner(p + 9 * i + 3, (double)rim[i][0], (double)rim[i][1], z);
        easel_set_corner(p + 9 * i + 6, (double)rim[k][0], (double)rim[k][1], z);
    }
    return n;
}

/* A grid over -size .. 2 size whose corners are moved at random, some by next to nothing, some onto the centres' lattice. */
static uint32_t make_grid(float *p, double size)
{
    enum { N = 13 };
    float at[N + 1][N + 1][2];
    uint32_t n = 0;
    for (int y = 0; y <= N; y++)
        for (int x = 0; x <= N; x++) {
            const int still = x == 0 || y == 0 || x == N || y == N;
            for (int c = 0; c < 2; c++) {
                double s = -size + 3 * size * (c ? y : x) / N;
                s += still ? 0.0 : (double)test_random_float(-0.2f, 0.2f) * 3 * size / N;
                at[y][x][c] = (float)(test_random() % 3 ? s : floor(s) + 0.5);
            }
        }
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
            for (int half = 0; half < 2; half++, n++) {
                const float *a = at[y + half][x + half], *b = at[y][x + 1], *c = at[y + 1][x];
                const double z = (n + 1.0) / (2 * N * N + 1);
                easel_set_corner(p + 9 * n, (double)a[0], (double)a[1], z);
                easel_set_corner(p + 9 * n + 3, (double)b[0], (double)b[1], z);
                easel_set_corner(p + 9 * n + 6, (double)c[0], (double)c[1], z);
            }
    return n;
}

static void test_coverage(void)
{
    enum { SIZE = 53 };
    static float p[9 * MOST], map[SIZE * SIZE];
    easel e = easel_new(SIZE, SIZE, 64, 1, 0);
    const tyn_shadow s = easel_plain_map(SIZE);
    int gaps = 0, doubles = 0;
    TEST("raster: meshes with shared edges cover each texel once");
    for (int round = 0; round < 300; round++) {
        const uint32_t n = round % 3 == 2 ? make_grid(p, SIZE) : make_fan(p, SIZE, round % 3);
        const tyn_mesh mesh = easel_mesh(p, n);
        CHECK(easel_shadow(&e, &s, map, &mesh, 1) == TYN_OK);
        gaps += easel_count_set(map, SIZE) != SIZE * SIZE;
        doubles += e.stats.pixels != SIZE * SIZE;
    }
    CHECK_NEAR(gaps, 0, 0);
    CHECK_NEAR(doubles, 0, 0);
    easel_free(&e);
}

/* A floor of jittered cells that starts behind the camera: edges made by the near plane, by the guard band, by both. Each
 * triangle is drawn alone, and all together: the hits must add up, and no pixel below the horizon may be missed. */
static void test_clipped_coverage(void)
{
    enum { W = 41, H = 37, N = 7 };
    static float p[9 * 2 * N * N];
    easel e = easel_new(W, H, 64, 1, 0);
    int gaps = 0, doubles = 0;
    TEST("raster: edges made by clipping cover each pixel once");
    for (int round = 0; round < 40; round++) {
        const float reach = (round & 1) ? 3e3f : 30.0f;
        const double tilt = (double)test_random_float(-0.5f, 0.5f), height = -(double)test_random_float(0.3f, 4.0f);
        float at[N + 1][N + 1][3];
        int64_t hits = 0, covered = 0;
        uint32_t n = 0;
        e.surface.camera.near_depth = 1e-3f;
        e.surface.camera.far_depth = 0.25f * reach; /* nearer than where cells are thinner than the grid of 1/256 */
        for (int y = 0; y <= N; y++)
            for (int x = 0; x <= N; x++) {
                const double sx = (x - N / 2.0 + (double)test_random_float(-0.2f, 0.2f)) / N * 2;
                const double sz = (y - N / 2.0 + (double)test_random_float(-0.2f, 0.2f)) / N * 2;
                easel_set_corner(at[y][x], sx * (double)reach, height + tilt * sx * (double)reach, sz * (double)reach);
            }
        for (int y = 0; y < N; y++)
            for (int x = 0; x < N; x++)
                for (int half = 0; half < 2; half++, n++) {
                    memcpy(p + 9 * n, at[y + half][x + half], 12);
                    memcpy(p + 9 * n + 3, at[y][x + 1], 12);
                    memcpy(p + 9 * n + 6, at[y + 1][x], 12);
                }
        for (uint32_t i = 0; i < n; i++) {
            tyn_mesh one = easel_mesh(p + 9 * i, 1);
            CHECK(easel_draw(&e, &one, 1) == TYN_OK);
            hits += e.stats.pixels;
        }
        {
            tyn_mesh all = easel_mesh(p, n);
            CHECK(easel_draw(&e, &all, 1) == TYN_OK);
        }
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                double ray[2], w;
                easel_ray(&e.surface.camera, W, H, x, y, ray);
                w = height / (ray[1] - tilt * ray[0]); /* y = height + tilt x */
                covered += easel_depth(&e, x, y) < 0.25f * reach;
                if (w > 0 && w < 0.15 * (double)reach) /* jittered heights are rounded, so the floor is not quite flat */
                    gaps += fabs((double)easel_depth(&e, x, y) / w - 1) > 0.1;
            }
        doubles += hits != covered;
    }
    CHECK_NEAR(gaps, 0, 0);
    CHECK_NEAR(doubles, 0, 0);
    easel_free(&e);
}

/* ---- depth ---------------------------------------------------------------------------------------------------------- */

/* Random triangles, `wild` ones around and behind the camera, against exact rays. A float corner is off by eps, so a plane seen
 * at an angle of sine s is off by about eps / s: the bound grows so. */
static void test_depth(int wild)
{
    enum { W = 61, H = 45 };
    /* edges nearly parallel: the product of two loses 8 bits */
    static const float needle[3][3] = {{-1.49082792f, 1.23958373f, 3.68397713f},
                                       {1.18935287f, -1.5853107f, -2.21122384f},
                                       {1.42932367f, -1.82681882f, -2.68584442f}};
    easel e = easel_new(W, H, 64, 1, 1);
    const tyn_camera *c = &e.surface.camera;
    const double step[2] = {((double)c->right_edge - (double)c->left_edge) / W,
                            ((double)c->bottom_edge - (double)c->top_edge) / H};
    const double near = (double)c->near_depth, far = (double)c->far_depth;
    int missed = 0, extra = 0, seen = 0;
    double worst = 0;
    TEST(wild ? "raster: triangles across the near plane against exact rays" : "raster: depth against exact rays");
    for (int round = 0; round < 1500; round++) {
        const float reach = test_random_float(0.1f, wild ? 5.0f : 40.0f);
        float p[9];
        double v[3][3];
        easel_exact t;
        tyn_mesh mesh = easel_mesh(p, 1);
        for (int i = 0; i < 3; i++) {
            const float z = wild ? test_random_float(-1.5f, 2.0f) * reach : test_random_float(0.2f, 2.0f) * reach;
            p[3 * i] = test_random_float(-1, 1) * reach;
            p[3 * i + 1] = test_random_float(-1, 1) * reach;
            p[3 * i + 2] = -z;
            for (int k = 0; k < 3 && wild && !round; k++)
                p[3 * i + k] = k < 2 ? needle[i][k] : -needle[i][k];
            v[i][0] = (double)p[3 * i];
            v[i][1] = (double)p[3 * i + 1];
            v[i][2] = -(double)p[3 * i + 2];
        }
        t = easel_exact_new(v);
        CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < H; y++)
            for (int32_t x = 0; x < W; x++) {
                double r[3] = {0, 0, 1}, w, error, sine;
                const double got = (double)easel_depth(&e, x, y);
                easel_ray(c, W, H, x, y, r);
                w = easel_exact_hit(&t, r, step, 0.01);
                if (w < 0 || fabs(w / near - 1) < 1e-5)
                    continue;
                if (w < near || w > far) {
                    extra += got < far;
                    continue;
                }
                if (got >= far) {
                    missed++;
                    continue;
                }
                seen++;
                sine = fabs(t.distance) / (w * sqrt(easel_dot(r, r) * easel_dot(t.normal, t.normal))); /* of ray and plane */
                error = fabs(got / w - 1) * (sine < 1 ? sine : 1);
                worst = error > worst ? error : worst;
            }
    }
    CHECK_NEAR(missed, 0, 0);
    CHECK_NEAR(extra, 0, 0);
    CHECK(seen > 10000);
    CHECK_NEAR(worst, 0, 4e-6); /* times the sine: 1e-5 relative at 6 degrees */
    easel_free(&e);
}

/* A floor to the horizon, seen from a tilted camera: two triangles of kilometres. */
static void test_grazing(void)
{
    enum { W = 160, H = 90 };
    static const float p[18] = {-4e3f, 0, -4e3f, 4e3f, 0, -4e3f, 4e3f, 0, 4e3f, -4e3f, 0, -4e3f, 4e3f, 0, 4e3f, -4e3f, 0, 4e3f};
    easel e = easel_new(W, H, 64, 1, 0);
    tyn_camera *c = &e.surface.camera;
    const tyn_mesh mesh = easel_mesh(p, 2);
    double worst = 0;
    int seen = 0;
    TEST("raster: a floor to the horizon");
    for (int round = 0; round < 20; round++) {
        const float from[3] = {test_random_float(-50, 50), test_random_float(1, 3), test_random_float(-50, 50)};
        const float to[3] = {test_random_float(-90, 90), test_random_float(-9, 9), test_random_float(-900, -90)};
        const float up[3] = {test_random_float(-0.3f, 0.3f), 1, 0};
        CHECK(tyn_camera_look(c, from, to, up, 1.0f, 0.1f, 3000.0f, W, H) == TYN_OK);
        CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < H; y++)
            for (int32_t x = 0; x < W; x++) {
                double r[2], down, w;
                easel_ray(c, W, H, x, y, r);
                down = r[0] * (double)c->right[1] + r[1] * (double)c->up[1] + (double)c->forward[1];
                w = -(double)from[1] / down;
                if (w > 0.2 && w < 1000.0) {
                    const double error = fabs((double)easel_depth(&e, x, y) / w - 1) / (10 + w / (double)from[1]);
                    seen++;
                    worst = error > worst ? error : worst;
                }
            }
    }
    CHECK(seen > 50000);
    CHECK_NEAR(
        worst, 0,
        3e-7); /* twice the worst of many seeds; times depth / height: what the last place of the gradient does over an image */
    easel_free(&e);
}

static void test_limits_of_depth(void)
{
    static const float p[27] = {-9,  -9, -5, 9,   -9, -5, 0,  9, -5, -90, -90, -50, 90, -90,
                                -50, 0,  90, -50, -1, -1, -1, 1, -1, -1,  0,   1,   -1};
    easel e = easel_new(9, 9, 64, 1, 0);
    const tyn_mesh mesh = easel_mesh(p, 3);
    TEST("raster: nearer than near and beyond far is not seen");
    e.surface.camera.near_depth = 2.0f;
    e.surface.camera.far_depth = 40.0f;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
    CHECK_NEAR(easel_depth(&e, 4, 4), 5, 1e-5);
    e.surface.camera.near_depth = 6.0f;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
    CHECK(easel_depth(&e, 4, 4) == 40.0f);
    e.surface.camera.far_depth = 60.0f;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
    CHECK_NEAR(easel_depth(&e, 4, 4), 50, 1e-4);
    easel_free(&e);
}

/* ---- bad input ------------------------------------------------------------------------------------------------------ */

static void test_bad(void)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f};
    easel e = easel_new(16, 16, 64, 1, 0), good = easel_new(16, 16, 64, 1, 0);
    float p[36];
    const tyn_mesh mesh = easel_mesh(p, 4), without = easel_mesh(p + 9, 3);
    TEST("raster: triangles that are not finite are left out and counted");
    for (int round = 0; round < 9 * 4; round++) {
        for (int i = 0; i < 36; i++)
            p[i] = i % 3 == 2 ? test_random_float(-9, 0) : test_random_float(-9, 9);
        memcpy(p + 12, p + 9, 12); /* no area */
        p[round % 9] = bad[round / 9];
        CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
        CHECK(easel_draw(&good, &without, 1) == TYN_OK);
        CHECK(e.stats.bad == 1 && good.stats.bad == 0 && e.stats.triangles == 4);
        CHECK(memcmp(e.depth.block, good.depth.block, e.depth.size) == 0);
    }
    easel_free(&e);
    easel_free(&good);
}

/* Numbers of all sizes: no crash, nothing that is not finite, no byte out of place (easel_draw looks). */
static void test_wild(void)
{
    static const int32_t sizes[][2] = {{1, 1}, {1, 37}, {37, 1}, {33, 31}, {64, 33}, {5, 65}};
    TEST("raster: odd sizes and wild triangles");
    for (int k = 0; k < 12; k++) {
        easel e = easel_new(sizes[k % 6][0], sizes[k % 6][1], 64, 1, k >= 6);
        float p[9 * 100];
        int finite = 1;
        const tyn_mesh mesh = easel_mesh(p, 100);
        tyn_light sun = {.direction = {0, 0, -1}, .colour = {1, 1, 1}};
        e.surface.lights = &sun;
        e.surface.light_count = 1;
        for (int round = 0; round < 10; round++) {
            for (int i = 0; i < 900; i++)
                p[i] = test_random_float(-1, 1) * expf(test_random_float(-30, (float)(round * 9)));
            CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
            for (int32_t y = 0; y < sizes[k % 6][1]; y++)
                for (int32_t x = 0; x < sizes[k % 6][0]; x++) {
                    const float *c = easel_colour(&e, x, y), z = easel_depth(&e, x, y);
                    finite &= z >= 0.1f && z <= FAR && isfinite(c[0]) && isfinite(c[1]) && isfinite(c[2]);
                }
        }
        CHECK(finite);
        e.surface.colour.pixels = NULL; /* depth alone is the same depth */
        {
            float before = easel_depth(&e, 0, 0);
            CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
            CHECK(easel_depth(&e, 0, 0) == before);
        }
        easel_free(&e);
    }
}

/* ---- sameness ------------------------------------------------------------------------------------------------------- */

static void test_order(void)
{
    enum { W = 70, H = 131, N = 1500, SIZE = 64 };
    static const int32_t batches[] = {64, 65, 100, 1000, 2048, 65536};
    static float p[9 * N], map[SIZE * SIZE], first_map[SIZE * SIZE];
    easel first = easel_new(W, H, 0, 1, 0);
    tyn_mesh mesh[5];
    tyn_light sun = {.direction = {0, -0.6f, -0.8f}, .colour = {3, 2, 1}};
    tyn_shadow shadow = {.size = SIZE};
    tyn_raster_stats first_stats;
    int different = 0;
    TEST("raster: same bytes for any workers, order and batch");
    for (int i = 0; i < 3 * N; i++) {
        const float depth = 3 + (float)(i / 3 % 97);
        easel_set_corner(p + 3 * i, (double)(test_random_float(-1, 1) * depth), (double)(test_random_float(-1, 1) * depth),
                         (double)(test_random_float(0, 2) - depth));
        if (i / 3 % 7 && i % 3)
            for (int c = 0; c < 3; c++)
                p[3 * i + c] = p[3 * i + c - 3] + test_random_float(-0.3f, 0.3f);
    }
    p[400] = NAN;
    mesh[0] = easel_mesh(p, 1000);
    mesh[1] = easel_mesh(p, 0);
    mesh[2] = easel_mesh(p + 9000, 1);
    mesh[3] = easel_mesh(p + 9009, N - 1001);
    mesh[4] = easel_mesh(p, 0);
    easel_random_matrix(shadow.matrix, 0);
    for (int k = 0; k < 12; k++)
        shadow.matrix[k] *= k % 4 == 3 ? 1.0f : 0.1f;
    CHECK(easel_shadow(&first, &shadow, first_map, mesh, 5) == TYN_OK);
    sun.shadow = shadow;
    sun.shadow.depth = first_map;
    first.surface.lights = &sun;
    first.surface.light_count = 1;
    CHECK(easel_draw(&first, mesh, 5) == TYN_OK);
    first_stats = first.stats;
    CHECK_NEAR(first_stats.triangles, N, 0);
    CHECK_NEAR(first_stats.bad, 1, 0);
    CHECK(first_stats.drawn > 100 && first_stats.drawn < N && first_stats.pixels > W * H / 2);
    for (int32_t workers = 1; workers <= 7; workers++)
        for (int order = 0; order < 3; order++) {
            easel e = easel_new(W, H, batches[(workers + 2 * order) % 6], workers, 0);
            easel_crew crew;
            easel_hire(&crew, (easel_order)order, workers);
            e.surface.lights = &sun;
            e.surface.light_count = 1;
            e.surface.executor = &crew.executor;
            CHECK(easel_draw(&e, mesh, 5) == TYN_OK);
            different += memcmp(e.depth.block, first.depth.block, e.depth.size) != 0;
            different += memcmp(e.colour.block, first.colour.block, e.colour.size) != 0;
            different += memcmp(&e.stats, &first_stats, sizeof first_stats) != 0;
            CHECK(tyn_raster_shadow(e.raster, &shadow, map, mesh, 5, &crew.executor, NULL, NULL, NULL) == TYN_OK);
            different += memcmp(map, first_map, sizeof map) != 0;
            for (crew.fault = 1; crew.fault <= 4; crew.fault++)
                CHECK(easel_draw(&e, mesh, 5) == TYN_E_EXECUTOR);
            easel_free(&e);
        }
    CHECK_NEAR(different, 0, 0);
    easel_free(&first);
}

void test_raster(void)
{
    test_rule();
    test_coverage();
    test_clipped_coverage();
    test_depth(0);
    test_depth(1);
    test_grazing();
    test_limits_of_depth();
    test_bad();
    test_wild();
    test_order();
}
