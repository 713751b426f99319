/* bits.h - a picture for a display of black and white dots. */
#ifndef NULL_BITS_H
#define NULL_BITS_H

#include "tyndall.h"

/* One dot a bit, white 1, the leftmost in the highest bit, rows of `stride` bytes: an ordered dither of a TYN_RGB565_SRGB
 * picture whose mean is the picture's light. `exposure`: 256 leaves the light as it is, 512 doubles it. Integers alone. */
void bits_dither(const tyn_image *picture, int32_t exposure, uint8_t *bits, ptrdiff_t stride);

#endif
