/* report.c - see report.h. No printf: freestanding machines have none. */
#include "report.h"

#include <string.h>

#include "show.h"
#include "stack.h"

static void say_number(const machine *m, uint64_t n, uint32_t base, int32_t width)
{
    char text[24];
    int32_t at = (int32_t)sizeof text - 1;
    text[at] = '\0';
    do {
        text[--at] = "0123456789abcdef"[n % base];
        n /= base;
    } while (n || (int32_t)sizeof text - 1 - at < width);
    m->write(text + at);
}

static void say(const machine *m, const char *before, uint64_t n, const char *after)
{
    m->write(before);
    say_number(m, n, 10, 1);
    m->write(after);
}

/* FNV-1a over the pixels' values, the low byte first: the same whatever the byte order. */
static uint64_t hash_of(const uint16_t *pixels, size_t count)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < 2 * count; i++)
        hash = (hash ^ (pixels[i / 2] >> 8 * (i & 1) & 255)) * 0x100000001b3u;
    return hash;
}

/* How much of a block that was filled with 0xa5 has been written, up to the last byte. */
static size_t touched(const uint8_t *block, size_t bytes)
{
    while (bytes > 0 && block[bytes - 1] == 0xa5)
        bytes--;
    return bytes;
}

static uint64_t count(const machine *m)
{
    return m->instructions ? m->instructions(NULL) : 0;
}

static void say_stage(const machine *m, const char *name, uint64_t instructions)
{
    m->write(name);
    if (m->instructions)
        say(m, " ", instructions, " instructions,");
    if (m->knows_stack)
        say(m, " ", stack_used(), " bytes of stack");
    m->write(m->instructions || m->knows_stack ? "\n" : " not counted here\n");
}

/* What is there before a stage, and after it. */
static uint64_t begin(const machine *m)
{
    if (m->knows_stack)
        stack_paint();
    return count(m);
}

int report(const machine *m)
{
    tyn_image picture = {m->pixels, m->width, m->height, 0, TYN_RGB565_SRGB};
    uint64_t start;
    tyn_status status;
    show s;
    memset(m->memory, 0xa5, m->bytes);
    status = show_open(&s, m->width, m->height, m->executor, m->memory, m->bytes);
    if (status == TYN_OK) {
        start = begin(m);
        status = show_surfaces(&s, 0.5f, &picture);
        say_stage(m, "surfaces", count(m) - start);
    }
    if (status == TYN_OK) {
        start = begin(m);
        status = show_light(&s, &picture);
        say_stage(m, "light   ", count(m) - start);
    }
    if (status != TYN_OK) {
        m->write(tyn_status_name(status));
        m->write("\n");
        return 1;
    }
    say(m, "memory   ", m->bytes, " bytes, ");
    say(m, "", touched(m->memory, m->bytes), " touched, ");
    say(m, "", s.stats.memory, " of them for the light\n");
    say(m, "picture  ", (uint64_t)m->width, "x");
    say(m, "", (uint64_t)m->height, " ");
    say_number(m, hash_of(m->pixels, (size_t)m->width * (size_t)m->height), 16, 16);
    m->write("\n");
    return 0;
}
