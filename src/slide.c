/* slide.c - see slide.h */
#include "slide.h"

#include "base.h"
#include "check.h"
#include "num.h"

void tyni_slide_axes(tyni_vec3 d, tyni_vec3 up, tyni_vec3 *right, tyni_vec3 *down)
{
    *right = tyni_vec_normalise(tyni_vec_cross(d, up));
    *down = tyni_vec_cross(d, *right);
}

void tyni_slide_face(int32_t face, tyni_vec3 *d, tyni_vec3 *right, tyni_vec3 *down)
{
    float axis[3][3] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (int32_t i = 0; i < 3; i++) /* the face's axis and the two after it */
        axis[i][(face / 2 + i) % 3] = i == 0 && face % 2 ? -1.0f : 1.0f;
    *d = tyni_vec_load(axis[0]);
    *right = tyni_vec_load(axis[1]);
    *down = tyni_vec_load(axis[2]);
}

/* v . (p - from), as a form of points relative to the camera. */
static tyni_form form(tyni_vec3 v, tyni_vec3 from)
{
    tyni_form f;
    f.v = v;
    f.c = -tyni_vec_dot(v, from);
    return f;
}

/* s = width (w / 2 + x / (2 half)) and t alike: tangents -half .. half over the image. */
static void frustum(tyni_slide *slide, tyni_vec3 from, tyni_vec3 d, tyni_vec3 right, tyni_vec3 down, float half)
{
    float width = (float)slide->image->width, height = (float)slide->image->height;
    slide->w = form(d, from);
    slide->s = form(tyni_vec_scale(tyni_vec_mad(d, 1.0f / half, right), 0.5f * width), from);
    slide->t = form(tyni_vec_scale(tyni_vec_mad(d, 1.0f / half, down), 0.5f * height), from);
}

static void gobo(tyni_slide *slide, const tyn_light *light, tyni_vec3 origin, tyni_vec3 right, tyni_vec3 down)
{
    float width = (float)slide->image->width, height = (float)slide->image->height;
    tyni_vec3 from = tyni_vec_scale(origin, -1.0f); /* the world's origin */
    slide->s = form(tyni_vec_scale(right, width / light->extent[0]), from);
    slide->t = form(tyni_vec_scale(down, height / light->extent[1]), from);
    slide->s.c += 0.5f * width;
    slide->t.c += 0.5f * height;
    slide->w.v = tyni_vec(0.0f, 0.0f, 0.0f);
    slide->w.c = 1.0f;
}

int32_t tyni_slide_set(tyni_slide slides[6], const tyn_light *light, const float origin[3])
{
    tyni_vec3 camera = tyni_vec_load(origin), from = tyni_vec_sub(tyni_vec_load(light->position), camera), d, right, down;
    float sine, cosine;
    for (int32_t i = 0; i < light->texture_count; i++) {
        slides[i].image = &light->textures[i];
        if (light->kind == TYN_LIGHT_POINT) {
            tyni_slide_face(i, &d, &right, &down);
            frustum(&slides[i], from, d, right, down, 1.0f);
            continue;
        }
        d = tyni_vec_normalise(tyni_vec_load(light->direction));
        tyni_slide_axes(d, tyni_vec_load(light->up), &right, &down);
        if (light->kind == TYN_LIGHT_SPOT) {
            tyni_num_sincos(0.5f * light->angle, &sine, &cosine);
            frustum(&slides[i], from, d, right, down, sine / cosine);
        } else {
            gobo(&slides[i], light, camera, right, down);
        }
    }
    return light->texture_count;
}

static void texel(const tyn_image *image, int32_t x, int32_t y, float rgb[3])
{
    const uint8_t *row = tyni_image_row(image, y);
    for (int32_t c = 0; c < 3; c++) {
        ptrdiff_t i = 3 * (ptrdiff_t)x + c;
        if (image->format == TYN_RGB8_LINEAR)
            rgb[c] = (float)row[i] * (1.0f / 255.0f);
        else if (image->format == TYN_RGB16_LINEAR)
            rgb[c] = (float)((const uint16_t *)(const void *)row)[i] * (1.0f / 65535.0f);
        else
            rgb[c] = tyni_clampf(((const float *)(const void *)row)[i], 0.0f, 1e6f);
    }
}

