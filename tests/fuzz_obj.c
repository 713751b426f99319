/* fuzz_obj.c - OBJ files with what they name. */
#include "fuzz.h"

#include <float.h>

#include "files.h"
#include "obj.h"

void fuzz_obj(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"m.obj", "m.mtl", "t.ppm", "k.pgm"};
    static const obj_place place = {{{2, 0, 0}, {0, 1, 0}, {0, 0.5, 1}}, {1, 2, 3}, {0.5f, 0.5f, 0.5f}};
    texture_cache textures = {0};
    tool_error error;
    scene s;
    fuzz_files(data, size, names, 4);
    scene_init(&s);
    error.text[0] = '\0';
    if (obj_load(&s, files_path("m.obj"), &place, &textures, &error) != 0)
        FUZZ_CHECK(error.text[0]);
    for (int32_t i = 0; i < s.mesh_count; i++) {
        const tyn_mesh *m = &s.meshes[i];
        for (size_t k = 0; k < 3 * (size_t)m->triangles; k++)
            FUZZ_CHECK(m->indices[k] < m->vertices);
        for (size_t k = 0; k < 3 * (size_t)m->vertices; k++)
            FUZZ_CHECK(m->positions[k] >= -FLT_MAX && m->positions[k] <= FLT_MAX);
        for (int k = 0; k < 3; k++)
            FUZZ_CHECK(m->material.albedo[k] >= 0 && m->material.albedo[k] <= 1);
    }
    texture_cache_free(&textures);
    scene_free(&s);
}
