/* deflate.h - RFC 1951 compression inside RFC 1950's zlib frame. */
#ifndef TOOL_DEFLATE_H
#define TOOL_DEFLATE_H

#include <stddef.h>

/* Takes compressed bytes; 0, or -1 to stop. */
typedef int (*deflate_sink)(void *context, const unsigned char *bytes, size_t count);

/* Compresses all of `data`. -1: no memory, or what the sink said. */
int deflate_zlib(const unsigned char *data, size_t size, deflate_sink sink, void *context);

#endif
