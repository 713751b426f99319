/* stability.c - what moves must not flicker, pop or streak: a camera that creeps by quarter pixels, and a light at every place
 * of the sky, each frame held against the exact march of the same shadow map. `make stability` writes tables and plots.
 *
 *     bench-stability FOLDER [PART ...]      parts: camera paths map; all without, three quarters of an hour
 *
 * Tables on stdout, every frame in FOLDER as CSV, the worst as pictures: the method, the march, and eight times their
 * difference. stability.gp draws the plots. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "png.h"
#include "stage.h"

enum { WAYS = 5, FRAMES = 32, PATHS = 6 };

static const struct {
    const char *name;
    tyn_preset preset;
    tyn_method method;
} ways[WAYS] = {{"quality", TYN_PRESET_QUALITY, TYN_METHOD_EPIPOLAR},
                {"balanced", TYN_PRESET_BALANCED, TYN_METHOD_EPIPOLAR},
                {"handheld", TYN_PRESET_HANDHELD, TYN_METHOD_EPIPOLAR},
                {"prefiltered", TYN_PRESET_QUALITY, TYN_METHOD_PREFILTERED},
                {"hybrid", TYN_PRESET_QUALITY, TYN_METHOD_HYBRID}};

static const char *const scenes[] = {"simple-off", "leafy-off"};
static const char *folder = ".";
static pool *threads;

static FILE *table(const char *part, const char *place, const char *what)
{
    char path[512];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s-%s-%s.csv", folder, part, place, what);
    file = fopen(path, "w");
    if (!file)
        bench_die("a table cannot be written");
    return file;
}

/* A stage and a context for each way. */
typedef struct show {
    stage s;
    tyn_context *context[WAYS + 1]; /* the last: the march */
} show;

static void show_open(show *w, const char *name, int32_t width, int32_t height, int32_t map)
{
    stage_set_up(&w->s, name, width, height, map, threads);
    for (int i = 0; i < WAYS; i++) {
        tyn_config c;
        bench_need(tyn_config_preset(&c, ways[i].preset, width, height), "tyn_config_preset");
        c.method = ways[i].method;
        c.shadow_size = map;
        c.workers = pool_executor(threads)->workers;
        w->context[i] = stage_context(&c);
    }
}

static void show_close(show *w)
{
    for (int i = 0; i < WAYS; i++)
        free(w->context[i]);
    stage_tear_down(&w->s);
}

/* Turns the camera's axes a towards b. */
static void turn(float a[3], float b[3], double angle)
{
    for (int k = 0; k < 3; k++) {
        double x = (double)a[k], y = (double)b[k];
        a[k] = (float)(x * cos(angle) + y * sin(angle));
        b[k] = (float)(y * cos(angle) - x * sin(angle));
    }
}

/* The camera looks up by `degrees`; what it sees is drawn with the light as it is. */
static void look(show *w, double degrees)
{
    bench_need(scene_camera_make(&w->s.scene, w->s.width, w->s.height, &w->s.camera), "camera");
    turn(w->s.camera.forward, w->s.camera.up, degrees * 0.017453292519943295);
    stage_surface(&w->s, threads);
}

/* Method, march, and eight times their difference, side by side. The way's picture is rendered anew. */
static void picture(show *w, int way, const char *name)
{
    stage *s = &w->s;
    char path[512];
    size_t row = 4 * (size_t)s->width;
    uint8_t *out = malloc(3 * row * (size_t)s->height);
    FILE *file;
    stage_truth(s, threads);
    stage_compare(s, w->context[way], threads);
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    file = fopen(path, "wb");
    if (!file || !out)
        bench_die("a picture cannot be written");
    for (int32_t y = 0; y < s->height; y++) {
        uint8_t *to = out + 3 * row * (size_t)y, *got = s->target + row * (size_t)y, *want = s->truth + row * (size_t)y;
        memcpy(to, got, row);
        memcpy(to + row, want, row);
        for (size_t i = 0; i < row; i++) {
            int apart = 8 * abs(got[i] - want[i]);
            to[2 * row + i] = (uint8_t)(apart > 255 ? 255 : apart);
        }
    }
    if (png_write(file, out, 3 * s->width, s->height) != 0 || fclose(file) != 0)
        bench_die(path);
    free(out);
}

