/* bits.c - see bits.h */
#include "bits.h"

/* The dots that are on at light n / 64 are those below n: each bit of x ^ y and y, turned round (Bayer 1973). */
static int32_t threshold(int32_t x, int32_t y)
{
    int32_t n = 0;
    for (int32_t bit = 0; bit < 3; bit++)
        n = n << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
    return n;
}

/* 0 .. 65535. Squares are close to sRGB's curve, and cost nothing. */
static int32_t light_of(uint16_t pixel)
{
    const int32_t r = pixel >> 11, g = pixel >> 5 & 63, b = pixel & 31;
    const int32_t red = r * r * 65535 / (31 * 31), green = g * g * 16384 / (63 * 63) * 4, blue = b * b * 65535 / (31 * 31);
    return (54 * red + 183 * green + 19 * blue) / 256;
}

void bits_dither(const tyn_image *picture, int32_t exposure, uint8_t *bits, ptrdiff_t stride)
{
    const ptrdiff_t from = picture->stride ? picture->stride : 2 * (ptrdiff_t)picture->width;
    for (int32_t y = 0; y < picture->height; y++) {
        const uint16_t *pixel = (const void *)((const uint8_t *)picture->pixels + y * from);
        uint8_t *to = bits + y * stride;
        for (int32_t x = 0; x < picture->width; x++) {
            const int32_t limit = 1024 * threshold(x & 7, y & 7) + 512;
            const uint8_t bit = (uint8_t)(128 >> (x & 7));
            if (light_of(pixel[x]) / 256 * exposure > limit)
                to[x >> 3] |= bit;
            else
                to[x >> 3] &= (uint8_t)~bit;
        }
    }
}
