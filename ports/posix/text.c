/* text.c */
#include "text.h"
#include "file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int text_open(text *t, const char *file, text_kind kind, tool_error *error)
{
    size_t size = 0;
    const char *why, *zero;
    memset(t, 0, sizeof *t);
    t->file = file;
    t->kind = kind;
    t->error = error;
    why = file_read(file, FILE_TEXT, &t->data, &size);
    if (why)
        return error_set(error, file, 0, NULL, 0, "can't be read: %s", why);
    zero = memchr(t->data, '\0', size);
    if (zero) {
        int32_t line = 1;
        for (const char *p = t->data; p < zero; p++)
            line += *p == '\n' && line < INT32_MAX;
        error_set(error, file, line, "\\0", 2, "a NUL byte: this is not a text file");
        text_close(t);
        return -1;
    }
    t->next = t->at = t->line_end = t->data;
    t->end = t->data + size;
    return 0;
}

void text_close(text *t)
{
    free(t->data);
    t->data = NULL;
}

static int is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r'); /* carriage returns are blanks: so CRLF works */
}

static char *line_break(char *from, char *end)
{
    char *p = from < end ? memchr(from, '\n', (size_t)(end - from)) : NULL;
    return p ? p : end;
}

int text_line(text *t)
{
    char *stop;
    if (t->next >= t->end)
        return 0;
    t->line += 1 + t->joined;
    t->joined = 0;
    t->at = t->next;
    stop = line_break(t->next, t->end);
    if (t->kind == TEXT_OBJ && *t->at != '#') { /* a comment may well end in the backslash of a path */
        for (;;) {
            char *last = stop;
            while (last > t->at && last[-1] == '\r')
                last--;
            if (stop == t->end || last == t->at || last[-1] != '\\')
                break;
            last[-1] = ' ';
            *stop = ' ';
            t->joined++;
            stop = line_break(stop + 1, t->end);
        }
    }
    t->next = stop < t->end ? stop + 1 : t->end;
    t->line_end = stop;
    if (t->kind == TEXT_SCENE) {
        char *hash = memchr(t->at, '#', (size_t)(stop - t->at));
        if (hash)
            t->line_end = hash;
    }
    return 1;
}

int text_token(text *t, token *out)
{
    char *p = t->at, *end = t->line_end;
    while (p < end && is_blank(*p))
        p++;
    if (p < end && *p == '#' && t->kind == TEXT_OBJ)
        p = end;
    out->start = p;
    while (p < end && !is_blank(*p))
        p++;
    out->length = (size_t)(p - out->start);
    t->at = p;
    return out->length > 0;
}

int text_rest(text *t, token *out)
{
    if (!text_token(t, out))
        return 0;
    t->at = t->line_end;
    while (is_blank(t->at[-1])) /* ends at the token at the latest */
        t->at--;
    out->length = (size_t)(t->at - out->start);
    return 1;
}

int token_is(token t, const char *word)
{
    return strlen(word) == t.length && memcmp(t.start, word, t.length) == 0;
}

static int slow_number(token t, float *out)
{
    char room[64], *copy = t.length < sizeof room ? room : malloc(t.length + 1), *end;
    float value;
    int good;
    if (!copy)
        return 0;
    memcpy(copy, t.start, t.length);
    copy[t.length] = '\0';
    value = strtof(copy, &end);
    good = end == copy + t.length && isfinite(value);
    if (copy != room)
        free(copy);
    if (good)
        *out = value;
    return good;
}

/* Plain decimals without strtof, five times as fast: digits as an integer below 2^53 and a power of ten up to 10^22 are exact
 * in double, so one division or product rounds once. Rounding that to float is right unless it lies next to the middle
 * between two floats; those, and all that is unusual, go to strtof. */
int token_number(token t, float *out)
{
    static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                  1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char *p = t.start, *end = p + t.length;
    uint64_t digits = 0, bits;
    int count = 0, after = 0, negative, point = 0;
    volatile double value; /* volatile: rounded to 64 bits also where registers are wider */
    negative = t.length > 0 && *p == '-';
    p += t.length > 0 && (*p == '-' || *p == '+');
    for (; p < end; p++) {
        if (*p >= '0' && *p <= '9') {
            digits = digits * 10 + (uint64_t)(*p - '0');
            count++;
            after += point;
        } else if (*p == '.' && !point) {
            point = 1;
        } else {
            return slow_number(t, out);
        }
        if (count > 15)
            return slow_number(t, out);
    }
    if (count == 0)
        return 0;
    value = (double)digits / tens[after];
    if (digits != 0 && value < 1e-30)
        return slow_number(t, out);
    {
        double plain = value;
        memcpy(&bits, &plain, sizeof bits);
    }
    bits &= 0x1fffffff; /* the bits that a float has not */
    if (bits - 0x0fffffff <= 2)
        return slow_number(t, out);
    *out = (float)(negative ? -value : value);
    return 1;
}

int text_number(text *t, token of, float *out)
{
    token number;
    if (!text_token(t, &number))
        return text_fail(t, of, "a number is missing after it");
    if (!token_number(number, out))
        return text_fail(t, number, "is not a finite number");
    return 0;
}

int text_fail(text *t, token at, const char *format, ...)
{
    char message[512];
    va_list list;
    va_start(list, format);
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    return error_set(t->error, t->file, t->line, at.length ? at.start : NULL, at.length, "%s", message);
}
