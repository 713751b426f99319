/* pixel_kernel.h - a template: a run of pixels at a time, for pixel.c. Planes have room for whole vectors. */

static TYNI_V_TARGET void TYNI_V(pixel_sights)(const tyni_pass *p, const run *r)
{
    const tyni_view *view = &p->view;
    const float py = (float)r->y + 0.5f, far = view->far_depth, most = p->frame->max_distance;
    const tyni_vec3 o = view->origin, dx = view->dx, dy = view->dy, to = p->lamp->to_light;
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float px = v_to_float(v_iadd(v_iset(r->x + i), v_index())) + 0.5f;
        v_float x = (o.x + px * dx.x) + py * dy.x, y = (o.y + px * dx.y) + py * dy.y, z = (o.z + px * dx.z) + py * dy.z;
        v_float length = v_set(1.0f), depth = v_load_n(r->depth + i, r->count - i), reach;
        if (view->orthographic) {
            x = v_set(view->forward.x);
            y = v_set(view->forward.y);
            z = v_set(view->forward.z);
        } else {
            length = v_sqrt(x * x + y * y + z * z);
        }
        depth = v_select(v_lt(depth, v_set(far)), depth, v_set(far));
        depth = v_select(v_gt(depth, v_set(0.0f)), depth, v_set(0.0f));
        reach = depth * length;
        if (most > 0.0f)
            reach = v_min(v_set(most), reach);
        v_store(r->length + i, length);
        v_store(r->reach + i, reach);
        v_store(r->cosine + i, v_clamp((x * to.x + y * to.y + z * to.z) / length, v_set(-1.0f), v_set(1.0f)));
    }
}

/* What samples add up to. */
typedef struct TYNI_V(pixel_sum) {
    v_float low, high, weight;
} TYNI_V(pixel_sum);

/* The two lines beside each pixel, line and line + 1, and their scales. */
typedef struct TYNI_V(pixel_lines) {
    v_int line;
    v_float scale[2][2]; /* of the line, and low or high */
} TYNI_V(pixel_lines);

/* Lines rise or fall along the row, so that mostly a vector of scales, from the lower of the outer lanes on, holds all. */
TYNI_V_INLINE void TYNI_V(pixel_scales)(TYNI_V(pixel_lines) * l, const tyni_field *f, v_int line)
{
    int32_t all[v_n], low, near;
    v_int place;
    v_istore(all, line);
    low = tyni_mini(all[0], all[v_n - 1]);
    place = v_isub(line, v_iset(low));
    near = v_none(v_mor(v_ilt(place, v_iset(0)), v_igt(place, v_iset(v_n - 1))));
    l->line = line;
    for (int32_t k = 0; k < 2; k++)
        for (int32_t side = 0; side < 2; side++) {
            if (near)
                l->scale[side][k] = v_pick(f->scales[k] + low + side, place);
            else
                l->scale[side][k] = v_gather(f->scales[k] + side, line);
        }
}

/* A sample of each pixel's line, or of the one beside it: tap() of gather.c. `at`: the pixel's depth, not below the nearest
 * that is told apart. */
TYNI_V_INLINE void TYNI_V(pixel_tap)(TYNI_V(pixel_sum) * s, const tyni_field *f, const TYNI_V(pixel_lines) * l, int32_t side,
                                     v_int sample, v_float at, v_float weight)
{
    const uint32_t *entries = f->entries + (ptrdiff_t)side * f->pitch;
    const v_int entry = v_igather(entries, v_shl(v_iadd(v_imul(l->line, v_iset(f->pitch)), sample), 2));
    const v_int code = v_shr(entry, 20), ten = v_iset(1023);
    const v_float other = v_from_bits(v_iadd(v_shl(v_isub(code, v_iset(1)), 15), v_iset((int32_t)TYNI_ENTRY_FLOOR + 0x4000)));
    const v_float off = v_abs(at - other), limit = f->threshold * v_min(at, other);
    const v_float low = v_to_float(v_iand(entry, ten)) * (1.0f / 1023.0f);
    const v_float high = v_to_float(v_iand(v_shr(entry, 10), ten)) * (1.0f / 1023.0f);
    const v_mask same = v_le(off, limit);
    v_float ratio = v_set(1.0f);
    if (!v_all(same)) {
        ratio = limit / off;
        ratio = ratio * ratio;
        ratio = v_select(same, v_set(1.0f), ratio * ratio);
    }
    weight = v_select(v_ieq(code, v_iset(0)), v_set(0.0f), weight * ratio);
    s->weight = s->weight + weight;
    s->low = s->low + weight * (low * low * l->scale[side][0]);
    s->high = s->high + weight * (high * high * l->scale[side][1]);
}

