/* pool.c - one mutex; jobs are slices and bands of rows, long against a lock. */
#include "pool.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

struct worker {
    pool *pool;
    int32_t number;
    pthread_t thread;
};

struct pool {
    tyn_executor executor;
    pthread_mutex_t mutex;
    pthread_cond_t work, idle;
    tyn_job job; /* of this run; all below are guarded by the mutex */
    void *argument;
    int32_t next, count;
    int32_t busy; /* threads inside the run */
    uint64_t run; /* counts the runs: how a thread knows a new one */
    int stop;
    void (*watch)(int32_t taken, int32_t count);
    struct worker workers[TYN_MAX_WORKERS]; /* [0] is the caller */
};

int32_t pool_default_workers(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > TYN_MAX_WORKERS ? TYN_MAX_WORKERS : (int32_t)n;
}

/* Takes jobs until there are none. The mutex is held on entry and on return. */
static void take_jobs(pool *p, int32_t number)
{
    while (p->next < p->count) {
        int32_t index = p->next++;
        pthread_mutex_unlock(&p->mutex);
        p->job(p->argument, index, number);
        if (number == 0 && p->watch)
            p->watch(index + 1, p->count);
        pthread_mutex_lock(&p->mutex);
    }
}

static void *work(void *argument)
{
    struct worker *w = argument;
    pool *p = w->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&p->mutex);
    while (!p->stop) {
        if (p->run == seen) {
            pthread_cond_wait(&p->work, &p->mutex);
            continue;
        }
        seen = p->run;
        p->busy++;
        take_jobs(p, w->number);
        if (--p->busy == 0)
            pthread_cond_signal(&p->idle);
    }
    pthread_mutex_unlock(&p->mutex);
    return NULL;
}

static void run(void *context, tyn_job job, void *argument, int32_t count)
{
    pool *p = context;
    pthread_mutex_lock(&p->mutex);
    p->job = job;
    p->argument = argument;
    p->next = 0;
    p->count = count;
    p->run++;
    if (count > 1 && p->executor.workers > 1)
        pthread_cond_broadcast(&p->work);
    take_jobs(p, 0);
    /* A thread that wakes up later finds no job left, and the next run can't start before it has said so. */
    while (p->busy > 0)
        pthread_cond_wait(&p->idle, &p->mutex);
    pthread_mutex_unlock(&p->mutex);
}

pool *pool_create(int32_t workers)
{
    pool *p = calloc(1, sizeof *p);
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGALRM, SIGXCPU};
    sigset_t ours, old;
    if (!p)
        return NULL;
    pthread_mutex_init(&p->mutex, NULL);
    pthread_cond_init(&p->work, NULL);
    pthread_cond_init(&p->idle, NULL);
    p->executor.run = run;
    p->executor.context = p;
    p->executor.workers = 1;
    /* These are for the thread that knows what to do then. */
    sigemptyset(&ours);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sigaddset(&ours, numbers[i]);
    pthread_sigmask(SIG_BLOCK, &ours, &old);
    for (int32_t i = 1; i < workers && i < TYN_MAX_WORKERS; i++) {
        p->workers[i].pool = p;
        p->workers[i].number = i;
        if (pthread_create(&p->workers[i].thread, NULL, work, &p->workers[i]) != 0)
            break;
        p->executor.workers = i + 1;
    }
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    return p;
}

void pool_free(pool *p)
{
    if (!p)
        return;
    pthread_mutex_lock(&p->mutex);
    p->stop = 1;
    pthread_cond_broadcast(&p->work);
    pthread_mutex_unlock(&p->mutex);
    for (int32_t i = 1; i < p->executor.workers; i++)
        pthread_join(p->workers[i].thread, NULL);
    pthread_cond_destroy(&p->idle);
    pthread_cond_destroy(&p->work);
    pthread_mutex_destroy(&p->mutex);
    free(p);
}

const tyn_executor *pool_executor(pool *p)
{
    return &p->executor;
}

void pool_watch(pool *p, void (*watch)(int32_t taken, int32_t count))
{
    p->watch = watch;
}
