/* pictures.h - what `render` and `post` do with their result: files and statistics. */
#ifndef TOOL_PICTURES_H
#define TOOL_PICTURES_H

#include "options.h"

typedef struct pictures {
    output_set set;
    FILE *out, *scatter, *surface, *depth; /* NULL: not wanted */
} pictures;

/* Opens what the options ask for; before the work, so that a folder without permission is known at once. -1: error set; abort
 * the set. */
int pictures_open(pictures *p, const options *o, tool_error *error);

/* -1: error set; abort the set. */
int pictures_write(pictures *p, const options *o, const render_result *r, tool_error *error);

void pictures_stats(const render_result *r, uint64_t load_ns, uint64_t start);

#endif
