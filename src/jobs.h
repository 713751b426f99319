/* jobs.h - runs the jobs of a stage through the caller's executor and counts that each was run. */
#ifndef TYNI_JOBS_H
#define TYNI_JOBS_H

#include "base.h"

/* A worker's count, on a cache line of its own. */
typedef struct tyni_jobs_count {
    int32_t done;
    uint8_t pad[4];
    uint64_t sum, squares; /* of the indices: a job run twice and another never must not pass for all */
    uint8_t line[40];
} tyni_jobs_count;

typedef struct tyni_jobs {
    const tyn_executor *executor; /* NULL: the calling thread */
    tyni_jobs_count *counts;      /* one per worker, in the arena; NULL: nothing is counted, the jobs tell by what they did */
    int32_t workers;              /* room in counts and in the scratch; 1 .. TYN_MAX_WORKERS */
} tyni_jobs;

/* Runs job(argument, i, worker) for i in 0 .. count - 1. TYN_E_EXECUTOR if not each was finished once, or a
 * worker number was out of range (that call then did nothing); without counts always TYN_OK. */
tyn_status tyni_jobs_run(const tyni_jobs *jobs, tyn_job job, void *argument, int32_t count);

/* TYN_E_EXECUTOR for an executor without run, or with workers outside 1 .. limit; NULL is right. */
tyn_status tyni_jobs_check(const tyn_executor *executor, int32_t limit);

#endif
