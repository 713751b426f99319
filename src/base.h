/* base.h - what every room shares: fixed-size types, small helpers, bit scans. */
#ifndef TYNI_BASE_H
#define TYNI_BASE_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "tyndall.h"

/* One picture on every machine: a * b + c must round twice. gcc in ISO mode (-std=c99) and with -ffp-contract=off never fuses,
 * and outside of it has a pragma of its own: AVX-512 brings fused multiply-add along. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__) && !defined(__STRICT_ANSI__)
#pragma GCC optimize("fp-contract=off")
#endif

/* x87 registers round later than float, and no pragma helps. 16: only half floats are widened. */
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "tyndall: floats are calculated in wider registers, which gives other pictures; 32-bit x86: -msse2 -mfpmath=sse"
#elif defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#error "tyndall: -ffast-math and -fassociative-math give other pictures; build tyndall without them"
#endif

/* A broken rule inside the library, never bad input: that is checked at the door and gets a status. */
#ifdef TYN_ASSERT
#define TYNI_ASSERT(condition) TYN_ASSERT(condition)
#else
#define TYNI_ASSERT(condition) ((void)0)
#endif

/* Says that an address will be read soon; nothing where the compiler has no such thing. */
#if defined(__GNUC__)
#define TYNI_PREFETCH(address) __builtin_prefetch(address)
#else
#define TYNI_PREFETCH(address) ((void)(address))
#endif

/* Before a loop of few and known rounds, at most 4, or at most 8: all of them side by side. Vectors in an array would else go
 * through memory. */
#if defined(__clang__)
#define TYNI_UNROLL _Pragma("clang loop unroll(full)")
#define TYNI_UNROLL_MORE TYNI_UNROLL
#elif defined(__GNUC__) && !defined(__OPTIMIZE_SIZE__)
#define TYNI_UNROLL _Pragma("GCC unroll 4")
#define TYNI_UNROLL_MORE _Pragma("GCC unroll 8")
#else
#define TYNI_UNROLL
#define TYNI_UNROLL_MORE
#endif

/* Long chains of operations that go side by side, three channels of so many vectors. Where code is to be small they lie on the
 * stack. */
#ifdef __OPTIMIZE_SIZE__
#define TYNI_CHAINS 3
#else
#define TYNI_CHAINS 6
#endif

/* Of rare work whose stack the caller should not carry. */
#if defined(__GNUC__)
#define TYNI_NOINLINE __attribute__((noinline))
#else
#define TYNI_NOINLINE
#endif

/* Of what must be part of its caller's loop. */
#if defined(__GNUC__)
#define TYNI_INLINE static inline __attribute__((always_inline))
#else
#define TYNI_INLINE static inline
#endif

/* Whether the build has a part, see TYN_LEAVE_OUT. */
#ifndef TYN_LEAVE_OUT
#define TYN_LEAVE_OUT 0
#endif
#define TYNI_HAS(part) (!((TYN_LEAVE_OUT) & (part)))

#define TYNI_PI 3.14159265358979f

/* 1.5 * 2^23 + 127. A float between -126 and 127 added to it is rounded to a whole number, and the lowest 8 bits of the sum are
 * that number as an exponent: quicker than two conversions. Needs rounding to nearest, and sums in the order as written. */
#define TYNI_WHOLE 12583039.0f

static inline int32_t tyni_mini(int32_t a, int32_t b)
{
    return a < b ? a : b;
}
static inline int32_t tyni_maxi(int32_t a, int32_t b)
{
    return a > b ? a : b;
}
static inline int32_t tyni_clampi(int32_t x, int32_t low, int32_t high)
{
    return x < low ? low : x > high ? high : x;
}

/* NaN in the first argument gives the second: what keeps NaN from spreading. */
static inline float tyni_minf(float a, float b)
{
    return a < b ? a : b;
}
static inline float tyni_maxf(float a, float b)
{
    return a > b ? a : b;
}
static inline float tyni_absf(float x)
{
    return x < 0.0f ? -x : x;
}
/* NaN gives low; low > high gives high. */
static inline float tyni_clampf(float x, float low, float high)
{
    return tyni_minf(tyni_maxf(x, low), high);
}

/* Not NaN and not infinite. */
static inline int tyni_finite(float x)
{
    return x - x == 0.0f;
}

static inline uint32_t tyni_float_bits(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float tyni_bits_float(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Towards minus infinity, for |x| < 2^31. */
static inline int32_t tyni_floori(float x)
{
    int32_t i = (int32_t)x;
    return i - ((float)i > x);
}

static inline int32_t tyni_ceili(float x)
{
    int32_t i = (int32_t)x;
    return i + ((float)i < x);
}

/* How many bits are set. Not the compilers' own, which is a call where there is no instruction for it. */
static inline int32_t tyni_ones32(uint32_t x)
{
    x -= x >> 1 & 0x55555555u;
    x = (x & 0x33333333u) + (x >> 2 & 0x33333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0fu;
    return (int32_t)(x * 0x01010101u >> 24);
}

/* Plain C twins of the bit scans; tests hold the builtins against them. x != 0. */
static inline int32_t tyni_ctz32_plain(uint32_t x)
{
    int32_t n = 0;
    while (!(x & 1u)) {
        x >>= 1;
        n++;
    }
    return n;
}

static inline int32_t tyni_clz32_plain(uint32_t x)
{
    int32_t n = 0;
    while (!(x & 0x80000000u)) {
        x <<= 1;
        n++;
    }
    return n;
}

#if defined(__GNUC__) && !defined(TYN_PLAIN_C)
static inline int32_t tyni_ctz32(uint32_t x)
{
    return (int32_t)__builtin_ctz(x);
}
static inline int32_t tyni_clz32(uint32_t x)
{
    return (int32_t)__builtin_clz(x);
}
#else
static inline int32_t tyni_ctz32(uint32_t x)
{
    return tyni_ctz32_plain(x);
}
static inline int32_t tyni_clz32(uint32_t x)
{
    return tyni_clz32_plain(x);
}
#endif

#endif
