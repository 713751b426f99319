/* prefiltered.c - prefiltered rows measured: the tables and figures of Klehm et al. 2014 on our scenes, and what each departure
 * from the paper brings. `make bench-prefiltered` writes tables to stdout and pictures into a folder.
 *
 *     prefiltered FOLDER [PART ...]      parts: accuracy better regions size media rectify ringing epipole small; all without
 * (minutes)
 *
 * Errors are relative L1 of L_scat to the exact march of the same shadow map; times are minima over repeats, one thread. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gallery.h"
#include "showcase.h"

static const char *const places[] = {"simple-off", "leafy-off", "01_pillars", "08_terrain", "05_stained",
                                     "simple-on",  "leafy-on",  "02_grating", "07_cage",    NULL};
#define OFF 5 /* of these have the epipole off the screen */

static const char *folder = ".";

static tyn_config plain(const gallery *g, tyn_method method)
{
    return gallery_config(g, method);
}

/* ---- accuracy: the goal's table, and that the cost does not depend on the scene ---- */

static void accuracy(void)
{
    double sum[3][2] = {{0}}, low = 1e9, high = 0, low_e = 1e9, high_e = 0;
    printf("\naccuracy and cost, 480x270, 1024 slices at most, map 2048, M = 32, 4 references, 96 columns\n"
           "%-12s %9s %9s %9s | %9s %9s %9s | %8s %8s %9s\n",
           "", "prefilt.", "hybrid", "epipolar", "us/slice", "ns/pixel", "KB", "hybrid", "epipolar", "walked %");
    for (int i = 0; places[i]; i++) {
        static const tyn_method methods[3] = {TYN_METHOD_PREFILTERED, TYN_METHOD_HYBRID, TYN_METHOD_EPIPOLAR};
        gallery g;
        gallery_shot shot[3];
        gallery_open(&g, places[i], 480, 270, 2048);
        for (int m = 0; m < 3; m++) {
            tyn_config c = plain(&g, methods[m]);
            gallery_shoot(&g, &c, 3, &shot[m]);
            sum[m][i >= OFF] += shot[m].gap;
        }
        printf("%-12s %9.5f %9.5f %9.5f | %9.1f %9.1f %9.0f | %8.1f %8.1f %9.2f\n", places[i], shot[0].gap, shot[1].gap,
               shot[2].gap, shot[0].slice_us, shot[0].pixel_ns, (double)shot[0].stats.memory / 1024, shot[1].ms, shot[2].ms,
               100.0 * (double)shot[0].stats.rejected / (double)shot[0].stats.pixels);
        if (g.light.kind == TYN_LIGHT_DIRECTIONAL) {
            low = fmin(low, shot[0].pixel_ns);
            high = fmax(high, shot[0].pixel_ns);
            low_e = fmin(low_e, shot[2].ms);
            high_e = fmax(high_e, shot[2].ms);
        }
        gallery_close(&g);
    }
    printf("mean, epipole off the screen (goal 0.015): %.5f, on it (goal 0.04): %.5f; hybrid %.5f, %.5f; epipolar %.5f, %.5f\n",
           sum[0][0] / OFF, sum[0][1] / 4, sum[1][0] / OFF, sum[1][1] / 4, sum[2][0] / OFF, sum[2][1] / 4);
    printf("directional lights: ns per pixel differ by %.0f %%, epipolar frames by %.0f %%\n", 100 * (high / low - 1),
           100 * (high_e / low_e - 1));
}

/* ---- better than the paper: each with and without ---- */

