/* num.h - the library's own exp, log, sin, cos and atan: libm's differ between machines, these give the same bits on all.
 * Relative error below 4e-7 unless stated; tests measure it. */
#ifndef TYNI_NUM_H
#define TYNI_NUM_H

#include "base.h"

/* e^x. Below -87 it is 0, above 88 it holds e^88. NaN gives 0. */
float tyni_num_exp(float x);

/* (1 - e^-x) / x for x >= 0, with its limit 1 at 0: the integral over a unit length of depth x. */
float tyni_num_fog(float x);

/* Natural logarithm of a positive normal number; others give that of the smallest. */
float tyni_num_log(float x);

/* |x| <= 8192. Absolute error below 2e-7. */
void tyni_num_sincos(float x, float *sine, float *cosine);

/* Angle of the point (x, y) to the x axis, -pi .. pi; 0 for (0, 0). Absolute error below 5e-7. */
float tyni_num_atan2(float y, float x);

#endif
