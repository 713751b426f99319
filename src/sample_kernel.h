/* sample_kernel.h - a template: samples of a line side by side, for sample.c. */

/* Of float metres along the forward axis. */
static TYNI_V_TARGET void TYNI_V(sample_depths)(float *depth, const tyni_slice *slice, const tyni_view *view,
                                                const tyni_door *door, int32_t last_p, int32_t last_m)
{
    const int32_t stride = (int32_t)door->stride, along = slice->along_y ? stride : 4, across = slice->along_y ? 4 : stride;
    const v_float far = v_set(view->far_depth), zero = v_set(0.0f);
    for (int32_t j = slice->first; j <= slice->last; j += v_n) {
        const int32_t n = slice->last - j + 1;
        /* lanes behind the last sample read it again */
        const v_int sample = v_imin(v_iadd(v_iset(j), v_index()), v_iset(slice->last));
        const v_float at = slice->p0 + v_to_float(sample) * slice->dp;
        const v_int p = v_trunc(v_clamp(at, zero, v_set((float)last_p)));
        const v_int m = v_trunc(v_clamp(slice->m0 + slice->slope * at, zero, v_set((float)last_m)));
        int32_t p0[v_n], m0[v_n];
        const uint8_t *base = door->image->pixels;
        v_float z;
        v_istore(p0, p);
        v_istore(m0, m);
        base += (ptrdiff_t)along * p0[0] + (ptrdiff_t)across * m0[0];
        z = v_from_bits(v_igather(
            base, v_iadd(v_imul(v_isub(p, v_iset(p0[0])), v_iset(along)), v_imul(v_isub(m, v_iset(m0[0])), v_iset(across)))));
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
