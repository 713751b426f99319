/* test_raster_light.c - level (a), light: textures, masks, Lambert, spots, shadows, against formulas in double precision. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "easel.h"
#include "test.h"

#define PI 3.14159265358979

/* ---- a quad before the camera ---------------------------------------------------------------------------------------- */

/* A parallelogram p + s a + t b as two triangles. */
typedef struct quad {
    double p[3], a[3], b[3];
    float corner[12], coord[8];
    tyn_mesh mesh;
} quad;

static const uint32_t quad_order[6] = {0, 1, 2, 0, 2, 3};

static void quad_set(quad *q)
{
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            q->corner[3 * i + c] = (float)(q->p[c] + (i == 1 || i == 2 ? q->a[c] : 0) + (i >= 2 ? q->b[c] : 0));
    memset(&q->mesh, 0, sizeof q->mesh);
    q->mesh.positions = q->corner;
    q->mesh.indices = quad_order;
    q->mesh.vertices = 4;
    q->mesh.triangles = 2;
    for (int c = 0; c < 3; c++)
        q->mesh.material.albedo[c] = 0.25f * (float)(c + 1);
}

/* Texture coordinates u0 + s du, v0 + t dv. */
static void quad_map(quad *q, float u0, float du, float v0, float dv)
{
    for (int i = 0; i < 4; i++) {
        q->coord[2 * i] = u0 + (i == 1 || i == 2 ? du : 0);
        q->coord[2 * i + 1] = v0 + (i >= 2 ? dv : 0);
    }
    q->mesh.texcoords = q->coord;
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Where a pixel's ray from the origin meets the quad's plane: the point, s and t. 0 outside 0 .. 1 less a margin. */
static int quad_hit(const quad *q, const easel *e, int32_t x, int32_t y, double point[3], double *s, double *t)
{
    double ray[3], normal[3], w, side[3], d[3];
    easel_ray(&e->surface.camera, e->depth.image.width, e->depth.image.height, x, y, ray);
    ray[2] = -1;
    cross3(q->a, q->b, normal);
    w = easel_dot(normal, q->p) / easel_dot(normal, ray);
    for (int c = 0; c < 3; c++) {
        point[c] = w * ray[c];
        d[c] = point[c] - q->p[c];
    }
    cross3(d, q->b, side);
    *s = easel_dot(side, normal) / easel_dot(normal, normal);
    cross3(q->a, d, side);
    *t = easel_dot(side, normal) / easel_dot(normal, normal);
    return w > 0 && *s > 0.01 && *s < 0.99 && *t > 0.01 && *t < 0.99;
}

/* Fills most of the view, leaning. */
static void lean(quad *q, double depth)
{
    for (int c = 0; c < 3; c++) {
        q->a[c] = (c == 0 ? 2 * depth : 0) + (double)test_random_float(-0.4f, 0.4f) * depth;
        q->b[c] = (c == 1 ? 2 * depth : 0) + (double)test_random_float(-0.4f, 0.4f) * depth;
        q->p[c] = (c == 2 ? -depth : 0) - 0.5 * (q->a[c] + q->b[c]);
    }
    quad_set(q);
}

/* Towards the camera, which is at the origin. */
static void quad_normal(const quad *q, double n[3])
{
    double length;
    cross3(q->a, q->b, n);
    length = sqrt(easel_dot(n, n)) * (easel_dot(n, q->p) > 0 ? -1 : 1);
    for (int c = 0; c < 3; c++)
        n[c] /= length;
}

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
        quad q;
        uint8_t *row = picture.image.pixels;
        lean(&q, (double)test_random_float(2, 20));
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
        quad_map(&q, u0, du, v0, dv);
        q.mesh.material.texture = &picture.image;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < 40; y++)
            for (int32_t x = 0; x < 48; x++) {
                double point[3], s, t;
                if (!quad_hit(&q, &e, x, y, point, &s, &t))
                    continue;
                seen++;
                for (int c = 0; c < 3; c++) {
                    const double u = (double)u0 + s * (double)du, v = (double)v0 + t * (double)dv;
                    const double want = bilinear(&picture.image, u, v, c) * (0.25 * (c + 1)) / PI;
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
        quad q;
        tyn_shadow shadow = {.size = SIZE};
        lean(&q, (double)test_random_float(2, 9));
        quad_map(&q, u0, 1.5f, v0, -1.25f);
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
                if (!quad_hit(&q, &e, x, y, point, &s, &t))
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
        quad q; /* without coordinates neither counts */
        lean(&q, 5);
        bytes[0] = 0;
        q.mesh.material.mask = &mask;
        CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK);
        CHECK(e.stats.pixels > SIZE * SIZE / 2);
    }
    easel_free(&e);
}