static void better(void)
{
    static const struct {
        const char *name;
        int32_t bases, columns, references, paper, window;
        tyn_weights weights;
        tyn_reference reference;
    } rows[] = {{"as it is", 32, 96, 4, 0, 0, 0, 0},
                {"without remap of z", 32, 96, 4, TYN_PAPER_DEPTH, 0, 0, 0},
                {"without margin", 32, 96, 4, TYN_PAPER_RANGE, 0, 0, 0},
                {"lit, dark in the basis", 32, 96, 4, TYN_PAPER_COLUMNS, 0, 0, 0},
                {"same, without margin", 32, 96, 4, TYN_PAPER_COLUMNS | TYN_PAPER_RANGE, 0, 0, 0},
                {"without walks", 32, 96, 4, TYN_PAPER_EPIPOLE, 0, 0, 0},
                {"window", 32, 96, 4, 0, 1, 0, 0},
                {"1 reference, bisectrix", 32, 96, 1, 0, 0, 0, 0},
                {"1 reference, geometric", 32, 96, 1, 0, 0, 0, TYN_REFERENCE_GEOMETRIC},
                {"2 references", 32, 96, 2, 0, 0, 0, 0},
                {"3 references", 32, 96, 3, 0, 0, 0, 0},
                {"64 columns", 32, 64, 4, 0, 0, 0, 0},
                {"256 columns", 32, 256, 4, 0, 0, 0, 0},
                {"128 columns, 3 references", 32, 128, 3, 0, 0, 0, 0},
                {"1024 columns", 32, 1024, 4, 0, 0, 0, 0},
                {"16 bases", 16, 96, 4, 0, 0, 0, 0},
                {"64 bases", 64, 96, 4, 0, 0, 0, 0},
                {"the paper, bisectrix", 32, 1024, 1, 15, 0, 0, 0},
                {"the paper, geometric", 32, 1024, 1, 15, 0, 0, TYN_REFERENCE_GEOMETRIC},
                {"the paper, average", 32, 1024, 1, 15, 0, TYN_WEIGHTS_AVERAGE, 0}};
    enum { ROWS = (int)(sizeof rows / sizeof *rows), MOST = 16 };
    double gap[ROWS][MOST];
    int n = 0;
    for (; places[n]; n++) {
        gallery g;
        gallery_open(&g, places[n], 480, 270, 2048);
        for (int r = 0; r < ROWS; r++) {
            tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
            gallery_shot shot;
            c.bases = rows[r].bases;
            c.columns = rows[r].columns;
            c.references = rows[r].references;
            c.paper = rows[r].paper;
            c.window = rows[r].window;
            c.weights = rows[r].weights;
            c.reference = rows[r].reference;
            gallery_shoot(&g, &c, 1, &shot);
            gap[r][n] = shot.gap;
        }
        gallery_close(&g);
    }
    printf("\nbetter than the paper: relative L1, 480x270, prefiltered\n%-25s", "");
    for (int i = 0; i < n; i++)
        printf(" %10s", places[i]);
    for (int r = 0; r < ROWS; r++) {
        printf("\n%-25s", rows[r].name);
        for (int i = 0; i < n; i++)
            printf(" %10.5f", gap[r][i]);
    }
    printf("\n");
}

/* ---- table 2: resolution and bases ---- */

static void size(void)
{
    static const int32_t rows[][3] = {{1024, 64, 32},  {1024, 128, 32}, {1024, 256, 32}, {1024, 512, 32},
                                      {512, 128, 32},  {768, 128, 32},  {1536, 128, 32}, {1024, 128, 8},
                                      {1024, 128, 16}, {1024, 128, 64}, {1024, 128, 128}};
    gallery g;
    gallery_open(&g, "leafy-off", 960, 540, 2048);
    printf("\ntable 2: leafy-off, 960x540, map 2048, one thread\n%7s %8s %6s %10s %10s %9s %8s %8s\n", "slices", "columns",
           "bases", "prefix ms", "+ pixels", "= sum", "MB", "L1");
    for (int i = 0; i < (int)(sizeof rows / sizeof *rows); i++) {
        tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
        gallery_shot shot;
        c.slices = rows[i][0];
        c.columns = rows[i][1];
        c.bases = rows[i][2];
        gallery_shoot(&g, &c, 2, &shot);
        printf("%7d %8d %6d %10.1f %10.1f %9.1f %8.2f %8.5f\n", (int)rows[i][0], (int)rows[i][1], (int)rows[i][2],
               (double)shot.stats.slice_ns * 1e-6, (double)shot.stats.gather_ns * 1e-6, shot.ms,
               (double)shot.stats.memory / 1048576, shot.gap);
    }
    gallery_close(&g);
}

/* ---- figure 3: average and transmittance weights in thin and dense media ---- */

