/* test_pictures.c - what the tool reads and writes: PPM, PGM, PFM, PNG, and the files' way to their names. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "deflate.h"
#include "files.h"
#include "output.h"
#include "pfm.h"
#include "png.h"
#include "pnm.h"
#include "render.h"
#include "test.h"

/* ---- PPM and PGM ------------------------------------------------------------------------------------------------------ */

static tyn_image *load_pnm(scene *s, const char *bytes, size_t size, int mask, tool_error *error)
{
    const char *path = files_write("t.pnm", bytes, size);
    scene_init(s);
    return mask ? pnm_load_mask(s, path, error) : pnm_load_colour(s, path, error);
}

static void test_pnm_values(void)
{
    tool_error error;
    scene s;
    tyn_image *i;
    static const char commented[] = "P6\n# a comment\n1 # another\n2\n255\nabcdef";
    static const char deep[] = "P6\n1 1\n65535\n\x01\x02\xff\xff\x00\x00";
    TEST("PPM and PGM values");
    i = load_pnm(&s, commented, sizeof commented - 1, 0, &error);
    CHECK(i && i->format == TYN_RGB8_LINEAR && i->width == 1 && i->height == 2 && memcmp(i->pixels, "abcdef", 6) == 0);
    scene_free(&s);
    i = load_pnm(&s, deep, sizeof deep - 1, 0, &error);
    CHECK(i && i->format == TYN_RGB16_LINEAR && ((uint16_t *)i->pixels)[0] == 0x0102 && ((uint16_t *)i->pixels)[1] == 65535);
    scene_free(&s);
    i = load_pnm(&s, "P3 1 1 1000 0 500 1000", 22, 0, &error);
    CHECK(i && i->format == TYN_RGB16_LINEAR && ((uint16_t *)i->pixels)[1] == 32768 && ((uint16_t *)i->pixels)[2] == 65535);
    scene_free(&s);
    i = load_pnm(&s, "P3\n1 1 255 0\n1 2", 16, 0, &error);
    CHECK(i && i->format == TYN_RGB8_LINEAR && ((uint8_t *)i->pixels)[2] == 2);
    scene_free(&s);
    i = load_pnm(&s, "P2 4 1 9 0 4 5 9", 16, 1, &error);
    CHECK(i && i->format == TYN_MASK8 && memcmp(i->pixels, "\0\0\xff\xff", 4) == 0);
    scene_free(&s);
    i = load_pnm(&s, "P5 2 1 255\n\x7f\x80", 13, 1, &error);
    CHECK(i && memcmp(i->pixels, "\0\xff", 2) == 0);
    scene_free(&s);
}

/* What is wrong with 3 GB that are not there: 32 bits cannot even count them as floats. */
#if SIZE_MAX > 0xffffffffu
#define ENORMOUS "shorter"
#else
#define ENORMOUS "the image is too large"
#endif

static void test_pnm_errors(void)
{
    static const struct {
        const char *bytes, *place;
        int mask;
    } bad[] = {
        {"", "t.pnm:1: ", 0},
        {"P7 1 1 255 abc", "t.pnm:1: 'P7'", 0},
        {"P61 1 255 abc", "t.pnm:1: 'P61'", 0},
        {"P5 1 1 255 a", "t.pnm:1: 'P5'", 0},
        {"P6 1 1 255 abc", "t.pnm:1: 'P6'", 1},
        {"P6 0 1 255 abc", "at least 1", 0},
        {"P6 1 0 255 abc", "at least 1", 0},
        {"P6 1 1 0 abc", "at least 1", 0},
        {"P6\n1\n-1 255 abc", "t.pnm:3: '-1'", 0},
        {"P6\n1 1x 255 abc", "t.pnm:2: '1x'", 0},
        {"P6 32769 1 255 abc", "t.pnm:1: '32769'", 0},
        {"P6 99999999999 1 255 abc", "t.pnm:1: '99999999999'", 0},
        {"P6 1 1 65536 abcdef", "t.pnm:1: '65536'", 0},
        {"P6 1 1 255", "blank", 0},
        {"P6 1 1 255 ab", "shorter", 0},
        {"P6 1 1 256 abcde", "shorter", 0},
        {"P6 32768 32768 255 abc", ENORMOUS, 0},
        {"P6 32768 32768 65535 abc", ENORMOUS, 0},
        {"P3 32768 32768 255 1 2 3", ENORMOUS, 0},
        {"P5 32768 32768 255 abc", ENORMOUS, 1},
        {"P6 1 1 97 abz", "above maxval", 0},
        {"P3 1 1 97 1 2 98", "t.pnm:1: '98'", 0},
        {"P3 1 1 97 1\n2 x", "t.pnm:2: 'x'", 0},
        {"P3 1 1 255 1   2    ", "ends", 0},
        {"P2 2 1 255 1   ", "ends", 1},
    };
    TEST("wrong PPM and PGM files");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        tool_error error = {""};
        scene s;
        tyn_image *image = load_pnm(&s, bad[i].bytes, strlen(bad[i].bytes), bad[i].mask, &error);
        if (image || !strstr(error.text, bad[i].place))
            printf("  \"%s\" gave: %s\n", bad[i].bytes, image ? "no error" : error.text);
        CHECK(!image && strstr(error.text, bad[i].place));
        scene_free(&s);
    }
}

