/* wasm.h - the operations of lanes.h in WebAssembly's SIMD128: four lanes. A mask is all ones or all zeros a lane. */
#ifndef TYNI_LANES_WASM_H
#define TYNI_LANES_WASM_H

#include <wasm_simd128.h>

#include "base.h"

#define TYNI_WASM_OP static inline __attribute__((always_inline))
#define TYNI_LANES_TARGET_wasm

enum { tyni_wasm_n = 4 };
typedef float tyni_wasm_float __attribute__((vector_size(16))); /* v128_t would add as integers */
typedef v128_t tyni_wasm_int;
typedef v128_t tyni_wasm_mask;

TYNI_WASM_OP tyni_wasm_float tyni_wasm_set(float x)
{
    return (tyni_wasm_float)wasm_f32x4_splat(x);
}
TYNI_WASM_OP v128_t tyni_wasm_iset(int32_t x)
{
    return wasm_i32x4_splat(x);
}
TYNI_WASM_OP v128_t tyni_wasm_index(void)
{
    return wasm_i32x4_const(0, 1, 2, 3);
}

/* ---- floats ---- */

TYNI_WASM_OP tyni_wasm_float tyni_wasm_sqrt(tyni_wasm_float x)
{
    return (tyni_wasm_float)wasm_f32x4_sqrt((v128_t)x);
}
/* pmin(b, a) is a < b ? a : b, and pmax(b, a) is b < a ? a : b */
TYNI_WASM_OP tyni_wasm_float tyni_wasm_min(tyni_wasm_float a, tyni_wasm_float b)
{
    return (tyni_wasm_float)wasm_f32x4_pmin((v128_t)b, (v128_t)a);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_max(tyni_wasm_float a, tyni_wasm_float b)
{
    return (tyni_wasm_float)wasm_f32x4_pmax((v128_t)b, (v128_t)a);
}
TYNI_WASM_OP v128_t tyni_wasm_lt(tyni_wasm_float a, tyni_wasm_float b)
{
    return wasm_f32x4_lt((v128_t)a, (v128_t)b);
}
TYNI_WASM_OP v128_t tyni_wasm_le(tyni_wasm_float a, tyni_wasm_float b)
{
    return wasm_f32x4_le((v128_t)a, (v128_t)b);
}
TYNI_WASM_OP v128_t tyni_wasm_eq(tyni_wasm_float a, tyni_wasm_float b)
{
    return wasm_f32x4_eq((v128_t)a, (v128_t)b);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_select(v128_t m, tyni_wasm_float a, tyni_wasm_float b)
{
    return (tyni_wasm_float)wasm_v128_bitselect((v128_t)a, (v128_t)b, m);
}

/* ---- integers ---- */

TYNI_WASM_OP v128_t tyni_wasm_iadd(v128_t a, v128_t b)
{
    return wasm_i32x4_add(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_isub(v128_t a, v128_t b)
{
    return wasm_i32x4_sub(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_imul(v128_t a, v128_t b)
{
    return wasm_i32x4_mul(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_imin(v128_t a, v128_t b)
{
    return wasm_i32x4_min(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_imax(v128_t a, v128_t b)
{
    return wasm_i32x4_max(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_iand(v128_t a, v128_t b)
{
    return wasm_v128_and(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_ior(v128_t a, v128_t b)
{
    return wasm_v128_or(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_ixor(v128_t a, v128_t b)
{
    return wasm_v128_xor(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_iandnot(v128_t a, v128_t b)
{
    return wasm_v128_andnot(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_shl(v128_t x, int32_t n)
{
    return wasm_i32x4_shl(x, (uint32_t)n);
}
TYNI_WASM_OP v128_t tyni_wasm_shr(v128_t x, int32_t n)
{
    return wasm_u32x4_shr(x, (uint32_t)n);
}
TYNI_WASM_OP v128_t tyni_wasm_sar(v128_t x, int32_t n)
{
    return wasm_i32x4_shr(x, (uint32_t)n);
}
TYNI_WASM_OP v128_t tyni_wasm_ilt(v128_t a, v128_t b)
{
    return wasm_i32x4_lt(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_ieq(v128_t a, v128_t b)
{
    return wasm_i32x4_eq(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_iselect(v128_t m, v128_t a, v128_t b)
{
    return wasm_v128_bitselect(a, b, m);
}

/* ---- from one to the other ---- */

TYNI_WASM_OP v128_t tyni_wasm_bits(tyni_wasm_float x)
{
    return (v128_t)x;
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_from_bits(v128_t x)
{
    return (tyni_wasm_float)x;
}
TYNI_WASM_OP v128_t tyni_wasm_trunc(tyni_wasm_float x)
{
    return wasm_i32x4_trunc_sat_f32x4((v128_t)x);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_to_float(v128_t x)
{
    return (tyni_wasm_float)wasm_f32x4_convert_i32x4(x);
}

/* ---- masks ---- */

TYNI_WASM_OP v128_t tyni_wasm_mand(v128_t a, v128_t b)
{
    return wasm_v128_and(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_mor(v128_t a, v128_t b)
{
    return wasm_v128_or(a, b);
}
TYNI_WASM_OP v128_t tyni_wasm_mandnot(v128_t a, v128_t b)
{
    return wasm_v128_andnot(a, b);
}
TYNI_WASM_OP uint32_t tyni_wasm_word(v128_t m)
{
    return (uint32_t)wasm_i32x4_bitmask(m);
}
TYNI_WASM_OP v128_t tyni_wasm_first(int32_t n)
{
    return wasm_i32x4_lt(tyni_wasm_index(), wasm_i32x4_splat(n));
}

/* ---- memory ---- */

TYNI_WASM_OP tyni_wasm_float tyni_wasm_load(const float *p)
{
    return (tyni_wasm_float)wasm_v128_load(p);
}
TYNI_WASM_OP void tyni_wasm_store(float *p, tyni_wasm_float x)
{
    wasm_v128_store(p, (v128_t)x);
}
TYNI_WASM_OP v128_t tyni_wasm_iload(const void *p)
{
    return wasm_v128_load(p);
}
TYNI_WASM_OP void tyni_wasm_istore(void *p, v128_t x)
{
    wasm_v128_store(p, x);
}
TYNI_WASM_OP void tyni_wasm_istore_where(void *p, v128_t m, v128_t x)
{
    wasm_v128_store(p, wasm_v128_bitselect(x, wasm_v128_load(p), m));
}
TYNI_WASM_OP v128_t tyni_wasm_iload_n(const void *p, int32_t n)
{
    int32_t lane[4] = {0, 0, 0, 0};
    if (n >= 4)
        return tyni_wasm_iload(p);
    for (int32_t i = 0; i < n; i++)
        memcpy(&lane[i], (const uint8_t *)p + 4 * i, 4);
    return tyni_wasm_iload(lane);
}
TYNI_WASM_OP void tyni_wasm_istore_n(void *p, v128_t x, int32_t n)
{
    int32_t lane[4];
    if (n >= 4) {
        tyni_wasm_istore(p, x);
        return;
    }
    tyni_wasm_istore(lane, x);
    for (int32_t i = 0; i < n; i++)
        memcpy((uint8_t *)p + 4 * i, &lane[i], 4);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_load_n(const float *p, int32_t n)
{
    return (tyni_wasm_float)tyni_wasm_iload_n(p, n);
}
TYNI_WASM_OP void tyni_wasm_store_n(float *p, tyni_wasm_float x, int32_t n)
{
    tyni_wasm_istore_n(p, (v128_t)x, n);
}
TYNI_WASM_OP void tyni_wasm_store_where(float *p, v128_t m, tyni_wasm_float x)
{
    wasm_v128_store(p, wasm_v128_bitselect((v128_t)x, wasm_v128_load(p), m));
}
TYNI_WASM_OP v128_t tyni_wasm_load_u8(const uint8_t *p)
{
    return wasm_u32x4_extend_low_u16x8(wasm_u16x8_extend_low_u8x16(wasm_v128_load32_zero(p)));
}
TYNI_WASM_OP v128_t tyni_wasm_load_u16(const uint16_t *p)
{
    return wasm_u32x4_load16x4(p);
}
TYNI_WASM_OP void tyni_wasm_store_u8(uint8_t *p, v128_t x)
{
    wasm_v128_store32_lane(p, wasm_i8x16_shuffle(x, x, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12), 0);
}
TYNI_WASM_OP void tyni_wasm_store_u16(uint16_t *p, v128_t x)
{
    wasm_v128_store64_lane(p, wasm_i16x8_shuffle(x, x, 0, 2, 4, 6, 0, 2, 4, 6), 0);
}
TYNI_WASM_OP v128_t tyni_wasm_iload_apart(const void *p, int32_t bytes)
{
    int32_t x[4];
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)p + i * bytes, 4);
    return tyni_wasm_iload(x);
}
TYNI_WASM_OP v128_t tyni_wasm_igather(const void *base, v128_t bytes)
{
    int32_t at[4], x[4];
    tyni_wasm_istore(at, bytes);
    for (int32_t i = 0; i < 4; i++)
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    return tyni_wasm_iload(x);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_gather(const float *base, v128_t index)
{
    int32_t at[4];
    float x[4];
    tyni_wasm_istore(at, index);
    for (int32_t i = 0; i < 4; i++)
        x[i] = base[at[i]];
    return tyni_wasm_load(x);
}
TYNI_WASM_OP v128_t tyni_wasm_words_of(const uint16_t *table, const uint8_t *p)
{
    return wasm_i32x4_make(table[p[0]], table[p[4]], table[p[8]], table[p[12]]);
}
TYNI_WASM_OP void tyni_wasm_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], v128_t out[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        out[c] = tyni_wasm_words_of(table, p + byte[c]);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_pick(const float *base, v128_t index)
{
    return tyni_wasm_gather(base, index);
}
TYNI_WASM_OP tyni_wasm_float tyni_wasm_pick16(const float *base, v128_t index)
{
    return tyni_wasm_gather(base, wasm_v128_and(index, wasm_i32x4_splat(15)));
}
TYNI_WASM_OP v128_t tyni_wasm_ipick(const void *base, v128_t index)
{
    return tyni_wasm_igather(base, tyni_wasm_shl(index, 2));
}
TYNI_WASM_OP v128_t tyni_wasm_igather_where(const void *base, v128_t bytes, v128_t m)
{
    int32_t at[4], x[4] = {0, 0, 0, 0};
    uint32_t word = tyni_wasm_word(m);
    tyni_wasm_istore(at, bytes);
    for (; word; word &= word - 1) {
        const int32_t i = tyni_ctz32(word);
        memcpy(&x[i], (const uint8_t *)base + at[i], 4);
    }
    return tyni_wasm_iload(x);
}
TYNI_WASM_OP void tyni_wasm_store_rgb(float *p, tyni_wasm_float r, tyni_wasm_float g, tyni_wasm_float b)
{
    for (int32_t i = 0; i < 4; i++) {
        p[3 * i] = r[i];
        p[3 * i + 1] = g[i];
        p[3 * i + 2] = b[i];
    }
}
TYNI_WASM_OP void tyni_wasm_load_rgb(const float *p, tyni_wasm_float *r, tyni_wasm_float *g, tyni_wasm_float *b)
{
    const tyni_wasm_float x = {p[0], p[3], p[6], p[9]}, y = {p[1], p[4], p[7], p[10]}, z = {p[2], p[5], p[8], p[11]};
    *r = x;
    *g = y;
    *b = z;
}
TYNI_WASM_OP uint32_t tyni_wasm_above16(const uint16_t *t, uint32_t position)
{
    const v128_t p = wasm_i16x8_splat((int16_t)(uint16_t)position);
    uint32_t word = 0;
    for (int32_t i = 0; i < 2; i++) {
        const v128_t a = wasm_u16x8_lt(p, wasm_v128_load(t + 16 * i)), b = wasm_u16x8_lt(p, wasm_v128_load(t + 16 * i + 8));
        word |= (uint32_t)wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(a, b)) << (16 * i);
    }
    return word;
}

TYNI_WASM_OP int32_t tyni_wasm_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    return tyni_scalar_pack64(out, from, bits);
}

TYNI_WASM_OP float tyni_wasm_halves(tyni_wasm_float x)
{
    float all[4];
    tyni_wasm_store(all, x);
    return (all[0] + all[2]) + (all[1] + all[3]);
}

TYNI_WASM_OP void tyni_wasm_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    for (int32_t k = 0; k < 4; k++) {
        v128_t sum = wasm_i32x4_splat(0);
        for (int32_t i = 0; i < n; i += 8)
            sum = wasm_i32x4_add(sum, wasm_i32x4_dot_i16x8(wasm_v128_load(a + i), wasm_i16x8_load8x8(b[k] + i)));
        out[k] = wasm_i32x4_extract_lane(sum, 0) + wasm_i32x4_extract_lane(sum, 1) + wasm_i32x4_extract_lane(sum, 2) +
                 wasm_i32x4_extract_lane(sum, 3);
    }
}

#endif
