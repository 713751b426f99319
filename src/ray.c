/* ray.c - see ray.h */
#include "ray.h"

#include "base.h"

/* The sum over intervals in the making: switched on and off at rising t within a piece, in any order of pieces. What is summed
 * is whatever differs from `outside`: shadows where all else is lit, light where all else is dark. */
typedef struct meter {
    const tyni_integral *integral;
    const tyni_lamp *lamp;
    const tyni_sight *v;
    float *sum;
    float from; /* t of the last switch */
    int outside, on;
} meter;

static void meter_begin(meter *m, const tyni_integral *integral, const tyni_lamp *lamp, const tyni_sight *v, float *sum)
{
    m->integral = integral;
    m->lamp = lamp;
    m->v = v;
    m->sum = sum;
    m->outside = lamp->outside;
    m->on = 0;
    for (int32_t i = 0; i < integral->count; i++)
        sum[i] = 0.0f;
}

/* Parts in which a slide's or tint's colour is taken as one: one per texel crossed, about. */
static int32_t colour_parts(const meter *m, float ta, float tb)
{
    const tyni_lamp *lamp = m->lamp;
    float texels = 0.0f;
    for (int32_t i = 0; i < lamp->slide_count + lamp->map_count; i++) {
        const tyni_form *s = i < lamp->slide_count ? &lamp->slides[i].s : &lamp->maps[i - lamp->slide_count].u;
        const tyni_form *t = i < lamp->slide_count ? &lamp->slides[i].t : &lamp->maps[i - lamp->slide_count].v;
        const tyni_form *w = i < lamp->slide_count ? &lamp->slides[i].w : &lamp->maps[i - lamp->slide_count].w;
        tyni_vec3 a = tyni_sight_at(m->v, ta), b = tyni_sight_at(m->v, tb);
        float wa = tyni_form_at(w, a), wb = tyni_form_at(w, b), ds, dt, scale = 1.0f;
        if (i >= lamp->slide_count) {
            const tyni_map *map = &lamp->maps[i - lamp->slide_count];
            if (!map->tint)
                continue;
            scale =
                (float)tyni_maxi(map->tint->width, map->tint->height) / (float)tyni_mini(map->texels.width, map->texels.height);
        }
        if (!(wa > 0.0f && wb > 0.0f)) {
            texels = 4096.0f; /* from one face of a cube to another */
            continue;
        }
        ds = tyni_form_at(s, b) / wb - tyni_form_at(s, a) / wa;
        dt = tyni_form_at(t, b) / wb - tyni_form_at(t, a) / wa;
        texels = tyni_maxf(texels, scale * (tyni_absf(ds) + tyni_absf(dt)));
    }
    /* four to a texel while that is cheap: the integrand varies as well */
    return 2 + (int32_t)tyni_minf(tyni_minf(4.0f * texels, texels + 96.0f), lamp->kind == TYN_LIGHT_POINT ? 1024.0f : 4096.0f);
}

/* The integral from ta to tb, times the light's colour column by column. */
static void meter_coloured(meter *m, float ta, float tb)
{
    int32_t parts = colour_parts(m, ta, tb);
    float last[3], next[3], rgb[3], x = tyni_integral_variable(m->integral, ta);
    float step = (tyni_integral_variable(m->integral, tb) - x) / (float)parts;
    tyni_integral_at(m->integral, ta, last);
    for (int32_t k = 0; k < parts; k++) {
        tyni_integral_at_variable(m->integral, x + (float)(k + 1) * step, next);
        tyni_view_colour(m->lamp, tyni_sight_at(m->v, tyni_integral_t(m->integral, x + ((float)k + 0.5f) * step)), rgb);
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] += (next[i] - last[i]) * rgb[m->integral->channels[i]];
        memcpy(last, next, sizeof last);
    }
}

static void meter_lit(meter *m, int lit, float t)
{
    float at[3];
    int on = lit != m->outside;
    if (on == m->on)
        return;
    m->on = on;
    if (m->lamp->coloured) {
        if (!on && t > m->from)
            meter_coloured(m, m->from, t);
        m->from = t;
        return;
    }
    tyni_integral_at(m->integral, t, at);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] += on ? -at[i] : at[i];
}

static void meter_end(meter *m)
{
    float all[3], shade[3];
    if (m->outside && m->lamp->coloured) {
        memcpy(shade, m->sum, sizeof *shade * (size_t)m->integral->count);
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = 0.0f;
        meter_coloured(m, m->integral->t0, m->integral->t1);
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = tyni_maxf(m->sum[i] - shade[i], 0.0f);
        return;
    }
    if (m->lamp->coloured) {
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = tyni_maxf(m->sum[i], 0.0f); /* differences of rounded sums */
        return;
    }
    tyni_integral_at(m->integral, m->integral->t1, all);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] = tyni_clampf(m->outside ? all[i] - m->sum[i] : m->sum[i], 0.0f, all[i]);
}