/* Pixels first .. end - 1 of the run, all in one sector of the shear grid. */
static TYNI_V_TARGET void TYNI_V(pixel_unwarp)(const tyni_pass *p, const run *r, const tyni_sector *sector, int32_t first,
                                               int32_t end)
{
    const tyni_slices *g = &p->slices;
    const float py = (float)r->y + 0.5f, dy = py * g->ew - g->ey, inverse = 1.0f / sector->spacing;
    const float slant = (sector->border - py) / dy;
    const int32_t last = sector->count - 2, most = p->lines.pitch - 1;
    const int sun = tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_bounded(p->lamp);
    const int32_t beside = sun ? BESIDE : 0;
    int32_t shift = 0;
    if (sector->count < 2)
        return; /* no slices at all */
    while (1 << shift < g->stride)
        shift++;
    for (int32_t i = first; i < end; i += v_n) {
        const int32_t n = end - i;
        const v_int x = v_iadd(v_iset(r->x + i), v_index());
        const v_float px = v_to_float(x) + 0.5f, dx = px * g->ew - g->ex, to = v_load_n(r->to + i, n);
        v_float at = to / (v_load_n(r->length + i, n) * p->view.far_depth), k, f, along;
        v_int line, sample, part;
        TYNI_V(pixel_lines) l;
        TYNI_V(pixel_sum) s = {v_set(0.0f), v_set(0.0f), v_set(0.0f)};
        v_mask wanted = v_mand(v_first(n), v_gt(to, v_set(0.0f))), fits;
        if (v_none(wanted))
            continue;
        at = v_max(at, v_set(TYNI_ENTRY_NEAREST));
        if (sector->along_y)
            k = px + dx * slant;
        else
            k = py + dy * (sector->border - px) / dx;
        k = v_clamp((k - sector->first) * inverse, v_set(0.0f), v_set((float)(sector->count - 1)));
        line = v_imin(v_trunc(k), v_iset(last));
        f = k - v_to_float(line);
        TYNI_V(pixel_scales)(&l, &p->lines, v_iadd(line, v_iset(sector->start)));
        part = sector->along_y ? v_iset(r->y) : v_imin(x, v_iset(g->width - 1));
        sample = v_shr(part, shift);
        if (!shift) {
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 0, sample, at, 1.0f - f);
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 1, sample, at, f);
        } else {
            const v_int next = v_imin(v_iadd(sample, v_iset(1)), v_iset(most));
            along = v_to_float(v_iand(part, v_iset(g->stride - 1))) * (1.0f / (float)g->stride);
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 0, sample, at, (1.0f - f) * (1.0f - along));
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 1, sample, at, f * (1.0f - along));
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 0, next, at, (1.0f - f) * along);
            TYNI_V(pixel_tap)(&s, &p->lines, &l, 1, next, at, f * along);
        }
        fits = v_mand(wanted, v_gt(s.weight, v_set(TYNI_GATHER_ENOUGH)));
        /* where neither line has the pixel's surface at its place, it may have it next door, as ED10's taps look for it */
        for (int32_t away = 1; away <= beside && v_any(v_mandnot(wanted, fits)); away++) {
            TYNI_V(pixel_sum) more = {v_set(0.0f), v_set(0.0f), v_set(0.0f)};
            const v_mask lost = v_mandnot(wanted, fits);
            for (int32_t way = -away; way <= away; way += 2 * away) {
                const v_int next = v_imin(v_imax(v_iadd(sample, v_iset(way)), v_iset(0)), v_iset(most));
                TYNI_V(pixel_tap)(&more, &p->lines, &l, 0, next, at, 1.0f - f);
                TYNI_V(pixel_tap)(&more, &p->lines, &l, 1, next, at, f);
            }
            s.weight = v_select(lost, more.weight, s.weight);
            s.low = v_select(lost, more.low, s.low);
            s.high = v_select(lost, more.high, s.high);
            fits = v_mand(wanted, v_gt(s.weight, v_set(TYNI_GATHER_ENOUGH)));
        }
        s.weight = 1.0f / s.weight;
        v_store_n(r->value[0] + i, v_select(fits, s.low * s.weight, v_set(0.0f)), n);
        v_store_n(r->value[1] + i, v_select(fits, s.high * s.weight, v_set(0.0f)), n);
        for (uint32_t bits = v_word(v_mandnot(wanted, fits)); bits; bits &= bits - 1) {
            const int32_t j = i + tyni_ctz32(bits);
            r->rejected[j >> 5] |= 1u << (j & 31);
        }
    }
}

