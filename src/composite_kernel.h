/* composite_kernel.h - a template: formats in and out, for composite.c. */

/* Up to v_n pixels from p on, n of them there. */
TYNI_V_INLINE void TYNI_V(composite_load)(tyn_format format, const uint8_t *p, int32_t n, v_float rgb[3])
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
        rgb[0] = v_gather(tyni_composite_srgb, v_ior(v_shl(r5, 3), v_shr(r5, 2)));
        rgb[1] = v_gather(tyni_composite_srgb, v_ior(v_shl(g6, 2), v_shr(g6, 4)));
        rgb[2] = v_gather(tyni_composite_srgb, v_ior(v_shl(b5, 3), v_shr(b5, 2)));
    } else {
        const int32_t red = format == TYN_BGRA8_SRGB ? 2 : 0;
        rgb[0] = v_gather_bytes(tyni_composite_srgb, p, red);
        rgb[1] = v_gather_bytes(tyni_composite_srgb, p, 1);
        rgb[2] = v_gather_bytes(tyni_composite_srgb, p, 2 - red);
    }
}

static TYNI_V_TARGET void TYNI_V(composite_read)(tyn_format format, const uint8_t *p, int32_t count, float *const rgb[3])
{
    const ptrdiff_t bytes = tyn_format_bytes(format);
    for (int32_t i = 0; i < count; i += v_n) {
        v_float v[3];
        TYNI_V(composite_load)(format, p + bytes * i, count - i, v);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            v_store_n(rgb[c] + i, v[c], count - i);
    }
}

/* 0 .. 1 linear to 0 .. 1 encoded (IEC 61966-2-1), within 2e-6: the mantissa's power is a polynomial, the exponent's a table.
 * The channels go term by term: each is one long chain, and one after the other they would be waited for. */
TYNI_V_INLINE void TYNI_V(composite_encode)(v_float rgb[3])
{
    static const float term[4] = {0.202089757f, -0.482285205f, 0.946032156f, 0.378249163f};
    v_float m[3], p[3];
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        m[c] = v_from_bits(v_ior(v_iand(v_bits(rgb[c]), v_iset(0x7fffff)), v_iset(0x3f800000)));
        p[c] = 0.0051434881f * m[c] - 0.0492275911f;
    }
    TYNI_UNROLL
    for (int32_t i = 0; i < 4; i++) {
        const v_float more = v_set(term[i]);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            p[c] = p[c] * m[c] + more;
    }
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        p[c] = p[c] * v_pick16(octave, v_iand(v_shr(v_bits(rgb[c]), 23), v_iset(15))) - 0.055f;
        rgb[c] = v_select(v_le(rgb[c], v_set(0.0031308f)), 12.92f * rgb[c], p[c]);
    }
}

TYNI_V_INLINE v_int TYNI_V(composite_level)(v_float encoded, float levels, v_float offset)
{
    return v_trunc(encoded * levels + offset);
}

/* Up to v_n pixels from p on, n of them there, exposed. x: the first one's. row: its row of the dither matrix. */
TYNI_V_INLINE void TYNI_V(composite_save)(tyn_format format, tyn_tone tone, uint8_t *p, int32_t x, int32_t n, v_float rgb[3],
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
    TYNI_V(composite_encode)(rgb);
    if (format == TYN_RGB565_SRGB) {
        const v_int r = TYNI_V(composite_level)(rgb[0], 31.0f, offset), g = TYNI_V(composite_level)(rgb[1], 63.0f, offset);
        const v_int b = TYNI_V(composite_level)(rgb[2], 31.0f, offset);
        v_store_u16_n((uint16_t *)(void *)p, v_ior(v_ior(v_shl(r, 11), v_shl(g, 5)), b), n);
    } else {
        const v_int r = TYNI_V(composite_level)(rgb[0], 255.0f, offset), g = TYNI_V(composite_level)(rgb[1], 255.0f, offset);
        const v_int b = TYNI_V(composite_level)(rgb[2], 255.0f, offset), a = v_iset(255);
        if (format == TYN_BGRA8_SRGB)
            v_store_rgba8_n(p, b, g, r, a, n);
        else
            v_store_rgba8_n(p, r, g, b, a, n);
    }
}

static TYNI_V_TARGET void TYNI_V(composite_write)(tyn_format format, const tyn_display *display, uint8_t *p, int32_t x,
                                                  int32_t count, float *const rgb[3], const float row[24])
{
    const ptrdiff_t bytes = tyn_format_bytes(format);
    const float exposure = display->exposure > 0.0f ? display->exposure : 1.0f;
    for (int32_t i = 0; i < count; i += v_n) {
        v_float v[3];
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            v[c] = v_load_n(rgb[c] + i, count - i) * exposure;
        TYNI_V(composite_save)(format, display->tone, p + bytes * i, x + i, count - i, v, row);
    }
}

/* from: NULL for black. */
static TYNI_V_TARGET void TYNI_V(composite_blend)(tyn_format format, const tyn_display *display, uint8_t *p,
                                                  tyn_format from_format, const uint8_t *from, int32_t x, int32_t count,
                                                  float *const share[3], float *const light[3], const float row[24])
{
    const ptrdiff_t bytes = tyn_format_bytes(format), from_bytes = tyn_format_bytes(from_format);
    const float exposure = display->exposure > 0.0f ? display->exposure : 1.0f;
    for (int32_t i = 0; i < count; i += v_n) {
        const int32_t n = count - i;
        v_float v[3] = {v_set(0.0f), v_set(0.0f), v_set(0.0f)};
        if (from)
            TYNI_V(composite_load)(from_format, from + from_bytes * i, n, v);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            v[c] = (v_load_n(share[c] + i, n) * v[c] + v_load_n(light[c] + i, n)) * exposure;
        TYNI_V(composite_save)(format, display->tone, p + bytes * i, x + i, n, v, row);
    }
}
