/* slice.c - see slice.h */
#include "slice.h"

#include "base.h"

int32_t tyni_slice_points(int32_t pixels, int32_t step)
{
    return (pixels - 1 + step - 1) / step + 1;
}

int32_t tyni_slice_stride(int32_t width, int32_t height, int32_t samples)
{
    int32_t stride = 1;
    while (tyni_slice_points(tyni_maxi(width, height), stride) > samples)
        stride *= 2;
    return stride;
}

/* Keeps the part of a convex polygon where a * x + b * y + c >= 0. Room for one more corner than n. */
static int32_t clip(float (*corner)[2], int32_t n, float a, float b, float c)
{
    float in[8][2];
    int32_t m = 0;
    memcpy(in, corner, sizeof in[0] * (size_t)n);
    for (int32_t i = 0; i < n; i++) {
        const float *p = in[i], *q = in[i + 1 < n ? i + 1 : 0];
        float fp = a * p[0] + b * p[1] + c, fq = a * q[0] + b * q[1] + c;
        if (fp >= 0.0f) {
            corner[m][0] = p[0];
            corner[m++][1] = p[1];
        }
        if ((fp >= 0.0f) != (fq >= 0.0f)) {
            float f = fp / (fp - fq);
            corner[m][0] = p[0] + f * (q[0] - p[0]);
            corner[m++][1] = p[1] + f * (q[1] - p[1]);
        }
    }
    return m;
}

/* The range of border points that lines through the sector's part of the screen reach; its length, 0 for an empty sector. */
static float border_range(tyni_sector *s, const tyni_slices *g, float sign)
{
    float width = (float)g->width, height = (float)g->height, low = 1e30f, high = -1e30f;
    float corner[8][2] = {{0.0f, 0.0f}, {width, 0.0f}, {width, height}, {0.0f, height}};
    float along = s->along_y ? g->ey : g->ex, across = s->along_y ? g->ex : g->ey;
    int32_t n = 4, p = s->along_y, m = !s->along_y;
    /* sign * dp >= |dm| with dp = p * ew - along, dm = m * ew - across */
    for (int32_t side = -1; side <= 1 && n; side += 2) {
        float fp = sign * g->ew, fm = (float)side * g->ew, c = -sign * along - (float)side * across;
        n = clip(corner, n, p ? fm : fp, p ? fp : fm, c);
    }
    for (int32_t i = 0; i < n; i++) {
        float dp = corner[i][p] * g->ew - along, dm = corner[i][m] * g->ew - across, at;
        if (sign * dp < 1e-3f)
            continue; /* the epipole itself */
        at = corner[i][m] + dm / dp * (s->border - corner[i][p]);
        low = tyni_minf(low, at);
        high = tyni_maxf(high, at);
    }
    s->first = low;
    return high - low > 0.01f ? high - low : 0.0f;
}

void tyni_slice_epipole(tyni_slices *g, const tyni_lamp *lamp, int32_t width, int32_t height)
{
    float size = tyni_maxf(lamp->ew, tyni_maxf(tyni_absf(lamp->ex), tyni_absf(lamp->ey)) / (float)(width + height));
    size = size > 0.0f ? 1.0f / size : 0.0f;
    g->width = width;
    g->height = height;
    g->ex = lamp->ex * size;
    g->ey = lamp->ey * size;
    g->ew = lamp->ew * size;
}

void tyni_slice_layout(tyni_slices *g, const tyni_lamp *lamp, int32_t width, int32_t height, int32_t limit, int32_t stride)
{
    float length[4], sum = 0.0f;
    int32_t used = 0, spare;
    g->layout = TYNI_LAYOUT_SHEAR;
    g->stride = stride;
    g->samples = tyni_slice_points(tyni_maxi(width, height), stride);
    tyni_slice_epipole(g, lamp, width, height);
    for (int32_t i = 0; i < 4; i++) {
        tyni_sector *s = &g->sectors[i];
        s->along_y = i >> 1;
        s->border = i & 1 ? 0.0f : (float)(s->along_y ? height : width);
        length[i] = border_range(s, g, i & 1 ? -1.0f : 1.0f);
        sum += length[i];
        used += length[i] > 0.0f;
    }
    spare = limit - 2 * used;
    g->count = 0;
    for (int32_t i = 0; i < 4; i++) {
        tyni_sector *s = &g->sectors[i];
        s->start = g->count;
        s->count = 0;
        if (length[i] <= 0.0f)
            continue;
        /* in proportion to the border, but never denser than one per pixel there */
        s->count = 2 + (int32_t)((float)spare * 0.9999f * length[i] / sum);
        s->count = tyni_mini(s->count, tyni_ceili(length[i]) + 1);
        s->spacing = length[i] / (float)(s->count - 1);
        g->count += s->count;
    }
}

/* Narrows first .. last to the samples with |m(p) - middle| <= half. */
static void trim(tyni_slice *s, const tyni_slices *g, float low, float high)
{
    float stride = (float)g->stride, a, b, swap;
    if (tyni_absf(s->slope) < 1e-6f) {
        if (s->m0 < low || s->m0 > high)
            s->last = s->first - 1;
        return;
    }
    a = ((low - s->m0) / s->slope - 0.5f) / stride;
    b = ((high - s->m0) / s->slope - 0.5f) / stride;
    if (a > b) {
        swap = a;
        a = b;
        b = swap;
    }
    s->first = tyni_maxi(s->first, tyni_ceili(tyni_clampf(a, -1.0f, 65536.0f)));
    s->last = tyni_mini(s->last, tyni_floori(tyni_clampf(b, -1.0f, 65536.0f)));
}

