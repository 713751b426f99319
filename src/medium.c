/* medium.c - see medium.h */
#include "medium.h"

#include <math.h>

#include "base.h"
#include "num.h"

void tyni_medium_extinction(const tyn_medium *media, int32_t count, float sigma[3])
{
    for (int32_t c = 0; c < 3; c++) {
        sigma[c] = 0.0f;
        for (int32_t i = 0; i < count; i++)
            sigma[c] += media[i].scatter[c] + media[i].absorb[c];
    }
}

static void choose_channels(tyni_medium *m)
{
    m->low = m->high = 0;
    for (int32_t c = 1; c < 3; c++) {
        if (m->sigma[c] < m->sigma[m->low])
            m->low = c;
        if (m->sigma[c] >= m->sigma[m->high])
            m->high = c;
    }
    m->middle = 3 - m->low - m->high;
    m->blend = m->sigma[m->high] > m->sigma[m->low]
                   ? (m->sigma[m->middle] - m->sigma[m->low]) / (m->sigma[m->high] - m->sigma[m->low])
                   : 0.5f;
}

void tyni_medium_prepare(tyni_medium *m, const tyn_medium *media, int32_t count)
{
    memset(m, 0, sizeof *m);
    tyni_medium_extinction(media, count, m->sigma);
    for (int32_t i = 0; i < count; i++) {
        const tyn_medium *p = &media[i];
        for (int32_t c = 0; c < 3; c++) {
            float scatter = p->scatter[c];
            if (scatter > 0.0f)
                m->scatters = 1;
            if (p->phase == TYN_PHASE_ISOTROPIC)
                m->isotropic[c] += scatter * (0.25f / TYNI_PI);
            else if (p->phase == TYN_PHASE_RAYLEIGH)
                m->rayleigh[c] += scatter * (0.1875f / TYNI_PI);
            else
                m->hg[m->hg_count].scale[c] = scatter * (0.25f / TYNI_PI) * (1.0f - p->g * p->g);
        }
        if (p->phase == TYN_PHASE_HG) {
            m->hg[m->hg_count++].g = p->g;
            if (tyni_absf(p->g) > m->peak)
                m->backward = p->g < 0.0f;
            m->peak = tyni_maxf(m->peak, tyni_absf(p->g));
        }
    }
    choose_channels(m);
}

void tyni_medium_mix(const tyni_medium *m, float cosine, float mix[3])
{
    for (int32_t c = 0; c < 3; c++)
        mix[c] = m->isotropic[c] + m->rayleigh[c] * (1.0f + cosine * cosine);
    for (int32_t i = 0; i < m->hg_count; i++) {
        /* 1 + g^2 - 2 g cos as a sum of two terms >= 0: no cancellation near the peak of a large g */
        float g = m->hg[i].g, d = (1.0f - g) * (1.0f - g) + 2.0f * g * (1.0f - cosine), f;
        d = tyni_maxf(d, 1e-12f);
        f = 1.0f / (d * sqrtf(d));
        for (int32_t c = 0; c < 3; c++)
            mix[c] += m->hg[i].scale[c] * f;
    }
}

void tyni_integral_density(const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float t, float density[3])
{
    tyni_vec3 to = tyni_vec_sub(lamp->position, tyni_sight_at(v, t)); /* from the point to the light */
    float r2 = tyni_maxf(tyni_vec_dot(to, to), lamp->radius * lamp->radius), r = sqrtf(r2);
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        for (int32_t c = 0; c < 3; c++)
            density[c] = tyni_num_exp(-medium->sigma[c] * t);
        return;
    }
    /* light travels along -to, towards the camera is -v */
    tyni_medium_mix(medium, tyni_clampf(tyni_vec_dot(to, v->d) / r, -1.0f, 1.0f), density);
    for (int32_t c = 0; c < 3; c++)
        density[c] *= tyni_num_exp(-medium->sigma[c] * (t + r)) / r2;
}