/* Visibility of the third channel. It falls about exponentially with extinction where the near air is in shadow. */
TYNI_V_INLINE v_float TYNI_V(pixel_between)(v_float a, v_float b, float blend)
{
    const v_float least = v_min(a, b), straight = a + (b - a) * blend;
    const v_mask near = v_mor(v_le(least, v_set(0.0f)), v_le(v_abs(a - b), 0.1f * least));
    if (v_all(near))
        return straight;
    return v_select(near, straight, a * v_exp(blend * v_log(b / a)));
}

/* Visibility of the three channels at pixels i .. i + v_n - 1: as lines hold it, or the third from the other two. */
TYNI_V_INLINE void TYNI_V(pixel_channels)(const tyni_pass *p, const run *r, int32_t i, v_float value[3])
{
    const tyni_medium *m = &p->medium;
    for (int32_t c = 0; c < 3; c++)
        value[c] = v_load(r->value[c] + i);
    if (p->count != 3) {
        const v_float low = value[0], high = value[1];
        value[m->low] = low;
        value[m->high] = high;
        value[m->middle] = TYNI_V(pixel_between)(low, high, m->blend);
    }
}

/* Bits i .. i + v_n - 1, i a multiple of v_n, as a mask. */
TYNI_V_INLINE v_mask TYNI_V(pixel_bits)(const uint32_t *words, int32_t i)
{
    static const int32_t bit[16] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
    const v_int all = v_iset((int32_t)(words[i >> 5] >> (i & 31) & 0xffffu));
    return v_igt(v_iand(all, v_iload(bit)), v_iset(0));
}

/* Visibility times the light of the sun that would be there without shadows. The phase function comes in here, last: it varies
 * fast near the epipole (IVB section 6.8). */
static TYNI_V_TARGET void TYNI_V(pixel_shade)(const tyni_pass *p, const run *r)
{
    const tyni_medium *m = &p->medium;
    const float *colour = p->lamp->colour;
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float from = v_load(r->from + i), to = v_load(r->to + i);
        const v_mask wanted = v_mandnot(v_gt(to, v_set(0.0f)), TYNI_V(pixel_bits)(r->rejected, i));
        v_float mix[3], light[3];
        if (v_none(wanted))
            continue;
        TYNI_V(medium_mix)(m, v_load(r->cosine + i), mix);
        TYNI_V(pixel_channels)(p, r, i, light);
        for (int32_t c = 0; c < 3; c++) {
            v_float norm = to * v_fog(m->sigma[c] * to);
            if (tyni_view_bounded(p->lamp))
                norm = norm - from * v_fog(m->sigma[c] * from);
            v_store(r->light[c] + i,
                    v_load(r->light[c] + i) + v_select(wanted, light[c] * norm * (mix[c] * colour[c]), v_set(0.0f)));
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
    for (int32_t c = 0; c < 3; c++)
        p->norm[c] = v_select(v_gt(p->t1, p->t0), p->norm[c], v_set(0.0f));
}

/* The same for the light of a lamp at a point; tyni_prefilter_light where lines hold visibility of that. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_shade_local)(const tyni_pass *p, const run *r)
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
            for (int32_t c = 0; c < 3; c++)
                all.norm[c] = all.norm[c] + rest.norm[c];
        }
        TYNI_V(pixel_channels)(p, r, i, light);
        for (int32_t c = 0; c < 3; c++) {
            v_store(r->light[c] + i,
                    v_load(r->light[c] + i) + v_select(wanted, light[c] * all.norm[c] * p->lamp->colour[c], v_set(0.0f)));
        }
    }
}

/* e^(-extinction s) */
static TYNI_V_TARGET void TYNI_V(pixel_share)(const tyni_pass *p, const run *r, float *const share[3])
{
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float s = v_load(r->reach + i);
        for (int32_t c = 0; c < 3; c++)
            v_store(share[c] + i, v_exp(-p->fog[c] * s));
    }
}

static TYNI_V_TARGET void TYNI_V(pixel_blend)(const run *r, float *const colour[3], float *const share[3])
{
    for (int32_t c = 0; c < 3; c++)
        for (int32_t i = 0; i < r->count; i += v_n)
            v_store(colour[c] + i, v_load(share[c] + i) * v_load(colour[c] + i) + v_load(r->light[c] + i));
}
