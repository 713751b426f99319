/* pass_kernel.h - a template: a line's samples into memory, for pass.c. */

static TYNI_V_TARGET void TYNI_V(pass_largest)(const float *value, int32_t first, int32_t last, float *largest)
{
    v_float most = v_set(0.0f);
    for (int32_t j = first; j <= last; j += v_n)
        most = v_max(v_load_n(value + j, last - j + 1), most);
    *largest = v_hmax(most);
}

/* 10 bits of a square root. */
TYNI_V_INLINE v_int TYNI_V(pass_root)(v_float value, float inverse)
{
    return v_trunc(v_sqrt(v_clamp(value * inverse, v_set(0.0f), v_set(1.0f))) * 1023.0f + 0.5f);
}

/* tyni_entry_pack; samples of depth 0 stay what they are. */
static TYNI_V_TARGET void TYNI_V(pass_pack)(uint32_t *entries, const tyni_scratch *s, int32_t first, int32_t last,
                                            const float inverse[2], float far_inverse)
{
    for (int32_t j = first; j <= last; j += v_n) {
        const int32_t n = last - j + 1;
        const v_float depth = v_load_n(s->depth + j, n);
        const v_int bits = v_bits(depth * far_inverse), floor = v_iset((int32_t)TYNI_ENTRY_FLOOR), one = v_iset(1);
        const v_int steps = v_iadd(v_shr(v_isub(bits, floor), 15), one);
        const v_int code = v_iselect(v_igt(bits, floor), steps, one);
        const v_int low = TYNI_V(pass_root)(v_load_n(s->value[0] + j, n), inverse[0]);
        const v_int high = TYNI_V(pass_root)(v_load_n(s->value[1] + j, n), inverse[1]);
        const v_int entry = v_ior(v_ior(low, v_shl(high, 10)), v_shl(code, 20));
        v_istore_n(entries + j, v_iselect(v_gt(depth, v_set(0.0f)), entry, v_iset(0)), n);
    }
}