/* The end of a ray: shadows as strong as the frame wants them. */
static void meter_lift(meter *m)
{
    float lit[3], all[3];
    if (m->lamp->lift == 0.0f)
        return;
    memcpy(lit, m->sum, sizeof *lit * (size_t)m->integral->count);
    if (m->lamp->coloured) {
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = 0.0f;
        meter_coloured(m, m->integral->t0, m->integral->t1);
        memcpy(all, m->sum, sizeof *all * (size_t)m->integral->count);
    } else {
        tyni_integral_at(m->integral, m->integral->t1, all);
    }
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] = tyni_maxf(lit[i] + m->lamp->lift * (all[i] - lit[i]), 0.0f);
}

/* A form along a ray: c + t * d. */
typedef struct line {
    float c, d;
} line;

static line along(const tyni_form *f, const tyni_sight *v)
{
    line l;
    l.c = tyni_form_at(f, v->o);
    l.d = tyni_vec_dot(f->v, v->d);
    return l;
}

static float line_at(line l, float t)
{
    return l.c + t * l.d;
}

/* Narrows t[0] .. t[1] to where l >= 0. */
static void line_clip(line l, float t[2])
{
    float a = line_at(l, t[0]), b = line_at(l, t[1]);
    if (a < 0.0f && b < 0.0f)
        t[1] = t[0] - 1.0f;
    else if (a < 0.0f)
        t[0] = t[0] + (t[1] - t[0]) * (a / (a - b));
    else if (b < 0.0f)
        t[1] = t[0] + (t[1] - t[0]) * (a / (a - b));
}

/* A ray on the map: a straight line of texels from (u, v) to (u + du, v + dv), with the parameter s from 0 to 1. Map depth is
 * linear in s, t is projective. */
typedef struct track {
    float u, v, du, dv, z, dz;
    float t[2], w[2];
} track;

