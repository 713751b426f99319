/* guard.h - images with a band of known bytes on all four sides, to see that a call writes its pixels and nothing else. */
#ifndef TYN_TEST_GUARD_H
#define TYN_TEST_GUARD_H

#include "tyndall.h"

typedef struct guard {
    tyn_image image;
    uint8_t *block;
    size_t size;
} guard;

/* A guarded image, pixels and bands filled with a pattern; `upside_down`: its stride is negative. */
guard guard_new(int32_t width, int32_t height, tyn_format format, int upside_down);
void guard_free(guard *g);

/* The pattern again, everywhere. */
void guard_reset(guard *g);

int guard_intact(const guard *g);    /* the bands are as they were */
int guard_untouched(const guard *g); /* so are the pixels */

#endif