/* ---- light ---------------------------------------------------------------------------------------------------------- */

static tyn_light random_light(tyn_light_kind kind)
{
    tyn_light l;
    double d[3], length;
    memset(&l, 0, sizeof l);
    l.kind = kind;
    for (int c = 0; c < 3; c++) {
        d[c] = (double)test_random_float(-1, 1) - (c == 2 && kind == TYN_LIGHT_SPOT ? 1.2 : 0);
        l.position[c] = test_random_float(-2, 2);
        l.colour[c] = test_random_float(0, 10);
    }
    length = sqrt(easel_dot(d, d));
    for (int c = 0; c < 3; c++)
        l.direction[c] = (float)(d[c] / length);
    l.angle = test_random_float(0.3f, 2.9f);
    return l;
}

/* What the light gives at a point of normal n, without shadows, per channel; *edge: how far from the cone's edge, radians. */
static void add_exact(const tyn_light *l, const double point[3], const double n[3], const double sigma[3], double sum[3],
                      double *edge)
{
    double to[3], r = 1, cosine = 0;
    for (int c = 0; c < 3; c++)
        to[c] = l->kind == TYN_LIGHT_DIRECTIONAL ? -(double)l->direction[c] : (double)l->position[c] - point[c];
    r = sqrt(easel_dot(to, to));
    for (int c = 0; c < 3; c++)
        cosine -= to[c] * (double)l->direction[c] / r;
    if (l->kind == TYN_LIGHT_SPOT) {
        const double off = acos(cosine > 1 ? 1 : cosine) - 0.5 * (double)l->angle;
        *edge = fabs(off) < *edge ? fabs(off) : *edge;
        if (off > 0)
            return;
    }
    for (int c = 0; c < 3; c++) {
        const double dim = l->kind == TYN_LIGHT_DIRECTIONAL ? 1 : exp(-sigma[c] * r) / (r * r);
        const double facing = easel_dot(n, to) / r;
        sum[c] += (double)l->colour[c] * dim * (facing > 0 ? facing : 0);
    }
}

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
        quad q;
        lean(&q, (double)test_random_float(1, 9));
        memset(medium, 0, sizeof medium);
        for (int i = 0; i < 3; i++)
            light[i] = random_light((tyn_light_kind)i);
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
        quad_normal(&q, n);
        for (int32_t y = 0; y < 32; y++)
            for (int32_t x = 0; x < 40; x++) {
                double point[3], s, t, sum[3], edge = 1;
                const float *got = easel_colour(&e, x, y);
                if (easel_depth(&e, x, y) == 1000.0f)
                    CHECK(memcmp(got, e.surface.background, 12) == 0);
                if (!quad_hit(&q, &e, x, y, point, &s, &t))
                    continue;
                for (int c = 0; c < 3; c++)
                    sum[c] = (double)e.surface.ambient[c];
                for (int i = 0; i < 3; i++)
                    add_exact(&light[i], point, n, sigma, sum, &edge);
                if (edge < 1e-5)
                    continue;
                seen++;
                lit += sum[0] > (double)e.surface.ambient[0];
                dark += sum[0] == (double)e.surface.ambient[0];
                for (int c = 0; c < 3; c++) {
                    const double want = sum[c] * (0.25 * (c + 1)) / PI, error = fabs((double)got[c] - want) / (want + 0.01);
                    worst = error > worst ? error : worst;
                }
            }
    }
    CHECK(seen > 20000 && lit > 2000 && dark > 50);
    CHECK_NEAR(worst, 0, 2e-4); /* spots a hand before the surface among them */
    easel_free(&e);
}

/* ---- shadows -------------------------------------------------------------------------------------------------------- */

/* The light's own axes: right, down, forward. */
static void light_axes(const tyn_light *l, double right[3], double down[3], double forward[3])
{
    double helper[3] = {0.3, 0.9, 0.2}, length;
    for (int c = 0; c < 3; c++)
        forward[c] = (double)l->direction[c];
    cross3(forward, helper, right);
    length = sqrt(easel_dot(right, right));
    for (int c = 0; c < 3; c++)
        right[c] /= length;
    cross3(forward, right, down);
}

