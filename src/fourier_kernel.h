/* fourier_kernel.h - a template: the bases of a column, for fourier.c. */

/* Sines, then cosines, of pi (2 k + 1) z for k = 0 .. half - 1, z of a column's threshold: just below it. */
static TYNI_V_TARGET void TYNI_V(fourier_waves)(const tyni_fourier *f, const tyni_shelf *s, uint32_t threshold, float *wave)
{
    const float z = TYNI_V(fourier_z)(f, s, (float)threshold - 0.5f);
    const int32_t half = f->bases / 2;
    for (int32_t k = 0; k < half; k += v_n) {
        v_float sine, cosine;
        v_sincos(TYNI_PI * z * (2.0f * (v_to_float(v_index()) + (float)k) + 1.0f), &sine, &cosine);
        v_store_n(wave + k, sine, half - k);
        v_store_n(wave + half + k, cosine, half - k);
    }
}

/* sum[k] += scale * wave[k] */
static TYNI_V_TARGET void TYNI_V(fourier_add)(float *sum, const float *wave, float scale, int32_t count)
{
    for (int32_t k = 0; k < count; k += v_n) {
        const int32_t n = count - k;
        v_store_n(sum + k, v_load_n(sum + k, n) + scale * v_load_n(wave + k, n), n);
    }
}

/* sum times part, -127 .. 127, to the nearest. */
static TYNI_V_TARGET void TYNI_V(fourier_bytes)(const float *sum, float part, int32_t count, uint8_t *out)
{
    for (int32_t k = 0; k < count; k += v_n) {
        const int32_t n = count - k;
        const v_float x = v_clamp(v_load_n(sum + k, n) * part, v_set(-127.0f), v_set(127.0f)) + 0.5f;
        v_store_u8_n(out + k, v_floori(x), n);
    }
}
