/* file.h - whole files into memory, and names relative to another file. */
#ifndef TOOL_FILE_H
#define TOOL_FILE_H

#include <stddef.h>

/* Reads a file or a pipe; *data is malloc'ed and has a NUL after its *size bytes. NULL where it worked, else what is wrong. */
const char *file_read(const char *path, char **data, size_t *size);

/* `name` as seen from the folder of the file `base`; malloc'ed, NULL without memory. */
char *file_beside(const char *base, const char *name, size_t length);

#endif
