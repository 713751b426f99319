/* draw.h - random scenes for tests of what holds for any. A failure prints the seed of its scene: TYN_SCENE=seed in the
 * environment draws that one alone. TYN_ROUNDS multiplies how many are drawn. */
#ifndef TYN_TEST_DRAW_H
#define TYN_TEST_DRAW_H

#include "rig.h"

typedef struct drawn {
    uint32_t seed;
    rig *r;
    const rig_way *way;
    tyn_config config;
    tyn_frame frame;
    size_t count; /* floats of a picture */
} drawn;

/* How many to draw. */
int draw_rounds(int count);

/* A scene and a way to draw it, all out of one number. */
drawn draw_one(void);

/* Checks and ends it; says which scene it was, if it failed. */
void draw_done(drawn *d, int holds);

/* Into the rig's buffers, as the frame says. */
void draw_render(const drawn *d);

/* Random numbers of its own; and a copy of floats for free(). */
double draw_between(double low, double high);
uint32_t draw_one_of(uint32_t count);
float *draw_copy(const float *from, size_t count);

#endif
