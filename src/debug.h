/* debug.h - pictures of how a picture is made. */
#ifndef TYNI_DEBUG_H
#define TYNI_DEBUG_H

#include "pass.h"

#include "base.h"

/* Views for which a line holds what each sample is in place of its light. */
static inline int tyni_debug_marks(tyn_debug debug)
{
    return TYNI_HAS(TYN_PART_DEBUG) &&
           (debug == TYN_DEBUG_LINES || debug == TYN_DEBUG_SAMPLES || debug == TYN_DEBUG_BREAKS || debug == TYN_DEBUG_SOURCES);
}

/* Writes it: first what the initial rays and breaks are; after refinement the new rays, and of each sample its first source. */
void tyni_debug_mark_initial(const tyni_pass *pass, int32_t line, const tyni_slice *slice, const uint32_t *rays,
                             const uint32_t *breaks);
void tyni_debug_mark_sources(const tyni_pass *pass, int32_t line, const tyni_slice *slice, const uint32_t *rays);

/* Draws over one pixel of the picture. `rejected`: it had a ray of its own. */
void tyni_debug_pixel(const tyni_pass *pass, int32_t x, int32_t y, float depth, int rejected, float rgb[3]);

#endif
