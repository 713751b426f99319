/* check.c - see check.h */
#include "check.h"

#include "base.h"

int tyni_check_finite(const float *v, int32_t n)
{
    for (int32_t i = 0; i < n; i++)
        if (!tyni_finite(v[i]))
            return 0;
    return 1;
}

int tyni_check_colour(const float v[3])
{
    return tyni_check_finite(v, 3) && v[0] >= 0.0f && v[1] >= 0.0f && v[2] >= 0.0f;
}

int tyni_check_within(const float *v, int32_t n, float most)
{
    for (int32_t i = 0; i < n; i++)
        if (!(tyni_absf(v[i]) <= most))
            return 0;
    return 1;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int unit(const float v[3])
{
    return tyni_check_finite(v, 3) && tyni_absf(dot(v, v) - 1.0f) < 2e-3f;
}

static int32_t component_bytes(tyn_format format)
{
    switch (format) {
    case TYN_RGB_F32:
    case TYN_DEPTH_F32:
    case TYN_DEPTH_U24:
        return 4;
    case TYN_RGB565_SRGB:
    case TYN_RGB16_LINEAR:
    case TYN_DEPTH_U16:
        return 2;
    default:
        return 1;
    }
}

ptrdiff_t tyni_image_stride(const tyn_image *image)
{
    return image->stride ? image->stride : (ptrdiff_t)image->width * tyn_format_bytes(image->format);
}

void *tyni_image_row(const tyn_image *image, int32_t y)
{
    return (uint8_t *)image->pixels + tyni_image_stride(image) * (ptrdiff_t)y;
}

/* Of the least stride that there is, too. */
static size_t apart_of(ptrdiff_t stride)
{
    return stride < 0 ? (size_t)0 - (size_t)stride : (size_t)stride;
}

tyn_status tyni_check_image(const tyn_image *image, uint32_t formats)
{
    ptrdiff_t stride;
    int32_t align;
    if (!image->pixels)
        return TYN_E_NULL;
    if ((uint32_t)image->format > 31u || !(formats & TYNI_FORMAT_BIT((uint32_t)image->format)))
        return TYN_E_IMAGE;
    if (image->width < 1 || image->height < 1 || image->width > TYN_MAX_SIZE || image->height > TYN_MAX_SIZE)
        return TYN_E_IMAGE;
    align = component_bytes(image->format);
    if ((uintptr_t)image->pixels % (uintptr_t)align)
        return TYN_E_ALIGN;
    stride = tyni_image_stride(image);
    if (stride % align)
        return TYN_E_ALIGN;
    if (apart_of(stride) < (size_t)image->width * (size_t)tyn_format_bytes(image->format) ||
        apart_of(stride) > (size_t)(PTRDIFF_MAX / image->height))
        return TYN_E_IMAGE;
    return TYN_OK;
}

tyn_status tyni_check_camera(const tyn_camera *c)
{
    if ((uint32_t)c->kind > (uint32_t)TYN_CAMERA_ORTHOGRAPHIC)
        return TYN_E_CAMERA;
    if (!tyni_check_finite(c->position, 3) || !unit(c->right) || !unit(c->up) || !unit(c->forward))
        return TYN_E_CAMERA;
    if (tyni_absf(dot(c->right, c->up)) > 2e-3f || tyni_absf(dot(c->up, c->forward)) > 2e-3f ||
        tyni_absf(dot(c->forward, c->right)) > 2e-3f)
        return TYN_E_CAMERA;
    if (!tyni_check_finite(&c->left_edge, 4) || !(c->left_edge < c->right_edge) || !(c->bottom_edge < c->top_edge))
        return TYN_E_CAMERA;
    if (!(c->far_depth <= TYN_MAX_LENGTH) || !(c->near_depth >= 1.0f / TYN_MAX_LENGTH) || !(c->near_depth < c->far_depth))
        return TYN_E_CAMERA;
    if (!tyni_check_within(c->position, 3, TYN_MAX_LENGTH) || !tyni_check_within(&c->left_edge, 4, TYN_MAX_LENGTH))
        return TYN_E_CAMERA;
    return TYN_OK;
}

int tyni_check_range(float at_near, float at_far, float ends[2])
{
    ends[0] = at_near;
    ends[1] = at_near == 0.0f && at_far == 0.0f ? 1.0f : at_far;
    return tyni_absf(at_near) <= 1e6f && tyni_absf(at_far) <= 1e6f && tyni_absf(ends[1] - ends[0]) >= 1e-6f;
}

static int coding_fits(const tyn_shadow *s)
{
    float ends[2];
    if ((uint32_t)s->coding > (uint32_t)TYN_MAP_LINEAR || !(s->bias >= 0.0f && s->bias <= 64.0f))
        return 0;
    if (!(s->scale >= 0.0f) || !tyni_finite(s->scale))
        return 0;
    if (s->coding == TYN_MAP_LINEAR && !tyni_shadow_parallel(s))
        return s->at_far >= 0.0f;
    return s->coding == TYN_MAP_REVERSED || tyni_check_range(s->at_near, s->at_far, ends);
}

int tyni_check_shadow_stride(const tyn_shadow *s)
{
    const size_t bytes = (size_t)tyni_shadow_bytes(s), apart = apart_of(s->stride);
    if (apart % bytes || (apart && apart < (size_t)s->size * bytes))
        return 0;
    return apart <= (size_t)(INT32_MAX / tyni_shadow_height(s)); /* offsets into a map are 32 bits */
}

static tyn_status check_shadow(const tyn_shadow *s, int32_t limit)
{
    int32_t height = tyni_shadow_height(s), bytes = tyni_shadow_bytes(s);
    if (!s->depth)
        return TYN_OK;
    if (s->size < 1 || s->size > TYN_MAX_SHADOW || height < 1 || height > TYN_MAX_SHADOW || !tyni_check_finite(s->matrix, 16))
        return TYN_E_LIGHT;
    if ((s->format != TYN_FORMAT_NONE && s->format != TYN_DEPTH_F32 && s->format != TYN_DEPTH_U16) || !coding_fits(s))
        return TYN_E_LIGHT;
    if ((uintptr_t)s->depth % (uintptr_t)bytes || !tyni_check_shadow_stride(s))
        return TYN_E_LIGHT;
    return s->size > limit || height > limit ? TYN_E_LIMIT : TYN_OK;
}

static tyn_status check_light(const tyn_light *l, int32_t shadow_limit, int32_t map_limit)
{
    tyn_status status;
    if ((uint32_t)l->kind > (uint32_t)(TYNI_HAS(TYN_PART_LAMPS) ? TYN_LIGHT_POINT : TYN_LIGHT_DIRECTIONAL) ||
        (uint32_t)l->outside > (uint32_t)TYN_OUTSIDE_DARK)
        return TYN_E_LIGHT;
    if (!tyni_check_colour(l->colour) || (l->kind != TYN_LIGHT_POINT && !unit(l->direction)))
        return TYN_E_LIGHT;
    if (l->kind != TYN_LIGHT_DIRECTIONAL && !tyni_check_within(l->position, 3, TYN_MAX_LENGTH))
        return TYN_E_LIGHT;
    if (!tyni_check_within(l->colour, 3, TYN_MAX_COLOUR))
        return TYN_E_LIGHT;
    if (!tyni_finite(l->scale) || !tyni_check_colour(l->tint))
        return TYN_E_LIGHT;
    if (l->kind == TYN_LIGHT_SPOT && (!(l->angle > 0.0f) || !(l->angle < 2.967060f)))
        return TYN_E_LIGHT;
    if (l->texture_count < 0 || l->texture_count > 6)
        return TYN_E_LIGHT;
    if (l->more_count < 0 || l->more_count >= map_limit)
        return TYN_E_LIMIT;
    if (l->more_count > 0 && !l->more)
        return TYN_E_NULL;
    status = check_shadow(&l->shadow, shadow_limit);
    for (int32_t i = 0; i < l->more_count && status == TYN_OK; i++)
        status = check_shadow(&l->more[i], shadow_limit);
    return status;
}

tyn_status tyni_check_lights(const tyn_light *lights, int32_t count, int32_t shadow_limit, int32_t map_limit)
{
    tyn_status status = TYN_OK;
    if (count < 0)
        return TYN_E_LIMIT;
    if (count > 0 && !lights)
        return TYN_E_NULL;
    for (int32_t i = 0; i < count && status == TYN_OK; i++)
        status = check_light(&lights[i], shadow_limit, map_limit);
    return status;
}

tyn_status tyni_check_media(const tyn_medium *media, int32_t count)
{
    if (count < 0 || count > TYN_MAX_MEDIA)
        return TYN_E_LIMIT;
    if (count > 0 && !media)
        return TYN_E_NULL;
    for (int32_t i = 0; i < count; i++) {
        const tyn_medium *m = &media[i];
        if (!tyni_check_within(m->scatter, 3, TYN_MAX_LENGTH) || !tyni_check_within(m->absorb, 3, TYN_MAX_LENGTH))
            return TYN_E_MEDIUM;
        if (!tyni_check_colour(m->scatter) || !tyni_check_colour(m->absorb) || (uint32_t)m->phase > (uint32_t)TYN_PHASE_HG)
            return TYN_E_MEDIUM;
        if (m->phase == TYN_PHASE_HG && !(m->g > -1.0f && m->g < 1.0f))
            return TYN_E_MEDIUM;
    }
    return TYN_OK;
}

tyn_status tyni_check_bounds(const float low[3], const float high[3])
{
    if (!low != !high)
        return TYN_E_NULL;
    if (!low)
        return TYN_OK;
    if (!tyni_check_finite(low, 3) || !tyni_check_finite(high, 3))
        return TYN_E_MESH;
    return low[0] > high[0] || low[1] > high[1] || low[2] > high[2] ? TYN_E_MESH : TYN_OK;
}

tyn_status tyni_check_display(const tyn_display *d)
{
    if (!tyni_finite(d->exposure) || d->exposure < 0.0f || (uint32_t)d->tone > (uint32_t)TYN_TONE_FILM)
        return TYN_E_DISPLAY;
    return TYN_OK;
}

int32_t tyn_format_bytes(tyn_format format)
{
    switch (format) {
    case TYN_RGB_F32:
        return 12;
    case TYN_RGBA8_SRGB:
    case TYN_BGRA8_SRGB:
    case TYN_DEPTH_F32:
    case TYN_DEPTH_U24:
        return 4;
    case TYN_RGB565_SRGB:
    case TYN_DEPTH_U16:
        return 2;
    case TYN_RGB8_LINEAR:
        return 3;
    case TYN_RGB16_LINEAR:
        return 6;
    case TYN_MASK8:
        return 1;
    default:
        return 0;
    }
}

const char *tyn_status_name(tyn_status status)
{
    switch (status) {
    case TYN_OK:
        return "TYN_OK";
    case TYN_E_NULL:
        return "TYN_E_NULL";
    case TYN_E_CONFIG:
        return "TYN_E_CONFIG";
    case TYN_E_MEMORY:
        return "TYN_E_MEMORY";
    case TYN_E_ALIGN:
        return "TYN_E_ALIGN";
    case TYN_E_IMAGE:
        return "TYN_E_IMAGE";
    case TYN_E_CAMERA:
        return "TYN_E_CAMERA";
    case TYN_E_LIGHT:
        return "TYN_E_LIGHT";
    case TYN_E_MEDIUM:
        return "TYN_E_MEDIUM";
    case TYN_E_MESH:
        return "TYN_E_MESH";
    case TYN_E_DISPLAY:
        return "TYN_E_DISPLAY";
    case TYN_E_LIMIT:
        return "TYN_E_LIMIT";
    case TYN_E_ISA:
        return "TYN_E_ISA";
    case TYN_E_EXECUTOR:
        return "TYN_E_EXECUTOR";
    }
    return "TYN_E_UNKNOWN";
}

const char *tyn_version(void)
{
    return TYN_VERSION;
}
