/* avx2.h - the operations of lanes.h in AVX2: eight lanes. A mask is all ones or all zeros a lane. */
#ifndef TYNI_LANES_AVX2_H
#define TYNI_LANES_AVX2_H

#include <immintrin.h>

#include "base.h"

#define TYNI_AVX2_OP static inline __attribute__((always_inline, target("avx2,bmi,bmi2,popcnt")))
#define TYNI_LANES_TARGET_avx2 __attribute__((target("avx2,bmi,bmi2,popcnt")))

enum { tyni_avx2_n = 8 };
typedef __m256 tyni_avx2_float;
typedef __m256i tyni_avx2_int;
typedef __m256i tyni_avx2_mask;

TYNI_AVX2_OP __m256 tyni_avx2_set(float x)
{
    return _mm256_set1_ps(x);
}
TYNI_AVX2_OP __m256i tyni_avx2_iset(int32_t x)
{
    return _mm256_set1_epi32(x);
}
TYNI_AVX2_OP __m256i tyni_avx2_index(void)
{
    return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
}

/* ---- floats ---- */

TYNI_AVX2_OP __m256 tyni_avx2_sqrt(__m256 x)
{
    return _mm256_sqrt_ps(x);
}
/* minps and maxps are a < b ? a : b and a > b ? a : b, for NaN and zeros too */
TYNI_AVX2_OP __m256 tyni_avx2_min(__m256 a, __m256 b)
{
    return _mm256_min_ps(a, b);
}
TYNI_AVX2_OP __m256 tyni_avx2_max(__m256 a, __m256 b)
{
    return _mm256_max_ps(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_lt(__m256 a, __m256 b)
{
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
}
TYNI_AVX2_OP __m256i tyni_avx2_le(__m256 a, __m256 b)
{
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
TYNI_AVX2_OP __m256i tyni_avx2_eq(__m256 a, __m256 b)
{
    return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_EQ_OQ));
}
TYNI_AVX2_OP __m256i tyni_avx2_iselect(__m256i m, __m256i a, __m256i b)
{
    return _mm256_blendv_epi8(b, a, m);
}
TYNI_AVX2_OP __m256 tyni_avx2_select(__m256i m, __m256 a, __m256 b)
{
    return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(m));
}

/* ---- integers ---- */