static double mean_of(const float *v, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)v[i];
    return sum / (double)count;
}

/* ---- the camera by quarter pixels ------------------------------------------------------------------------------------ */

static const char *const moves[] = {"pan", "tilt", "strafe", "forward"};

/* A quarter of a pixel: turned, or moved such that what is 20 m away moves by it (forward: at half the picture's width). */
static void creep(tyn_camera *c, int move, int32_t width)
{
    double step = 0.25 * (double)(c->right_edge - c->left_edge) / width;
    if (move == 0)
        turn(c->forward, c->right, step);
    else if (move == 1)
        turn(c->forward, c->up, step);
    for (int k = 0; k < 3 && move >= 2; k++)
        c->position[k] += (float)(20 * step) * (move == 2 ? c->right[k] : 2.0f * c->forward[k]);
}

/* Change from frame to frame of the picture and of the error. */
typedef struct change {
    double light, error, most; /* most: the largest ratio of a frame to the march's */
} change;

static void camera_path(show *w, FILE *file, int move, int frames, change sum[WAYS + 1])
{
    const size_t count = 3 * w->s.pixels;
    float *last[WAYS + 1];
    double level = 0;
    memset(sum, 0, (WAYS + 1) * sizeof *sum);
    for (int i = 0; i <= WAYS; i++)
        if (!(last[i] = calloc(count, sizeof **last)))
            bench_die("no memory");
    look(w, 0);
    for (int f = 0; f < frames; f++, creep(&w->s.camera, move, w->s.width)) {
        double moved[WAYS + 1] = {0};
        float *before = malloc(count * sizeof *before); /* the march of the last frame */
        if (!before)
            bench_die("no memory");
        memcpy(before, last[WAYS], count * sizeof *before);
        stage_surface(&w->s, threads);
        stage_truth(&w->s, threads);
        level += mean_of(w->s.truth_scatter, count) / frames;
        for (int i = WAYS; i >= 0; i--) {
            const float *now = w->s.truth_scatter;
            double wrong = 0;
            if (i < WAYS) {
                stage_compare(&w->s, w->context[i], threads);
                now = w->s.scatter;
            }
            for (size_t k = 0; k < count && f; k++) {
                double step = (double)now[k] - (double)last[i][k];
                moved[i] += fabs(step);
                wrong += fabs(step - ((double)w->s.truth_scatter[k] - (double)before[k]));
            }
            memcpy(last[i], now, count * sizeof *now);
            if (f) {
                sum[i].light += moved[i];
                sum[i].error += wrong;
                sum[i].most = fmax(sum[i].most, moved[i] / moved[WAYS]);
            }
        }
        if (file && f) {
            fprintf(file, "%d", f);
            for (int i = 0; i < WAYS; i++)
                fprintf(file, ",%.5f", moved[i] / moved[WAYS]);
            fprintf(file, ",%.6g\n", moved[WAYS] / (double)count);
        }
        free(before);
    }
    for (int i = 0; i <= WAYS; i++) {
        sum[i].error *= 100 / (level * (double)count * (frames - 1));
        sum[i].light /= i < WAYS ? 1 : level * (double)count * (frames - 1) / 100;
        free(last[i]);
    }
    for (int i = 0; i < WAYS; i++)
        sum[i].light *= 100 / (level * (double)count * (frames - 1)) / sum[WAYS].light;
}

static void heads(FILE *file, const char *first, const char *last)
{
    fprintf(file, "%s", first);
    for (int i = 0; i < WAYS; i++)
        fprintf(file, ",%s", ways[i].name);
    fprintf(file, "%s\n", last);
}

