/* stack.h - how deep the stack went, on machines whose linker script says where it ends. */
#ifndef NULL_STACK_H
#define NULL_STACK_H

#include <stddef.h>

/* Fills what is free of the stack; then, after some work, how many bytes of it the work has written. */
void stack_paint(void);
size_t stack_used(void);

#endif
