/* avx512.h - the operations of lanes.h in AVX-512 (F, BW, DQ, VL, VBMI2: since Ice Lake and Zen 4): sixteen lanes. A mask is a
 * bit a lane. */
#ifndef TYNI_LANES_AVX512_H
#define TYNI_LANES_AVX512_H

#include <immintrin.h>

#include "base.h"

#define TYNI_AVX512_FEATURES target("avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi2,bmi,bmi2,popcnt")
#define TYNI_AVX512_OP static inline __attribute__((always_inline, TYNI_AVX512_FEATURES))
#define TYNI_LANES_TARGET_avx512 __attribute__((TYNI_AVX512_FEATURES))

enum { tyni_avx512_n = 16 };
typedef __m512 tyni_avx512_float;
typedef __m512i tyni_avx512_int;
typedef __mmask16 tyni_avx512_mask;

TYNI_AVX512_OP __m512 tyni_avx512_set(float x)
{
    return _mm512_set1_ps(x);
}
TYNI_AVX512_OP __m512i tyni_avx512_iset(int32_t x)
{
    return _mm512_set1_epi32(x);
}
TYNI_AVX512_OP __m512i tyni_avx512_index(void)
{
    return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/* ---- floats ---- */

TYNI_AVX512_OP __m512 tyni_avx512_sqrt(__m512 x)
{
    return _mm512_sqrt_ps(x);
}
/* vminps and vmaxps are a < b ? a : b and a > b ? a : b, for NaN and zeros too */
TYNI_AVX512_OP __m512 tyni_avx512_min(__m512 a, __m512 b)
{
    return _mm512_min_ps(a, b);
}
TYNI_AVX512_OP __m512 tyni_avx512_max(__m512 a, __m512 b)
{
    return _mm512_max_ps(a, b);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_lt(__m512 a, __m512 b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_le(__m512 a, __m512 b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_eq(__m512 a, __m512 b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ);
}
TYNI_AVX512_OP __m512 tyni_avx512_select(__mmask16 m, __m512 a, __m512 b)
{
    return _mm512_mask_blend_ps(m, b, a);
}

/* ---- integers ---- */

TYNI_AVX512_OP __m512i tyni_avx512_iadd(__m512i a, __m512i b)
{
    return _mm512_add_epi32(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_isub(__m512i a, __m512i b)
{
    return _mm512_sub_epi32(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_imul(__m512i a, __m512i b)
{
    return _mm512_mullo_epi32(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_imin(__m512i a, __m512i b)
{
    return _mm512_min_epi32(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_imax(__m512i a, __m512i b)
{
    return _mm512_max_epi32(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_iand(__m512i a, __m512i b)
{
    return _mm512_and_si512(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_ior(__m512i a, __m512i b)
{
    return _mm512_or_si512(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_ixor(__m512i a, __m512i b)
{
    return _mm512_xor_si512(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_iandnot(__m512i a, __m512i b)
{
    return _mm512_andnot_si512(b, a);
}
TYNI_AVX512_OP __m512i tyni_avx512_shl(__m512i x, int32_t n)
{
    return _mm512_sll_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_AVX512_OP __m512i tyni_avx512_shr(__m512i x, int32_t n)
{
    return _mm512_srl_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_AVX512_OP __m512i tyni_avx512_sar(__m512i x, int32_t n)
{
    return _mm512_sra_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_AVX512_OP __mmask16 tyni_avx512_ilt(__m512i a, __m512i b)
{
    return _mm512_cmplt_epi32_mask(a, b);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_ieq(__m512i a, __m512i b)
{
    return _mm512_cmpeq_epi32_mask(a, b);
}
TYNI_AVX512_OP __m512i tyni_avx512_iselect(__mmask16 m, __m512i a, __m512i b)
{
    return _mm512_mask_blend_epi32(m, b, a);
}

/* ---- from one to the other ---- */

TYNI_AVX512_OP __m512i tyni_avx512_bits(__m512 x)
{
    return _mm512_castps_si512(x);
}
TYNI_AVX512_OP __m512 tyni_avx512_from_bits(__m512i x)
{
    return _mm512_castsi512_ps(x);
}
TYNI_AVX512_OP __m512i tyni_avx512_trunc(__m512 x)
{
    return _mm512_cvttps_epi32(x);
}
TYNI_AVX512_OP __m512 tyni_avx512_to_float(__m512i x)
{
    return _mm512_cvtepi32_ps(x);
}

/* ---- masks ---- */

TYNI_AVX512_OP __mmask16 tyni_avx512_mand(__mmask16 a, __mmask16 b)
{
    return (__mmask16)(a & b);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_mor(__mmask16 a, __mmask16 b)
{
    return (__mmask16)(a | b);
}
TYNI_AVX512_OP __mmask16 tyni_avx512_mandnot(__mmask16 a, __mmask16 b)
{
    return (__mmask16)(a & ~b);
}
TYNI_AVX512_OP uint32_t tyni_avx512_word(__mmask16 m)
{
    return m;
}
TYNI_AVX512_OP __mmask16 tyni_avx512_first(int32_t n)
{
    return n >= 16 ? (__mmask16)0xffff : n > 0 ? (__mmask16)((1u << n) - 1u) : (__mmask16)0;
}

/* ---- memory ---- */

TYNI_AVX512_OP __m512 tyni_avx512_load(const float *p)
{
    return _mm512_loadu_ps(p);
}
TYNI_AVX512_OP void tyni_avx512_store(float *p, __m512 x)
{
    _mm512_storeu_ps(p, x);
}
TYNI_AVX512_OP __m512 tyni_avx512_load_n(const float *p, int32_t n)
{
    return _mm512_maskz_loadu_ps(tyni_avx512_first(n), p);
}
TYNI_AVX512_OP void tyni_avx512_store_n(float *p, __m512 x, int32_t n)
{
    _mm512_mask_storeu_ps(p, tyni_avx512_first(n), x);
}
/* Not a masked store: a load that follows it at once would wait for memory. */
TYNI_AVX512_OP void tyni_avx512_store_where(float *p, __mmask16 m, __m512 x)
{
    _mm512_storeu_ps(p, _mm512_mask_blend_ps(m, _mm512_loadu_ps(p), x));
}
TYNI_AVX512_OP __m512i tyni_avx512_iload(const void *p)
{
    return _mm512_loadu_si512(p);
}
TYNI_AVX512_OP void tyni_avx512_istore(void *p, __m512i x)
{
    _mm512_storeu_si512(p, x);
}
TYNI_AVX512_OP void tyni_avx512_istore_where(void *p, __mmask16 m, __m512i x)
{
    _mm512_storeu_si512(p, _mm512_mask_blend_epi32(m, _mm512_loadu_si512(p), x));
}
TYNI_AVX512_OP __m512i tyni_avx512_iload_n(const void *p, int32_t n)
{
    return _mm512_maskz_loadu_epi32(tyni_avx512_first(n), p);
}
TYNI_AVX512_OP void tyni_avx512_istore_n(void *p, __m512i x, int32_t n)
{
    _mm512_mask_storeu_epi32(p, tyni_avx512_first(n), x);
}
TYNI_AVX512_OP __m512i tyni_avx512_load_u8(const uint8_t *p)
{
    return _mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}
TYNI_AVX512_OP __m512i tyni_avx512_load_u16(const uint16_t *p)
{
    return _mm512_cvtepu16_epi32(_mm256_loadu_si256((const __m256i *)(const void *)p));
}
TYNI_AVX512_OP void tyni_avx512_store_u8(uint8_t *p, __m512i x)
{
    _mm_storeu_si128((__m128i *)(void *)p, _mm512_cvtepi32_epi8(x));
}
TYNI_AVX512_OP void tyni_avx512_store_u16(uint16_t *p, __m512i x)
{
    _mm256_storeu_si256((__m256i *)(void *)p, _mm512_cvtepi32_epi16(x));
}
TYNI_AVX512_OP __m512 tyni_avx512_pick16(const float *base, __m512i index)
{
    return _mm512_permutexvar_ps(index, _mm512_loadu_ps(base));
}
/* Loads and inserts: the machine's own gathers take three times as long on Zen 4 and are no faster elsewhere. */
TYNI_AVX512_OP __m128i tyni_avx512_four(const uint8_t *base, const int32_t *bytes)
{
    int32_t x[4];
    memcpy(&x[0], base + bytes[0], 4);
    memcpy(&x[1], base + bytes[1], 4);
    memcpy(&x[2], base + bytes[2], 4);
    memcpy(&x[3], base + bytes[3], 4);
    return _mm_setr_epi32(x[0], x[1], x[2], x[3]);
}
TYNI_AVX512_OP __m512i tyni_avx512_igather(const void *base, __m512i bytes)
{
    int32_t at[16];
    __m256i low, high;
    _mm512_storeu_si512(at, bytes);
    low = _mm256_castsi128_si256(tyni_avx512_four(base, at));
    low = _mm256_inserti128_si256(low, tyni_avx512_four(base, at + 4), 1);
    high = _mm256_castsi128_si256(tyni_avx512_four(base, at + 8));
    high = _mm256_inserti128_si256(high, tyni_avx512_four(base, at + 12), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
TYNI_AVX512_OP __m512i tyni_avx512_iload_apart(const void *p, int32_t bytes)
{
    const int32_t at[4] = {0, bytes, 2 * bytes, 3 * bytes};
    const uint8_t *base = p;
    __m256i low = _mm256_castsi128_si256(tyni_avx512_four(base, at));
    __m256i high = _mm256_castsi128_si256(tyni_avx512_four(base + 8 * bytes, at));
    low = _mm256_inserti128_si256(low, tyni_avx512_four(base + 4 * bytes, at), 1);
    high = _mm256_inserti128_si256(high, tyni_avx512_four(base + 12 * bytes, at), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
/* 64 entries a shuffle, and of four such the right one by the index's two upper bits. Index: the low byte of each word. */
TYNI_AVX512_OP __m512i tyni_avx512_words32(const uint16_t *table, __m512i index)
{
    const __mmask32 m64 = _mm512_test_epi16_mask(index, _mm512_set1_epi16(64));
    const __mmask32 m128 = _mm512_test_epi16_mask(index, _mm512_set1_epi16(128));
    __m512i part[4];
    TYNI_UNROLL
    for (int32_t i = 0; i < 4; i++)
        part[i] = _mm512_permutex2var_epi16(_mm512_loadu_si512(table + 64 * i), index, _mm512_loadu_si512(table + 64 * i + 32));
    part[0] = _mm512_mask_blend_epi16(m64, part[0], part[1]);
    part[2] = _mm512_mask_blend_epi16(m64, part[2], part[3]);
    return _mm512_mask_blend_epi16(m128, part[0], part[2]);
}
/* The bytes in order are low and high halves of words: so there are two channels at a time, for a fifth of what loads cost. */
TYNI_AVX512_OP void tyni_avx512_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], __m512i out[3])
{
    const __m512i order = _mm512_set1_epi32((int32_t)0x80000000u | byte[0] | byte[1] << 16 | byte[2] << 8);
    const __m512i pixel = _mm512_setr_epi32(0, 0x00040404, 0x00080808, 0x000c0c0c, 0, 0x00040404, 0x00080808, 0x000c0c0c, 0,
                                            0x00040404, 0x00080808, 0x000c0c0c, 0, 0x00040404, 0x00080808, 0x000c0c0c);
    const __m512i bytes = _mm512_shuffle_epi8(_mm512_loadu_si512(p), _mm512_or_si512(order, pixel));
    const __m512i two = tyni_avx512_words32(table, bytes), third = tyni_avx512_words32(table, _mm512_srli_epi16(bytes, 8));
    out[0] = _mm512_and_si512(two, _mm512_set1_epi32(65535));
    out[1] = _mm512_srli_epi32(two, 16);
    out[2] = _mm512_and_si512(third, _mm512_set1_epi32(65535));
}
TYNI_AVX512_OP __m512 tyni_avx512_gather(const float *base, __m512i index)
{
    return _mm512_castsi512_ps(tyni_avx512_igather(base, _mm512_slli_epi32(index, 2)));
}
TYNI_AVX512_OP __m512 tyni_avx512_pick(const float *base, __m512i index)
{
    return _mm512_permutexvar_ps(index, _mm512_loadu_ps(base));
}
TYNI_AVX512_OP __m512i tyni_avx512_ipick(const void *base, __m512i index)
{
    return _mm512_permutexvar_epi32(index, _mm512_loadu_si512(base));
}
/* Without an optimiser it is a macro, whose conversions are the compiler's own. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"
TYNI_AVX512_OP __m512i tyni_avx512_igather_where(const void *base, __m512i bytes, __mmask16 m)
{
    return _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), m, bytes, base, 1);
}
#pragma GCC diagnostic pop
TYNI_AVX512_OP void tyni_avx512_store_rgb(float *p, __m512 r, __m512 g, __m512 b)
{
    const __m512i rg0 = _mm512_setr_epi32(0, 16, 0, 1, 17, 1, 2, 18, 2, 3, 19, 3, 4, 20, 4, 5);
    const __m512i b0 = _mm512_setr_epi32(0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
    const __m512i rg1 = _mm512_setr_epi32(21, 5, 6, 22, 6, 7, 23, 7, 8, 24, 8, 9, 25, 9, 10, 26);
    const __m512i b1 = _mm512_setr_epi32(0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
    const __m512i rg2 = _mm512_setr_epi32(10, 11, 27, 11, 12, 28, 12, 13, 29, 13, 14, 30, 14, 15, 31, 15);
    const __m512i b2 = _mm512_setr_epi32(26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
    _mm512_storeu_ps(p + 0, _mm512_permutex2var_ps(_mm512_permutex2var_ps(r, rg0, g), b0, b));
    _mm512_storeu_ps(p + 16, _mm512_permutex2var_ps(_mm512_permutex2var_ps(r, rg1, g), b1, b));
    _mm512_storeu_ps(p + 32, _mm512_permutex2var_ps(_mm512_permutex2var_ps(r, rg2, g), b2, b));
}
TYNI_AVX512_OP void tyni_avx512_load_rgb(const float *p, __m512 *r, __m512 *g, __m512 *b)
{
    const __m512 x = _mm512_loadu_ps(p), y = _mm512_loadu_ps(p + 16), z = _mm512_loadu_ps(p + 32);
    const __m512i xy0 = _mm512_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 0, 0, 0, 0, 0);
    const __m512i z0 = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 17, 20, 23, 26, 29);
    const __m512i xy1 = _mm512_setr_epi32(1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 0, 0, 0, 0, 0);
    const __m512i z1 = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 18, 21, 24, 27, 30);
    const __m512i xy2 = _mm512_setr_epi32(2, 5, 8, 11, 14, 17, 20, 23, 26, 29, 0, 0, 0, 0, 0, 0);
    const __m512i z2 = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 19, 22, 25, 28, 31);
    *r = _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy0, y), z0, z);
    *g = _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy1, y), z1, z);
    *b = _mm512_permutex2var_ps(_mm512_permutex2var_ps(x, xy2, y), z2, z);
}
TYNI_AVX512_OP uint32_t tyni_avx512_above16(const uint16_t *t, uint32_t position)
{
    return _mm512_cmplt_epu16_mask(_mm512_set1_epi16((int16_t)(uint16_t)position), _mm512_loadu_si512(t));
}

/* VBMI2's compression, of places, and then a shuffle. */
TYNI_AVX512_OP int32_t tyni_avx512_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    static const uint8_t ramp[64] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21,
                                     22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43,
                                     44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63};
    const __m512i low = _mm512_loadu_si512(from), high = _mm512_loadu_si512(from + 32);
    const __m512i place = _mm512_maskz_compress_epi8(_cvtu64_mask64(bits), _mm512_loadu_si512(ramp));
    const int32_t n = __builtin_popcountll(bits);
    _mm512_storeu_si512(out, _mm512_permutex2var_epi16(low, _mm512_cvtepu8_epi16(_mm512_castsi512_si256(place)), high));
    if (n > 32)
        _mm512_storeu_si512(out + 32,
                            _mm512_permutex2var_epi16(low, _mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(place, 1)), high));
    return n;
}

TYNI_AVX512_OP float tyni_avx512_halves(__m512 x)
{
    const __m256 eight = _mm256_add_ps(_mm512_castps512_ps256(x), _mm512_extractf32x8_ps(x, 1));
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

TYNI_AVX512_OP void tyni_avx512_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    __m256i s0 = _mm256_setzero_si256(), s1 = s0, s2 = s0, s3 = s0, low, high;
    for (int32_t i = 0; i < n; i += 16) {
        const __m256i v = _mm256_loadu_si256((const __m256i *)(const void *)(a + i));
        const __m256i w0 = _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i *)(const void *)(b[0] + i)));
        const __m256i w1 = _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i *)(const void *)(b[1] + i)));
        const __m256i w2 = _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i *)(const void *)(b[2] + i)));
        const __m256i w3 = _mm256_cvtepi8_epi16(_mm_loadu_si128((const __m128i *)(const void *)(b[3] + i)));
        s0 = _mm256_add_epi32(s0, _mm256_madd_epi16(v, w0));
        s1 = _mm256_add_epi32(s1, _mm256_madd_epi16(v, w1));
        s2 = _mm256_add_epi32(s2, _mm256_madd_epi16(v, w2));
        s3 = _mm256_add_epi32(s3, _mm256_madd_epi16(v, w3));
    }
    low = _mm256_add_epi32(_mm256_unpacklo_epi32(s0, s1), _mm256_unpackhi_epi32(s0, s1));
    high = _mm256_add_epi32(_mm256_unpacklo_epi32(s2, s3), _mm256_unpackhi_epi32(s2, s3));
    low = _mm256_add_epi32(_mm256_unpacklo_epi64(low, high), _mm256_unpackhi_epi64(low, high));
    _mm_storeu_si128((__m128i *)(void *)out, _mm_add_epi32(_mm256_castsi256_si128(low), _mm256_extracti128_si256(low, 1)));
}

#endif