static void media(void)
{
    static const float scales[] = {0.1f, 0.3f, 1.0f, 3.0f, 10.0f};
    printf("\nfigure 3: 01_pillars, its medium times a factor\n%8s %12s %12s %12s\n", "factor", "average", "1 reference",
           "3 references");
    for (int i = 0; i < 5; i++) {
        gallery g;
        double gap[3];
        gallery_open(&g, "01_pillars", 480, 270, 2048);
        gallery_thicken(&g, scales[i]);
        for (int w = 0; w < 3; w++) {
            tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
            gallery_shot shot;
            char name[64];
            c.weights = w ? TYN_WEIGHTS_TRANSMITTANCE : TYN_WEIGHTS_AVERAGE;
            c.references = w == 1 ? 1 : 3;
            gallery_shoot(&g, &c, 1, &shot);
            gap[w] = shot.gap;
            snprintf(name, sizeof name, "fig3-%g-%s", (double)scales[i], w == 0 ? "average" : w == 1 ? "one" : "three");
            gallery_picture(&g, folder, name);
        }
        printf("%8g %12.5f %12.5f %12.5f\n", (double)scales[i], gap[0], gap[1], gap[2]);
        gallery_close(&g);
    }
}

/* ---- figure 7: ringing ---- */

static void ringing(void)
{
    static const char *const scenes[] = {"simple-off", "leafy-off", "01_pillars"};
    printf("\nfigure 7: bases; as it is, with the window, as the paper has it\n%-12s", "");
    for (int32_t m = 4; m <= 128; m *= 2)
        printf(" %25d", (int)m);
    printf("\n");
    for (int i = 0; i < 3; i++) {
        gallery g;
        gallery_open(&g, scenes[i], 480, 270, 2048);
        printf("%-12s", scenes[i]);
        for (int32_t m = 4; m <= 128; m *= 2)
            for (int way = 0; way < 3; way++) {
                tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
                gallery_shot shot;
                char name[64];
                c.bases = m;
                c.window = way == 1;
                c.paper = way == 2 ? TYN_PAPER_DEPTH | TYN_PAPER_RANGE | TYN_PAPER_COLUMNS : 0;
                gallery_shoot(&g, &c, 1, &shot);
                printf(" %8.5f", shot.gap);
                snprintf(name, sizeof name, "fig7-%s-%d-%s", scenes[i], (int)m,
                         way == 0   ? "ours"
                         : way == 1 ? "window"
                                    : "paper");
                gallery_picture(&g, folder, name);
            }
        printf("\n");
        gallery_march(&g);
        gallery_picture(&g, folder,
                        i == 0   ? "fig7-simple-off-march"
                        : i == 1 ? "fig7-leafy-off-march"
                                 : "fig7-01_pillars-march");
        gallery_close(&g);
    }
}

/* ---- figure 8: the epipole ---- */

static void epipole(void)
{
    static const char *const scenes[] = {"simple-on", "leafy-on", "02_grating"};
    printf("\nfigure 8: epipole on the screen; looked up everywhere, and walked where few texels are crossed\n");
    for (int i = 0; i < 3; i++) {
        gallery g;
        double gap[2];
        char name[64];
        gallery_open(&g, scenes[i], 480, 270, 2048);
        for (int way = 0; way < 2; way++) {
            tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
            gallery_shot shot;
            c.paper = way ? 0 : TYN_PAPER_EPIPOLE;
            gallery_shoot(&g, &c, 1, &shot);
            gap[way] = shot.gap;
            snprintf(name, sizeof name, "fig8-%s-%s", scenes[i], way ? "walked" : "looked-up");
            gallery_picture(&g, folder, name);
        }
        gallery_march(&g);
        snprintf(name, sizeof name, "fig8-%s-march", scenes[i]);
        gallery_picture(&g, folder, name);
        printf("%-12s %9.5f %9.5f\n", scenes[i], gap[0], gap[1]);
        gallery_close(&g);
    }
}

/* ---- table 1: tasks ---- */