static void path_begin(tyni_path *p, const tyni_lamp *lamp, const tyni_sight *v, float t0, float t1)
{
    tyni_vec3 to = tyni_vec_sub(lamp->position, v->o), h;
    p->t0 = t0;
    p->t1 = t1;
    p->near_t = tyni_vec_dot(v->d, to);
    p->from = t0 - p->near_t;
    h = tyni_vec_mad(to, -p->near_t, v->d);
    p->h = tyni_maxf(tyni_vec_length(h), lamp->radius);
    p->span = tyni_num_atan2(p->h * (t1 - t0), p->from * (t1 - p->near_t) + p->h * p->h);
}

static float path_t(const tyni_path *p, float psi)
{
    float sine, cosine, d;
    tyni_num_sincos(psi, &sine, &cosine);
    d = p->h * cosine - p->from * sine;
    if (!(d > 0.0f))
        return p->t1;
    return tyni_clampf(p->t0 + sine * (p->from * p->from + p->h * p->h) / d, p->t0, p->t1);
}

/* The integrand per d psi. */
static void path_value(const tyni_path *p, const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float psi,
                       float value[3])
{
    float t = path_t(p, psi), d = t - p->near_t, scale;
    tyni_integral_density(medium, lamp, v, t, value);
    scale = (d * d + p->h * p->h) / p->h;
    for (int32_t c = 0; c < 3; c++)
        value[c] *= scale;
}

/* Simpson intervals: more where the integrand bends, by angle, by depth and by the phase function's peak. */
static int32_t intervals(const tyni_medium *medium, const tyni_path *p)
{
    float a = p->from, b = p->t1 - p->near_t, h2 = p->h * p->h, depth;
    depth = medium->sigma[medium->high] * ((p->t1 - p->t0) + tyni_absf(sqrtf(b * b + h2) - sqrtf(a * a + h2)));
    return tyni_clampi(
        (int32_t)tyni_minf(4.0f + 3.0f * p->span + 2.0f * depth + 4.0f * medium->peak / (1.0f - medium->peak), 64.0f), 4,
        TYNI_MEDIUM_KNOTS - 1);
}

static float power_of(float x, int32_t power)
{
    return power == 1 ? x : power == 2 ? x * x : x * x * x * x;
}

/* psi of a knot coordinate s, and d psi / ds. */
static float warp(const tyni_integral *it, float s, float *slope)
{
    float e = it->reversed ? 1.0f - s : s, span = it->path.span;
    *slope = span * (float)it->power * power_of(e, it->power) / tyni_maxf(e, 1e-9f);
    if (it->power == 1)
        *slope = span;
    return it->reversed ? span * (1.0f - power_of(e, it->power)) : span * power_of(e, it->power);
}

static float unwarp(const tyni_integral *it, float psi)
{
    float r = it->path.span > 0.0f ? tyni_clampf(psi / it->path.span, 0.0f, 1.0f) : 0.0f, e = it->reversed ? 1.0f - r : r;
    if (it->power > 1)
        e = sqrtf(e);
    if (it->power > 2)
        e = sqrtf(e);
    return it->reversed ? 1.0f - e : e;
}

/* The integrand per ds. */
static void knot_value(const tyni_integral *it, const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float s,
                       float value[3])
{
    float slope, psi = warp(it, s, &slope);
    path_value(&it->path, medium, lamp, v, psi, value);
    for (int32_t c = 0; c < 3; c++)
        value[c] *= slope;
}

static void tabulate(tyni_integral *it, const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v)
{
    float last[3], half[3], next[3], step;
    int32_t n;
    path_begin(&it->path, lamp, v, it->t0, it->t1);
    n = intervals(medium, &it->path);
    it->power = medium->peak < 0.8f ? 1 : medium->peak < 0.93f ? 2 : 4;
    it->reversed = medium->backward;
    step = 1.0f / (float)n;
    it->knots = n + 1;
    knot_value(it, medium, lamp, v, 0.0f, last);
    for (int32_t i = 0; i < it->count; i++) {
        it->sum[i][0] = 0.0f;
        it->value[i][0] = last[it->channels[i]] * step;
    }
    for (int32_t k = 1; k <= n; k++) {
        knot_value(it, medium, lamp, v, ((float)k - 0.5f) * step, half);
        knot_value(it, medium, lamp, v, (float)k * step, next);
        for (int32_t i = 0; i < it->count; i++) {
            int32_t c = it->channels[i];
            it->sum[i][k] = it->sum[i][k - 1] + step * (1.0f / 6.0f) * (last[c] + 4.0f * half[c] + next[c]);
            it->value[i][k] = next[c] * step;
        }
        memcpy(last, next, sizeof last);
    }
}

