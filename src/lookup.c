/* lookup.c - see lookup.h */
#include "lookup.h"

#include "base.h"
#include "lanes/lanes.h"
#include "num.h"

void tyni_lookup_sight(const tyni_fourier *f, const tyni_sight *v, float t1, tyni_lookup_ray *ray)
{
    const tyni_lamp *lamp = f->lamp;
    float along = tyni_vec_dot(v->d, lamp->to_light), across;
    across = tyni_vec_length(tyni_vec_mad(v->d, -along, lamp->to_light));
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
        float inverse = 1.0f / tyni_maxf(across, 1e-4f); /* nearer to the epipole rays are walked, or there is no map */
        ray->x = across * t1;
        for (int32_t c = 0; c < 3; c++)
            ray->lean[c] = f->medium->sigma[c] * inverse;
        return;
    }
    ray->x = tyni_num_atan2(across * t1, lamp->distance - along * t1);
    ray->lean[0] = ray->lean[1] = ray->lean[2] = tyni_num_atan2(across, along);
}

/* Texels that the ray crosses along a map's longer axis. */
static float texels_crossed(const tyni_map *map, tyni_vec3 a, tyni_vec3 b)
{
    float wa = tyni_maxf(tyni_form_at(&map->w, a), 1e-6f), wb = tyni_maxf(tyni_form_at(&map->w, b), 1e-6f);
    float du = tyni_form_at(&map->u, b) / wb - tyni_form_at(&map->u, a) / wa;
    float dv = tyni_form_at(&map->v, b) / wb - tyni_form_at(&map->v, a) / wa;
    return tyni_maxf(tyni_absf(du), tyni_absf(dv));
}

int tyni_lookup_coarse(const tyni_fourier *f, const tyni_sight *v, float t0, float t1)
{
    const tyni_lamp *lamp = f->lamp;
    float texels = 0.0f, depth = f->medium->sigma[f->medium->high] * (t1 - t0);
    if (!lamp->map_count || f->no_walks)
        return 0;
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
        for (int32_t i = 0; i < lamp->map_count; i++)
            texels = tyni_maxf(texels, texels_crossed(&lamp->maps[i], tyni_sight_at(v, t0), tyni_sight_at(v, t1)));
    } else { /* by the angle at the light: whichever faces the ray meets, their texels are of about one size */
        tyni_vec3 a = tyni_vec_sub(tyni_sight_at(v, t0), lamp->position);
        tyni_vec3 b = tyni_vec_sub(tyni_sight_at(v, t1), lamp->position);
        texels = tyni_num_atan2(tyni_vec_length(tyni_vec_cross(a, b)), tyni_vec_dot(a, b)) * f->map_scale;
    }
    /* as tyni_ray_coarse */
    return tyni_maxf(1.0f, depth) > 0.05f * texels;
}

void tyni_lookup_widen(tyni_fourier_range *r, const tyni_lookup_ray *ray)
{
    for (int32_t c = 0; c < 3; c++) {
        r->lean[0] = r->count + c ? tyni_minf(r->lean[0], ray->lean[c]) : ray->lean[c];
        r->lean[1] = r->count + c ? tyni_maxf(r->lean[1], ray->lean[c]) : ray->lean[c];
    }
    r->x = r->count ? tyni_maxf(r->x, ray->x) : ray->x;
    r->count++;
}

/* How far a ray is on the way from reference ray `slot` to the next. */
static inline float between(const tyni_shelf *s, int32_t references, float lean, int32_t *slot)
{
    int32_t i = 0;
    float step;
    while (i < references - 2 && lean >= s->lean[i + 1])
        i++;
    *slot = i;
    if (references == 1)
        return 0.0f;
    step = s->lean[i + 1] - s->lean[i];
    return step > 1e-4f * s->lean[i] ? tyni_clampf((lean - s->lean[i]) / step, 0.0f, 1.0f) : 0.0f;
}

/* The last column holds for a little more: lines next to each other see about the same. */
static int covers(const tyni_shelf *s, float x)
{
    return s->valid && x <= s->high + 0.05f * (s->high - s->low);
}

#define TYNI_KERNEL "lookup_kernel.h"
#include "lanes/each.h"

int tyni_lookup_value(const tyni_fourier *f, const tyni_shelf *s, float p, const tyni_lookup_ray *ray, float value[3])
{
    float y;
    if (!covers(s, ray->x))
        return 0;
    y = tyni_fourier_cells(s, tyni_clampf(ray->x, s->low, s->high) - s->low) * (float)f->columns;
    TYNI_LANES_CALL(f->isa, lookup_row, (f, s, y, p, ray->lean, value));
    return 1;
}

void tyni_lookup_pixels(const tyni_fourier *f, const tyni_lookup *l)
{
    TYNI_LANES_CALL(f->isa, lookup_pixels, (f, l));
}