static void regions(void)
{
    gallery g;
    gallery_open(&g, "leafy-off", 960, 540, 2048);
    printf("\ntable 1: a slice is one task; leafy-off, 960x540\n%8s %6s %10s %10s %10s\n", "threads", "tasks", "prefix ms",
           "+ pixels", "= sum");
    for (int t = 1; t <= 2; t++)
        for (int32_t slices = 256; slices <= 1024; slices *= 2) {
            tyn_config c = plain(&g, TYN_METHOD_PREFILTERED);
            gallery_shot shot;
            c.slices = slices;
            gallery_threads(&g, t);
            gallery_shoot(&g, &c, 3, &shot);
            printf("%8d %6d %10.1f %10.1f %10.1f\n", t, (int)slices, (double)shot.stats.slice_ns * 1e-6,
                   (double)shot.stats.gather_ns * 1e-6, shot.ms);
        }
    gallery_close(&g);
}

/* ---- projective rectification as the sun comes to the border of the screen ---- */

static void render_into(const scene *s, int rectify, int32_t splits, int32_t shadow, tyn_method method, pool *threads,
                        float *out)
{
    render_settings settings;
    render_result result;
    tool_error error;
    memset(&settings, 0, sizeof settings);
    memset(&error, 0, sizeof error);
    settings.width = 480;
    settings.height = 270;
    settings.method = (int32_t)method + 1;
    settings.want_scatter = 1;
    settings.shadow_size = shadow;
    settings.rectify = rectify;
    settings.splits = splits;
    if (render_scene(s, "scene", &settings, threads, &result, &error) != 0) {
        fprintf(stderr, "bench: a scene cannot be drawn\n");
        exit(1);
    }
    memcpy(out, result.scatter, 3 * 480 * 270 * sizeof *out);
    render_free(&result);
}

static double gap_between(const float *a, const float *b)
{
    double gap = 0, sum = 0;
    for (int i = 0; i < 3 * 480 * 270; i++) {
        gap += fabs((double)a[i] - (double)b[i]);
        sum += (double)b[i];
    }
    return sum > 0 ? gap / sum : gap;
}

static void rectify(void)
{
    static const float places_of_sun[] = {0.9f, 1.0f, 1.02f, 1.05f, 1.1f, 1.2f, 1.4f, 1.7f, 2.0f, 3.0f, 6.0f};
    static float truth[3 * 480 * 270], one[3 * 480 * 270], other[3 * 480 * 270];
    static const char *const scenes[] = {"simple-off", "leafy-off"};
    pool *threads = pool_create(2);
    for (int n = 0; n < 2; n++) {
        scene s;
        scene_init(&s);
        if (showcase_scene(scenes[n], &s) != 0 || !threads)
            exit(1);
        printf(
            "\nrectification: %s, the sun off the right border by a part of half the width; against the march of a 4096 map\n"
            "%8s %8s | %9s %9s | %9s %9s %9s %9s %9s\n",
            scenes[n], "place", "weight", "march1024", "epipolar", "split 1", "2", "4", "6", "4 to ep.");
        for (int k = 0; k < (int)(sizeof places_of_sun / sizeof *places_of_sun); k++) {
            /* the camera looks along -z, 60 degrees high at 16 : 9 */
            float d[3] = {-places_of_sun[k] * 1.0264f, -0.35f, 1.0f}, length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            tyn_camera camera;
            double opening;
            for (int i = 0; i < 3; i++)
                s.lights[0].light.direction[i] = d[i] / length;
            if (scene_camera_make(&s, 480, 270, &camera) != TYN_OK)
                exit(1);
            opening = (double)tyn_shadow_rectifiable(&s.lights[0].light, &camera);
            render_into(&s, 0, 0, 4096, TYN_METHOD_MARCH, threads, truth);
            render_into(&s, 0, 0, 1024, TYN_METHOD_MARCH, threads, one);
            printf("%8.2f %8.3f | %9.5f", (double)places_of_sun[k], opening, gap_between(one, truth));
            render_into(&s, 0, 0, 1024, TYN_METHOD_PREFILTERED, threads, one);
            printf(" %9.5f |", gap_between(one, truth));
            for (int32_t splits = 1; splits <= 6 && opening > 0; splits += splits > 1 ? 2 : 1) {
                render_into(&s, RENDER_FORCED, splits, 1024, TYN_METHOD_PREFILTERED, threads, splits == 4 ? other : one);
                printf(" %9.5f", gap_between(splits == 4 ? other : one, truth));
            }
            render_into(&s, 0, 0, 1024, TYN_METHOD_PREFILTERED, threads, one);
            if (opening > 0)
                printf(" %9.5f", gap_between(other, one));
            printf("\n");
        }
        scene_free(&s);
    }
    pool_free(threads);
}

