/* page.c - what the page calls, and what a module of its own must bring: memory, and workers where memory is shared. No libc.
 */
#include "demo.h"

#define EXPORT(name) __attribute__((export_name(#name)))
#define WASM_PAGE 65536u
#define HELPERS 15          /* beside the thread that calls */
#define HELPER_STACK 32768u /* the library wants 4096 */

extern uint8_t __heap_base; /* by the linker: all behind it is free */

/* Nanoseconds, from JavaScript: a double holds them for weeks. */
__attribute__((import_module("page"), import_name("now"))) double page_now(void);

static demo d;
static demo_view view;
static double figures[32];
static uint8_t *frame_memory;
static size_t frame_bytes;

static uint64_t now(void *context)
{
    (void)context;
    return (uint64_t)page_now();
}

/* ---- workers ------------------------------------------------------------------------------------------------------- */

/* Jobs that are left count down: whoever takes one off has its index. While one runs, `run` has not returned and the rest of
 * the pool stays as it is; so a helper may read it after it got a job, however late it came. */
static struct pool {
    tyn_job job;
    void *argument;
    int32_t count, left, done;
    int32_t calls; /* of run: what helpers sleep on */
} pool;

#ifdef __wasm_atomics__
static void sleep_on(int32_t *word, int32_t value)
{
    __builtin_wasm_memory_atomic_wait32(word, value, -1);
}
static void wake(int32_t *word, uint32_t sleepers)
{
    __builtin_wasm_memory_atomic_notify(word, sleepers);
}
#else /* nobody else is there */
static void sleep_on(int32_t *word, int32_t value)
{
    (void)word;
    (void)value;
}
static void wake(int32_t *word, uint32_t sleepers)
{
    (void)word;
    (void)sleepers;
}
#endif

static void take_jobs(int32_t worker)
{
    for (;;) {
        int32_t left = __atomic_fetch_sub(&pool.left, 1, __ATOMIC_ACQ_REL);
        if (left <= 0)
            return;
        pool.job(pool.argument, pool.count - left, worker);
        if (__atomic_add_fetch(&pool.done, 1, __ATOMIC_ACQ_REL) == pool.count)
            wake(&pool.done, 1);
    }
}

#ifdef __wasm_atomics__
static uint8_t stacks[HELPERS][HELPER_STACK] __attribute__((aligned(64)));

/* Where a helper's stack starts; 0 for one too many. */
EXPORT(stack) uint8_t *page_stack(int32_t helper)
{
    return helper < HELPERS ? stacks[helper] + HELPER_STACK : NULL;
}

/* Never returns. */
EXPORT(help) void page_help(int32_t helper)
{
    for (;;) {
        int32_t calls = __atomic_load_n(&pool.calls, __ATOMIC_ACQUIRE);
        take_jobs(helper + 1);
        sleep_on(&pool.calls, calls);
    }
}
#endif

static void run(void *context, tyn_job job, void *argument, int32_t count)
{
    (void)context;
    pool.job = job;
    pool.argument = argument;
    pool.count = count;
    __atomic_store_n(&pool.done, 0, __ATOMIC_RELEASE);
    __atomic_store_n(&pool.left, count, __ATOMIC_RELEASE);
    __atomic_fetch_add(&pool.calls, 1, __ATOMIC_ACQ_REL);
    wake(&pool.calls, HELPERS);
    take_jobs(0);
    for (;;) {
        int32_t done = __atomic_load_n(&pool.done, __ATOMIC_ACQUIRE);
        if (done == count)
            return;
        sleep_on(&pool.done, done);
    }
}

static tyn_executor executor = {run, NULL, 1};

/* ---- calls --------------------------------------------------------------------------------------------------------- */

/* Makes sure that memory goes to `end`. */
static int reach(size_t end)
{
    size_t have = __builtin_wasm_memory_size(0) * WASM_PAGE;
    return end <= have || __builtin_wasm_memory_grow(0, (end - have + WASM_PAGE - 1) / WASM_PAGE) != (size_t)-1;
}

EXPORT(open) int32_t page_open(void)
{
    size_t start = (size_t)&__heap_base, end = start + scene_bytes();
    if (!reach(end))
        return TYN_E_MEMORY;
    scene_build(&d.scene, &__heap_base);
    d.clock = now;
    frame_memory = (uint8_t *)((end + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT);
    return TYN_OK;
}

/* Filled by the page before `draw`. */
EXPORT(view) demo_view *page_view(void)
{
    return &view;
}

EXPORT(draw) int32_t page_draw(void)
{
    frame_bytes = demo_bytes(&view);
    if (frame_bytes == 0)
        return TYN_E_CONFIG;
    if (!reach((size_t)frame_memory + frame_bytes))
        return TYN_E_MEMORY;
    executor.workers = view.workers;
    d.executor = &executor;
    return demo_draw(&d, &view, frame_memory, frame_bytes);
}

EXPORT(march) int32_t page_march(int32_t x, int32_t y, int32_t width, int32_t height)
{
    return demo_march(&d, x, y, width, height);
}

EXPORT(target) const uint8_t *page_target(void)
{
    return d.target;
}

EXPORT(truth) const uint8_t *page_truth(void)
{
    return d.truth;
}

EXPORT(hash) uint64_t page_hash(void)
{
    return demo_hash(&d);
}

/* Of the last frame, nanoseconds and bytes: worker.js has the same order. */
EXPORT(figures) const double *page_figures(void)
{
    const tyn_stats *s = &d.stats;
    const uint64_t times[] = {d.shadow_ns, d.surface_ns, s->total_ns,   s->sample_ns,  s->row_ns,      s->ray_ns,
                              s->line_ns,  s->unwarp_ns, s->correct_ns, s->upscale_ns, s->composite_ns};
    const size_t bytes[] = {d.shaft_bytes, d.map_bytes, d.raster_bytes, d.picture_bytes,
                            __builtin_wasm_memory_size(0) * WASM_PAGE};
    int n = 0;
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        figures[n++] = (double)times[i];
    for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++)
        figures[n++] = (double)bytes[i];
    figures[n++] = (double)s->rays_percent;
    return figures;
}

/* Two floats beside the figures: see demo_gap. */
EXPORT(gap) const double *page_gap(int32_t x, int32_t width)
{
    float largest, squared;
    demo_gap(&d, x, width, &largest, &squared);
    figures[30] = (double)largest;
    figures[31] = (double)squared;
    return figures + 30;
}

/* Which of tyn_isa the library takes by itself. */
EXPORT(isa) int32_t page_isa(void)
{
    return tyn_isa_available();
}
