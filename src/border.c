/* border.c - see border.h */
#include "border.h"

#include "base.h"

/* The border's corners are half a pixel inside the screen's. */
#define LOW 0.5f

static float high_x(const tyni_slices *g)
{
    return (float)g->width - 0.5f;
}
static float high_y(const tyni_slices *g)
{
    return (float)g->height - 0.5f;
}

/* A place along the border, in pixels from the top left corner and clockwise, as a point, and the way out of the screen. */
static void border_point(const tyni_slices *g, float at, float point[2], float out[2])
{
    float w = (float)(g->width - 1), h = (float)(g->height - 1);
    out[0] = out[1] = 0.0f;
    if (at < w) {
        point[0] = LOW + at;
        point[1] = LOW;
        out[1] = -1.0f;
    } else if (at < w + h) {
        point[0] = high_x(g);
        point[1] = LOW + (at - w);
        out[0] = 1.0f;
    } else if (at < 2.0f * w + h) {
        point[0] = high_x(g) - (at - w - h);
        point[1] = high_y(g);
        out[1] = 1.0f;
    } else {
        point[0] = LOW;
        point[1] = high_y(g) - tyni_minf(at - 2.0f * w - h, h);
        out[0] = -1.0f;
    }
}

/* How far from `at` along d, of length 1, the border is on one axis: far away if d runs beside it. */
static float slab(float at, float d, float low, float high)
{
    return d > 0.0f ? (high - at) / d : d < 0.0f ? (low - at) / d : 1e30f;
}

/* From the epipole through (x, y) on, as a vector of length 1; 0 at the epipole. */
static int away(const tyni_slices *g, float x, float y, float d[2])
{
    float length;
    d[0] = x * g->ew - g->ex;
    d[1] = y * g->ew - g->ey;
    length = sqrtf(d[0] * d[0] + d[1] * d[1]);
    if (!(length > 1e-6f))
        return 0;
    d[0] /= length;
    d[1] /= length;
    return 1;
}

/* The line that leaves the screen at a border point; 0 if none does. */
static int spoke_through(tyni_spoke *s, const tyni_slices *g, const float exit[2], const float out[2], int32_t samples,
                         int stretch)
{
    float d[2], length, pitch;
    if (!away(g, exit[0], exit[1], d) || !(d[0] * out[0] + d[1] * out[1] > 0.0f))
        return 0;
    /* back to the border on the other side, but no further than the epipole */
    length = tyni_minf(slab(exit[0], -d[0], LOW, high_x(g)), slab(exit[1], -d[1], LOW, high_y(g)));
    if (g->ew > 0.0f) {
        float dx = exit[0] - g->ex / g->ew, dy = exit[1] - g->ey / g->ew;
        length = tyni_minf(length, sqrtf(dx * dx + dy * dy));
    }
    if (!(length > 0.01f))
        return 0;
    s->x = exit[0] - length * d[0];
    s->y = exit[1] - length * d[1];
    pitch = length / (float)(samples - 1);
    pitch = stretch ? tyni_maxf(pitch, 1.0f) : pitch;
    s->ux = d[0] / pitch;
    s->uy = d[1] / pitch;
    return 1;
}

void tyni_border_layout(tyni_slices *g, const tyni_lamp *lamp, int32_t width, int32_t height, int32_t slots, int32_t samples,
                        int stretch)
{
    float around = 2.0f * (float)(width - 1 + height - 1);
    g->layout = TYNI_LAYOUT_BORDER;
    tyni_slice_epipole(g, lamp, width, height);
    g->samples = samples;
    g->count = 0;
    g->slot_count = around > 0.0f ? slots : 0; /* a single pixel has no border */
    g->spacing = around / (float)slots;
    for (int32_t i = 0; i < g->slot_count; i++) {
        float exit[2], out[2];
        border_point(g, (float)i * g->spacing, exit, out);
        g->slots[i] = spoke_through(&g->spokes[g->count], g, exit, out, samples, stretch) ? g->count++ : -1;
    }
}

