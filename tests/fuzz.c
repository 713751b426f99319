/* fuzz.c - see fuzz.h */
#include "fuzz.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"

enum { MOST_TEXELS = 64, MOST_STRIDE = 2048, MOST_BLOCKS = 256 };

/* ---- numbers ---- */

uint32_t fuzz_byte(fuzz_bytes *f)
{
    if (!f->left)
        return 0;
    f->left--;
    return *f->at++;
}

uint32_t fuzz_word(fuzz_bytes *f)
{
    uint32_t word = fuzz_byte(f);
    word |= fuzz_byte(f) << 8;
    word |= fuzz_byte(f) << 16;
    return word | fuzz_byte(f) << 24;
}

static int32_t as_int(uint32_t word)
{
    int32_t i;
    memcpy(&i, &word, sizeof i);
    return i;
}

int32_t fuzz_int(fuzz_bytes *f)
{
    static const int32_t odd[] = {INT32_MAX, INT32_MIN,          255,          256,   1000,     1023, 1024, 4095, 4097, 65536,
                                  65537,     TYN_MAX_SHADOW + 1, TYN_MAX_SIZE, 32769, 16777216, -1000};
    uint32_t kind = fuzz_byte(f);
    if (kind < 192)
        return (int32_t)kind - 16;
    if (kind < 224)
        return as_int(UINT32_C(1) << (kind - 192));
    return kind < 240 ? odd[kind - 224] : as_int(fuzz_word(f));
}

float fuzz_float(fuzz_bytes *f)
{
    static const float odd[32] = {0,          -0.0f,     1,         -1,      0.5f,      -0.5f,   (float)NAN, HUGE_VALF,
                                  -HUGE_VALF, FLT_MAX,   -FLT_MAX,  FLT_MIN, 1e-45f,    -1e-45f, 1e12f,      -1e12f,
                                  1e24f,      1e-12f,    1e-6f,     1e6f,    0.999999f, 0.9999f, 1.0001f,    -0.9999f,
                                  2.967f,     3.141592f, 1.570796f, 0.1f,    40,        1e-30f,  1e30f,      16777216};
    uint32_t kind = fuzz_byte(f);
    if (kind < 32)
        return odd[kind];
    if (kind < 64) {
        uint32_t word = fuzz_word(f);
        float value;
        memcpy(&value, &word, sizeof value);
        return value;
    }
    return ldexpf((float)((int)kind - 160), (int)(fuzz_byte(f) % 64) - 32);
}

static void add(fuzz_slots *s, void *at, int count, int is_float)
{
    for (int i = 0; i < count && s->count < (int)(sizeof s->slot / sizeof *s->slot); i++) {
        s->slot[s->count].at = (char *)at + 4 * i;
        s->slot[s->count++].is_float = is_float;
    }
}

void fuzz_floats(fuzz_slots *s, float *at, int count)
{
    add(s, at, count, 1);
}

void fuzz_int_slots(fuzz_slots *s, void *at, int count)
{
    add(s, at, count, 0);
}

void fuzz_edit(fuzz_bytes *f, const fuzz_slots *s)
{
    uint32_t edits = fuzz_byte(f) % 64;
    for (uint32_t i = 0; i < edits && f->left; i++) {
        uint32_t which = fuzz_byte(f);
        which = (which | fuzz_byte(f) << 8) % (uint32_t)s->count;
        if (s->slot[which].is_float) {
            float value = fuzz_float(f);
            memcpy(s->slot[which].at, &value, sizeof value);
        } else {
            int32_t value = fuzz_int(f);
            memcpy(s->slot[which].at, &value, sizeof value);
        }
    }
}

/* ---- memory ---- */

static void *blocks[MOST_BLOCKS];
static int block_count;

static void *keep(void *block)
{
    if (!block || block_count == MOST_BLOCKS)
        abort();
    return blocks[block_count++] = block;
}

void *fuzz_memory(size_t bytes)
{
    return keep(malloc(bytes ? bytes : 1));
}

