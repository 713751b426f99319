/* ray_kernel.h - a template: rays side by side, for ray.c. */

/* find by compares, 64 columns at a time. Blocks without a change are passed over 32 at a time. */
TYNI_V_INLINE int32_t TYNI_V(ray_find)(const arrays *a, int32_t first, int32_t *next, int32_t end, uint32_t position,
                                       int outside, uint16_t *edges)
{
    const uint16_t *threshold = a->threshold, *edge = a->edge;
    const int32_t start = first + *next, last = first + end;
    const uint64_t behind = ~(uint64_t)1 << (start & 63);
    int32_t n = (position < threshold[start]) != outside;
    if (v_n == 1)
        return find_columns(a, first, next, end, position, outside, edges);
    edges[0] = edge[start];
    for (int32_t w = start >> 6; w <= last >> 6; w += 32) {
        uint32_t mixed = v_above16(a->high + w, position) & ~v_above16(a->low + w, position);
        if ((last >> 6) - w < 31)
            mixed &= ((uint32_t)2 << ((last >> 6) - w)) - 1;
        for (; mixed; mixed &= mixed - 1) {
            const int32_t i = 64 * (w + tyni_ctz32(mixed));
            const uint64_t bits = v_above64(threshold + i, position);
            uint64_t changes = bits ^ (bits << 1);
            if (i > start)
                changes ^= position < threshold[i - 1];
            else
                changes &= behind;
            if (i + 63 > last)
                changes &= ((uint64_t)2 << (last & 63)) - 1;
            n += v_pack64(edges + n, edge + i, changes);
            if (n >= TYNI_RAY_EDGES) {
                for (; n > TYNI_RAY_EDGES; n--)
                    changes &= ~((uint64_t)1 << highest(changes));
                *next = i + highest(changes) - first + 1;
                return TYNI_RAY_EDGES;
            }
        }
    }
    *next = end + 1;
    return n;
}

/* For one ray: its edges lie side by side. */
static TYNI_V_TARGET int32_t TYNI_V(ray_words)(crossing *c, const tyni_finder *finder)
{
    const arrays a = arrays_of(finder);
    const int32_t start = c->next;
    const int32_t n = TYNI_V(ray_find)(&a, c->piece->first, &c->next, c->last, c->position, c->outside, c->edges);
    c->looked += (c->next - start + 31) / 32;
    return n;
}

/* fill_edges. What is written behind a ray's edges is the next one's, which comes later. */
static TYNI_V_TARGET int TYNI_V(ray_fill)(tyni_bundle *b, const tyni_finder *finder, const tyni_piece *piece, int outside,
                                          int32_t *looked)
{
    const arrays a = arrays_of(finder);
    const int32_t rays = b->count, first = piece->first;
    int left = 0;
    for (int32_t n = 0; n < rays; n++) {
        const int32_t last = b->last[n], start = b->next[n];
        int32_t next = start, count = 0;
        if (next <= last) {
            uint16_t *edge = b->edge + n * TYNI_RAY_EDGES;
            count = TYNI_V(ray_find)(&a, first, &next, last, b->position[n], outside, edge);
            edge[count] = TYNI_ROW_END;
            count += count & 1;
            b->next[n] = (uint16_t)next;
            left |= next <= last;
            *looked += (next - start + 31) / 32;
        }
        b->edges[n] = (uint16_t)count;
    }
    return left;
}

/* 1 - 2^-x for x >= 0, to 5e-7 of itself also where x is about 0. */
TYNI_V_INLINE v_float TYNI_V(ray_dimmed)(v_float x)
{
    const v_float y = v_min(x, v_set(126.0f)), whole = TYNI_WHOLE - y;
    const v_float f = y - (TYNI_WHOLE - whole), f2 = f * f, scale = v_from_bits(v_shl(v_bits(whole), 23));
    /* (2^-f - 1) / f for |f| <= 1/2, interpolated at Chebyshev's points */
    const v_float q = (0.240223497f * f - 0.693147182f) + f2 * (0.00966636837f * f - 0.0555038117f - 0.00133813021f * f2);
    return (1.0f - scale) - f * scale * q;
}

