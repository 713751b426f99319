/* fence.h - read-only copies of inputs that lie right against a page that must not be touched: any byte read beside them, and
 * any written into them, is a fault. */
#ifndef TYN_TEST_FENCE_H
#define TYN_TEST_FENCE_H

#include "tyndall.h"

typedef enum fence_side { FENCE_AFTER, FENCE_BEFORE } fence_side; /* where the page is that must not be touched */

enum { FENCE_MOST = 64 };

typedef struct fence_yard {
    fence_side side;
    int count;
    struct {
        void *map;
        size_t size;
    } fence[FENCE_MOST];
} fence_yard;

void *fence_copy(fence_yard *yard, const void *from, size_t bytes);
/* The image's pixels, which have no gaps, as a copy. */
void fence_image(fence_yard *yard, tyn_image *image);
/* A map's texels: square, without gaps. */
void fence_shadow(fence_yard *yard, tyn_shadow *s);
void fence_free(fence_yard *yard);

/* Calls it; 0: it faulted. */
int fence_try(void (*call)(void *argument), void *argument);

#endif
