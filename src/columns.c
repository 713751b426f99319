/* columns.c - see columns.h */
#include "columns.h"

#include "base.h"
#include "num.h"

static float column_of(const tyni_columns *c, int32_t i, float step)
{
    float n = step * c->piece[i].wd - c->piece[i].rd, d = c->piece[i].rn - step * c->piece[i].wn;
    if (!c->local)
        return d != 0.0f ? n / d : 0.0f;
    /* of the two ways that n / d can mean, the one in front of the map: the sign of n tells nothing where it is about 0 */
    if (n * c->piece[i].wn + d * c->piece[i].wd < 0.0f) {
        n = -n;
        d = -d;
    }
    return tyni_num_atan2(tyni_maxf(n, 0.0f), d * c->distance);
}

void tyni_columns_begin(tyni_columns *c, const tyni_row *row, const tyni_slice *slice, const tyni_lamp *lamp, float end)
{
    memset(c, 0, sizeof *c);
    c->row = row;
    c->local = lamp->kind != TYN_LIGHT_DIRECTIONAL;
    c->distance = lamp->distance;
    c->outside = lamp->outside ? 65535 : 0;
    c->end = end;
    c->k = -1;
    for (int32_t i = 0; i < row->count; i++) {
        const tyni_piece *p = &row->pieces[i];
        int32_t n = i;
        c->piece[i].rn = tyni_vec_dot(p->r.v, slice->ex);
        c->piece[i].wn = tyni_vec_dot(p->w.v, slice->ex);
        c->piece[i].rd = tyni_form_at(&p->r, slice->origin);
        c->piece[i].wd = tyni_form_at(&p->w, slice->origin);
        c->piece[i].begin = column_of(c, i, p->from);
        c->piece[i].end = column_of(c, i, tyni_minf(p->to, (float)p->steps));
        for (; n > 0 && c->piece[c->order[n - 1]].begin > c->piece[i].begin; n--)
            c->order[n] = c->order[n - 1];
        c->order[n] = i;
    }
}

/* First and last column of a piece that its part from .. to touches. */
static void piece_begin(tyni_columns *c, const tyni_piece *p)
{
    int32_t a = tyni_clampi((int32_t)p->from, 0, p->steps - 1), b = tyni_clampi(tyni_ceili(p->to) - 1, a, p->steps - 1);
    c->k = 2 * a + (p->from >= tyni_row_edge(c->row, p, 2 * a + 1));
    c->last = 2 * b + (p->to > tyni_row_edge(c->row, p, 2 * b + 1));
}

int tyni_columns_next(tyni_columns *c, float *from, float *to, uint32_t *threshold)
{
    *from = c->x;
    while (c->x < c->end) {
        int32_t i = c->at < c->row->count ? c->order[c->at] : -1;
        const tyni_piece *p = &c->row->pieces[tyni_maxi(i, 0)];
        float x = c->end;
        if (i >= 0 && c->k >= 0 && c->k > c->last) {
            c->at++;
            c->k = -1;
            continue;
        }
        *threshold = c->outside;
        if (i >= 0 && c->k < 0) {
            piece_begin(c, p);
            x = c->piece[i].begin;
        } else if (i >= 0) {
            const uint16_t *column = c->row->threshold + p->first;
            *threshold = column[c->k];
            while (c->k < c->last && column[c->k + 1] == *threshold)
                c->k++;
            x = c->k < c->last ? column_of(c, i, tyni_row_edge(c->row, p, c->k + 1)) : c->piece[i].end;
            c->k++;
        }
        if (!(x > c->x)) /* no gap, or an empty half of a step */
            continue;
        c->x = *to = tyni_minf(x, c->end);
        return 1;
    }
    return 0;
}

/* Narrows x to where s sin x + c cos x >= least, for 0 <= x <= pi; the part must be less than half a circle. */
static void clip_wave(float x[2], float s, float c, float least)
{
    float r2 = s * s + c * c, half, middle, shift;
    if (least * least >= r2) {
        x[1] = least > 0.0f ? x[0] : x[1];
        return;
    }
    half = tyni_num_atan2(sqrtf(r2 - least * least), least);
    middle = tyni_num_atan2(s, c);
    shift = middle + half < x[0] ? 2.0f * TYNI_PI : 0.0f;
    x[0] = tyni_maxf(x[0], middle - half + shift);
    x[1] = tyni_minf(x[1], middle + half + shift);
}

/* Narrows x to where scale * a + b >= 0. A local light's forms vanish at the light, so that along a column they grow from
 * there. */
static void clip_form(const tyni_slice *slice, const tyni_lamp *lamp, const tyni_form *a, float scale, const tyni_form *b,
                      float x[2])
{
    float n = scale * tyni_vec_dot(a->v, slice->ex) + tyni_vec_dot(b->v, slice->ex), c;
    if (lamp->kind != TYN_LIGHT_DIRECTIONAL) {
        clip_wave(x, n, -(scale * tyni_vec_dot(a->v, slice->ey) + tyni_vec_dot(b->v, slice->ey)), 0.0f);
        return;
    }
    c = scale * tyni_form_at(a, slice->origin) + tyni_form_at(b, slice->origin);
    if (n > 0.0f)
        x[0] = tyni_maxf(x[0], -c / n);
    else if (n < 0.0f)
        x[1] = tyni_minf(x[1], -c / n);
    else if (c < 0.0f)
        x[1] = x[0];
}

void tyni_columns_volume(const tyni_slice *slice, const tyni_lamp *lamp, float x[2])
{
    if (lamp->slide_count && lamp->kind != TYN_LIGHT_POINT) {
        const tyni_slide *s = &lamp->slides[0];
        clip_form(slice, lamp, &s->w, 0.0f, &s->s, x);
        clip_form(slice, lamp, &s->w, 0.0f, &s->t, x);
        clip_form(slice, lamp, &s->s, -1.0f / (float)s->image->width, &s->w, x);
        clip_form(slice, lamp, &s->t, -1.0f / (float)s->image->height, &s->w, x);
    } else if (lamp->kind == TYN_LIGHT_SPOT) {
        clip_wave(x, tyni_vec_dot(slice->ex, lamp->axis), -tyni_vec_dot(slice->ey, lamp->axis), lamp->cos_half);
    }
}

tyni_vec3 tyni_columns_point(const tyni_slice *slice, const tyni_lamp *lamp, float x)
{
    float s, c;
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL)
        return tyni_vec_mad(slice->origin, x, slice->ex);
    tyni_num_sincos(x, &s, &c);
    return tyni_vec_mad(tyni_vec_mad(lamp->position, s * lamp->distance, slice->ex), -c * lamp->distance, slice->ey);
}
