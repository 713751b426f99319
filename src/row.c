/* row.c - see row.h */
#include "row.h"

#include "base.h"

/* Columns of a slice as directions (n, d) in half a circle: n = x and d = 1 - y / distance, so that n / d is the tangent of the
 * column's angle seen from the light (or x itself for a directional light). Clipped to f . (n, d) >= 0. */
typedef struct fan {
    float n[2], d[2]; /* from, to */
    int empty;
} fan;

static void fan_clip(fan *f, float fn, float fd)
{
    float a = f->n[0] * fn + f->d[0] * fd, b = f->n[1] * fn + f->d[1] * fd;
    int32_t out;
    if (f->empty || (a >= 0.0f && b >= 0.0f))
        return;
    if (a < 0.0f && b < 0.0f) {
        f->empty = 1;
        return;
    }
    out = a < 0.0f ? 0 : 1;
    a = tyni_absf(a);
    b = tyni_absf(b);
    f->n[out] = (f->n[0] * b + f->n[1] * a) / (a + b);
    f->d[out] = (f->d[0] * b + f->d[1] * a) / (a + b);
}

/* All columns in front of the light: w = n * wn + d * wd > 0. A spot's columns span half a circle, whose ends are opposite: no
 * linear clip can cut that, so the edge is placed directly. */
static void fan_begin(fan *f, int spot, float wn, float wd)
{
    f->empty = 0;
    f->n[0] = 0.0f;
    f->d[0] = 1.0f;
    f->n[1] = spot ? 1e-3f : 1.0f;
    f->d[1] = spot ? -1.0f : 0.0f;
    if (!spot) {
        fan_clip(f, wn, wd);
    } else if (wd > 0.0f) {
        f->n[1] = wd;
        f->d[1] = 1e-5f * wd - wn;
    } else if (wd < 0.0f) {
        f->n[0] = -wd;
        f->d[0] = wn + 1e-5f * wd;
        f->n[1] = 0.0f;
    } else {
        f->n[0] = 1e-3f;
        f->empty = wn <= 0.0f;
    }
}

/* Where the fan's ends fall on the map, in texels; 0 if it misses the map. */
static int fan_ends(const tyni_lamp *lamp, const tyni_slice *slice, float reach, float u[2], float v[2])
{
    float un = tyni_vec_dot(lamp->u.v, slice->ex), vn = tyni_vec_dot(lamp->v.v, slice->ex);
    float wn = tyni_vec_dot(lamp->w.v, slice->ex), size = (float)lamp->size;
    int spot = lamp->kind == TYN_LIGHT_SPOT;
    fan f;
    fan_begin(&f, spot, wn, lamp->w.c);
    fan_clip(&f, un, lamp->u.c);
    fan_clip(&f, size * wn - un, size * lamp->w.c - lamp->u.c);
    fan_clip(&f, vn, lamp->v.c);
    fan_clip(&f, size * wn - vn, size * lamp->w.c - lamp->v.c);
    if (!spot)
        fan_clip(&f, -1.0f, reach);
    if (f.empty)
        return 0;
    for (int32_t i = 0; i < 2; i++) {
        float w = f.n[i] * wn + f.d[i] * lamp->w.c;
        if (!(w > 0.0f))
            return 0;
        u[i] = tyni_clampf((f.n[i] * un + f.d[i] * lamp->u.c) / w, 0.0f, size);
        v[i] = tyni_clampf((f.n[i] * vn + f.d[i] * lamp->v.c) / w, 0.0f, size);
    }
    return 1;
}

/* The threshold test of a surface at column coordinate g and map depth z as two numbers linear in (g, z, 1): their signs tell
 * whether it shadows the line's lit end and its dark end, their ratio where between the two the shadow begins. */
typedef struct ends {
    float g[2], z[2], c[2];
} ends;

static int ends_begin(ends *e, const tyni_row *row, const tyni_slice *slice, const tyni_lamp *lamp, const float p[2])
{
    /* (g w, z w, w) = M (x, y, 1) in the slice's plane */
    float m[3][3], x[3], y[3], det, sign;
    const tyni_form *form[3];
    form[0] = &row->r;
    form[1] = &lamp->z;
    form[2] = &lamp->w;
    for (int32_t i = 0; i < 3; i++) {
        m[i][0] = tyni_vec_dot(form[i]->v, slice->ex);
        m[i][1] = tyni_vec_dot(form[i]->v, slice->ey);
        m[i][2] = form[i]->c;
    }
    /* rows of the inverse, but for a positive factor */
    for (int32_t i = 0; i < 3; i++) {
        int32_t j = (i + 1) % 3, k = (i + 2) % 3;
        x[i] = m[j][1] * m[k][2] - m[k][1] * m[j][2];
        y[i] = m[k][0] * m[j][2] - m[j][0] * m[k][2];
    }
    det = m[0][0] * x[0] + m[1][0] * x[1] + m[2][0] * x[2];
    if (det == 0.0f || !tyni_finite(det))
        return 0;
    sign = det < 0.0f ? -1.0f : 1.0f;
    for (int32_t i = 0; i < 2; i++) {
        tyni_vec3 v = tyni_vec_mad(slice->a, p[i], slice->b);
        float vx = sign * tyni_vec_dot(v, slice->ex), vy = sign * tyni_vec_dot(v, slice->ey);
        e->g[i] = vy * x[0] - vx * y[0];
        e->z[i] = vy * x[1] - vx * y[1];
        e->c[i] = vy * x[2] - vx * y[2];
    }
    return 1;
}

