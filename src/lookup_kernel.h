/* lookup_kernel.h - a template: rays in prefiltered rows, for lookup.c. What is of a ray is computed for v_n rays side by side,
 * what is of its bases for v_n bases. */

/* 32767 a_k(z), KSE14's eq. 8, as the bases are stored. `a` has room for v_n more. Sines of (2 k + 1) z half turns, z >= 0, to
 * 4e-6, which is a tenth of what 16 bits tell apart. */
TYNI_V_INLINE void TYNI_V(lookup_factors)(const tyni_fourier *f, float z, int16_t *a)
{
    const int32_t half = f->bases / 2;
    const v_int one = v_iset(1), two = v_iset(2);
    for (int32_t k = 0; k < half; k += v_n) {
        const v_float turn = z * (2.0f * (v_to_float(v_index()) + (float)k) + 1.0f);
        const v_int n = v_trunc(2.0f * turn + 0.5f);
        const v_mask even = v_ieq(v_iand(n, one), v_iset(0));
        const v_float x = TYNI_PI * (turn - 0.5f * v_to_float(n)), q = x * x;
        const v_float s = x + x * q * (q * (q * (-1.0f / 5040.0f) + 1.0f / 120.0f) - 1.0f / 6.0f);
        const v_float c = 1.0f + q * (q * (q * (-1.0f / 720.0f) + 1.0f / 24.0f) - 0.5f);
        const v_float most = v_to_float(v_load_u16((const uint16_t *)(const void *)(f->amplitude + k)));
        const v_int sine = v_ixor(v_bits(v_select(even, s, c)), v_shl(v_iandnot(two, n), 30)); /* times -1 */
        const v_int cosine = v_ixor(v_bits(v_select(even, c, s)), v_shl(v_iand(v_iadd(n, one), two), 30));
        v_store_u16_n((uint16_t *)(void *)(a + k), v_trunc(most * v_from_bits(cosine)), half - k);
        v_store_u16_n((uint16_t *)(void *)(a + half + k), v_trunc(most * v_from_bits(sine)), half - k);
    }
}

/* z of the ray through p of the slice's line */
TYNI_V_INLINE float TYNI_V(lookup_z)(const tyni_fourier *f, const tyni_shelf *s, float p)
{
    return TYNI_V(fourier_z)(f, s, tyni_clampf((p - s->p_start) * s->p_scale, 0.0f, 65534.0f));
}

/* What a ray gets from its slice's row: of the stored column where it ends, and then of the one before, `count` sets from
 * reference ray `first` on. */
typedef struct TYNI_V(lookup_sets) {
    int32_t sum[24], word[24]; /* of the bases; constant and share */
    float at;                  /* how much of the way to the first column */
    int32_t count, first, slot[3];
    float part[3]; /* of the way from reference ray slot to the next */
} TYNI_V(lookup_sets);

/* Of the ray that ends in column y of the row, 0 .. columns, by its factors. */
TYNI_V_INLINE void TYNI_V(lookup_take)(const tyni_fourier *f, const tyni_shelf *s, float y, const int16_t *a,
                                       const float lean[3], TYNI_V(lookup_sets) * t)
{
    const int32_t cell = tyni_clampi((int32_t)y, 0, f->columns - 1), whole = f->bases & ~15;
    const ptrdiff_t pitch = tyni_fourier_pitch(f);
    const uint8_t *row = (const uint8_t *)(s + 1) + cell * pitch;
    const int8_t *rows[28];
    int32_t last = 0, count;
    t->at = 1.0f;
    t->first = 3;
    /* between two stored means M the mean over half a cell is no straight line: (y - cell) / y of the sum is new */
    if (cell > 0 && y > 0.0f)
        t->at = tyni_minf((y - (float)cell) * (float)(cell + 1) / y, 1.0f);
    for (int32_t c = 0; c < 3; c++) {
        t->part[c] = between(s, f->references, lean[c], &t->slot[c]);
        t->first = tyni_mini(t->first, t->slot[c]);
        last = tyni_maxi(last, t->slot[c]);
    }
    last = tyni_mini(last + 1, f->references - 1);
    row += (ptrdiff_t)(t->first * f->channels) * TYNI_FOURIER_LENGTH(f->bases);
    t->count = (last + 1 - t->first) * f->channels;
    count = t->at < 1.0f ? 2 * t->count : t->count;
    for (int32_t i = 0; i < count; i++) {
        const uint8_t *p = i < t->count ? row + i * TYNI_FOURIER_LENGTH(f->bases)
                                        : row + (i - t->count) * TYNI_FOURIER_LENGTH(f->bases) - pitch;
        uint16_t part[2];
        memcpy(part, p, sizeof part);
        t->word[i] = (int32_t)((uint32_t)part[1] << 16 | part[0]);
        rows[i] = (const int8_t *)p + sizeof part;
    }
    for (int32_t i = count; i < count + 3; i++)
        rows[i] = (const int8_t *)row; /* sums come in fours */
    for (int32_t i = 0; i < count; i += 4)
        v_dots8(a, rows + i, whole, t->sum + i);
    for (int32_t k = whole; k < f->bases; k++)
        for (int32_t i = 0; i < count; i++)
            t->sum[i] += a[k] * rows[i][k];
}

