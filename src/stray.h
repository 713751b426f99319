/* stray.h - pixels of a quad that are done one by one: those across an edge, those that no sample of their quad fits, and
 * frames that quad.c has no short way for. */
#ifndef TYNI_STRAY_H
#define TYNI_STRAY_H

#include "quads.h"

#include "base.h"

/* A pixel of any format, with a tone curve, and what is wanted besides the picture. s: metres to its surface. */
void tyni_stray_put(const tyni_quads *quads, int32_t x, int32_t row, const tyni_air *air, float s);

/* The light at a depth that neither of quad n's samples fits, from those beside or from between. 0: they are too far apart. */
int tyni_stray_about(const tyni_quads *quads, int32_t n, float z, const tyni_knot *knot, float light[3]);

/* Quad n's pixels by themselves, as many as there are: light is that of the two samples, or of the one that fits, or of those
 * beside. Where there are none, a pixel is marked as rejected. */
void tyni_stray_each(const tyni_quads *quads, int32_t n, int32_t rows, const tyni_knot *knot);

/* The rejected pixels of a row, by rays of their own. Not from within, for the sake of the stack. */
void tyni_stray_walk(const tyni_quads *quads, int32_t row);

#endif
