/* relief.h - the surface that a depth buffer shows: its depths in metres, without holes, and as triangles. */
#ifndef TOOL_RELIEF_H
#define TOOL_RELIEF_H

#include "foreign.h"

/* View-space depth of each pixel, 0 .. far_depth; `known` (one byte a pixel) is 0 where nothing was measured: there `depth` is
 * made up from what is around it, smoothly, so that neither a hole nor a box is seen. -1: no memory. */
int relief_depths(const foreign *f, float *depth, uint8_t *known);

/* The known pixels as a mesh of the scene: neighbours hang together where they differ by less than `jump`, relative to the
 * nearer. With a thickness, walls that long go away from the camera at such edges. Sky makes none. -1: no memory. */
int relief_mesh(foreign *f, const float *depth, const uint8_t *known, float jump, float thickness);

#endif
