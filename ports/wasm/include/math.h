/* math.h - what src/ wants of it where there is no libc: the machine has instructions for all three (-fno-math-errno). */
#ifndef TYNDALL_WASM_MATH_H
#define TYNDALL_WASM_MATH_H

float sqrtf(float x);
float floorf(float x);
float ceilf(float x);

#endif
