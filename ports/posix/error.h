/* error.h - one message about bad input: "file:line: 'token': what is wrong". */
#ifndef TOOL_ERROR_H
#define TOOL_ERROR_H

#include <stddef.h>
#include <stdint.h>

typedef struct tool_error {
    char text[4096]; /* empty: no error. Overlong paths are cut, never overrun */
} tool_error;

#if defined(__GNUC__)
#define TOOL_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define TOOL_PRINTF(f, a)
#endif

/* Sets the message and returns -1. line 0 and token NULL are left out; of long names and tokens a part is shown, so that there
 * is always room for what is wrong; what is not printable UTF-8 becomes '?', so that a file can't drive the terminal. */
int error_set(tool_error *e, const char *file, int32_t line, const char *token, size_t length, const char *format, ...)
    TOOL_PRINTF(6, 7);

/* Puts "file:line: 'token': " before the message, where a file is read on behalf of another. Returns -1. */
int error_wrap(tool_error *e, const char *file, int32_t line, const char *token, size_t length);

int error_memory(tool_error *e);

/* "tyndall: message" on stderr, one line, as printable as errors are. */
void error_say(const char *format, ...) TOOL_PRINTF(1, 2);

/* Says the error; `about` is the file to name where memory ran out. */
void error_report(const tool_error *e, const char *about);

#endif
