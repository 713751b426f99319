/* stack.c - see stack.h. The linker script has stack_low, where the stack ends. */
#include "stack.h"

#include <stdint.h>

#define PAINT 0x5aa5c33cu
#define OWN 32 /* words below a local that a function may use itself */

extern volatile uint32_t stack_low[];
static size_t painted; /* words */

__attribute__((noinline)) void stack_paint(void)
{
    volatile uint32_t here = 0;
    painted = (size_t)((uintptr_t)&here - (uintptr_t)stack_low) / sizeof here - OWN;
    for (size_t i = 0; i < painted; i++)
        stack_low[i] = PAINT;
}

size_t stack_used(void)
{
    size_t i = 0;
    while (i < painted && stack_low[i] == PAINT)
        i++;
    return (painted - i + OWN) * sizeof *stack_low;
}