/* The means over the columns of stored rows. The series is clamped: it overshoots, what it stands for does not. */
TYNI_V_INLINE v_float TYNI_V(lookup_mean)(const int32_t *sum, const int32_t *word, int32_t n)
{
    const v_int w = v_iload_n(word, n);
    const v_float series = 0.5f + v_to_float(v_iload_n(sum, n)) * (0.636619772f / (127.0f * 32767.0f));
    const v_float constant = v_to_float(v_sar(v_shl(w, 16), 16)) * (1.0f / 32767.0f);
    return constant + v_to_float(v_shr(w, 16)) * (1.0f / 65535.0f) * v_clamp(series, v_set(0.0f), v_set(1.0f));
}

TYNI_V_INLINE void TYNI_V(lookup_value)(const tyni_fourier *f, const tyni_shelf *s, const TYNI_V(lookup_sets) * t,
                                        float value[3])
{
    const int32_t count = t->count, next = f->references > 1 ? f->channels : 0;
    float mean[16];
    for (int32_t i = 0; i < count; i += v_n) {
        v_float m = TYNI_V(lookup_mean)(t->sum + i, t->word + i, count - i);
        if (t->at < 1.0f)
            m = m + (1.0f - t->at) * (TYNI_V(lookup_mean)(t->sum + count + i, t->word + count + i, count - i) - m);
        v_store(mean + i, m);
    }
    for (int32_t c = 0; c < 3; c++) {
        const float *m = mean + (t->slot[c] - t->first) * f->channels + (f->channels == 3 ? c : 0);
        value[c] = tyni_maxf(m[0] + t->part[c] * (m[next] - m[0]), 0.0f) * s->scale[c];
    }
}

static TYNI_V_TARGET void TYNI_V(lookup_row)(const tyni_fourier *f, const tyni_shelf *s, float y, float p, const float lean[3],
                                             float value[3])
{
    int16_t a[128 + 16];
    TYNI_V(lookup_sets) t;
    TYNI_V(lookup_factors)(f, TYNI_V(lookup_z)(f, s, p), a);
    TYNI_V(lookup_take)(f, s, y, a, lean, &t);
    TYNI_V(lookup_value)(f, s, &t, value);
}

/* v_n rays from the camera, of unit length. */
typedef struct TYNI_V(lookup_rays) {
    v_float x, y, z, along, across, t0, t1;
} TYNI_V(lookup_rays);

TYNI_V_INLINE v_float TYNI_V(lookup_form)(const tyni_form *f, const TYNI_V(lookup_rays) * r, v_float t)
{
    return (f->v.x * r->x + f->v.y * r->y + f->v.z * r->z) * t + f->c;
}