void tyni_slide_sample(const tyn_image *image, float s, float t, float rgb[3])
{
    float x = tyni_clampf(s - 0.5f, 0.0f, (float)(image->width - 1)),
          y = tyni_clampf(t - 0.5f, 0.0f, (float)(image->height - 1));
    int32_t i = (int32_t)x, j = (int32_t)y, i1 = tyni_mini(i + 1, image->width - 1), j1 = tyni_mini(j + 1, image->height - 1);
    float fx = x - (float)i, fy = y - (float)j, a[3], b[3];
    texel(image, i, j, a);
    texel(image, i1, j, b);
    for (int32_t k = 0; k < 3; k++)
        rgb[k] = a[k] + (b[k] - a[k]) * fx;
    texel(image, i, j1, a);
    texel(image, i1, j1, b);
    for (int32_t k = 0; k < 3; k++)
        rgb[k] += (a[k] + (b[k] - a[k]) * fx - rgb[k]) * fy;
}

int tyni_slide_colour(const tyni_slide *slides, int32_t count, tyni_vec3 p, float rgb[3])
{
    for (int32_t i = 0; i < count; i++) {
        float w = tyni_form_at(&slides[i].w, p), s, t;
        if (!(w > 0.0f))
            continue;
        s = tyni_form_at(&slides[i].s, p) / w;
        t = tyni_form_at(&slides[i].t, p) / w;
        if (s >= 0.0f && t >= 0.0f && s <= (float)slides[i].image->width && t <= (float)slides[i].image->height) {
            tyni_slide_sample(slides[i].image, s, t, rgb);
            return 1;
        }
    }
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    return 0;
}

tyn_status tyni_slide_check(const tyn_light *light)
{
    tyn_status status = TYN_OK;
    tyni_vec3 d = tyni_vec_load(light->direction), up = tyni_vec_load(light->up);
    if (!light->texture_count)
        return TYN_OK;
    if (light->texture_count != (light->kind == TYN_LIGHT_POINT ? 6 : 1))
        return TYN_E_LIGHT;
    if (!light->textures)
        return TYN_E_NULL;
    for (int32_t i = 0; i < light->texture_count && status == TYN_OK; i++)
        status = tyni_check_image(&light->textures[i], TYNI_SLIDE_FORMATS);
    if (status != TYN_OK || light->kind == TYN_LIGHT_POINT)
        return status;
    if (!tyni_vec_finite(up) || !(tyni_vec_length(tyni_vec_cross(d, tyni_vec_normalise(up))) > 1e-4f))
        return TYN_E_LIGHT;
    if (light->kind == TYN_LIGHT_DIRECTIONAL &&
        (!tyni_check_finite(light->extent, 2) || !(light->extent[0] > 0.0f) || !(light->extent[1] > 0.0f)))
        return TYN_E_LIGHT;
    return TYN_OK;
}

tyn_status tyni_slide_lights(const tyn_light *lights, int32_t count, int textured)
{
    tyn_status status = TYN_OK;
    for (int32_t i = 0; i < count && status == TYN_OK; i++) {
        const tyn_light *l = &lights[i];
        int coloured = l->texture_count || l->shadow.tint;
        status = TYNI_HAS(TYN_PART_SLIDES) ? tyni_slide_check(l) : TYN_OK;
        for (int32_t k = -1; k < l->more_count && status == TYN_OK; k++) {
            const tyn_shadow *s = k < 0 ? &l->shadow : &l->more[k];
            coloured |= s->tint != NULL;
            status = TYNI_HAS(TYN_PART_SLIDES) && s->tint ? tyni_check_image(s->tint, TYNI_SLIDE_FORMATS) : TYN_OK;
        }
        if (status == TYN_OK && coloured && !(TYNI_HAS(TYN_PART_SLIDES) && textured))
            status = TYN_E_LIMIT;
    }
    return status;
}
