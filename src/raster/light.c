/* light.c - what a shadow map says about a point of a surface.
 *
 * A texel holds the exact z of what its centre sees. A point of a flat surface is compared with it where that surface's own
 * plane has the texel's centre, not where the point is: the surface then meets itself there at equal z, however steep, and
 * needs no bias that grows with the slope. What bias there is serves inner edges, where the centre already lies on the next
 * surface. */
#include "raster/raster.h"

#include "num.h"
#include "vec.h"

/* Shadows here have hard edges. The four nearest comparisons, bilinearly weighted, put the edge where they cross 1/2: a
 * straighter line than the texels' outlines. A ramp of 1/4 texel about it measured best or equal on three scenes against exact
 * shadows: 25 % less error than plain bilinear weights, 0 .. 11 % less than the nearest texel alone. */
#define SHARPNESS 4.0f

static tyni_vec3 row(const tyni_raster_lamp *lamp, int32_t i)
{
    return tyni_vec_load(lamp->row[i]);
}

/* Parallel: u, v, z are linear in the point. `across`, `down` and `along` are the columns of the inverse. */
static void set_parallel(tyni_raster_lamp *lamp, float texels)
{
    const float w = 1.0f / lamp->shift[3];
    tyni_vec3 u, v, z;
    float determinant;
    for (int32_t i = 0; i < 3; i++) {
        for (int32_t c = 0; c < 3; c++)
            lamp->row[i][c] *= w;
        lamp->shift[i] *= w;
    }
    lamp->shift[3] = 1.0f;
    u = row(lamp, 0);
    v = row(lamp, 1);
    z = row(lamp, 2);
    determinant = 1.0f / tyni_vec_dot(tyni_vec_cross(u, v), z);
    lamp->across = tyni_vec_scale(tyni_vec_cross(v, z), determinant);
    lamp->down = tyni_vec_scale(tyni_vec_cross(z, u), determinant);
    lamp->along = tyni_vec_scale(tyni_vec_cross(u, v), determinant);
    lamp->bias = texels / (tyni_minf(tyni_vec_length(u), tyni_vec_length(v)) * tyni_vec_length(lamp->along));
    lamp->bias_z = 0.0f;
}

/* Perspective: with the apex a, point = a + w (u across + v down + axis). w falls out of the bias: a texel's width grows with
 * the distance as a step of z shrinks. */
static void set_perspective(tyni_raster_lamp *lamp, float texels)
{
    const tyni_vec3 u = row(lamp, 0), v = row(lamp, 1), z = row(lamp, 2), w = row(lamp, 3);
    const float determinant = 1.0f / tyni_vec_dot(tyni_vec_cross(u, v), w), length = tyni_vec_length(w);
    const tyni_vec3 axis = tyni_vec_scale(w, 1.0f / length), third = tyni_vec_scale(tyni_vec_cross(u, v), determinant);
    const tyni_vec3 u_side = tyni_vec_mad(u, -tyni_vec_dot(u, axis), axis),
                    v_side = tyni_vec_mad(v, -tyni_vec_dot(v, axis), axis);
    const float texel = texels / tyni_minf(tyni_vec_length(u_side), tyni_vec_length(v_side));
    lamp->across = tyni_vec_scale(tyni_vec_cross(v, w), determinant);
    lamp->down = tyni_vec_scale(tyni_vec_cross(w, u), determinant);
    lamp->along = tyni_vec_mad(tyni_vec_mad(tyni_vec_scale(lamp->across, -lamp->shift[0]), -lamp->shift[1], lamp->down),
                               -lamp->shift[3], third);
    lamp->slope_u = tyni_vec_dot(z, lamp->across);
    lamp->slope_v = tyni_vec_dot(z, lamp->down);
    lamp->apex = tyni_vec_dot(z, lamp->along) + lamp->shift[2];
    lamp->bias = texel * tyni_vec_dot(z, axis);
    lamp->bias_z = texel * length;
}

