/* guard.c - see guard.h */
#include "guard.h"

#include <stdlib.h>

#define BAND 16 /* bytes left and right; as many rows above and below would be a lot: 2 */

static uint8_t pattern(size_t i)
{
    return (uint8_t)(i * 37u + (i >> 8) + 11u);
}

guard guard_new(int32_t width, int32_t height, tyn_format format, int upside_down)
{
    guard g = {{NULL, 0, 0, 0, TYN_FORMAT_NONE}, NULL, 0};
    size_t row = 2 * BAND + (((size_t)width * (size_t)tyn_format_bytes(format) + 3) & ~(size_t)3);
    g.size = row * ((size_t)height + 4);
    g.block = malloc(g.size);
    if (!g.block)
        abort();
    g.image.width = width;
    g.image.height = height;
    g.image.format = format;
    g.image.stride = upside_down ? -(ptrdiff_t)row : (ptrdiff_t)row;
    g.image.pixels = g.block + row * (upside_down ? (size_t)height + 1 : 2) + BAND;
    guard_reset(&g);
    return g;
}

void guard_free(guard *g)
{
    free(g->block);
    g->block = NULL;
}

void guard_reset(guard *g)
{
    for (size_t i = 0; i < g->size; i++)
        g->block[i] = pattern(i);
}

int guard_intact(const guard *g)
{
    size_t row = (size_t)(g->image.stride < 0 ? -g->image.stride : g->image.stride);
    size_t used = (size_t)g->image.width * (size_t)tyn_format_bytes(g->image.format);
    for (size_t i = 0; i < g->size; i++) {
        size_t y = i / row, x = i % row;
        int pixel = y >= 2 && y < (size_t)g->image.height + 2 && x >= BAND && x < BAND + used;
        if (!pixel && g->block[i] != pattern(i))
            return 0;
    }
    return 1;
}

int guard_untouched(const guard *g)
{
    for (size_t i = 0; i < g->size; i++)
        if (g->block[i] != pattern(i))
            return 0;
    return 1;
}
