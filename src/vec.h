/* vec.h - vectors of three floats. */
#ifndef TYNI_VEC_H
#define TYNI_VEC_H

#include <math.h>

#include "base.h"

typedef struct tyni_vec3 {
    float x, y, z;
} tyni_vec3;

static inline tyni_vec3 tyni_vec(float x, float y, float z)
{
    tyni_vec3 v = {x, y, z};
    return v;
}

static inline tyni_vec3 tyni_vec_load(const float v[3])
{
    return tyni_vec(v[0], v[1], v[2]);
}
static inline tyni_vec3 tyni_vec_add(tyni_vec3 a, tyni_vec3 b)
{
    return tyni_vec(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline tyni_vec3 tyni_vec_sub(tyni_vec3 a, tyni_vec3 b)
{
    return tyni_vec(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline tyni_vec3 tyni_vec_scale(tyni_vec3 a, float s)
{
    return tyni_vec(a.x * s, a.y * s, a.z * s);
}
/* a + s b */
static inline tyni_vec3 tyni_vec_mad(tyni_vec3 a, float s, tyni_vec3 b)
{
    return tyni_vec(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline float tyni_vec_dot(tyni_vec3 a, tyni_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline tyni_vec3 tyni_vec_cross(tyni_vec3 a, tyni_vec3 b)
{
    return tyni_vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline float tyni_vec_length(tyni_vec3 a)
{
    return sqrtf(tyni_vec_dot(a, a));
}

/* Of length 1; the zero vector stays zero. */
static inline tyni_vec3 tyni_vec_normalise(tyni_vec3 a)
{
    float length = tyni_vec_length(a);
    return length > 0.0f ? tyni_vec_scale(a, 1.0f / length) : a;
}

static inline int tyni_vec_finite(tyni_vec3 a)
{
    return tyni_finite(a.x) && tyni_finite(a.y) && tyni_finite(a.z);
}

#endif
