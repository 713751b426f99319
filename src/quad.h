/* quad.h - pixels four at a time: tyn_config.quads, for machines without vectors. Plain C on all.
 *
 * The 2 x 2 pixels of a quad mostly lie at about one depth. They then share their two lines' visibility, the phase function and
 * one exponential, from which each pixel's own is a tangent away; what is left for each is its colour and its encoding. Pixels
 * of a quad across an edge are done one by one, from the same lines where those fit, else as pixel.c does. */
#ifndef TYNI_QUAD_H
#define TYNI_QUAD_H

#include "pass.h"

#include "base.h"

/* Whether a frame's only light goes this way; else pixel.c has it. By configuration and frame alone, never by ISA. */
int tyni_quad_takes(const tyni_pass *pass);

/* Between slices and pixels: each worker's table of exponentials, where its bundle was. */
void tyni_quad_begin(const tyni_pass *pass);

/* A job in the place of tyni_pixel_band. */
void tyni_quad_band(void *pass, int32_t index, int32_t worker);

#endif
