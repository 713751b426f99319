/* lanes.h - one small set of vector operations, and the kernels written over it.
 *
 * A kernel is written once, in a header without a guard, and compiled once for each instruction set (ISA). Its .c file says
 *
 *     #define TYNI_KERNEL "raster/span.h"
 *     #include "lanes/each.h"
 *
 * and calls TYNI_LANES_CALL(isa, raster_span, (...)). In the kernel a function that is called from outside is
 *
 *     static TYNI_V_TARGET void TYNI_V(raster_span)(float *p, int32_t count) {...}
 *
 * and one that is only used in the kernel `TYNI_V_INLINE v_float TYNI_V(raster_part)(v_float x)`. No function without one of
 * the two may take or give v_ types. No compiler flags are needed.
 *
 * Every ISA gives the same bits; only which NaN a NaN is is open, and what becomes of a signalling one. So nothing here is
 * fused or approximate, and a float sum over lanes has a fixed order (v_sum16). A kernel must not let a result depend on v_n.
 *
 * Types: v_float, v_int (int32_t; also 32 bits of anything), v_mask. v_n lanes, 1 .. 16.
 *     + - * / and unary minus work on v_float, also with a float on one side. On v_int and v_mask they do not: see below.
 *     v_set(x) v_iset(x)                 all lanes equal
 *     v_index()                          0, 1, 2 ...
 * Floats:
 *     v_sqrt(x) v_abs(x)                 abs as tyni_absf: -0 stays
 *     v_min(a, b) v_max(a, b)            a < b ? a : b and a > b ? a : b: NaN in a gives b, NaN in b gives NaN, of zeros b
 *     v_clamp(x, low, high)              as tyni_clampf: NaN gives low, low > high gives high
 *     v_lt v_le v_gt v_ge v_eq v_ne      masks; NaN: all false but v_ne
 *     v_select(m, a, b)                  m ? a : b
 *     v_exp(x) v_fog(x) v_log(x)         the bits of tyni_num_exp, tyni_num_fog, tyni_num_log
 *     v_fade(x, &left, &lost)            the bits of tyni_num_fade
 *     v_fades(x, n, left, lost)          v_fade of x[0 .. n - 1], n up to TYNI_CHAINS, faster than one by one; x may be left
 *     v_sincos(x, &s, &c) v_atan2(y, x)  the bits of tyni_num_sincos, tyni_num_atan2
 * Integers, wrapping:
 *     v_iadd v_isub v_imul v_imin v_imax v_iand v_ior v_ixor v_iandnot(a, b) = a & ~b
 *     v_shl(x, n) v_shr(x, n) v_sar(x, n)      n is 0 .. 31, one for all lanes; sar brings in the sign
 *     v_ilt v_igt v_ieq                  masks, signed
 *     v_iselect(m, a, b)
 * From one to the other:
 *     v_bits(f) v_from_bits(i)           the same 32 bits
 *     v_trunc(f)                         towards 0, for |f| < 2^31; others give anything
 *     v_floori(f) v_ceili(f)             as tyni_floori, the same range
 *     v_to_float(i)                      to nearest
 * Masks:
 *     v_mand v_mor v_mandnot(a, b) = a & ~b    v_first(n): lanes below n, any n
 *     v_word(m)                          bit i is lane i; v_any(m) v_all(m) v_none(m)
 *     v_unword(word)                     lane i is bit i; bits from v_n on are anything
 * Memory, no alignment but that of the C type:
 *     v_load(p) v_store(p, x)            floats
 *     v_iload(p) v_istore(p, x)          32-bit words, at any address
 *     v_load_u8 v_load_u16 v_store_u8 v_store_u16    between bytes or words and v_int: zero extended; the low bits stored
 *     ..._n(p, n), ..._n(p, x, n)        the first n lanes alone, any n: others load as 0, their memory is not touched
 *     v_store_where v_istore_where(p, m, x)    where m; elsewhere the old values may be written back: all must be writable
 *     v_gather(base, index)              floats base[index]; all lanes are read
 *     v_rgb_words(table, p, byte, out)   out[c], c < 3: uint16_t table[p[byte[c]]], table[p[4 + byte[c]]] ...: what three
 *                                        bytes, 0 .. 3, of four-byte pixels stand for. All 256 of table may be read
 *     v_pick(base, index)                floats base[index], 0 <= index < v_n; all of base[0 .. v_n - 1] may be read
 *     v_ipick(base, index)               32-bit words, likewise
 *     v_pick16(base, index)              the same of a table of 16, by the index's lowest 4 bits
 *     v_igather(base, bytes)             32-bit words at base + bytes, at any address
 *     v_iload_apart(p, bytes)            32-bit words at p, p + bytes ...: faster than v_igather where bytes is a constant
 *     v_igather_where(base, bytes, m)    of lanes m alone, others are 0; their offsets may be anything
 *     v_store_rgb(p, r, g, b)            3 v_n floats, r g b r g b ...; v_store_rgb_n(p, r, g, b, n); v_load_rgb(p, &r, &g, &b)
 *     v_store_rgba8(p, r, g, b, a)       4 v_n bytes out of the low 8 bits of v_ints; v_store_rgba8_n(p, r, g, b, a, n)
 *     v_above16(t, position)             32 bits from 32 uint16_t: bit i is position < t[i]; position is 0 .. 65535
 *     v_above64(t, position)             the same of 64
 *     v_pack64(out, from, bits)          uint16_t from[i] for each bit i of 64 that is set, in order; returns how many.
 *                                        All 64 of from may be read and all of out[0 .. 63] written
 * Over lanes:
 *     v_sum16(part)                      of v_float part[16 / v_n], 16 partial sums, in one order on every ISA
 *     v_hmin(x) v_hmax(x)                no NaN; which zero of two is open
 *     v_isum(x)
 *     v_dots8(a, b, n, out)              out[k], k < 4: sum of int16_t a[i] times int8_t b[k][i], i < n, that must fit 32 bits;
 *                                        n of 16s
 */