/* ---- PFM -------------------------------------------------------------------------------------------------------------- */

static void test_pfm(void)
{
    static const float values[12] = {0.0f, -1.5f, 2.0f, 1e-40f, 3e38f, 5.0f, 6.0f, 7.0f, 8.0f, 9.0f, 10.0f, 11.0f};
    static const char big[] = "Pf\n2 1\n1.0\n\x3f\x80\0\0\xc0\0\0\0";
    static const char *const bad[] = {"",
                                      "P6\n1 1\n-1\nabcd",
                                      "Pf\n1\n",
                                      "Pf\n0 1\n-1\nabcd",
                                      "Pf\n1 32769\n-1\nabcd",
                                      "Pf\n1 1\n0\nabcd",
                                      "Pf\n1 1\nx\nabcd",
                                      "Pf\n1 1\n-1\nabc",
                                      "Pf\n1 1\n-1",
                                      "PF\n32768 32768\n-1\nabcdabcdabcd"};
    tool_error error;
    pfm image;
    size_t size = 0;
    const char *path = files_path("t.pfm");
    FILE *file = fopen(path, "wb");
    char *bytes;
    TEST("PFM there and back");
    CHECK(file && pfm_write(file, values, 2, 2, 3) == 0 && fclose(file) == 0);
    bytes = files_read(path, &size);
    CHECK(bytes && size == 12 + 48 && memcmp(bytes, "PF\n2 2\n-1.0\n", 12) == 0);
    CHECK(bytes && memcmp(bytes + 12 + 24 + 8, "\0\0\0\x40", 4) == 0); /* little-endian 2.0 in the last row: the top one */
    free(bytes);
    CHECK(pfm_load(&image, path, &error) == 0);
    CHECK(image.width == 2 && image.height == 2 && image.channels == 3);
    CHECK(image.values && memcmp(image.values, values, sizeof values) == 0);
    free(image.values);
    CHECK(pfm_load(&image, files_write("t.pfm", big, sizeof big - 1), &error) == 0);
    CHECK(image.channels == 1 && image.values && image.values[0] == 1.0f && image.values[1] == -2.0f);
    free(image.values);
    TEST("wrong PFM files");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK(pfm_load(&image, files_text("t.pfm", bad[i]), &error) == -1 && strstr(error.text, "t.pfm"));
}

/* ---- deflate, PNG ------------------------------------------------------------------------------------------------------ */

typedef struct inflater {
    const uint8_t *in;
    size_t at, bits, size; /* bit position within in[at] is bits */
    uint8_t *out;
    size_t used, room;
    int bad;
} inflater;

static unsigned take(inflater *f, int count)
{
    unsigned value = 0;
    for (int i = 0; i < count; i++) {
        if (f->at >= f->size) {
            f->bad = 1;
            return 0;
        }
        value |= (unsigned)(f->in[f->at] >> f->bits & 1) << i;
        if (++f->bits == 8) {
            f->bits = 0;
            f->at++;
        }
    }
    return value;
}

typedef struct lengths {
    uint8_t of[320];
    int count;
} lengths;

