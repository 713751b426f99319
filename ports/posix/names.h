/* names.h - numbers for names: of materials, of files. Finding one takes the bits of the name asked for at most, whatever else
 * is there: names made to collide cost no more than others. */
#ifndef TOOL_NAMES_H
#define TOOL_NAMES_H

#include <stddef.h>
#include <stdint.h>

/* Zero bytes are an empty set. */
typedef struct name_set {
    struct name {
        char *text; /* with a NUL after its length */
        size_t length;
        /* An inner node that came with the name: where those below part. */
        size_t byte;
        uint8_t bit;
        int32_t below[2]; /* by that bit; from 0: a name; else the complement of a node */
    } * all;
    int32_t count, capacity, root;
} name_set;

/* The number of a name, which is the old count if it is new; -1: no memory. Names don't end in NUL bytes, or are of one length.
 */
int32_t names_find(name_set *n, const void *text, size_t length);
void names_free(name_set *n);

#endif
