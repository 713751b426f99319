/* showcase.c - `tyndall showcase`: the built-in scenes as pictures, and what they cost. */
#include "showcase.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "commands.h"
#include "output.h"
#include "progress.h"
#include "render.h"
#include "showcase_scenes.h"

/* The exposure is a choice, as a photographer's: the automatic one shows all, these show what the picture is about. */
struct picture {
    const char *name;
    int (*fill)(scene *s);
    float exposure;
    int32_t shadow_size;
};

static const struct picture pictures[] = {
    {"pillars", scene_pillars, 1.0f, 2048}, {"rose", scene_rose, 0.9f, 2048},        {"forest", scene_forest, 0.33f, 2048},
    {"spot", scene_spot, 4.0f, 2048},       {"terrain", scene_terrain, 0.27f, 4096},
};
#define PICTURES (sizeof pictures / sizeof pictures[0])

static const struct picture *find(const char *name)
{
    for (size_t i = 0; i < PICTURES; i++) {
        if (strcmp(name, pictures[i].name) == 0) {
            return &pictures[i];
        }
    }
    return NULL;
}

int showcase_scene(const char *name, scene *s)
{
    static const char *const bench[4] = {"simple-off", "simple-on", "leafy-off", "leafy-on"};
    const struct picture *picture = find(name);
    if (picture != NULL) {
        return picture->fill(s);
    }
    for (int i = 0; i < 4; i++) {
        if (strcmp(name, bench[i]) == 0) {
            return scene_bench(s, i >> 1, i & 1);
        }
    }
    return 1;
}

static int write_picture(const char *path, const render_result *result, tool_error *error)
{
    output_set set;
    memset(&set, 0, sizeof set);
    FILE *file = output_open(&set, path, error);
    void *pixels = file != NULL ? render_display(result, result->exposure, TYN_RGBA8_SRGB, error) : NULL;
    int status = -1;
    if (pixels != NULL) {
        progress_stage("writing");
        status = output_picture(file, OUTPUT_PNG, pixels, result->width, result->height);
        status = status != 0 ? output_failed(&set, file, error) : output_commit(&set, error);
        progress_end();
    }
    free(pixels);
    output_abort(&set);
    return status;
}

static double ms(uint64_t ns)
{
    return (double)ns / 1e6;
}

static double megabytes(size_t bytes)
{
    return (double)bytes / 1e6;
}

static void print_row(const char *name, const scene *s, const render_result *r)
{
    int64_t triangles = 0;
    for (int32_t i = 0; i < s->mesh_count; i++) {
        triangles += s->meshes[i].triangles;
    }
    uint64_t total = r->times.shadow_ns + r->times.surface_ns + r->times.shafts_ns;
    printf("%-8s %9lld %6d %7.1f %8.1f %7.1f %7.1f %7.1f %6.2f %8lld %8.1f %7.1f %6.1f\n", name, (long long)triangles,
           (int)s->light_count, ms(r->times.shadow_ns), ms(r->times.surface_ns), ms(r->stats.slice_ns), ms(r->stats.gather_ns),
           ms(total), (double)r->stats.rays_percent, (long long)r->stats.rejected, megabytes(r->stats.memory),
           megabytes(r->raster_bytes), megabytes(r->shadow_bytes));
    fflush(stdout);
}

static int run_picture(const struct picture *picture, const char *directory, pool *threads, tool_error *error)
{
    char path[4096];
    scene s;
    render_settings settings;
    render_result result;
    memset(&settings, 0, sizeof settings);
    settings.exposure = picture->exposure;
    settings.shadow_size = picture->shadow_size;
    if (snprintf(path, sizeof path, "%s/%s.png", directory, picture->name) >= (int)sizeof path) {
        return error_set(error, directory, 0, NULL, 0, "the name is too long");
    }
    scene_init(&s);
    progress_stage(picture->name);
    int status = picture->fill(&s) == 0 ? 0 : error_memory(error);
    progress_end();
    if (status == 0) {
        status = render_scene(&s, picture->name, &settings, threads, &result, error);
    }
    if (status == 0) {
        status = write_picture(path, &result, error);
        if (status == 0) {
            print_row(picture->name, &s, &result);
        }
        render_free(&result);
    }
    scene_free(&s);
    return status;
}

int command_showcase(int argc, char **argv)
{
    const char *directory = argc > 0 ? argv[0] : "build";
    int known = directory[0] != '-' && directory[0] != '\0';
    for (int i = 1; i < argc; i++) {
        known = known && find(argv[i]) != NULL;
    }
    if (!known) {
        error_say("usage: tyndall showcase [DIR [NAME...]]");
        return 2;
    }
    pool *threads = pool_create(pool_default_workers());
    if (threads == NULL) {
        error_say("out of memory");
        return 1;
    }
    mkdir(directory, 0777); /* if that fails, writing says why */
    printf("                           ms:                                      rays           MB:\n");
    printf("scene    triangles lights  shadow  surface  slices  gather   total      %% rejected  context  raster   maps\n");
    tool_error error;
    int status = 0, count = argc > 1 ? argc - 1 : (int)PICTURES;
    error.text[0] = '\0';
    for (int i = 0; i < count && status == 0; i++) {
        status = run_picture(argc > 1 ? find(argv[i + 1]) : &pictures[i], directory, threads, &error);
    }
    pool_free(threads);
    if (status != 0) {
        error_report(&error, directory);
        return 1;
    }
    printf("pictures: %s/*.png\n", directory);
    return 0;
}
