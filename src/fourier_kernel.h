/* fourier_kernel.h - a template: the bases of a column, for fourier.c. */

/* Sines, then cosines, of pi (2 k + 1) z for k = 0 .. half - 1. */
static TYNI_V_TARGET void TYNI_V(fourier_waves)(float z, int32_t half, float *wave)
{
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
