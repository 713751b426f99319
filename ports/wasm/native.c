/* native.c - draws views and prints their hashes, for the tests to hold the page's against.
 *     native [-o FILE.ppm] NUMBER...       16 numbers a view, in the order of demo_view */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "demo.h"

enum { NUMBERS = 16, REALS = 6 };

static uint64_t now(void *context)
{
    (void)context;
    return (uint64_t)clock() * (1000000000u / CLOCKS_PER_SEC);
}

static void *block(size_t bytes)
{
    void *memory;
    if (posix_memalign(&memory, TYN_ALIGNMENT, bytes) != 0) {
        fprintf(stderr, "native: out of memory\n");
        exit(1);
    }
    return memory;
}

static void write_ppm(const char *path, const demo *d)
{
    FILE *file = fopen(path, "wb");
    if (!file || fprintf(file, "P6\n%d %d\n255\n", (int)d->view.width, (int)d->view.height) < 0) {
        perror(path);
        exit(1);
    }
    for (int32_t i = 0; i < d->view.width * d->view.height; i++)
        fwrite(d->target + 4 * i, 1, 3, file);
    if (fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

int main(int argc, char **argv)
{
    static demo d;
    const char *path = argc > 2 && strcmp(argv[1], "-o") == 0 ? argv[2] : NULL;
    int at = path ? 3 : 1;
    if (argc == at || (argc - at) % NUMBERS != 0) {
        fprintf(stderr, "usage: native [-o FILE.ppm] NUMBER... (16 a view, see demo.h)\n");
        return 2;
    }
    scene_build(&d.scene, block(scene_bytes()));
    d.clock = now;
    for (; at < argc; at += NUMBERS) {
        demo_view view;
        float reals[REALS];
        int32_t whole[NUMBERS - REALS];
        for (int i = 0; i < NUMBERS; i++)
            if (i < REALS)
                reals[i] = (float)strtod(argv[at + i], NULL);
            else
                whole[i - REALS] = (int32_t)strtol(argv[at + i], NULL, 10);
        memcpy(&view, reals, sizeof reals);
        memcpy((char *)&view + sizeof reals, whole, sizeof whole);
        size_t bytes = demo_bytes(&view);
        void *memory = block(bytes ? bytes : 1);
        tyn_status status = demo_draw(&d, &view, memory, bytes);
        if (status != TYN_OK) {
            fprintf(stderr, "native: %s\n", tyn_status_name(status));
            return 1;
        }
        uint64_t hash = demo_hash(&d);
        printf("%08lx%08lx\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
        if (path)
            write_ppm(path, &d);
        fprintf(stderr, "shadow %.1f surface %.1f shafts %.1f ms, %.1f MB; rays %.2f%% rejected %lld; triangles %u %u %u %u\n",
                (double)d.shadow_ns / 1e6, (double)d.surface_ns / 1e6, (double)d.stats.total_ns / 1e6, (double)bytes / 1e6,
                (double)d.stats.rays_percent, (long long)d.stats.rejected, d.scene.meshes[0].triangles,
                d.scene.meshes[1].triangles, d.scene.meshes[2].triangles, d.scene.meshes[3].triangles);
        free(memory);
    }
    return 0;
}