void tyni_raster_set_lamp(tyni_raster_lamp *lamp, const tyn_light *light, const float origin[3], float bias)
{
    const tyni_vec3 direction = tyni_vec_normalise(tyni_vec_load(light->direction));
    float sine;
    memset(lamp, 0, sizeof *lamp);
    lamp->light = light;
    lamp->towards = tyni_vec_scale(direction, -1.0f);
    if (light->kind == TYN_LIGHT_SPOT) {
        lamp->position = tyni_vec_sub(tyni_vec_load(light->position), tyni_vec_load(origin));
        tyni_num_sincos(0.5f * light->angle, &sine, &lamp->cosine);
    }
    if (!light->shadow.depth)
        return;
    for (int32_t i = 0; i < 4; i++) {
        memcpy(lamp->row[i], light->shadow.matrix + 4 * i, sizeof lamp->row[i]);
        lamp->shift[i] = tyni_vec_dot(row(lamp, i), tyni_vec_load(origin)) + light->shadow.matrix[4 * i + 3];
    }
    lamp->parallel = tyni_vec_dot(row(lamp, 3), row(lamp, 3)) == 0.0f;
    if (lamp->parallel)
        set_parallel(lamp, bias / (float)light->shadow.size);
    else
        set_perspective(lamp, bias / (float)light->shadow.size);
}

void tyni_raster_slope(const tyni_raster_lamp *lamp, tyni_vec3 point, tyni_vec3 normal, float slope[2])
{
    const float texel = 1.0f / (float)lamp->light->shadow.size;
    float du = tyni_vec_dot(normal, lamp->across), dv = tyni_vec_dot(normal, lamp->down);
    if (lamp->parallel) {
        const float dz = -1.0f / tyni_vec_dot(normal, lamp->along);
        du *= dz;
        dv *= dz;
    } else {
        const float dz = lamp->apex / tyni_vec_dot(normal, tyni_vec_sub(point, lamp->along));
        du = du * dz + lamp->slope_u;
        dv = dv * dz + lamp->slope_v;
    }
    /* A plane through the light has no slope; nothing of it is lit. */
    slope[0] = tyni_finite(du) ? du * texel : 0.0f;
    slope[1] = tyni_finite(dv) ? dv * texel : 0.0f;
}

float tyni_raster_visible(const tyni_raster_lamp *lamp, tyni_vec3 point, const float slope[2])
{
    const tyn_shadow *map = &lamp->light->shadow;
    const float outside = lamp->light->kind == TYN_LIGHT_SPOT ? 0.0f : 1.0f, size = (float)map->size;
    float u = tyni_vec_dot(row(lamp, 0), point) + lamp->shift[0], v = tyni_vec_dot(row(lamp, 1), point) + lamp->shift[1];
    float z = tyni_vec_dot(row(lamp, 2), point) + lamp->shift[2], share[4], sum = 0.0f, bias;
    int32_t x[2], y[2];
    if (!lamp->parallel) {
        const float w = tyni_vec_dot(row(lamp, 3), point) + lamp->shift[3], inverse = 1.0f / w;
        if (!(w > 0.0f))
            return outside;
        u *= inverse;
        v *= inverse;
        z *= inverse;
    }
    if (!(u >= 0.0f && u <= 1.0f && v >= 0.0f && v <= 1.0f))
        return outside;
    bias = tyni_absf(lamp->bias - lamp->bias_z * z);
    u = u * size - 0.5f;
    v = v * size - 0.5f;
    x[0] = tyni_floori(u);
    y[0] = tyni_floori(v);
    share[1] = u - (float)x[0];
    share[0] = 1.0f - share[1];
    share[3] = v - (float)y[0];
    share[2] = 1.0f - share[3];
    x[1] = tyni_mini(x[0] + 1, map->size - 1);
    y[1] = tyni_mini(y[0] + 1, map->size - 1);
    x[0] = tyni_maxi(x[0], 0);
    y[0] = tyni_maxi(y[0], 0);
    for (int32_t j = 0; j < 2; j++)
        for (int32_t i = 0; i < 2; i++) {
            const float blocker = tyni_minf(map->depth[(ptrdiff_t)y[j] * map->size + x[i]], 1.0f);
            const float here = z + slope[0] * ((float)x[i] - u) + slope[1] * ((float)y[j] - v) + bias;
            if (!(blocker > 0.0f && blocker > here))
                sum += share[i] * share[2 + j];
        }
    return tyni_clampf((sum - 0.5f) * SHARPNESS + 0.5f, 0.0f, 1.0f);
}
