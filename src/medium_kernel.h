/* medium_kernel.h - a template: phase functions side by side, for the kernels of other rooms. */

/* tyni_medium_mix of each cosine. */
TYNI_V_INLINE void TYNI_V(medium_mix)(const tyni_medium *m, v_float cosine, v_float mix[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        mix[c] = m->isotropic[c] + m->rayleigh[c] * (1.0f + cosine * cosine);
    for (int32_t i = 0; i < m->hg_count; i++) {
        const float g = m->hg[i].g;
        const v_float d = v_max((1.0f - g) * (1.0f - g) + (2.0f * g) * (1.0f - cosine), v_set(1e-12f));
        const v_float f = 1.0f / (d * v_sqrt(d));
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            mix[c] = mix[c] + m->hg[i].scale[c] * f;
    }
}
