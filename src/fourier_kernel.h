/* fourier_kernel.h - a template: sums over the bases of columns, for fourier.c. */

/* sum[k] += scale * wave[k] */
static TYNI_V_TARGET void TYNI_V(fourier_add)(float *sum, const float *wave, float scale, int32_t count)
{
    for (int32_t k = 0; k < count; k += v_n) {
        const int32_t n = count - k;
        v_store_n(sum + k, v_load_n(sum + k, n) + scale * v_load_n(wave + k, n), n);
    }
}

/* out[i]: the sum of a[k] b[k] over the bases of row i, `pitch` bytes from one to the next. Whole numbers: in any order. */
static TYNI_V_TARGET void TYNI_V(fourier_dots)(const int32_t *a, const uint8_t *b, int32_t rows, int32_t pitch, int32_t count,
                                               int32_t *out)
{
    for (int32_t i = 0; i < rows; i++, b += pitch) {
        v_int sum = v_iset(0);
        for (int32_t k = 0; k < count; k += v_n) {
            const int32_t n = count - k;
            sum = v_iadd(sum, v_imul(v_iload_n(a + k, n), v_load_u8_n(b + k, n)));
        }
        out[i] = v_isum(sum);
    }
}