static int track_begin(track *k, const tyni_map *map, const tyni_sight *v, const float part[2])
{
    line lu = along(&map->u, v), lv = along(&map->v, v), lz = along(&map->z, v), lw = along(&map->w, v), edge;
    float width = (float)map->texels.width, height = (float)map->texels.height, u[2], y[2], z[2];
    k->t[0] = part[0];
    k->t[1] = part[1];
    edge.c = lw.c - 1e-6f;
    edge.d = lw.d;
    line_clip(edge, k->t);
    line_clip(lu, k->t);
    line_clip(lv, k->t);
    edge.c = width * lw.c - lu.c;
    edge.d = width * lw.d - lu.d;
    line_clip(edge, k->t);
    edge.c = height * lw.c - lv.c;
    edge.d = height * lw.d - lv.d;
    line_clip(edge, k->t);
    if (!(k->t[0] < k->t[1]))
        return 0;
    for (int32_t i = 0; i < 2; i++) {
        float w = tyni_maxf(line_at(lw, k->t[i]), 1e-9f);
        k->w[i] = w;
        u[i] = tyni_clampf(line_at(lu, k->t[i]) / w, 0.0f, width);
        y[i] = tyni_clampf(line_at(lv, k->t[i]) / w, 0.0f, height);
        z[i] = line_at(lz, k->t[i]) / w;
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

/* One axis of the walk: the texel, where in s the next border is, and how far apart borders are. */
typedef struct axis {
    int32_t texel, step;
    float next, pitch;
} axis;

static axis axis_begin(float x, float dx, int32_t size)
{
    axis a;
    a.texel = tyni_clampi((int32_t)x, 0, size - 1);
    a.step = dx >= 0.0f ? 1 : -1;
    if (tyni_absf(dx) > 1e-6f) {
        a.pitch = 1.0f / tyni_absf(dx);
        a.next = tyni_maxf((dx >= 0.0f ? (float)a.texel + 1.0f - x : x - (float)a.texel) * a.pitch, 0.0f);
    } else {
        a.pitch = 2.0f;
        a.next = 2.0f;
    }
    return a;
}

static void walk_texels(const tyni_map *map, const track *k, meter *m)
{
    const tyni_texels *texels = &map->texels;
    axis u = axis_begin(k->u, k->du, texels->width), v = axis_begin(k->v, k->dv, texels->height);
    float s = 0.0f, za = k->z;
    /* every step leaves a texel for good: at most both sides of them, whatever rounding does */
    for (int32_t left = texels->width + texels->height + 2; left > 0; left--) {
        float depth = tyni_texels_at(texels, u.texel, v.texel);
        float end = tyni_minf(tyni_minf(u.next, v.next), 1.0f), zb = k->z + end * k->dz;
        int open = !(depth > 0.0f), lit_a, lit_b;
        lit_a = open || za >= depth;
        lit_b = open || zb >= depth;
        if ((lit_a != m->outside) != m->on)
            meter_lit(m, lit_a, track_t(k, s));
        if (lit_b != lit_a)
            meter_lit(m, lit_b, track_t(k, s + (end - s) * ((depth - za) / (zb - za))));
        if (end >= 1.0f)
            return;
        if (u.next <= v.next) {
            u.texel += u.step;
            u.next += u.pitch;
        } else {
            v.texel += v.step;
            v.next += v.pitch;
        }
        if ((uint32_t)u.texel >= (uint32_t)texels->width || (uint32_t)v.texel >= (uint32_t)texels->height)
            return;
        s = end;
        za = zb;
    }
}

void tyni_ray_walk(const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v, float *light)
{
    /* parts of the ray that no map has covered yet */
    float part[TYN_MAX_MAPS + 1][2];
    int32_t parts = 1;
    meter m;
    track k;
    meter_begin(&m, it, lamp, v, light);
    if (!(it->t0 < it->t1))
        return;
    part[0][0] = it->t0;
    part[0][1] = it->t1;
    for (int32_t i = 0; i < lamp->map_count; i++)
        for (int32_t n = parts - 1; n >= 0; n--) {
            float end = part[n][1];
            if (!(part[n][0] < end) || !track_begin(&k, &lamp->maps[i], v, part[n]))
                continue;
            walk_texels(&lamp->maps[i], &k, &m);
            meter_lit(&m, lamp->outside, k.t[1]);
            part[n][1] = k.t[0];
            if (k.t[1] < end && parts <= TYN_MAX_MAPS) {
                part[parts][0] = k.t[1];
                part[parts++][1] = end;
            }
        }
    meter_end(&m);
    meter_lift(&m);
}

/* Visibility of columns i .. i + 31 of the row; bits past its end are 0. */
static uint32_t visibility(const tyni_piece *row, int32_t i, uint32_t position)
{
    uint32_t bits = 0;
    int32_t n = tyni_mini(32, 2 * row->steps - i);
    for (int32_t b = 0; b < n; b++)
        bits |= (uint32_t)(position < row->threshold[i + b]) << b;
    return bits;
}

/* t of a step coordinate. */
static float border_t(line r, line w, float at)
{
    return (at * w.c - r.c) / (r.d - at * w.d);
}

static void row_words(const tyni_piece *row, uint32_t position, line r, line w, float from, float to, meter *m)
{
    int32_t a = tyni_clampi((int32_t)from, 0, row->steps - 1), b = tyni_clampi(tyni_ceili(to) - 1, a, row->steps - 1);
    int32_t first = 2 * a + (from - (float)a >= row->split[a]), last = 2 * b + (to - (float)b > row->split[b]);
    for (int32_t i = first & ~31; i <= last; i += 32) {
        uint32_t bits = visibility(row, i, position), changes;
        if (i < first) { /* columns before the ray look like its first */
            uint32_t before = (1u << (first - i)) - 1u;
            bits = bits >> (first - i) & 1u ? bits | before : bits & ~before;
        }
        if (last - i < 31) { /* and those after it like its last */
            uint32_t after = 0xffffffffu << (last - i) << 1;
            bits = bits >> (last - i) & 1u ? bits | after : bits & ~after;
        }
        /* the first column of a word changes at its border, or where the ray comes in */
        if ((int)(bits & 1u) != (m->on ^ m->outside))
            meter_lit(m, (int)(bits & 1u), border_t(r, w, i <= first ? tyni_maxf(from, 0.0f) : tyni_row_edge(row, i)));
        changes = bits ^ (bits << 1 | (bits & 1u));
        for (; changes; changes &= changes - 1) {
            int32_t k = tyni_ctz32(changes);
            meter_lit(m, (int)(bits >> k & 1u), border_t(r, w, tyni_row_edge(row, i + k)));
        }
    }
    meter_lit(m, m->outside, border_t(r, w, tyni_minf(to, (float)row->steps)));
}

/* Step coordinates of the ray's ends, of its part in front of the map. 0: none is. */
static int row_span(line r, line w, float part[2], float *from, float *to)
{
    line edge = w;
    edge.c -= 1e-6f;
    line_clip(edge, part);
    if (!(part[0] < part[1]))
        return 0;
    *from = line_at(r, part[0]) / line_at(w, part[0]);
    *to = line_at(r, part[1]) / line_at(w, part[1]);
    return 1;
}

void tyni_ray_row(const tyni_row *row, float p, const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v,
                  float *light)
{
    uint32_t position = tyni_row_position(row, p);
    meter m;
    meter_begin(&m, it, lamp, v, light);
    if (!(it->t0 < it->t1))
        return;
    for (int32_t i = 0; i < row->count; i++) {
        const tyni_piece *piece = &row->pieces[i];
        line r = along(&piece->r, v), w = along(&piece->w, v);
        float part[2], from, to;
        part[0] = it->t0;
        part[1] = it->t1;
        if (!row_span(r, w, part, &from, &to))
            continue;
        /* a piece's columns begin and end inside its first and last step where another piece goes on */
        from = tyni_maxf(from, piece->from);
        to = tyni_minf(to, piece->to);
        if (from < to)
            row_words(piece, position, r, w, from, to, &m);
    }
    meter_end(&m);
    meter_lift(&m);
}

int tyni_ray_coarse(const tyni_row *row, const tyni_integral *it, const tyni_sight *v)
{
    float part[2], from, to, texels = 0.0f, depth = it->sigma[it->count - 1] * (it->t1 - it->t0);
    if (row->count < 1)
        return 0;
    for (int32_t i = 0; i < row->count; i++) {
        part[0] = it->t0;
        part[1] = it->t1;
        if (row_span(along(&row->pieces[i].r, v), along(&row->pieces[i].w, v), part, &from, &to))
            texels += tyni_maxf(tyni_minf(to, row->pieces[i].to) - tyni_maxf(from, row->pieces[i].from), 0.0f);
    }
    /* a texel's share of the light, at most: 1 / texels in thin air, its optical depth in thick */
    return tyni_maxf(1.0f, depth) > 0.05f * texels;
}

static int point_lit(const tyni_lamp *lamp, const tyni_sight *v, float t)
{
    for (int32_t i = 0; i < lamp->map_count; i++) {
        const tyni_map *map = &lamp->maps[i];
        float w = line_at(along(&map->w, v), t), depth, x, y;
        if (!(w > 0.0f))
            continue;
        x = line_at(along(&map->u, v), t) / w;
        y = line_at(along(&map->v, v), t) / w;
        if (!(x >= 0.0f && y >= 0.0f && x < (float)map->texels.width && y < (float)map->texels.height))
            continue;
        depth = tyni_texels_at(&map->texels, (int32_t)x, (int32_t)y);
        return !(depth > 0.0f) || line_at(along(&map->z, v), t) / w >= depth;
    }
    return lamp->outside;
}

void tyni_ray_steps(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float t0, float t1, int32_t steps,
                    float light[3])
{
    float dt = (t1 - t0) / (float)steps, density[3], rgb[3] = {1.0f, 1.0f, 1.0f}, dark[3] = {0.0f, 0.0f, 0.0f};
    light[0] = light[1] = light[2] = 0.0f;
    if (!(dt > 0.0f))
        return;
    for (int32_t i = 0; i < steps; i++) {
        float t = t0 + ((float)i + 0.5f) * dt;
        int lit = point_lit(lamp, v, t);
        if (!lit && lamp->lift == 0.0f)
            continue;
        tyni_integral_density(medium, lamp, v, t, density);
        if (lamp->coloured)
            tyni_view_colour(lamp, tyni_sight_at(v, t), rgb);
        for (int32_t c = 0; c < 3; c++)
            *(lit ? &light[c] : &dark[c]) += density[c] * dt * rgb[c];
    }
    for (int32_t c = 0; c < 3; c++)
        light[c] = tyni_maxf(light[c] + lamp->lift * dark[c], 0.0f);
}

void tyni_ray_pixel(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s, int32_t steps,
                    float light[3])
{
    static const int32_t channels[3] = {0, 1, 2};
    float t0 = 0.0f, t1 = s, mix[3];
    tyni_integral it;
    light[0] = light[1] = light[2] = 0.0f;
    if (!tyni_view_clip(lamp, v, &t0, &t1))
        return;
    if (steps) {
        tyni_ray_steps(lamp, medium, v, t0, t1, steps, light);
    } else {
        tyni_integral_begin(&it, medium, lamp, v, t0, t1, channels, 3);
        tyni_ray_walk(lamp, &it, v, light);
    }
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL)
        tyni_medium_mix(medium, tyni_clampf(tyni_vec_dot(v->d, lamp->to_light), -1.0f, 1.0f), mix);
    else
        mix[0] = mix[1] = mix[2] = 1.0f;
    for (int32_t c = 0; c < 3; c++)
        light[c] *= mix[c] * lamp->colour[c];
}