void *fuzz_block(size_t bytes)
{
    void *block = NULL;
    if (posix_memalign(&block, TYN_ALIGNMENT, bytes ? bytes : 1))
        abort();
    return keep(block);
}

void fuzz_release(void)
{
    while (block_count)
        free(blocks[--block_count]);
}

static uint32_t next(uint32_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 17;
    return *x ^= *x << 5;
}

/* A value 0 .. 1, but for those that are none. */
static float value_of(uint32_t kind, size_t i, uint32_t *random)
{
    static const float odd[] = {(float)NAN, HUGE_VALF, -HUGE_VALF, FLT_MAX, -FLT_MAX, 0, -0.0f, 1e-45f, 1, -1};
    uint32_t r = next(random);
    if (kind & 8 && r % 16 == 0)
        return odd[(r >> 8) % (sizeof odd / sizeof *odd)];
    switch (kind & 7) {
    case 0:
        return 0.5f;
    case 1:
        return (float)(i % 61) / 61.0f;
    case 2:
        return i / 7 % 2 ? 0.2f : 0.9f;
    case 3:
        return (float)(r >> 8) / 16777216.0f;
    case 4:
        return i % 5 ? 0.99f : 0.01f;
    case 5:
        return 0.0f;
    case 6:
        return 1.0f;
    default:
        return (float)(i % 500) / 500.0f;
    }
}

void fuzz_fill(void *at, size_t bytes, int component, uint32_t kind, uint32_t *random)
{
    uint8_t *to = at;
    for (size_t i = 0; (i + 1) * (size_t)component <= bytes; i++, to += component) {
        float value = value_of(kind, i, random) * (kind & 16 ? 30.0f : 1.0f);
        float part = value > 0 ? (value < 1 ? value : 1) : 0;
        uint16_t half = (uint16_t)(part * 65535.0f);
        if (component == 4)
            memcpy(to, &value, 4);
        else if (component == 2)
            memcpy(to, &half, 2);
        else
            *to = (uint8_t)(part * 255.0f);
    }
}

/* Bytes of `rows` rows of `row` bytes, `stride` apart, and where the first begins; 0: must be refused. */
static size_t room(int64_t rows, int64_t row, int64_t stride, size_t *first)
{
    int64_t apart = stride < 0 ? -stride : stride;
    apart = apart < row ? row : apart;
    *first = stride < 0 ? (size_t)((rows - 1) * apart) : 0;
    return (size_t)((rows - 1) * apart + row);
}

fuzz_picture fuzz_picture_new(tyn_image *image)
{
    fuzz_picture p = {image, NULL, NULL, 64};
    size_t first = 0;
    int32_t bytes = tyn_format_bytes(image->format);
    if (image->width > MOST_TEXELS && image->width <= TYN_MAX_SIZE)
        image->width = TYN_MAX_SIZE + 1;
    if (image->height > MOST_TEXELS && image->height <= TYN_MAX_SIZE)
        image->height = 0;
    if (image->stride > MOST_STRIDE || image->stride < -MOST_STRIDE)
        image->stride = 1;
    if (image->width >= 1 && image->width <= MOST_TEXELS && image->height >= 1 && image->height <= MOST_TEXELS)
        p.size = room(image->height, (int64_t)image->width * (bytes ? bytes : 4), image->stride, &first);
    p.block = fuzz_memory(p.size);
    p.before = fuzz_memory(p.size);
    image->pixels = p.block + first;
    for (size_t i = 0; i < p.size; i++)
        p.block[i] = (uint8_t)(i * 37 + 11);
    fuzz_keep(&p);
    return p;
}

