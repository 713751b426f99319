/* pixel_kernel.h - a template: a run of pixels at a time, for pixel.c. Planes have room for whole vectors. */

static TYNI_V_TARGET void TYNI_V(pixel_sights)(const tyni_pass *p, const run *r)
{
    const tyni_view *view = &p->view;
    const float py = (float)r->y + 0.5f, far = view->far_depth, most = p->frame->max_distance;
    const tyni_vec3 o = tyni_vec_mad(view->origin, py, view->dy), dx = view->dx, to = p->lamp->to_light;
    for (int32_t i = 0; i < r->count; i += v_n) {
        const v_float px = v_to_float(v_iadd(v_iset(r->x + i), v_index())) + 0.5f;
        v_float x = o.x + px * dx.x, y = o.y + px * dx.y, z = o.z + px * dx.z;
        v_float length = v_set(1.0f), inverse = v_set(1.0f), depth = v_load_n(r->depth + i, r->count - i), reach;
        if (view->orthographic) {
            x = v_set(view->forward.x);
            y = v_set(view->forward.y);
            z = v_set(view->forward.z);
        } else {
            length = v_sqrt(x * x + y * y + z * z);
            inverse = 1.0f / length;
        }
        reach = v_max(v_min(depth, v_set(far)), v_set(0.0f)) * length; /* NaN: far */
        if (most > 0.0f)
            reach = v_min(v_set(most), reach);
        v_store(r->nearness + i, inverse * (1.0f / far));
        v_store(r->reach + i, reach);
        v_store(r->cosine + i, v_max(v_min((x * to.x + y * to.y + z * to.z) * inverse, v_set(1.0f)), v_set(-1.0f)));
    }
}

/* What samples add up to. */
typedef struct TYNI_V(pixel_sum) {
    v_float low, high, weight;
} TYNI_V(pixel_sum);

/* The two lines beside each pixel, `line` and the one after it. Lines rise or fall along the row: `line` = low + place, and
 * place is 0 .. span. */
typedef struct TYNI_V(pixel_lines) {
    v_int line, place;
    int32_t low, span;
    v_float f;           /* the way to the next line */
    v_float scale[2][2]; /* of the line, and low or high */
} TYNI_V(pixel_lines);

/* k: line and the way to the next one of pixels, n of them. first: of the sector's lines, last: the last but one. */
TYNI_V_INLINE void TYNI_V(pixel_between_lines)(const tyni_field *field, const float *k, int32_t n, int32_t first, int32_t last,
                                               TYNI_V(pixel_lines) * l)
{
    const int32_t a = tyni_mini((int32_t)k[0], last), b = tyni_mini((int32_t)k[tyni_mini(n, v_n) - 1], last);
    const v_float at = v_load_n(k, n);
    v_int line = v_imin(v_trunc(at), v_iset(last));
    if (n < v_n)
        line = v_iselect(v_first(n), line, v_iset(a));
    l->f = at - v_to_float(line);
    l->low = tyni_mini(a, b) + first;
    l->span = tyni_maxi(a, b) + first - l->low;
    l->line = v_iadd(line, v_iset(first));
    l->place = v_isub(l->line, v_iset(l->low));
    TYNI_UNROLL
    for (int32_t i = 0; i < 4; i++) {
        if (l->span < v_n)
            l->scale[i >> 1][i & 1] = v_pick(field->scales[i & 1] + l->low + (i >> 1), l->place);
        else
            l->scale[i >> 1][i & 1] = v_gather(field->scales[i & 1] + (i >> 1), l->line);
    }
}

/* Entries of both lines where lines run along y: all at the sample of this row of the tile. */
TYNI_V_INLINE void TYNI_V(pixel_down)(const tile *t, int32_t sample, const TYNI_V(pixel_lines) * l, v_int out[2])
{
    const uint32_t *row = t->row[sample - t->sample] + (l->low - t->low);
    TYNI_UNROLL
    for (int32_t side = 0; side < 2; side++)
        out[side] = v_ipick(row + side, l->place);
}

/* The same where lines run along x and the lanes' samples lie side by side, from `base` on: line after line is read whole. Four
 * at a time, so that the number of rounds is mostly foreseen; `last`: the field's. */
TYNI_V_INLINE void TYNI_V(pixel_along)(const tyni_field *f, const TYNI_V(pixel_lines) * l, int32_t last, v_int sample,
                                       int32_t base, v_int out[2])
{
    const uint32_t *entries = f->entries + (ptrdiff_t)l->low * f->pitch + base;
    const v_int at = v_isub(sample, v_iset(base));
    v_int one = v_ipick(entries, at);
    out[0] = out[1] = one;
    for (int32_t k = 0; k <= l->span; k += 4) {
        TYNI_UNROLL
        for (int32_t j = 0; j < 4; j++) {
            const v_mask here = v_ieq(l->place, v_iset(k + j));
            entries += l->low + k + j < last ? f->pitch : 0;
            out[0] = v_iselect(here, one, out[0]);
            one = v_ipick(entries, at);
            out[1] = v_iselect(here, one, out[1]);
        }
    }
}

