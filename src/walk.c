/* walk.c - see walk.h */
#include "walk.h"

#include "base.h"
#include "course.h"
#include "lanes/lanes.h"
#include "line.h"
#include "meter.h"
#include "num.h"

/* A ray on the map: a straight tyni_line of texels from (u, v) to (u + du, v + dv), with the parameter s from 0 to 1. Map depth
 * is linear in s, t is projective. */
typedef struct track {
    float u, v, du, dv, z, dz;
    float t[2], w[2];
} track;

/* Narrows t to the part of the ray that falls on the map; 0 if none does. */
static int on_map(const tyni_map *map, const tyni_sight *v, float t[2])
{
    tyni_line u = tyni_line_along(&map->u, v), y = tyni_line_along(&map->v, v), w = tyni_line_along(&map->w, v), edge;
    float width = (float)map->texels.width, height = (float)map->texels.height;
    edge.c = w.c - 1e-6f;
    edge.d = w.d;
    tyni_line_clip(edge, t);
    tyni_line_clip(u, t);
    tyni_line_clip(y, t);
    edge.c = width * w.c - u.c;
    edge.d = width * w.d - u.d;
    tyni_line_clip(edge, t);
    edge.c = height * w.c - y.c;
    edge.d = height * w.d - y.d;
    tyni_line_clip(edge, t);
    return t[0] < t[1];
}

static TYNI_NOINLINE int track_begin(track *k, const tyni_map *map, const tyni_sight *v, const float part[2])
{
    tyni_line lu = tyni_line_along(&map->u, v), lv = tyni_line_along(&map->v, v);
    tyni_line lz = tyni_line_along(&map->z, v), lw = tyni_line_along(&map->w, v);
    float width = (float)map->texels.width, height = (float)map->texels.height, u[2], y[2], z[2];
    k->t[0] = part[0];
    k->t[1] = part[1];
    if (!on_map(map, v, k->t))
        return 0;
    for (int32_t i = 0; i < 2; i++) {
        float w = tyni_maxf(tyni_line_at(lw, k->t[i]), 1e-9f);
        k->w[i] = w;
        u[i] = tyni_clampf(tyni_line_at(lu, k->t[i]) / w, 0.0f, width);
        y[i] = tyni_clampf(tyni_line_at(lv, k->t[i]) / w, 0.0f, height);
        z[i] = tyni_line_at(lz, k->t[i]) / w;
    }
    k->u = u[0];
    k->v = y[0];
    k->z = z[0];
    k->du = u[1] - u[0];
    k->dv = y[1] - y[0];
    k->dz = z[1] - z[0];
    return 1;
}

static float track_t(const track *k, float s)
{
    float a = (1.0f - s) * k->w[1], b = s * k->w[0];
    return (a * k->t[0] + b * k->t[1]) / (a + b);
}

/* A track step by step along its course: step k lies between k and k + 1. In a step the ray crosses one texel, or two that meet
 * at k + cut. */
typedef struct traversal {
    const tyni_texels *texels;
    tyni_course course;
    tyni_cells cells;
    int32_t steps;
    float rise;  /* 1 / slope */
    float z, dz; /* of step coordinates: z + k dz */
} traversal;

/* 0: the course has no length, the ray stays in one texel. */
static TYNI_NOINLINE int traversal_begin(traversal *r, const tyni_map *map, const track *k)
{
    float u[2], v[2], length;
    u[0] = k->u;
    u[1] = k->u + k->du;
    v[0] = k->v;
    v[1] = k->v + k->dv;
    tyni_course_begin(&r->course, u, v);
    r->texels = &map->texels;
    r->steps = tyni_course_on(&r->course, r->texels, &r->cells);
    r->rise = 1.0f / r->course.slope;
    length = r->course.to - r->course.from;
    if (!(length > 1e-6f))
        return 0;
    r->dz = k->dz / length;
    r->z = k->z - r->course.from * r->dz;
    return 1;
}

/* Turns, where light begins or ends, wait until there is a vector of them: each as 4 times its step and which of the step's
 * states it begins, in the order in, out, in, out; and then, in the same place, the bits of its t. */
#define TURNS 16

/* ---- kernels ---- */

/* Steps side by side: the middle of step i is at from + (i + 0.5) dt. */
typedef struct stride {
    float from, dt;
    int32_t steps;
} stride;

/* A map's forms along the ray. */
typedef struct trail {
    tyni_line u, v, z, w;
} trail;

