/* math.h - all that is asked of one: the square root is an instruction, the rest a few. */
#ifndef RISCV_MATH_H
#define RISCV_MATH_H

static inline float sqrtf(float x)
{
    float root;
    __asm__("fsqrt.s %0, %1" : "=f"(root) : "f"(x));
    return root;
}

/* Towards 0; from 2^23 on a float has no fraction. */
static inline float libc_trunc(float x)
{
    return __builtin_fabsf(x) < 8388608.0f ? __builtin_copysignf((float)(int)x, x) : x;
}

static inline float floorf(float x)
{
    float t = libc_trunc(x);
    return t > x ? t - 1.0f : t;
}

static inline float ceilf(float x)
{
    float t = libc_trunc(x);
    return t < x ? __builtin_copysignf(t + 1.0f, x) : t;
}

#endif
