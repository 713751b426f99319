/* progress.c */
#include "progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

static const char *stage;
static uint64_t shown; /* when the line was last written; 0: there is none */

uint64_t clock_now(void *unused)
{
    struct timespec t;
    (void)unused;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

void progress_stage(const char *name)
{
    stage = isatty(2) ? name : NULL;
    if (stage) {
        fprintf(stderr, "\r\033[K%s", stage);
        shown = clock_now(NULL);
    }
}

void progress_jobs(int32_t taken, int32_t count)
{
    uint64_t now;
    if (!stage)
        return;
    now = clock_now(NULL);
    if (now - shown < 200000000u)
        return;
    fprintf(stderr, "\r\033[K%s %ld %%", stage, (long)((int64_t)taken * 100 / (count > 0 ? count : 1)));
    shown = now;
}

void progress_end(void)
{
    if (stage)
        fprintf(stderr, "\r\033[K");
    stage = NULL;
    shown = 0;
}
