/* setup.c - stage 1: a triangle's corners on the grid, and the plane of its value. See raster.h. */
#include "raster/raster.h"

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

/* The corner nearest to the eye: the plane's distance suffers least from cancellation there. */
static const tyni_raster_vertex *nearest(const tyni_raster_vertex v[3])
{
    const tyni_raster_vertex *best = v;
    for (int32_t i = 1; i < 3; i++)
        if (largest(position(&v[i])) < largest(position(best)))
            best = &v[i];
    return best;
}

/* With r = (x / w, y / w, 1) at a pixel, w r lies on the plane where 1 / w = (normal . r) / distance. The value changes by
 * `g` along the plane, so value / w = g . (r - p / w') + p.value / w' with any corner p, and 1 / w' as above. Everything is
 * linear in r. The vertices are those before clipping and snapping: a piece of a triangle has the plane of the whole. */
void tyni_raster_set_plane(const tyni_raster_view *view, const tyni_raster_vertex v[3], tyni_raster_plane *plane)
{
    const tyni_raster_vertex *p = nearest(v);
    const tyni_vec3 at = position(p);
    const tyni_vec3 r = tyni_vec(view->middle[0] + ((float)plane->x0 + 0.5f - view->half[0]) * view->step[0],
                                 view->middle[1] + ((float)plane->y0 + 0.5f - view->half[1]) * view->step[1], 1.0f);
    const float da = v[1].value - v[0].value, db = v[2].value - v[0].value;
    tyni_vec3 g = tyni_vec(0.0f, 0.0f, 0.0f);
    float inverse, rest;
    tyni_raster_facet f;
    plane->value = p->value / p->w; /* seen edge on, or no area: any value of its own will do */
    plane->dx = plane->dy = 0.0f;
    if (!tyni_raster_make_facet(position(&v[0]), position(&v[1]), position(&v[2]), &f))
        return;
    inverse = 1.0f / tyni_vec_dot(f.normal, at);
    if (!tyni_finite(inverse))
        return;
    if (da != 0.0f || db != 0.0f)
        g = tyni_raster_gradient(&f, da, db);
    rest = (p->value - tyni_vec_dot(g, at)) * inverse;
    {
        const float w = tyni_vec_dot(f.normal, r) * inverse;
        const float value = tyni_vec_dot(g, tyni_vec_mad(r, -w, at)) + p->value * w;
        const float dx = view->step[0] * (g.x + rest * f.normal.x), dy = view->step[1] * (g.y + rest * f.normal.y);
        if (!tyni_finite(value) || !tyni_finite(dx) || !tyni_finite(dy))
            return;
        plane->value = value;
        plane->dx = dx;
        plane->dy = dy;
    }
}

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
    tyni_raster_vertex whole[3], cut[TYNI_RASTER_CORNERS];
    const tyni_raster_vertex *v = whole;
    int32_t any = 0, all = ~0, count = 3;
    piece->corners = 0;
    rows->first = UINT16_MAX;
    rows->last = 0;
    for (int32_t i = 0; i < 3; i++) {
        int32_t out;
        if (!tyni_raster_transform(view, mesh->positions + (size_t)index[i] * 3, &whole[i]))
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
    if (touched(view, piece, rows))
        tyni_raster_set_plane(view, whole, &piece->plane);
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
