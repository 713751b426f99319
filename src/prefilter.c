/* prefilter.c - see prefilter.h */
#include "prefilter.h"

#include "base.h"
#include "num.h"

int32_t tyni_prefilter_sets(const tyn_config *config)
{
    return (config->weights == TYN_WEIGHTS_AVERAGE ? 1 : config->references) * (config->textured ? 3 : 1);
}

size_t tyni_prefilter_bytes(const tyn_config *c)
{
    return (tyni_fourier_bytes(c->bases, c->columns, tyni_prefilter_sets(c)) + 7) / 8 * 8;
}

size_t tyni_prefilter_scratch(const tyn_config *c)
{
    return tyni_fourier_scratch(c->bases, tyni_prefilter_sets(c));
}

/* 32767 / (2 k - 1), or less with a window: Lanczos' factors pull the overshoot from 9 % to 1, and twice as wide a step. */
static void set_amplitudes(tyni_fourier *f, int windowed)
{
    for (int32_t k = 0; k < f->bases / 2; k++) {
        float order = (float)(2 * k + 1), at = TYNI_PI * order / (float)(f->bases + 1), sine, cosine, factor = 1.0f;
        if (windowed) {
            tyni_num_sincos(at, &sine, &cosine);
            factor = sine / at;
        }
        f->amplitude[k] = (int16_t)(32767.0f * factor / order);
    }
}

void tyni_prefilter_begin(tyni_fourier *f, const tyn_config *c, const tyni_lamp *lamp, const tyni_medium *medium,
                          const tyni_view *view)
{
    float apart = (medium->sigma[medium->high] - medium->sigma[medium->low]) * view->far_depth;
    memset(f, 0, sizeof *f);
    f->lamp = lamp;
    f->medium = medium;
    f->isa = c->isa;
    f->bases = c->bases;
    f->columns = c->columns;
    f->average = c->weights == TYN_WEIGHTS_AVERAGE;
    f->geometric = c->reference == TYN_REFERENCE_GEOMETRIC;
    f->references = f->average ? 1 : c->references;
    /* a directional light's reference rays span the channels' extinctions as well as the angles; a local one's only angles */
    f->channels = c->textured && (lamp->coloured || (lamp->kind != TYN_LIGHT_DIRECTIONAL && apart > 0.5f)) ? 3 : 1;
    f->sets = f->references * f->channels;
    f->remap = c->paper & TYN_PAPER_DEPTH ? 0.0f : 0.5f;
    f->margin = c->paper & TYN_PAPER_RANGE ? 0.0f : 0.01f;
    f->no_walks = (c->paper & TYN_PAPER_EPIPOLE) != 0;
    f->all = (c->paper & TYN_PAPER_COLUMNS) != 0;
    f->far_x = 2.0f * (lamp->distance + view->far_depth);
    if (lamp->kind != TYN_LIGHT_DIRECTIONAL && lamp->map_count) {
        const tyni_map *map = &lamp->maps[0];
        tyni_vec3 axis = tyni_vec_normalise(map->w.v), u = tyni_vec_mad(map->u.v, -tyni_vec_dot(map->u.v, axis), axis);
        f->map_scale = tyni_vec_length(u) / tyni_maxf(tyni_vec_length(map->w.v), 1e-20f);
    }
    set_amplitudes(f, c->window);
}

void tyni_prefilter_slice(const tyni_fourier *f, tyni_shelf *shelf, void *scratch, const tyni_row *row, const tyni_slice *slice,
                          const tyni_view *view, const float *depth)
{
    tyni_fourier_range range = {{0.0f, 0.0f}, 0.0f, 0};
    for (int32_t j = slice->first; j <= slice->last; j++) {
        tyni_lookup_ray ray;
        tyni_sight v;
        float t1 = depth[j] * tyni_slice_sight(slice, view, tyni_slice_p(slice, j), &v);
        if (!(t1 > 0.0f) || tyni_lookup_coarse(f, &v, 0.0f, t1))
            continue;
        tyni_lookup_sight(f, &v, t1, &ray);
        tyni_lookup_widen(&range, &ray);
    }
    tyni_fourier_build(f, shelf, scratch, row, slice, &range);
}

void tyni_prefilter_light(const tyni_fourier *f, const tyni_sight *v, float t0, float t1, float light[3])
{
    const tyni_lamp *lamp = f->lamp;
    float middle = 0.5f * (t0 + t1), nearest, second[3];
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
        tyni_integral_norm(f->medium, lamp, v, t0, t1, light);
        return;
    }
    /* two halves, parted where the ray is nearest to the light: ten times closer, at twice the cost; a table of the integral
     * costs ten times as much */
    nearest = tyni_vec_dot(v->d, tyni_vec_sub(lamp->position, v->o));
    if (nearest > t0 && nearest < t1)
        middle = nearest;
    tyni_integral_norm(f->medium, lamp, v, t0, middle, light);
    tyni_integral_norm(f->medium, lamp, v, middle, t1, second);
    for (int32_t c = 0; c < 3; c++)
        light[c] += second[c];
}

int tyni_prefilter_ray(const tyni_fourier *f, const tyni_shelf *shelf, float p, const tyni_sight *v, float t0, float t1,
                       float value[3])
{
    tyni_lookup_ray ray;
    if (tyni_lookup_coarse(f, v, t0, t1))
        return 0;
    tyni_lookup_sight(f, v, t1, &ray);
    return tyni_lookup_value(f, shelf, p, &ray, value);
}
