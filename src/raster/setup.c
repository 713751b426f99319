/* setup.c - stage 1: a triangle's corners on the grid, and the plane of its value. See raster.h. */
#include "raster/raster.h"

#include "raster/pair.h"
#include "vec.h"

/* More than this counts as not finite: products of two such numbers and of the guard band must not overflow. */
#define LARGEST 1e15f

static float across(const float row[3], float shift, float x, float y, float z)
{
    return row[0] * x + row[1] * y + row[2] * z + shift;
}

/* 0 if the vertex is not finite. */
int tyni_raster_transform(const tyni_raster_view *view, const float point[3], tyni_raster_vertex *vertex)
{
    const float x = point[0] - view->origin[0], y = point[1] - view->origin[1], z = point[2] - view->origin[2];
    vertex->x = across(view->row[0], view->shift[0], x, y, z);
    vertex->y = across(view->row[1], view->shift[1], x, y, z);
    vertex->value = across(view->row[2], view->shift[2], x, y, z);
    vertex->w = across(view->row[3], view->shift[3], x, y, z);
    return tyni_absf(vertex->x) + tyni_absf(vertex->y) + tyni_absf(vertex->value) + tyni_absf(vertex->w) < LARGEST &&
           tyni_absf(x) + tyni_absf(y) + tyni_absf(z) < LARGEST;
}

static float largest(tyni_vec3 a)
{
    return tyni_maxf(tyni_absf(a.x), tyni_maxf(tyni_absf(a.y), tyni_absf(a.z)));
}

static tyni_vec3 position(const tyni_raster_vertex *v)
{
    return tyni_vec(v->x, v->y, v->w);
}

/* `a` and `b` are its edges in units of the longest component, so that nothing over- or underflows. */
int tyni_raster_make_facet(tyni_vec3 p0, tyni_vec3 p1, tyni_vec3 p2, tyni_raster_facet *f)
{
    const tyni_vec3 a = tyni_vec_sub(p1, p0), b = tyni_vec_sub(p2, p0);
    const float size = tyni_maxf(largest(a), largest(b));
    tyni_vec3 cross;
    float length;
    if (!(size > 1e-30f))
        return 0;
    f->unit = 1.0f / size;
    f->a = tyni_vec_scale(a, f->unit);
    f->b = tyni_vec_scale(b, f->unit);
    cross = tyni_vec_cross(f->a, f->b);
    length = largest(cross);
    if (!(length > 1e-30f))
        return 0;
    f->normal = tyni_vec_scale(cross, 1.0f / length);
    f->square = tyni_vec_dot(f->normal, cross);
    return 1;
}

tyni_vec3 tyni_raster_gradient(const tyni_raster_facet *f, float da, float db)
{
    const tyni_vec3 a = tyni_vec_cross(f->b, f->normal), b = tyni_vec_cross(f->normal, f->a);
    return tyni_vec_scale(tyni_vec_add(tyni_vec_scale(a, da), tyni_vec_scale(b, db)), f->unit / f->square);
}

/* The corner nearest to the eye, where the plane's distance suffers least from cancellation, and the farthest. */
static const tyni_raster_vertex *nearest(const tyni_raster_vertex v[3])
{
    const tyni_raster_vertex *best = v;
    for (int32_t i = 1; i < 3; i++)
        if (largest(position(&v[i])) < largest(position(best)))
            best = &v[i];
    return best;
}

static const tyni_raster_vertex *farthest(const tyni_raster_vertex v[3])
{
    const tyni_raster_vertex *best = v;
    for (int32_t i = 1; i < 3; i++)
        if (largest(position(&v[i])) > largest(position(best)))
            best = &v[i];
    return best;
}

/* Infinity and NaN stay out: what was in the plane before will do. */
static void set_values(tyni_raster_plane *plane, float value, float dx, float dy)
{
    if (!tyni_finite(value) || !tyni_finite(dx) || !tyni_finite(dy))
        return;
    plane->value = value;
    plane->dx = dx;
    plane->dy = dy;
}

/* x / w (y / w) at a pixel's centre. The offset from the middle is exact. */
static tyni_pair ray_through(const tyni_raster_view *view, int32_t axis, int32_t pixel)
{
    const tyni_pair offset = tyni_pair_of((float)pixel + 0.5f - view->half[axis]);
    const tyni_pair middle = {view->middle[axis], view->middle_low[axis]}, step = {view->step[axis], view->step_low[axis]};
    return tyni_pair_add(middle, tyni_pair_mul(offset, step));
}

/* With r = (x / w, y / w, 1) at a pixel, w r lies on the plane where 1 / w = (normal . r) / distance. The value changes by
 * `g` along the plane, so value / w = g . (r - p / w') + p.value / w' with any corner p, and 1 / w' as above. Everything is
 * linear in r. The vertices are those before clipping and snapping: a piece of a triangle has the plane of the whole.
 * Says whether cancellation costs much: the plane is so nearly seen edge on, somewhere, that 4 bits are lost, or its edges are
 * so nearly parallel that their product loses 6. */