static uint16_t threshold_of(float f0, float f1)
{
    if (!(f0 > 0.0f))
        return 0; /* dark even at the lit end */
    if (f1 > 0.0f)
        return 65535;
    return (uint16_t)(65534.0f * (f0 / (f0 - f1)) + 0.9999f);
}

/* The line on the map: starts at step coordinate 0, where it is at `minor`, and rises by `slope` a step. */
typedef struct course {
    int32_t across; /* the major axis is u */
    float sign;     /* way along the major axis */
    float base;     /* texel border that is step coordinate 0 */
    float minor, slope;
    int32_t steps;
} course;

static void course_begin(course *c, const float u[2], const float v[2], int32_t room)
{
    const float *major, *other;
    c->across = tyni_absf(u[1] - u[0]) >= tyni_absf(v[1] - v[0]);
    major = c->across ? u : v;
    other = c->across ? v : u;
    c->sign = major[1] >= major[0] ? 1.0f : -1.0f;
    c->base = c->sign > 0.0f ? (float)tyni_floori(major[0]) : (float)tyni_ceili(major[0]);
    c->slope = major[1] != major[0] ? (other[1] - other[0]) / (c->sign * (major[1] - major[0])) : 0.0f;
    c->minor = other[0] - c->slope * (c->sign * (major[0] - c->base));
    c->steps = tyni_clampi(tyni_ceili(c->sign * (major[1] - c->base)), 1, room);
}

static uint16_t column(const ends *e, float g, float z)
{
    if (!(z > 0.0f))
        return 65535; /* nothing there: lit */
    z = tyni_minf(z, 1.0f);
    return threshold_of(e->g[0] * g + e->z[0] * z + e->c[0], e->g[1] * g + e->z[1] * z + e->c[1]);
}

static void fill(tyni_row *row, uint16_t *threshold, float *split, const tyni_lamp *lamp, const course *c, const ends *e)
{
    int32_t size = lamp->size, first = tyni_clampi((int32_t)c->base - (c->sign < 0.0f), 0, size - 1);
    ptrdiff_t step = c->across ? 1 : size, pitch = c->across ? size : 1;
    const float *texel = lamp->depth + step * first;
    row->steps = tyni_mini(c->steps, c->sign > 0.0f ? size - first : first + 1);
    step = c->sign > 0.0f ? step : -step;
    for (int32_t k = 0; k < row->steps; k++, texel += step) {
        float from = c->minor + c->slope * (float)k, to = c->minor + c->slope * (float)(k + 1), cut = 1.0f;
        int32_t a = tyni_clampi(tyni_floori(from), 0, size - 1), b = tyni_clampi(tyni_floori(to), 0, size - 1);
        if (a != b) /* |slope| <= 1: they are neighbours */
            cut = tyni_clampf(((float)tyni_maxi(a, b) - from) / c->slope, 0.0f, 1.0f);
        split[k] = cut;
        threshold[2 * k] = column(e, (float)k + 0.5f * cut, texel[a * pitch]);
        threshold[2 * k + 1] = a != b ? column(e, (float)k + 0.5f + 0.5f * cut, texel[b * pitch]) : threshold[2 * k];
    }
}

void tyni_row_build(tyni_row *row, uint16_t *threshold, float *split, int32_t room, const tyni_slices *slices,
                    const tyni_slice *slice, const tyni_lamp *lamp, float reach)
{
    float u[2], v[2], pa, pb, p[2], length;
    const tyni_form *form;
    course c;
    ends e;
    row->threshold = threshold;
    row->split = split;
    row->steps = 0;
    if (!lamp->depth || !fan_ends(lamp, slice, reach, u, v))
        return;
    /* the line's lit end comes first: the one nearer to the light on the screen */
    pa = tyni_slice_p(slices, slice->first);
    pb = tyni_slice_p(slices, slice->last);
    p[0] = (pa < slice->epipole) != lamp->behind ? pb : pa;
    p[1] = (pa < slice->epipole) != lamp->behind ? pa : pb;
    length = p[1] - p[0];
    row->p_start = p[0];
    row->p_scale = length != 0.0f ? 65534.0f / length : 0.0f;
    course_begin(&c, u, v, room);
    form = c.across ? &lamp->u : &lamp->v;
    row->r.v = tyni_vec_scale(tyni_vec_mad(form->v, -c.base, lamp->w.v), c.sign);
    row->r.c = c.sign * (form->c - c.base * lamp->w.c);
    row->w = lamp->w;
    if (ends_begin(&e, row, slice, lamp, p))
        fill(row, threshold, split, lamp, &c, &e);
}