void tyni_slice_plane(tyni_slice *s, float border, const tyni_lamp *lamp, const tyni_view *view)
{
    tyni_vec3 side;
    s->a = tyni_vec_mad(view->origin, s->m0, s->along_y ? view->dx : view->dy);
    s->b = s->along_y ? tyni_vec_mad(view->dy, s->slope, view->dx) : tyni_vec_mad(view->dx, s->slope, view->dy);
    side = tyni_vec_mad(s->a, border, s->b);
    s->origin = tyni_vec(0.0f, 0.0f, 0.0f);
    s->ey = lamp->to_light;
    if (view->orthographic && tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        side = view->forward;
    } else if (view->orthographic) {
        /* columns are angles about the light, from the way back to the camera to the way it looks */
        s->ey = view->forward;
        s->origin = tyni_vec_mad(lamp->position, -lamp->distance, view->forward);
        side = tyni_vec_sub(side, s->origin);
    }
    s->ex = tyni_vec_normalise(tyni_vec_mad(side, -tyni_vec_dot(side, s->ey), s->ey));
    /* rays start at different columns: the least is 0 */
    if (view->orthographic && tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        float at = tyni_vec_dot(s->b, s->ex) >= 0.0f ? 0.0f : (float)(view->width + view->height);
        s->origin = tyni_vec_mad(s->a, at, s->b);
    }
}

float tyni_slice_sight(const tyni_slice *s, const tyni_view *view, float p, tyni_sight *v)
{
    tyni_vec3 d = tyni_vec_mad(s->a, p, s->b);
    float length;
    v->o = d;
    v->d = view->forward;
    if (view->orthographic)
        return 1.0f;
    length = tyni_vec_length(d);
    v->o = tyni_vec(0.0f, 0.0f, 0.0f);
    v->d = tyni_vec_scale(d, 1.0f / length);
    return length;
}

void tyni_slice_line(tyni_slice *s, const tyni_slices *g, const tyni_lamp *lamp, const tyni_view *view, int32_t index)
{
    const tyni_sector *sector = g->sectors;
    float along, across, mb, margin, at;
    int32_t size;
    while (index >= sector->start + sector->count)
        sector++;
    s->along_y = sector->along_y;
    along = s->along_y ? g->ey : g->ex;
    across = s->along_y ? g->ex : g->ey;
    mb = sector->first + (float)(index - sector->start) * sector->spacing;
    s->slope = tyni_clampf((across - g->ew * mb) / (along - g->ew * sector->border), -1.001f, 1.001f);
    s->m0 = mb - s->slope * sector->border;
    s->p0 = 0.5f;
    s->dp = (float)g->stride;
    tyni_slice_plane(s, sector->border, lamp, view);
    /* the samples: on the screen, on this side of the epipole */
    size = s->along_y ? g->height : g->width;
    s->first = 0;
    s->last = (size - 1 + g->stride - 1) / g->stride;
    margin = sector->spacing + 0.5f;
    trim(s, g, -margin, (float)(s->along_y ? g->width : g->height) + margin);
    at = g->ew > 0.0f ? tyni_clampf(along / g->ew, -1e9f, 1e9f) : sector->border > 0.0f ? -1e9f : 1e9f;
    s->epipole = at;
    at = (tyni_clampf(at, -1e6f, 1e6f) - 0.5f) / (float)g->stride;
    if (sector->border > 0.0f)
        s->first = tyni_maxi(s->first, tyni_floori(at) + 1);
    else
        s->last = tyni_mini(s->last, tyni_ceili(at) - 1);
}

const tyni_sector *tyni_slice_find(const tyni_slices *g, float x, float y, float *coordinate)
{
    float dx = x * g->ew - g->ex, dy = y * g->ew - g->ey, k;
    int32_t along_y = tyni_absf(dy) > tyni_absf(dx);
    const tyni_sector *s = &g->sectors[2 * along_y + ((along_y ? dy : dx) < 0.0f)];
    if (!s->count) /* the epipole's own pixel, or a corner lost to rounding: any sector will do, its samples are weighed */
        for (s = g->sectors; !s->count && s < g->sectors + 3; s++)
            ;
    k = s->along_y ? x + dx / dy * (s->border - y) : y + dy / dx * (s->border - x);
    *coordinate = tyni_clampf((k - s->first) / s->spacing, 0.0f, (float)(s->count - 1));
    return s;
}

/* Square n: 0 left of the lines along y, 1 on them, 2 right of them. Rises along the row. */
static int side_of(const tyni_slices *g, int32_t n, float size, float dy)
{
    float dx = ((float)n + 0.5f) * size * g->ew - g->ex;
    return tyni_absf(dy) > tyni_absf(dx) ? 1 : dx < 0.0f ? 0 : 2;
}

const tyni_sector *tyni_slice_span(const tyni_slices *g, int32_t first, int32_t end, int32_t size, float y, int32_t *next)
{
    const float dy = y * g->ew - g->ey, s = (float)size;
    const int side = side_of(g, first, s, dy);
    const tyni_sector *sector = &g->sectors[side == 1 ? 2 + (dy < 0.0f) : side == 0];
    if (side_of(g, end - 1, s, dy) == side) /* most spans are whole */
        first = end;
    while (first < end) {
        const int32_t middle = first + (end - first) / 2;
        if (side_of(g, middle, s, dy) > side)
            end = middle;
        else
            first = middle + 1;
    }
    *next = end;
    if (!sector->count) /* the epipole's own pixel, or a corner lost to rounding: any will do, its samples are weighed */
        for (sector = g->sectors; !sector->count && sector < g->sectors + 3; sector++)
            ;
    return sector;
}
