/* test_raster_slide.c - level (a): slides, gobos, cubes of textures and tints on a wall, against formulas in double precision.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "easel.h"
#include "test.h"

#define PI 3.14159265358979

enum { W = 40, H = 36, COLUMNS = 5, ROWS = 3 };

/* A wall at depth 4 that fills the view. */
static const float wall[18] = {-9, -9, -4, 9, -9, -4, 9, 9, -4, -9, -9, -4, 9, 9, -4, -9, 9, -4};

static uint8_t bytes[6][ROWS][COLUMNS][3];

static void fill_pictures(tyn_image picture[6])
{
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < ROWS * COLUMNS * 3; k++)
            (&bytes[i][0][0][0])[k] = (uint8_t)test_random();
        memset(&picture[i], 0, sizeof picture[i]);
        picture[i].pixels = bytes[i];
        picture[i].width = COLUMNS;
        picture[i].height = ROWS;
        picture[i].format = TYN_RGB8_LINEAR;
    }
}

/* x and y from 0 to 1 over picture i, rim held. */
static double lookup(int i, double x, double y, int c)
{
    const double s = fmin(fmax(x * COLUMNS - 0.5, 0), COLUMNS - 1), t = fmin(fmax(y * ROWS - 0.5, 0), ROWS - 1);
    const int a = (int)s, b = (int)t, a1 = a + 1 < COLUMNS ? a + 1 : a, b1 = b + 1 < ROWS ? b + 1 : b;
    return ((bytes[i][b][a][c] * (1 - s + a) + bytes[i][b][a1][c] * (s - a)) * (1 - t + b) +
            (bytes[i][b1][a][c] * (1 - s + a) + bytes[i][b1][a1][c] * (s - a)) * (t - b)) /
           255;
}

/* Axes of a slide: forward, right = forward x up, down. */
static void axes(const tyn_light *l, double out[3][3])
{
    double length = 0;
    for (int c = 0; c < 3; c++)
        out[0][c] = (double)l->direction[c];
    for (int pass = 1; pass < 3; pass++) {
        for (int c = 0; c < 3; c++) {
            const int k = (c + 1) % 3, m = (c + 2) % 3;
            out[pass][c] = pass == 1 ? out[0][k] * (double)l->up[m] - out[0][m] * (double)l->up[k]
                                     : out[0][k] * out[1][m] - out[0][m] * out[1][k];
        }
        length = sqrt(easel_dot(out[pass], out[pass]));
        for (int c = 0; c < 3; c++)
            out[pass][c] /= length;
    }
}

/* Which picture a point p lies in and where; 0: in none. *edge: how far from its border. */
static int locate(const tyn_light *l, const double p[3], int *picture, double at[2], double *edge)
{
    double d[3], axis[3][3], forward;
    for (int c = 0; c < 3; c++)
        d[c] = p[c] - (l->kind == TYN_LIGHT_DIRECTIONAL ? 0 : (double)l->position[c]);
    *picture = 0;
    if (l->kind == TYN_LIGHT_POINT) { /* the largest component's face */
        int k = 0;
        for (int c = 1; c < 3; c++)
            k = fabs(d[c]) > fabs(d[k]) ? c : k;
        *picture = 2 * k + (d[k] < 0);
        at[0] = 0.5 + 0.5 * d[(k + 1) % 3] / fabs(d[k]);
        at[1] = 0.5 + 0.5 * d[(k + 2) % 3] / fabs(d[k]);
    } else {
        axes(l, axis);
        forward = l->kind == TYN_LIGHT_SPOT ? easel_dot(d, axis[0]) * 2 * tan(0.5 * (double)l->angle) : 0;
        at[0] = 0.5 + easel_dot(d, axis[1]) / (forward > 0 ? forward : (double)l->extent[0]);
        at[1] = 0.5 + easel_dot(d, axis[2]) / (forward > 0 ? forward : (double)l->extent[1]);
    }
    *edge = fmin(fmin(fabs(at[0]), fabs(at[0] - 1)), fmin(fabs(at[1]), fabs(at[1] - 1)));
    return at[0] > 0 && at[0] < 1 && at[1] > 0 && at[1] < 1;
}

