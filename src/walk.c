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
    int32_t first, steps; /* the first step's texel along the major axis */
    float rise;           /* 1 / slope */
    float z, dz;          /* of step coordinates: z + k dz */
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
    r->steps = tyni_course_on(&r->course, r->texels, &r->first);
    r->rise = 1.0f / r->course.slope;
    length = r->course.to - r->course.from;
    if (!(length > 1e-6f))
        return 0;
    r->dz = k->dz / length;
    r->z = k->z - r->course.from * r->dz;
    return 1;
}

/* Of 32 steps, a bit each: whether the ray is lit where it comes into the step's first texel and where it leaves it, then the
 * same of the second; where there is none, what the first one left behind. */
typedef struct states {
    uint32_t in[2], out[2];
} states;

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

/* t of a step coordinate. */
static float step_t(const traversal *r, const track *way, float at)
{
    return track_t(way, tyni_clampf((at - r->course.from) / (r->course.to - r->course.from), 0.0f, 1.0f));
}

/* Where a ray whose depth goes from za to zb passes z, from 0 to 1. */
static float passes(float za, float zb, float z)
{
    return za != zb ? tyni_clampf((z - za) / (zb - za), 0.0f, 1.0f) : 0.0f;
}

/* Step k, in which something changes: what walk_states does, and at what t of its four states the ray is. Returns how many
 * count. */
static TYNI_NOINLINE int32_t times_in_step(const traversal *r, const track *way, int32_t k, const states *lit, int32_t bit,
                                           float t[4])
{
    const tyni_course *c = &r->course;
    int32_t major = r->first + (c->sign > 0.0f ? k : -k), most = (c->across ? r->texels->height : r->texels->width) - 1;
    float from = c->minor + c->slope * (float)k, to = c->minor + c->slope * ((float)k + 1.0f), at[3];
    int32_t minor[2], texels;
    minor[0] = tyni_clampi(tyni_floori(from), 0, most);
    minor[1] = tyni_clampi(tyni_floori(to), 0, most);
    texels = minor[0] != minor[1] ? 2 : 1;
    at[0] = tyni_maxf((float)k, c->from);
    at[1] = at[2] = tyni_minf((float)k + 1.0f, c->to);
    if (texels > 1)
        at[1] = tyni_clampf((float)k + ((float)tyni_maxi(minor[0], minor[1]) - from) * r->rise, at[0], at[2]);
    for (int32_t i = 0; i < texels; i++) {
        float z = tyni_texels_at(r->texels, c->across ? major : minor[i], c->across ? minor[i] : major);
        t[2 * i] = t[2 * i + 1] = step_t(r, way, at[i]);
        if ((lit->in[i] ^ lit->out[i]) >> bit & 1) {
            z = passes(r->z + at[i] * r->dz, r->z + at[i + 1] * r->dz, z);
            t[2 * i + 1] = step_t(r, way, at[i] + z * (at[i + 1] - at[i]));
        }
    }
    return 2 * texels;
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

/* Steps k .. k + 31 and where they change. */
static void walk_closely(int32_t isa, const traversal *r, int32_t k, const track *way, tyni_meter *m)
{
    uint32_t before = (uint32_t)(m->on != m->outside), changes;
    states lit;
    float t[4];
    TYNI_LANES_CALL(isa, walk_states, (r, k, &lit));
    changes = (lit.in[0] ^ (lit.out[1] << 1 | before)) | (lit.in[0] ^ lit.out[0]) | (lit.out[0] ^ lit.in[1]);
    changes |= lit.in[1] ^ lit.out[1];
    if (r->steps - k < 32)
        changes &= (1u << (r->steps - k)) - 1u;
    for (; changes; changes &= changes - 1) {
        int32_t bit = tyni_ctz32(changes), count = times_in_step(r, way, k + bit, &lit, bit, t);
        for (int32_t i = 0; i < count; i++)
            tyni_meter_lit(m, (i & 1 ? lit.out : lit.in)[i >> 1] >> bit & 1, t[i]);
    }
}

/* Paces k .. k + 31 of `count`, each of `pace` steps: a texel in the middle stands for all of them. */
static void walk_pacing(int32_t isa, const traversal *r, int32_t pace, int32_t k, const track *way, tyni_meter *m)
{
    uint32_t before = (uint32_t)(m->on != m->outside), lit, changes;
    int32_t left = (r->steps + pace - 1) / pace - k;
    TYNI_LANES_CALL(isa, walk_paces, (r, pace, k, &lit));
    changes = lit ^ (lit << 1 | before);
    if (left < 32)
        changes &= (1u << left) - 1u;
    for (; changes; changes &= changes - 1) {
        int32_t bit = tyni_ctz32(changes);
        tyni_meter_lit(m, lit >> bit & 1, step_t(r, way, (float)((k + bit) * pace)));
    }
}

static void walk_texels(int32_t isa, const tyni_map *map, int32_t pace, const track *way, tyni_meter *m)
{
    traversal r;
    if (!traversal_begin(&r, map, way)) {
        walk_texel(map, way, m);
        return;
    }
    pace = tyni_clampi(r.steps / PACES, 1, pace);
    for (int32_t k = 0; k * pace < r.steps; k += 32) {
        if (pace > 1)
            walk_pacing(isa, &r, pace, k, way, m);
        else
            walk_closely(isa, &r, k, way, m);
    }
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
