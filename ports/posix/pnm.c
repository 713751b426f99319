/* pnm.c */
#include "pnm.h"
#include "file.h"

#include <stdlib.h>
#include <string.h>

typedef enum purpose { COLOUR, MASK, COUNTS } purpose; /* COUNTS: 16 bits as they stand in the file */

typedef struct pnm {
    const char *file;
    const unsigned char *start, *at, *end;
    tool_error *error;
} pnm;

/* The line is counted only when there is an error. */
static int fail(const pnm *p, const unsigned char *at, size_t length, const char *why)
{
    int32_t line = 1;
    for (const unsigned char *c = p->start; c < at; c++)
        line += *c == '\n' && line < INT32_MAX;
    return error_set(p->error, p->file, line, length ? (const char *)at : NULL, length, "%s", why);
}

static int is_blank(unsigned char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* A decimal number after blanks and comments, at most `limit`. */
static int number(pnm *p, uint32_t limit, uint32_t *out)
{
    uint32_t value = 0;
    const unsigned char *from;
    while (p->at < p->end && (is_blank(*p->at) || *p->at == '#')) {
        if (*p->at == '#')
            while (p->at < p->end && *p->at != '\n')
                p->at++;
        else
            p->at++;
    }
    from = p->at;
    if (from == p->end)
        return fail(p, from, 0, "the file ends where a number should be");
    while (p->at < p->end && *p->at >= '0' && *p->at <= '9') {
        if (value <= limit)
            value = value * 10 + (uint32_t)(*p->at - '0');
        p->at++;
    }
    while (p->at < p->end && !is_blank(*p->at)) { /* "12x": not a number, and a whole token to show */
        if (*p->at == '#' && p->at > from)
            break;
        p->at++;
        value = UINT32_MAX;
    }
    if (p->at == from || value == UINT32_MAX)
        return fail(p, from, (size_t)(p->at - from), "is not a whole number");
    if (value > limit)
        return fail(p, from, (size_t)(p->at - from), "is too large");
    *out = value;
    return 0;
}

static int sample(pnm *p, int plain, uint32_t maxval, uint32_t *out)
{
    if (plain)
        return number(p, maxval, out);
    *out = p->at[0];
    if (maxval > 255)
        *out = *out << 8 | p->at[1];
    if (*out > maxval)
        return fail(p, p->at, 0, "a sample is above maxval");
    p->at += maxval > 255 ? 2 : 1;
    return 0;
}

static int fill(pnm *p, tyn_image *image, size_t count, int plain, uint32_t maxval)
{
    uint8_t *bytes = image->pixels;
    uint16_t *words = image->pixels;
    uint32_t v = 0;
    if (image->format == TYN_RGB8_LINEAR && !plain) {
        memcpy(bytes, p->at, count);
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        if (sample(p, plain, maxval, &v) != 0)
            return -1;
        if (image->format == TYN_RGB8_LINEAR)
            bytes[i] = (uint8_t)v;
        else if (image->format == TYN_MASK8)
            bytes[i] = v * 2 < maxval ? 0 : 255;
        else if (image->format == TYN_DEPTH_U16)
            words[i] = (uint16_t)v;
        else
            words[i] = (uint16_t)((v * 65535u + maxval / 2) / maxval);
    }
    return 0;
}

static tyn_image *read_image(scene *s, pnm *p, purpose use, uint32_t *top)
{
    uint32_t width = 0, height = 0, maxval = 0;
    size_t count, left;
    int plain, mask = use != COLOUR;
    tyn_image *image;
    const char *binary_magic = mask ? "P5" : "P6", *plain_magic = mask ? "P2" : "P3";
    if (p->end - p->at < 3 || (memcmp(p->at, binary_magic, 2) != 0 && memcmp(p->at, plain_magic, 2) != 0) ||
        !(is_blank(p->at[2]) || p->at[2] == '#')) {
        size_t length = 0;
        while (length < 8 && p->at + length < p->end && !is_blank(p->at[length]))
            length++;
        fail(p, p->at, length, mask ? "is not a PGM (P5 or P2)" : "is not a PPM (P6 or P3)");
        return NULL;
    }
    plain = p->at[1] == plain_magic[1];
    p->at += 2;
    if (number(p, TYN_MAX_SIZE, &width) != 0 || number(p, TYN_MAX_SIZE, &height) != 0 || number(p, 65535, &maxval) != 0)
        return NULL;
    if (width == 0 || height == 0 || maxval == 0) {
        fail(p, p->at, 0, "width, height and maxval must be at least 1");
        return NULL;
    }
    if (p->at == p->end || !is_blank(*p->at)) {
        fail(p, p->at, 0, "a blank is missing after maxval");
        return NULL;
    }
    p->at++;
    /* Before anything is allocated: does the file hold what its header claims? Plain samples take two bytes but for the last.
     */
    left = (size_t)(p->end - p->at);
    count = mask ? 1 : 3;
    if ((size_t)width > SIZE_MAX / 8 / height / count) {
        fail(p, p->at, 0, "the image is too large");
        return NULL;
    }
    count *= (size_t)width * height;
    if (plain ? left < count * 2 - 1 : left < count * (maxval > 255 ? 2 : 1)) {
        fail(p, p->start, 2, "the file is shorter than its header says");
        return NULL;
    }
    *top = maxval;
    image = scene_add_image(s, (int32_t)width, (int32_t)height,
                            use == COUNTS   ? TYN_DEPTH_U16
                            : use == MASK   ? TYN_MASK8
                            : maxval == 255 ? TYN_RGB8_LINEAR
                                            : TYN_RGB16_LINEAR);
    if (!image) {
        error_memory(p->error);
        return NULL;
    }
    return fill(p, image, count, plain, maxval) == 0 ? image : NULL;
}

static tyn_image *load(scene *s, const char *path, purpose use, uint32_t *top, tool_error *error)
{
    char *data = NULL;
    size_t size = 0;
    pnm p = {path, NULL, NULL, NULL, error};
    tyn_image *image;
    const char *why = file_read(path, FILE_PICTURE, &data, &size);
    if (why) {
        error_set(error, path, 0, NULL, 0, "can't be read: %s", why);
        return NULL;
    }
    p.start = p.at = (const unsigned char *)data;
    p.end = p.start + size;
    image = read_image(s, &p, use, top);
    free(data);
    return image;
}

tyn_image *pnm_load_colour(scene *s, const char *path, tool_error *error)
{
    uint32_t top;
    return load(s, path, COLOUR, &top, error);
}

tyn_image *pnm_load_mask(scene *s, const char *path, tool_error *error)
{
    uint32_t top;
    return load(s, path, MASK, &top, error);
}

tyn_image *pnm_load_counts(scene *s, const char *path, int32_t *maxval, tool_error *error)
{
    uint32_t top = 0;
    tyn_image *image = load(s, path, COUNTS, &top, error);
    *maxval = (int32_t)top;
    return image;
}

tyn_image *texture_load(texture_cache *cache, scene *s, const char *path, int mask, tool_error *error)
{
    uintmax_t key[3] = {0, 0, (uintmax_t)mask};
    int32_t count = cache->files.count, at;
    int there = file_key(path, key) == 0; /* else reading it will tell */
    at = there ? names_find(&cache->files, key, sizeof key) : count;
    if (at < 0) {
        error_memory(error);
        return NULL;
    }
    if (there && at >= cache->capacity) {
        tyn_image **more = realloc(cache->images, (size_t)cache->files.capacity * sizeof *more);
        if (!more) {
            error_memory(error);
            return NULL;
        }
        cache->images = more;
        cache->capacity = cache->files.capacity;
    }
    if (at < count)
        return cache->images[at];
    tyn_image *image = mask ? pnm_load_mask(s, path, error) : pnm_load_colour(s, path, error);
    if (there)
        cache->images[at] = image;
    return image;
}

void texture_cache_free(texture_cache *cache)
{
    names_free(&cache->files);
    free(cache->images);
    memset(cache, 0, sizeof *cache);
}