static void camera(void)
{
    static const char *const names[] = {"simple-off", "leafy-off", "simple-on", "leafy-on"};
    printf(
        "\ncamera by quarter pixels, 480x270, map 2048, 40 frames: change of L_scat from frame to frame, in the mean and at\n"
        "most, as a part of the march's (goal 1.1); and change of the error in percent of L_scat\n%-20s %8s",
        "", "march %");
    for (int i = 0; i < WAYS; i++)
        printf(" %20s", ways[i].name);
    for (int n = 0; n < 4; n++) {
        show w;
        show_open(&w, names[n], 480, 270, 2048);
        for (int m = 0; m < 4; m++) {
            FILE *file = table("camera", names[n], moves[m]);
            change sum[WAYS + 1];
            heads(file, "frame", ",march");
            camera_path(&w, file, m, 40, sum);
            fclose(file);
            printf("\n%-10s %-9s %8.3f", names[n], moves[m], sum[WAYS].light);
            for (int i = 0; i < WAYS; i++)
                printf(" %6.3f %6.3f %6.3f", sum[i].light, sum[i].most, sum[i].error);
            fflush(stdout);
        }
        show_close(&w);
    }
    printf("\n");
}

/* ---- the light at any place -------------------------------------------------------------------------------------------- */

/* A way to the light in the camera's frame: a place on the screen, 0 .. 1 from the left and from the top, at `side` 1; -1: the
 * point of the screen that is opposite, the light behind the camera. Or whatever direction, 0 as its side too. */
typedef struct spot {
    double x, y, z;
} spot;

static spot on_screen(const tyn_camera *c, double u, double v, double side)
{
    spot p;
    p.x = side * ((double)c->left_edge + u * (double)(c->right_edge - c->left_edge));
    p.y = side * ((double)c->top_edge + v * (double)(c->bottom_edge - c->top_edge));
    p.z = side;
    return p;
}

/* The sun from there, so dim that 8 bits hold it, or a lamp 30 m away that looks at what is 12 m before the camera. */
static void shine(show *w, tyn_light_kind kind, spot at)
{
    const tyn_camera *c = &w->s.camera;
    tyn_light *l = &w->s.light;
    const double reach = 30, length = sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
    double way[3], norm = 0;
    *l = w->s.scene.lights[0].light;
    l->kind = kind;
    l->angle = 1.2f;
    l->shadow.size = w->s.shadow_size;
    for (int k = 0; k < 3; k++) {
        double to = ((double)c->right[k] * at.x + (double)c->up[k] * at.y + (double)c->forward[k] * at.z) / length;
        way[k] = kind == TYN_LIGHT_SPOT ? 12 * (double)c->forward[k] - reach * to : -to;
        norm += way[k] * way[k];
        l->position[k] = c->position[k] + (float)(reach * to);
        l->colour[k] *= kind == TYN_LIGHT_SPOT ? (float)(reach * reach) : 0.25f;
    }
    for (int k = 0; k < 3; k++)
        l->direction[k] = (float)(way[k] / sqrt(norm));
    stage_shadow(&w->s, threads);
}

/* Frame f of FRAMES. All of the sky is above the ground in these. */
static spot on_path(const tyn_camera *c, int path, int f)
{
    const double t = (double)f / FRAMES, around = 6.283185307179586 * t, half = (f % (FRAMES / 2) + 1) * 2.0 / FRAMES * 2;
    spot p = {0, 0, 0};
    switch (path) {
    case 0: /* across the screen, far off on both sides */
        return on_screen(c, 4 * t - 1.5, 0.3, 1);
    case 1: /* on the border to the bit, corners too */
        return on_screen(c, fmin(fmax(t < 0.5 ? 4 * t : 3 - 4 * t, 0), 1), fmin(fmax(t < 0.5 ? 4 * t - 1 : 4 - 4 * t, 0), 1),
                         1);
    case 2: /* both diagonals, through the corners */
        return on_screen(c, f < FRAMES / 2 ? half - 1 : 2 - half, half - 1, 1);
    case 3: /* around the camera: at infinity twice, where it is beside */
        p.x = sin(around);
        p.y = 0.36;
        p.z = cos(around);
        return p;
    case 4: /* over the zenith, from ahead to behind */
        p.y = sin(around / 2 * 0.94 + 0.1);
        p.z = cos(around / 2 * 0.94 + 0.1);
        return p;
    default: /* behind: the shadow's end across the screen */
        return on_screen(c, 4 * t - 1.5, 0.7, -1);
    }
}

