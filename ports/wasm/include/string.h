/* string.h - what src/ wants of it where there is no libc: the compiler has instructions for all three (-mbulk-memory). */
#ifndef TYNDALL_WASM_STRING_H
#define TYNDALL_WASM_STRING_H

#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t bytes);
void *memmove(void *to, const void *from, size_t bytes);
void *memset(void *to, int byte, size_t bytes);

#endif