static int is_local(const tyni_integral *it)
{
    return TYNI_HAS(TYN_PART_LAMPS) && it->local;
}

void tyni_integral_begin(tyni_integral *it, const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float t0,
                         float t1, const int32_t *channels, int32_t count)
{
    it->count = count;
    it->t0 = t0;
    it->t1 = t1;
    it->local = tyni_view_kind(lamp) != TYN_LIGHT_DIRECTIONAL;
    for (int32_t i = 0; i < count; i++) {
        it->channels[i] = channels[i];
        it->sigma[i] = medium->sigma[channels[i]];
    }
    if (is_local(it) && t1 > t0)
        tabulate(it, medium, lamp, v);
}

/* Cubic Hermite between knots; s in knots. Slopes are the integrand, so the sum rises. */
static void hermite(const tyni_integral *it, float s, float *out)
{
    int32_t k = tyni_clampi((int32_t)s, 0, it->knots - 2);
    float x = tyni_clampf(s - (float)k, 0.0f, 1.0f), y = 1.0f - x;
    float h1 = x * x * (3.0f - 2.0f * x), d0 = x * y * y, d1 = -x * x * y;
    for (int32_t i = 0; i < it->count; i++) {
        const float *sum = it->sum[i] + k, *value = it->value[i] + k;
        out[i] = sum[0] + (sum[1] - sum[0]) * h1 + value[0] * d0 + value[1] * d1;
    }
}

float tyni_integral_variable(const tyni_integral *it, float t)
{
    const tyni_path *p = &it->path;
    t = tyni_clampf(t, it->t0, it->t1);
    return is_local(it) ? tyni_num_atan2(p->h * (t - p->t0), p->from * (t - p->near_t) + p->h * p->h) : t;
}

float tyni_integral_t(const tyni_integral *it, float variable)
{
    return is_local(it) ? path_t(&it->path, variable) : variable;
}

void tyni_integral_at_variable(const tyni_integral *it, float x, float *out)
{
    if (is_local(it)) {
        hermite(it, unwarp(it, x) * (float)(it->knots - 1), out);
        return;
    }
    for (int32_t i = 0; i < it->count; i++) {
        out[i] = x * tyni_num_fog(it->sigma[i] * x);
        if (it->t0 > 0.0f)
            out[i] -= it->t0 * tyni_num_fog(it->sigma[i] * it->t0);
    }
}

void tyni_integral_at(const tyni_integral *it, float t, float *out)
{
    tyni_integral_at_variable(it, tyni_integral_variable(it, t), out);
}

void tyni_integral_norm(const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float t0, float t1,
                        float norm[3])
{
    /* Gauss and Legendre, four points on 0 .. 1 */
    static const float at[4] = {0.0694318442f, 0.330009478f, 0.669990522f, 0.930568156f};
    static const float weight[4] = {0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f};
    float value[3];
    tyni_path p;
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        for (int32_t c = 0; c < 3; c++)
            norm[c] = t1 * tyni_num_fog(medium->sigma[c] * t1) - t0 * tyni_num_fog(medium->sigma[c] * t0);
        return;
    }
    norm[0] = norm[1] = norm[2] = 0.0f;
    if (!(t1 > t0))
        return;
    path_begin(&p, lamp, v, t0, t1);
    for (int32_t i = 0; i < 4; i++) {
        path_value(&p, medium, lamp, v, p.span * at[i], value);
        for (int32_t c = 0; c < 3; c++)
            norm[c] += p.span * weight[i] * value[c];
    }
}
