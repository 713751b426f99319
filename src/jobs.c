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
    if (c->jobs->counts) {
        tyni_jobs_count *n = &c->jobs->counts[worker];
        n->done++;
        n->sum += (uint64_t)index;
        n->squares += (uint64_t)index * (uint64_t)index;
    }
}

tyn_status tyni_jobs_run(const tyni_jobs *jobs, tyn_job job, void *argument, int32_t count)
{
    call c = {jobs, job, argument, count};
    int32_t done = 0;
    uint64_t sum = 0, squares = 0, i = 0;
    for (int32_t w = 0; w < jobs->workers && jobs->counts; w++)
        memset(&jobs->counts[w], 0, sizeof jobs->counts[w]);
    if (jobs->executor) {
        if (count > 0)
            jobs->executor->run(jobs->executor->context, counted, &c, count);
    } else {
        for (int32_t k = 0; k < count; k++)
            counted(&c, k, 0);
    }
    if (!jobs->counts)
        return TYN_OK;
    for (int32_t w = 0; w < jobs->workers; w++) {
        done += jobs->counts[w].done;
        sum += jobs->counts[w].sum;
        squares += jobs->counts[w].squares;
    }
    for (; i < (uint64_t)tyni_maxi(count, 0); i++) {
        sum -= i;
        squares -= i * i;
    }
    return done == count && !sum && !squares ? TYN_OK : TYN_E_EXECUTOR;
}

tyn_status tyni_jobs_check(const tyn_executor *executor, int32_t limit)
{
    if (executor && (!executor->run || executor->workers < 1 || executor->workers > limit))
        return TYN_E_EXECUTOR;
    return TYN_OK;
}
