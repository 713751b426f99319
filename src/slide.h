/* slide.h - light textures: slides in spots, gobos in front of the sun, cubes around point lights, and the tints of shadow
 * maps. */
#ifndef TYNI_SLIDE_H
#define TYNI_SLIDE_H

#include "vec.h"

#include "base.h"

#define TYNI_SLIDE_FORMATS (1u << TYN_RGB8_LINEAR | 1u << TYN_RGB16_LINEAR | 1u << TYN_RGB_F32)

/* A linear form of a point relative to the camera: v . p + c. */
typedef struct tyni_form {
    tyni_vec3 v;
    float c;
} tyni_form;

static inline float tyni_form_at(const tyni_form *f, tyni_vec3 p)
{
    return tyni_vec_dot(f->v, p) + f->c;
}

/* A texture and where it lies: texel (s / w, t / w), w > 0 where it can be. */
typedef struct tyni_slide {
    const tyn_image *image;
    tyni_form s, t, w;
} tyni_slide;

/* The slides of a light, at most 6; returns how many. origin: the camera's position. */
int32_t tyni_slide_set(tyni_slide slides[6], const tyn_light *light, const float origin[3]);

/* Colour of the first slide that the point lies in; 0: in none, dark. */
int tyni_slide_colour(const tyni_slide *slides, int32_t count, tyni_vec3 p, float rgb[3]);

/* Bilinear, texel i's centre at i + 0.5, the rim held. */
void tyni_slide_sample(const tyn_image *image, float s, float t, float rgb[3]);

/* Axes of a slide or face: right and down as seen along d. up not parallel to d. */
void tyni_slide_axes(tyni_vec3 d, tyni_vec3 up, tyni_vec3 *right, tyni_vec3 *down);
void tyni_slide_face(int32_t face, tyni_vec3 *d, tyni_vec3 *right, tyni_vec3 *down);

/* Light textures at the door: count, formats, up, extent. */
tyn_status tyni_slide_check(const tyn_light *light);
/* And with them the tints of all maps, of a frame's lights. TYN_E_LIMIT for any where there is no room (not `textured`). */
tyn_status tyni_slide_lights(const tyn_light *lights, int32_t count, int textured);

#endif