/* A map around a sphere at `centre` for a sun; the cone's frustum for a spot. */
static void fit(tyn_light *l, const double centre[3], double radius)
{
    double axis[3][3], at[3];
    float *m = l->shadow.matrix;
    const int spot = l->kind == TYN_LIGHT_SPOT;
    light_axes(l, axis[0], axis[1], axis[2]);
    for (int c = 0; c < 3; c++)
        at[c] = spot ? (double)l->position[c] : centre[c];
    memset(m, 0, 16 * sizeof *m);
    for (int i = 0; i < 2; i++) {
        const double scale = spot ? 0.5 / tan(0.5 * (double)l->angle) : 0.5 / radius;
        for (int c = 0; c < 3; c++)
            m[4 * i + c] = (float)(axis[i][c] * scale + (spot ? 0.5 * axis[2][c] : 0));
        m[4 * i + 3] = (float)((spot ? 0 : 0.5) - easel_dot(axis[i], at) * scale - (spot ? 0.5 * easel_dot(axis[2], at) : 0));
    }
    for (int c = 0; c < 3; c++) {
        m[8 + c] = spot ? 0 : (float)(-axis[2][c] * 0.25 / radius);
        m[12 + c] = spot ? (float)axis[2][c] : 0;
    }
    m[11] = spot ? 0.05f : (float)(0.5 + easel_dot(axis[2], at) * 0.25 / radius);
    m[15] = spot ? (float)-easel_dot(axis[2], at) : 1;
}

/* A flat surface at all angles to the light, alone: no texel of it may shadow it. Then a small plate some texels before it: its
 * shadow is there, away from the edge. */
static void test_flat(tyn_light_kind kind)
{
    enum { SIZE = 128, W = 64, H = 48 };
    static float map[SIZE * SIZE];
    easel e = easel_new(SIZE, SIZE, 64, 1, 0), view = easel_new(W, H, 64, 1, 0);
    int acne = 0, seen = 0, lost = 0, shaded = 0;
    TEST(kind == TYN_LIGHT_SPOT ? "raster: a spot's flat surfaces neither shadow themselves nor lose shadows"
                                : "raster: a sun's flat surfaces neither shadow themselves nor lose shadows");
    for (int round = 0; round < 120; round++) {
        quad q, plate;
        tyn_light l = random_light(kind), bare;
        tyn_mesh both[2];
        double n[3], middle[3], texels, gap, facing, reach;
        const double no_sigma[3] = {0, 0, 0};
        lean(&q, (double)test_random_float(1, 30));
        reach = sqrt(easel_dot(q.p, q.p)) * 1.5;
        quad_normal(&q, n);
        for (int c = 0; c < 3; c++)
            middle[c] = q.p[c] + 0.5 * (q.a[c] + q.b[c]);
        if (kind == TYN_LIGHT_SPOT) { /* above the surface, its axis on the middle */
            double d[3], length;
            const double height = reach * (double)test_random_float(0.2f, 1.0f), aside = (double)test_random_float(-1, 1);
            for (int c = 0; c < 3; c++) {
                l.position[c] = (float)(middle[c] + n[c] * height + aside * q.a[c]);
                d[c] = middle[c] - (double)l.position[c];
            }
            length = sqrt(easel_dot(d, d));
            for (int c = 0; c < 3; c++)
                l.direction[c] = (float)(d[c] / length);
            l.angle = 1.2f;
            texels = 2 * tan(0.6) * length / SIZE;
        } else {
            double toward = 0;
            for (int c = 0; c < 3; c++)
                toward -= n[c] * (double)l.direction[c];
            for (int c = 0; c < 3; c++)
                l.direction[c] = toward < 0 ? -l.direction[c] : l.direction[c];
            texels = 2 * reach / SIZE;
        }
        fit(&l, middle, reach);
        l.shadow.size = SIZE;
        bare = l;
        view.surface.light_count = 1;
        for (int pass = 0; pass < 2; pass++) {
            double hit[3], s, t;
            facing = 0;
            for (int c = 0; c < 3; c++)
                facing -= n[c] * (double)l.direction[c];
            plate = q; /* the middle ninth or so, moved towards the light by 6 texels along its way */
            gap = 6 * texels;
            for (int c = 0; c < 3; c++) {
                plate.a[c] *= 0.4;
                plate.b[c] *= 0.4;
                plate.p[c] = middle[c] - 0.5 * (plate.a[c] + plate.b[c]) - gap * (double)l.direction[c];
            }
            quad_set(&plate);
            both[0] = q.mesh;
            both[1] = plate.mesh;
            CHECK(easel_shadow(&e, &bare.shadow, map, both, pass + 1) == TYN_OK);
            l.shadow = bare.shadow;
            l.shadow.depth = map;
            view.surface.lights = &l;
            CHECK(easel_draw(&view, &q.mesh, 1) == TYN_OK); /* the plate is in the map alone */
            for (int32_t y = 0; y < H; y++)
                for (int32_t x = 0; x < W; x++) {
                    double sum[3] = {0, 0, 0}, edge = 1, want;
                    if (!quad_hit(&q, &view, x, y, hit, &s, &t))
                        continue;
                    add_exact(&l, hit, n, no_sigma, sum, &edge);
                    want = sum[2] * 0.75 / PI;
                    if (want < 1e-6 || edge < 0.02 || facing < 0.05)
                        continue;
                    if (pass == 0) {
                        seen++;
                        acne += (double)easel_colour(&view, x, y)[2] < 0.999 * want;
                    } else if (fabs(s - 0.5) < 0.05 && fabs(t - 0.5) < 0.05 && facing > 0.25) {
                        shaded++;
                        lost += (double)easel_colour(&view, x, y)[2] > 0.001 * want;
                    }
                }
        }
    }
    CHECK(seen > 20000 && shaded > 200);
    CHECK_NEAR(acne, 0, 0);
    CHECK_NEAR(lost, 0, 0);
    easel_free(&e);
    easel_free(&view);
}

