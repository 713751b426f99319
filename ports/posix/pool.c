/* pool.c - jobs are taken without a lock; one mutex for going to sleep and waking up. */
#include "pool.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

struct worker {
    pool *pool;
    int32_t number;
    pthread_t thread;
};

/* Jobs next .. end - 1 of a run are left of what a worker was dealt; next may be beyond. On a cache line of its own. */
struct share {
    uint32_t next, end;
    uint8_t pad[56];
};

struct pool {
    tyn_executor executor;
    pthread_mutex_t mutex;
    pthread_cond_t work, idle;
    tyn_job job; /* of this run: written before it begins, when no thread is inside one */
    void *argument;
    int32_t count;
    uint32_t taken; /* jobs */
    uint32_t busy;  /* threads inside the run; rises and falls under the mutex */
    uint32_t run;   /* counts the runs, under the mutex: how a thread knows a new one */
    int stop;       /* under the mutex */
    void (*watch)(int32_t taken, int32_t count);
    struct worker workers[TYN_MAX_WORKERS]; /* [0] is the caller */
    struct share share[TYN_MAX_WORKERS];
};

int32_t pool_default_workers(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > TYN_MAX_WORKERS ? TYN_MAX_WORKERS : (int32_t)n;
}

/* C99 has no atomics; gcc and clang do. */
static uint32_t add(uint32_t *number, uint32_t more)
{
    return __atomic_fetch_add(number, more, __ATOMIC_ACQ_REL);
}
static uint32_t get(const uint32_t *number)
{
    return __atomic_load_n(number, __ATOMIC_ACQUIRE);
}

/* A thread that sleeps takes as long to wake up as a whole run of the rasterizer's, which has two for every thousand triangles.
 * So who waits looks on for about 0.1 ms before it sleeps. */
static void look(const uint32_t *number, uint32_t old)
{
    for (int i = 0; i < 400 && get(number) == old; i++)
        sched_yield();
}

/* Takes jobs until there are none: first of a worker's own share, so that from run to run it has the same part of a picture in
 * its cache, then of the others'. */
static void take_jobs(pool *p, int32_t number)
{
    for (int32_t i = 0, owner = number; i < p->executor.workers; i++) {
        struct share *s = &p->share[owner];
        for (uint32_t index; get(&s->next) < s->end && (index = add(&s->next, 1)) < s->end;) {
            uint32_t taken = add(&p->taken, 1) + 1;
            p->job(p->argument, (int32_t)index, number);
            if (number == 0 && p->watch)
                p->watch((int32_t)taken, p->count);
        }
        owner = owner + 1 < p->executor.workers ? owner + 1 : 0;
    }
}

static void *work(void *argument)
{
    struct worker *w = argument;
    pool *p = w->pool;
    uint32_t seen = 0;
    pthread_mutex_lock(&p->mutex);
    while (!p->stop) {
        pthread_mutex_unlock(&p->mutex);
        look(&p->run, seen);
        pthread_mutex_lock(&p->mutex);
        while (get(&p->run) == seen && !p->stop)
            pthread_cond_wait(&p->work, &p->mutex);
        if (get(&p->run) == seen)
            continue;
        seen = get(&p->run);
        add(&p->busy, 1);
        pthread_mutex_unlock(&p->mutex);
        take_jobs(p, w->number);
        pthread_mutex_lock(&p->mutex);
        if (add(&p->busy, (uint32_t)-1) == 1)
            pthread_cond_signal(&p->idle);
    }
    pthread_mutex_unlock(&p->mutex);
    return NULL;
}

/* Until no thread is inside a run. The mutex is held on entry and on return. */
static void wait_for_all(pool *p)
{
    for (uint32_t busy = get(&p->busy); busy > 0; busy = get(&p->busy)) {
        pthread_mutex_unlock(&p->mutex);
        look(&p->busy, busy);
        pthread_mutex_lock(&p->mutex);
        if (get(&p->busy) == busy)
            pthread_cond_wait(&p->idle, &p->mutex);
    }
}

static void run(void *context, tyn_job job, void *argument, int32_t count)
{
    pool *p = context;
    const int32_t workers = p->executor.workers;
    pthread_mutex_lock(&p->mutex);
    wait_for_all(p); /* threads that woke up too late for the run before */
    p->job = job;
    p->argument = argument;
    p->taken = 0;
    p->count = count;
    for (int32_t i = 0; i < workers; i++) {
        p->share[i].next = (uint32_t)(count * (int64_t)i / workers);
        p->share[i].end = (uint32_t)(count * ((int64_t)i + 1) / workers);
    }
    add(&p->run, 1);
    if (count > 1 && workers > 1)
        pthread_cond_broadcast(&p->work);
    pthread_mutex_unlock(&p->mutex);
    take_jobs(p, 0);
    pthread_mutex_lock(&p->mutex);
    wait_for_all(p);
    pthread_mutex_unlock(&p->mutex);
}

pool *pool_create(int32_t workers)
{
    pool *p = calloc(1, sizeof *p);
    static const int signals[] = {POOL_SIGNALS, SIGALRM};
    sigset_t ours, old;
    if (!p)
        return NULL;
    pthread_mutex_init(&p->mutex, NULL);
    pthread_cond_init(&p->work, NULL);
    pthread_cond_init(&p->idle, NULL);
    p->executor.run = run;
    p->executor.context = p;
    p->executor.workers = 1;
    sigemptyset(&ours);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        sigaddset(&ours, signals[i]);
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
