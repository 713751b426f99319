/* noise.h - numbers that look random and are the same everywhere: for the built-in scenes. */
#ifndef TOOL_NOISE_H
#define TOOL_NOISE_H

#include <stdint.h>

/* A well mixed number for a lattice point. */
uint32_t noise_hash(int32_t x, int32_t y, uint32_t seed);

/* The same as 0 .. 1 (1 excluded). */
float noise_unit(int32_t x, int32_t y, uint32_t seed);

/* The next number of a sequence, low .. high; *state is the sequence's place. */
float noise_next(uint32_t *state, float low, float high);

/* Gradient noise, about -1 .. 1, 0 on lattice points. Repeats after `period` in both directions; 0: never.
 * slope (may be NULL) gets the derivatives. */
float noise_gradient(float x, float y, int32_t period, uint32_t seed, float slope[2]);

/* Octaves of it, each at twice the frequency and half the height: about -1 .. 1. */
float noise_sum(float x, float y, int32_t octaves, int32_t period, uint32_t seed);

/* Distance to the nearest of one random point per cell (F1) and to the second (F2), for stones, leaves, cracks. */
void noise_cells(float x, float y, int32_t period, uint32_t seed, float *f1, float *f2, uint32_t *which);

#endif