/* Outside of its map a sun shines and a spot does not; an empty map hides nothing. */
static void test_outside(void)
{
    static float map[4 * 4];
    easel e = easel_new(8, 8, 64, 1, 0);
    quad q;
    tyn_light sun = {.direction = {0, 0, -1}, .colour = {1, 1, 1}};
    tyn_light spot = {
        .kind = TYN_LIGHT_SPOT, .position = {0, 0, 0}, .direction = {0, 0, -1}, .colour = {1, 1, 1}, .angle = 2.5f};
    const double nowhere[3] = {100, 100, 0}, here[3] = {0, 0, -4};
    TEST("raster: outside of the map a sun shines and a spot does not");
    lean(&q, 4);
    e.surface.light_count = 1;
    e.surface.lights = &sun;
    for (int i = 0; i < 16; i++)
        map[i] = i & 1 ? 1.0f : 50.0f; /* all in shadow; above 1 counts as 1 */
    fit(&sun, nowhere, 5);
    sun.shadow.depth = map;
    sun.shadow.size = 4;
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] > 0);
    fit(&sun, here, 9);
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] == 0);
    memset(map, 0, sizeof map);
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] > 0);
    e.surface.lights = &spot;
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] > 0);
    fit(&spot, here, 1);
    spot.shadow.depth = map;
    spot.shadow.size = 4;
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] > 0);
    for (int c = 0; c < 12; c += 4) /* a map that looks elsewhere */
        spot.shadow.matrix[c / 4 * 4 + 3] += c == 0 ? 100.0f : 0.0f;
    CHECK(easel_draw(&e, &q.mesh, 1) == TYN_OK && easel_colour(&e, 4, 4)[0] == 0);
    easel_free(&e);
}

