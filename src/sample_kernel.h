/* sample_kernel.h - a template: samples of a line side by side, for sample.c. */

/* Of float metres along the forward axis. What the next slices read is asked for: along y each sample has a line of memory of
 * its own, which they share; along x they read rows below. */
static TYNI_V_TARGET void TYNI_V(sample_depths)(float *depth, const tyni_slice *slice, const tyni_view *view,
                                                const tyni_door *door, int32_t last_p, int32_t last_m)
{
    const int32_t stride = (int32_t)door->stride, along = slice->along_y ? stride : 4, across = slice->along_y ? 4 : stride;
    const int32_t ahead = slice->along_y ? 16 : 8;
    const v_float far = v_set(view->far_depth), zero = v_set(0.0f);
    for (int32_t j = slice->first; j <= slice->last; j += v_n) {
        const int32_t n = slice->last - j + 1;
        /* lanes behind the last sample read it again */
        const v_int sample = v_imin(v_iadd(v_iset(j), v_index()), v_iset(slice->last));
        const v_float at = slice->p0 + v_to_float(sample) * slice->dp;
        const v_int p = v_trunc(v_clamp(at, zero, v_set((float)last_p)));
        const v_int m = v_trunc(v_clamp(slice->m0 + slice->slope * at, zero, v_set((float)last_m)));
        int32_t p0[v_n], m0[v_n], next[v_n];
        const uint8_t *base = door->image->pixels;
        v_int bytes;
        v_float z;
        v_istore(p0, p);
        v_istore(m0, m);
        base += (ptrdiff_t)along * p0[0] + (ptrdiff_t)across * m0[0];
        bytes = v_iadd(v_imul(v_isub(p, v_iset(p0[0])), v_iset(along)), v_imul(v_isub(m, v_iset(m0[0])), v_iset(across)));
        z = v_from_bits(v_igather(base, bytes));
        v_istore(next, v_iadd(bytes, v_imul(v_imin(v_iset(ahead), v_isub(v_iset(last_m), m)), v_iset(across))));
        for (int32_t i = 0; i < v_n && v_n > 1; i += slice->along_y ? 1 : 4)
            TYNI_PREFETCH(base + next[i]);
        z = v_select(v_lt(z, far), z, far);
        v_store_n(depth + j, v_select(v_gt(z, zero), z, zero), n);
    }
}

/* The farthest along ex that a ray of the line ends. */
static TYNI_V_TARGET float TYNI_V(sample_reach)(const float *depth, const tyni_slice *slice, const tyni_view *view)
{
    const float a = tyni_vec_dot(slice->a, slice->ex), b = tyni_vec_dot(slice->b, slice->ex);
    const float ahead = tyni_vec_dot(view->forward, slice->ex);
    const int flat = view->orthographic;
    v_float most = v_set(-3e38f);
    for (int32_t j = slice->first; j <= slice->last; j += v_n) {
        /* lanes behind the last sample are the last again */
        const v_int sample = v_imin(v_iadd(v_iset(j), v_index()), v_iset(slice->last));
        const v_float x = a + b * (slice->p0 + v_to_float(sample) * slice->dp);
        v_float s = v_load_n(depth + j, slice->last - j + 1);
        s = v_select(v_first(slice->last - j + 1), s, v_set(depth[slice->last]));
        most = v_max(flat ? x + s * ahead : x * s, most);
    }
    return v_hmax(most);
}

static TYNI_V_TARGET void TYNI_V(sample_breaks)(uint32_t *breaks, const float *depth, int32_t first, int32_t last,
                                                float threshold)
{
    for (int32_t w = 0; w <= last >> 5; w++) {
        uint32_t bits = 0;
        for (int32_t i = 0; i < 32; i += v_n) {
            const v_float a = v_load_n(depth + 32 * w + i, last + 1 - (32 * w + i));
            const v_float b = v_load_n(depth + 32 * w + i + 1, last - (32 * w + i));
            bits |= v_word(v_gt(v_abs(a - b), threshold * v_min(a, b))) << i;
        }
        /* first .. last - 1 alone */
        if (w == first >> 5)
            bits &= 0xffffffffu << (first & 31);
        if (w < first >> 5)
            bits = 0;
        if (w == last >> 5)
            bits &= (1u << (last & 31)) - 1u;
        breaks[w] = bits;
    }
}

/* Rays in hand, at least; so many more may be. */
#define RAYS 64
/* Of a ray's place: a break follows. The rest is samples from the first in hand; a line has no more than pixels. */
#define BREAK 0x8000
typedef char TYNI_V(places_fit)[TYN_MAX_SIZE <= BREAK ? 1 : -1];