/* The same wherever they lie. */
TYNI_V_INLINE void TYNI_V(pixel_anywhere)(const tyni_field *f, const TYNI_V(pixel_lines) * l, v_int sample, v_int out[2])
{
    const v_int at = v_shl(v_iadd(v_imul(l->line, v_iset(f->pitch)), sample), 2);
    TYNI_UNROLL
    for (int32_t side = 0; side < 2; side++)
        out[side] = v_igather(f->entries + (ptrdiff_t)side * f->pitch, at);
}

/* A sample of each pixel's two lines: tap() of gather.c. `at`: the pixel's depth, not below the nearest that is told apart;
 * `share`: of the lines in the pixel. */
TYNI_V_INLINE void TYNI_V(pixel_taps)(TYNI_V(pixel_sum) * s, const tyni_field *f, const v_int entry[2],
                                      const TYNI_V(pixel_lines) * l, v_float at, const v_float share[2])
{
    const v_int ten = v_iset(1023);
    v_float off[2], limit[2], weight[2];
    TYNI_UNROLL
    for (int32_t side = 0; side < 2; side++) {
        const v_int code = v_shr(entry[side], 20);
        const v_float other =
            v_from_bits(v_iadd(v_shl(v_isub(code, v_iset(1)), 15), v_iset((int32_t)TYNI_ENTRY_FLOOR + 0x4000)));
        off[side] = v_abs(at - other);
        limit[side] = f->threshold * v_min(at, other);
        weight[side] = v_select(v_ieq(code, v_iset(0)), v_set(0.0f), share[side]);
    }
    if (!v_all(v_mand(v_le(off[0], limit[0]), v_le(off[1], limit[1])))) {
        /* (limit / off)^4, at most 1 */
        TYNI_UNROLL
        for (int32_t side = 0; side < 2; side++) {
            const v_float ratio = limit[side] / v_max(off[side], limit[side]), square = ratio * ratio;
            weight[side] = weight[side] * (square * square);
        }
    }
    TYNI_UNROLL
    for (int32_t side = 0; side < 2; side++) {
        const v_float low = v_to_float(v_iand(entry[side], ten));
        const v_float high = v_to_float(v_iand(v_shr(entry[side], 10), ten));
        s->weight = s->weight + weight[side];
        s->low = s->low + weight[side] * (low * low * l->scale[side][0]);
        s->high = s->high + weight[side] * (high * high * l->scale[side][1]);
    }
}

/* Lines that are worth reading one after the other, rather than each lane's own. */
#define FEW (v_n < 8 ? 0 : v_n)

/* Asks for the entries of lines along x that pixels first .. end - 1 need in this row, their places known, and in the rows of
 * the band below: they lie far apart in memory, and one by one each would be waited for. */
TYNI_V_INLINE void TYNI_V(pixel_call)(const tyni_pass *p, const run *r, const tyni_sector *sector, int32_t first, int32_t end)
{
    const tyni_slices *g = &p->slices;
    const float most = (float)(sector->count - 1), rows = (float)TYNI_PIXEL_BAND / sector->spacing;
    for (int32_t i = first; i < end; i += 16) {
        const int32_t last = tyni_mini(i + 16, end) - 1;
        const float px = (float)(r->x + i) + 0.5f, a = r->value[0][i], b = r->value[0][last];
        const float fall = rows * (1.0f + g->ew * (sector->border - px) / (px * g->ew - g->ex));
        const int32_t low = (int32_t)tyni_clampf(tyni_minf(a, b) + tyni_minf(fall, 0.0f), 0.0f, most);
        const int32_t high = (int32_t)tyni_clampf(tyni_maxf(a, b) + tyni_maxf(fall, 0.0f) + 1.0f, 0.0f, most);
        const uint32_t *entries = p->lines.entries + (r->x + last) / g->stride;
        for (int32_t line = low; line <= tyni_mini(high, low + 31); line++)
            TYNI_PREFETCH(entries + (ptrdiff_t)(sector->start + line) * p->lines.pitch);
    }
}

/* The slice coordinate, 0 .. count - 1, of pixels first .. end - 1 of the run, all in one sector of the shear grid: into
 * value[0]. In a round of its own, so that how many lines a vector needs is known long before its turn. */
static TYNI_V_TARGET void TYNI_V(pixel_places)(const tyni_pass *p, const run *r, const tyni_sector *sector, int32_t first,
                                               int32_t end)
{
    const tyni_slices *g = &p->slices;
    const float py = (float)r->y + 0.5f, dy = py * g->ew - g->ey, inverse = 1.0f / sector->spacing;
    const float slant = (sector->border - py) / dy;
    for (int32_t i = first; i < end; i += v_n) {
        const v_float px = v_to_float(v_iadd(v_iset(r->x + i), v_index())) + 0.5f, dx = px * g->ew - g->ex;
        v_float k;
        if (sector->along_y)
            k = px + dx * slant;
        else
            k = py + dy * (sector->border - px) / dx;
        k = v_clamp((k - sector->first) * inverse, v_set(0.0f), v_set((float)(sector->count - 1)));
        v_store_n(r->value[0] + i, k, end - i);
    }
    if (v_n > 1 && !sector->along_y && r->y % TYNI_PIXEL_BAND == 0)
        TYNI_V(pixel_call)(p, r, sector, first, end);
}

