/* pixel.h - from finished lines to pixels: visibility, light, and after the last light the picture. A job of tyni_jobs_run; the
 * argument is a tyni_pass. */
#ifndef TYNI_PIXEL_H
#define TYNI_PIXEL_H

#include "run.h"

#include "base.h"

void tyni_pixel_band(void *pass, int32_t index, int32_t worker);

#endif
