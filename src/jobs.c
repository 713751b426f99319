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

/* The sums of 0 .. n - 1 and of their squares, wrapped. In closed form: of a loop some compilers make one by themselves, with a
 * product of 128 bits out of their own library. */
static void sums_of(uint32_t n, uint64_t *sum, uint64_t *squares)
{
    uint32_t a = n, b = n - 1, c = 2 * n - 1; /* n = 0: a makes it 0 */
    if (a % 2 == 0)
        a /= 2;
    else
        b /= 2;
    *sum = (uint64_t)a * b;
    if (a % 3 == 0)
        a /= 3;
    else if (b % 3 == 0)
        b /= 3;
    else
        c /= 3;
    *squares = (uint64_t)a * b * c;
}

tyn_status tyni_jobs_run(const tyni_jobs *jobs, tyn_job job, void *argument, int32_t count)
{
    call c = {jobs, job, argument, count};
    int32_t done = 0;
    uint64_t sum, squares;
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
    sums_of((uint32_t)tyni_maxi(count, 0), &sum, &squares);
    for (int32_t w = 0; w < jobs->workers; w++) {
        done += jobs->counts[w].done;
        sum -= jobs->counts[w].sum;
        squares -= jobs->counts[w].squares;
    }
    return done == count && !sum && !squares ? TYN_OK : TYN_E_EXECUTOR;
}

tyn_status tyni_jobs_check(const tyn_executor *executor, int32_t limit)
{
    if (executor && (!executor->run || executor->workers < 1 || executor->workers > limit))
        return TYN_E_EXECUTOR;
    return TYN_OK;
}
