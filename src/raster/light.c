/* light.c - what a shadow map says about a point of a surface.
 *
 * A texel holds the exact z of what its centre sees. A point of a flat surface is compared with it where that surface's own
 * plane has the texel's centre, not where the point is: the surface then meets itself there at equal z, however steep, and
 * needs no bias that grows with the slope. What bias there is serves inner edges, where the centre already lies on the next
 * surface. */
#include "raster/raster.h"

#include "check.h"
#include "num.h"
#include "vec.h"

static tyni_vec3 row(const tyn_shadow *shadow, int32_t i)
{
    return tyni_vec_load(shadow->matrix + 4 * i);
}

static float form(const float row[4], tyni_vec3 point)
{
    return tyni_vec_dot(tyni_vec_load(row), point) + row[3];
}

/* Texels per length that the rows of u and v give, the fewer of both. */
static float texels_of(const tyni_texels *t, tyni_vec3 u, tyni_vec3 v)
{
    return tyni_minf(tyni_vec_length(u) * (float)t->width, tyni_vec_length(v) * (float)t->height);
}

/* Parallel: u, v, z are linear in the point. `across`, `down` and `along` are the columns of the inverse. */
static void set_parallel(tyni_raster_map *map, const tyn_shadow *shadow, float bias)
{
    const float w = 1.0f / shadow->matrix[15];
    const tyni_vec3 u = tyni_vec_scale(row(shadow, 0), w), v = tyni_vec_scale(row(shadow, 1), w),
                    z = tyni_vec_scale(tyni_vec_load(map->z), w);
    const float determinant = 1.0f / tyni_vec_dot(tyni_vec_cross(u, v), z);
    map->across = tyni_vec_scale(tyni_vec_cross(v, z), determinant);
    map->down = tyni_vec_scale(tyni_vec_cross(z, u), determinant);
    map->along = tyni_vec_scale(tyni_vec_cross(u, v), determinant);
    map->bias = bias / (texels_of(&map->texels, u, v) * tyni_vec_length(map->along));
}

/* Perspective: with the apex a, point = a + w (u across + v down + axis). w falls out of the bias: a texel's width grows with
 * the distance as a step of z shrinks. */
static void set_perspective(tyni_raster_map *map, const tyn_shadow *shadow, float bias)
{
    const float *m = shadow->matrix;
    const tyni_vec3 u = row(shadow, 0), v = row(shadow, 1), z = tyni_vec_load(map->z), w = row(shadow, 3);
    const float determinant = 1.0f / tyni_vec_dot(tyni_vec_cross(u, v), w), length = tyni_vec_length(w);
    const tyni_vec3 axis = tyni_vec_scale(w, 1.0f / length), third = tyni_vec_scale(tyni_vec_cross(u, v), determinant);
    const tyni_vec3 u_side = tyni_vec_mad(u, -tyni_vec_dot(u, axis), axis),
                    v_side = tyni_vec_mad(v, -tyni_vec_dot(v, axis), axis);
    const float texel = bias / texels_of(&map->texels, u_side, v_side);
    map->across = tyni_vec_scale(tyni_vec_cross(v, w), determinant);
    map->down = tyni_vec_scale(tyni_vec_cross(w, u), determinant);
    map->along = tyni_vec_mad(tyni_vec_mad(tyni_vec_scale(map->across, -m[3]), -m[7], map->down), -m[15], third);
    map->slope_u = tyni_vec_dot(z, map->across);
    map->slope_v = tyni_vec_dot(z, map->down);
    map->apex = form(map->z, map->along);
    map->bias = texel * tyni_vec_dot(z, axis);
    map->bias_z = texel * length;
}

static void set_map(tyni_raster_map *map, const tyn_shadow *shadow, float bias)
{
    memset(map, 0, sizeof *map);
    tyni_door_map(&map->texels, map->z, shadow, 0.0f);
    map->parallel = tyni_shadow_parallel(shadow);
    if (map->parallel)
        set_parallel(map, shadow, bias);
    else
        set_perspective(map, shadow, bias);
}

/* Floats that offsets of 32 bits reach. */
static int plain(const tyni_texels *t)
{
    const ptrdiff_t pitch = t->pitch < 0 ? -t->pitch : t->pitch;
    return t->bytes == 4 && !t->inverse && pitch <= INT32_MAX / t->height;
}

