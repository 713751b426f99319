/* test_raster_shadow.c - level (a), shadows: maps of suns, spots and points, against formulas in double precision. */
#include <math.h>
#include <string.h>

#include "pane.h"
#include "test.h"

/* The light's own axes: right, down, forward. */
static void light_axes(const tyn_light *l, double right[3], double down[3], double forward[3])
{
    double helper[3] = {0.3, 0.9, 0.2}, length;
    for (int c = 0; c < 3; c++)
        forward[c] = (double)l->direction[c];
    easel_cross(forward, helper, right);
    length = sqrt(easel_dot(right, right));
    for (int c = 0; c < 3; c++)
        right[c] /= length;
    easel_cross(forward, right, down);
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
        pane q, plate;
        tyn_light l = pane_light(kind), bare;
        tyn_mesh both[2];
        double n[3], middle[3], texels, gap, facing, reach;
        const double no_sigma[3] = {0, 0, 0};
        pane_lean(&q, (double)test_random_float(1, 30));
        reach = sqrt(easel_dot(q.p, q.p)) * 1.5;
        pane_normal(&q, n);
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
            pane_set(&plate);
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
                    if (!pane_hit(&q, &view, x, y, hit, &s, &t))
                        continue;
                    pane_add_light(&l, hit, n, no_sigma, sum, &edge);
                    want = sum[2] * 0.75 / PANE_PI;
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
    pane q;
    tyn_light sun = {.direction = {0, 0, -1}, .colour = {1, 1, 1}};
    tyn_light spot = {
        .kind = TYN_LIGHT_SPOT, .position = {0, 0, 0}, .direction = {0, 0, -1}, .colour = {1, 1, 1}, .angle = 2.5f};
    const double nowhere[3] = {100, 100, 0}, here[3] = {0, 0, -4};
    TEST("raster: outside of the map a sun shines and a spot does not");
    pane_lean(&q, 4);
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
    pane room[7];
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
        pane_set(&room[side]);
        mesh[side] = room[side].mesh;
    }
    for (int round = 0; round < 30; round++) {
        tyn_light l;
        tyn_shadow face[6];
        const double no_sigma[3] = {0, 0, 0};
        pane *plate = &room[6];
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
        pane_set(plate);
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
                    if (!pane_hit(&room[side], &view, x, y, hit, &s, &t))
                        continue;
                    pane_normal(&room[side], n);
                    pane_add_light(&l, hit, n, no_sigma, sum, &edge);
                    want = sum[1] * 0.5 / PANE_PI;
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
    pane wall;
    TEST("raster: the first map that covers a place counts");
    memset(&wall, 0, sizeof wall);
    wall.p[0] = wall.p[1] = -9;
    wall.p[2] = -4;
    wall.a[0] = wall.b[1] = 18;
    pane_set(&wall);
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

void test_raster_shadow(void)
{
    test_flat(TYN_LIGHT_DIRECTIONAL);
    test_flat(TYN_LIGHT_SPOT);
    test_outside();
    test_cube();
    test_cascades();
}
