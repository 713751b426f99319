/* arena.h - carves the caller's block. Without a block it only counts, so that measuring and placing are one path. */
#ifndef TYNI_ARENA_H
#define TYNI_ARENA_H

#include "base.h"

typedef struct tyni_arena {
    uint8_t *block; /* NULL: count only */
    size_t used;    /* bytes, a multiple of TYN_ALIGNMENT */
    int overflow;   /* a size did not fit size_t */
} tyni_arena;

/* count * bytes, aligned to TYN_ALIGNMENT; NULL without a block. */
void *tyni_arena_take(tyni_arena *arena, size_t count, size_t bytes);

#endif
