/* file.h - whole files into memory, and names relative to another file. */
#ifndef TOOL_FILE_H
#define TOOL_FILE_H

#include <stddef.h>
#include <stdint.h>

typedef enum file_kind {
    FILE_TEXT,   /* holds no NUL */
    FILE_PICTURE /* starts with a P: PPM, PGM and PFM */
} file_kind;

/* Reads a file or a pipe; *data is malloc'ed and has a NUL after its *size bytes. NULL where it worked, else what is wrong.
 * What is not of its kind is not read to the end, and may have none. */
const char *file_read(const char *path, file_kind kind, char **data, size_t *size);

/* As open() does, but waits some seconds only for the other end of a named pipe. -1: *why is set. */
int file_open(const char *path, int flags, const char **why);

/* `name` as seen from the folder of the file `base`; malloc'ed, NULL without memory. */
char *file_beside(const char *base, const char *name, size_t length);

/* The name without folders. */
const char *file_base(const char *path);

/* Where all links lead, there or not yet; malloc'ed. NULL: errno says why. */
char *file_behind_links(const char *path);

/* What a file has alone, however it is called. -1: there is none. */
int file_key(const char *path, uintmax_t key[2]);

/* Whether two names are those of one file, there or not yet; of two files in one folder. */
int file_same(const char *a, const char *b);
int file_same_folder(const char *a, const char *b);

#endif
