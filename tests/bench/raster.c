/* raster.c - times of the rasterizer: every ISA, one and two threads, and Mesa's llvmpipe for the same triangles, textures,
 * matrices and sizes. Minima over repeats, all in one run.
 *
 *     bench-raster [OBJ] [WIDTHxHEIGHT] [REPEATS]      default: Sponza of the shared data, 1920x1080, 15
 *
 * Passes: the shadow map (1024 x 1024); depth alone; plain: depth and colour, textured, lit by a sun without a shadow
 * map; shadowed: the same with a look-up in the map, four texels compared and weighted. */
#define _DEFAULT_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "obj.h"
#include "pool.h"
#include "raster.h"

static const char *const passes[RASTER_PASSES] = {"shadow map", "depth", "plain", "shadowed"};

static void die(const char *what)
{
    fprintf(stderr, "bench-raster: %s\n", what);
    exit(1);
}

static void need(tyn_status status, const char *what)
{
    if (status == TYN_OK)
        return;
    fprintf(stderr, "bench-raster: %s: %s\n", what, tyn_status_name(status));
    exit(1);
}

/* Shared with the processes in which llvmpipe runs. */
static void *shared(size_t bytes)
{
    void *block = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (block == MAP_FAILED)
        die("no memory");
    memset(block, 0, bytes);
    return block;
}

double raster_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static raster_picture make_picture(const raster_work *w)
{
    const size_t pixels = (size_t)w->width * (size_t)w->height;
    raster_picture p;
    p.depth = shared(pixels * sizeof(float));
    p.rgb = shared(pixels * 3 * sizeof(float));
    p.map = shared((size_t)w->map * (size_t)w->map * sizeof(float));
    return p;
}

/* The view that the data's README calls a good one. */
static void set_up(raster_work *w, scene *s, const char *path)
{
    static const float eye[3] = {-9.8f, 1.7f, 1.6f}, target[3] = {4, 4.5f, -1}, up[3] = {0, 1, 0},
                       sun[3] = {0.5f, 0.85f, -0.08f};
    const float length = sqrtf(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]);
    obj_place place = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, {0.7f, 0.7f, 0.7f}};
    texture_cache textures = {0};
    tool_error error = {""};
    float low[3], high[3];
    scene_init(s);
    if (obj_load(s, path, &place, &textures, &error) != 0)
        die(error.text);
    texture_cache_free(&textures);
    w->scene = s;
    need(tyn_camera_look(&w->camera, eye, target, up, 1.308997f, 0.1f, 100.0f, w->width, w->height), "camera");
    w->light.kind = TYN_LIGHT_DIRECTIONAL;
    for (int c = 0; c < 3; c++) {
        w->light.direction[c] = -sun[c] / length;
        w->light.colour[c] = 3.0f;
        w->ambient[c] = 0.5f;
        w->background[c] = 0.3f;
    }
    scene_bounds(s, low, high);
    need(tyn_shadow_fit(&w->light, &w->camera, low, high), "tyn_shadow_fit");
    w->light.shadow.size = w->map;
}

/* ---- ours ---- */

typedef struct ours {
    tyn_raster *raster;
    void *block;
    pool *threads;
} ours;

static ours make_ours(const raster_work *w, int32_t isa, int32_t workers)
{
    ours o;
    tyn_raster_config c = {0};
    size_t bytes;
    o.threads = pool_create(workers);
    if (!o.threads)
        die("no threads");
    c.width = w->width > w->map ? w->width : w->map;
    c.height = w->height > w->map ? w->height : w->map;
    c.workers = workers;
    c.isa = isa;
    need(tyn_raster_measure(&c, &bytes), "tyn_raster_measure");
    if (posix_memalign(&o.block, TYN_ALIGNMENT, bytes))
        die("no memory");
    need(tyn_raster_init(&o.raster, &c, o.block, bytes), "tyn_raster_init");
    return o;
}

static void draw(const raster_work *w, const ours *o, const tyn_executor *executor, int pass, raster_picture *p)
{
    tyn_surface f;
    tyn_light light = w->light;
    if (pass == RASTER_MAP) {
        need(tyn_raster_shadow(o->raster, &light.shadow, p->map, w->scene->meshes, w->scene->mesh_count, executor, NULL, NULL,
                               NULL),
             "tyn_raster_shadow");
        return;
    }
    memset(&f, 0, sizeof f);
    light.shadow.depth = pass == RASTER_SHADOWED ? p->map : NULL;
    if (!light.shadow.depth)
        light.shadow.size = 0;
    f.camera = w->camera;
    f.meshes = w->scene->meshes;
    f.mesh_count = w->scene->mesh_count;
    f.lights = &light;
    f.light_count = 1;
    memcpy(f.ambient, w->ambient, sizeof f.ambient);
    memcpy(f.background, w->background, sizeof f.background);
    f.depth.pixels = p->depth;
    f.colour.pixels = pass == RASTER_DEPTH ? NULL : p->rgb;
    f.depth.width = f.colour.width = w->width;
    f.depth.height = f.colour.height = w->height;
    f.depth.format = TYN_DEPTH_F32;
    f.colour.format = TYN_RGB_F32;
    f.executor = executor;
    need(tyn_raster_surface(o->raster, &f), "tyn_raster_surface");
}

