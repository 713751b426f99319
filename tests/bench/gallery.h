/* gallery.h - scenes for benchmarks that look at pictures: drawn once, rendered by many configs, each held against the exact
 * march of the same shadow map. Whatever goes wrong ends the program. */
#ifndef TYN_BENCH_GALLERY_H
#define TYN_BENCH_GALLERY_H

#include "pool.h"
#include "render.h"
#include "tyndall.h"

typedef struct gallery {
    scene scene;
    render_result drawn; /* depth, shadow maps, camera */
    int32_t width, height, shadow_size;
    size_t pixels;
    tyn_light light;
    tyn_medium media[TYN_MAX_MEDIA];
    float *truth, *scatter, *picture;
    float exposure;
    pool *threads;
} gallery;

typedef struct gallery_shot {
    double gap; /* relative L1 of L_scat to the march */
    double ms, slice_us, pixel_ns;
    tyn_stats stats; /* of the fastest */
} gallery_shot;

/* A built-in scene, or one of ../shared/reference. Its first light alone. */
void gallery_open(gallery *g, const char *name, int32_t width, int32_t height, int32_t shadow_size);
void gallery_close(gallery *g);

/* Multiplies the medium; the march is made anew. */
void gallery_thicken(gallery *g, float factor);

/* 1 at first. */
void gallery_threads(gallery *g, int threads);

/* Quality, for this scene. */
tyn_config gallery_config(const gallery *g, tyn_method method);

/* The fastest of some renders. */
void gallery_shoot(gallery *g, const tyn_config *config, int repeats, gallery_shot *shot);

/* Makes the march the last rendered picture. */
void gallery_march(gallery *g);

/* The last rendered picture as FOLDER/NAME.png. */
void gallery_picture(const gallery *g, const char *folder, const char *name);

#endif
