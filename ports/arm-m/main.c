/* main.c - bare-metal Cortex-M with a single-precision FPU: start-up, semihosting for text, a timer for counting. */
#include <string.h>

#include "report.h"
#include "show.h"

enum { WIDTH = 320, HEIGHT = 240 };

static union {
    uint8_t bytes[SHOW_MEMORY(WIDTH, HEIGHT, 1)];
    uint64_t align;
} __attribute__((aligned(TYN_ALIGNMENT))) block;
static uint16_t screen[WIDTH * HEIGHT];

/* ---- semihosting --------------------------------------------------------------------------------------------------- */

#define SYS_WRITE0 4
#define SYS_EXIT_EXTENDED 32
#define APPLICATION_EXIT 0x20026u

static void host(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void say(const char *text)
{
    host(SYS_WRITE0, text);
}

static void leave(uint32_t status)
{
    uint32_t arguments[2] = {APPLICATION_EXIT, 0};
    arguments[1] = status;
    for (;;)
        host(SYS_EXIT_EXTENDED, arguments);
}

/* ---- counting ------------------------------------------------------------------------------------------------------ */

/* QEMU's -icount shift=0 takes a nanosecond for each instruction; the boards' timer counts down every 40. */
static volatile uint32_t *const timer = (volatile uint32_t *)0x40000000; /* control, value, reload */

static void start_timer(void)
{
    timer[2] = 0xffffffffu;
    timer[1] = 0xffffffffu;
    timer[0] = 1;
}

static uint64_t instructions(void *context)
{
    (void)context;
    return (uint64_t)(0xffffffffu - timer[1]) * 40;
}

/* ---- start --------------------------------------------------------------------------------------------------------- */

extern uint8_t data_start[], data_end[], data_from[], bss_start[], bss_end[], stack_top[];

void reset(void);
static void fault(void);

__attribute__((section(".vectors"), used)) static const struct {
    void *stack;
    void (*handler[15])(void);
} vectors = {stack_top, {reset, fault, fault, fault, fault, fault}};

static void fault(void)
{
    say("fault\n");
    leave(2);
}

int main(void)
{
    machine m = {WIDTH, HEIGHT, screen, block.bytes, sizeof block, NULL, say, instructions, 1};
    start_timer();
    return report(&m);
}

void reset(void)
{
    volatile uint32_t *access = (volatile uint32_t *)0xe000ed88; /* CPACR */
    *access |= 15u << 20;                                        /* CP10, CP11: the FPU */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    memcpy(data_start, data_from, (size_t)(data_end - data_start));
    memset(bss_start, 0, (size_t)(bss_end - bss_start));
    leave((uint32_t)main());
}
