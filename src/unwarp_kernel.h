/* unwarp_kernel.h - a template: visibility of a run of pixels from lines, for unwarp.c. Planes have room for whole vectors. */

static TYNI_V_TARGET void TYNI_V(pixel_sights)(const tyni_pass *p, const tyni_run *r, const ahead *a)
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
        TYNI_UNROLL
        for (int32_t j = 0; j < 3 && v_n > 1; j++) /* images are beyond the nearest caches, and runs too short to be foreseen */
            TYNI_PREFETCH(a->pixels[j] + (ptrdiff_t)a->bytes[j] * i);
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
TYNI_V_INLINE void TYNI_V(pixel_down)(const tyni_tile *t, int32_t sample, const TYNI_V(pixel_lines) * l, v_int out[2])
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

/* tyni_gather_threshold of pixels from px on, at depths relative to far. */
TYNI_V_INLINE v_float TYNI_V(pixel_threshold)(const tyni_view *view, tyni_vec3 lamp, float threshold, int32_t px, float py,
                                              v_float depth)
{
    const v_float at = v_to_float(v_iadd(v_iset(px), v_index())) + 0.5f, z = depth * view->far_depth;
    const tyni_vec3 o = tyni_vec_mad(view->origin, py, view->dy);
    v_float x[3];
    x[0] = o.x + at * view->dx.x;
    x[1] = o.y + at * view->dx.y;
    x[2] = o.z + at * view->dx.z;
    if (view->orthographic) {
        x[0] = lamp.x - (x[0] + z * view->forward.x);
        x[1] = lamp.y - (x[1] + z * view->forward.y);
        x[2] = lamp.z - (x[2] + z * view->forward.z);
    } else {
        x[0] = lamp.x - z * x[0];
        x[1] = lamp.y - z * x[1];
        x[2] = lamp.z - z * x[2];
    }
    x[0] = v_sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / z;
    return threshold * v_clamp(x[0], v_set(TYNI_GATHER_NARROW), v_set(1.0f));
}

/* A sample of each pixel's two lines: tap() of gather.c. `at`: the pixel's depth, not below the nearest that is told apart;
 * `share`: of the lines in the pixel. */