#ifndef TYNI_LANES_H
#define TYNI_LANES_H

#include "base.h"

/* What is built in. x86: where scalar floats live in SSE registers too, or not even scalar code would round alike. */
#if defined(__GNUC__) && !defined(TYN_PLAIN_C)
#if defined(__x86_64__) || (defined(__i386__) && defined(__SSE2_MATH__))
#define TYNI_LANES_X86 1
#ifdef __x86_64__ /* gcc 12 joins two masks of 32 lanes to 64 bits wrongly in 32-bit code */
#define TYNI_LANES_AVX512 1
#endif
#elif defined(__aarch64__) && !defined(__AARCH64EB__)
#define TYNI_LANES_NEON 1
#elif defined(__wasm_simd128__)
#define TYNI_LANES_WASM 1
#endif
#endif

#include "lanes/scalar.h"
#ifdef TYNI_LANES_X86
#include "lanes/sse2.h"
#include "lanes/avx2.h"
#endif
#ifdef TYNI_LANES_AVX512
#include "lanes/avx512.h"
#endif
#ifdef TYNI_LANES_NEON
#include "lanes/neon.h"
#endif
#ifdef TYNI_LANES_WASM
#include "lanes/wasm.h"
#endif

/* Names of the ISA at hand, TYNI_ISA: lanes/each.h sets it. */
#define TYNI_LANES_PASTE(a, b, c, d) a##b##c##d
#define TYNI_LANES_JOIN(a, b, c, d) TYNI_LANES_PASTE(a, b, c, d)
#define TYNI_V(name) TYNI_LANES_JOIN(tyni_, TYNI_ISA, _, name)
#define TYNI_V_TARGET TYNI_LANES_JOIN(TYNI_LANES_TARGET_, TYNI_ISA, , )
#if defined(__OPTIMIZE_SIZE__) && !defined(TYNI_LANES_X86) && !defined(TYNI_LANES_NEON) && !defined(TYNI_LANES_WASM)
/* one lane, and code is to be small: the compiler knows better */
#define TYNI_V_INLINE static inline TYNI_V_TARGET
#elif defined(__GNUC__)
#define TYNI_V_INLINE static inline __attribute__((always_inline)) TYNI_V_TARGET
#else
#define TYNI_V_INLINE static inline
#endif

