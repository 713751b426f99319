/* entry.h - one epipolar sample as it is kept in memory: 32 bits.
 *
 * What is kept is visibility, the light divided by tyni_integral_norm, for the channel of the least and that of the largest
 * extinction (a coloured light: for red and green, and blue in an array of its own): 10 bits each, as a square root relative to
 * the line's largest, since the eye (and relative error) wants fine steps in the dark. The depth it belongs to takes 12 bits, a
 * float's own: 0 = no sample, else steps of 1/256 over 15 octaves below far. */
#ifndef TYNI_ENTRY_H
#define TYNI_ENTRY_H

#include <math.h>

#include "base.h"

#define TYNI_ENTRY_FLOOR 0x38000000u     /* bits of 2^-15 */
#define TYNI_ENTRY_NEAREST 3.0577183e-5f /* what the first code stands for */

/* inverse = 1 / scale of the line, or 0 for a dark one. depth is relative to far, 0 .. 1. */
static inline uint32_t tyni_entry_pack(float low, float high, const float inverse[2], float depth)
{
    uint32_t bits = tyni_float_bits(depth), code = bits > TYNI_ENTRY_FLOOR ? ((bits - TYNI_ENTRY_FLOOR) >> 15) + 1 : 1;
    uint32_t a = (uint32_t)(sqrtf(tyni_clampf(low * inverse[0], 0.0f, 1.0f)) * 1023.0f + 0.5f);
    uint32_t b = (uint32_t)(sqrtf(tyni_clampf(high * inverse[1], 0.0f, 1.0f)) * 1023.0f + 0.5f);
    return a | b << 10 | code << 20;
}

static inline uint32_t tyni_entry_code(uint32_t entry)
{
    return entry >> 20;
}

/* Relative to far; the middle of the step. */
static inline float tyni_entry_depth(uint32_t entry)
{
    return tyni_bits_float(((entry >> 20) - 1) * 0x8000u + TYNI_ENTRY_FLOOR + 0x4000u);
}

/* The third channel of a coloured light, kept apart. */
static inline uint16_t tyni_entry_third(float value, float inverse)
{
    return (uint16_t)(sqrtf(tyni_clampf(value * inverse, 0.0f, 1.0f)) * 65535.0f + 0.5f);
}

static inline float tyni_entry_third_value(uint16_t third, float scale)
{
    float q = (float)third * (1.0f / 65535.0f);
    return q * q * scale;
}

static inline float tyni_entry_low(uint32_t entry, float scale)
{
    float q = (float)(entry & 1023u) * (1.0f / 1023.0f);
    return q * q * scale;
}

static inline float tyni_entry_high(uint32_t entry, float scale)
{
    float q = (float)(entry >> 10 & 1023u) * (1.0f / 1023.0f);
    return q * q * scale;
}

#endif
