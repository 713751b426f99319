/* meter.h - the light of a ray's lit intervals, in the making (IVB eq. 15 and 16): integral(end) - integral(start) over all of
 * them. Whoever finds the intervals switches it on and off. */
#ifndef TYNI_METER_H
#define TYNI_METER_H

#include "medium.h"
#include "view.h"

#include "base.h"

/* Switched at rising t within a piece of a row or a map, in any order of pieces. What is summed is whatever differs from
 * `outside`: shadows where all else is lit, light where all else is dark. */
typedef struct tyni_meter {
    const tyni_integral *integral; /* begun for the ray v */
    const tyni_lamp *lamp;
    const tyni_sight *v;
    float *sum; /* one value for each channel of the integral */
    float from; /* t of the last switch */
    int outside, on;
} tyni_meter;

void tyni_meter_begin(tyni_meter *meter, const tyni_integral *integral, const tyni_lamp *lamp, const tyni_sight *v, float *sum);

/* From t on the ray is lit, or not. */
void tyni_meter_lit(tyni_meter *meter, int lit, float t);

/* The end: what was not switched is as `outside` says, and shadows are as strong as the frame wants them. */
void tyni_meter_end(tyni_meter *meter);

#endif
