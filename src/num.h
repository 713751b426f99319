/* num.h - the library's own exp, log, sin and cos: libm's differ between machines, these give the same bits on all. Tests
 * measure the stated errors. */
#ifndef TYNI_NUM_H
#define TYNI_NUM_H

#include "base.h"

/* e^x, relative error below 3e-7. Below -87 it is 0, above 88 it is e^88, for NaN 0. */
float tyni_num_exp(float x);

/* (1 - e^-x) / x with its limit 1 at 0: the mean of e^-t over 0 .. x. x >= 0, relative error below 4e-7. */
float tyni_num_fog(float x);

/* What is left of light after an optical depth of x >= 0, e^-x with a relative error below (6 + x) * 1e-7, and what is
 * lost, 1 - e^-x, below 8e-7. Beyond 87.3 and for NaN 2^-126 is left. */
void tyni_num_fade(float x, float *left, float *lost);

/* Natural logarithm of a positive normal number, error below 3e-7 of max(1, |log x|); -87.3 for what is less or NaN. */
float tyni_num_log(float x);

/* |x| <= 8192, absolute error below 3e-7. */
void tyni_num_sincos(float x, float *sine, float *cosine);

/* Angle of the point (x, y) to the x axis, -pi .. pi, relative error below 3e-7 (small angles too); 0 for (0, 0). */
float tyni_num_atan2(float y, float x);

#endif
