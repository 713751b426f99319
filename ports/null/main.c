/* main.c - the smallest whole port: a block of memory, a screen that nobody sees, and text. Copy this folder.
 *     null            reports on pictures of 320x240, and of 400x240 in black and white
 *     null colour     the first as a PPM on stdout; `null dots`: the second as a PBM */
#include <stdio.h>
#include <string.h>

#include "bits.h"
#include "report.h"
#include "show.h"
#include "stack.h"

enum { DOTS_W = 400, DOTS_H = 240, DOTS_STRIDE = 52, WORKERS = 2 };

/* Enough for the larger of the two, and to begin on a multiple of TYN_ALIGNMENT. */
static uint8_t block[SHOW_MEMORY(DOTS_W, DOTS_H, WORKERS) + TYN_ALIGNMENT];
static uint16_t screen[DOTS_W * DOTS_H];
static uint8_t dots[DOTS_STRIDE * DOTS_H];

static void say(const char *text)
{
    fputs(text, stdout);
}

static void say_nothing(const char *text)
{
    (void)text;
}

/* No machine says where the stack of a hosted program ends. */
void stack_paint(void) {}

size_t stack_used(void)
{
    return 0;
}

/* A machine with cores gives each job to one that is free, under its number, and waits for all. Here two take turns. */
static void run(void *context, tyn_job job, void *argument, int32_t count)
{
    (void)context;
    for (int32_t i = 0; i < count; i++)
        job(argument, i, i % WORKERS);
}

static int write_colour(int32_t pixels)
{
    for (int32_t i = 0; i < pixels; i++) {
        putchar((screen[i] >> 11) * 255 / 31);
        putchar((screen[i] >> 5 & 63) * 255 / 63);
        putchar((screen[i] & 31) * 255 / 31);
    }
    return ferror(stdout) || fflush(stdout);
}

static int write_dots(void)
{
    for (int32_t y = 0; y < DOTS_H; y++)
        for (int32_t x = 0; x < DOTS_W / 8; x++)
            putchar(~dots[y * DOTS_STRIDE + x] & 255); /* a PBM has black 1 */
    return ferror(stdout) || fflush(stdout);
}

static int white(void)
{
    int sum = 0;
    for (int32_t i = 0; i < DOTS_W * DOTS_H; i++)
        sum += dots[i / DOTS_W * DOTS_STRIDE + i % DOTS_W / 8] >> (7 - i % DOTS_W % 8) & 1;
    return sum;
}

int main(int argc, char **argv)
{
    const char *wanted = argc > 1 ? argv[1] : "";
    machine m = {320, 240, NULL, NULL, SHOW_MEMORY(320, 240, 1), NULL, NULL, NULL, 0};
    const tyn_executor executor = {run, NULL, WORKERS};
    tyn_image picture = {screen, DOTS_W, DOTS_H, 0, TYN_RGB565_SRGB};
    m.pixels = screen;
    m.memory = block + (TYN_ALIGNMENT - (uintptr_t)block % TYN_ALIGNMENT) % TYN_ALIGNMENT;
    m.write = *wanted ? say_nothing : say;
    if (report(&m))
        return 1;
    if (strcmp(wanted, "colour") == 0) {
        printf("P6\n320 240\n255\n");
        return write_colour(320 * 240);
    }
    m.width = DOTS_W;
    m.height = DOTS_H;
    m.executor = &executor;
    m.bytes = SHOW_MEMORY(DOTS_W, DOTS_H, WORKERS);
    if (report(&m))
        return 1;
    bits_dither(&picture, 512, dots, DOTS_STRIDE);
    if (strcmp(wanted, "dots") == 0) {
        printf("P4\n%d %d\n", DOTS_W, DOTS_H);
        return write_dots();
    }
    printf("dots     %d of %d white\n", white(), DOTS_W * DOTS_H);
    return 0;
}
