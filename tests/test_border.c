/* test_border.c - lines to border points: entries and exits of IVB figures 11 to 14, the ring of slots, and the look-up. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "border.h"
#include "test.h"
#include "tyndall.h"

enum { SLOTS = 257, SAMPLES = 64 };

typedef struct place {
    const char *name;
    float x, y, w; /* homogeneous, in parts of the screen */
} place;

static const place places[] = {{"the middle", 0.5f, 0.5f, 1},
                               {"off the middle", 0.21f, 0.83f, 1},
                               {"on the left border", 0, 0.4f, 1},
                               {"on the lower border", 0.7f, 1, 1},
                               {"in a corner", 0, 0, 1},
                               {"in the other corner", 1, 1, 1},
                               {"just beside the right border", 1.001f, 0.5f, 1},
                               {"left", -0.8f, 0.45f, 1},
                               {"right", 2.5f, 0.2f, 1},
                               {"above", 0.3f, -1.5f, 1},
                               {"below", 0.6f, 3, 1},
                               {"beyond a corner", -1, -1, 1},
                               {"far away", 900, 31, 1},
                               {"at infinity, aslant", 1, 0.3f, 0},
                               {"at infinity, level", -1, 0, 0},
                               {"at infinity, upright", 0, -1, 0}};
static const int32_t sizes[][2] = {{64, 48}, {31, 97}, {2, 2}, {40, 1}, {1, 40}, {1, 1}, {300, 5}};

typedef struct ring {
    tyni_slices slices;
    tyni_spoke spokes[SLOTS];
    int32_t slots[SLOTS];
    tyni_lamp lamp;
    tyni_view view;
} ring;

static void set_up(ring *r, const place *p, int32_t width, int32_t height, int32_t slots, int stretch)
{
    const float at[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    tyn_camera camera;
    memset(r, 0, sizeof *r);
    CHECK(tyn_camera_look(&camera, at, target, up, 1, 0.1f, 50, width, height) == TYN_OK);
    tyni_view_camera(&r->view, &camera, width, height);
    r->lamp.ex = p->x * (float)width;
    r->lamp.ey = p->y * (float)height;
    r->lamp.ew = p->w;
    r->lamp.to_light.y = 1;
    r->slices.spokes = r->spokes;
    r->slices.slots = r->slots;
    tyni_border_layout(&r->slices, &r->lamp, width, height, slots, SAMPLES, stretch);
}

/* The same place along the border, by walking there. */
static void walk_border(const tyni_slices *g, double at, double point[2], double out[2])
{
    const double way[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}},
                 sides[4] = {g->width - 1.0, g->height - 1.0, g->width - 1.0, g->height - 1.0};
    int side = 0;
    point[0] = point[1] = 0.5;
    for (; side < 3 && at >= sides[side]; side++) {
        point[0] += way[side][0] * sides[side];
        point[1] += way[side][1] * sides[side];
        at -= sides[side];
    }
    point[0] += way[side][0] * at;
    point[1] += way[side][1] * at;
    out[0] = way[side][1];
    out[1] = -way[side][0];
}

/* Direction from the epipole through a point, and its length. */
static double direction(const tyni_slices *g, double x, double y, double d[2])
{
    double length;
    d[0] = x * (double)g->ew - (double)g->ex;
    d[1] = y * (double)g->ew - (double)g->ey;
    length = hypot(d[0], d[1]);
    d[0] /= length;
    d[1] /= length;
    return length;
}

static int inside(const tyni_slices *g, double x, double y, double slack)
{
    return x >= 0.5 - slack && y >= 0.5 - slack && x <= g->width - 0.5 + slack && y <= g->height - 0.5 + slack;
}

static int on_border(const tyni_slices *g, double x, double y)
{
    return inside(g, x, y, 0.01) && !inside(g, x, y, -0.01);
}

