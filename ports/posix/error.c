/* error.c */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define TOKEN_MAX 80
#define NAME_SHOWN 512 /* four names, one read on behalf of another, fit into a message */

static const char no_memory[] = "out of memory";

static size_t place(char *out, size_t size, const char *file, int32_t line, const char *token, size_t length)
{
    size_t n = 0, whole = strlen(file), cut = whole > NAME_SHOWN ? whole - NAME_SHOWN : 0;
    const char *dots = cut ? "..." : "", *name = whole ? file + cut : "''";
    int wrote =
        line > 0 ? snprintf(out, size, "%s%s:%ld: ", dots, name, (long)line) : snprintf(out, size, "%s%s: ", dots, name);
    if (wrote > 0)
        n = (size_t)wrote < size ? (size_t)wrote : size - 1;
    if (token && n + TOKEN_MAX + 16 < size) {
        size_t shown = length < TOKEN_MAX ? length : TOKEN_MAX;
        out[n++] = '\'';
        for (size_t i = 0; i < shown; i++)
            out[n++] = token[i] ? token[i] : '?'; /* of binary files: a NUL would end the message */
        wrote = snprintf(out + n, size - n, "%s': ", shown < length ? "..." : "");
        n += wrote > 0 ? (size_t)wrote : 0;
    }
    return n;
}

/* Bytes of the character at s if it is printable UTF-8, else 0. */
static int printable(const unsigned char *s)
{
    static const uint32_t least[5] = {0, 0, 0xa0, 0x800, 0x10000}; /* U+0080 .. U+009F are control characters */
    int length = *s < 0xc0 ? 1 : *s < 0xe0 ? 2 : *s < 0xf0 ? 3 : *s < 0xf8 ? 4 : 0;
    uint32_t point = length > 1 ? *s & (0x7fu >> length) : 0;
    if (length < 2)
        return length && *s >= 32 && *s < 127;
    for (int i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80)
            return 0;
        point = point << 6 | (s[i] & 0x3fu);
    }
    return point >= least[length] && point < 0x110000 && !(point >= 0xd800 && point < 0xe000) ? length : 0;
}

static void clean(char *text)
{
    for (char *c = text; *c;) {
        int length = printable((const unsigned char *)c);
        if (!length)
            *c = '?';
        c += length ? length : 1;
    }
}

int error_set(tool_error *e, const char *file, int32_t line, const char *token, size_t length, const char *format, ...)
{
    size_t n = place(e->text, sizeof e->text, file, line, token, length);
    va_list list;
    va_start(list, format);
    vsnprintf(e->text + n, sizeof e->text - n, format, list);
    va_end(list);
    clean(e->text);
    return -1;
}

int error_wrap(tool_error *e, const char *file, int32_t line, const char *token, size_t length)
{
    tool_error inner = *e;
    size_t n = place(e->text, sizeof e->text, file, line, token, length);
    snprintf(e->text + n, sizeof e->text - n, "%s", inner.text);
    clean(e->text);
    return -1;
}

int error_memory(tool_error *e)
{
    snprintf(e->text, sizeof e->text, "%s", no_memory);
    return -1;
}

void error_say(const char *format, ...)
{
    char text[sizeof((tool_error *)0)->text + 64];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    clean(text);
    fprintf(stderr, "tyndall: %s\n", text);
}

void error_report(const tool_error *e, const char *about)
{
    tool_error whole = *e;
    if (strcmp(whole.text, no_memory) == 0)
        error_wrap(&whole, about, 0, NULL, 0);
    error_say("%s", whole.text);
}
