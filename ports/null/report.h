/* report.h - draws one picture of the show on whatever machine this is, and says what came out and what it took. */
#ifndef NULL_REPORT_H
#define NULL_REPORT_H

#include "tyndall.h"

/* What a machine brings. */
typedef struct machine {
    int32_t width, height;
    uint16_t *pixels; /* the screen: RGB565 */
    void *memory;     /* SHOW_MEMORY(width, height, workers) bytes, aligned to TYN_ALIGNMENT */
    size_t bytes;
    const tyn_executor *executor; /* NULL: one core */
    void (*write)(const char *text);
    uint64_t (*instructions)(void *); /* NULL: it cannot count */
    int knows_stack;                  /* it has stack.c */
} machine;

/* Lines of text through `write`; the picture stays in `pixels`. Not 0: it could not be drawn. The line that begins with
 * "picture" is the same on every machine. */
int report(const machine *m);

#endif
