/* pool.h - threads for tyn_executor. */
#ifndef TOOL_POOL_H
#define TOOL_POOL_H

#include "tyndall.h"

typedef struct pool pool;

/* Signals that end a program from outside. The pool's threads leave them, and SIGALRM, to the thread that knows what to do
 * then. */
#define POOL_SIGNALS SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU

/* Threads of the machine, 1 .. TYN_MAX_WORKERS. */
int32_t pool_default_workers(void);

/* `workers` threads including the caller of run, who is worker 0. Where the system gives fewer threads there are fewer workers.
 * NULL: no memory. */
pool *pool_create(int32_t workers);
void pool_free(pool *p);

/* Valid as long as the pool. run must not be called from two threads, nor from a job. */
const tyn_executor *pool_executor(pool *p);

/* Called between the caller's own jobs with how many of a run are taken; for progress. */
void pool_watch(pool *p, void (*watch)(int32_t taken, int32_t count));

#endif