static void trail_of(trail *t, const tyni_map *map, const tyni_sight *v)
{
    t->u = tyni_line_along(&map->u, v);
    t->v = tyni_line_along(&map->v, v);
    t->z = tyni_line_along(&map->z, v);
    t->w = tyni_line_along(&map->w, v);
}

/* Slides and tints at n places; red, green and blue `pitch` apart. */
static void colours(const tyni_lamp *lamp, const tyni_sight *v, const float *t, int32_t n, float *rgb, int32_t pitch)
{
    for (int32_t i = 0; i < n; i++) {
        float one[3];
        tyni_view_colour(lamp, tyni_sight_at(v, t[i]), one);
        for (int32_t c = 0; c < 3; c++)
            rgb[c * pitch + i] = one[c];
    }
}

#define TYNI_KERNEL "walk_kernel.h"
#include "lanes/each.h"

/* ---- the exact walk ---- */

/* Where a ray whose depth goes from za to zb passes z, from 0 to 1. */
static float passes(float za, float zb, float z)
{
    return za != zb ? tyni_clampf((z - za) / (zb - za), 0.0f, 1.0f) : 0.0f;
}

static void walk_texel(const tyni_map *map, const track *way, tyni_meter *m)
{
    const tyni_texels *t = &map->texels;
    float z = tyni_texels_at(t, tyni_mini((int32_t)way->u, t->width - 1), tyni_mini((int32_t)way->v, t->height - 1));
    float za = tyni_maxf(way->z, 0.0f), zb = tyni_maxf(way->z + way->dz, 0.0f);
    tyni_meter_lit(m, za >= z, way->t[0]);
    if ((za >= z) != (zb >= z))
        tyni_meter_lit(m, zb >= z, track_t(way, passes(way->z, way->z + way->dz, z)));
}

#define PACES 64 /* at least: rays over few texels are looked at closely */