/* Narrows first .. last to samples with low <= at + j step <= high; a hair more, so that ends on the border stay. */
static void keep(tyni_slice *s, float at, float step, float low, float high)
{
    float a, b;
    low -= 0.01f;
    high += 0.01f;
    if (tyni_absf(step) < 1e-6f) {
        if (at < low || at > high)
            s->last = s->first - 1;
        return;
    }
    a = (low - at) / step;
    b = (high - at) / step;
    s->first = tyni_maxi(s->first, tyni_ceili(tyni_clampf(tyni_minf(a, b), -1.0f, 65536.0f)));
    s->last = tyni_mini(s->last, tyni_floori(tyni_clampf(tyni_maxf(a, b), -1.0f, 65536.0f)));
}

/* The line begins at the epipole, not at the border. */
static int from_epipole(const tyni_slices *g, const tyni_spoke *s)
{
    float dx = s->x * g->ew - g->ex, dy = s->y * g->ew - g->ey;
    return g->ew > 0.0f && dx * dx + dy * dy < 0.01f * g->ew * g->ew;
}

void tyni_border_line(tyni_slice *s, const tyni_slices *g, const tyni_lamp *lamp, const tyni_view *view, int32_t index)
{
    const tyni_spoke *spoke = &g->spokes[index];
    float square = spoke->ux * spoke->ux + spoke->uy * spoke->uy, dx = spoke->ux / square, dy = spoke->uy / square, along;
    s->along_y = tyni_absf(dy) > tyni_absf(dx);
    s->p0 = s->along_y ? spoke->y : spoke->x;
    s->dp = s->along_y ? dy : dx;
    s->slope = tyni_clampf(s->along_y ? dx / dy : dy / dx, -1.0f, 1.0f);
    s->m0 = (s->along_y ? spoke->x : spoke->y) - s->slope * s->p0;
    along = s->along_y ? g->ey : g->ex;
    s->epipole = g->ew > 0.0f ? tyni_clampf(along / g->ew, -1e9f, 1e9f) : s->dp > 0.0f ? -1e9f : 1e9f;
    tyni_slice_plane(s, tyni_slice_p(s, g->samples - 1), lamp, view);
    /* not the light's own place, where all lines meet and a ray runs into the light: its light is no neighbour's */
    s->first = from_epipole(g, spoke) ? tyni_mini(1 + (int32_t)(0.5f * sqrtf(square)), g->samples - 1) : 0;
    s->last = g->samples - 1;
    keep(s, spoke->x, dx, LOW, high_x(g));
    keep(s, spoke->y, dy, LOW, high_y(g));
}

int tyni_border_find(const tyni_slices *g, float x, float y, int32_t slot[2], float *blend)
{
    float w = (float)(g->width - 1), h = (float)(g->height - 1), d[2], tx, ty, t, at, k;
    if (!g->slot_count || !away(g, x, y, d))
        return 0;
    tx = slab(x, d[0], LOW, high_x(g));
    ty = slab(y, d[1], LOW, high_y(g));
    t = tyni_minf(tx, ty);
    x = tyni_clampf(x + t * d[0] - LOW, 0.0f, w);
    y = tyni_clampf(y + t * d[1] - LOW, 0.0f, h);
    if (tx <= ty)
        at = d[0] > 0.0f ? w + y : 2.0f * w + h + (h - y);
    else
        at = d[1] > 0.0f ? w + h + (w - x) : x;
    k = at / g->spacing;
    slot[0] = tyni_clampi((int32_t)k, 0, g->slot_count - 1);
    slot[1] = slot[0] + 1 == g->slot_count ? 0 : slot[0] + 1;
    *blend = tyni_clampf(k - (float)slot[0], 0.0f, 1.0f);
    return 1;
}