int tyni_raster_set_plane(const tyni_raster_view *view, const tyni_raster_vertex v[3], tyni_raster_plane *plane)
{
    const tyni_raster_vertex *p = nearest(v);
    const tyni_vec3 at = position(p);
    const tyni_vec3 r = tyni_vec(view->middle[0] + ((float)plane->x0 + 0.5f - view->half[0]) * view->step[0],
                                 view->middle[1] + ((float)plane->y0 + 0.5f - view->half[1]) * view->step[1], 1.0f);
    const float da = v[1].value - v[0].value, db = v[2].value - v[0].value;
    tyni_vec3 g = tyni_vec(0.0f, 0.0f, 0.0f);
    float distance, inverse, rest, w;
    tyni_raster_facet f;
    plane->value = p->value / p->w; /* seen edge on, or no area: any value of its own will do */
    plane->dx = plane->dy = 0.0f;
    if (!tyni_raster_make_facet(position(&v[0]), position(&v[1]), position(&v[2]), &f))
        return 1;
    if (da != 0.0f || db != 0.0f)
        g = tyni_raster_gradient(&f, da, db);
    distance = tyni_vec_dot(f.normal, at);
    inverse = 1.0f / distance;
    rest = (p->value - tyni_vec_dot(g, at)) * inverse;
    w = tyni_vec_dot(f.normal, r) * inverse;
    set_values(plane, tyni_vec_dot(g, tyni_vec_mad(r, -w, at)) + p->value * w, view->step[0] * (g.x + rest * f.normal.x),
               view->step[1] * (g.y + rest * f.normal.y));
    return tyni_absf(distance) < 0.0625f * largest(position(farthest(v))) || f.square < 0.015625f * largest(f.a) * largest(f.b);
}

static tyni_pair3 difference(const float *a, const float *b, float unit)
{
    tyni_pair3 d;
    d.x = tyni_pair_sum(a[0] * unit, -b[0] * unit);
    d.y = tyni_pair_sum(a[1] * unit, -b[1] * unit);
    d.z = tyni_pair_sum(a[2] * unit, -b[2] * unit);
    return d;
}

static tyni_pair3 exactly(const float *a)
{
    tyni_pair3 p;
    p.x = tyni_pair_of(a[0]);
    p.y = tyni_pair_of(a[1]);
    p.z = tyni_pair_of(a[2]);
    return p;
}

/* clang 14 packs what follows into WebAssembly vectors and gets another plane; 16 does not. */
#if defined(__wasm_simd128__) && __clang_major__ < 16
#pragma clang optimize off
#endif
/* A camera's plane from world positions: 1 / w = normal . ray / distance. Rotated corners are off by their distance's last
 * place, which moves a floor of kilometres under an eye at 2 m by 1e-4 of its depth. Here nothing is rounded to single
 * precision before the end. */
static void set_exact_plane(const tyni_raster_view *view, const float *const p[3], tyni_raster_plane *plane)
{
    float size = 0.0f, unit, inverse;
    tyni_pair3 a, b, eye, normal, right, up, forward;
    tyni_pair x, y, z, distance, value;
    for (int32_t i = 0; i < 3; i++)
        for (int32_t c = 0; c < 3; c++)
            size = tyni_maxf(size, tyni_absf(p[i][c]) + tyni_absf(view->origin[c]));
    if (!(size > 1e-15f && size < LARGEST))
        return;
    /* The power of two above 1 / size: what is scaled by it keeps its bits. */
    unit = tyni_bits_float((254u << 23) - (tyni_float_bits(size) & 0x7f800000u));
    a = difference(p[1], p[0], unit);
    b = difference(p[2], p[0], unit);
    eye = difference(p[0], view->origin, unit);
    normal = tyni_pair_cross(&a, &b);
    distance = tyni_pair_dot(&normal, &eye);
    right = exactly(view->row[0]);
    up = exactly(view->row[1]);
    forward = exactly(view->row[3]);
    x = tyni_pair_dot(&normal, &right);
    y = tyni_pair_dot(&normal, &up);
    z = tyni_pair_dot(&normal, &forward);
    value = tyni_pair_add(z, tyni_pair_mul(x, ray_through(view, 0, plane->x0)));
    value = tyni_pair_add(value, tyni_pair_mul(y, ray_through(view, 1, plane->y0)));
    inverse = unit / distance.high;
    set_values(plane, value.high * inverse, view->step[0] * x.high * inverse, view->step[1] * y.high * inverse);
}

#if defined(__wasm_simd128__) && __clang_major__ < 16
#pragma clang optimize on
#endif

/* To the nearest point of the grid. Clipping leaves |offset| <= GUARD but for rounding, so the clamp only guards the cast. */
static int32_t snap(float offset, float half)
{
    const float x = tyni_clampf(offset + half, -1e5f, 1e5f) * (float)TYNI_RASTER_SUB;
    return tyni_floori(x + 0.5f);
}

/* First pixel whose centre is at or right of (below) a grid position: ceil((x - 128) / 256), with a positive number shifted. */
static int32_t first_pixel(int32_t x)
{
    return ((x + TYNI_RASTER_SUB / 2 - 1 + (1 << 26)) >> 8) - (1 << 18);
}