/* tyni_slice_sight of each ray: its way from the camera, or where an orthographic one's starts. Returns its length a depth. */
TYNI_V_INLINE v_float TYNI_V(ray_way)(const tyni_bundle *b, int32_t i, const tyni_slice *s, const tyni_view *view, v_float v[3])
{
    const v_float p = s->p0 + v_to_float(v_load_u16(b->sample + i)) * s->dp;
    v_float length = v_set(1.0f), inverse;
    v[0] = s->a.x + p * s->b.x;
    v[1] = s->a.y + p * s->b.y;
    v[2] = s->a.z + p * s->b.z;
    if (!view->orthographic) {
        length = v_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        inverse = 1.0f / length;
        TYNI_UNROLL
        for (int32_t k = 0; k < 3; k++)
            v[k] = v[k] * inverse;
    }
    return length;
}

/* A form along each ray. */
TYNI_V_INLINE void TYNI_V(ray_form)(const v_float v[3], const tyni_view *view, const tyni_form *f, v_float *c, v_float *d)
{
    const v_float dot = v[0] * f->v.x + v[1] * f->v.y + v[2] * f->v.z;
    if (view->orthographic) {
        *c = dot + f->c;
        *d = v_set(tyni_vec_dot(f->v, view->forward));
    } else {
        *c = v_set(f->c);
        *d = dot;
    }
}

/* row_span of each ray: from >= until where it does not cross the piece. */
TYNI_V_INLINE void TYNI_V(ray_span)(tyni_bundle *b, int32_t i, const v_float v[3], const tyni_view *view,
                                    const tyni_piece *piece, int count)
{
    const v_float zero = v_set(0.0f), end = v_load(b->to + i);
    v_float rc, rd, wc, wd, near, far, low = zero, high = end, from, until, cut;
    v_mask crosses;
    TYNI_V(ray_form)(v, view, &piece->r, &rc, &rd);
    TYNI_V(ray_form)(v, view, &piece->w, &wc, &wd);
    /* the part in front of the map: w >= 1e-6 */
    near = wc - 1e-6f;
    far = near + end * wd;
    cut = end * (near / (near - far));
    low = v_select(v_mand(v_lt(near, zero), v_ge(far, zero)), cut, low);
    high = v_select(v_mand(v_ge(near, zero), v_lt(far, zero)), cut, high);
    crosses = v_mand(v_lt(low, high), v_mor(v_ge(near, zero), v_ge(far, zero)));
    from = v_max(v_set(piece->from), (rc + low * rd) / (wc + low * wd));
    until = v_min(v_set(piece->to), (rc + high * rd) / (wc + high * wd));
    crosses = v_mand(crosses, v_lt(from, until));
    v_store(b->rc + i, rc);
    v_store(b->rd + i, rd);
    v_store(b->wc + i, wc);
    v_store(b->wd + i, wd);
    v_store(b->from + i, v_select(crosses, from, zero));
    v_store(b->until + i, v_select(crosses, until, zero));
    if (count)
        v_store(b->texels + i, v_load(b->texels + i) + v_select(crosses, until - from, zero));
}

/* How far each ray goes, and ray_spans of the first piece. */
static TYNI_V_TARGET void TYNI_V(ray_begin)(tyni_bundle *b, const tyni_slice *s, const tyni_view *view, const tyni_row *row,
                                            const float *depth, float most)
{
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_int sample = v_load_u16(b->sample + i);
        const v_float p = s->p0 + v_to_float(sample) * s->dp, zero = v_set(0.0f);
        v_float v[3], to = v_gather(depth, sample) * TYNI_V(ray_way)(b, i, s, view, v);
        if (most > 0.0f)
            to = v_min(v_set(most), to);
        v_store(b->to + i, to);
        v_store(b->visible[0] + i, zero);
        v_store(b->visible[1] + i, zero);
        v_store(b->texels + i, zero);
        /* tyni_row_position */
        v_store_u16(b->position + i, v_trunc(v_clamp((p - row->p_start) * row->p_scale, zero, v_set(65534.0f))));
        if (row->count)
            TYNI_V(ray_span)(b, i, v, view, &row->pieces[0], 1);
    }
}

