/* test_workers.c - tyn_render's promises beyond a frame: the same bytes for any workers, nothing kept between frames. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "rig.h"
#include "guard.h"
#include "test.h"

/* Executors of all kinds. `kind` of a crowd; LATE: threads that dawdle before each job. */
enum { IN_ORDER, REVERSED, SHUFFLED, THREADS, LATE, KINDS };

typedef struct crowd {
    int32_t workers;
    int kind;
} crowd;

typedef struct share {
    pthread_t thread;
    tyn_job job;
    void *argument;
    int32_t *next, count, worker, late;
    pthread_mutex_t *lock;
} share;

static void *work(void *of)
{
    share *s = of;
    for (;;) {
        int32_t i;
        pthread_mutex_lock(s->lock);
        i = (*s->next)++;
        pthread_mutex_unlock(s->lock);
        if (i >= s->count)
            return NULL;
        if (s->late) {
            const struct timespec while_others_work = {0, 1000 * ((i * 7 + s->worker) % 5)};
            nanosleep(&while_others_work, NULL);
        }
        s->job(s->argument, i, s->worker);
    }
}

static void run_threads(const crowd *c, tyn_job job, void *argument, int32_t count)
{
    share shares[TYN_MAX_WORKERS];
    pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    int32_t next = 0;
    for (int32_t w = 0; w < c->workers; w++) {
        share s = {0};
        s.job = job;
        s.argument = argument;
        s.next = &next;
        s.count = count;
        s.worker = w;
        s.late = c->kind == LATE;
        s.lock = &lock;
        shares[w] = s;
        if (pthread_create(&shares[w].thread, NULL, work, &shares[w]))
            abort();
    }
    for (int32_t w = 0; w < c->workers; w++)
        pthread_join(shares[w].thread, NULL);
}

static void run_crowd(void *context, tyn_job job, void *argument, int32_t count)
{
    const crowd *c = context;
    int32_t *order;
    if (c->kind >= THREADS) {
        run_threads(c, job, argument, count);
        return;
    }
    order = malloc((size_t)(count + 1) * sizeof *order);
    if (!order)
        abort();
    for (int32_t i = 0; i < count; i++)
        order[i] = c->kind == REVERSED ? count - 1 - i : i;
    for (int32_t i = count - 1; c->kind == SHUFFLED && i > 0; i--) {
        int32_t j = (int32_t)(test_random() % (uint32_t)(i + 1)), swap = order[i];
        order[i] = order[j];
        order[j] = swap;
    }
    for (int32_t i = 0; i < count; i++)
        job(argument, order[i], (int32_t)(test_random() % (uint32_t)c->workers));
    free(order);
}

static void test_any_workers(void)
{
    enum { W = 34, H = 23 };
    static const char *const scenes[] = {"sun ahead", "lamp in view", "sun parallel to the picture"};
    TEST("tyn_render: the same bytes for any workers in any order");
    for (int n = 0; n < 3; n++) {
        rig *r = rig_stock(scenes[n], W, H, 128);
        for (int way = 0; way < RIG_WAYS; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            uint64_t scatter, target;
            tyn_stats stats;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            scatter = rig_hash(r->scatter, W * H * 3 * sizeof(float));
            target = rig_hash(r->target, W * H * 4);
            stats = r->stats;
            for (int32_t workers = 1; workers <= 7; workers++)
                for (int kind = 0; kind < (workers == 3 ? KINDS : LATE); kind++) {
                    crowd c = {workers, kind};
                    tyn_executor executor = {run_crowd, &c, workers};
                    config.workers = workers + (kind == SHUFFLED); /* room for more than come */
                    frame.executor = &executor;
                    memset(r->scatter, 0x5a, W * H * 3 * sizeof(float));
                    CHECK(rig_render(r, &config, &frame) == TYN_OK);
                    CHECK(rig_hash(r->scatter, W * H * 3 * sizeof(float)) == scatter);
                    CHECK(rig_hash(r->target, W * H * 4) == target);
                    stats.memory = r->stats.memory;
                    CHECK(memcmp(&stats, &r->stats, sizeof stats) == 0);
                }
        }
        rig_free(r);
    }
}