static void check_spoke(const ring *r, int32_t slot, int stretch)
{
    const tyni_slices *g = &r->slices;
    const tyni_spoke *s = &r->spokes[r->slots[slot]];
    double point[2], out[2], d[2], pitch = 1 / hypot((double)s->ux, (double)s->uy), length, at[2];
    tyni_slice line;
    int count = 0;
    walk_border(g, (double)slot * (double)g->spacing, point, out);
    direction(g, point[0], point[1], d);
    CHECK(d[0] * out[0] + d[1] * out[1] > -1e-4); /* it leaves the screen here */
    CHECK_NEAR(hypot(d[0] - (double)s->ux * pitch, d[1] - (double)s->uy * pitch), 0, 2e-3);
    length = hypot(point[0] - (double)s->x, point[1] - (double)s->y);
    CHECK_NEAR(pitch, stretch ? fmax(length / (SAMPLES - 1), 1) : length / (SAMPLES - 1), 1e-3 * (1 + length));
    /* the entry: the epipole, else where the line comes in */
    at[0] = (double)g->ex / (double)g->ew;
    at[1] = (double)g->ey / (double)g->ew;
    if (g->ew > 0 && inside(g, at[0], at[1], -0.02))
        CHECK_NEAR(hypot((double)s->x - at[0], (double)s->y - at[1]), 0, 0.01);
    else
        CHECK(on_border(g, (double)s->x, (double)s->y));
    /* its samples: on the line, on the screen, and none left out that is there */
    tyni_border_line(&line, g, &r->lamp, &r->view, r->slots[slot]);
    for (int32_t j = 0; j < SAMPLES; j++) {
        double x = (double)s->x + j * pitch * pitch * (double)s->ux, y = (double)s->y + j * pitch * pitch * (double)s->uy;
        double p = (double)tyni_slice_p(&line, j), m = (double)line.m0 + (double)line.slope * p;
        int kept = j >= line.first && j <= line.last;
        CHECK_NEAR(hypot(x - (line.along_y ? m : p), y - (line.along_y ? p : m)), 0, 0.02);
        if (!kept && g->ew > 0 && hypot(x - at[0], y - at[1]) < 0.51 + pitch && j < line.first)
            continue; /* beside the epipole */
        CHECK(kept ? inside(g, x, y, 0.05) : !inside(g, x, y, -0.05));
        count += kept;
    }
    CHECK(stretch ? count > 0 || length < 1.6 : count == SAMPLES - line.first);
    CHECK(line.first == 0 || (double)line.first * pitch < 0.51 + pitch || line.first == SAMPLES - 1);
}

static void test_layout(void)
{
    TEST("lines to border points: exits, entries, stretching");
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++)
            for (int stretch = 0; stretch < 2; stretch++) {
                static ring r;
                const tyni_slices *g = &r.slices;
                int32_t lines = 0;
                set_up(&r, &places[p], sizes[n][0], sizes[n][1], n & 1 ? 61 : SLOTS, stretch);
                for (int32_t k = 0; k < g->slot_count; k++) {
                    double point[2], out[2], d[2];
                    if (r.slots[k] >= 0) {
                        CHECK(r.slots[k] == lines);
                        lines++;
                        check_spoke(&r, k, stretch);
                        continue;
                    }
                    /* none: the light comes in here, or the line would be no longer than a point */
                    walk_border(g, (double)k * (double)g->spacing, point, out);
                    if (direction(g, point[0], point[1], d) > 0.02)
                        CHECK(d[0] * out[0] + d[1] * out[1] < 1e-3 ||
                              on_border(g, point[0] - 0.02 * d[0], point[1] - 0.02 * d[1]) ||
                              !inside(g, point[0] - 0.02 * d[0], point[1] - 0.02 * d[1], 0));
                }
                CHECK(lines == g->count && (g->slot_count > 0) == (sizes[n][0] * sizes[n][1] > 1));
                if (p < 2 && sizes[n][0] > 2 && sizes[n][1] > 2)
                    CHECK(lines == g->slot_count); /* from the epipole to everywhere */
            }
}

/* A pixel lies between the lines of its two slots, as far beyond the first as the blend says. */
static void test_find(void)
{
    TEST("the two lines next to a pixel");
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
            static ring r;
            const tyni_slices *g = &r.slices;
            int bad = 0;
            set_up(&r, &places[p], sizes[n][0], sizes[n][1], SLOTS, 1);
            for (int i = 0; i < sizes[n][0] * sizes[n][1]; i++) {
                double x = i % sizes[n][0] + 0.5, y = i / sizes[n][0] + 0.5, d[2], exit[2], out[2], way[2], length;
                int32_t slot[2] = {-9, -9};
                float blend = -1;
                length = direction(g, x, y, d);
                if (!tyni_border_find(g, (float)x, (float)y, slot, &blend)) {
                    bad += !(length < 1e-3) && g->slot_count > 0;
                    continue;
                }
                bad += slot[0] < 0 || slot[0] >= SLOTS || slot[1] != (slot[0] + 1) % SLOTS || !(blend >= 0 && blend <= 1);
                if (length < 0.05)
                    continue;
                /* the border point that they say is on the ray through the pixel */
                walk_border(g, ((double)slot[0] + (double)blend) * (double)g->spacing, exit, out);
                if (direction(g, exit[0], exit[1], way) > 0.05)
                    bad += fabs(way[0] * d[1] - way[1] * d[0]) > 2e-3 || way[0] * d[0] + way[1] * d[1] < 0.9;
            }
            if (bad)
                printf("  %s, %d x %d: %d\n", places[p].name, (int)sizes[n][0], (int)sizes[n][1], bad);
            CHECK(bad == 0);
        }
}

void test_border(void)
{
    test_layout();
    test_find();
}
