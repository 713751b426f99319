/* composite_kernel.h - a template: formats in and out, for composite.c. */

TYNI_V_INLINE v_float TYNI_V(composite_decode)(v_int byte)
{
    return v_gather(srgb, v_iand(byte, v_iset(255)));
}

static TYNI_V_TARGET void TYNI_V(composite_read)(tyn_format format, const uint8_t *p, int32_t count, float *const rgb[3])
{
    const int32_t red = format == TYN_BGRA8_SRGB ? 16 : 0;
    for (int32_t i = 0; i < count; i += v_n) {
        const int32_t n = count - i;
        v_float r, g, b;
        if (format == TYN_RGB_F32) {
            const v_float zero = v_set(0.0f), most = v_set(1e30f);
            float part[3 * v_n] = {0.0f};
            memcpy(part, (const float *)(const void *)p + 3 * (ptrdiff_t)i, sizeof *part * 3u * (size_t)tyni_mini(n, v_n));
            v_load_rgb(part, &r, &g, &b);
            r = v_clamp(r, zero, most);
            g = v_clamp(g, zero, most);
            b = v_clamp(b, zero, most);
        } else if (format == TYN_RGB565_SRGB) {
            const v_int v = v_load_u16_n((const uint16_t *)(const void *)p + i, n), five = v_iset(31);
            const v_int r5 = v_shr(v, 11), g6 = v_iand(v_shr(v, 5), v_iset(63)), b5 = v_iand(v, five);
            r = TYNI_V(composite_decode)(v_ior(v_shl(r5, 3), v_shr(r5, 2)));
            g = TYNI_V(composite_decode)(v_ior(v_shl(g6, 2), v_shr(g6, 4)));
            b = TYNI_V(composite_decode)(v_ior(v_shl(b5, 3), v_shr(b5, 2)));
        } else {
            v_int v[4];
            v_load_rgba8_n(p + 4 * (ptrdiff_t)i, v, n);
            r = TYNI_V(composite_decode)(red ? v[2] : v[0]);
            g = TYNI_V(composite_decode)(v[1]);
            b = TYNI_V(composite_decode)(red ? v[0] : v[2]);
        }
        v_store_n(rgb[0] + i, r, n);
        v_store_n(rgb[1] + i, g, n);
        v_store_n(rgb[2] + i, b, n);
    }
}

/* 0 .. 1 linear to 0 .. 1 encoded (IEC 61966-2-1), within 2e-6: the mantissa's power is a polynomial, the exponent's a table.
 */
TYNI_V_INLINE v_float TYNI_V(composite_encode)(v_float x)
{
    const v_int bits = v_bits(x), e = v_imax(v_isub(v_shr(bits, 23), v_iset(127 - 9)), v_iset(0));
    const v_float m = v_from_bits(v_ior(v_iand(bits, v_iset(0x7fffff)), v_iset(0x3f800000))) - 1.0f;
    v_float p = 0.0054353727f * m - 0.0242401492f, curve;
    p = p * m + 0.0572534576f;
    p = p * m - 0.120175168f;
    p = p * m + 0.41656673f;
    p = p * m + 1.00000119f;
    curve = p * v_pick16(octave, v_imin(e, v_iset(9))) - 0.055f;
    return v_select(v_le(x, v_set(0.0031308f)), 12.92f * x, curve);
}

TYNI_V_INLINE v_float TYNI_V(composite_tone)(v_float x, tyn_tone tone)
{
    if (tone == TYN_TONE_FILM)
        return 1.0f - v_exp(-x);
    return v_min(x, v_set(1.0f));
}

TYNI_V_INLINE v_int TYNI_V(composite_level)(v_float encoded, float levels, v_float offset)
{
    return v_trunc(v_clamp(encoded * levels + offset, v_set(0.0f), v_set(levels)));
}

static TYNI_V_TARGET void TYNI_V(composite_write)(tyn_format format, const tyn_display *display, uint8_t *p, int32_t x,
                                                  int32_t count, float *const rgb[3], const float row[24])
{
    const float exposure = display->exposure > 0.0f ? display->exposure : 1.0f;
    for (int32_t i = 0; i < count; i += v_n) {
        const int32_t n = count - i;
        const float *offsets = row + ((x + i) & 7);
        v_float v[3], offset;
        for (int32_t c = 0; c < 3; c++)
            v[c] = v_clamp(v_load_n(rgb[c] + i, n) * exposure, v_set(0.0f), v_set(1e30f));
        if (format == TYN_RGB_F32) {
            v_store_rgb_n((float *)(void *)p + 3 * (ptrdiff_t)i, v[0], v[1], v[2], n);
            continue;
        }
        offset = v_load(offsets);
        for (int32_t c = 0; c < 3; c++)
            v[c] = TYNI_V(composite_encode)(TYNI_V(composite_tone)(v[c], display->tone));
        if (format == TYN_RGB565_SRGB) {
            const v_int r = TYNI_V(composite_level)(v[0], 31.0f, offset), g = TYNI_V(composite_level)(v[1], 63.0f, offset);
            const v_int b = TYNI_V(composite_level)(v[2], 31.0f, offset);
            v_store_u16_n((uint16_t *)(void *)p + i, v_ior(v_ior(v_shl(r, 11), v_shl(g, 5)), b), n);
        } else {
            const v_int r = TYNI_V(composite_level)(v[0], 255.0f, offset), g = TYNI_V(composite_level)(v[1], 255.0f, offset);
            const v_int b = TYNI_V(composite_level)(v[2], 255.0f, offset), a = v_iset(255);
            uint8_t *to = p + 4 * (ptrdiff_t)i;
            if (format == TYN_BGRA8_SRGB)
                v_store_rgba8_n(to, b, g, r, a, n);
            else
                v_store_rgba8_n(to, r, g, b, a, n);
        }
    }
}
