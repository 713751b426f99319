/* composite.h - colour in and the picture out: formats, exposure, tone curve, dither. */
#ifndef TYNI_COMPOSITE_H
#define TYNI_COMPOSITE_H

#include "base.h"
#include "lanes/lanes.h"

#define TYNI_COLOUR_FORMATS (1u << TYN_RGB_F32 | 1u << TYN_RGBA8_SRGB | 1u << TYN_BGRA8_SRGB | 1u << TYN_RGB565_SRGB)

/* sRGB decoding of a byte: 65535 times the root of the linear value, which keeps it to a 300th of a step of the byte. Dithering
 * tells a 128th apart, and what no light touches is to come back as it was. */
extern const uint16_t tyni_composite_srgb[256];
#define TYNI_COMPOSITE_ROOT (1.0f / 65535.0f)

/* 256 times the encoded level, 0 .. 255, by 1023 times the root of a linear value. */
extern const uint16_t tyni_composite_curve[1024];

/* 1.055 * 2^(5 / 12 e), e = -9 .. 0: what the exponent of a float adds to its sRGB encoding, 1.055 x^(1 / 2.4) - 0.055. By the
 * low four bits of the exponent as floats have it, which is 127 for e = 0. */
extern const float tyni_composite_octave[16];

/* What is added to 1/256 of a step before it is cut off, in pixels x % 8 of a row. */
void tyni_composite_dither(const tyn_display *display, int32_t y, uint32_t row[8]);

/* The same to a whole step, in 24 pixels of a row, the first of which has x % 8 = 0: 16 can be read from any of its first
 * eight. */
void tyni_composite_offsets(const tyn_display *display, int32_t y, float row[24]);

/* `count` pixels from (x, y) on as planes of linear red, green and blue, finite and not negative; black for an image without
 * pixels. isa: of tyni_lanes_choose. */
void tyni_composite_read(int32_t isa, const tyn_image *image, int32_t x, int32_t y, int32_t count, float *const rgb[3]);

/* Exposes, tone maps, dithers and encodes. Finite for any input. */
void tyni_composite_write(int32_t isa, const tyn_image *image, const tyn_display *display, int32_t x, int32_t y, int32_t count,
                          float *const rgb[3]);

/* share * colour + light, each, into an image that may be the colour itself: tyni_composite_write of what tyni_composite_read
 * has. */
void tyni_composite_blend(int32_t isa, const tyn_image *image, const tyn_display *display, const tyn_image *colour, int32_t x,
                          int32_t y, int32_t count, float *const share[3], float *const light[3]);

#define TYNI_KERNEL "format_kernel.h"
#include "lanes/each.h"

#endif