TYNI_AVX2_OP __m256i tyni_avx2_iadd(__m256i a, __m256i b)
{
    return _mm256_add_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_isub(__m256i a, __m256i b)
{
    return _mm256_sub_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_imul(__m256i a, __m256i b)
{
    return _mm256_mullo_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_ilt(__m256i a, __m256i b)
{
    return _mm256_cmpgt_epi32(b, a);
}
TYNI_AVX2_OP __m256i tyni_avx2_ieq(__m256i a, __m256i b)
{
    return _mm256_cmpeq_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_imin(__m256i a, __m256i b)
{
    return _mm256_min_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_imax(__m256i a, __m256i b)
{
    return _mm256_max_epi32(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_iand(__m256i a, __m256i b)
{
    return _mm256_and_si256(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_ior(__m256i a, __m256i b)
{
    return _mm256_or_si256(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_ixor(__m256i a, __m256i b)
{
    return _mm256_xor_si256(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_iandnot(__m256i a, __m256i b)
{
    return _mm256_andnot_si256(b, a);
}
TYNI_AVX2_OP __m256i tyni_avx2_shl(__m256i x, int32_t n)
{
    return _mm256_sll_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_AVX2_OP __m256i tyni_avx2_shr(__m256i x, int32_t n)
{
    return _mm256_srl_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_AVX2_OP __m256i tyni_avx2_sar(__m256i x, int32_t n)
{
    return _mm256_sra_epi32(x, _mm_cvtsi32_si128(n));
}

/* ---- from one to the other ---- */

TYNI_AVX2_OP __m256i tyni_avx2_bits(__m256 x)
{
    return _mm256_castps_si256(x);
}
TYNI_AVX2_OP __m256 tyni_avx2_from_bits(__m256i x)
{
    return _mm256_castsi256_ps(x);
}
TYNI_AVX2_OP __m256i tyni_avx2_trunc(__m256 x)
{
    return _mm256_cvttps_epi32(x);
}
TYNI_AVX2_OP __m256 tyni_avx2_to_float(__m256i x)
{
    return _mm256_cvtepi32_ps(x);
}

/* ---- masks ---- */

TYNI_AVX2_OP __m256i tyni_avx2_mand(__m256i a, __m256i b)
{
    return _mm256_and_si256(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_mor(__m256i a, __m256i b)
{
    return _mm256_or_si256(a, b);
}
TYNI_AVX2_OP __m256i tyni_avx2_mandnot(__m256i a, __m256i b)
{
    return _mm256_andnot_si256(b, a);
}
TYNI_AVX2_OP uint32_t tyni_avx2_word(__m256i m)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(m));
}
TYNI_AVX2_OP __m256i tyni_avx2_first(int32_t n)
{
    return _mm256_cmpgt_epi32(_mm256_set1_epi32(n), tyni_avx2_index());
}

/* ---- memory ---- */

TYNI_AVX2_OP __m256 tyni_avx2_load(const float *p)
{
    return _mm256_loadu_ps(p);
}
TYNI_AVX2_OP void tyni_avx2_store(float *p, __m256 x)
{
    _mm256_storeu_ps(p, x);
}
TYNI_AVX2_OP __m256i tyni_avx2_iload(const void *p)
{
    return _mm256_loadu_si256((const __m256i *)p);
}
TYNI_AVX2_OP void tyni_avx2_istore(void *p, __m256i x)
{
    _mm256_storeu_si256((__m256i *)p, x);
}
TYNI_AVX2_OP void tyni_avx2_istore_where(void *p, __m256i m, __m256i x)
{
    tyni_avx2_istore(p, tyni_avx2_iselect(m, x, tyni_avx2_iload(p)));
}
TYNI_AVX2_OP __m256i tyni_avx2_iload_n(const void *p, int32_t n)
{
    return n >= 8 ? tyni_avx2_iload(p) : _mm256_maskload_epi32((const int *)p, tyni_avx2_first(n));
}
TYNI_AVX2_OP void tyni_avx2_istore_n(void *p, __m256i x, int32_t n)
{
    if (n >= 8)
        tyni_avx2_istore(p, x);
    else
        _mm256_maskstore_epi32((int *)p, tyni_avx2_first(n), x);
}
TYNI_AVX2_OP __m256 tyni_avx2_load_n(const float *p, int32_t n)
{
    return _mm256_castsi256_ps(tyni_avx2_iload_n(p, n));
}
TYNI_AVX2_OP void tyni_avx2_store_n(float *p, __m256 x, int32_t n)
{
    tyni_avx2_istore_n(p, _mm256_castps_si256(x), n);
}
TYNI_AVX2_OP void tyni_avx2_store_where(float *p, __m256i m, __m256 x)
{
    _mm256_storeu_ps(p, tyni_avx2_select(m, x, _mm256_loadu_ps(p))); /* masked stores are slow on some */
}
TYNI_AVX2_OP __m256i tyni_avx2_load_u8(const uint8_t *p)
{
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
TYNI_AVX2_OP __m256i tyni_avx2_load_u16(const uint16_t *p)
{
    return _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}
TYNI_AVX2_OP __m128i tyni_avx2_pack16(__m256i x)
{
    const __m256i low = _mm256_and_si256(x, _mm256_set1_epi32(65535));
    return _mm_packus_epi32(_mm256_castsi256_si128(low), _mm256_extracti128_si256(low, 1));
}
TYNI_AVX2_OP void tyni_avx2_store_u16(uint16_t *p, __m256i x)
{
    _mm_storeu_si128((__m128i *)(void *)p, tyni_avx2_pack16(x));
}
TYNI_AVX2_OP void tyni_avx2_store_u8(uint8_t *p, __m256i x)
{
    const __m128i words = tyni_avx2_pack16(_mm256_and_si256(x, _mm256_set1_epi32(255)));
    _mm_storel_epi64((__m128i *)(void *)p, _mm_packus_epi16(words, words));
}
/* Loads and inserts: see avx512.h. */
TYNI_AVX2_OP __m128i tyni_avx2_four(const uint8_t *base, const int32_t *bytes)
{
    int32_t x[4];
    memcpy(&x[0], base + bytes[0], 4);
    memcpy(&x[1], base + bytes[1], 4);
    memcpy(&x[2], base + bytes[2], 4);
    memcpy(&x[3], base + bytes[3], 4);
    return _mm_setr_epi32(x[0], x[1], x[2], x[3]);
}
TYNI_AVX2_OP __m256i tyni_avx2_igather(const void *base, __m256i bytes)
{
    int32_t at[8];
    _mm256_storeu_si256((__m256i *)(void *)at, bytes);
    return _mm256_inserti128_si256(_mm256_castsi128_si256(tyni_avx2_four(base, at)), tyni_avx2_four(base, at + 4), 1);
}
TYNI_AVX2_OP __m256i tyni_avx2_iload_apart(const void *p, int32_t bytes)
{
    const int32_t at[4] = {0, bytes, 2 * bytes, 3 * bytes};
    const uint8_t *base = p;
    return _mm256_inserti128_si256(_mm256_castsi128_si256(tyni_avx2_four(base, at)), tyni_avx2_four(base + 4 * bytes, at), 1);
}
TYNI_AVX2_OP __m256 tyni_avx2_pick(const float *base, __m256i index)
{
    return _mm256_permutevar8x32_ps(_mm256_loadu_ps(base), index);
}
TYNI_AVX2_OP __m256i tyni_avx2_ipick(const void *base, __m256i index)
{
    return _mm256_permutevar8x32_epi32(tyni_avx2_iload(base), index);
}
/* Both halves of the table, and bit 3 of the index says which. */
TYNI_AVX2_OP __m256 tyni_avx2_pick16(const float *base, __m256i index)
{
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(base), index);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(base + 8), index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
}
TYNI_AVX2_OP __m256 tyni_avx2_gather(const float *base, __m256i index)
{
    return _mm256_castsi256_ps(tyni_avx2_igather(base, _mm256_slli_epi32(index, 2)));
}
TYNI_AVX2_OP __m256i tyni_avx2_words_of(const uint16_t *table, const uint8_t *p)
{
    __m128i x = _mm_cvtsi32_si128(table[p[0]]);
    x = _mm_insert_epi16(x, (int16_t)table[p[4]], 1);
    x = _mm_insert_epi16(x, (int16_t)table[p[8]], 2);
    x = _mm_insert_epi16(x, (int16_t)table[p[12]], 3);
    x = _mm_insert_epi16(x, (int16_t)table[p[16]], 4);
    x = _mm_insert_epi16(x, (int16_t)table[p[20]], 5);
    x = _mm_insert_epi16(x, (int16_t)table[p[24]], 6);
    x = _mm_insert_epi16(x, (int16_t)table[p[28]], 7);
    return _mm256_cvtepu16_epi32(x);
}
TYNI_AVX2_OP void tyni_avx2_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], __m256i out[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        out[c] = tyni_avx2_words_of(table, p + byte[c]);
}
TYNI_AVX2_OP __m256i tyni_avx2_igather_where(const void *base, __m256i bytes, __m256i m)
{
    return _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), (const int *)base, bytes, m, 1);
}
/* SSE2's shuffles in both halves, which then change places. */
TYNI_AVX2_OP void tyni_avx2_store_rgb(float *p, __m256 r, __m256 g, __m256 b)
{
    const __m256 rg0 = _mm256_unpacklo_ps(r, g), rg1 = _mm256_unpackhi_ps(r, g); /* r0 g0 r1 g1, r2 g2 r3 g3 */
    const __m256 b0r1 = _mm256_shuffle_ps(b, r, 0x50);                           /* b0 b0 r1 r1 */
    const __m256 g1b1 = _mm256_shuffle_ps(g, b, 0x55);                           /* g1 g1 b1 b1 */
    const __m256 b2r3 = _mm256_shuffle_ps(b, r, 0xfa), g3b3 = _mm256_shuffle_ps(g, b, 0xff);
    const __m256 x = _mm256_shuffle_ps(rg0, b0r1, 0x84);  /* r0 g0 b0 r1 */
    const __m256 y = _mm256_shuffle_ps(g1b1, rg1, 0x48);  /* g1 b1 r2 g2 */
    const __m256 z = _mm256_shuffle_ps(b2r3, g3b3, 0x88); /* b2 r3 g3 b3 */
    _mm256_storeu_ps(p, _mm256_permute2f128_ps(x, y, 0x20));
    _mm256_storeu_ps(p + 8, _mm256_permute2f128_ps(z, x, 0x30));
    _mm256_storeu_ps(p + 16, _mm256_permute2f128_ps(y, z, 0x31));
}
TYNI_AVX2_OP void tyni_avx2_load_rgb(const float *p, __m256 *r, __m256 *g, __m256 *b)
{
    const __m256 v0 = _mm256_loadu_ps(p), v1 = _mm256_loadu_ps(p + 8), v2 = _mm256_loadu_ps(p + 16);
    const __m256 x = _mm256_permute2f128_ps(v0, v1, 0x30), y = _mm256_permute2f128_ps(v0, v2, 0x21),
                 z = _mm256_permute2f128_ps(v1, v2, 0x30);
    const __m256 r23 = _mm256_shuffle_ps(y, z, 0x12); /* y2 y0 z1 z0: r2 . r3 . */
    const __m256 g01 = _mm256_shuffle_ps(x, y, 0x01); /* x1 x0 y0 y0: g0 . g1 . */
    const __m256 g23 = _mm256_shuffle_ps(y, z, 0x23); /* y3 y0 z2 z0: g2 . g3 . */
    const __m256 b01 = _mm256_shuffle_ps(x, y, 0x12); /* x2 x0 y1 y0: b0 . b1 . */
    *r = _mm256_shuffle_ps(_mm256_shuffle_ps(x, x, 0x30), r23, 0x88);
    *g = _mm256_shuffle_ps(g01, g23, 0x88);
    *b = _mm256_shuffle_ps(b01, _mm256_shuffle_ps(z, z, 0x30), 0x88);
}
TYNI_AVX2_OP uint32_t tyni_avx2_above16(const uint16_t *t, uint32_t position)
{
    const __m256i p = _mm256_set1_epi16((int16_t)(uint16_t)position), zero = _mm256_setzero_si256();
    const __m256i *v = (const __m256i *)(const void *)t;
    const __m256i a = _mm256_cmpeq_epi16(_mm256_subs_epu16(_mm256_loadu_si256(v), p), zero);
    const __m256i b = _mm256_cmpeq_epi16(_mm256_subs_epu16(_mm256_loadu_si256(v + 1), p), zero);
    return ~(uint32_t)_mm256_movemask_epi8(_mm256_permute4x64_epi64(_mm256_packs_epi16(a, b), 0xd8));
}

TYNI_AVX2_OP int32_t tyni_avx2_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    tyni_scalar_list64(out, from, bits);
    return __builtin_popcountll(bits);
}

TYNI_AVX2_OP float tyni_avx2_halves(__m256 x)
{
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

TYNI_AVX2_OP void tyni_avx2_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
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