/* A point light in a room, in a cube of six maps: the walls are lit all over, but behind a plate. */
static void test_cube(void)
{
    enum { SIZE = 96, W = 64, H = 48 };
    static float map[6][SIZE * SIZE];
    easel e = easel_new(SIZE, SIZE, 64, 1, 0), view = easel_new(W, H, 64, 1, 0);
    quad room[7];
    tyn_mesh mesh[7];
    int wrong = 0, lit = 0, dark = 0;
    TEST("raster: a point light's cube of maps");
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2;
        memset(&room[side], 0, sizeof room[side]);
        for (int c = 0; c < 3; c++)
            room[side].p[c] = c == axis && side % 2 ? 5 : -5;
        room[side].a[(axis + 1) % 3] = 10;
        room[side].b[(axis + 2) % 3] = 10;
        quad_set(&room[side]);
        mesh[side] = room[side].mesh;
    }
    for (int round = 0; round < 30; round++) {
        tyn_light l;
        tyn_shadow face[6];
        const double no_sigma[3] = {0, 0, 0};
        quad *plate = &room[6];
        memset(&l, 0, sizeof l);
        memset(face, 0, sizeof face);
        memset(plate, 0, sizeof *plate);
        l.kind = TYN_LIGHT_POINT;
        for (int c = 0; c < 3; c++) {
            l.position[c] = test_random_float(-3, 3);
            l.colour[c] = 10;
        }
        plate->a[0] = plate->b[1] = 1;
        for (int c = 0; c < 3; c++)
            plate->p[c] = (double)l.position[c] - (c == 2 ? 1 : 0.5);
        quad_set(plate);
        mesh[6] = plate->mesh;
        for (int i = 0; i < 6; i++)
            face[i].size = SIZE;
        CHECK(tyn_shadow_fit_cube(face, l.position, 30) == TYN_OK);
        for (int i = 0; i < 6; i++) {
            CHECK(easel_shadow(&e, &face[i], map[i], mesh, 7) == TYN_OK);
            face[i].depth = map[i];
        }
        l.shadow = face[0];
        l.more = face + 1;
        l.more_count = 5;
        view.surface.lights = &l;
        view.surface.light_count = 1;
        CHECK(easel_draw(&view, mesh, 6) == TYN_OK); /* the plate is in the maps alone */
        for (int side = 0; side < 6; side++)
            for (int32_t y = 0; y < H; y++)
                for (int32_t x = 0; x < W; x++) {
                    double hit[3], s, t, n[3], sum[3] = {0, 0, 0}, edge, want, got, off, k;
                    if (!quad_hit(&room[side], &view, x, y, hit, &s, &t))
                        continue;
                    quad_normal(&room[side], n);
                    add_exact(&l, hit, n, no_sigma, sum, &edge);
                    want = sum[1] * 0.5 / PI;
                    got = (double)easel_colour(&view, x, y)[1];
                    k = 1 / ((double)l.position[2] - hit[2]); /* where the way to the light meets the plate's plane */
                    off = fmax(fabs(hit[0] - (double)l.position[0]), fabs(hit[1] - (double)l.position[1])) * k;
                    if (k > 0 && k < 0.95 && off < 0.44) {
                        dark++;
                        wrong += got > 0;
                    } else if (k < 0 || off > 0.56) {
                        lit++;
                        wrong += fabs(got / want - 1) > 1e-4;
                    }
                }
    }
    CHECK(lit > 20000 && dark > 1000);
    CHECK_NEAR(wrong, 0, 0);
    easel_free(&e);
    easel_free(&view);
}

/* The first map that covers a point counts; `outside` says what holds where none does. */
static void test_cascades(void)
{
    static float full[16], empty[16];
    static const tyn_outside outside[3] = {TYN_OUTSIDE_DEFAULT, TYN_OUTSIDE_LIT, TYN_OUTSIDE_DARK};
    easel e = easel_new(33, 33, 64, 1, 0);
    const double middle[3] = {0, 0, -4};
    quad wall;
    TEST("raster: the first map that covers a place counts");
    memset(&wall, 0, sizeof wall);
    wall.p[0] = wall.p[1] = -9;
    wall.p[2] = -4;
    wall.a[0] = wall.b[1] = 18;
    quad_set(&wall);
    for (int i = 0; i < 16; i++)
        full[i] = 1.0f;
    for (int i = 0; i < 3; i++) {
        tyn_light sun = {.direction = {0, 0, -1}, .colour = {1, 1, 1}}, wide = sun;
        fit(&sun, middle, 0.4);
        fit(&wide, middle, 1.2);
        sun.shadow.size = wide.shadow.size = 4;
        sun.shadow.depth = full;
        wide.shadow.depth = empty;
        sun.more = &wide.shadow;
        sun.more_count = 1;
        sun.outside = outside[i];
        e.surface.lights = &sun;
        e.surface.light_count = 1;
        CHECK(easel_draw(&e, &wall.mesh, 1) == TYN_OK);
        CHECK(easel_colour(&e, 16, 16)[0] == 0);                                      /* in the first, full one */
        CHECK(easel_colour(&e, 16, 21)[0] > 0);                                       /* in the second, empty one */
        CHECK((easel_colour(&e, 16, 31)[0] > 0) == (outside[i] != TYN_OUTSIDE_DARK)); /* in neither */
        wide.shadow.depth = full;
        CHECK(easel_draw(&e, &wall.mesh, 1) == TYN_OK && easel_colour(&e, 16, 21)[0] == 0);
    }
    easel_free(&e);
}

void test_raster_light(void)
{
    test_textures();
    test_masks();
    test_lambert();
    test_flat(TYN_LIGHT_DIRECTIONAL);
    test_flat(TYN_LIGHT_SPOT);
    test_outside();
    test_cube();
    test_cascades();
}
