/* files.h - small files for the tests of the tool, in a folder of their own below build/. */
#ifndef TEST_FILES_H
#define TEST_FILES_H

#include <stddef.h>

/* The name of a file there. A few calls' results stay valid. */
const char *files_path(const char *name);

/* Writes a file there and gives its name. */
const char *files_write(const char *name, const void *bytes, size_t size);
const char *files_text(const char *name, const char *text);

/* Reads any file; malloc'ed, with a NUL after it. NULL: there is none. */
char *files_read(const char *path, size_t *size);

/* Removes the folder with all that is in it. */
void files_remove(void);

#endif
