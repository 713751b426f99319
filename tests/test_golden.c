/* test_golden.c - hashes of small pictures in tests/golden.txt: a change of one bit anywhere shows. They are the same on every
 * machine, compiler and optimisation. `make golden` rewrites the file, for a change that is meant, and writes the pictures. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "test.h"

#define FILE_NAME "tests/golden.txt"
enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT };

static const struct {
    const char *name, *scene;
    tyn_method method;
    tyn_rays rays;
    tyn_preset preset;
    int dither, bytes; /* bytes: colours of 8 bits */
} pictures[] = {
    {"sun-ahead", "sun ahead", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 1, 0},
    {"sun-ahead-march", "sun ahead", TYN_METHOD_MARCH, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 1, 0},
    {"sun-left-handheld", "sun off the left", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_HANDHELD, 1, 0},
    {"sun-ahead-quads", "sun ahead", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_HANDHELD, 1, 1},
    {"sun-left-quads", "sun off the left", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_HANDHELD, 0, 1},
    {"sun-parallel-steps", "sun parallel to the picture", TYN_METHOD_EPIPOLAR, TYN_RAYS_STEPS, TYN_PRESET_BALANCED, 0, 0},
    {"lamp-in-view", "lamp in view", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 0, 0},
    {"lamp-left-subsample", "lamp off the left", TYN_METHOD_SUBSAMPLE, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 1, 0},
    {"bulb-in-view", "bulb in view", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 0, 0},
    {"sun-ahead-prefiltered", "sun ahead", TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 1, 0},
    {"lamp-view-prefiltered", "lamp in view", TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 0, 0},
    {"sun-left-hybrid", "sun off the left", TYN_METHOD_HYBRID, TYN_RAYS_WORDS, TYN_PRESET_BALANCED, 1, 0},
    {"lamp-above-reference", "lamp above", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_REFERENCE, 0, 0},
};
enum { PICTURES = (int)(sizeof pictures / sizeof *pictures) };

/* Hashes of the picture, of L_scat, and of what the rasterizer made (colour, depth and shadow map). */
typedef struct golden {
    uint64_t target, scatter, raster;
} golden;

static rig *render(int i, golden *out)
{
    rig *r = rig_stock(pictures[i].scene, WIDTH, HEIGHT, 256);
    tyn_config config;
    tyn_frame frame = rig_frame(r);
    float *scatter = calloc(PIXELS, 3 * sizeof *scatter);
    uint8_t *bytes = calloc(PIXELS, 4);
    CHECK(scatter && bytes && tyn_config_preset(&config, pictures[i].preset, WIDTH, HEIGHT) == TYN_OK);
    config.method = pictures[i].method;
    config.rays = pictures[i].rays;
    rig_fill(r, &config);
    frame.scatter.pixels = scatter;
    frame.display.dither = pictures[i].dither;
    if (pictures[i].bytes) {
        const tyn_image linear = frame.colour;
        frame.colour.pixels = bytes;
        frame.colour.format = TYN_RGBA8_SRGB;
        CHECK(tyn_encode(&linear, &frame.display, &frame.colour) == TYN_OK);
    }
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    out->target = rig_hash(r->target, 4 * PIXELS);
    out->scatter = rig_hash_floats(scatter, 3 * PIXELS);
    out->raster = rig_hash_floats(r->colour, 3 * PIXELS) ^ 3 * rig_hash_floats(r->depth, PIXELS) ^
                  5 * rig_hash_floats(r->map[0], 256 * 256);
    free(scatter);
    free(bytes);
    return r;
}

static void write_ppm(const char *folder, const char *name, const rig *r)
{
    char path[512];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s.ppm", folder, name);
    file = fopen(path, "wb");
    CHECK(file != NULL);
    if (!file)
        return;
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int i = 0; i < PIXELS; i++)
        fwrite(r->target + 4 * i, 1, 3, file);
    fclose(file);
    printf("  %s\n", path);
}

static void print_golden(char to[160], const char *name, const golden *g)
{
    snprintf(to, 160, "%-22s %08lx%08lx %08lx%08lx %08lx%08lx\n", name, (unsigned long)(g->target >> 32),
             (unsigned long)(g->target & 0xffffffffu), (unsigned long)(g->scatter >> 32),
             (unsigned long)(g->scatter & 0xffffffffu), (unsigned long)(g->raster >> 32),
             (unsigned long)(g->raster & 0xffffffffu));
}

static void rewrite(const char *folder)
{
    FILE *file = fopen(FILE_NAME, "w");
    TEST("golden: written anew");
    CHECK(file != NULL);
    if (!file)
        return;
    fprintf(file, "# name, FNV-1a of: the picture, L_scat, the rasterizer's colour, depth and shadow map. By `make golden`.\n");
    for (int i = 0; i < PICTURES; i++) {
        golden g;
        char line[160];
        rig *r = render(i, &g);
        print_golden(line, pictures[i].name, &g);
        fputs(line, file);
        write_ppm(folder, pictures[i].name, r);
        rig_free(r);
    }
    fclose(file);
}

/* The line of a picture in the file; 0: none. */
static int find(const char *name, char *line, int size)
{
    FILE *file = fopen(FILE_NAME, "r");
    size_t length = strlen(name);
    int found = 0;
    while (file && !found && fgets(line, size, file))
        found = strncmp(line, name, length) == 0 && line[length] == ' ';
    if (file)
        fclose(file);
    return found;
}

void test_golden(void)
{
    const char *folder = getenv("TYN_GOLDEN");
    if (folder) {
        rewrite(folder);
        return;
    }
    for (int i = 0; i < PICTURES; i++) {
        char line[160] = "", now[160];
        golden g;
        test_begin(pictures[i].name);
        rig_free(render(i, &g));
        CHECK(find(pictures[i].name, line, (int)sizeof line));
        print_golden(now, pictures[i].name, &g);
        if (strcmp(line, now) != 0)
            printf("  is  %s  was %s", now, line);
        CHECK(strcmp(line, now) == 0);
    }
}