/* The next symbol, by comparing with each code of its length: slow and plain. */
static int symbol(inflater *f, const lengths *l)
{
    int word = 0, first = 0;
    for (int bits = 1; bits < 16 && !f->bad; bits++) {
        int n = 0;
        word = word << 1 | (int)take(f, 1);
        for (int i = 0; i < l->count; i++)
            n += l->of[i] == bits;
        if (word - first < n && word >= first) {
            for (int i = 0; i < l->count; i++)
                if (l->of[i] == bits && word-- == first)
                    return i;
        }
        first = (first + n) << 1;
    }
    f->bad = 1;
    return 256;
}

static void read_lengths(inflater *f, lengths *literals, lengths *distances)
{
    static const uint8_t order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    lengths codes, all;
    memset(&codes, 0, sizeof codes);
    memset(&all, 0, sizeof all);
    literals->count = (int)take(f, 5) + 257;
    distances->count = (int)take(f, 5) + 1;
    codes.count = 19;
    for (int i = (int)take(f, 4) + 4, k = 0; k < i; k++)
        codes.of[order[k]] = (uint8_t)take(f, 3);
    while (all.count < literals->count + distances->count && !f->bad) {
        int s = symbol(f, &codes), repeat = 1;
        uint8_t value = (uint8_t)s;
        if (s == 16) {
            value = all.count ? all.of[all.count - 1] : 0;
            repeat = (int)take(f, 2) + 3;
        } else if (s > 16) {
            value = 0;
            repeat = s == 17 ? (int)take(f, 3) + 3 : (int)take(f, 7) + 11;
        }
        while (repeat-- && all.count < 320)
            all.of[all.count++] = value;
    }
    memcpy(literals->of, all.of, sizeof literals->of);
    for (int i = 0; i < distances->count; i++)
        distances->of[i] = all.of[literals->count + i];
}

static void inflate_block(inflater *f, const lengths *literals, const lengths *distances)
{
    for (;;) {
        int s = symbol(f, literals), extra, length, distance;
        if (f->bad || s == 256)
            return;
        if (s < 256) {
            if (f->used < f->room)
                f->out[f->used++] = (uint8_t)s;
            else
                f->bad = 1;
            continue;
        }
        s -= 257;
        extra = s < 8 || s == 28 ? 0 : (s - 4) / 4;
        length = s == 28 ? 258 : s < 8 ? s + 3 : ((s - 4) % 4 + 4) * (1 << extra) + 3;
        length += (int)take(f, extra);
        s = symbol(f, distances);
        extra = s < 4 ? 0 : (s - 2) / 2;
        distance = s < 4 ? s + 1 : ((s - 2) % 2 + 2) * (1 << extra) + 1;
        distance += (int)take(f, extra);
        if ((size_t)distance > f->used || (size_t)length > f->room - f->used)
            f->bad = 1;
        for (; length && !f->bad; length--, f->used++)
            f->out[f->used] = f->out[f->used - (size_t)distance];
    }
}

