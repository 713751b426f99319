/* debug.h - pictures of how a picture is made. */
#ifndef TYNI_DEBUG_H
#define TYNI_DEBUG_H

#include "gather.h"
#include "slice.h"
#include "view.h"

#include "base.h"

/* Writes what each sample is in place of its light. */
void tyni_debug_mark(uint32_t *entries, const uint32_t *rays, const uint32_t *breaks, int32_t first, int32_t last);

/* Draws over one pixel. */
void tyni_debug_pixel(tyn_debug debug, const tyni_view *view, const tyni_lamp *lamp, const tyni_slices *slices,
                      const tyni_field *field, int32_t x, int32_t y, float depth, int rejected, float rgb[3]);

#endif
