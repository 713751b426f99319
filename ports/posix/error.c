/* error.c */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define TOKEN_MAX 80

static size_t place(char *out, size_t size, const char *file, int32_t line, const char *token, size_t length)
{
    size_t n = 0;
    int wrote = line > 0 ? snprintf(out, size, "%s:%ld: ", file, (long)line) : snprintf(out, size, "%s: ", file);
    if (wrote > 0)
        n = (size_t)wrote < size ? (size_t)wrote : size - 1;
    if (token && n + TOKEN_MAX + 16 < size) {
        size_t shown = length < TOKEN_MAX ? length : TOKEN_MAX;
        out[n++] = '\'';
        for (size_t i = 0; i < shown; i++) {
            unsigned char c = (unsigned char)token[i];
            out[n++] = (char)(c < 32 || c == 127 ? '?' : c);
        }
        wrote = snprintf(out + n, size - n, "%s': ", shown < length ? "..." : "");
        n += wrote > 0 ? (size_t)wrote : 0;
    }
    return n;
}

int error_set(tool_error *e, const char *file, int32_t line, const char *token, size_t length, const char *format, ...)
{
    size_t n = place(e->text, sizeof e->text, file, line, token, length);
    va_list list;
    va_start(list, format);
    vsnprintf(e->text + n, sizeof e->text - n, format, list);
    va_end(list);
    return -1;
}

int error_wrap(tool_error *e, const char *file, int32_t line, const char *token, size_t length)
{
    tool_error inner = *e;
    size_t n = place(e->text, sizeof e->text, file, line, token, length);
    snprintf(e->text + n, sizeof e->text - n, "%s", inner.text);
    return -1;
}

int error_memory(tool_error *e)
{
    snprintf(e->text, sizeof e->text, "out of memory");
    return -1;
}