/* 0 where zlib data unpacks to exactly `size` bytes with the right sum. */
static int unpack(const uint8_t *in, size_t in_size, uint8_t *out, size_t size)
{
    inflater f = {in, 2, 0, in_size, out, 0, size, 0};
    uint32_t a = 1, b = 0, sum = 0;
    unsigned last = 0;
    if (in_size < 6 || ((unsigned)in[0] << 8 | in[1]) % 31 || in[0] != 0x78)
        return -1;
    while (!last && !f.bad) {
        lengths literals, distances;
        unsigned kind;
        last = take(&f, 1);
        kind = take(&f, 2);
        memset(&literals, 0, sizeof literals);
        memset(&distances, 0, sizeof distances);
        if (kind == 1) {
            literals.count = 288;
            for (int i = 0; i < 288; i++)
                literals.of[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
            distances.count = 30;
            memset(distances.of, 5, 30);
        } else if (kind == 2) {
            read_lengths(&f, &literals, &distances);
        } else {
            return -1;
        }
        inflate_block(&f, &literals, &distances);
    }
    if (f.bits)
        f.at++;
    if (f.bad || f.used != size || f.at + 4 != in_size)
        return -1;
    for (size_t i = 0; i < size; i++) {
        a = (a + out[i]) % 65521;
        b = (b + a) % 65521;
    }
    for (int i = 0; i < 4; i++)
        sum = sum << 8 | in[f.at + (size_t)i];
    return sum == (b << 16 | a) ? 0 : -1;
}

typedef struct bytes {
    uint8_t *data;
    size_t used, room;
    int calls_left; /* then the sink fails */
} bytes;

static int collect(void *context, const unsigned char *from, size_t count)
{
    bytes *b = context;
    if (b->calls_left-- == 0 || count > b->room - b->used)
        return -1;
    memcpy(b->data + b->used, from, count);
    b->used += count;
    return 0;
}

static void test_deflate(void)
{
    enum { MOST = 150000 };
    uint8_t *from = calloc(MOST, 1), *back = malloc(MOST);
    bytes packed = {malloc(2 * MOST), 0, 2 * MOST, -1};
    TEST("deflate is undone by a plain inflate");
    if (!from || !back || !packed.data)
        abort();
    for (int round = 0; round < 40; round++) {
        size_t size = round < 12 ? (size_t)round : test_random() % MOST;
        unsigned range = round % 5 == 0 ? 256 : round % 5 == 1 ? 1 : round % 5 == 2 ? 2 : 9;
        int copies = round % 3; /* stretches from before make matches */
        for (size_t i = 0; i < size; i++) {
            from[i] = (uint8_t)(test_random() % range);
            if (copies && i > 40000 && test_random() % 100 == 0)
                for (size_t far = test_random() % 40000 + 1, n = test_random() % 400; n && i < size; n--, i++)
                    from[i] = from[i - far];
        }
        packed.used = 0;
        packed.calls_left = -1;
        CHECK(deflate_zlib(from, size, collect, &packed) == 0);
        CHECK(unpack(packed.data, packed.used, back, size) == 0 && memcmp(from, back, size) == 0);
    }
    TEST("deflate stops when its sink fails");
    for (size_t i = 0; i < MOST; i++)
        from[i] = (uint8_t)test_random();
    packed.used = 0;
    packed.calls_left = 2;
    CHECK(deflate_zlib(from, MOST, collect, &packed) == -1);
    free(from);
    free(back);
    free(packed.data);
}

static uint32_t big(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static int unfilter(const uint8_t *filtered, int width, int height, uint8_t *rgb)
{
    int row = 3 * width;
    for (int y = 0; y < height; y++) {
        int filter = *filtered++;
        for (int x = 0; x < row; x++, filtered++) {
            int a = x < 3 ? 0 : rgb[y * row + x - 3], b = y ? rgb[(y - 1) * row + x] : 0;
            int c = x < 3 || !y ? 0 : rgb[(y - 1) * row + x - 3], p = a + b - c, guess;
            int pa = abs(p - a), pb = abs(p - b), pc = abs(p - c);
            switch (filter) {
            case 0:
                guess = 0;
                break;
            case 1:
                guess = a;
                break;
            case 2:
                guess = b;
                break;
            case 3:
                guess = (a + b) / 2;
                break;
            case 4:
                guess = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
                break;
            default:
                return -1;
            }
            rgb[y * row + x] = (uint8_t)(*filtered + guess);
        }
    }
    return 0;
}

static void check_png(int width, int height)
{
    size_t count = (size_t)width * (size_t)height, filtered_size = (3 * (size_t)width + 1) * (size_t)height, size = 0, used = 0;
    uint8_t *rgba = malloc(4 * count), *rgb = malloc(3 * count), *filtered = malloc(filtered_size), *data, *packed;
    const char *path = files_path("t.png");
    FILE *file = fopen(path, "wb");
    int ends = 0, same = 1;
    if (!rgba || !rgb || !filtered)
        abort();
    for (size_t i = 0; i < 4 * count; i++)
        rgba[i] = (uint8_t)(i / 40 + test_random() % 3);
    CHECK(file && png_write(file, rgba, width, height) == 0 && fclose(file) == 0);
    data = (uint8_t *)files_read(path, &size);
    packed = malloc(size + 1);
    if (!data || !packed)
        abort();
    CHECK(size > 57 && memcmp(data, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) == 0);
    CHECK(big(data + 16) == (uint32_t)width && big(data + 20) == (uint32_t)height &&
          memcmp(data + 24, "\x08\x02\0\0\0", 5) == 0);
    for (size_t at = 8; at + 12 <= size;) {
        size_t n = big(data + at);
        uint32_t crc = 0xffffffffu;
        if (n > size - at - 12)
            break;
        for (size_t i = at + 4; i < at + 8 + n; i++) {
            crc ^= data[i];
            for (int k = 0; k < 8; k++)
                crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
        }
        CHECK(big(data + at + 8 + n) == ~crc);
        if (memcmp(data + at + 4, "IDAT", 4) == 0) {
            memcpy(packed + used, data + at + 8, n);
            used += n;
        }
        ends += memcmp(data + at + 4, "IEND", 4) == 0 && at + 12 == size;
        at += 12 + n;
    }
    CHECK(ends == 1);
    CHECK(unpack(packed, used, filtered, filtered_size) == 0 && unfilter(filtered, width, height, rgb) == 0);
    for (size_t i = 0; i < count; i++)
        same = same && memcmp(rgb + 3 * i, rgba + 4 * i, 3) == 0;
    CHECK(same);
    free(rgba);
    free(rgb);
    free(filtered);
    free(data);
    free(packed);
}

/* ---- outputs ----------------------------------------------------------------------------------------------------------- */

static int exists(const char *name)
{
    struct stat st;
    return stat(files_path(name), &st) == 0;
}

static void test_output(void)
{
    output_set set = {.count = 0};
    tool_error error;
    FILE *a, *b;
    char *bytes_read;
    size_t size = 0;
    TEST("output files appear together, or not at all");
    files_text("a.ppm", "old");
    a = output_open(&set, files_path("a.ppm"), &error);
    b = output_open(&set, files_path("b.ppm"), &error);
    CHECK(a && b && fputs("new", a) >= 0 && fputs("other", b) >= 0);
    bytes_read = files_read(files_path("a.ppm"), &size);
    CHECK(bytes_read && strcmp(bytes_read, "old") == 0 && !exists("b.ppm"));
    free(bytes_read);
    CHECK(output_commit(&set, &error) == 0 && set.count == 0);
    bytes_read = files_read(files_path("a.ppm"), &size);
    CHECK(bytes_read && strcmp(bytes_read, "new") == 0 && exists("b.ppm"));
    free(bytes_read);

    a = output_open(&set, files_path("c.ppm"), &error);
    CHECK(a && output_open(&set, files_path("no/such/d.ppm"), &error) == NULL && strstr(error.text, "d.ppm: can't be written"));
    CHECK(output_open(&set, "build", &error) == NULL && strstr(error.text, "folder"));
    output_abort(&set);
    output_abort(&set);
    CHECK(!exists("c.ppm"));
    CHECK(output_kind_of("a.PNG") == OUTPUT_PNG && output_kind_of("a.b.rgb565") == OUTPUT_RGB565);
    CHECK(output_kind_of("png") == OUTPUT_UNKNOWN && output_kind_of(".png") == OUTPUT_UNKNOWN &&
          output_kind_of("") == OUTPUT_UNKNOWN);
}

static void test_exposure(void)
{
    enum { COUNT = 1000 };
    float picture[3 * COUNT] = {0.0f}, once, twice;
    TEST("automatic exposure");
    CHECK(render_exposure(picture, COUNT, 1) == 1.0f); /* all black */
    for (int i = 0; i < 3 * COUNT; i++)
        picture[i] = test_random_float(0.0f, 2.0f);
    once = render_exposure(picture, COUNT, 1);
    for (int i = 0; i < 3 * COUNT; i++)
        picture[i] *= 1024.0f;
    twice = render_exposure(picture, COUNT, 1);
    CHECK(once > 0.0f && twice * 1024.0f == once); /* follows the light */
    for (int i = 0; i < 3 * COUNT; i++)
        picture[i] = i % 2 ? 3e38f : 1e-45f;
    once = render_exposure(picture, COUNT, 1);
    CHECK(once > 0.0f && isfinite(once));
}

void test_pictures(void)
{
    static const int sizes[][2] = {{1, 1}, {2, 3}, {1, 500}, {700, 1}, {320, 240}};
    test_pnm_values();
    test_pnm_errors();
    test_pfm();
    test_deflate();
    TEST("PNG is read back");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        check_png(sizes[i][0], sizes[i][1]);
    test_output();
    test_exposure();
    files_remove();
}