#define v_n TYNI_V(n)
#define v_float TYNI_V(float)
#define v_int TYNI_V(int)
#define v_mask TYNI_V(mask)
#define v_set TYNI_V(set)
#define v_iset TYNI_V(iset)
#define v_index TYNI_V(index)
#define v_sqrt TYNI_V(sqrt)
#define v_min TYNI_V(min)
#define v_max TYNI_V(max)
#define v_lt TYNI_V(lt)
#define v_le TYNI_V(le)
#define v_eq TYNI_V(eq)
#define v_select TYNI_V(select)
#define v_iadd TYNI_V(iadd)
#define v_isub TYNI_V(isub)
#define v_imul TYNI_V(imul)
#define v_imin TYNI_V(imin)
#define v_imax TYNI_V(imax)
#define v_iand TYNI_V(iand)
#define v_ior TYNI_V(ior)
#define v_ixor TYNI_V(ixor)
#define v_iandnot TYNI_V(iandnot)
#define v_shl TYNI_V(shl)
#define v_shr TYNI_V(shr)
#define v_sar TYNI_V(sar)
#define v_ilt TYNI_V(ilt)
#define v_ieq TYNI_V(ieq)
#define v_iselect TYNI_V(iselect)
#define v_bits TYNI_V(bits)
#define v_from_bits TYNI_V(from_bits)
#define v_trunc TYNI_V(trunc)
#define v_to_float TYNI_V(to_float)
#define v_mand TYNI_V(mand)
#define v_mor TYNI_V(mor)
#define v_mandnot TYNI_V(mandnot)
#define v_word TYNI_V(word)
#define v_unword TYNI_V(unword)
#define v_first TYNI_V(first)
#define v_load TYNI_V(load)
#define v_store TYNI_V(store)
#define v_load_n TYNI_V(load_n)
#define v_store_n TYNI_V(store_n)
#define v_store_where TYNI_V(store_where)
#define v_istore_where TYNI_V(istore_where)
#define v_iload TYNI_V(iload)
#define v_istore TYNI_V(istore)
#define v_iload_n TYNI_V(iload_n)
#define v_iload_apart TYNI_V(iload_apart)
#define v_istore_n TYNI_V(istore_n)
#define v_load_u8 TYNI_V(load_u8)
#define v_load_u16 TYNI_V(load_u16)
#define v_store_u8 TYNI_V(store_u8)
#define v_store_u16 TYNI_V(store_u16)
#define v_gather TYNI_V(gather)
#define v_rgb_words TYNI_V(rgb_words)
#define v_pick TYNI_V(pick)
#define v_ipick TYNI_V(ipick)
#define v_pick16 TYNI_V(pick16)
#define v_igather TYNI_V(igather)
#define v_igather_where TYNI_V(igather_where)
#define v_store_rgb TYNI_V(store_rgb)
#define v_load_rgb TYNI_V(load_rgb)
#define v_above16 TYNI_V(above16)
#define v_above64 TYNI_V(above64)
#define v_pack64 TYNI_V(pack64)
#define v_dots8 TYNI_V(dots8)
#define v_gt TYNI_V(gt)
#define v_ge TYNI_V(ge)
#define v_ne TYNI_V(ne)
#define v_abs TYNI_V(abs)
#define v_clamp TYNI_V(clamp)
#define v_igt TYNI_V(igt)
#define v_floori TYNI_V(floori)
#define v_ceili TYNI_V(ceili)
#define v_any TYNI_V(any)
#define v_all TYNI_V(all)
#define v_none TYNI_V(none)
#define v_load_u8_n TYNI_V(load_u8_n)
#define v_store_u8_n TYNI_V(store_u8_n)
#define v_store_u16_n TYNI_V(store_u16_n)
#define v_store_rgb_n TYNI_V(store_rgb_n)
#define v_store_rgba8 TYNI_V(store_rgba8)
#define v_store_rgba8_n TYNI_V(store_rgba8_n)
#define v_sum16 TYNI_V(sum16)
#define v_hmin TYNI_V(hmin)
#define v_hmax TYNI_V(hmax)
#define v_isum TYNI_V(isum)
#define v_exp TYNI_V(exp)
#define v_fog TYNI_V(fog)
#define v_fade TYNI_V(fade)
#define v_fades TYNI_V(fades)
#define v_log TYNI_V(log)
#define v_sincos TYNI_V(sincos)
#define v_atan2 TYNI_V(atan2)

#define TYNI_KERNEL "lanes/derived.h"
#include "lanes/each.h"

/* Calls a kernel's function for an ISA that was picked: TYNI_LANES_CALL(isa, raster_span, (p, count)). Direct calls, so that
 * whoever follows the calls (compilers, the proof of stack) sees them. */
#ifdef TYNI_LANES_AVX512
#define TYNI_LANES_CALL(isa, name, arguments)                                                                                  \
    ((isa) == TYN_ISA_AVX512 ? tyni_avx512_##name arguments                                                                    \
     : (isa) == TYN_ISA_AVX2 ? tyni_avx2_##name arguments                                                                      \
     : (isa) == TYN_ISA_SSE2 ? tyni_sse2_##name arguments                                                                      \
                             : tyni_scalar_##name arguments)
#elif defined(TYNI_LANES_X86)
#define TYNI_LANES_CALL(isa, name, arguments)                                                                                  \
    ((isa) == TYN_ISA_AVX2   ? tyni_avx2_##name arguments                                                                      \
     : (isa) == TYN_ISA_SSE2 ? tyni_sse2_##name arguments                                                                      \
                             : tyni_scalar_##name arguments)
#elif defined(TYNI_LANES_NEON)
#define TYNI_LANES_CALL(isa, name, arguments)                                                                                  \
    ((isa) == TYN_ISA_NEON ? tyni_neon_##name arguments : tyni_scalar_##name arguments)
#elif defined(TYNI_LANES_WASM)
#define TYNI_LANES_CALL(isa, name, arguments)                                                                                  \
    ((isa) == TYN_ISA_WASM ? tyni_wasm_##name arguments : tyni_scalar_##name arguments)
#else
#define TYNI_LANES_CALL(isa, name, arguments) ((void)(isa), tyni_scalar_##name arguments)
#endif

/* Whether an ISA has lanes side by side. Where none is built in the compiler knows. */
#if defined(TYNI_LANES_X86) || defined(TYNI_LANES_NEON) || defined(TYNI_LANES_WASM)
#define TYNI_LANES_WIDE(isa) ((isa) != TYN_ISA_SCALAR)
#else
#define TYNI_LANES_WIDE(isa) 0
#endif

/* From a config's isa to one that runs here. TYN_E_CONFIG for a number that is none, TYN_E_ISA for one that is not there. */
tyn_status tyni_lanes_choose(int32_t wanted, int32_t *isa);

#endif
