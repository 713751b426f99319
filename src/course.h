/* course.h - a straight line over a shadow map, step by step along its major axis: from step to step it crosses one texel, or
 * two that are neighbours along the other axis. */
#ifndef TYNI_COURSE_H
#define TYNI_COURSE_H

#include "door.h"
#include "lanes/lanes.h"

#include "base.h"

/* Starts at step coordinate 0, on a texel's border, where it is at `minor`, and rises by `slope` a step, -1 .. 1. */
typedef struct tyni_course {
    int32_t across; /* the major axis is u */
    float sign;     /* way along the major axis */
    float base;     /* texel border that is step coordinate 0 */
    float minor, slope;
    float from, to; /* step coordinates of its ends; from < 1 */
    int32_t steps;  /* at least 1 */
} tyni_course;

/* The texels of its steps. */
typedef struct tyni_cells {
    float minor, slope;
    int16_t first;      /* the texel of step 0 along the major axis */
    int8_t across, way; /* way: 1 or -1 */
} tyni_cells;

typedef char cells_fit[TYN_MAX_SHADOW <= 32768 ? 1 : -1];

/* From (u[0], v[0]) to (u[1], v[1]), in texels. */
void tyni_course_begin(tyni_course *course, const float u[2], const float v[2]);

/* Returns how many steps lie on the map. */
int32_t tyni_course_on(const tyni_course *course, const tyni_texels *texels, tyni_cells *cells);

#define TYNI_KERNEL "course_kernel.h"
#include "lanes/each.h"

/* Who follows a course reads texels side by side. Here and not in door.h, which most files include: compilers take half a
 * second over the intrinsics. */
#define TYNI_KERNEL "door_kernel.h"
#include "lanes/each.h"

#endif