/* At most TURNS of them. */
static void take_turns(int32_t isa, const traversal *r, const track *way, int32_t *turn, int32_t count, tyni_meter *m)
{
    int plain = tyni_view_kind(m->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_coloured(m->lamp);
    TYNI_LANES_CALL(isa, walk_turns, (r, way, turn, count, plain, m));
    for (int32_t i = 0; i < count && !plain; i++)
        tyni_meter_lit(m, m->on == m->outside, tyni_bits_float((uint32_t)turn[i]));
}

/* `pace` steps at a time: where they are more than one, a texel in the middle stands for all of them. */
static void walk_texels(int32_t isa, const tyni_map *map, int32_t pace, const track *way, tyni_meter *m)
{
    int32_t turn[TURNS], count = 0, paces;
    uint32_t before = (uint32_t)(m->on != m->outside);
    traversal r;
    if (!traversal_begin(&r, map, way)) {
        walk_texel(map, way, m);
        return;
    }
    pace = tyni_clampi(r.steps / PACES, 1, pace);
    paces = (r.steps + pace - 1) / pace;
    for (int32_t k = 0; k < paces; k += 32) {
        uint32_t lit[4], last, some;
        if (pace > 1)
            TYNI_LANES_CALL(isa, walk_paces, (&r, pace, k, lit));
        else
            TYNI_LANES_CALL(isa, walk_states, (&r, k, lit));
        /* from what is lit to what changes */
        last = lit[3];
        lit[3] ^= lit[2];
        lit[2] ^= lit[1];
        lit[1] ^= lit[0];
        lit[0] ^= last << 1 | before;
        before = last >> 31;
        some = lit[0] | lit[1] | lit[2] | lit[3];
        if (paces - k < 32)
            some &= (1u << (paces - k)) - 1u;
        for (; some; some &= some - 1) {
            int32_t bit = tyni_ctz32(some);
            for (int32_t e = 0; e < 4; e++) {
                turn[count] = 4 * (k + bit) * pace + e;
                count += (int32_t)(lit[e] >> bit & 1u); /* no branch: nobody can foretell it */
                if (count == TURNS) {
                    take_turns(isa, &r, way, turn, TURNS, m);
                    count = 0;
                }
            }
        }
    }
    if (count)
        take_turns(isa, &r, way, turn, count, m);
}

void tyni_walk_ray(int32_t isa, const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v, int32_t pace, float *light)
{
    /* parts of the ray that no map has covered yet */
    float part[TYN_MAX_MAPS + 1][2];
    int32_t parts = 1;
    tyni_meter m;
    track k;
    tyni_meter_begin(&m, it, lamp, v, light);
    if (!(it->t0 < it->t1))
        return;
    part[0][0] = it->t0;
    part[0][1] = it->t1;
    for (int32_t i = 0; i < lamp->map_count; i++)
        for (int32_t n = parts - 1; n >= 0; n--) {
            float end = part[n][1];
            if (!(part[n][0] < end) || !track_begin(&k, &lamp->maps[i], v, part[n]))
                continue;
            walk_texels(isa, &lamp->maps[i], pace, &k, &m);
            tyni_meter_lit(&m, lamp->outside, k.t[1]);
            part[n][1] = k.t[0];
            if (k.t[1] < end && parts <= TYN_MAX_MAPS) {
                part[parts][0] = k.t[1];
                part[parts++][1] = end;
            }
        }
    tyni_meter_end(&m);
}

/* ED10 marches inside the light's frustum alone. Narrows t to what the maps cover, from the first to the last, and adds the
 * light before and after it in closed form, where there is one. */
static void inside_frustum(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float t[2], float light[3])
{
    float from = t[1], to = t[0], part[2];
    if (tyni_view_coloured(lamp) || lamp->lift != 0.0f || (lamp->outside && tyni_view_kind(lamp) != TYN_LIGHT_DIRECTIONAL))
        return;
    for (int32_t i = 0; i < lamp->map_count; i++) {
        part[0] = t[0];
        part[1] = t[1];
        if (!on_map(&lamp->maps[i], v, part))
            continue;
        from = tyni_minf(from, part[0]);
        to = tyni_maxf(to, part[1]);
    }
    from = tyni_minf(from, to); /* no map at all: everything is after it */
    if (lamp->outside)
        for (int32_t c = 0; c < 3; c++) {
            float s = medium->sigma[c];
            light[c] = from * tyni_num_fog(s * from) - t[0] * tyni_num_fog(s * t[0]);
            light[c] += t[1] * tyni_num_fog(s * t[1]) - to * tyni_num_fog(s * to);
        }
    t[0] = from;
    t[1] = to;
}

void tyni_walk_steps(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float t0, float t1,
                     int32_t steps, float light[3])
{
    float part[2], dark[3] = {0.0f, 0.0f, 0.0f};
    stride s;
    light[0] = light[1] = light[2] = 0.0f;
    part[0] = t0;
    part[1] = t1;
    if (!(t0 < t1))
        return;
    inside_frustum(lamp, medium, v, part, light);
    s.from = part[0];
    s.dt = (part[1] - part[0]) / (float)steps;
    s.steps = steps;
    if (s.dt > 0.0f)
        TYNI_LANES_CALL(isa, walk_steps, (lamp, medium, v, &s, 1, light));
    if (s.dt > 0.0f && lamp->lift != 0.0f)
        TYNI_LANES_CALL(isa, walk_steps, (lamp, medium, v, &s, 0, dark));
    for (int32_t c = 0; c < 3; c++)
        light[c] = tyni_maxf(light[c] + lamp->lift * dark[c], 0.0f);
}

/* The light's colour and, of a sun, the phase function. */
static TYNI_NOINLINE void colour_in(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float light[3])
{
    float mix[3] = {1.0f, 1.0f, 1.0f};
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL)
        tyni_medium_mix(medium, tyni_clampf(tyni_vec_dot(v->d, lamp->to_light), -1.0f, 1.0f), mix);
    for (int32_t c = 0; c < 3; c++)
        light[c] *= mix[c] * lamp->colour[c];
}

void tyni_walk_pixel(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s, int32_t pace,
                     float light[3])
{
    static const int32_t channels[3] = {0, 1, 2};
    float t0 = 0.0f, t1 = s;
    tyni_integral it;
    light[0] = light[1] = light[2] = 0.0f;
    if (!tyni_view_clip(lamp, v, &t0, &t1))
        return;
    tyni_integral_begin(&it, medium, lamp, v, t0, t1, channels, 3);
    tyni_walk_ray(isa, lamp, &it, v, pace, light);
    colour_in(lamp, medium, v, light);
}

void tyni_walk_pixel_steps(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s,
                           int32_t steps, float light[3])
{
    float t0 = 0.0f, t1 = s;
    light[0] = light[1] = light[2] = 0.0f;
    if (!tyni_view_clip(lamp, v, &t0, &t1))
        return;
    tyni_walk_steps(isa, lamp, medium, v, t0, t1, steps, light);
    colour_in(lamp, medium, v, light);
}
