/* quads.h - two rows of pixels in quads: what quad.c and stray.c share of them.
 *
 * Channels are in the order in which the colours' bytes lie in memory, and all light is exposed: times `gain`, at which 1 is
 * the square of TYNI_QUADS_LEVELS. A pixel is share * colour + (1 - share) * light; the share falls with the distance, what is
 * meant by light hardly does: it is what a ray would have if it were infinitely long and as lit as the one at hand. */
#ifndef TYNI_QUADS_H
#define TYNI_QUADS_H

#include <math.h>

#include "composite.h"
#include "entry.h"
#include "pass.h"

#include "base.h"

/* Part of its caller's loop, but where size counts. */
#if defined(__OPTIMIZE_SIZE__)
#define TYNI_QUADS_INLINE static inline
#else
#define TYNI_QUADS_INLINE TYNI_INLINE
#endif

/* Roots of linear values, 0 .. 1, are taken in so many steps: fine enough to tell 255 levels apart, 0.4 of one in the dark. */
#define TYNI_QUADS_LEVELS 1023.0f /* the last of tyni_composite_curve */

/* What 1 is in weighed roots of visibility: 10 bits of an entry times 64. */
#define TYNI_QUADS_ROOTS 65472.0f

/* Where e^-(extinction s) is known: at 16 distances an octave, over ten octaves up to the farthest. Between them goes a
 * tangent, which is off by less than 0.0003, and by less than 0.003 where it serves depths an eighth of an octave apart. */
#define TYNI_QUADS_FADES 162
#define TYNI_QUADS_OCTAVE 16
#define TYNI_QUADS_FADE_BITS 19 /* of a float below those that tell them apart */

/* Depths that belong together lie within this many float steps of each other: an eighth of an octave either way, twice what
 * makes a break. */
#define TYNI_QUADS_WINDOW (1 << 20)

/* The least sum of weights of 64. */
#define TYNI_QUADS_ENOUGH ((uint32_t)(64.0f * TYNI_GATHER_ENOUGH) + 1u)

/* Metres a ray goes per depth, and what shines there where all is lit, for visibility's roots. */
typedef struct tyni_knot {
    float length, glow[3];
} tyni_knot;

typedef struct tyni_quads {
    const tyni_pass *pass;
    const tyn_frame *frame;
    const float *decode;     /* of 256 levels, exposed */
    float (*fade)[3];        /* of each distance */
    int32_t base;            /* bits of the first */
    uint32_t twice;          /* the same of twice the distance */
    const uint32_t *entries; /* samples of all lines, `pitch` a line */
    ptrdiff_t pitch;
    float far, near;     /* the farthest depth, and 1 over it */
    float gain, inverse; /* and 1 over it */
    float most;          /* the square of TYNI_QUADS_LEVELS. Where it has that name, compilers branch */
    float falls[3];      /* -extinction */
    float glow[3];       /* the sun's colour over extinction, for visibility's roots */
    float blend[3];      /* where a channel lies between the two whose visibility is kept */
    int32_t red;         /* which channel that is: 0 or 2 */
    int32_t span;        /* pixels from knot to knot */
    int32_t run;         /* pixels at a time, at most */
    int32_t y, x, count;
    const float *depth[2]; /* rows y and y + 1, pixels x .. x + count - 1 */
    const uint8_t *from[2];
    uint8_t *to[2];
    int32_t from_bytes, to_bytes; /* of pixels */
    int32_t *entry, *part;        /* of each quad: its first line's sample, and 1/64 of the way to the next line */
    tyni_knot *knot, *rise;       /* in the middle of the two rows; from there to the next two */
    const uint32_t (*dither)[8];  /* of both rows */
    int plain;                    /* bytes to bytes in one order, no tone curve, and nothing but the picture is wanted */
    uint32_t *rejected[2];        /* bits */
    tyn_stats *stats;
} tyni_quads;

/* The share is known at `from` metres, and goes on by its slope. Flat: one share for all pixels there are, and the light is
 * times 1 - share. */
typedef struct tyni_air {
    float share[3], slope[3], from, light[3];
    int flat;
} tyni_air;

/* Which of red, green and blue a channel is. */
static inline int32_t tyni_quads_colour(const tyni_quads *q, int32_t channel)
{
    return q->red ? 2 - channel : channel;
}

/* ---- the air ---- */

/* The nearest fade to s metres. */
TYNI_QUADS_INLINE void tyni_quads_fade(const tyni_quads *q, float s, tyni_air *a)
{
    const uint32_t half = 1u << (TYNI_QUADS_FADE_BITS - 1);
    const int32_t i =
        tyni_clampi((int32_t)((tyni_float_bits(s) + half) >> TYNI_QUADS_FADE_BITS) - q->base, 0, TYNI_QUADS_FADES - 1);
    a->flat = 0;
    a->from = tyni_bits_float((uint32_t)(q->base + i) << TYNI_QUADS_FADE_BITS);
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        a->share[c] = q->fade[i][c];
        a->slope[c] = q->falls[c] * q->fade[i][c];
    }
}

TYNI_QUADS_INLINE void tyni_quads_share(const tyni_air *a, float s, float share[3])
{
    const float away = s - a->from;
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        share[c] = a->share[c] + a->slope[c] * away;
}

/* Two 10-bit roots as the halves of a word, with room for a weight of 64 in all. */
TYNI_QUADS_INLINE uint32_t tyni_quads_roots(uint32_t entry)
{
    return (entry & 0x3ffu) | (entry & 0xffc00u) << 6;
}

/* The nearest bits of a depth, in metres, that a sample fits: fewer than 2 TYNI_QUADS_WINDOW farther are as good. */
TYNI_QUADS_INLINE uint32_t tyni_quads_low(const tyni_quads *q, uint32_t entry)
{
    return tyni_float_bits(q->far * tyni_entry_depth(entry)) - TYNI_QUADS_WINDOW;
}

/* From weighed roots of visibility and what shines where all is lit. Between the least and the largest extinction a root goes
 * straight: visibility falls about exponentially with extinction. */
TYNI_QUADS_INLINE void tyni_quads_light(const tyni_quads *q, float low, float high, const float glow[3], float light[3])
{
    const float more = high - low;
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        const float root = low + q->blend[c] * more;
        light[c] = root * root * glow[c];
    }
}

/* ---- pixels ---- */

/* 256 times the level, 0 .. 255. x: not below 0. */
TYNI_QUADS_INLINE uint32_t tyni_quads_level(const tyni_quads *q, float x)
{
    return tyni_composite_curve[(ptrdiff_t)sqrtf(tyni_minf(x, q->most))];
}

/* Of a plain frame. */
TYNI_QUADS_INLINE void tyni_quads_put(const tyni_quads *q, const uint8_t *from, uint8_t *to, const float light[3],
                                      const float share[3], uint32_t dither)
{
    const float x = q->decode[from[0]] - light[0], y = q->decode[from[1]] - light[1], z = q->decode[from[2]] - light[2];
    to[0] = (uint8_t)((tyni_quads_level(q, light[0] + share[0] * x) + dither) >> 8);
    to[1] = (uint8_t)((tyni_quads_level(q, light[1] + share[1] * y) + dither) >> 8);
    to[2] = (uint8_t)((tyni_quads_level(q, light[2] + share[2] * z) + dither) >> 8);
    to[3] = 255;
}

#endif