/* tyni_lookup_coarse of all */
TYNI_V_INLINE v_mask TYNI_V(lookup_coarse)(const tyni_fourier *f, const TYNI_V(lookup_rays) * r)
{
    const tyni_lamp *lamp = f->lamp;
    const v_float depth = f->medium->sigma[f->medium->high] * (r->t1 - r->t0), tiny = v_set(1e-6f);
    v_float texels = v_set(0.0f);
    if (!lamp->map_count || f->no_walks)
        return v_first(0);
    if (lamp->kind != TYN_LIGHT_DIRECTIONAL) {
        const v_float n = lamp->distance * (r->t1 - r->t0) * r->across;
        const v_float d = r->t0 * r->t1 + lamp->distance * (lamp->distance - (r->t0 + r->t1) * r->along);
        return v_gt(v_max(v_set(1.0f), depth), 0.05f * f->map_scale * v_atan2(n, d));
    }
    for (int32_t i = 0; i < lamp->map_count; i++) {
        const tyni_map *m = &lamp->maps[i];
        const v_float a = 1.0f / v_max(TYNI_V(lookup_form)(&m->w, r, r->t0), tiny);
        const v_float b = 1.0f / v_max(TYNI_V(lookup_form)(&m->w, r, r->t1), tiny);
        const v_float du = TYNI_V(lookup_form)(&m->u, r, r->t1) * b - TYNI_V(lookup_form)(&m->u, r, r->t0) * a;
        const v_float dv = TYNI_V(lookup_form)(&m->v, r, r->t1) * b - TYNI_V(lookup_form)(&m->v, r, r->t0) * a;
        texels = v_max(texels, v_max(v_abs(du), v_abs(dv)));
    }
    return v_gt(v_max(v_set(1.0f), depth), 0.05f * texels);
}

TYNI_V_INLINE void TYNI_V(lookup_sights)(const tyni_fourier *f, const tyni_view *v, v_float px, float py,
                                         TYNI_V(lookup_rays) * r)
{
    const tyni_vec3 to = f->lamp->to_light;
    const v_float x = (v->origin.x + px * v->dx.x) + py * v->dy.x, y = (v->origin.y + px * v->dx.y) + py * v->dy.y;
    const v_float z = (v->origin.z + px * v->dx.z) + py * v->dy.z, scale = 1.0f / v_sqrt(x * x + y * y + z * z);
    v_float cx, cy, cz;
    r->x = x * scale;
    r->y = y * scale;
    r->z = z * scale;
    r->along = r->x * to.x + r->y * to.y + r->z * to.z;
    cx = r->x - r->along * to.x;
    cy = r->y - r->along * to.y;
    cz = r->z - r->along * to.z;
    r->across = v_sqrt(cx * cx + cy * cy + cz * cz);
}

/* Rays in the rows of one of the two slices beside each, and the sums over both: of values by weight, of weights. */
typedef struct TYNI_V(lookup_taps) {
    float p[v_n], x[v_n], lean[v_n], weight[v_n], sum[4][v_n];
    int32_t line[v_n];
    /* of the side in hand */
    float z[v_n], y[v_n];
    TYNI_V(lookup_sets) sets[4];
    int16_t factors[]; /* 4 times (bases + 16) */
} TYNI_V(lookup_taps);

/* z and y of lanes `wanted`; returns those whose row knows them. */
TYNI_V_INLINE uint32_t TYNI_V(lookup_place)(const tyni_fourier *f, const tyni_lookup *l, TYNI_V(lookup_taps) * t,
                                            uint32_t wanted)
{
    float offset[v_n] = {0.0f}, density[v_n] = {0.0f}, near[v_n] = {0.0f}, far[v_n] = {0.0f};
    for (uint32_t bits = wanted; bits; bits &= bits - 1) {
        const int32_t i = tyni_ctz32(bits);
        const tyni_shelf *s = (const void *)(l->shelves + (size_t)t->line[i] * l->bytes);
        if (!(t->weight[i] > 0.0f) || !covers(s, t->x[i])) {
            wanted &= ~(1u << i);
            continue;
        }
        t->z[i] = TYNI_V(lookup_z)(f, s, t->p[i]);
        offset[i] = tyni_clampf(t->x[i], s->low, s->high) - s->low;
        density[i] = s->density;
        near[i] = s->near_share;
        far[i] = s->far_share;
    }
    {
        const v_float o = v_load(offset), n = v_load(near);
        v_store(t->y, o * (v_load(far) + n * v_fog(v_load(density) * o)) * (float)f->columns);
    }
    return wanted;
}

