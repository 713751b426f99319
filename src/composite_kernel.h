/* composite_kernel.h - a template: rows of pixels, for composite.c. */

static TYNI_V_TARGET void TYNI_V(composite_read)(tyn_format format, const uint8_t *p, int32_t count, float *const rgb[3])
{
    const ptrdiff_t bytes = tyn_format_bytes(format);
    for (int32_t i = 0; i < count; i += v_n) {
        v_float v[3];
        TYNI_V(format_load)(format, p + bytes * i, count - i, v);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            v_store_n(rgb[c] + i, v[c], count - i);
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
        TYNI_V(format_save)(format, display->tone, p + bytes * i, x + i, count - i, v, row);
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
            TYNI_V(format_load)(from_format, from + from_bytes * i, n, v);
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            v[c] = (v_load_n(share[c] + i, n) * v[c] + v_load_n(light[c] + i, n)) * exposure;
        TYNI_V(format_save)(format, display->tone, p + bytes * i, x + i, n, v, row);
    }
}
