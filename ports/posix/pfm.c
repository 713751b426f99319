/* pfm.c */
#include "pfm.h"
#include "file.h"
#include "text.h"

#include <stdlib.h>
#include <string.h>

#include "tyndall.h"

typedef struct cursor {
    const char *at, *end;
    int32_t line;
} cursor;

static token next_token(cursor *c)
{
    token t;
    while (c->at < c->end && (*c->at == ' ' || (*c->at >= '\t' && *c->at <= '\r')))
        c->line += *c->at++ == '\n';
    t.start = c->at;
    while (c->at < c->end && *c->at != ' ' && !(*c->at >= '\t' && *c->at <= '\r'))
        c->at++;
    t.length = (size_t)(c->at - t.start);
    return t;
}

static int fail(tool_error *error, const char *path, const cursor *c, token t, const char *why)
{
    return error_set(error, path, c->line, t.length ? t.start : NULL, t.length, "%s", why);
}

static int size_token(token t, int32_t *out)
{
    int32_t value = 0;
    for (size_t i = 0; i < t.length; i++) {
        if (t.start[i] < '0' || t.start[i] > '9')
            return -1;
        value = value * 10 + (t.start[i] - '0');
        if (value > TYN_MAX_SIZE)
            return -1;
    }
    *out = value;
    return value > 0 ? 0 : -1;
}

static int parse(pfm *image, const char *path, const char *data, size_t size, tool_error *error)
{
    cursor c = {data, data + size, 1};
    token t = next_token(&c);
    float scale = 0.0f;
    size_t row, rows;
    if (!token_is(t, "PF") && !token_is(t, "Pf"))
        return fail(error, path, &c, t.length < 16 ? t : (token){t.start, 16}, "is not a PFM (PF or Pf)");
    image->channels = t.start[1] == 'F' ? 3 : 1;
    for (int i = 0; i < 2; i++) {
        t = next_token(&c);
        if (size_token(t, i ? &image->height : &image->width) != 0)
            return fail(error, path, &c, t, "must be a whole number from 1 to 32768");
    }
    t = next_token(&c);
    if (!token_number(t, &scale) || !(scale < 0.0f || scale > 0.0f))
        return fail(error, path, &c, t, "is no scale (a number that is not 0)");
    if (c.at == c.end)
        return fail(error, path, &c, t, "the file ends here");
    c.at++;
    row = (size_t)image->width * (size_t)image->channels;
    rows = (size_t)image->height;
    if (rows > SIZE_MAX / 4 / row || (size_t)(c.end - c.at) < 4 * row * rows)
        return fail(error, path, &c, (token){data, 2}, "the file is shorter than its header says");
    image->values = malloc(4 * row * rows);
    if (!image->values)
        return error_memory(error);
    for (size_t y = 0; y < rows; y++) {
        const unsigned char *from = (const unsigned char *)c.at + 4 * row * (rows - 1 - y);
        float *to = image->values + row * y;
        for (size_t x = 0; x < row; x++, from += 4) {
            uint32_t bits = scale < 0.0f ? from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24
                                         : from[3] | (uint32_t)from[2] << 8 | (uint32_t)from[1] << 16 | (uint32_t)from[0] << 24;
            memcpy(&to[x], &bits, 4);
        }
    }
    return 0;
}

int pfm_load(pfm *image, const char *path, tool_error *error)
{
    char *data = NULL;
    size_t size = 0;
    int result;
    const char *why = file_read(path, FILE_PICTURE, &data, &size);
    memset(image, 0, sizeof *image);
    if (why)
        return error_set(error, path, 0, NULL, 0, "can't be read: %s", why);
    result = parse(image, path, data, size, error);
    free(data);
    return result;
}

int pfm_write(FILE *file, const float *values, int32_t width, int32_t height, int32_t channels)
{
    size_t row = (size_t)width * (size_t)channels;
    unsigned char *bytes = malloc(4 * row);
    int result = 0;
    if (!bytes)
        return -1;
    if (fprintf(file, "%s\n%ld %ld\n-1.0\n", channels == 3 ? "PF" : "Pf", (long)width, (long)height) < 0)
        result = -1;
    for (int32_t y = height - 1; y >= 0 && result == 0; y--) {
        const float *from = values + row * (size_t)y;
        for (size_t x = 0; x < row; x++) {
            uint32_t bits;
            memcpy(&bits, &from[x], 4);
            for (int i = 0; i < 4; i++)
                bytes[4 * x + (size_t)i] = (unsigned char)(bits >> 8 * i);
        }
        if (fwrite(bytes, 4, row, file) != row)
            result = -1;
    }
    free(bytes);
    return result;
}
