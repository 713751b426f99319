/* lookup_kernel.h - a template: rays in prefiltered rows, for lookup.c. What is of a ray is computed for v_n rays side by side,
 * what is of its bases for v_n bases. */

/* 32767 a_k(z), KSE14's eq. 8, as the bases are stored; the rest up to a multiple of 16 is 0. `a` has room for 16 more. */
TYNI_V_INLINE void TYNI_V(lookup_factors)(const tyni_fourier *f, float z, int16_t *a)
{
    const int32_t half = f->bases / 2;
    /* cosines first: what is stored beyond them is in the sines' place, or behind all */
    for (int32_t k = 0; k < half; k += v_n) {
        const v_float order = 2.0f * (v_to_float(v_index()) + (float)k) + 1.0f;
        v_float sine, cosine, most = v_to_float(v_load_u16((const uint16_t *)(const void *)(f->amplitude + k)));
        v_sincos(TYNI_PI * z * order, &sine, &cosine);
        v_store_u16_n((uint16_t *)(void *)(a + k), v_trunc(most * cosine), half - k);
        v_store_u16_n((uint16_t *)(void *)(a + half + k), v_trunc(-most * sine), half - k);
    }
}

/* Visibility of the ray that ends in column y of its slice's row, 0 .. columns. */
static TYNI_V_TARGET void TYNI_V(lookup_row)(const tyni_fourier *f, const tyni_shelf *s, float y, float p, const float lean[3],
                                             float value[3])
{
    const int32_t length = TYNI_FOURIER_LENGTH(f->bases), whole = f->bases & ~15,
                  cell = tyni_clampi((int32_t)y, 0, f->columns - 1);
    const float position = tyni_clampf((p - s->p_start) * s->p_scale, 0.0f, 65534.0f);
    const uint32_t above[2] = {v_above16(s->knot, (uint32_t)position), v_above16(s->knot + 32, (uint32_t)position)};
    const int32_t knot = above[0] ? tyni_ctz32(above[0]) - 1 : above[1] ? 31 + tyni_ctz32(above[1]) : 63;
    float at = 1.0f, node[3], mean[12];
    int32_t first = 3, last = 0;
    const uint8_t *row;
    int16_t a[128 + 16];
    /* between two stored means M the mean over half a cell is no straight line: (y - cell) / y of the sum is new */
    if (cell > 0 && y > 0.0f)
        at = tyni_minf((y - (float)cell) * (float)(cell + 1) / y, 1.0f);
    for (int32_t c = 0; c < 3; c++) {
        node[c] = c && lean[c] <= lean[0] && lean[c] >= lean[0] ? node[0] : between(s, f->references, lean[c]);
        first = tyni_mini(first, (int32_t)node[c]);
        last = tyni_maxi(last, tyni_mini((int32_t)node[c] + 1, f->references - 1));
    }
    TYNI_V(lookup_factors)(f, tyni_fourier_z_between(f, s, knot, position), a);
    row = (const uint8_t *)(s + 1) + cell * tyni_fourier_pitch(f) + (ptrdiff_t)first * f->channels * length;
    for (int32_t i = first * f->channels; i < (last + 1) * f->channels; i++, row += length) {
        const uint8_t *before = row - tyni_fourier_pitch(f);
        int32_t sum = v_dot8(a, (const int8_t *)(row + 4), whole);
        for (int32_t k = whole; k < f->bases; k++)
            sum += a[k] * (int8_t)row[4 + k];
        mean[i] = row_mean(row, sum);
        if (!(at < 1.0f))
            continue;
        sum = v_dot8(a, (const int8_t *)(before + 4), whole);
        for (int32_t k = whole; k < f->bases; k++)
            sum += a[k] * (int8_t)before[4 + k];
        mean[i] += (1.0f - at) * (row_mean(before, sum) - mean[i]);
    }
    for (int32_t c = 0; c < 3; c++) {
        const int32_t n = tyni_clampi((int32_t)node[c], first, tyni_maxi(last - 1, first)), o = f->channels == 3 ? c : 0;
        const float low = mean[n * f->channels + o], high = mean[tyni_mini(n + 1, last) * f->channels + o];
        value[c] = tyni_maxf(low + (node[c] - (float)n) * (high - low), 0.0f) * s->scale[c];
    }
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

/* What the rows of one of the two slices beside each pixel say, times its weight. */
TYNI_V_INLINE void TYNI_V(lookup_side)(const tyni_fourier *f, const tyni_lookup *l, const float *p, uint32_t wanted,
                                       const int32_t *line, const float *weight, const float *x, const float *lean,
                                       float sum[4][v_n])
{
    const float *sigma = f->medium->sigma;
    const int sun = f->lamp->kind == TYN_LIGHT_DIRECTIONAL;
    float offset[v_n] = {0.0f}, density[v_n] = {0.0f}, near[v_n] = {0.0f}, far[v_n] = {0.0f}, y[v_n];
    for (uint32_t bits = wanted; bits; bits &= bits - 1) {
        const int32_t i = tyni_ctz32(bits);
        const tyni_shelf *s = (const void *)(l->shelves + (size_t)line[i] * l->bytes);
        if (!(weight[i] > 0.0f) || !covers(s, x[i])) {
            wanted &= ~(1u << i);
            continue;
        }
        offset[i] = tyni_clampf(x[i], s->low, s->high) - s->low;
        density[i] = s->density;
        near[i] = s->near_share;
        far[i] = s->far_share;
    }
    if (!wanted)
        return;
    {
        const v_float o = v_load(offset), n = v_load(near);
        v_store(y, o * (v_load(far) + n * v_fog(v_load(density) * o)) * (float)f->columns);
    }
    for (uint32_t bits = wanted; bits; bits &= bits - 1) {
        const int32_t i = tyni_ctz32(bits);
        float k[3], value[3];
        for (int32_t c = 0; c < 3; c++)
            k[c] = sun ? sigma[c] * lean[i] : lean[i];
        TYNI_V(lookup_row)(f, (const void *)(l->shelves + (size_t)line[i] * l->bytes), y[i], p[i], k, value);
        for (int32_t c = 0; c < 3; c++)
            sum[c][i] += weight[i] * value[c];
        sum[3][i] += weight[i];
    }
}

static TYNI_V_TARGET void TYNI_V(lookup_pixels)(const tyni_fourier *f, const tyni_lookup *l)
{
    const tyni_slices *g = l->slices;
    const tyni_sector *s = l->sector;
    const float py = (float)l->y + 0.5f, dy = py * g->ew - g->ey, inverse = 1.0f / s->spacing, slant = (s->border - py) / dy;
    const int sun = f->lamp->kind == TYN_LIGHT_DIRECTIONAL;
    for (int32_t i = 0; i < l->count; i += v_n) {
        const int32_t n = l->count - i;
        v_float px = v_to_float(v_iadd(v_iset(l->x + i), v_index())) + 0.5f, dx = px * g->ew - g->ex;
        float p[v_n], x[v_n], lean[v_n], weight[v_n], sum[4][v_n];
        int32_t line[v_n];
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
            v_store(x, r.across * r.t1);
            v_store(lean, 1.0f / v_max(r.across, v_set(1e-4f)));
        } else {
            v_store(x, v_atan2(r.across * r.t1, f->lamp->distance - r.along * r.t1));
            v_store(lean, v_atan2(r.across, r.along));
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
        v_store(p, px);
        memset(sum, 0, sizeof sum);
        for (int32_t side = 0; side < 2; side++) {
            v_istore(line, v_iadd(at, v_iset(side)));
            if (side)
                v_store(weight, part);
            else
                v_store(weight, 1.0f - part);
            TYNI_V(lookup_side)(f, l, p, v_word(v_mandnot(wanted, coarse)), line, weight, x, lean, sum);
        }
        part = v_load(sum[3]);
        for (int32_t c = 0; c < 3; c++)
            v_store_n(l->value[c] + i, v_select(v_gt(part, v_set(0.0f)), v_load(sum[c]) / part, v_set(0.0f)), n);
        for (uint32_t bits = v_word(v_mandnot(wanted, v_gt(part, v_set(0.0f)))); bits; bits &= bits - 1) {
            const int32_t j = l->first + i + tyni_ctz32(bits);
            l->rejected[j >> 5] |= 1u << (j & 31);
        }
    }
}