void tyni_raster_set_lamp(tyni_raster_lamp *lamp, tyni_raster_map *maps, tyni_slide *slides, const tyn_light *light,
                          const float origin[3], float bias, int32_t number)
{
    float sine;
    memset(lamp, 0, sizeof *lamp);
    lamp->light = light;
    lamp->maps = maps;
    lamp->slides = slides;
    (void)tyni_slide_set(slides, light, origin);
    lamp->cosine = -1.0f;
    lamp->plain = !light->texture_count;
    if (light->kind != TYN_LIGHT_POINT)
        lamp->towards = tyni_vec_scale(tyni_vec_normalise(tyni_vec_load(light->direction)), -1.0f);
    if (light->kind != TYN_LIGHT_DIRECTIONAL)
        lamp->position = tyni_vec_sub(tyni_vec_load(light->position), tyni_vec_load(origin));
    if (light->kind == TYN_LIGHT_SPOT)
        tyni_num_sincos(0.5f * light->angle, &sine, &lamp->cosine);
    for (int32_t i = 0; i <= light->more_count; i++)
        if (tyni_raster_shadow_of(light, i)->depth) {
            set_map(&maps[i], tyni_raster_shadow_of(light, i), bias);
            maps[i].number = number + i;
            lamp->mapped = 1;
            if (!plain(&maps[i].texels) || tyni_raster_shadow_of(light, i)->tint)
                lamp->plain = 0;
        }
    if (light->outside == TYN_OUTSIDE_LIT || (light->outside == TYN_OUTSIDE_DEFAULT && light->kind == TYN_LIGHT_DIRECTIONAL))
        lamp->outside = 1.0f;
}

void tyni_raster_set_slope(tyni_raster_slopes *slopes, int32_t i, const tyni_raster_map *map, tyni_vec3 point, tyni_vec3 normal)
{
    float du = tyni_vec_dot(normal, map->across), dv = tyni_vec_dot(normal, map->down);
    if (map->parallel) {
        const float dz = -1.0f / tyni_vec_dot(normal, map->along);
        du *= dz;
        dv *= dz;
    } else {
        const float dz = map->apex / tyni_vec_dot(normal, tyni_vec_sub(point, map->along));
        du = du * dz + map->slope_u;
        dv = dv * dz + map->slope_v;
    }
    /* A plane through the light has no slope; nothing of it is lit. */
    slopes->slope[i][0] = tyni_finite(du) ? du / (float)map->texels.width : 0.0f;
    slopes->slope[i][1] = tyni_finite(dv) ? dv / (float)map->texels.height : 0.0f;
    slopes->ready |= 1u << i;
}

/* The four texels around (u, v), in texels from the first one's centre; slopes per texel. */
static float compare(const tyni_texels *texels, float u, float v, float z, float slope_u, float slope_v)
{
    const int32_t left = tyni_floori(u), top = tyni_floori(v);
    const int32_t x[2] = {tyni_maxi(left, 0), tyni_mini(left + 1, texels->width - 1)};
    const int32_t y[2] = {tyni_maxi(top, 0), tyni_mini(top + 1, texels->height - 1)};
    const float s = u - (float)left, t = v - (float)top, share_x[2] = {1.0f - s, s}, share_y[2] = {1.0f - t, t};
    float sum = 0.0f;
    for (int32_t j = 0; j < 2; j++)
        for (int32_t i = 0; i < 2; i++) {
            const float blocker = tyni_texels_at(texels, x[i], y[j]);
            const float here = z + slope_u * ((float)x[i] - u) + slope_v * ((float)y[j] - v);
            if (!(blocker > 0.0f && blocker > here))
                sum += share_x[i] * share_y[j];
        }
    return tyni_clampf((sum - 0.5f) * TYNI_RASTER_SHARPNESS + 0.5f, 0.0f, 1.0f);
}

static void tint(const tyn_image *image, float u, float v, float rgb[3])
{
    float texel[3];
    tyni_slide_sample(image, u * (float)image->width, v * (float)image->height, texel);
    for (int32_t c = 0; c < 3; c++)
        rgb[c] *= texel[c];
}

float tyni_raster_visible(const tyni_raster_lamp *lamp, tyni_vec3 point, tyni_vec3 normal, tyni_raster_slopes *slopes,
                          float rgb[3])
{
    for (int32_t i = 0; i <= lamp->light->more_count; i++) {
        const tyn_shadow *shadow = tyni_raster_shadow_of(lamp->light, i);
        const tyni_raster_map *map = &lamp->maps[i];
        const float *m = shadow->matrix, w = form(m + 12, point);
        float inverse, u, v, z;
        if (!shadow->depth || !(w > 0.0f))
            continue;
        inverse = 1.0f / w;
        u = form(m, point) * inverse;
        v = form(m + 4, point) * inverse;
        z = form(map->z, point) * inverse;
        if (!(u >= 0.0f && u <= 1.0f && v >= 0.0f && v <= 1.0f))
            continue;
        if (shadow->tint)
            tint(shadow->tint, u, v, rgb);
        if (!(slopes->ready >> i & 1u))
            tyni_raster_set_slope(slopes, i, map, point, normal);
        z += tyni_absf(map->bias - map->bias_z * z);
        return compare(&map->texels, u * (float)map->texels.width - 0.5f, v * (float)map->texels.height - 0.5f, z,
                       slopes->slope[i][0], slopes->slope[i][1]);
    }
    return lamp->outside;
}
