/* neon.h - the operations of lanes.h in AArch64's NEON: four lanes. (32-bit NEON flushes denormals and has no division.) A mask
 * is all ones or all zeros a lane. */
#ifndef TYNI_LANES_NEON_H
#define TYNI_LANES_NEON_H

#include <arm_neon.h>

#include "base.h"

#define TYNI_NEON_OP static inline __attribute__((always_inline))
#define TYNI_LANES_TARGET_neon

enum { tyni_neon_n = 4 };
typedef float32x4_t tyni_neon_float;
typedef int32x4_t tyni_neon_int;
typedef uint32x4_t tyni_neon_mask;

TYNI_NEON_OP float32x4_t tyni_neon_set(float x)
{
    return vdupq_n_f32(x);
}
TYNI_NEON_OP int32x4_t tyni_neon_iset(int32_t x)
{
    return vdupq_n_s32(x);
}
TYNI_NEON_OP int32x4_t tyni_neon_index(void)
{
    static const int32_t lane[4] = {0, 1, 2, 3};
    return vld1q_s32(lane);
}

/* ---- floats ---- */

TYNI_NEON_OP float32x4_t tyni_neon_sqrt(float32x4_t x)
{
    return vsqrtq_f32(x);
}
/* vminq and vmaxq have another rule for NaN and zeros */
TYNI_NEON_OP float32x4_t tyni_neon_min(float32x4_t a, float32x4_t b)
{
    return vbslq_f32(vcltq_f32(a, b), a, b);
}
TYNI_NEON_OP float32x4_t tyni_neon_max(float32x4_t a, float32x4_t b)
{
    return vbslq_f32(vcgtq_f32(a, b), a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_lt(float32x4_t a, float32x4_t b)
{
    return vcltq_f32(a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_le(float32x4_t a, float32x4_t b)
{
    return vcleq_f32(a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_eq(float32x4_t a, float32x4_t b)
{
    return vceqq_f32(a, b);
}
TYNI_NEON_OP float32x4_t tyni_neon_select(uint32x4_t m, float32x4_t a, float32x4_t b)
{
    return vbslq_f32(m, a, b);
}

/* ---- integers ---- */

TYNI_NEON_OP int32x4_t tyni_neon_iadd(int32x4_t a, int32x4_t b)
{
    return vaddq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_isub(int32x4_t a, int32x4_t b)
{
    return vsubq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_imul(int32x4_t a, int32x4_t b)
{
    return vmulq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_imin(int32x4_t a, int32x4_t b)
{
    return vminq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_imax(int32x4_t a, int32x4_t b)
{
    return vmaxq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_iand(int32x4_t a, int32x4_t b)
{
    return vandq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_ior(int32x4_t a, int32x4_t b)
{
    return vorrq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_ixor(int32x4_t a, int32x4_t b)
{
    return veorq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_iandnot(int32x4_t a, int32x4_t b)
{
    return vbicq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_shl(int32x4_t x, int32_t n)
{
    return vshlq_s32(x, vdupq_n_s32(n));
}
TYNI_NEON_OP int32x4_t tyni_neon_shr(int32x4_t x, int32_t n)
{
    return vreinterpretq_s32_u32(vshlq_u32(vreinterpretq_u32_s32(x), vdupq_n_s32(-n)));
}
TYNI_NEON_OP int32x4_t tyni_neon_sar(int32x4_t x, int32_t n)
{
    return vshlq_s32(x, vdupq_n_s32(-n));
}
TYNI_NEON_OP uint32x4_t tyni_neon_ilt(int32x4_t a, int32x4_t b)
{
    return vcltq_s32(a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_ieq(int32x4_t a, int32x4_t b)
{
    return vceqq_s32(a, b);
}
TYNI_NEON_OP int32x4_t tyni_neon_iselect(uint32x4_t m, int32x4_t a, int32x4_t b)
{
    return vbslq_s32(m, a, b);
}

/* ---- from one to the other ---- */

TYNI_NEON_OP int32x4_t tyni_neon_bits(float32x4_t x)
{
    return vreinterpretq_s32_f32(x);
}
TYNI_NEON_OP float32x4_t tyni_neon_from_bits(int32x4_t x)
{
    return vreinterpretq_f32_s32(x);
}
TYNI_NEON_OP int32x4_t tyni_neon_trunc(float32x4_t x)
{
    return vcvtq_s32_f32(x);
}
TYNI_NEON_OP float32x4_t tyni_neon_to_float(int32x4_t x)
{
    return vcvtq_f32_s32(x);
}

/* ---- masks ---- */

TYNI_NEON_OP uint32x4_t tyni_neon_mand(uint32x4_t a, uint32x4_t b)
{
    return vandq_u32(a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_mor(uint32x4_t a, uint32x4_t b)
{
    return vorrq_u32(a, b);
}
TYNI_NEON_OP uint32x4_t tyni_neon_mandnot(uint32x4_t a, uint32x4_t b)
{
    return vbicq_u32(a, b);
}
TYNI_NEON_OP uint32_t tyni_neon_word(uint32x4_t m)
{
    static const uint32_t bit[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(m, vld1q_u32(bit)));
}
TYNI_NEON_OP uint32x4_t tyni_neon_first(int32_t n)
{
    return vcltq_s32(tyni_neon_index(), vdupq_n_s32(n));
}

/* ---- memory ---- */

TYNI_NEON_OP float32x4_t tyni_neon_load(const float *p)
{
    return vld1q_f32(p);
}
TYNI_NEON_OP void tyni_neon_store(float *p, float32x4_t x)
{
    vst1q_f32(p, x);
}
TYNI_NEON_OP int32x4_t tyni_neon_iload(const void *p)
{
    return vreinterpretq_s32_u8(vld1q_u8((const uint8_t *)p));
}
TYNI_NEON_OP void tyni_neon_istore(void *p, int32x4_t x)
{
    vst1q_u8((uint8_t *)p, vreinterpretq_u8_s32(x));
}
TYNI_NEON_OP void tyni_neon_istore_where(void *p, uint32x4_t m, int32x4_t x)
{
    tyni_neon_istore(p, vbslq_s32(m, x, tyni_neon_iload(p)));
}
TYNI_NEON_OP int32x4_t tyni_neon_iload_n(const void *p, int32_t n)
{
    int32_t lane[4] = {0, 0, 0, 0};
    if (n >= 4)
        return tyni_neon_iload(p);
    for (int32_t i = 0; i < n; i++)
        memcpy(&lane[i], (const uint8_t *)p + 4 * i, 4);
    return tyni_neon_iload(lane);
}
TYNI_NEON_OP void tyni_neon_istore_n(void *p, int32x4_t x, int32_t n)
{
    int32_t lane[4];
    if (n >= 4) {
        tyni_neon_istore(p, x);
        return;
    }
    tyni_neon_istore(lane, x);
    for (int32_t i = 0; i < n; i++)
        memcpy((uint8_t *)p + 4 * i, &lane[i], 4);
}
TYNI_NEON_OP float32x4_t tyni_neon_load_n(const float *p, int32_t n)
{
    return vreinterpretq_f32_s32(tyni_neon_iload_n(p, n));
}
TYNI_NEON_OP void tyni_neon_store_n(float *p, float32x4_t x, int32_t n)
{
    tyni_neon_istore_n(p, vreinterpretq_s32_f32(x), n);
}
TYNI_NEON_OP void tyni_neon_store_where(float *p, uint32x4_t m, float32x4_t x)
{
    vst1q_f32(p, vbslq_f32(m, x, vld1q_f32(p)));
}
TYNI_NEON_OP int32x4_t tyni_neon_load_u8(const uint8_t *p)
{
    uint32_t four;
    memcpy(&four, p, 4);
    return vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(vmovl_u8(vcreate_u8(four)))));
}
TYNI_NEON_OP int32x4_t tyni_neon_load_u16(const uint16_t *p)
{
    return vreinterpretq_s32_u32(vmovl_u16(vld1_u16(p)));
}
TYNI_NEON_OP void tyni_neon_store_u8(uint8_t *p, int32x4_t x)
{
    const uint16x4_t words = vmovn_u32(vreinterpretq_u32_s32(x));
    const uint32_t four = vget_lane_u32(vreinterpret_u32_u8(vmovn_u16(vcombine_u16(words, words))), 0);
    memcpy(p, &four, 4);
}
TYNI_NEON_OP void tyni_neon_store_u16(uint16_t *p, int32x4_t x)
{
    vst1_u16(p, vmovn_u32(vreinterpretq_u32_s32(x)));
}
TYNI_NEON_OP int32x4_t tyni_neon_iload_apart(const void *p, int32_t bytes)
{
    int32_t x[4];
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)p + i * bytes, 4);
    return tyni_neon_iload(x);
}
TYNI_NEON_OP int32x4_t tyni_neon_igather(const void *base, int32x4_t bytes)
{
    int32_t at[4], x[4];
    tyni_neon_istore(at, bytes);
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    return tyni_neon_iload(x);
}
TYNI_NEON_OP float32x4_t tyni_neon_gather(const float *base, int32x4_t index)
{
    int32_t at[4];
    float x[4];
    tyni_neon_istore(at, index);
    for (int32_t i = 0; i < 4; i++)
        x[i] = base[at[i]];
    return vld1q_f32(x);
}
TYNI_NEON_OP int32x4_t tyni_neon_words_of(const uint16_t *table, const uint8_t *p)
{
    uint16x4_t x = vld1_dup_u16(table + p[0]);
    x = vld1_lane_u16(table + p[4], x, 1);
    x = vld1_lane_u16(table + p[8], x, 2);
    x = vld1_lane_u16(table + p[12], x, 3);
    return vreinterpretq_s32_u32(vmovl_u16(x));
}
TYNI_NEON_OP void tyni_neon_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], int32x4_t out[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        out[c] = tyni_neon_words_of(table, p + byte[c]);
}
TYNI_NEON_OP float32x4_t tyni_neon_pick(const float *base, int32x4_t index)
{
    return tyni_neon_gather(base, index);
}
TYNI_NEON_OP float32x4_t tyni_neon_pick16(const float *base, int32x4_t index)
{
    return tyni_neon_gather(base, tyni_neon_iand(index, vdupq_n_s32(15)));
}
TYNI_NEON_OP int32x4_t tyni_neon_ipick(const void *base, int32x4_t index)
{
    return tyni_neon_igather(base, tyni_neon_shl(index, 2));
}
TYNI_NEON_OP int32x4_t tyni_neon_igather_where(const void *base, int32x4_t bytes, uint32x4_t m)
{
    int32_t at[4], x[4] = {0, 0, 0, 0};
    uint32_t word = tyni_neon_word(m);
    tyni_neon_istore(at, bytes);
    for (; word; word &= word - 1) {
        const int32_t i = tyni_ctz32(word);
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    }
    return tyni_neon_iload(x);
}
TYNI_NEON_OP void tyni_neon_store_rgb(float *p, float32x4_t r, float32x4_t g, float32x4_t b)
{
    float32x4x3_t rgb;
    rgb.val[0] = r;
    rgb.val[1] = g;
    rgb.val[2] = b;
    vst3q_f32(p, rgb);
}
TYNI_NEON_OP void tyni_neon_load_rgb(const float *p, float32x4_t *r, float32x4_t *g, float32x4_t *b)
{
    const float32x4x3_t rgb = vld3q_f32(p);
    *r = rgb.val[0];
    *g = rgb.val[1];
    *b = rgb.val[2];
}
TYNI_NEON_OP uint32_t tyni_neon_above16(const uint16_t *t, uint32_t position)
{
    static const uint8_t bit[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    const uint16x8_t p = vdupq_n_u16((uint16_t)position);
    const uint8x8_t bits = vld1_u8(bit);
    uint32_t word = 0;
    for (int32_t i = 0; i < 4; i++)
        word |= (uint32_t)vaddv_u8(vand_u8(vmovn_u16(vcltq_u16(p, vld1q_u16(t + 8 * i))), bits)) << (8 * i);
    return word;
}

TYNI_NEON_OP int32_t tyni_neon_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    return tyni_scalar_pack64(out, from, bits);
}

TYNI_NEON_OP float tyni_neon_halves(float32x4_t x)
{
    const float32x2_t two = vadd_f32(vget_low_f32(x), vget_high_f32(x));
    return vget_lane_f32(two, 0) + vget_lane_f32(two, 1);
}

TYNI_NEON_OP void tyni_neon_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    for (int32_t k = 0; k < 4; k++) {
        int32x4_t sum = vdupq_n_s32(0);
        for (int32_t i = 0; i < n; i += 8) {
            const int16x8_t v = vld1q_s16(a + i), w = vmovl_s8(vld1_s8(b[k] + i));
            sum = vmlal_s16(vmlal_s16(sum, vget_low_s16(v), vget_low_s16(w)), vget_high_s16(v), vget_high_s16(w));
        }
        out[k] = vaddvq_s32(sum);
    }
}

#endif
