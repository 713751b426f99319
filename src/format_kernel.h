/* format_kernel.h - a template: pixels of the formats in and out, for the kernels of composite.c and picture.c. */

/* Linear values of three bytes of v_n pixels. */
TYNI_V_INLINE void TYNI_V(format_decode)(const uint8_t *p, const int32_t byte[3], v_float rgb[3])
{
    v_int word[3];
    v_rgb_words(tyni_composite_srgb, p, byte, word);
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        const v_float root = v_to_float(word[c]) * TYNI_COMPOSITE_ROOT;
        rgb[c] = root * root;
    }
}

/* Up to v_n pixels from p on, n of them there. */
TYNI_V_INLINE void TYNI_V(format_load)(tyn_format format, const uint8_t *p, int32_t n, v_float rgb[3])
{
    float part[3 * v_n] = {0.0f};
    if (n < v_n)
        p = memcpy(part, p, (size_t)tyn_format_bytes(format) * (size_t)n);
    if (format == TYN_RGB_F32) {
        v_load_rgb((const float *)(const void *)p, &rgb[0], &rgb[1], &rgb[2]);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            rgb[c] = v_min(v_max(rgb[c], v_set(0.0f)), v_set(1e30f));
    } else if (format == TYN_RGB565_SRGB) {
        const v_int v = v_load_u16((const uint16_t *)(const void *)p), five = v_iset(31);
        const v_int r5 = v_shr(v, 11), g6 = v_iand(v_shr(v, 5), v_iset(63)), b5 = v_iand(v, five);
        const int32_t byte[3] = {0, 1, 2};
        uint8_t bytes[4 * v_n];
        v_store_rgba8(bytes, v_ior(v_shl(r5, 3), v_shr(r5, 2)), v_ior(v_shl(g6, 2), v_shr(g6, 4)),
                      v_ior(v_shl(b5, 3), v_shr(b5, 2)), five);
        TYNI_V(format_decode)(bytes, byte, rgb);
    } else {
        const int32_t red = format == TYN_BGRA8_SRGB ? 2 : 0, byte[3] = {red, 1, 2 - red};
        TYNI_V(format_decode)(p, byte, rgb);
    }
}

/* n vectors, at most TYNI_CHAINS, from 0 .. 1 linear to 0 .. 1 encoded (IEC 61966-2-1), within 1.1e-5: the mantissa's power is
 * a polynomial, the exponent's a table. They go term by term: each is one long chain, and one after the other they would be
 * waited for. */
TYNI_V_INLINE void TYNI_V(format_encode)(v_float *x, int32_t n)
{
    static const float term[3] = {-0.318287253f, 0.828860164f, 0.411229342f};
    v_float m[TYNI_CHAINS], p[TYNI_CHAINS];
    TYNI_UNROLL_MORE
    for (int32_t c = 0; c < n; c++) {
        m[c] = v_from_bits(v_ior(v_iand(v_bits(x[c]), v_iset(0x7fffff)), v_iset(0x3f800000)));
        p[c] = 0.0890376940f - 0.0108295474f * m[c];
    }
    TYNI_UNROLL
    for (int32_t i = 0; i < 3; i++) {
        const v_float more = v_set(term[i]);
        TYNI_UNROLL_MORE
        for (int32_t c = 0; c < n; c++)
            p[c] = p[c] * m[c] + more;
    }
    TYNI_UNROLL_MORE
    for (int32_t c = 0; c < n; c++) {
        p[c] = p[c] * v_pick16(tyni_composite_octave, v_shr(v_bits(x[c]), 23)) - 0.055f;
        x[c] = v_select(v_le(x[c], v_set(0.0031308f)), 12.92f * x[c], p[c]);
    }
}

TYNI_V_INLINE v_int TYNI_V(format_level)(v_float encoded, float levels, v_float offset)
{
    return v_trunc(encoded * levels + offset);
}

/* Up to v_n pixels from p on, n of them there, exposed. x: the first one's. row: its row of the dither matrix. */
TYNI_V_INLINE void TYNI_V(format_save)(tyn_format format, tyn_tone tone, uint8_t *p, int32_t x, int32_t n, v_float rgb[3],
                                       const float row[24])
{
    const int clamp = format != TYN_RGB_F32 && tone == TYN_TONE_CLAMP;
    const v_float most = v_set(clamp ? 1.0f : 1e30f), offset = v_load(row + (x & 7));
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        rgb[c] = v_min(v_max(rgb[c], v_set(0.0f)), most); /* NaN: 0 */
    if (format == TYN_RGB_F32) {
        v_store_rgb_n((float *)(void *)p, rgb[0], rgb[1], rgb[2], n);
        return;
    }
    if (tone == TYN_TONE_FILM) {
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            rgb[c] = 1.0f - v_exp(-rgb[c]);
    }
    TYNI_V(format_encode)(rgb, 3);
    if (format == TYN_RGB565_SRGB) {
        const v_int r = TYNI_V(format_level)(rgb[0], 31.0f, offset), g = TYNI_V(format_level)(rgb[1], 63.0f, offset);
        const v_int b = TYNI_V(format_level)(rgb[2], 31.0f, offset);
        v_store_u16_n((uint16_t *)(void *)p, v_ior(v_ior(v_shl(r, 11), v_shl(g, 5)), b), n);
    } else {
        const v_int r = TYNI_V(format_level)(rgb[0], 255.0f, offset), g = TYNI_V(format_level)(rgb[1], 255.0f, offset);
        const v_int b = TYNI_V(format_level)(rgb[2], 255.0f, offset), a = v_iset(255);
        if (format == TYN_BGRA8_SRGB)
            v_store_rgba8_n(p, b, g, r, a, n);
        else
            v_store_rgba8_n(p, r, g, b, a, n);
    }
}