TYNI_V_INLINE void TYNI_V(pixel_taps)(TYNI_V(pixel_sum) * s, v_float threshold, const v_int entry[2],
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
        limit[side] = threshold * v_min(at, other);
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
TYNI_V_INLINE void TYNI_V(pixel_call)(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector, int32_t first,
                                      int32_t end)
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

/* The slice coordinate, 0 .. count - 1, of pixels x of row y in a sector of the shear grid. */
TYNI_V_INLINE v_float TYNI_V(pixel_place)(const tyni_pass *p, int32_t y, const tyni_sector *sector, v_int x)
{
    const tyni_slices *g = &p->slices;
    const float py = (float)y + 0.5f, dy = py * g->ew - g->ey, inverse = 1.0f / sector->spacing;
    const float slant = (sector->border - py) / dy;
    const v_float px = v_to_float(x) + 0.5f, dx = px * g->ew - g->ex;
    v_float k;
    if (sector->along_y)
        k = px + dx * slant;
    else
        k = py + dy * (sector->border - px) / dx;
    return v_clamp((k - sector->first) * inverse, v_set(0.0f), v_set((float)(sector->count - 1)));
}

/* Of pixels first .. end - 1 of the run, all in one sector: into value[0]. In a round of its own, so that how many lines a
 * vector needs is known long before its turn. */
static TYNI_V_TARGET void TYNI_V(pixel_places)(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector, int32_t first,
                                               int32_t end)
{
    for (int32_t i = first; i < end; i += v_n)
        v_store_n(r->value[0] + i, TYNI_V(pixel_place)(p, r->y, sector, v_iadd(v_iset(r->x + i), v_index())), end - i);
    if (v_n > 1 && !sector->along_y && r->y % TYNI_PIXEL_BAND == 0)
        TYNI_V(pixel_call)(p, r, sector, first, end);
}

/* From there visibility of these pixels. t: entries of the sector's lines along y, or NULL. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_unwarp)(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector,
                                                             const tyni_tile *t, int32_t first, int32_t end)
{
    const tyni_field field = p->lines; /* copies are none of what is written */
    const tyni_run own = *r;
    const int32_t along_y = sector->along_y, start = sector->start, count = sector->count, most = field.pitch - 1;
    const int32_t stride = p->slices.stride, edge = p->slices.width - 1;
    const float step = 1.0f / (float)stride;
    const int local = tyni_view_kind(p->lamp) != TYN_LIGHT_DIRECTIONAL;
    const int32_t shift = shift_of(&p->slices);
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
        v_float threshold = v_set(field.threshold);
        v_mask fits;
        int in_tile, side_by_side;
        TYNI_V(pixel_between_lines)(&field, own.value[0] + i, n, start, count - 2, &l);
        if (local)
            threshold =
                TYNI_V(pixel_threshold)(&p->view, p->lamp->position, field.threshold, own.x + i, (float)own.y + 0.5f, at);
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
            TYNI_V(pixel_taps)(&s, threshold, entry, &l, at, share);
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

/* Two vectors of pixels in the light of a sun, the usual ones. Each is a chain of operations that wait for one another, and
 * what a core looks ahead is hardly longer; so they go step by step. */
typedef struct TYNI_V(pixel_pair) {
    v_float at[2], f[2], scale[2][2][2]; /* of a vector, its line, and low or high */
    v_float along[2];                    /* the way to the next sample */
    v_int place[2], entry[2][2];         /* of a vector and its line */
    v_int sample[2];                     /* where lines run along x: from the vector's first on */
    int32_t low[2], span[2], base[2];
} TYNI_V(pixel_pair);

/* pixel_between_lines of both; 0: for one of them lines are too many. */
TYNI_V_INLINE int TYNI_V(pixel_pair_lines)(float *const scales[2], const float *k, int32_t first, int32_t last,
                                           TYNI_V(pixel_pair) * q)
{
    TYNI_UNROLL
    for (int32_t n = 0; n < 2; n++) {
        const int32_t a = tyni_mini((int32_t)k[n * v_n], last), b = tyni_mini((int32_t)k[n * v_n + v_n - 1], last);
        const v_float at = v_load(k + n * v_n);
        const v_int line = v_imin(v_trunc(at), v_iset(last));
        q->f[n] = at - v_to_float(line);
        q->low[n] = tyni_mini(a, b);
        q->span[n] = tyni_maxi(a, b) - q->low[n];
        q->place[n] = v_isub(line, v_iset(q->low[n]));
        q->low[n] += first;
    }
    if (tyni_maxi(q->span[0], q->span[1]) >= v_n)
        return 0;
    TYNI_UNROLL_MORE
    for (int32_t n = 0; n < 8; n++)
        q->scale[n >> 2][n >> 1 & 1][n & 1] = v_pick(scales[n & 1] + q->low[n >> 2] + (n >> 1 & 1), q->place[n >> 2]);
    return 1;
}

/* Samples of both where lines run along x, of pixels from column x on; 0: the last lie beyond the line. */
TYNI_V_INLINE int TYNI_V(pixel_pair_samples)(int32_t x, int32_t shift, int32_t pitch, TYNI_V(pixel_pair) * q)
{
    TYNI_UNROLL
    for (int32_t n = 0; n < 2; n++) {
        const v_int column = v_iadd(v_iset(x + n * v_n), v_index());
        q->base[n] = (x + n * v_n) >> shift;
        q->sample[n] = v_isub(v_shr(column, shift), v_iset(q->base[n]));
        q->along[n] = v_to_float(v_iand(column, v_iset((1 << shift) - 1))) * (1.0f / (float)(1 << shift));
    }
    return (x + 2 * v_n - 1) >> shift < pitch - (shift > 0);
}

/* Entries of both where lines run along y, at a row of the tile. */
TYNI_V_INLINE void TYNI_V(pixel_pair_down)(const uint32_t *row, TYNI_V(pixel_pair) * q)
{
    TYNI_UNROLL
    for (int32_t n = 0; n < 4; n++)
        q->entry[n >> 1][n & 1] = v_ipick(row + q->low[n >> 1] + (n & 1), q->place[n >> 1]);
}

/* What pixels of a vector have on a line, from its first sample on: what lies behind that of the last is not theirs, and may be
 * the next line's or what is behind the last line (frame.c). */
TYNI_V_INLINE v_int TYNI_V(pixel_pair_read)(const uint32_t *row, v_int sample, int32_t shift)
{
    return shift ? v_ipick(row, sample) : v_iload(row);
}

/* pixel_along of both, `next` samples on. */
TYNI_V_INLINE void TYNI_V(pixel_pair_along)(const tyni_field *f, int32_t shift, int32_t next, TYNI_V(pixel_pair) * q)
{
    const int32_t span = tyni_maxi(q->span[0], q->span[1]);
    const uint32_t *row[2];
    v_int one[2];
    TYNI_UNROLL
    for (int32_t n = 0; n < 2; n++) {
        row[n] = f->entries + (ptrdiff_t)q->low[n] * f->pitch + q->base[n] + next;
        one[n] = q->entry[n][0] = q->entry[n][1] = TYNI_V(pixel_pair_read)(row[n], q->sample[n], shift);
    }
    for (int32_t k = 0; k <= span; k += 4) {
        TYNI_UNROLL
        for (int32_t j = 0; j < 4; j++) {
            TYNI_UNROLL
            for (int32_t n = 0; n < 2; n++) {
                const v_mask here = v_ieq(q->place[n], v_iset(k + j));
                row[n] += k + j <= q->span[n] ? f->pitch : 0;
                q->entry[n][0] = v_iselect(here, one[n], q->entry[n][0]);
                one[n] = TYNI_V(pixel_pair_read)(row[n], q->sample[n], shift);
                q->entry[n][1] = v_iselect(here, one[n], q->entry[n][1]);
            }
        }
    }
}

/* pixel_taps of both. part: of the pixel, this sample's; NULL: all of it. more: add to what there is. */
TYNI_V_INLINE void TYNI_V(pixel_pair_taps)(const TYNI_V(pixel_pair) * q, float threshold, const v_float *part, int more,
                                           TYNI_V(pixel_sum) s[2])
{
    const v_int ten = v_iset(1023);
    v_float off[4], limit[4], weight[4];
    v_mask near = v_first(v_n);
    TYNI_UNROLL
    for (int32_t n = 0; n < 4; n++) {
        const v_int code = v_shr(q->entry[n >> 1][n & 1], 20);
        const v_float other = v_from_bits(v_iadd(v_shl(code, 15), v_iset((int32_t)TYNI_ENTRY_FLOOR - 0x4000)));
        off[n] = v_abs(q->at[n >> 1] - other);
        limit[n] = threshold * v_min(q->at[n >> 1], other);
        weight[n] = q->f[n >> 1];
        if (!(n & 1))
            weight[n] = 1.0f - weight[n];
        if (part)
            weight[n] = weight[n] * part[n >> 1];
        weight[n] = v_select(v_ieq(code, v_iset(0)), v_set(0.0f), weight[n]);
        near = v_mand(near, v_le(off[n], limit[n]));
    }
    if (!v_all(near)) {
        TYNI_UNROLL
        for (int32_t n = 0; n < 4; n++) {
            const v_float ratio = limit[n] / v_max(off[n], limit[n]), square = ratio * ratio;
            weight[n] = weight[n] * (square * square);
        }
    }
    TYNI_UNROLL
    for (int32_t n = 0; n < 2; n++) {
        v_float low[2], high[2];
        TYNI_UNROLL
        for (int32_t side = 0; side < 2; side++) {
            const v_int entry = q->entry[n][side];
            low[side] = v_to_float(v_iand(entry, ten));
            high[side] = v_to_float(v_iand(v_shr(entry, 10), ten));
            low[side] = weight[2 * n + side] * (low[side] * low[side] * q->scale[n][side][0]);
            high[side] = weight[2 * n + side] * (high[side] * high[side] * q->scale[n][side][1]);
        }
        if (more) {
            weight[2 * n] = s[n].weight + weight[2 * n];
            low[0] = s[n].low + low[0];
            high[0] = s[n].high + high[0];
        }
        s[n].weight = weight[2 * n] + weight[2 * n + 1];
        s[n].low = low[0] + low[1];
        s[n].high = high[0] + high[1];
    }
}

/* The taps of both at their sample, or at both samples beside them. t: NULL where lines run along x; y: the row. */
TYNI_V_INLINE void TYNI_V(pixel_pair_gather)(const tyni_field *f, const tyni_tile *t, int32_t y, int32_t shift,
                                             TYNI_V(pixel_pair) * q, TYNI_V(pixel_sum) s[2])
{
    const int32_t beyond = y & ((1 << shift) - 1), both = t ? beyond : shift, row = t ? (y >> shift) - t->sample : 0;
    v_float part[2];
    TYNI_UNROLL
    for (int32_t n = 0; n < 2; n++) {
        if (t)
            q->along[n] = v_set((float)beyond) * (1.0f / (float)(1 << shift));
        part[n] = 1.0f - q->along[n];
    }
    if (t)
        TYNI_V(pixel_pair_down)(t->row[row] - t->low, q);
    else
        TYNI_V(pixel_pair_along)(f, shift, 0, q);
    TYNI_V(pixel_pair_taps)(q, f->threshold, both ? part : NULL, 0, s);
    if (both) {
        if (t)
            TYNI_V(pixel_pair_down)(t->row[tyni_mini(row + 1, f->pitch - 1 - t->sample)] - t->low, q);
        else
            TYNI_V(pixel_pair_along)(f, shift, 1, q);
        TYNI_V(pixel_pair_taps)(q, f->threshold, q->along, 1, s);
    }
}

/* pixel_unwarp of two vectors after the other, as long as there are two whole ones and they are of that kind. Returns where it
 * stopped. */
static TYNI_V_TARGET TYNI_NOINLINE int32_t TYNI_V(pixel_unwarp_pairs)(const tyni_pass *p, const tyni_run *r,
                                                                      const tyni_sector *sector, const tyni_tile *t,
                                                                      int32_t first, int32_t end)
{
    const int32_t shift = shift_of(&p->slices);
    int32_t i = first;
    for (; v_n > 1 && (t || !sector->along_y) && end - i >= 2 * v_n; i += 2 * v_n) {
        TYNI_V(pixel_pair) q;
        TYNI_V(pixel_sum) s[2];
        v_mask wanted[2];
        const int inside = TYNI_V(pixel_pair_samples)(r->x + i, shift, p->lines.pitch, &q);
        if (!TYNI_V(pixel_pair_lines)(p->lines.scales, r->value[0] + i, sector->start, sector->count - 2, &q))
            break;
        TYNI_UNROLL
        for (int32_t n = 0; n < 2; n++) {
            const v_float to = v_load(r->to + i + n * v_n);
            wanted[n] = v_gt(to, v_set(0.0f));
            q.at[n] = v_max(to * v_load(r->nearness + i + n * v_n), v_set(TYNI_ENTRY_NEAREST));
        }
        if (t) {
            const int32_t low = tyni_mini(q.low[0], q.low[1]), high = tyni_maxi(q.low[0] + q.span[0], q.low[1] + q.span[1]) + 1;
            if (low < t->low || high >= t->low + t->count)
                break;
        } else if (!inside) {
            break;
        }
        if (shift)
            TYNI_V(pixel_pair_gather)(&p->lines, t, r->y, shift, &q, s);
        else /* the same, known beforehand */
            TYNI_V(pixel_pair_gather)(&p->lines, t, r->y, 0, &q, s);
        TYNI_UNROLL
        for (int32_t n = 0; n < 2; n++) {
            const v_mask fits = v_mand(wanted[n], v_gt(s[n].weight, v_set(TYNI_GATHER_ENOUGH)));
            const v_float scale = 1.0f / (s[n].weight * (1023.0f * 1023.0f));
            v_store(r->value[0] + i + n * v_n, v_select(fits, s[n].low * scale, v_set(0.0f)));
            v_store(r->value[1] + i + n * v_n, v_select(fits, s[n].high * scale, v_set(0.0f)));
            for (uint32_t bits = v_word(v_mandnot(wanted[n], fits)); bits; bits &= bits - 1) {
                const int32_t j = i + n * v_n + tyni_ctz32(bits);
                r->rejected[j >> 5] |= 1u << (j & 31);
            }
        }
    }
    return i;
}