/* The same of another piece. */
static TYNI_V_TARGET void TYNI_V(ray_spans)(tyni_bundle *b, const tyni_slice *slice, const tyni_view *view,
                                            const tyni_piece *piece, int count)
{
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        v_float v[3];
        TYNI_V(ray_way)(b, i, slice, view, v);
        TYNI_V(ray_span)(b, i, v, view, piece, count);
    }
}

/* tyni_ray_coarse of rays that cross any column. */
TYNI_V_INLINE v_mask TYNI_V(ray_coarse_mask)(const tyni_bundle *b, int32_t i, float sigma, float most)
{
    const v_float texels = v_load(b->texels + i), share = v_max(v_set(1.0f), sigma * v_load(b->to + i));
    return v_mand(v_gt(texels, v_set(0.0f)), v_gt(share, most * texels));
}

/* What each word has first and second in memory. */
TYNI_V_INLINE void TYNI_V(ray_halves)(v_int word, v_int half[2])
{
    const v_int low = v_iand(word, v_iset(0xffff)), high = v_shr(word, 16);
    const uint16_t one = 1;
    uint8_t low_first;
    memcpy(&low_first, &one, 1);
    half[0] = low_first ? low : high;
    half[1] = low_first ? high : low;
}

/* Where the second column of each step begins. */
TYNI_V_INLINE v_float TYNI_V(ray_second)(const tyni_row *row, const tyni_piece *piece, v_int step)
{
    v_int half[2];
    TYNI_V(ray_halves)(v_igather(row->edge + piece->first, v_shl(step, 2)), half);
    return v_to_float(half[1]) * piece->unit;
}

/* columns_of each ray that crosses the piece and is not coarse; of others none. */
static TYNI_V_TARGET void TYNI_V(ray_enter)(tyni_bundle *b, const tyni_row *row, const tyni_piece *piece, float sigma,
                                            float most)
{
    const v_int one = v_iset(1), none = v_iset(0), final = v_iset(piece->steps - 1);
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_float from = v_load(b->from + i), until = v_load(b->until + i);
        const v_mask coarse = TYNI_V(ray_coarse_mask)(b, i, sigma, most), crosses = v_mandnot(v_lt(from, until), coarse);
        const v_int k = v_imax(v_imin(v_trunc(from), final), none);
        const v_int l = v_imax(v_imin(v_isub(v_ceili(until), one), final), k);
        const v_mask second = v_ge(from, TYNI_V(ray_second)(row, piece, k));
        const v_mask both = v_gt(until, TYNI_V(ray_second)(row, piece, l));
        b->coarse = (i ? b->coarse : 0) | v_word(coarse) << i;
        v_store_u16(b->next + i, v_iselect(crosses, v_iadd(v_iadd(k, k), v_iselect(second, one, none)), one));
        v_store_u16(b->last + i, v_iselect(crosses, v_iadd(v_iadd(l, l), v_iselect(both, one, none)), none));
        if (is_flat(piece)) { /* w is the same all along the ray */
            const v_float inverse = 1.0f / v_load(b->rd + i);
            v_store(b->rc + i, v_load(b->rc + i) * inverse);
            v_store(b->rd + i, v_load(b->wc + i) * inverse);
        }
        v_store(b->from + i, v_max(from, v_set(0.0f)));
        v_store(b->until + i, v_min(until, v_set((float)piece->steps)));
    }
}

/* Of an extinction: its e^-(sigma t) as a power of 2. Where it is about 0 any small one gives the same ratios of integrals. */
TYNI_V_INLINE float TYNI_V(ray_rate)(float sigma)
{
    return 1.44269504f * tyni_maxf(sigma, 1e-20f);
}

/* The t of each ray at a step coordinate. */
TYNI_V_INLINE v_float TYNI_V(ray_t)(const tyni_bundle *b, int flat, int32_t i, v_float at)
{
    if (flat)
        at = at * v_load(b->rd + i) - v_load(b->rc + i);
    else
        at = (at * v_load(b->wc + i) - v_load(b->rc + i)) / (v_load(b->rd + i) - at * v_load(b->wd + i));
    return v_clamp(at, v_set(0.0f), v_load(b->to + i));
}

