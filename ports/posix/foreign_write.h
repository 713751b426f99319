/* foreign_write.h - a rendered scene as files that `tyndall post` takes: `tyndall render --frame`. */
#ifndef TOOL_FOREIGN_WRITE_H
#define TOOL_FOREIGN_WRITE_H

#include "output.h"
#include "render.h"

/* Adds PREFIX.frame, .depth.pfm, .colour.pfm, each light's maps and texture to the set. The result has maps and surface. -1:
 * error set; the set is to be aborted. */
int foreign_write(output_set *set, const char *prefix, const scene *s, const render_result *result, tool_error *error);

/* What is wrong with a prefix as part of names in a frame file; NULL: nothing. */
const char *foreign_prefix_fault(const char *prefix);

/* Whether foreign_write makes, or may make, a file of this name. */
int foreign_prefix_takes(const char *prefix, const char *name);

#endif