/* ---- the smallest useful profile ---- */

/* The most slices that fit; 0: not even 8 do. */
static int32_t fit(tyn_config c, size_t bytes)
{
    int32_t best = 0;
    for (c.slices = 8; c.slices <= 512; c.slices += 4) {
        size_t need = 0;
        if (tyn_measure(&c, &need) == TYN_OK && need <= bytes)
            best = c.slices;
    }
    return best;
}

static void small(void)
{
    static const int32_t sizes[2][2] = {{160, 120}, {320, 240}},
                         shapes[][3] = {{4, 8, 1},   {4, 16, 1}, {8, 8, 1},   {8, 16, 1},  {8, 32, 1},  {16, 16, 1},
                                        {16, 32, 1}, {8, 16, 2}, {16, 16, 2}, {16, 32, 2}, {32, 32, 1}, {32, 16, 1}};
    static const char *const scenes[3] = {"simple-off", "leafy-off", "02_grating"};
    for (int m = 0; m < 2; m++)
        for (int z = 0; z < 2; z++) {
            size_t bytes = m ? 65536 : 32768;
            gallery g[3];
            int best = -1;
            double least = 1e9;
            printf("\nsmallest profile: %dx%d in %d KB, map 256\n%7s %8s %6s %7s", (int)sizes[z][0], (int)sizes[z][1],
                   (int)(bytes / 1024), "bases", "columns", "refs", "slices");
            for (int i = 0; i < 3; i++) {
                gallery_open(&g[i], scenes[i], sizes[z][0], sizes[z][1], 256);
                printf(" %11s", scenes[i]);
            }
            printf("\n");
            for (int k = 0; k < (int)(sizeof shapes / sizeof *shapes); k++) {
                double sum = 0, gap[3];
                tyn_config c = plain(&g[0], TYN_METHOD_PREFILTERED);
                c.bases = shapes[k][0];
                c.columns = shapes[k][1];
                c.references = shapes[k][2];
                c.samples = sizes[z][0] / 2;
                c.slices = fit(c, bytes);
                if (!c.slices)
                    continue;
                for (int i = 0; i < 3; i++) {
                    gallery_shot shot;
                    gallery_shoot(&g[i], &c, 1, &shot);
                    gap[i] = shot.gap;
                    sum += shot.gap;
                }
                if (sum < least) {
                    least = sum;
                    best = k;
                }
                printf("%7d %8d %6d %7d %11.4f %11.4f %11.4f\n", (int)c.bases, (int)c.columns, (int)c.references, (int)c.slices,
                       gap[0], gap[1], gap[2]);
            }
            for (int i = 0; i < 3; i++) {
                char name[64];
                if (best >= 0) {
                    tyn_config c = plain(&g[i], TYN_METHOD_PREFILTERED);
                    gallery_shot shot;
                    c.bases = shapes[best][0];
                    c.columns = shapes[best][1];
                    c.references = shapes[best][2];
                    c.samples = sizes[z][0] / 2;
                    c.slices = fit(c, bytes);
                    gallery_shoot(&g[i], &c, 1, &shot);
                    snprintf(name, sizeof name, "small-%d-%d-%s", (int)sizes[z][0], (int)(bytes / 1024), scenes[i]);
                    gallery_picture(&g[i], folder, name);
                }
                gallery_close(&g[i]);
            }
        }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*run)(void);
    } parts[] = {{"accuracy", accuracy}, {"better", better},   {"regions", regions}, {"size", size},  {"media", media},
                 {"rectify", rectify},   {"ringing", ringing}, {"epipole", epipole}, {"small", small}};
    folder = argc > 1 ? argv[1] : ".";
    for (int i = 0; i < (int)(sizeof parts / sizeof *parts); i++) {
        int wanted = argc <= 2;
        for (int k = 2; k < argc; k++)
            wanted |= strcmp(argv[k], parts[i].name) == 0;
        if (wanted)
            parts[i].run();
        fflush(stdout);
    }
    return 0;
}
