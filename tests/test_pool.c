/* test_pool.c - the tool's threads: each job once, each worker number in one thread at a time, what was written is seen. */
#include <stdlib.h>
#include <string.h>

#include "pool.h"
#include "test.h"

enum { JOBS = 5000 };

typedef struct tally {
    int32_t done[JOBS];
    int32_t inside[TYN_MAX_WORKERS]; /* not 0 while a worker is in a job */
    int32_t workers, errors[TYN_MAX_WORKERS];
} tally;

static void job(void *argument, int32_t index, int32_t worker)
{
    tally *t = argument;
    if (worker < 0 || worker >= t->workers) {
        abort();
    }
    t->errors[worker] += t->inside[worker]++ != 0;
    t->done[index]++;
    t->inside[worker]--;
}

/* The least number that 32 bits do not hold for each of the most workers. */
enum { MANY = INT32_MAX / TYN_MAX_WORKERS + 1 };

static void one_of_many(void *argument, int32_t index, int32_t worker)
{
    int64_t *sums = argument;
    if (index < 0 || index >= MANY)
        abort();
    sums[8 * worker] += index;
}

static void test_many(void)
{
    static int64_t sums[8 * TYN_MAX_WORKERS]; /* each on a cache line of its own */
    pool *p = pool_create(TYN_MAX_WORKERS);
    const tyn_executor *e = p ? pool_executor(p) : NULL;
    int64_t sum = 0;
    const char *emulated = getenv("TYN_EMULATED"); /* sameness.sh's */
    TEST("a pool deals out more jobs than 32 bits hold for each worker");
    CHECK(e);
    if (emulated && *emulated) {
        test_skip("33 million jobs take minutes on an emulated machine");
        pool_free(p);
        return;
    }
    if (e)
        e->run(e->context, one_of_many, sums, MANY);
    for (int i = 0; i < TYN_MAX_WORKERS; i++)
        sum += sums[8 * i];
    CHECK(sum == (int64_t)MANY * (MANY - 1) / 2);
    pool_free(p);
}

void test_pool(void)
{
    static const int32_t sizes[] = {1, 2, 3, 8, TYN_MAX_WORKERS};
    tally *t = malloc(sizeof *t);
    if (!t)
        abort();
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        pool *p = pool_create(sizes[s]);
        const tyn_executor *e = p ? pool_executor(p) : NULL;
        TEST("a pool runs each job once");
        CHECK(e && e->workers >= 1 && e->workers <= sizes[s]);
        for (int round = 0; e && round < 50; round++) {
            int32_t count = round < 3 ? round : (int32_t)(test_random() % JOBS), wrong = 0;
            memset(t, 0, sizeof *t);
            t->workers = e->workers;
            e->run(e->context, job, t, count);
            for (int32_t i = 0; i < JOBS; i++)
                wrong += t->done[i] != (i < count);
            for (int32_t i = 0; i < TYN_MAX_WORKERS; i++)
                wrong += t->errors[i];
            CHECK(wrong == 0);
        }
        pool_free(p);
    }
    CHECK(pool_default_workers() >= 1 && pool_default_workers() <= TYN_MAX_WORKERS);
    pool_free(NULL);
    free(t);
    test_many();
}
