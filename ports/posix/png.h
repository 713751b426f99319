/* png.h - 8-bit RGB pictures as PNG. */
#ifndef TOOL_PNG_H
#define TOOL_PNG_H

#include <stdint.h>
#include <stdio.h>

/* `rgba` has 4 bytes a pixel, sRGB, top row first without gaps; alpha is not written. -1: errno says why. */
int png_write(FILE *file, const uint8_t *rgba, int32_t width, int32_t height);

#endif
