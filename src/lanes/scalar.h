/* scalar.h - the operations of lanes.h with one lane, in plain C: what all the others must equal, bit by bit. One lane and not
 * four: compilers turn structs of four floats into loads and stores, and one lane is also the smallest code. */
#ifndef TYNI_LANES_SCALAR_H
#define TYNI_LANES_SCALAR_H

#include <math.h>

#include "base.h"

#define TYNI_SCALAR_OP static inline
#define TYNI_LANES_TARGET_scalar

enum { tyni_scalar_n = 1 };
typedef float tyni_scalar_float;
typedef int32_t tyni_scalar_int;
typedef uint32_t tyni_scalar_mask; /* 0 or 1 */

TYNI_SCALAR_OP float tyni_scalar_set(float x)
{
    return x;
}
TYNI_SCALAR_OP int32_t tyni_scalar_iset(int32_t x)
{
    return x;
}
TYNI_SCALAR_OP int32_t tyni_scalar_index(void)
{
    return 0;
}

/* ---- floats ---- */

TYNI_SCALAR_OP float tyni_scalar_sqrt(float x)
{
    return sqrtf(x);
}
TYNI_SCALAR_OP float tyni_scalar_min(float a, float b)
{
    return a < b ? a : b;
}
TYNI_SCALAR_OP float tyni_scalar_max(float a, float b)
{
    return a > b ? a : b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_lt(float a, float b)
{
    return a < b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_le(float a, float b)
{
    return a <= b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_eq(float a, float b)
{
    return a == b;
}
TYNI_SCALAR_OP float tyni_scalar_select(uint32_t m, float a, float b)
{
    return m ? a : b;
}

/* ---- integers ---- */

TYNI_SCALAR_OP int32_t tyni_scalar_iadd(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}
TYNI_SCALAR_OP int32_t tyni_scalar_isub(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}
TYNI_SCALAR_OP int32_t tyni_scalar_imul(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a * (uint32_t)b);
}
TYNI_SCALAR_OP int32_t tyni_scalar_imin(int32_t a, int32_t b)
{
    return a < b ? a : b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_imax(int32_t a, int32_t b)
{
    return a > b ? a : b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_iand(int32_t a, int32_t b)
{
    return a & b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_ior(int32_t a, int32_t b)
{
    return a | b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_ixor(int32_t a, int32_t b)
{
    return a ^ b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_iandnot(int32_t a, int32_t b)
{
    return a & ~b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_shl(int32_t x, int32_t n)
{
    return (int32_t)((uint32_t)x << n);
}
TYNI_SCALAR_OP int32_t tyni_scalar_shr(int32_t x, int32_t n)
{
    return (int32_t)((uint32_t)x >> n);
}
TYNI_SCALAR_OP int32_t tyni_scalar_sar(int32_t x, int32_t n)
{
    return x < 0 ? ~(~x >> n) : x >> n;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_ilt(int32_t a, int32_t b)
{
    return a < b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_ieq(int32_t a, int32_t b)
{
    return a == b;
}
TYNI_SCALAR_OP int32_t tyni_scalar_iselect(uint32_t m, int32_t a, int32_t b)
{
    return m ? a : b;
}

/* ---- from one to the other ---- */

TYNI_SCALAR_OP int32_t tyni_scalar_bits(float x)
{
    return (int32_t)tyni_float_bits(x);
}
TYNI_SCALAR_OP float tyni_scalar_from_bits(int32_t x)
{
    return tyni_bits_float((uint32_t)x);
}
TYNI_SCALAR_OP int32_t tyni_scalar_trunc(float x)
{
    return (int32_t)x;
}
TYNI_SCALAR_OP float tyni_scalar_to_float(int32_t x)
{
    return (float)x;
}

/* ---- masks ---- */

TYNI_SCALAR_OP uint32_t tyni_scalar_mand(uint32_t a, uint32_t b)
{
    return a & b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_mor(uint32_t a, uint32_t b)
{
    return a | b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_mandnot(uint32_t a, uint32_t b)
{
    return a & ~b;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_word(uint32_t m)
{
    return m;
}
TYNI_SCALAR_OP uint32_t tyni_scalar_first(int32_t n)
{
    return n > 0;
}

/* ---- memory ---- */

TYNI_SCALAR_OP float tyni_scalar_load(const float *p)
{
    return *p;
}
TYNI_SCALAR_OP void tyni_scalar_store(float *p, float x)
{
    *p = x;
}
TYNI_SCALAR_OP float tyni_scalar_load_n(const float *p, int32_t n)
{
    return n > 0 ? *p : 0.0f;
}
TYNI_SCALAR_OP void tyni_scalar_store_n(float *p, float x, int32_t n)
{
    if (n > 0)
        *p = x;
}
TYNI_SCALAR_OP void tyni_scalar_store_where(float *p, uint32_t m, float x)
{
    if (m)
        *p = x;
}
TYNI_SCALAR_OP void tyni_scalar_istore_where(void *p, uint32_t m, int32_t x)
{
    if (m)
        memcpy(p, &x, sizeof x);
}
TYNI_SCALAR_OP int32_t tyni_scalar_iload(const void *p)
{
    int32_t x;
    memcpy(&x, p, sizeof x);
    return x;
}
TYNI_SCALAR_OP void tyni_scalar_istore(void *p, int32_t x)
{
    memcpy(p, &x, sizeof x);
}
TYNI_SCALAR_OP int32_t tyni_scalar_iload_n(const void *p, int32_t n)
{
    return n > 0 ? tyni_scalar_iload(p) : 0;
}
TYNI_SCALAR_OP void tyni_scalar_istore_n(void *p, int32_t x, int32_t n)
{
    if (n > 0)
        tyni_scalar_istore(p, x);
}
TYNI_SCALAR_OP int32_t tyni_scalar_load_u8(const uint8_t *p)
{
    return *p;
}
TYNI_SCALAR_OP int32_t tyni_scalar_load_u16(const uint16_t *p)
{
    return *p;
}
TYNI_SCALAR_OP void tyni_scalar_store_u8(uint8_t *p, int32_t x)
{
    *p = (uint8_t)(x & 255);
}
TYNI_SCALAR_OP void tyni_scalar_store_u16(uint16_t *p, int32_t x)
{
    *p = (uint16_t)(x & 65535);
}
TYNI_SCALAR_OP float tyni_scalar_gather(const float *base, int32_t index)
{
    return base[index];
}
TYNI_SCALAR_OP int32_t tyni_scalar_words_of(const uint16_t *table, const uint8_t *p)
{
    return table[*p];
}
TYNI_SCALAR_OP void tyni_scalar_rgb_words(const uint16_t *table, const uint8_t *p, const int32_t byte[3], int32_t out[3])
{
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        out[c] = tyni_scalar_words_of(table, p + byte[c]);
}
TYNI_SCALAR_OP float tyni_scalar_pick(const float *base, int32_t index)
{
    return tyni_scalar_gather(base, index);
}
TYNI_SCALAR_OP float tyni_scalar_pick16(const float *base, int32_t index)
{
    return tyni_scalar_gather(base, index & 15);
}
TYNI_SCALAR_OP int32_t tyni_scalar_iload_apart(const void *p, int32_t bytes)
{
    (void)bytes;
    return tyni_scalar_iload(p);
}
TYNI_SCALAR_OP int32_t tyni_scalar_igather(const void *base, int32_t bytes)
{
    return tyni_scalar_iload((const uint8_t *)base + bytes);
}
TYNI_SCALAR_OP int32_t tyni_scalar_ipick(const void *base, int32_t index)
{
    return tyni_scalar_igather(base, 4 * index);
}
TYNI_SCALAR_OP int32_t tyni_scalar_igather_where(const void *base, int32_t bytes, uint32_t m)
{
    return m ? tyni_scalar_igather(base, bytes) : 0;
}
TYNI_SCALAR_OP void tyni_scalar_store_rgb(float *p, float r, float g, float b)
{
    p[0] = r;
    p[1] = g;
    p[2] = b;
}
TYNI_SCALAR_OP void tyni_scalar_load_rgb(const float *p, float *r, float *g, float *b)
{
    *r = p[0];
    *g = p[1];
    *b = p[2];
}
TYNI_SCALAR_OP uint32_t tyni_scalar_above16(const uint16_t *t, uint32_t position)
{
    uint32_t word = 0;
    for (int32_t i = 0; i < 32; i++)
        word |= (uint32_t)(position < t[i]) << i;
    return word;
}

/* The lowest bit that is set; x != 0. */
TYNI_SCALAR_OP int32_t tyni_scalar_ctz64(uint64_t x)
{
#if defined(__GNUC__) && !defined(TYN_PLAIN_C) && __SIZEOF_LONG__ == 8 /* else the compiler's library may be asked */
    return __builtin_ctzll(x);
#else
    return (uint32_t)x ? tyni_ctz32((uint32_t)x) : 32 + tyni_ctz32((uint32_t)(x >> 32));
#endif
}
/* What pack64 writes, for all that have no instruction for it. Four at a time without asking whether there are so many: a
 * branch that nobody can foretell costs more. */
TYNI_SCALAR_OP void tyni_scalar_list64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    const uint64_t top = (uint64_t)1 << 63;
    do {
        const uint64_t second = bits & (bits - 1), third = second & (second - 1), fourth = third & (third - 1);
        out[0] = from[tyni_scalar_ctz64(bits | top)];
        out[1] = from[tyni_scalar_ctz64(second | top)];
        out[2] = from[tyni_scalar_ctz64(third | top)];
        out[3] = from[tyni_scalar_ctz64(fourth | top)];
        out += 4;
        bits = fourth & (fourth - 1);
    } while (bits);
}
TYNI_SCALAR_OP int32_t tyni_scalar_pack64(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    tyni_scalar_list64(out, from, bits);
    return tyni_ones32((uint32_t)bits) + tyni_ones32((uint32_t)(bits >> 32));
}

/* The lanes' sum: of halves, then of their halves. */
TYNI_SCALAR_OP float tyni_scalar_halves(float x)
{
    return x;
}

TYNI_SCALAR_OP void tyni_scalar_dots8(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    for (int32_t k = 0; k < 4; k++) {
        out[k] = 0;
        for (int32_t i = 0; i < n; i++)
            out[k] += a[i] * b[k][i];
    }
}

#endif
