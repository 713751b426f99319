/* fuzz_scene.c - garbage for the readers of scenes, OBJ, MTL, PPM, PGM and PFM. Built by hand, from the top folder:
 *
 *   clang -g -O1 -fsanitize=fuzzer,address,undefined -D_POSIX_C_SOURCE=200809L -Iinclude -Isrc -Iports/posix -o
 * build/fuzz_scene \ tests/fuzz_scene.c tests/files.c
 * ports/posix/{error,file,text,keys,directives,scene,pnm,mtl,obj,parse,pfm}.c src/[a-z]*.c -lm
 *
 * An input is the files one after the other, with a byte 1 between them. */
#include <stdlib.h>

#include "files.h"
#include "parse.h"
#include "pfm.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const scene *s)
{
    for (int32_t i = 0; i < s->mesh_count; i++) {
        const tyn_mesh *m = &s->meshes[i];
        for (size_t k = 0; k < 3 * (size_t)m->triangles; k++)
            if (m->indices[k] >= m->vertices)
                abort();
        for (size_t k = 0; k < 3 * (size_t)m->vertices; k++)
            if (!(m->positions[k] - m->positions[k] == 0.0f))
                abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"s.scene", "m.obj", "m.mtl", "t.ppm", "k.pgm", "x.pfm"};
    static int registered;
    tool_error error;
    scene s;
    pfm picture;
    if (!registered++)
        atexit(files_remove);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t length = 0;
        while (length < size && data[length] != 1)
            length++;
        files_write(names[i], data, length);
        data += length;
        size -= length;
        if (size) {
            data++;
            size--;
        }
    }
    if (scene_load(&s, files_path("s.scene"), &error) == 0)
        check(&s);
    else if (!error.text[0] || s.meshes || s.images)
        abort();
    scene_free(&s);
    if (pfm_load(&picture, files_path("x.pfm"), &error) == 0)
        free(picture.values);
    return 0;
}
