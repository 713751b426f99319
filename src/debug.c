/* debug.c - see debug.h */
#include "debug.h"

#include "base.h"
#include "entry.h"
#include "sample.h"

enum mark { MARK_NONE = 0, MARK_LINE = 1, MARK_RAY = 2, MARK_BREAK = 3, MARK_REFINED = 4 };
#define MARK_BITS 4 /* the sample's first source stands above them */

static uint32_t *entries_of(const tyni_pass *p, int32_t line)
{
    return p->lines.entries + (ptrdiff_t)line * p->lines.pitch;
}

void tyni_debug_mark_initial(const tyni_pass *p, int32_t line, const tyni_slice *slice, const uint32_t *rays,
                             const uint32_t *breaks)
{
    uint32_t *entries = entries_of(p, line);
    for (int32_t j = slice->first; j <= slice->last; j++) {
        int side = (j < slice->last && tyni_sample_bit(breaks, j)) || (j > slice->first && tyni_sample_bit(breaks, j - 1));
        entries[j] = side ? MARK_BREAK : tyni_sample_bit(rays, j) ? MARK_RAY : MARK_LINE;
    }
}

void tyni_debug_mark_sources(const tyni_pass *p, int32_t line, const tyni_slice *slice, const uint32_t *rays)
{
    uint32_t *entries = entries_of(p, line), source = 0;
    for (int32_t j = slice->first; j <= slice->last; j++) {
        if (tyni_sample_bit(rays, j)) {
            entries[j] = entries[j] == MARK_LINE ? MARK_REFINED : entries[j];
            source = (uint32_t)j;
        }
        entries[j] |= source << MARK_BITS;
    }
}

static void paint(float rgb[3], float r, float g, float b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

/* The mark of the sample at the pixel; MARK_NONE where no line passes through it. */
static uint32_t mark_at(const tyni_pass *p, int32_t x, int32_t y)
{
    int32_t line, sample, pixel;
    float distance;
    if (!tyni_pass_nearest(p, (float)x + 0.5f, (float)y + 0.5f, &line, &sample, &distance) || distance > 0.5f)
        return MARK_NONE;
    if (!tyni_slice_bordered(&p->slices) && p->slices.stride > 1) { /* between samples there is nothing to show */
        float k;
        pixel = tyni_slice_find(&p->slices, (float)x + 0.5f, (float)y + 0.5f, &k)->along_y ? y : x;
        if (pixel % p->slices.stride)
            return MARK_NONE;
    }
    return entries_of(p, line)[sample] & ((1u << MARK_BITS) - 1u);
}

/* A bright colour, different for neighbouring numbers. */
static void paint_number(float rgb[3], uint32_t n)
{
    n *= 0x9e3779b1u;
    paint(rgb, 0.1f + (float)(n >> 24) * 0.004f, 0.1f + (float)(n >> 16 & 255u) * 0.004f,
          0.1f + (float)(n >> 8 & 255u) * 0.004f);
}

/* The texture of lines: a row is a slice, a column a sample. */
static void paint_texture(const tyni_pass *p, int32_t x, int32_t y, float rgb[3])
{
    int32_t line = (int32_t)((int64_t)y * p->slices.count / p->view.height);
    int32_t sample = (int32_t)((int64_t)x * p->slices.samples / p->view.width);
    uint32_t entry = entries_of(p, line)[sample];
    paint(rgb, 0.1f, 0.0f, 0.1f);
    if (p->frame->debug == TYN_DEBUG_SOURCES) {
        uint32_t mark = entry & ((1u << MARK_BITS) - 1u);
        if (mark == MARK_LINE)
            paint_number(rgb, entry >> MARK_BITS);
        else if (mark == MARK_BREAK)
            paint(rgb, 0.0f, 5.0f, 0.0f);
        else if (mark != MARK_NONE)
            paint(rgb, 5.0f, 5.0f, 5.0f);
    } else if (tyni_entry_code(entry)) {
        float low = tyni_entry_low(entry, p->lines.scales[0][line]), high = tyni_entry_high(entry, p->lines.scales[1][line]);
        paint(rgb, low, 0.5f * (low + high), high);
    }
}

/* The rows of TYN_METHOD_PREFILTERED. */
static void paint_basis(const tyni_pass *p, int32_t x, int32_t y, float rgb[3])
{
    int32_t line = (int32_t)((int64_t)y * p->slices.count / p->view.height);
    int32_t column = (int32_t)((int64_t)x * p->fourier.columns / p->view.width);
    paint(rgb, 0.1f, 0.0f, 0.1f);
    if (tyni_prefilter_kept(p->method))
        tyni_fourier_show(&p->fourier, (const void *)(p->context->shelves + (size_t)line * p->context->shelf_bytes), column,
                          rgb);
}

static int outside(const tyni_pass *p, int32_t x, int32_t y, float depth)
{
    tyni_vec3 at = tyni_view_point(&p->view, (float)x + 0.5f, (float)y + 0.5f, tyni_view_depth(&p->view, depth));
    for (int32_t i = 0; i < p->lamp->map_count; i++) {
        const tyni_map *map = &p->lamp->maps[i];
        float u = tyni_form_at(&map->u, at), v = tyni_form_at(&map->v, at), w = tyni_form_at(&map->w, at);
        if (w > 0.0f && u >= 0.0f && v >= 0.0f && u <= w * (float)map->texels.width && v <= w * (float)map->texels.height)
            return 0;
    }
    return 1;
}

static void paint_mark(tyn_debug debug, uint32_t mark, float rgb[3])
{
    if (debug == TYN_DEBUG_LINES && mark != MARK_NONE)
        paint(rgb, 1.0f, 0.7f, 0.1f);
    else if (debug != TYN_DEBUG_LINES && mark == MARK_BREAK)
        paint(rgb, 0.0f, 5.0f, 0.0f);
    else if (debug == TYN_DEBUG_SAMPLES && mark == MARK_RAY)
        paint(rgb, 5.0f, 5.0f, 5.0f);
    else if (debug == TYN_DEBUG_SAMPLES && mark == MARK_REFINED)
        paint(rgb, 0.2f, 0.5f, 5.0f);
}

void tyni_debug_pixel(const tyni_pass *p, int32_t x, int32_t y, float depth, int rejected, float rgb[3])
{
    tyn_debug debug = p->frame->debug;
    if (debug == TYN_DEBUG_OUTSIDE) {
        if (outside(p, x, y, depth))
            paint(rgb, 3.0f, 0.0f, 3.0f);
    } else if (debug == TYN_DEBUG_REJECTED) {
        if (rejected)
            paint(rgb, 5.0f, tyni_pass_gridded(p) ? 4.0f : 0.0f, 0.0f);
    } else if (!p->slices.count) {
        return; /* no epipolar pass: nothing to show */
    } else if (debug == TYN_DEBUG_SCATTER || debug == TYN_DEBUG_SOURCES) {
        paint_texture(p, x, y, rgb);
    } else if (debug == TYN_DEBUG_BASIS) {
        paint_basis(p, x, y, rgb);
    } else if (tyni_debug_marks(debug)) { /* charts are drawn over the picture later: their lines hold light, if any are kept */
        paint_mark(debug, mark_at(p, x, y), rgb);
    }
}
