/* png.c */
#include "png.h"
#include "deflate.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct writer {
    FILE *file;
    uint32_t crc_table[256];
} writer;

static void make_table(writer *w)
{
    for (uint32_t n = 0; n < 256; n++) {
        uint32_t c = n;
        for (int k = 0; k < 8; k++)
            c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
        w->crc_table[n] = c;
    }
}

static uint32_t crc(const writer *w, uint32_t c, const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        c = w->crc_table[(c ^ bytes[i]) & 255] ^ c >> 8;
    return c;
}

static void big_endian(uint8_t out[4], uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

static int chunk(writer *w, const char *name, const uint8_t *bytes, size_t count)
{
    uint8_t head[8], tail[4];
    uint32_t sum;
    big_endian(head, (uint32_t)count);
    memcpy(head + 4, name, 4);
    sum = crc(w, 0xffffffffu, head + 4, 4);
    sum = crc(w, sum, bytes, count);
    big_endian(tail, ~sum);
    if (fwrite(head, 1, 8, w->file) != 8 || fwrite(bytes, 1, count, w->file) != count || fwrite(tail, 1, 4, w->file) != 4)
        return -1;
    return 0;
}

static int data_chunk(void *context, const unsigned char *bytes, size_t count)
{
    return chunk(context, "IDAT", bytes, count);
}

static int distance(int a, int b)
{
    return a < b ? b - a : a - b;
}

static uint8_t paeth(int left, int up, int corner)
{
    int p = left + up - corner, by_left = distance(p, left), by_up = distance(p, up), by_corner = distance(p, corner);
    return (uint8_t)(by_left <= by_up && by_left <= by_corner ? left : by_up <= by_corner ? up : corner);
}

/* One row under filter 0 .. 4; gives the sum of the sizes of what is left, by which filters are compared. */
static uint64_t filter_row(int filter, const uint8_t *row, const uint8_t *above, size_t bytes, uint8_t *out)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < bytes; i++) {
        int left = i < 3 ? 0 : row[i - 3], up = above[i], corner = i < 3 ? 0 : above[i - 3], guess = 0;
        switch (filter) {
        case 1:
            guess = left;
            break;
        case 2:
            guess = up;
            break;
        case 3:
            guess = (left + up) / 2;
            break;
        case 4:
            guess = paeth(left, up, corner);
            break;
        }
        out[i] = (uint8_t)(row[i] - guess);
        sum += out[i] < 128 ? out[i] : 256u - out[i];
    }
    return sum;
}

static void filter_image(const uint8_t *rgba, int32_t width, int32_t height, uint8_t *rows, uint8_t *out)
{
    size_t bytes = 3 * (size_t)width;
    uint8_t *row = rows, *above = rows + bytes, *trial = rows + 2 * bytes;
    memset(above, 0, bytes);
    for (int32_t y = 0; y < height; y++, out += bytes + 1) {
        uint64_t best = UINT64_MAX;
        const uint8_t *from = rgba + 4 * (size_t)width * (size_t)y;
        uint8_t *swap = above;
        for (size_t x = 0; x < (size_t)width; x++)
            memcpy(row + 3 * x, from + 4 * x, 3);
        for (int filter = 0; filter < 5; filter++) {
            uint64_t sum = filter_row(filter, row, above, bytes, trial);
            if (sum < best) {
                best = sum;
                out[0] = (uint8_t)filter;
                memcpy(out + 1, trial, bytes);
            }
        }
        above = row;
        row = swap;
    }
}

int png_write(FILE *file, const uint8_t *rgba, int32_t width, int32_t height)
{
    static const uint8_t magic[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    size_t bytes = 3 * (size_t)width + 1, size = bytes * (size_t)height;
    uint8_t header[13] = {0}, intent = 0, *filtered, *rows;
    int result = -1;
    writer w;
    if (size / (size_t)height != bytes) {
        errno = ENOMEM;
        return -1;
    }
    w.file = file;
    make_table(&w);
    big_endian(header, (uint32_t)width);
    big_endian(header + 4, (uint32_t)height);
    header[8] = 8; /* bits */
    header[9] = 2; /* RGB */
    filtered = malloc(size);
    rows = malloc(3 * bytes);
    if (filtered && rows) {
        filter_image(rgba, width, height, rows, filtered);
        if (fwrite(magic, 1, 8, file) == 8 && chunk(&w, "IHDR", header, 13) == 0 && chunk(&w, "sRGB", &intent, 1) == 0 &&
            deflate_zlib(filtered, size, data_chunk, &w) == 0 && chunk(&w, "IEND", header, 0) == 0)
            result = 0;
    }
    free(filtered);
    free(rows);
    return result;
}
