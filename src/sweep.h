/* sweep.h - the visibility of a whole row, kept while the view ray sweeps over the slice.
 *
 * From one end of the slice's line to the other the position of the view ray rises, and a column that is dark once stays dark:
 * all that happens is that columns go dark one after the other, in the order of their thresholds. They are sorted by the sample
 * at which they do (a counting sort, one bucket a sample), and each flips one bit. A ray then finds its words made: 32 columns
 * for one load, where a comparing machine without vectors does 32 compares. */
#ifndef TYNI_SWEEP_H
#define TYNI_SWEEP_H

#include "row.h"
#include "slice.h"

#include "base.h"

typedef struct tyni_sweep {
    /* arrays of the caller's; see tyni_sweep_rooms */
    uint32_t *order;              /* columns in the order in which they go dark; those that never do are left out */
    uint32_t *heads;              /* bucket b of the order is heads[b] .. heads[b + 1] - 1: dark from the sample of rank b on */
    uint32_t *bits;               /* bit c % 32 of word c / 32: column c is lit */
    uint16_t *position;           /* of the ray of a rank */
    int32_t samples;              /* ranks */
    int32_t first, last, falling; /* samples; falling: rank 0 is the last */
    uint32_t at;                  /* so much of the order is dark */
} tyni_sweep;

/* Entries of bits for so many columns: one more than they fill, since a word may begin anywhere. heads has samples + 1. */
static inline size_t tyni_sweep_words(size_t columns)
{
    return columns / 32 + 2;
}

/* Sorts the row for the samples of a slice and stands before the first ray: nothing but what is always dark is dark. */
void tyni_sweep_begin(tyni_sweep *sweep, const tyni_row *row, const tyni_slice *slice);

/* Moves to a sample, either way. */
void tyni_sweep_to(tyni_sweep *sweep, int32_t sample);

/* Visibility of columns c .. c + 31; bits past the end of the row are 0 or 1. */
static inline uint32_t tyni_sweep_word(const tyni_sweep *sweep, int32_t c)
{
    const uint32_t *word = &sweep->bits[c >> 5];
    int32_t shift = c & 31;
    return shift ? word[0] >> shift | word[1] << (32 - shift) : word[0];
}

#endif
