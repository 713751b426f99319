/* progress.h - one line on stderr that says what is being done, only where stderr is a terminal. */
#ifndef TOOL_PROGRESS_H
#define TOOL_PROGRESS_H

#include <stdint.h>

void progress_stage(const char *name);
void progress_jobs(int32_t taken, int32_t count); /* for pool_watch */
void progress_end(void);                          /* clears the line; before any message */

uint64_t clock_now(void *unused); /* nanoseconds, a tyn_clock */

#endif