static const char *const path_names[PATHS] = {"across", "border", "corners", "around", "over", "behind"};
/* Up, so that all of the screen is sky that a sun can stand in; or down, so that the point opposite of it is ground. */
static const double path_looks[PATHS] = {33, 33, 33, 0, 0, -33};

typedef struct frame_error {
    double l1, level; /* relative to the march, percent; L_scat of the march in the mean */
    int worst;        /* of the 8-bit picture */
} frame_error;

static void measure(show *w, frame_error e[WAYS])
{
    stage_truth(&w->s, threads);
    for (int i = 0; i < WAYS; i++) {
        gap g = stage_compare(&w->s, w->context[i], threads);
        e[i].l1 = g.l1_percent;
        e[i].level = mean_of(w->s.truth_scatter, 3 * w->s.pixels);
        e[i].worst = g.worst;
    }
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of one way on one path. */
typedef struct summary {
    double median, most;
    int at, worst, worst_at, bad; /* frames of the two worst; frames that hold NaN */
} summary;

static summary sum_up(frame_error (*e)[WAYS], int way, int frames)
{
    double l1[FRAMES];
    summary s = {0, 0, 0, 0, 0, 0};
    for (int f = 0; f < frames; f++) {
        l1[f] = e[f][way].l1;
        s.bad += !(l1[f] < 1e9);
        if (l1[f] > s.most) {
            s.most = l1[f];
            s.at = f;
        }
        if (e[f][way].worst > s.worst) {
            s.worst = e[f][way].worst;
            s.worst_at = f;
        }
    }
    qsort(l1, (size_t)frames, sizeof *l1, by_size);
    s.median = l1[frames / 2];
    return s;
}

static const char *kind_name(tyn_light_kind kind)
{
    return kind == TYN_LIGHT_SPOT ? "lamp" : "sun";
}

static void light_path(show *w, tyn_light_kind kind, int path, int every, frame_error (*e)[WAYS])
{
    look(w, path_looks[path]);
    for (int f = 0; f < FRAMES; f += every) {
        shine(w, kind, on_path(&w->s.camera, path, f));
        measure(w, e[f / every]);
    }
}

static void paths(void)
{
    printf(
        "\na light on paths, 320x180, map 1024, %d frames: relative L1 to the march in percent, median and worst; their ratio\n"
        "(goal 2); largest difference of 8 bits\n%-24s",
        FRAMES, "");
    for (int i = 0; i < WAYS; i++)
        printf(" %24s", ways[i].name);
    for (int n = 0; n < 2; n++) {
        show w;
        show_open(&w, scenes[n], 320, 180, 1024);
        for (tyn_light_kind kind = TYN_LIGHT_DIRECTIONAL; kind <= TYN_LIGHT_SPOT; kind++) {
            FILE *file = table("light", scenes[n], kind_name(kind));
            heads(file, "frame", ",path,level,quality8,balanced8,handheld8,prefiltered8,hybrid8");
            for (int p = 0; p < PATHS; p++) {
                frame_error e[FRAMES][WAYS];
                light_path(&w, kind, p, 1, e);
                for (int f = 0; f < FRAMES; f++) {
                    fprintf(file, "%d", p * FRAMES + f);
                    for (int i = 0; i < WAYS; i++)
                        fprintf(file, ",%.5f", e[f][i].l1);
                    fprintf(file, ",%s,%.5g", path_names[p], e[f][0].level);
                    for (int i = 0; i < WAYS; i++)
                        fprintf(file, ",%d", e[f][i].worst);
                    fprintf(file, "\n");
                }
                printf("\n%-10s %-4s %-8s", scenes[n], kind_name(kind), path_names[p]);
                for (int i = 0; i < WAYS; i++) {
                    summary s = sum_up(e, i, FRAMES);
                    char name[128];
                    printf("  %6.3f %6.3f %4.1f %3d%s", s.median, s.most, s.most / s.median, s.worst, s.bad ? "!" : " ");
                    for (int k = 0; k < 2; k++) {
                        int f = k ? s.worst_at : s.at;
                        shine(&w, kind, on_path(&w.s.camera, p, f));
                        snprintf(name, sizeof name, "worst-%s-%s-%s-%s-%s%d", scenes[n], kind_name(kind), path_names[p],
                                 ways[i].name, k ? "8bit" : "l1", f);
                        picture(&w, i, name);
                    }
                }
                fflush(stdout);
            }
            fclose(file);
        }
        show_close(&w);
    }
    printf("\n");
}

/* ---- all places: 3x3 screens before the camera, and as many behind ------------------------------------------------------ */

static void map_of(show *w, const char *place, tyn_light_kind kind, int side)
{
    enum { COLUMNS = 25, ROWS = 16 }; /* 8 and 5 a screen, and its borders and corners to the bit */
    char what[64];
    FILE *file;
    double most[WAYS] = {0};
    spot worst[WAYS];
    memset(worst, 0, sizeof worst);
    snprintf(what, sizeof what, "%s-%s", kind_name(kind), side > 0 ? "front" : "behind");
    file = table("map", place, what);
    heads(file, "x,y", ",level,quality8,balanced8,handheld8,prefiltered8,hybrid8");
    look(w, side * 33.0);
    for (int y = 0; y < ROWS; y++) {
        for (int x = 0; x < COLUMNS; x++) {
            double u = x / 8.0 - 1, v = y / 5.0 - 1;
            spot at = on_screen(&w->s.camera, u, v, side);
            double up = (at.x * (double)w->s.camera.right[1] + at.y * (double)w->s.camera.up[1] +
                         at.z * (double)w->s.camera.forward[1]) /
                        sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
            frame_error e[WAYS];
            fprintf(file, "%.4f,%.4f", u, v);
            if (up < 0.03) { /* in the ground: no light */
                fprintf(file, ",NaN,NaN,NaN,NaN,NaN,0,NaN,NaN,NaN,NaN,NaN\n");
                continue;
            }
            shine(w, kind, at);
            measure(w, e);
            for (int i = 0; i < WAYS; i++) {
                fprintf(file, ",%.5f", e[i].l1);
                if (!(e[i].l1 <= most[i])) {
                    most[i] = e[i].l1;
                    worst[i] = at;
                }
            }
            fprintf(file, ",%.5g", e[0].level);
            for (int i = 0; i < WAYS; i++)
                fprintf(file, ",%d", e[i].worst);
            fprintf(file, "\n");
        }
        fflush(file);
    }
    fclose(file);
    printf("%-10s %-12s", place, what);
    for (int i = 0; i < WAYS; i++) {
        char name[128];
        shine(w, kind, worst[i]);
        snprintf(name, sizeof name, "worst-map-%s-%s-%s", place, what, ways[i].name);
        picture(w, i, name);
        printf(" %14.3f", most[i]);
    }
    printf("\n");
    fflush(stdout);
}

static void map(void)
{
    printf("\nthe light everywhere, 240x135, map 1024: the largest relative L1 in percent\n%-23s", "");
    for (int i = 0; i < WAYS; i++)
        printf(" %14s", ways[i].name);
    printf("\n");
    for (int n = 0; n < 2; n++) {
        show w;
        show_open(&w, scenes[n], 240, 135, 1024);
        for (tyn_light_kind kind = TYN_LIGHT_DIRECTIONAL; kind <= TYN_LIGHT_SPOT; kind++)
            for (int side = 1; side >= -1; side -= 2)
                map_of(&w, scenes[n], kind, side);
        show_close(&w);
    }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*run)(void);
    } parts[] = {{"camera", camera}, {"paths", paths}, {"map", map}};
    folder = argc > 1 ? argv[1] : ".";
    threads = pool_create(2);
    if (!threads)
        bench_die("no threads");
    for (int i = 0; i < (int)(sizeof parts / sizeof *parts); i++) {
        int wanted = argc <= 2;
        for (int k = 2; k < argc; k++)
            wanted |= strcmp(argv[k], parts[i].name) == 0;
        if (wanted)
            parts[i].run();
        fflush(stdout);
    }
    pool_free(threads);
    return 0;
}
