/* meter.c - see meter.h */
#include "meter.h"

#include "base.h"

void tyni_meter_begin(tyni_meter *m, const tyni_integral *integral, const tyni_lamp *lamp, const tyni_sight *v, float *sum)
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
static TYNI_NOINLINE int32_t colour_parts(const tyni_meter *m, float ta, float tb)
{
    const tyni_lamp *lamp = m->lamp;
    float texels = 0.0f;
    for (int32_t i = 0; i < tyni_view_slides(lamp) + lamp->map_count; i++) {
        const tyni_form *s = i < tyni_view_slides(lamp) ? &lamp->slides[i].s : &lamp->maps[i - tyni_view_slides(lamp)].u;
        const tyni_form *t = i < tyni_view_slides(lamp) ? &lamp->slides[i].t : &lamp->maps[i - tyni_view_slides(lamp)].v;
        const tyni_form *w = i < tyni_view_slides(lamp) ? &lamp->slides[i].w : &lamp->maps[i - tyni_view_slides(lamp)].w;
        tyni_vec3 a = tyni_sight_at(m->v, ta), b = tyni_sight_at(m->v, tb);
        float wa = tyni_form_at(w, a), wb = tyni_form_at(w, b), ds, dt, scale = 1.0f;
        if (i >= tyni_view_slides(lamp)) {
            const tyni_map *map = &lamp->maps[i - tyni_view_slides(lamp)];
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
    return 2 + (int32_t)tyni_minf(tyni_minf(4.0f * texels, texels + 96.0f),
                                  tyni_view_kind(lamp) == TYN_LIGHT_POINT ? 1024.0f : 4096.0f);
}

/* The integral from ta to tb, times the light's colour column by column. */
static void coloured(tyni_meter *m, float ta, float tb)
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

/* Apart from tyni_meter_lit: what only this needs is off the stack when colours are looked up. */
static TYNI_NOINLINE void plain(tyni_meter *m, float t)
{
    float at[3];
    tyni_integral_at(m->integral, t, at);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] += m->on ? -at[i] : at[i];
}

void tyni_meter_lit(tyni_meter *m, int lit, float t)
{
    float from = m->from;
    int on = lit != m->outside;
    if (on == m->on)
        return;
    m->on = on;
    m->from = t;
    if (!tyni_view_coloured(m->lamp))
        plain(m, t);
    else if (!on && t > from)
        coloured(m, from, t);
}

static void settle(tyni_meter *m)
{
    float all[3], shade[3];
    if (m->outside && tyni_view_coloured(m->lamp)) {
        memcpy(shade, m->sum, sizeof *shade * (size_t)m->integral->count);
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = 0.0f;
        coloured(m, m->integral->t0, m->integral->t1);
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = tyni_maxf(m->sum[i] - shade[i], 0.0f);
        return;
    }
    if (tyni_view_coloured(m->lamp)) {
        for (int32_t i = 0; i < m->integral->count; i++)
            m->sum[i] = tyni_maxf(m->sum[i], 0.0f); /* differences of rounded sums */
        return;
    }
    tyni_integral_at(m->integral, m->integral->t1, all);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] = tyni_clampf(m->outside ? all[i] - m->sum[i] : m->sum[i], 0.0f, all[i]);
}

/* The end of a ray: shadows as strong as the frame wants them. */
static void lift(tyni_meter *m)
{
    float lit[3];
    if (m->lamp->lift == 0.0f)
        return;
    memcpy(lit, m->sum, sizeof *lit * (size_t)m->integral->count);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] = 0.0f;
    if (tyni_view_coloured(m->lamp))
        coloured(m, m->integral->t0, m->integral->t1);
    else
        tyni_integral_at(m->integral, m->integral->t1, m->sum);
    for (int32_t i = 0; i < m->integral->count; i++)
        m->sum[i] = tyni_maxf(lit[i] + m->lamp->lift * (m->sum[i] - lit[i]), 0.0f);
}

void tyni_meter_end(tyni_meter *m)
{
    settle(m);
    lift(m);
}
