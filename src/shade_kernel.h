/* shade_kernel.h - a template: from visibility to light and to the picture, for pixel.c. Planes have room for whole vectors. */

/* Visibility of the third channel: the mean of the two with the exponent 1/2, as quads have it. It is e^(-extinction s)
 * averaged over what is lit of the ray, by the same over all of it. Where little is lit the mean is nearly geometric, but what
 * is lit spreads less than the whole ray, and so the third is brighter than that. */
TYNI_V_INLINE v_float TYNI_V(pixel_between)(v_float a, v_float b, float blend)
{
    const float rest = 1.0f - blend;
    return (rest * rest * a + blend * blend * b) + 2.0f * rest * blend * v_sqrt(a * b);
}

/* Visibility of the three channels at pixels i .. i + v_n - 1: as lines hold it, or the third from the other two. count: of the
 * channels that are held. */
TYNI_V_INLINE void TYNI_V(pixel_channels)(const tyni_medium *m, int32_t count, float *const held[3], int32_t i,
                                          v_float value[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        value[c] = v_load(held[c] + i);
    if (count != 3) {
        const v_float low = value[0], high = value[1];
        value[m->low] = low;
        value[m->high] = high;
        value[m->middle] = TYNI_V(pixel_between)(low, high, m->blend);
    }
}

/* Bits i .. i + v_n - 1, i a multiple of v_n, as a mask. */
TYNI_V_INLINE v_mask TYNI_V(pixel_bits)(const uint32_t *words, int32_t i)
{
    return v_unword(words[i >> 5] >> (i & 31));
}

/* What of the light that is scattered into rays from `from` to `to` arrives, per what is scattered a metre; and what is left of
 * light from `to`. 1 / extinction is 0 for none. */
TYNI_V_INLINE v_float TYNI_V(pixel_arrives)(float sigma, float inverse, v_float from, v_float to, int bounded, v_float *left)
{
    v_float lost, before, none;
    v_fade(sigma * to, left, &lost);
    if (bounded) {
        v_fade(sigma * from, &none, &before);
        lost = lost - before;
        to = to - from;
    }
    if (inverse > 0.0f)
        to = lost * inverse;
    return to;
}

/* Visibility times the light of the sun that would be there without shadows. The phase function comes in here, last: it varies
 * fast near the epipole (IVB section 6.8). What is lost on the way is what surfaces lose, where the run says so: `shared`. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_shade)(const tyni_pass *p, const tyni_run *r)
{
    const tyni_medium m = p->medium; /* copies are none of what is written */
    const tyni_run own = *r;
    const int32_t count = p->count;
    const int bounded = tyni_view_bounded(p->lamp);
    float inverse[3], colour[3];
    for (int32_t c = 0; c < 3; c++) {
        inverse[c] = m.sigma[c] > TYNI_SIGMA_LEAST ? 1.0f / m.sigma[c] : 0.0f;
        colour[c] = p->lamp->colour[c];
    }
    for (int32_t i = 0; i < own.count; i += v_n) {
        const v_float from = v_load(own.from + i), to = v_load(own.to + i);
        const v_mask wanted = v_mandnot(v_gt(to, v_set(0.0f)), TYNI_V(pixel_bits)(own.rejected, i));
        v_float mix[3], value[3];
        if (v_none(wanted) && !own.shared)
            continue;
        TYNI_V(medium_mix)(&m, v_load(own.cosine + i), mix);
        TYNI_V(pixel_channels)(&m, count, own.value, i, value);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++) {
            v_float left, norm = TYNI_V(pixel_arrives)(m.sigma[c], inverse[c], from, to, bounded, &left);
            if (own.shared)
                v_store(own.share[c] + i, left);
            norm = v_select(wanted, value[c] * norm * (mix[c] * colour[c]), v_set(0.0f));
            v_store(own.light[c] + i, v_load(own.light[c] + i) + norm);
        }
    }
}

typedef struct TYNI_V(pixel_rays) {
    v_float ox, oy, oz, dx, dy, dz; /* tyni_view_sight */
    v_float to[3], near_t;          /* from o to the light; where the ray is nearest to it */
} TYNI_V(pixel_rays);

TYNI_V_INLINE void TYNI_V(pixel_rays_at)(const tyni_view *v, tyni_vec3 light, v_float px, float py, TYNI_V(pixel_rays) * r)
{
    const v_float x = (v->origin.x + px * v->dx.x) + py * v->dy.x, y = (v->origin.y + px * v->dx.y) + py * v->dy.y;
    const v_float z = (v->origin.z + px * v->dx.z) + py * v->dy.z;
    if (v->orthographic) {
        r->ox = x;
        r->oy = y;
        r->oz = z;
        r->dx = v_set(v->forward.x);
        r->dy = v_set(v->forward.y);
        r->dz = v_set(v->forward.z);
    } else {
        const v_float scale = 1.0f / v_sqrt(x * x + y * y + z * z);
        r->ox = r->oy = r->oz = v_set(0.0f);
        r->dx = x * scale;
        r->dy = y * scale;
        r->dz = z * scale;
    }
    r->to[0] = light.x - r->ox;
    r->to[1] = light.y - r->oy;
    r->to[2] = light.z - r->oz;
    r->near_t = r->dx * r->to[0] + r->dy * r->to[1] + r->dz * r->to[2];
}

