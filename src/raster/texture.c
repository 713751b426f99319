/* texture.c - textures (bilinear) and masks (nearest texel). Both repeat; v runs up while rows run down. */
#include "raster/raster.h"

#include "check.h"
#include "vec.h"

/* The part behind the point, 0 <= x <= 1 (1 by rounding alone). Numbers too large to have one, and what is not finite, give 0.
 */
static float fraction(float x)
{
    return tyni_absf(x) < 8388608.0f ? x - (float)tyni_floori(x) : 0.0f;
}

/* Texel i of n is centred at (i + 0.5) / n. Gives the texel at or before the point, its successor, and the way between. */
static float neighbours(float at, int32_t n, int32_t *first, int32_t *second)
{
    const float x = fraction(at) * (float)n - 0.5f; /* -0.5 .. n - 0.5 */
    const int32_t i = tyni_clampi(tyni_floori(x), -1, n - 1);
    *first = i < 0 ? n - 1 : i;
    *second = i + 1 < n ? i + 1 : 0;
    return x - (float)i;
}

/* Two rows, two columns in each (counted in components), and the way between them. */
typedef struct patch {
    const void *upper, *lower;
    ptrdiff_t left, right;
    float s, t;
} patch;

static float blend(const patch *p, float a, float b, float c, float d)
{
    const float top = a + p->s * (b - a), bottom = c + p->s * (d - c);
    return top + p->t * (bottom - top);
}

static void blend_bytes(const patch *p, float rgb[3])
{
    const uint8_t *a = (const uint8_t *)p->upper + p->left, *b = (const uint8_t *)p->upper + p->right;
    const uint8_t *c = (const uint8_t *)p->lower + p->left, *d = (const uint8_t *)p->lower + p->right;
    for (int32_t i = 0; i < 3; i++)
        rgb[i] = blend(p, (float)a[i], (float)b[i], (float)c[i], (float)d[i]) * (1.0f / 255.0f);
}

static void blend_words(const patch *p, float rgb[3])
{
    const uint16_t *a = (const uint16_t *)p->upper + p->left, *b = (const uint16_t *)p->upper + p->right;
    const uint16_t *c = (const uint16_t *)p->lower + p->left, *d = (const uint16_t *)p->lower + p->right;
    for (int32_t i = 0; i < 3; i++)
        rgb[i] = blend(p, (float)a[i], (float)b[i], (float)c[i], (float)d[i]) * (1.0f / 65535.0f);
}

/* What a file brought along may be anything: negative, infinite, no number. */
static float tame(float x)
{
    return tyni_clampf(x, 0.0f, 1e30f);
}

static void blend_floats(const patch *p, float rgb[3])
{
    const float *a = (const float *)p->upper + p->left, *b = (const float *)p->upper + p->right;
    const float *c = (const float *)p->lower + p->left, *d = (const float *)p->lower + p->right;
    for (int32_t i = 0; i < 3; i++)
        rgb[i] = blend(p, tame(a[i]), tame(b[i]), tame(c[i]), tame(d[i]));
}

void tyni_raster_texel(const tyn_image *texture, float u, float v, float rgb[3])
{
    int32_t x0, x1, y0, y1;
    patch p;
    p.s = neighbours(u, texture->width, &x0, &x1);
    p.t = neighbours(1.0f - fraction(v), texture->height, &y0, &y1);
    p.upper = tyni_image_row(texture, y0);
    p.lower = tyni_image_row(texture, y1);
    p.left = 3 * (ptrdiff_t)x0;
    p.right = 3 * (ptrdiff_t)x1;
    if (texture->format == TYN_RGB8_LINEAR)
        blend_bytes(&p, rgb);
    else if (texture->format == TYN_RGB16_LINEAR)
        blend_words(&p, rgb);
    else
        blend_floats(&p, rgb);
}

void tyni_raster_set_cutout(const tyni_raster_pass *pass, const tyni_raster_piece *piece, tyni_raster_cutout *cutout)
{
    const tyn_mesh *mesh = &pass->meshes[piece->mesh];
    const uint32_t *index = mesh->indices + (size_t)piece->triangle * 3;
    tyni_raster_vertex v[3];
    cutout->mask = mesh->material.mask;
    cutout->u.x0 = cutout->v.x0 = cutout->w.x0 = piece->plane.x0;
    cutout->u.y0 = cutout->v.y0 = cutout->w.y0 = piece->plane.y0;
    for (int32_t i = 0; i < 3; i++) {
        (void)tyni_raster_transform(&pass->view, mesh->positions + (size_t)index[i] * 3, &v[i]);
        v[i].value = mesh->texcoords[(size_t)index[i] * 2];
    }
    (void)tyni_raster_set_plane(&pass->view, v, &cutout->u);
    for (int32_t i = 0; i < 3; i++)
        v[i].value = mesh->texcoords[(size_t)index[i] * 2 + 1];
    (void)tyni_raster_set_plane(&pass->view, v, &cutout->v);
    for (int32_t i = 0; i < 3; i++)
        v[i].value = 1.0f;
    (void)tyni_raster_set_plane(&pass->view, v, &cutout->w);
}

int tyni_raster_solid(const tyni_raster_cutout *cutout, int32_t x, int32_t y)
{
    const tyn_image *mask = cutout->mask;
    const float w = 1.0f / tyni_raster_at(&cutout->w, x, y);
    const float u = fraction(tyni_raster_at(&cutout->u, x, y) * w), v = fraction(tyni_raster_at(&cutout->v, x, y) * w);
    const int32_t i = tyni_mini((int32_t)(u * (float)mask->width), mask->width - 1);
    const int32_t j = tyni_mini((int32_t)(v * (float)mask->height), mask->height - 1);
    const uint8_t *row = tyni_image_row(mask, mask->height - 1 - j);
    return row[i] >= 128;
}