/* Executors that break the rules, one way each. */
static void run_bad(void *context, tyn_job job, void *argument, int32_t count)
{
    int kind = *(const int *)context;
    if (kind == 6) /* refuses */
        return;
    for (int32_t i = 0; i < count; i++) {
        if (kind == 0 && i == count - 1)
            continue; /* forgets one */
        if (kind == 1 && i == 0)
            job(argument, i, 0); /* does one twice */
        job(argument, kind == 4 && i == 1 ? count : kind == 5 && i == 1 ? -1 : i, kind == 2 && i == 1 ? 2 : kind == 3 ? -1 : 0);
    }
}

static void test_bad_executors(void)
{
    rig *r = rig_stock("sun ahead", 40, 30, 64);
    TEST("tyn_render: executors that forget, repeat, miscount or refuse");
    for (int kind = 0; kind < 7; kind++)
        for (int way = 0; way < RIG_WAYS; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            tyn_executor executor = {run_bad, &kind, 2};
            guard target = guard_new(40, 30, TYN_RGBA8_SRGB, 0);
            config.workers = 2;
            frame.executor = &executor;
            frame.target = target.image;
            CHECK(rig_render(r, &config, &frame) == TYN_E_EXECUTOR);
            CHECK(guard_intact(&target));
            guard_free(&target);
        }
    rig_free(r);
}

/* ---- no memory ------------------------------------------------------------------------------------------------------ */

static uint64_t ticks(void *context)
{
    return ++*(uint64_t *)context * 1000;
}

/* One context, other frames and sizes in between: each frame is as from a fresh context, and the block's end stays whole. */
static void test_no_history(void)
{
    static const char *const scenes[] = {"sun ahead", "lamp above", "sun off the left", "lamp in view"};
    rig *r[4];
    uint64_t fresh[4];
    TEST("tyn_render: nothing is kept between frames");
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config;
        size_t bytes;
        tyn_context *context;
        uint8_t *block;
        uint64_t time = 0;
        for (int i = 0; i < 4; i++)
            r[i] = rig_stock(scenes[i], 64 - 9 * i, 48 - 7 * i, 128);
        config = rig_way_config(r[0], &rig_ways[way]);
        for (int i = 0; i < 4; i++) {
            tyn_frame frame = rig_frame(r[i]);
            CHECK(rig_render(r[i], &config, &frame) == TYN_OK);
            fresh[i] = rig_hash(r[i]->target, (size_t)(r[i]->width * r[i]->height) * 4);
            CHECK(r[i]->stats.total_ns == 0 && r[i]->stats.slice_ns == 0 && r[i]->stats.gather_ns == 0);
        }
        CHECK(tyn_measure(&config, &bytes) == TYN_OK);
        block = rig_block(bytes + 64);
        memset(block, 0xee, bytes + 64);
        CHECK(tyn_init(&context, &config, block, bytes) == TYN_OK);
        memset(&config, 0xee, sizeof config); /* it was copied */
        for (int n = 0; n < 12; n++) {
            int i = (int)(test_random() & 3u);
            tyn_frame frame = rig_frame(r[i]);
            frame.clock = ticks;
            frame.clock_context = &time;
            CHECK(tyn_render(context, &frame) == TYN_OK);
            CHECK(rig_hash(r[i]->target, (size_t)(r[i]->width * r[i]->height) * 4) == fresh[i]);
            CHECK(r[i]->stats.memory == bytes && r[i]->stats.total_ns > 0);
        }
        for (size_t i = bytes; i < bytes + 64; i++)
            CHECK(block[i] == 0xee);
        free(block);
        for (int i = 0; i < 4; i++)
            rig_free(r[i]);
    }
}

void test_workers(void)
{
    test_any_workers();
    test_bad_executors();
    test_no_history();
}