/* tyni_integral_norm of rays from t0 to t1, in its steps: what is changed there must be changed here. */
typedef struct TYNI_V(pixel_part) {
    v_float t0, t1, from, h, span, norm[3];
} TYNI_V(pixel_part);

/* A point of Gauss and Legendre's. A function: in a loop all its constants would want a place on the stack. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_norm_point)(const tyni_medium *m, const tyni_lamp *lamp,
                                                                 const TYNI_V(pixel_rays) * r, TYNI_V(pixel_part) * p, float at,
                                                                 float weight)
{
    v_float sine, cosine, d, t, x, y, z, r2, far, scale, mix[3];
    v_sincos(p->span * at, &sine, &cosine);
    d = p->h * cosine - p->from * sine;
    t = v_clamp(p->t0 + sine * (p->from * p->from + p->h * p->h) / d, p->t0, p->t1);
    t = v_select(v_gt(d, v_set(0.0f)), t, p->t1);
    x = lamp->position.x - (r->ox + t * r->dx);
    y = lamp->position.y - (r->oy + t * r->dy);
    z = lamp->position.z - (r->oz + t * r->dz);
    r2 = v_max(x * x + y * y + z * z, v_set(lamp->radius * lamp->radius));
    far = v_sqrt(r2);
    TYNI_V(medium_mix)(m, v_clamp((x * r->dx + y * r->dy + z * r->dz) / far, v_set(-1.0f), v_set(1.0f)), mix);
    d = t - r->near_t;
    scale = (d * d + p->h * p->h) / p->h;
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        const v_float value = mix[c] * (v_exp(-m->sigma[c] * (t + far)) / r2) * scale;
        p->norm[c] = p->norm[c] + p->span * weight * value;
    }
}

static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_norm)(const tyni_medium *m, const tyni_lamp *lamp,
                                                           const TYNI_V(pixel_rays) * r, TYNI_V(pixel_part) * p)
{
    static const float at[4] = {0.0694318442f, 0.330009478f, 0.669990522f, 0.930568156f};
    static const float weight[4] = {0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f};
    const v_float hx = r->to[0] + -r->near_t * r->dx, hy = r->to[1] + -r->near_t * r->dy, hz = r->to[2] + -r->near_t * r->dz;
    p->from = p->t0 - r->near_t;
    p->h = v_max(v_sqrt(hx * hx + hy * hy + hz * hz), v_set(lamp->radius));
    p->span = v_atan2(p->h * (p->t1 - p->t0), p->from * (p->t1 - r->near_t) + p->h * p->h);
    p->norm[0] = p->norm[1] = p->norm[2] = v_set(0.0f);
    for (int32_t i = 0; i < 4; i++)
        TYNI_V(pixel_norm_point)(m, lamp, r, p, at[i], weight[i]);
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        p->norm[c] = v_select(v_gt(p->t1, p->t0), p->norm[c], v_set(0.0f));
}

/* The same for the light of a lamp at a point; tyni_prefilter_light where lines hold visibility of that. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_shade_local)(const tyni_pass *p, const tyni_run *r)
{
    const tyni_medium *m = &p->medium;
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float t0 = v_load(r->from + i), t1 = v_load(r->to + i);
        const v_mask wanted =
            v_mand(v_first(r->count - i), v_mandnot(v_gt(t1, v_set(0.0f)), TYNI_V(pixel_bits)(r->rejected, i)));
        v_float light[3];
        TYNI_V(pixel_part) all, rest;
        TYNI_V(pixel_rays) rays;
        if (v_none(wanted))
            continue;
        TYNI_V(pixel_rays_at)
        (&p->view, p->lamp->position, v_to_float(v_iadd(v_iset(r->x + i), v_index())) + 0.5f, (float)r->y + 0.5f, &rays);
        all.t0 = t0;
        all.t1 = t1;
        if (tyni_prefilter_kept(p->method))
            all.t1 = v_select(v_mand(v_gt(rays.near_t, t0), v_lt(rays.near_t, t1)), rays.near_t, 0.5f * (t0 + t1));
        TYNI_V(pixel_norm)(m, p->lamp, &rays, &all);
        if (tyni_prefilter_kept(p->method)) {
            rest.t0 = all.t1;
            rest.t1 = t1;
            TYNI_V(pixel_norm)(m, p->lamp, &rays, &rest);
            TYNI_UNROLL
            for (int32_t c = 0; c < 3; c++)
                all.norm[c] = all.norm[c] + rest.norm[c];
        }
        TYNI_V(pixel_channels)(m, p->count, r->value, i, light);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++) {
            v_store(r->light[c] + i,
                    v_load(r->light[c] + i) + v_select(wanted, light[c] * all.norm[c] * p->lamp->colour[c], v_set(0.0f)));
        }
    }
}

/* e^(-extinction s) */
static TYNI_V_TARGET void TYNI_V(pixel_share)(const tyni_pass *p, const tyni_run *r)
{
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float s = v_load(r->reach + i);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++) {
            v_float left, lost;
            v_fade(p->fog[c] * s, &left, &lost);
            v_store(r->share[c] + i, left);
        }
    }
}
