/* fuzz_scene.c - scene files with all that they may name, and the picture of those that are small. */
#include "fuzz.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "parse.h"
#include "render.h"

enum { MOST_PIXELS = 40 * 30, MOST_TRIANGLES = 2000 };

static void check_meshes(const scene *s)
{
    for (int32_t i = 0; i < s->mesh_count; i++) {
        const tyn_mesh *m = &s->meshes[i];
        for (size_t k = 0; k < 3 * (size_t)m->triangles; k++)
            FUZZ_CHECK(m->indices[k] < m->vertices);
        for (size_t k = 0; k < 3 * (size_t)m->vertices; k++)
            FUZZ_CHECK(m->positions[k] >= -FLT_MAX && m->positions[k] <= FLT_MAX);
    }
}

static void draw(const scene *s)
{
    static pool *threads;
    render_settings settings;
    render_result result;
    tool_error error;
    uint64_t triangles = 0;
    for (int32_t i = 0; i < s->mesh_count; i++)
        triangles += s->meshes[i].triangles;
    if ((int64_t)s->width * s->height > MOST_PIXELS || triangles > MOST_TRIANGLES)
        return;
    if (!threads && (threads = pool_create(1)) == NULL)
        abort();
    memset(&settings, 0, sizeof settings);
    settings.shadow_size = 32;
    settings.slices = 16;
    settings.want_scatter = 1;
    error.text[0] = '\0';
    if (render_scene(s, "s.scene", &settings, threads, &result, &error) != 0) {
        FUZZ_CHECK(error.text[0]);
        return;
    }
    for (int32_t i = 0; i < 3 * s->width * s->height; i++) {
        FUZZ_CHECK(result.scatter[i] >= 0 && result.scatter[i] <= FLT_MAX);
        FUZZ_CHECK(result.radiance[i] >= 0 && result.radiance[i] <= FLT_MAX);
    }
    render_free(&result);
}

void fuzz_scene(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"s.scene", "m.obj", "m.mtl", "t.ppm", "k.pgm"};
    tool_error error;
    scene s;
    fuzz_files(data, size, names, 5);
    error.text[0] = '\0';
    if (scene_load(&s, files_path("s.scene"), &error) == 0) {
        check_meshes(&s);
        draw(&s);
    } else {
        FUZZ_CHECK(error.text[0] && !s.meshes && !s.images);
    }
    scene_free(&s);
}
