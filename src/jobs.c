/* jobs.c - see jobs.h */
#include "jobs.h"

#include "base.h"

typedef struct call {
    const tyni_jobs *jobs;
    tyn_job job;
    void *argument;
    int32_t count;
} call;

static void counted(void *argument, int32_t index, int32_t worker)
{
    const call *c = argument;
    if (worker < 0 || worker >= c->jobs->workers || index < 0 || index >= c->count)
        return;
    c->job(c->argument, index, worker);
    if (c->jobs->counts)
        c->jobs->counts[worker].done++;
}

tyn_status tyni_jobs_run(const tyni_jobs *jobs, tyn_job job, void *argument, int32_t count)
{
    call c = {jobs, job, argument, count};
    int32_t done = 0;
    for (int32_t w = 0; w < jobs->workers && jobs->counts; w++)
        jobs->counts[w].done = 0;
    if (jobs->executor) {
        if (count > 0)
            jobs->executor->run(jobs->executor->context, counted, &c, count);
    } else {
        for (int32_t i = 0; i < count; i++)
            counted(&c, i, 0);
    }
    if (!jobs->counts)
        return TYN_OK;
    for (int32_t w = 0; w < jobs->workers; w++)
        done += jobs->counts[w].done;
    return done == count ? TYN_OK : TYN_E_EXECUTOR;
}

tyn_status tyni_jobs_check(const tyn_executor *executor, int32_t limit)
{
    if (executor && (!executor->run || executor->workers < 1 || executor->workers > limit))
        return TYN_E_EXECUTOR;
    return TYN_OK;
}
