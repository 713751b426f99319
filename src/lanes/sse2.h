/* sse2.h - the operations of lanes.h in SSE2: four lanes. A mask is all ones or all zeros a lane. */
#ifndef TYNI_LANES_SSE2_H
#define TYNI_LANES_SSE2_H

#include <emmintrin.h>

#include "base.h"

#define TYNI_SSE2_OP static inline __attribute__((always_inline, target("sse2")))
#define TYNI_LANES_TARGET_sse2 __attribute__((target("sse2")))

enum { tyni_sse2_n = 4 };
typedef __m128 tyni_sse2_float;
typedef __m128i tyni_sse2_int;
typedef __m128i tyni_sse2_mask;

TYNI_SSE2_OP __m128 tyni_sse2_set(float x)
{
    return _mm_set1_ps(x);
}
TYNI_SSE2_OP __m128i tyni_sse2_iset(int32_t x)
{
    return _mm_set1_epi32(x);
}
TYNI_SSE2_OP __m128i tyni_sse2_index(void)
{
    return _mm_setr_epi32(0, 1, 2, 3);
}

/* ---- floats ---- */

TYNI_SSE2_OP __m128 tyni_sse2_sqrt(__m128 x)
{
    return _mm_sqrt_ps(x);
}
/* minps and maxps are a < b ? a : b and a > b ? a : b, for NaN and zeros too */
TYNI_SSE2_OP __m128 tyni_sse2_min(__m128 a, __m128 b)
{
    return _mm_min_ps(a, b);
}
TYNI_SSE2_OP __m128 tyni_sse2_max(__m128 a, __m128 b)
{
    return _mm_max_ps(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_lt(__m128 a, __m128 b)
{
    return _mm_castps_si128(_mm_cmplt_ps(a, b));
}
TYNI_SSE2_OP __m128i tyni_sse2_le(__m128 a, __m128 b)
{
    return _mm_castps_si128(_mm_cmple_ps(a, b));
}
TYNI_SSE2_OP __m128i tyni_sse2_eq(__m128 a, __m128 b)
{
    return _mm_castps_si128(_mm_cmpeq_ps(a, b));
}
TYNI_SSE2_OP __m128i tyni_sse2_iselect(__m128i m, __m128i a, __m128i b)
{
    return _mm_or_si128(_mm_and_si128(m, a), _mm_andnot_si128(m, b));
}
TYNI_SSE2_OP __m128 tyni_sse2_select(__m128i m, __m128 a, __m128 b)
{
    const __m128 f = _mm_castsi128_ps(m);
    return _mm_or_ps(_mm_and_ps(f, a), _mm_andnot_ps(f, b));
}

/* ---- integers ---- */

TYNI_SSE2_OP __m128i tyni_sse2_iadd(__m128i a, __m128i b)
{
    return _mm_add_epi32(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_isub(__m128i a, __m128i b)
{
    return _mm_sub_epi32(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_imul(__m128i a, __m128i b)
{
    const __m128i even = _mm_mul_epu32(a, b), odd = _mm_mul_epu32(_mm_srli_si128(a, 4), _mm_srli_si128(b, 4));
    return _mm_unpacklo_epi32(_mm_shuffle_epi32(even, 0x08), _mm_shuffle_epi32(odd, 0x08));
}
TYNI_SSE2_OP __m128i tyni_sse2_ilt(__m128i a, __m128i b)
{
    return _mm_cmpgt_epi32(b, a);
}
TYNI_SSE2_OP __m128i tyni_sse2_ieq(__m128i a, __m128i b)
{
    return _mm_cmpeq_epi32(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_imin(__m128i a, __m128i b)
{
    return tyni_sse2_iselect(tyni_sse2_ilt(a, b), a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_imax(__m128i a, __m128i b)
{
    return tyni_sse2_iselect(tyni_sse2_ilt(a, b), b, a);
}
TYNI_SSE2_OP __m128i tyni_sse2_iand(__m128i a, __m128i b)
{
    return _mm_and_si128(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_ior(__m128i a, __m128i b)
{
    return _mm_or_si128(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_ixor(__m128i a, __m128i b)
{
    return _mm_xor_si128(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_iandnot(__m128i a, __m128i b)
{
    return _mm_andnot_si128(b, a);
}
TYNI_SSE2_OP __m128i tyni_sse2_shl(__m128i x, int32_t n)
{
    return _mm_sll_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_SSE2_OP __m128i tyni_sse2_shr(__m128i x, int32_t n)
{
    return _mm_srl_epi32(x, _mm_cvtsi32_si128(n));
}
TYNI_SSE2_OP __m128i tyni_sse2_sar(__m128i x, int32_t n)
{
    return _mm_sra_epi32(x, _mm_cvtsi32_si128(n));
}

/* ---- from one to the other ---- */

TYNI_SSE2_OP __m128i tyni_sse2_bits(__m128 x)
{
    return _mm_castps_si128(x);
}
TYNI_SSE2_OP __m128 tyni_sse2_from_bits(__m128i x)
{
    return _mm_castsi128_ps(x);
}
TYNI_SSE2_OP __m128i tyni_sse2_trunc(__m128 x)
{
    return _mm_cvttps_epi32(x);
}
TYNI_SSE2_OP __m128 tyni_sse2_to_float(__m128i x)
{
    return _mm_cvtepi32_ps(x);
}

/* ---- masks ---- */

TYNI_SSE2_OP __m128i tyni_sse2_mand(__m128i a, __m128i b)
{
    return _mm_and_si128(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_mor(__m128i a, __m128i b)
{
    return _mm_or_si128(a, b);
}
TYNI_SSE2_OP __m128i tyni_sse2_mandnot(__m128i a, __m128i b)
{
    return _mm_andnot_si128(b, a);
}
TYNI_SSE2_OP uint32_t tyni_sse2_word(__m128i m)
{
    return (uint32_t)_mm_movemask_ps(_mm_castsi128_ps(m));
}
TYNI_SSE2_OP __m128i tyni_sse2_first(int32_t n)
{
    return _mm_cmpgt_epi32(_mm_set1_epi32(n), tyni_sse2_index());
}

/* ---- memory ---- */

TYNI_SSE2_OP __m128 tyni_sse2_load(const float *p)
{
    return _mm_loadu_ps(p);
}
TYNI_SSE2_OP void tyni_sse2_store(float *p, __m128 x)
{
    _mm_storeu_ps(p, x);
}
TYNI_SSE2_OP __m128i tyni_sse2_iload(const void *p)
{
    return _mm_loadu_si128((const __m128i *)p);
}
TYNI_SSE2_OP void tyni_sse2_istore(void *p, __m128i x)
{
    _mm_storeu_si128((__m128i *)p, x);
}
TYNI_SSE2_OP void tyni_sse2_istore_where(void *p, __m128i m, __m128i x)
{
    tyni_sse2_istore(p, tyni_sse2_iselect(m, x, tyni_sse2_iload(p)));
}
TYNI_SSE2_OP __m128i tyni_sse2_iload_n(const void *p, int32_t n)
{
    int32_t lane[4] = {0, 0, 0, 0};
    if (n >= 4)
        return tyni_sse2_iload(p);
    for (int32_t i = 0; i < n; i++)
        memcpy(&lane[i], (const uint8_t *)p + 4 * i, 4);
    return tyni_sse2_iload(lane);
}
TYNI_SSE2_OP void tyni_sse2_istore_n(void *p, __m128i x, int32_t n)
{
    int32_t lane[4];
    if (n >= 4) {
        tyni_sse2_istore(p, x);
        return;
    }
    tyni_sse2_istore(lane, x);
    for (int32_t i = 0; i < n; i++)
        memcpy((uint8_t *)p + 4 * i, &lane[i], 4);
}
TYNI_SSE2_OP __m128 tyni_sse2_load_n(const float *p, int32_t n)
{
    return _mm_castsi128_ps(tyni_sse2_iload_n(p, n));
}
TYNI_SSE2_OP void tyni_sse2_store_n(float *p, __m128 x, int32_t n)
{
    tyni_sse2_istore_n(p, _mm_castps_si128(x), n);
}
TYNI_SSE2_OP void tyni_sse2_store_where(float *p, __m128i m, __m128 x)
{
    _mm_storeu_ps(p, tyni_sse2_select(m, x, _mm_loadu_ps(p)));
}
TYNI_SSE2_OP __m128i tyni_sse2_load_u8(const uint8_t *p)
{
    const __m128i zero = _mm_setzero_si128();
    int32_t four;
    memcpy(&four, p, 4);
    return _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(four), zero), zero);
}
TYNI_SSE2_OP __m128i tyni_sse2_load_u16(const uint16_t *p)
{
    return _mm_unpacklo_epi16(_mm_loadl_epi64((const __m128i *)(const void *)p), _mm_setzero_si128());
}
/* Packing saturates signed 16-bit numbers: the low half of each lane is made one first. */
TYNI_SSE2_OP __m128i tyni_sse2_pack16(__m128i x)
{
    const __m128i low = _mm_srai_epi32(_mm_slli_epi32(x, 16), 16);
    return _mm_packs_epi32(low, low);
}
TYNI_SSE2_OP void tyni_sse2_store_u16(uint16_t *p, __m128i x)
{
    _mm_storel_epi64((__m128i *)(void *)p, tyni_sse2_pack16(x));
}
TYNI_SSE2_OP void tyni_sse2_store_u8(uint8_t *p, __m128i x)
{
    const __m128i words = tyni_sse2_pack16(_mm_and_si128(x, _mm_set1_epi32(255)));
    const int32_t four = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
    memcpy(p, &four, 4);
}
TYNI_SSE2_OP __m128i tyni_sse2_iload_apart(const void *p, int32_t bytes)
{
    int32_t x[4];
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)p + i * bytes, 4);
    return tyni_sse2_iload(x);
}
TYNI_SSE2_OP __m128i tyni_sse2_igather(const void *base, __m128i bytes)
{
    int32_t at[4], x[4];
    tyni_sse2_istore(at, bytes);
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    return tyni_sse2_iload(x);
}
TYNI_SSE2_OP __m128 tyni_sse2_gather(const float *base, __m128i index)
{
    int32_t at[4];
    tyni_sse2_istore(at, index);
    return _mm_setr_ps(base[at[0]], base[at[1]], base[at[2]], base[at[3]]);
}
TYNI_SSE2_OP __m128i tyni_sse2_words_of(const uint16_t *table, const uint8_t *p)
{
    __m128i x = _mm_cvtsi32_si128(table[p[0]]);
    x = _mm_insert_epi16(x, (int16_t)table[p[4]], 2);
    x = _mm_insert_epi16(x, (int16_t)table[p[8]], 4);
    return _mm_insert_epi16(x, (int16_t)table[p[12]], 6);
}
TYNI_SSE2_OP void tyni_sse2_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], __m128i out[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        out[c] = tyni_sse2_words_of(table, p + byte[c]);
}
TYNI_SSE2_OP __m128 tyni_sse2_pick(const float *base, __m128i index)
{
    return tyni_sse2_gather(base, index);
}
TYNI_SSE2_OP __m128 tyni_sse2_pick16(const float *base, __m128i index)
{
    return tyni_sse2_gather(base, _mm_and_si128(index, _mm_set1_epi32(15)));
}
TYNI_SSE2_OP __m128i tyni_sse2_ipick(const void *base, __m128i index)
{
    return tyni_sse2_igather(base, tyni_sse2_shl(index, 2));
}
TYNI_SSE2_OP __m128i tyni_sse2_igather_where(const void *base, __m128i bytes, __m128i m)
{
    int32_t at[4], x[4] = {0, 0, 0, 0};
    uint32_t word = tyni_sse2_word(m);
    tyni_sse2_istore(at, bytes);
    for (; word; word &= word - 1) {
        const int32_t i = tyni_ctz32(word);
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    }
    return tyni_sse2_iload(x);
}
TYNI_SSE2_OP void tyni_sse2_store_rgb(float *p, __m128 r, __m128 g, __m128 b)
{
    const __m128 rg0 = _mm_unpacklo_ps(r, g), rg1 = _mm_unpackhi_ps(r, g); /* r0 g0 r1 g1, r2 g2 r3 g3 */
    const __m128 b0r1 = _mm_shuffle_ps(b, r, 0x50);                        /* b0 b0 r1 r1 */
    const __m128 g1b1 = _mm_shuffle_ps(g, b, 0x55);                        /* g1 g1 b1 b1 */
    const __m128 b2r3 = _mm_shuffle_ps(b, r, 0xfa), g3b3 = _mm_shuffle_ps(g, b, 0xff);
    _mm_storeu_ps(p, _mm_shuffle_ps(rg0, b0r1, 0x84));      /* r0 g0 b0 r1 */
    _mm_storeu_ps(p + 4, _mm_shuffle_ps(g1b1, rg1, 0x48));  /* g1 b1 r2 g2 */
    _mm_storeu_ps(p + 8, _mm_shuffle_ps(b2r3, g3b3, 0x88)); /* b2 r3 g3 b3 */
}
TYNI_SSE2_OP void tyni_sse2_load_rgb(const float *p, __m128 *r, __m128 *g, __m128 *b)
{
    const __m128 x = _mm_loadu_ps(p), y = _mm_loadu_ps(p + 4), z = _mm_loadu_ps(p + 8);
    const __m128 r23 = _mm_shuffle_ps(y, z, 0x12); /* y2 y0 z1 z0: r2 . r3 . */
    const __m128 g01 = _mm_shuffle_ps(x, y, 0x01); /* x1 x0 y0 y0: g0 . g1 . */
    const __m128 g23 = _mm_shuffle_ps(y, z, 0x23); /* y3 y0 z2 z0: g2 . g3 . */
    const __m128 b01 = _mm_shuffle_ps(x, y, 0x12); /* x2 x0 y1 y0: b0 . b1 . */
    *r = _mm_shuffle_ps(_mm_shuffle_ps(x, x, 0x30), r23, 0x88);
    *g = _mm_shuffle_ps(g01, g23, 0x88);
    *b = _mm_shuffle_ps(b01, _mm_shuffle_ps(z, z, 0x30), 0x88);
}
/* Unsigned compare: t > position where the saturated difference is not 0. */
TYNI_SSE2_OP uint32_t tyni_sse2_above16(const uint16_t *t, uint32_t position)
{
    const __m128i p = _mm_set1_epi16((int16_t)(uint16_t)position), zero = _mm_setzero_si128();
    const __m128i *v = (const __m128i *)(const void *)t;
    uint32_t below = 0;
    for (int32_t i = 0; i < 2; i++) {
        const __m128i a = _mm_cmpeq_epi16(_mm_subs_epu16(_mm_loadu_si128(v + 2 * i), p), zero);
        const __m128i b = _mm_cmpeq_epi16(_mm_subs_epu16(_mm_loadu_si128(v + 2 * i + 1), p), zero);
        below |= (uint32_t)_mm_movemask_epi8(_mm_packs_epi16(a, b)) << (16 * i);
    }
    return ~below;
}

TYNI_SSE2_OP int32_t tyni_sse2_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    return tyni_scalar_pack64(out, from, bits);
}

TYNI_SSE2_OP float tyni_sse2_halves(__m128 x)
{
    const __m128 two = _mm_add_ps(x, _mm_movehl_ps(x, x));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

TYNI_SSE2_OP void tyni_sse2_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    __m128i sum[4], low, high;
    for (int32_t k = 0; k < 4; k++) {
        sum[k] = _mm_setzero_si128();
        for (int32_t i = 0; i < n; i += 16) {
            const __m128i *v = (const __m128i *)(const void *)(a + i);
            const __m128i w = _mm_loadu_si128((const __m128i *)(const void *)(b[k] + i));
            low = _mm_madd_epi16(_mm_loadu_si128(v), _mm_srai_epi16(_mm_unpacklo_epi8(w, w), 8));
            high = _mm_madd_epi16(_mm_loadu_si128(v + 1), _mm_srai_epi16(_mm_unpackhi_epi8(w, w), 8));
            sum[k] = _mm_add_epi32(sum[k], _mm_add_epi32(low, high));
        }
    }
    low = _mm_add_epi32(_mm_unpacklo_epi32(sum[0], sum[1]), _mm_unpackhi_epi32(sum[0], sum[1]));
    high = _mm_add_epi32(_mm_unpacklo_epi32(sum[2], sum[3]), _mm_unpackhi_epi32(sum[2], sum[3]));
    _mm_storeu_si128((__m128i *)(void *)out, _mm_add_epi32(_mm_unpacklo_epi64(low, high), _mm_unpackhi_epi64(low, high)));
}

#endif
