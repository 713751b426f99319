/* pair.h - sums and products of about 48 bits out of floats (Dekker, Knuth): high + low, |low| at most half a last place of
 * high. For planes that nearly run through the eye, where terms of single precision cancel. Exact as long as nothing is fused
 * or kept in wider registers, and numbers stay within 1e-15 .. 1e15. */
#ifndef TYNI_RASTER_PAIR_H
#define TYNI_RASTER_PAIR_H

#include "base.h"

typedef struct tyni_pair {
    float high, low;
} tyni_pair;

typedef struct tyni_pair3 {
    tyni_pair x, y, z;
} tyni_pair3;

static inline tyni_pair tyni_pair_sum(float a, float b)
{
    tyni_pair s;
    float part;
    s.high = a + b;
    part = s.high - a;
    s.low = (a - (s.high - part)) + (b - part);
    return s;
}

static inline tyni_pair tyni_pair_product(float a, float b)
{
    const float ca = 4097.0f * a, cb = 4097.0f * b; /* 2^12 + 1: the upper 12 bits of each */
    const float ah = ca - (ca - a), al = a - ah, bh = cb - (cb - b), bl = b - bh;
    tyni_pair p;
    p.high = a * b;
    p.low = ((ah * bh - p.high) + ah * bl + al * bh) + al * bl;
    return p;
}

static inline tyni_pair tyni_pair_add(tyni_pair a, tyni_pair b)
{
    const tyni_pair s = tyni_pair_sum(a.high, b.high);
    return tyni_pair_sum(s.high, s.low + (a.low + b.low));
}

static inline tyni_pair tyni_pair_mul(tyni_pair a, tyni_pair b)
{
    const tyni_pair p = tyni_pair_product(a.high, b.high);
    return tyni_pair_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static inline tyni_pair tyni_pair_negate(tyni_pair a)
{
    a.high = -a.high;
    a.low = -a.low;
    return a;
}

static inline tyni_pair tyni_pair_of(float a)
{
    tyni_pair p = {a, 0.0f};
    return p;
}

static inline tyni_pair tyni_pair_dot(const tyni_pair3 *a, const tyni_pair3 *b)
{
    return tyni_pair_add(tyni_pair_add(tyni_pair_mul(a->x, b->x), tyni_pair_mul(a->y, b->y)), tyni_pair_mul(a->z, b->z));
}

static inline tyni_pair tyni_pair_minor(tyni_pair a, tyni_pair b, tyni_pair c, tyni_pair d)
{
    return tyni_pair_add(tyni_pair_mul(a, b), tyni_pair_negate(tyni_pair_mul(c, d)));
}

static inline tyni_pair3 tyni_pair_cross(const tyni_pair3 *a, const tyni_pair3 *b)
{
    tyni_pair3 c;
    c.x = tyni_pair_minor(a->y, b->z, a->z, b->y);
    c.y = tyni_pair_minor(a->z, b->x, a->x, b->z);
    c.z = tyni_pair_minor(a->x, b->y, a->y, b->x);
    return c;
}

#endif