/* From there visibility of these pixels. t: entries of the sector's lines along y, or NULL. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_unwarp)(const tyni_pass *p, const run *r, const tyni_sector *sector,
                                                             const tile *t, int32_t first, int32_t end)
{
    const tyni_field field = p->lines; /* copies are none of what is written */
    const run own = *r;
    const int32_t along_y = sector->along_y, start = sector->start, count = sector->count, most = field.pitch - 1;
    const int32_t stride = p->slices.stride, edge = p->slices.width - 1;
    const float step = 1.0f / (float)stride;
    int32_t shift = 0;
    while (1 << shift < stride)
        shift++;
    for (int32_t i = first; i < end; i += v_n) {
        const int32_t n = end - i, place = along_y ? own.y : own.x + i, base = place >> shift;
        /* a second sample where there are pixels between two */
        const int32_t samples = (along_y || v_n == 1 ? place & (stride - 1) : shift) ? 2 : 1;
        const v_float to = v_load_n(own.to + i, n);
        const v_float at = v_max(to * v_load_n(own.nearness + i, n), v_set(TYNI_ENTRY_NEAREST));
        const v_mask wanted = v_mand(v_first(n), v_gt(to, v_set(0.0f)));
        const v_int part = along_y ? v_iset(place) : v_imin(v_iadd(v_iset(place), v_index()), v_iset(edge));
        v_int sample = v_shr(part, shift), entry[2];
        TYNI_V(pixel_lines) l;
        TYNI_V(pixel_sum) s = {v_set(0.0f), v_set(0.0f), v_set(0.0f)};
        v_mask fits;
        int in_tile, side_by_side;
        TYNI_V(pixel_between_lines)(&field, own.value[0] + i, n, start, count - 2, &l);
        in_tile = t && l.span < v_n && l.low >= t->low && l.low + l.span + 1 < t->low + t->count;
        side_by_side = !along_y && l.span < FEW && base + v_n <= field.pitch;
        for (int32_t next = 0; next < samples; next++) {
            v_float share[2];
            share[0] = 1.0f - l.f;
            share[1] = l.f;
            if (samples > 1) {
                v_float along = v_to_float(v_iand(part, v_iset(stride - 1))) * step;
                if (!next)
                    along = 1.0f - along;
                share[0] = share[0] * along;
                share[1] = share[1] * along;
                sample = v_imin(v_iadd(sample, v_iset(next)), v_iset(most));
            }
            if (in_tile)
                TYNI_V(pixel_down)(t, tyni_mini(base + next, most), &l, entry);
            else if (side_by_side)
                TYNI_V(pixel_along)(&field, &l, p->slices.count - 1, sample, base, entry);
            else
                TYNI_V(pixel_anywhere)(&field, &l, sample, entry);
            TYNI_V(pixel_taps)(&s, &field, entry, &l, at, share);
        }
        fits = v_mand(wanted, v_gt(s.weight, v_set(TYNI_GATHER_ENOUGH)));
        s.weight = 1.0f / (s.weight * (1023.0f * 1023.0f));
        v_store_n(own.value[0] + i, v_select(fits, s.low * s.weight, v_set(0.0f)), n);
        v_store_n(own.value[1] + i, v_select(fits, s.high * s.weight, v_set(0.0f)), n);
        for (uint32_t bits = v_word(v_mandnot(wanted, fits)); bits; bits &= bits - 1) {
            const int32_t j = i + tyni_ctz32(bits);
            own.rejected[j >> 5] |= 1u << (j & 31);
        }
    }
}

/* Visibility of the third channel. It falls about exponentially with extinction where the near air is in shadow: a^(1 - blend)
 * b^blend, by Pade's quotient (within 1 % where a and b differ by a factor of four). */
TYNI_V_INLINE v_float TYNI_V(pixel_between)(v_float a, v_float b, float blend)
{
    const float more = (2.0f + blend) * (1.0f + blend), less = (2.0f - blend) * (1.0f - blend);
    const float even = 2.0f * (4.0f - blend * blend);
    const v_float aa = a * a, bb = b * b, ab = even * (a * b);
    return a * (more * bb + ab + less * aa) / v_max(less * bb + ab + more * aa, v_set(1e-20f));
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
    static const int32_t bit[16] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
    const v_int all = v_iset((int32_t)(words[i >> 5] >> (i & 31) & 0xffffu));
    return v_igt(v_iand(all, v_iload(bit)), v_iset(0));
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
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_shade)(const tyni_pass *p, const run *r)
{
    const tyni_medium m = p->medium; /* copies are none of what is written */
    const run own = *r;
    const int32_t count = p->count;
    const int bounded = tyni_view_bounded(p->lamp);
    float inverse[3], colour[3];
    for (int32_t c = 0; c < 3; c++) {
        inverse[c] = m.sigma[c] > SIGMA_LEAST ? 1.0f / m.sigma[c] : 0.0f;
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
static TYNI_V_TARGET void TYNI_V(pixel_share)(const tyni_pass *p, const run *r)
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