/* Some rays at a time: each step by itself is short, so that a processor has several rays in work at once. */
TYNI_V_INLINE void TYNI_V(lookup_side)(const tyni_fourier *f, const tyni_lookup *l, TYNI_V(lookup_taps) * t, uint32_t wanted)
{
    const int sun = f->lamp->kind == TYN_LIGHT_DIRECTIONAL;
    for (uint32_t left = TYNI_V(lookup_place)(f, l, t, wanted); left;) {
        const tyni_shelf *shelf[4];
        int32_t lane[4], count = 0;
        for (; left && count < 4; left &= left - 1) {
            lane[count] = tyni_ctz32(left);
            shelf[count] = (const void *)(l->shelves + (size_t)t->line[lane[count]] * l->bytes);
            count++;
        }
        for (int32_t j = 0; j < count; j++)
            TYNI_V(lookup_factors)(f, t->z[lane[j]], t->factors + j * (f->bases + 16));
        for (int32_t j = 0; j < count; j++) {
            float k[3];
            for (int32_t c = 0; c < 3; c++)
                k[c] = sun ? f->medium->sigma[c] * t->lean[lane[j]] : t->lean[lane[j]];
            TYNI_V(lookup_take)(f, shelf[j], t->y[lane[j]], t->factors + j * (f->bases + 16), k, &t->sets[j]);
        }
        for (int32_t j = 0; j < count; j++) {
            float value[3], weight = t->weight[lane[j]];
            TYNI_V(lookup_value)(f, shelf[j], &t->sets[j], value);
            for (int32_t c = 0; c < 3; c++)
                t->sum[c][lane[j]] += weight * value[c];
            t->sum[3][lane[j]] += weight;
        }
    }
}

static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(lookup_pixels)(const tyni_fourier *f, const tyni_lookup *l)
{
    TYNI_V(lookup_taps) *t = l->scratch;
    const tyni_slices *g = l->slices;
    const tyni_sector *s = l->sector;
    const float py = (float)l->y + 0.5f, dy = py * g->ew - g->ey, inverse = 1.0f / s->spacing, slant = (s->border - py) / dy;
    const int sun = f->lamp->kind == TYN_LIGHT_DIRECTIONAL;
    for (int32_t i = 0; i < l->count; i += v_n) {
        const int32_t n = l->count - i;
        v_float px = v_to_float(v_iadd(v_iset(l->x + i), v_index())) + 0.5f, dx = px * g->ew - g->ex;
        TYNI_V(lookup_rays) r;
        v_float k, part;
        v_mask wanted, coarse;
        v_int at;
        r.t0 = v_load_n(l->from + i, n);
        r.t1 = v_load_n(l->to + i, n);
        wanted = v_mand(v_first(n), v_gt(r.t1, v_set(0.0f)));
        if (v_none(wanted))
            continue;
        TYNI_V(lookup_sights)(f, l->view, px, py, &r);
        coarse = v_mand(wanted, TYNI_V(lookup_coarse)(f, &r));
        if (sun) {
            v_store(t->x, r.across * r.t1);
            v_store(t->lean, 1.0f / v_max(r.across, v_set(1e-4f)));
        } else {
            v_store(t->x, v_atan2(r.across * r.t1, f->lamp->distance - r.along * r.t1));
            v_store(t->lean, v_atan2(r.across, r.along));
        }
        if (s->along_y)
            k = px + dx * slant;
        else
            k = py + dy * (s->border - px) / dx;
        k = v_clamp((k - s->first) * inverse, v_set(0.0f), v_set((float)(s->count - 1)));
        at = v_imin(v_trunc(k), v_iset(s->count - 2));
        part = k - v_to_float(at);
        at = v_iadd(at, v_iset(s->start));
        if (s->along_y)
            px = v_set(py);
        v_store(t->p, px);
        memset(t->sum, 0, sizeof t->sum);
        for (int32_t side = 0; side < 2; side++) {
            v_istore(t->line, v_iadd(at, v_iset(side)));
            if (side)
                v_store(t->weight, part);
            else
                v_store(t->weight, 1.0f - part);
            TYNI_V(lookup_side)(f, l, t, v_word(v_mandnot(wanted, coarse)));
        }
        part = v_load(t->sum[3]);
        for (int32_t c = 0; c < 3; c++)
            v_store_n(l->value[c] + i, v_select(v_gt(part, v_set(0.0f)), v_load(t->sum[c]) / part, v_set(0.0f)), n);
        for (uint32_t bits = v_word(v_mandnot(wanted, v_gt(part, v_set(0.0f)))); bits; bits &= bits - 1) {
            const int32_t j = l->first + i + tyni_ctz32(bits);
            l->rejected[j >> 5] |= 1u << (j & 31);
        }
    }
}