/* The same at edges of the row. Of an orthographic map t is linear along it: between the t of the ray's ends. */
TYNI_V_INLINE v_float TYNI_V(ray_place)(const tyni_bundle *b, int flat, int32_t i, float unit, v_int edge,
                                        const v_float ends[2])
{
    const v_float at = v_to_float(edge);
    /* the first column begins before the ray comes in, the last one ends behind its end */
    if (flat)
        return v_clamp(at * (unit * v_load(b->rd + i)) - v_load(b->rc + i), ends[0], ends[1]);
    return TYNI_V(ray_t)(b, flat, i, v_clamp(at * unit, v_load(b->from + i), v_load(b->until + i)));
}

/* Where edges e and e + 1 of each ray are. Rays with fewer have there what others left. */
TYNI_V_INLINE void TYNI_V(ray_pair)(const tyni_bundle *b, int flat, int32_t i, float unit, int32_t e, const v_float ends[2],
                                    v_float *begin, v_float *end)
{
    v_int half[2];
    TYNI_V(ray_halves)(v_iload_apart(b->edge + i * TYNI_RAY_EDGES + e, TYNI_RAY_EDGES * (int32_t)sizeof *b->edge), half);
    *begin = TYNI_V(ray_place)(b, flat, i, unit, half[0], ends);
    *end = TYNI_V(ray_place)(b, flat, i, unit, half[1], ends);
}

/* The integrals up to the edges that wait: those with an even number begin what differs from outside, those with an odd number
 * end it. Only ratios of integrals count, so that they are without their 1 / sigma. */
static TYNI_V_TARGET void TYNI_V(ray_settle)(tyni_bundle *b, const tyni_piece *piece, const float sigma[2])
{
    const int flat = is_flat(piece);
    const float s0 = TYNI_V(ray_rate)(sigma[0]), s1 = TYNI_V(ray_rate)(sigma[1]);
    const v_float zero = v_set(0.0f);
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_int edges = v_load_u16(b->edges + i);
        v_float sum0 = v_load(b->visible[0] + i), sum1 = v_load(b->visible[1] + i);
        v_mask some = v_igt(edges, v_iset(0));
        v_float begin, end, ends[2];
        if (v_none(some))
            continue;
        ends[0] = TYNI_V(ray_t)(b, flat, i, v_load(b->from + i));
        ends[1] = TYNI_V(ray_t)(b, flat, i, v_load(b->until + i));
        TYNI_V(ray_pair)(b, flat, i, piece->unit, 0, ends, &begin, &end);
        /* the next two places before the light of these: either is a long chain, and so they overlap */
        for (int32_t e = 2; v_any(some); e += 2) {
            const v_float t0 = begin, t1 = end;
            const v_mask now = some;
            v_float light0, light1;
            some = v_igt(edges, v_iset(e));
            if (v_any(some))
                TYNI_V(ray_pair)(b, flat, i, piece->unit, e, ends, &begin, &end);
            light0 = TYNI_V(ray_dimmed)(s0 * t1) - TYNI_V(ray_dimmed)(s0 * t0);
            light1 = TYNI_V(ray_dimmed)(s1 * t1) - TYNI_V(ray_dimmed)(s1 * t0);
            sum0 = sum0 + v_select(now, light0, zero);
            sum1 = sum1 + v_select(now, light1, zero);
        }
        v_store(b->visible[0] + i, sum0);
        v_store(b->visible[1] + i, sum1);
    }
}

/* From sums to visibility. */
static TYNI_V_TARGET void TYNI_V(ray_visible)(tyni_bundle *b, int outside, const float sigma[2])
{
    for (int32_t k = 0; k < 2; k++)
        for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
            const v_float all = TYNI_V(ray_dimmed)(TYNI_V(ray_rate)(sigma[k]) * v_load(b->to + i)), zero = v_set(0.0f);
            v_float lit = v_load(b->visible[k] + i);
            if (outside)
                lit = all - lit;
            lit = v_clamp(lit, zero, all);
            v_store(b->visible[k] + i, v_select(v_gt(all, zero), lit / all, zero));
        }
}
