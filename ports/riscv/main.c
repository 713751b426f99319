/* main.c - bare RISC-V, 32 or 64 bits with single-precision floats, on QEMU's board `virt`: no libc at all. */
#include <string.h>

#include "report.h"
#include "show.h"

enum { WIDTH = 320, HEIGHT = 240 };

static uint8_t block[SHOW_MEMORY(WIDTH, HEIGHT, 1)] __attribute__((aligned(TYN_ALIGNMENT)));
static uint16_t screen[WIDTH * HEIGHT];

static void say(const char *text)
{
    volatile uint8_t *const serial = (volatile uint8_t *)0x10000000; /* a 16550: data, and in byte 5 whether it takes more */
    for (; *text; text++) {
        while (!(serial[5] & 0x20)) {
        }
        *serial = (uint8_t)*text;
    }
}

static void leave(uint32_t status)
{
    volatile uint32_t *const finisher = (volatile uint32_t *)0x100000; /* ends QEMU with this status */
    for (;;)
        *finisher = status ? status << 16 | 0x3333 : 0x5555;
}

static uint64_t instructions(void *context)
{
    (void)context;
#if __riscv_xlen == 32
    uint32_t low, high, again;
    do {
        __asm__ volatile("csrr %0, minstreth\n\tcsrr %1, minstret\n\tcsrr %2, minstreth" : "=r"(high), "=r"(low), "=r"(again));
    } while (high != again);
    return (uint64_t)high << 32 | low;
#else
    uint64_t all;
    __asm__ volatile("csrr %0, minstret" : "=r"(all));
    return all;
#endif
}

int main(void)
{
    machine m = {WIDTH, HEIGHT, screen, block, sizeof block, NULL, say, instructions, 1};
    return report(&m);
}

extern uint8_t bss_start[], bss_end[];

void trap(void);
__attribute__((aligned(4))) void trap(void)
{
    say("trap\n");
    leave(2);
}

void run(void);
void run(void)
{
    memset(bss_start, 0, (size_t)(bss_end - bss_start));
    leave((uint32_t)main());
}

/* One core goes on; the floating-point unit is off until mstatus says otherwise. */
__asm__(".section .start, \"ax\"\n"
        ".globl start\n"
        "start:\n"
        "    csrr a0, mhartid\n"
        "1:  bnez a0, 1b\n"
        "    la sp, stack_top\n"
        "    la t0, trap\n"
        "    csrw mtvec, t0\n"
        "    li t0, 1 << 13\n"
        "    csrs mstatus, t0\n"
        "    csrw fcsr, zero\n"
        "    j run\n");