static void place(const tyni_raster_view *view, const tyni_raster_vertex *v, int32_t count, tyni_raster_piece *piece)
{
    int32_t far = 0;
    for (int32_t i = 0; i < count; i++) {
        const float inverse = 1.0f / v[i].w, value = v[i].value * inverse;
        piece->corner[i].x = snap(view->scale[0] * (v[i].x - view->middle[0] * v[i].w) * inverse, view->half[0]);
        piece->corner[i].y = snap(view->scale[1] * (v[i].y - view->middle[1] * v[i].w) * inverse, view->half[1]);
        piece->low = i && piece->low < value ? piece->low : value;
        piece->high = i && piece->high > value ? piece->high : value;
        if (v[i].w > v[far].w)
            far = i;
    }
    piece->corners = count;
    /* The plane is given from the far end, where values are small and a relative error counts most. */
    piece->plane.x0 = tyni_clampi(first_pixel(piece->corner[far].x), 0, view->width - 1);
    piece->plane.y0 = tyni_clampi(first_pixel(piece->corner[far].y), 0, view->height - 1);
}

/* The rows whose centres are inside; 0 where there is no row or no column. */
static int touched(const tyni_raster_view *view, const tyni_raster_piece *piece, tyni_raster_rows *rows)
{
    int32_t x0 = piece->corner[0].x, x1 = x0, y0 = piece->corner[0].y, y1 = y0;
    for (int32_t i = 1; i < piece->corners; i++) {
        x0 = tyni_mini(x0, piece->corner[i].x);
        x1 = tyni_maxi(x1, piece->corner[i].x);
        y0 = tyni_mini(y0, piece->corner[i].y);
        y1 = tyni_maxi(y1, piece->corner[i].y);
    }
    x0 = tyni_maxi(first_pixel(x0), 0);
    x1 = tyni_mini(first_pixel(x1), view->width);
    y0 = tyni_maxi(first_pixel(y0), 0);
    y1 = tyni_mini(first_pixel(y1), view->height);
    if (x0 >= x1 || y0 >= y1)
        return 0;
    rows->first = (uint16_t)y0;
    rows->last = (uint16_t)(y1 - 1);
    return 1;
}

/* 0 if a corner is not finite. */
static int make_piece(const tyni_raster_pass *pass, tyni_raster_piece *piece, tyni_raster_rows *rows)
{
    const tyni_raster_view *view = &pass->view;
    const tyn_mesh *mesh = &pass->meshes[piece->mesh];
    const uint32_t *index = mesh->indices + (size_t)piece->triangle * 3;
    const float *const point[3] = {mesh->positions + (size_t)index[0] * 3, mesh->positions + (size_t)index[1] * 3,
                                   mesh->positions + (size_t)index[2] * 3};
    tyni_raster_vertex whole[3], cut[TYNI_RASTER_CORNERS];
    const tyni_raster_vertex *v = whole;
    int32_t any = 0, all = ~0, count = 3;
    piece->corners = 0;
    rows->first = UINT16_MAX;
    rows->last = 0;
    for (int32_t i = 0; i < 3; i++) {
        int32_t out;
        if (!tyni_raster_transform(view, point[i], &whole[i]))
            return 0;
        out = tyni_raster_outside(view, &whole[i]);
        any |= out;
        all &= out;
    }
    if (all)
        return 1;
    if (any) {
        memcpy(cut, whole, sizeof whole);
        count = tyni_raster_clip(view, cut);
        v = cut;
        if (!count)
            return 1;
    }
    place(view, v, count, piece);
    if (touched(view, piece, rows) && tyni_raster_set_plane(view, whole, &piece->plane) && pass->kind != TYNI_RASTER_SHADOW)
        set_exact_plane(view, point, &piece->plane);
    return 1;
}

void tyni_raster_setup(void *argument, int32_t index, int32_t worker)
{
    const tyni_raster_pass *pass = argument;
    tyni_raster_chunk *chunk = &pass->raster->chunks[index];
    tyni_raster_piece *piece = &pass->raster->pieces[(size_t)index * TYNI_RASTER_CHUNK];
    tyni_raster_rows *rows = &pass->raster->rows[(size_t)index * TYNI_RASTER_CHUNK];
    uint32_t mesh = chunk->mesh, triangle = chunk->triangle;
    (void)worker;
    chunk->first = INT32_MAX;
    chunk->last = -1;
    chunk->bad = 0;
    for (int32_t i = 0; i < chunk->count; i++) {
        while (triangle >= pass->meshes[mesh].triangles) {
            mesh++;
            triangle = 0;
        }
        piece[i].mesh = mesh;
        piece[i].triangle = triangle++;
        chunk->bad += !make_piece(pass, &piece[i], &rows[i]);
        if (rows[i].first <= rows[i].last) {
            chunk->first = tyni_mini(chunk->first, rows[i].first);
            chunk->last = tyni_maxi(chunk->last, rows[i].last);
        }
    }
}