static void test_slides(tyn_light_kind kind)
{
    static const char *const names[] = {"raster: a gobo on a wall", "raster: a slide on a wall",
                                        "raster: a cube of textures on a wall"};
    easel e = easel_new(W, H, 64, 1, 0);
    const tyn_mesh mesh = easel_mesh(wall, 2);
    tyn_image picture[6];
    double worst = 0;
    int lit = 0, dark = 0;
    TEST(names[kind]);
    e.surface.light_count = 1;
    for (int round = 0; round < 40; round++) {
        tyn_light l;
        double length = 0;
        memset(&l, 0, sizeof l);
        fill_pictures(picture);
        l.kind = kind;
        l.textures = picture;
        l.texture_count = kind == TYN_LIGHT_POINT ? 6 : 1;
        l.angle = test_random_float(0.3f, 1.5f);
        for (int c = 0; c < 3; c++) {
            l.position[c] = test_random_float(-1.5f, 1.5f);
            l.direction[c] = c == 2 ? -1 : test_random_float(-0.6f, 0.6f);
            l.up[c] = c == 1 ? 2 : test_random_float(-1, 1);
            l.colour[c] = 10 * (float)(c + 1);
            length += (double)l.direction[c] * (double)l.direction[c];
        }
        for (int c = 0; c < 3; c++)
            l.direction[c] /= (float)sqrt(length);
        l.extent[0] = test_random_float(1, 6);
        l.extent[1] = test_random_float(1, 6);
        e.surface.lights = &l;
        CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
        for (int32_t y = 0; y < H; y++)
            for (int32_t x = 0; x < W; x++) {
                double p[3] = {0, 0, -4}, r[2], at[2], edge, to = 0, square = 1, facing;
                int i;
                const float *got = easel_colour(&e, x, y);
                easel_ray(&e.surface.camera, W, H, x, y, r);
                p[0] = 4 * r[0];
                p[1] = 4 * r[1];
                if (kind != TYN_LIGHT_DIRECTIONAL) {
                    square = 0;
                    for (int c = 0; c < 3; c++) {
                        to = (double)l.position[c] - p[c];
                        square += to * to;
                    }
                    facing = to / (square * sqrt(square));
                } else {
                    facing = -(double)l.direction[2];
                }
                if (!locate(&l, p, &i, at, &edge)) {
                    dark++;
                    worst = edge > 1e-4 && got[0] > 0 ? 1 : worst;
                    continue;
                }
                if (edge < 1e-4)
                    continue;
                lit++;
                for (int c = 0; c < 3; c++) {
                    const double full = (double)l.colour[c] * fabs(facing) * 0.5 / PI;
                    const double error = fabs((double)got[c] - full * lookup(i, at[0], at[1], c)) / full;
                    worst = error > worst ? error : worst;
                }
            }
    }
    CHECK(lit > 4000 && (dark > 4000 || kind == TYN_LIGHT_POINT));
    CHECK_NEAR(worst, 0, 1e-4);
    easel_free(&e);
}

/* The tint of a map colours what lies in its column, lit or not. */
static void test_tint(void)
{
    static const float empty[4];
    easel e = easel_new(W, H, 64, 1, 0);
    const tyn_mesh mesh = easel_mesh(wall, 2);
    tyn_image picture[6];
    tyn_light sun;
    double worst = 0;
    int inside = 0;
    TEST("raster: the tint of a shadow map");
    fill_pictures(picture);
    memset(&sun, 0, sizeof sun);
    sun.direction[2] = -1;
    sun.shadow.depth = empty;
    sun.shadow.size = 2;
    sun.shadow.tint = picture;
    sun.shadow.matrix[0] = 0.4f; /* u = 0.4 x + 0.5, v = 0.5 - 0.3 y, z rises with z */
    sun.shadow.matrix[5] = -0.3f;
    sun.shadow.matrix[10] = 0.1f;
    sun.shadow.matrix[3] = sun.shadow.matrix[7] = sun.shadow.matrix[11] = 0.5f;
    sun.shadow.matrix[15] = 1.0f;
    for (int c = 0; c < 3; c++)
        sun.colour[c] = 2.0f * (float)PI;
    e.surface.lights = &sun;
    e.surface.light_count = 1;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK);
    for (int32_t y = 0; y < H; y++)
        for (int32_t x = 0; x < W; x++) {
            double r[2], u, v;
            easel_ray(&e.surface.camera, W, H, x, y, r);
            u = 0.5 + 0.4 * 4 * r[0];
            v = 0.5 - 0.3 * 4 * r[1];
            inside += u > 0 && u < 1 && v > 0 && v < 1;
            for (int c = 0; c < 3; c++) {
                const double want = u > 0 && u < 1 && v > 0 && v < 1 ? lookup(0, u, v, c) : 1;
                worst = fmax(worst, fabs((double)easel_colour(&e, x, y)[c] - want));
            }
        }
    CHECK(inside > W * H / 4 && inside < W * H);
    CHECK_NEAR(worst, 0, 1e-4);
    picture[0].format = TYN_RGBA8_SRGB;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_E_IMAGE);
    sun.shadow.tint = NULL;
    sun.textures = picture;
    sun.texture_count = 2;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_E_LIGHT);
    easel_free(&e);
}

void test_raster_slide(void)
{
    test_slides(TYN_LIGHT_DIRECTIONAL);
    test_slides(TYN_LIGHT_SPOT);
    test_slides(TYN_LIGHT_POINT);
    test_tint();
}
