/* door_kernel.h - a template: texels of shadow maps side by side, for the kernels of other rooms. */

/* tyni_texels_z of what is stored */
TYNI_V_INLINE v_float TYNI_V(door_z)(const tyni_texels *t, v_float stored)
{
    const v_float z = (stored - t->end) * t->step, zero = v_set(0.0f);
    if (t->inverse)
        return v_select(v_mand(v_gt(z, zero), v_lt(z, v_set(t->limit))), 1.0f / v_max(z, v_set(1e-6f)), zero);
    return v_select(v_gt(z, zero), v_min(z, v_set(1.0f)), zero);
}

/* Depths of the texels at these offsets, all of them inside the map. */
TYNI_V_INLINE v_float TYNI_V(door_texels)(const tyni_texels *t, v_int offset)
{
    if (t->bytes == 2) {
        int32_t offsets[v_n];
        float out[v_n];
        v_istore(offsets, offset);
        for (int32_t i = 0; i < v_n; i++) /* one by one: a vector's load would read beyond the last */
            out[i] = (float)*(const uint16_t *)(const void *)(t->pixels + offsets[i]);
        return TYNI_V(door_z)(t, v_load(out));
    }
    return TYNI_V(door_z)(t, v_from_bits(v_igather(t->pixels, offset)));
}