/* Adds rays from word w on to `place` until there are RAYS or no more. Returns how many; moves w behind them. */
TYNI_V_INLINE int32_t TYNI_V(sample_list)(const uint32_t *rays, const uint32_t *breaks, int32_t *w, int32_t last, int32_t base,
                                          uint16_t *place, int32_t n)
{
    for (; 32 * *w <= last && n < RAYS; *w += 2) {
        const int two = 32 * *w + 32 <= last;
        const uint64_t bits = rays[*w] | (uint64_t)(two ? rays[*w + 1] : 0) << 32;
        const uint64_t ends = breaks[*w] | (uint64_t)(two ? breaks[*w + 1] : 0) << 32;
        uint16_t all[64];
        for (int32_t i = 0; i < 64; i += v_n) {
            const v_int p = v_iadd(v_iset(32 * *w - base + i), v_index());
            v_store_u16(all + i, v_iselect(v_unword((uint32_t)(ends >> i)), v_ior(p, v_iset(BREAK)), p));
        }
        n += v_pack64(place + n, all, bits);
    }
    return n;
}

/* refine_from where all rays are fresh: three by three side by side. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(sample_bends)(uint32_t *fresh, const uint32_t *rays, const uint32_t *breaks,
                                                             float *const value[3], int32_t values, int32_t first, int32_t last,
                                                             float tolerance, int32_t least)
{
    const v_int none = v_iset(0), samples = v_iset(BREAK - 1), four = v_iset(4);
    float v[3][RAYS + 64 + 16];
    uint16_t place[RAYS + 64 + 64];
    int32_t base = first, w = first >> 5, n = 1;
    place[0] = BREAK; /* there is none before the first */
    while (32 * w <= last) {
        n = TYNI_V(sample_list)(rays, breaks, &w, last, base, place, n);
        for (int32_t k = 0; k < n; k += v_n) {
            const v_int at = v_iselect(v_first(n - k), v_iand(v_load_u16(place + k), samples), none);
            for (int32_t c = 0; c < values; c++)
                v_store(v[c] + k, v_gather(value[c] + base, at));
        }
        for (int32_t i = 1; i + 1 < n; i += v_n) {
            const v_int p = v_load_u16(place + i - 1), q = v_load_u16(place + i), r = v_load_u16(place + i + 1);
            const v_int a = v_iand(p, samples), b = v_iand(q, samples), c = v_iand(r, samples);
            const v_float near = v_to_float(v_isub(b, a)), far = v_to_float(v_isub(c, a)), most = tolerance * far;
            const v_mask before = v_igt(p, samples), after = v_igt(q, samples);
            const v_mask end = v_mor(v_igt(r, samples), v_ieq(c, v_iset(last - base)));
            const v_mask alone = v_mand(v_mandnot(v_mand(before, end), after), v_igt(v_isub(c, b), four));
            uint32_t bits, bent;
            v_mask off = v_first(0);
            for (int32_t k = 0; k < values; k++) { /* as bent() has it */
                const v_float x = v_load(v[k] + i - 1), y = v_load(v[k] + i), z = v_load(v[k] + i + 1);
                const v_float d = (y - x) * far - (z - x) * near;
                off = v_mor(off, v_mor(v_gt(d, most), v_lt(d, -most)));
            }
            off = v_mandnot(v_mandnot(off, before), after);
            bent = v_word(off);
            for (bits = v_word(v_mand(v_mor(off, alone), v_first(n - 1 - i))); bits; bits &= bits - 1) {
                const int32_t k = tyni_ctz32(bits), m = base + (place[i + k] & (BREAK - 1));
                if (bent >> k & 1u)
                    halve(fresh, base + (place[i + k - 1] & (BREAK - 1)), m, least);
                halve(fresh, m, base + (place[i + k + 1] & (BREAK - 1)), least);
            }
        }
        /* the last two begin what is next */
        place[0] = place[n - 2];
        place[1] = place[n - 1];
        n = place[0] & (BREAK - 1);
        place[0] = (uint16_t)(place[0] - n);
        place[1] = (uint16_t)(place[1] - n);
        base += n;
        n = 2;
    }
}

#undef RAYS
#undef BREAK

/* From the last to the first: what is read next then lies before what was written, and no load waits for a store that covers it
 * with lanes that it leaves alone. */
static TYNI_V_TARGET void TYNI_V(sample_interpolate)(float *const value[3], int32_t values, const uint32_t *rays, int32_t first,
                                                     int32_t last)
{
    const v_float one = v_to_float(v_index()) + 1.0f;
    for (int32_t b = last, a; b > first; b = a) {
        a = previous(rays, b, first);
        for (int32_t i = 0; i < values && b - a > 1; i++) {
            float *v = value[i];
            const float from = v[a], step = (v[b] - from) / (float)(b - a);
            for (int32_t j = a + 1; j < b; j += v_n)
                v_store_n(v + j, from + step * (one + (float)(j - a - 1)), b - j);
        }
    }
}