static void time_ours(const raster_work *w, const ours *o, int repeats, raster_times *times, raster_picture *p)
{
    for (int i = 0; i < repeats; i++)
        for (int pass = 0; pass < RASTER_PASSES; pass++) {
            const double start = raster_now();
            draw(w, o, pool_executor(o->threads), pass, p);
            times->ms[pass] = fmin(times->ms[pass], raster_now() - start);
        }
}

/* What two threads would take on two cores of their own: jobs one by one, each to the worker that is free first. Says what
 * the division into jobs allows where a machine is shared; memory and waking threads are not in it. */
static double modelled;

static void run_model(void *context, tyn_job job, void *argument, int32_t count)
{
    double busy[2] = {0, 0};
    (void)context;
    for (int32_t i = 0; i < count; i++) {
        const double start = raster_now();
        job(argument, i, 0);
        busy[busy[1] < busy[0]] += raster_now() - start;
    }
    modelled += (busy[0] < busy[1] ? busy[0] : busy[1]); /* what the second one takes off the first */
}

static void model_ours(const raster_work *w, const ours *o, int repeats, double gain[RASTER_PASSES], raster_picture *p)
{
    tyn_executor executor = {run_model, NULL, 1};
    for (int i = 0; i < repeats; i++)
        for (int pass = 0; pass < RASTER_PASSES; pass++) {
            const double start = raster_now();
            double whole;
            modelled = 0;
            draw(w, o, &executor, pass, p);
            whole = raster_now() - start;
            gain[pass] = fmax(gain[pass], whole / (whole - modelled));
        }
}

/* ---- theirs, in a process of its own ---- */

typedef struct theirs {
    raster_times times;
    raster_picture picture;
    int works;
    char reason[200];
} theirs;

static void time_theirs(const raster_work *w, int threads, int repeats, theirs *t)
{
    pid_t child;
    int status;
    fflush(stdout);
    child = fork();
    if (child == 0) {
        t->works = llvmpipe_draw(w, threads, repeats, &t->times, &t->picture, t->reason) == 0;
        fflush(stdout);
        _exit(0);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status))
        t->works = 0;
}

/* Share of pixels that agree: nothing in both, or depths within 1 %; and the mean error of colour where they do. */
static void compare(const raster_work *w, const raster_picture *a, const raster_picture *b)
{
    const size_t pixels = (size_t)w->width * (size_t)w->height, texels = (size_t)w->map * (size_t)w->map;
    size_t same = 0, covered[2] = {0, 0}, map_same = 0;
    double colour = 0, sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float far = 0.999f * w->camera.far_depth;
        const int na = a->depth[i] >= far, nb = b->depth[i] >= far;
        covered[0] += !na;
        covered[1] += !nb;
        if (na != nb || (!na && fabsf(a->depth[i] - b->depth[i]) > 0.01f * a->depth[i]))
            continue;
        same++;
        for (size_t c = 0; c < 3; c++) {
            colour += fabs((double)(a->rgb[3 * i + c] - b->rgb[3 * i + c]));
            sum += (double)a->rgb[3 * i + c];
        }
    }
    for (size_t i = 0; i < texels; i++)
        map_same += fabsf(a->map[i] - b->map[i]) < 1e-3f;
    printf("pictures: covered %.3f %% and %.3f %%, %.3f %% of pixels agree in depth (1 %%), colour there differs by %.3f %% in "
           "the mean; %.3f %% of the map's texels agree\n",
           100.0 * (double)covered[0] / (double)pixels, 100.0 * (double)covered[1] / (double)pixels,
           100.0 * (double)same / (double)pixels, 100.0 * colour / sum, 100.0 * (double)map_same / (double)texels);
}

/* ---- the table ---- */

static void head(void)
{
    printf("  %-20s", "ms");
    for (int i = 0; i < RASTER_PASSES; i++)
        printf(" %11s", passes[i]);
    printf("\n");
}

static void row(const char *name, int threads, const raster_times *t)
{
    printf("  %-10s %d thread%s", name, threads, threads > 1 ? "s" : " ");
    for (int i = 0; i < RASTER_PASSES; i++)
        printf(" %11.2f", t->ms[i]);
    printf("\n");
}

