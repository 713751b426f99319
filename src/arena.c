/* arena.c - see arena.h */
#include "arena.h"

#include "base.h"

void *tyni_arena_take(tyni_arena *arena, size_t count, size_t bytes)
{
    const size_t mask = TYN_ALIGNMENT - 1;
    size_t at = arena->used, size;
    if (count && bytes > (SIZE_MAX - mask) / count) {
        arena->overflow = 1;
        return NULL;
    }
    size = (count * bytes + mask) & ~mask;
    if (size > SIZE_MAX - at) {
        arena->overflow = 1;
        return NULL;
    }
    arena->used = at + size;
    return arena->block ? arena->block + at : NULL;
}
