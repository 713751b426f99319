/* picture_kernel.h - a template: from visibility to the picture at once, for picture.c. Planes have room for whole vectors. */

/* A channel of a vector is a chain of a hundred operations that wait for one another, and what a core looks ahead is hardly
 * longer: two vectors go together, and their six chains step by step. */
#define CHAINS TYNI_CHAINS
#define VECTORS (CHAINS / 3)

/* medium_mix of the vectors; what is the same for all pixels is known before. */
TYNI_V_INLINE void TYNI_V(picture_mix)(const tyni_picture *q, const v_float cosine[VECTORS], v_float mix[CHAINS])
{
    const tyni_medium *m = &q->medium;
    TYNI_UNROLL_MORE
    for (int32_t n = 0; n < CHAINS; n++)
        mix[n] = m->isotropic[n % 3] + m->rayleigh[n % 3] * (1.0f + cosine[n / 3] * cosine[n / 3]);
    for (int32_t i = 0; i < m->hg_count; i++) {
        v_float f[VECTORS];
        TYNI_UNROLL
        for (int32_t k = 0; k < VECTORS; k++) {
            const v_float d = v_max(q->base[i] + q->slope[i] * (1.0f - cosine[k]), v_set(1e-12f));
            f[k] = 1.0f / (d * v_sqrt(d));
        }
        TYNI_UNROLL_MORE
        for (int32_t n = 0; n < CHAINS; n++)
            mix[n] = mix[n] + m->hg[i].scale[n % 3] * f[n / 3];
    }
}

/* Exposed colours to words of the target. x: of each vector's first pixel. */
TYNI_V_INLINE void TYNI_V(picture_encode)(const tyni_picture *q, const int32_t x[VECTORS], v_float rgb[CHAINS],
                                          v_int out[VECTORS])
{
    const int32_t film = q->tone == TYN_TONE_FILM;
    const v_float most = v_set(film ? 1e30f : 1.0f);
    TYNI_UNROLL_MORE
    for (int32_t n = 0; n < CHAINS; n++)
        rgb[n] = v_min(v_max(rgb[n], v_set(0.0f)), most);
    if (film) {
        TYNI_UNROLL_MORE
        for (int32_t n = 0; n < CHAINS; n++)
            rgb[n] = 1.0f - v_exp(-rgb[n]);
    }
    TYNI_V(format_encode)(rgb, CHAINS);
    TYNI_UNROLL
    for (int32_t k = 0; k < VECTORS; k++) {
        const v_float offset = v_load(q->offset + (x[k] & 7));
        out[k] = v_iset(q->opaque);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            out[k] = v_ior(out[k], v_shl(TYNI_V(format_level)(rgb[3 * k + c], 255.0f, offset), q->shift[c]));
    }
}

/* Light and what is left of the surfaces, added. The bits are those of pixel_shade and composite_blend one after the other;
 * what they hand on by planes stays in registers here. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_picture)(const tyni_run *r, const tyni_picture *q)
{
    /* a copy is none of what is written */
    const int32_t byte[3] = {q->from_byte[0], q->from_byte[1], q->from_byte[2]};
    for (int32_t i = 0; i < r->count && v_n > 1; i += VECTORS * v_n) { /* one lane has too few registers to gain */
        uint8_t part[VECTORS][4 * v_n];
        v_float to[VECTORS], cosine[VECTORS], mix[CHAINS], rgb[CHAINS], left[CHAINS], lost[CHAINS];
        v_int out[VECTORS];
        int32_t at[VECTORS], x[VECTORS];
        TYNI_UNROLL
        for (int32_t k = 0; k < VECTORS; k++) {
            at[k] = i + k * v_n < r->count ? i + k * v_n : i; /* where there is no second vector it is the first again */
            x[k] = r->x + at[k];
            to[k] = v_load(r->to + at[k]);
            rgb[3 * k] = v_load(r->value[0] + at[k]);
            rgb[3 * k + 1] = v_load(r->value[1] + at[k]);
            rgb[3 * k + 2] = (q->between[0] * rgb[3 * k] + q->between[1] * rgb[3 * k + 1]) +
                             q->between[2] * v_sqrt(rgb[3 * k] * rgb[3 * k + 1]);
            cosine[k] = v_load(r->cosine + at[k]);
        }
        TYNI_V(picture_mix)(q, cosine, mix);
        TYNI_UNROLL_MORE
        for (int32_t n = 0; n < CHAINS; n++)
            left[n] = q->medium.sigma[n % 3] * to[n / 3];
        v_fades(left, CHAINS, left, lost);
        TYNI_UNROLL_MORE
        for (int32_t n = 0; n < CHAINS; n++) {
            const v_float light = rgb[n] * (lost[n] * q->inverse[n % 3]) * (mix[n] * q->colour[n % 3]);
            rgb[n] = v_select(v_gt(to[n / 3], v_set(0.0f)), light, v_set(0.0f));
        }
        TYNI_UNROLL
        for (int32_t k = 0; k < VECTORS; k++) {
            const uint8_t *from = q->from + 4 * (ptrdiff_t)at[k];
            v_float surface[3];
            if (r->count - at[k] < v_n)
                from = memcpy(memset(part[k], 0, sizeof part[k]), from, 4 * (size_t)(r->count - at[k]));
            TYNI_V(format_decode)(from, byte, surface);
            TYNI_UNROLL
            for (int32_t c = 0; c < 3; c++)
                rgb[3 * k + c] = (left[3 * k + c] * surface[c] + rgb[3 * k + c]) * q->exposure;
        }
        TYNI_V(picture_encode)(q, x, rgb, out);
        TYNI_UNROLL
        for (int32_t k = 0; k < VECTORS; k++)
            v_istore_n(q->target + 4 * (ptrdiff_t)at[k], out[k], r->count - at[k]);
    }
}

#undef CHAINS
#undef VECTORS