static void ratio(const char *name, const raster_times *a, const raster_times *b)
{
    printf("  %-20s", name);
    for (int i = 0; i < RASTER_PASSES; i++)
        printf(" %11.2f", a->ms[i] / b->ms[i]);
    printf("\n");
}

static const raster_times never = {{1e9, 1e9, 1e9, 1e9}};

#define ISAS 6

static void bench(const raster_work *w, int repeats)
{
    raster_picture p = make_picture(w);
    raster_times times[ISAS][2], lp[2] = {never, never};
    ours o[ISAS][2];
    theirs *t = shared(3 * sizeof *t);
    double gain[RASTER_PASSES] = {0, 0, 0, 0};
    int best = 0;
    for (int i = 0; i < 3; i++) {
        t[i].times = never;
        t[i].picture = make_picture(w);
    }
    for (int i = 0; i < ISAS; i++)
        for (int k = 0; k < 2; k++) {
            times[i][k] = never;
            if (tyn_isa_available() & 1 << i)
                o[i][k] = make_ours(w, 1 << i, k + 1);
        }
    for (int round = 0; round < 3; round++) { /* in turn, so that a busy moment hits all alike */
        for (int i = 0; i < ISAS; i++)
            for (int k = 0; k < 2 && (tyn_isa_available() & 1 << i); k++)
                time_ours(w, &o[i][k], (repeats + 2) / 3, &times[i][k], &p);
        for (int i = 0; i < 3; i++)
            time_theirs(w, i, (repeats + 2) / 3, &t[i]);
    }
    for (int i = 0; i < ISAS; i++)
        if (tyn_isa_available() & 1 << i)
            best = i;
    model_ours(w, &o[best][0], repeats, gain, &p);
    draw(w, &o[0][0], NULL, RASTER_PLAIN, &p); /* to compare */
    head();
    for (int i = 0; i < ISAS; i++)
        if (tyn_isa_available() & 1 << i) {
            for (int k = 0; k < 2; k++) {
                row(tyn_isa_name(1 << i), k + 1, &times[i][k]);
                pool_free(o[i][k].threads);
                free(o[i][k].block);
            }
        }
    ratio("2 threads, x 1", &times[best][0], &times[best][1]);
    printf("  %-20s", "by jobs' times");
    for (int i = 0; i < RASTER_PASSES; i++)
        printf(" %11.2f", gain[i]);
    printf("\n");
    if (best)
        ratio("best, x scalar", &times[0][1], &times[best][1]);
    if (!t[0].works || !t[1].works || !t[2].works) {
        printf("SKIPPED: llvmpipe: %s\n", t[0].reason[0] ? t[0].reason : "it did not run");
        return;
    }
    /* Its own threads and the caller's share two cores: the better of one and two. */
    for (int i = 0; i < RASTER_PASSES; i++) {
        lp[0].ms[i] = t[0].times.ms[i];
        lp[1].ms[i] = fmin(t[1].times.ms[i], t[2].times.ms[i]);
    }
    row("llvmpipe", 1, &lp[0]);
    row("llvmpipe", 2, &lp[1]);
    ratio("llvmpipe / ours, 1", &lp[0], &times[best][0]);
    ratio("llvmpipe / ours, 2", &lp[1], &times[best][1]);
    compare(w, &p, &t[0].picture);
}

int main(int argc, char **argv)
{
    const char *root = getenv("TYN_SHARED");
    char path[4096];
    raster_work w;
    scene s;
    int width = 1920, height = 1080, repeats = argc > 3 ? atoi(argv[3]) : 15;
    uint32_t triangles = 0;
    memset(&w, 0, sizeof w);
    snprintf(path, sizeof path, "%s/data/dabrovic-sponza/dabrovic-sponza.obj", root ? root : "../shared");
    if (argc > 2 && sscanf(argv[2], "%dx%d", &width, &height) != 2)
        die("a size is WIDTHxHEIGHT");
    if (repeats < 1)
        die("repeats are 1 or more");
    if (argc < 2 && access(path, R_OK) != 0) {
        printf("SKIPPED: no %s\n", path);
        return 0;
    }
    w.width = width;
    w.height = height;
    w.map = 1024;
    set_up(&w, &s, argc > 1 ? argv[1] : path);
    for (int32_t i = 0; i < s.mesh_count; i++)
        triangles += s.meshes[i].triangles;
    printf("%lu triangles in %d meshes, %dx%d, shadow map %d, %d repeats\n", (unsigned long)triangles, (int)s.mesh_count, width,
           height, (int)w.map, repeats);
    bench(&w, repeats);
    scene_free(&s);
    return 0;
}
