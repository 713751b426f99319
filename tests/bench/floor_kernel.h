/* floor_kernel.h - a template: depth and colour in, a picture out, and nothing else. */

static TYNI_V_TARGET void TYNI_V(bench_floor)(const float *depth, const uint32_t *from, uint32_t *to, int32_t count)
{
    for (int32_t i = 0; i < count; i += v_n) {
        const int32_t n = count - i;
        const v_mask near = v_gt(v_load_n(depth + i, n), v_set(1.0f));
        const v_int colour = v_iload_n(from + i, n);
        v_istore_n(to + i, v_iselect(near, colour, v_ixor(colour, v_iset(-1))), n);
    }
}
