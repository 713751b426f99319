/* debug.c - see debug.h */
#include "debug.h"

#include "base.h"
#include "entry.h"
#include "sample.h"

enum mark { MARK_NONE = 0, MARK_LINE = 1, MARK_RAY = 2, MARK_BREAK = 3 };

void tyni_debug_mark(uint32_t *entries, const uint32_t *rays, const uint32_t *breaks, int32_t first, int32_t last)
{
    for (int32_t j = first; j <= last; j++) {
        int side = (j < last && tyni_sample_bit(breaks, j)) || (j > first && tyni_sample_bit(breaks, j - 1));
        entries[j] = side ? MARK_BREAK : tyni_sample_bit(rays, j) ? MARK_RAY : MARK_LINE;
    }
}

static void paint(float rgb[3], float r, float g, float b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

/* The mark of the sample whose line passes through the pixel; MARK_NONE where none does. */
static uint32_t mark_at(const tyni_slices *slices, const tyni_field *field, int32_t x, int32_t y)
{
    float px = (float)x + 0.5f, py = (float)y + 0.5f, k, p, along, size, spacing;
    const tyni_sector *s = tyni_slice_find(slices, px, py, &k);
    int32_t line, pixel = s->along_y ? y : x;
    if (!s->count || pixel % slices->stride)
        return MARK_NONE;
    /* lines draw together towards the epipole */
    p = s->along_y ? py : px;
    along = s->along_y ? slices->ey : slices->ex;
    size = tyni_absf(s->border * slices->ew - along);
    spacing = size > 0.0f ? s->spacing * tyni_absf(p * slices->ew - along) / size : 0.0f;
    line = (int32_t)(k + 0.5f);
    if (tyni_absf(k - (float)line) * spacing > 0.5f)
        return MARK_NONE;
    return field->entries[(ptrdiff_t)(s->start + line) * field->pitch + pixel / slices->stride];
}

static void paint_scatter(const tyni_view *view, const tyni_slices *slices, const tyni_field *field, int32_t x, int32_t y,
                          float rgb[3])
{
    int32_t line = (int32_t)((int64_t)y * slices->count / view->height);
    int32_t sample = (int32_t)((int64_t)x * slices->samples / view->width);
    uint32_t entry = field->entries[(ptrdiff_t)line * field->pitch + sample];
    float low = tyni_entry_low(entry, field->scales[line]), high = tyni_entry_high(entry, field->scales[line]);
    if (tyni_entry_code(entry))
        paint(rgb, low, 0.5f * (low + high), high);
    else
        paint(rgb, 0.1f, 0.0f, 0.1f);
}

static int outside(const tyni_view *view, const tyni_lamp *lamp, int32_t x, int32_t y, float depth)
{
    tyni_vec3 p = tyni_view_point(view, (float)x + 0.5f, (float)y + 0.5f, tyni_view_depth(view, depth));
    for (int32_t i = 0; i < lamp->map_count; i++) {
        const tyni_map *map = &lamp->maps[i];
        float u = tyni_vec_dot(map->u.v, p) + map->u.c, v = tyni_vec_dot(map->v.v, p) + map->v.c;
        float w = tyni_vec_dot(map->w.v, p) + map->w.c, width = (float)map->texels.width, height = (float)map->texels.height;
        if (w > 0.0f && u >= 0.0f && v >= 0.0f && u <= w * width && v <= w * height)
            return 0;
    }
    return 1;
}

void tyni_debug_pixel(tyn_debug debug, const tyni_view *view, const tyni_lamp *lamp, const tyni_slices *slices,
                      const tyni_field *field, int32_t x, int32_t y, float depth, int rejected, float rgb[3])
{
    uint32_t mark = MARK_NONE;
    if (debug == TYN_DEBUG_OUTSIDE) {
        if (outside(view, lamp, x, y, depth))
            paint(rgb, 3.0f, 0.0f, 3.0f);
        return;
    }
    if (debug == TYN_DEBUG_REJECTED) {
        if (rejected)
            paint(rgb, 5.0f, 0.0f, 0.0f);
        return;
    }
    if (!slices->count)
        return; /* no epipolar pass: nothing to show */
    if (debug == TYN_DEBUG_SCATTER) {
        paint_scatter(view, slices, field, x, y, rgb);
        return;
    }
    mark = mark_at(slices, field, x, y);
    if (mark == MARK_BREAK && debug != TYN_DEBUG_LINES)
        paint(rgb, 0.0f, 5.0f, 0.0f);
    else if (mark == MARK_RAY && debug == TYN_DEBUG_SAMPLES)
        paint(rgb, 5.0f, 5.0f, 5.0f);
    else if (mark != MARK_NONE && debug == TYN_DEBUG_LINES)
        paint(rgb, 1.0f, 0.7f, 0.1f);
}