void fuzz_shadow_texels(tyn_shadow *shadow, uint32_t *random, uint32_t kind)
{
    int32_t height = shadow->height ? shadow->height : shadow->size, bytes = shadow->format == TYN_DEPTH_U16 ? 2 : 4;
    size_t first = 0, size = 64;
    uint8_t *block;
    if (shadow->size > MOST_TEXELS && shadow->size <= TYN_MAX_SHADOW)
        shadow->size = TYN_MAX_SHADOW + 1;
    if (height > MOST_TEXELS && height <= TYN_MAX_SHADOW)
        shadow->height = -1;
    if (shadow->stride > MOST_STRIDE || shadow->stride < -MOST_STRIDE)
        shadow->stride = 1;
    if (shadow->size >= 1 && shadow->size <= MOST_TEXELS && height >= 1 && height <= MOST_TEXELS)
        size = room(height, (int64_t)shadow->size * bytes, shadow->stride, &first);
    block = fuzz_memory(size);
    fuzz_fill(block, size, bytes, kind, random);
    shadow->depth = block + first;
}

void fuzz_keep(fuzz_picture *p)
{
    memcpy(p->before, p->block, p->size);
}

void fuzz_restore(fuzz_picture *p)
{
    memcpy(p->block, p->before, p->size);
}

int fuzz_untouched(const fuzz_picture *p)
{
    return memcmp(p->block, p->before, p->size) == 0;
}

int fuzz_framed(const fuzz_picture *p)
{
    const tyn_image *image = p->image;
    const size_t row = (size_t)image->width * (size_t)tyn_format_bytes(image->format);
    const size_t apart = image->stride ? (size_t)(image->stride < 0 ? -image->stride : image->stride) : row;
    for (size_t i = 0; i < p->size; i++)
        if (i % apart >= row && p->block[i] != p->before[i])
            return 0;
    return 1;
}

int fuzz_good(const fuzz_picture *p, float most)
{
    const tyn_image *image = p->image;
    const ptrdiff_t apart = image->stride ? image->stride : (ptrdiff_t)image->width * 12;
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < 3 * image->width; x++) {
            float value;
            memcpy(&value, (const char *)image->pixels + y * apart + 4 * x, sizeof value);
            if (!(value >= 0 && value <= most))
                return 0;
        }
    return 1;
}

static void run_reversed(void *context, tyn_job job, void *argument, int32_t count)
{
    const int32_t workers = *(const int32_t *)context;
    for (int32_t i = count - 1; i >= 0; i--)
        job(argument, i, i % workers);
}

tyn_executor fuzz_reversed(int32_t *workers)
{
    tyn_executor e = {run_reversed, workers, *workers};
    return e;
}

/* ---- files ---- */

void fuzz_files(const uint8_t *data, size_t size, const char *const *names, int count)
{
    size_t at = 0;
    for (int i = 0; i < count; i++) {
        size_t end = at;
        while (end < size && data[end] != 1)
            end++;
        files_write(names[i], end > at ? data + at : NULL, end - at); /* an input of no bytes is NULL */
        at = end < size ? end + 1 : end;
    }
}

void fuzz_shadow_slots(fuzz_slots *s, tyn_shadow *m, int32_t *stride)
{
    fuzz_int_slots(s, &m->size, 1);
    fuzz_floats(s, m->matrix, 16);
    fuzz_int_slots(s, &m->height, 1);
    fuzz_int_slots(s, &m->format, 1);
    fuzz_int_slots(s, stride, 1);
    fuzz_int_slots(s, &m->coding, 1);
    fuzz_floats(s, &m->at_near, 1);
    fuzz_floats(s, &m->at_far, 1);
    fuzz_floats(s, &m->scale, 1);
    fuzz_floats(s, &m->bias, 1);
}

void fuzz_light_slots(fuzz_slots *s, tyn_light *l)
{
    fuzz_int_slots(s, &l->kind, 1);
    fuzz_floats(s, l->position, 3);
    fuzz_floats(s, l->direction, 3);
    fuzz_floats(s, l->colour, 3);
    fuzz_floats(s, &l->angle, 1);
    fuzz_int_slots(s, &l->more_count, 1);
    fuzz_int_slots(s, &l->outside, 1);
    fuzz_int_slots(s, &l->texture_count, 1);
    fuzz_floats(s, l->up, 3);
    fuzz_floats(s, l->extent, 2);
}
