/* gather.c - see gather.h */
#include "gather.h"

#include "base.h"
#include "entry.h"
#include "num.h"

typedef struct sum {
    float low, high, third, weight;
} sum;

static float depth_weight(float depth, uint32_t entry, float threshold)
{
    float other = tyni_entry_depth(entry), off, limit, r;
    depth = tyni_maxf(depth, TYNI_ENTRY_NEAREST); /* nearer ones are not told apart */
    off = tyni_absf(depth - other);
    limit = threshold * tyni_minf(depth, other);
    if (off <= limit)
        return 1.0f;
    r = limit / off;
    r *= r;
    return r * r;
}

static void add(sum *s, const tyni_field *field, int32_t line, int32_t sample, float weight)
{
    uint32_t entry = field->entries[(ptrdiff_t)line * field->pitch + sample];
    s->weight += weight;
    s->low += weight * tyni_entry_low(entry, field->scales[0][line]);
    s->high += weight * tyni_entry_high(entry, field->scales[1][line]);
    if (field->thirds)
        s->third +=
            weight * tyni_entry_third_value(field->thirds[(ptrdiff_t)line * field->pitch + sample], field->scales[2][line]);
}

static void tap(sum *s, const tyni_field *field, int32_t line, int32_t sample, float depth, float threshold, float weight)
{
    uint32_t entry = field->entries[(ptrdiff_t)line * field->pitch + sample];
    if (tyni_entry_code(entry) && weight > 0.0f)
        add(s, field, line, sample, weight * depth_weight(depth, entry, threshold));
}

static int settle(const sum *s, float least, float value[3])
{
    if (!(s->weight > least))
        return 0;
    value[0] = s->low / s->weight;
    value[1] = s->high / s->weight;
    value[2] = s->third / s->weight;
    return 1;
}

/* A pixel's place on the shear grid: the first of its two lines and how far it is from it; its sample, and pixels beyond it. 0:
 * no slices at all. */
static int place_in(const tyni_slices *slices, float x, float y, int32_t *line, float *f, int32_t *sample, int32_t *beyond)
{
    float k;
    const tyni_sector *sector = tyni_slice_find(slices, x, y, &k);
    int32_t p;
    if (!sector->count)
        return 0;
    /* the last points of a coarse picture lie beside the screen */
    p = tyni_mini((int32_t)(sector->along_y ? y : x), (sector->along_y ? slices->height : slices->width) - 1);
    *sample = p / slices->stride;
    *beyond = p - *sample * slices->stride;
    *line = tyni_mini((int32_t)k, sector->count - 2);
    *f = k - (float)*line;
    *line += sector->start;
    return 1;
}

float tyni_gather_threshold(float threshold, const tyni_view *view, const tyni_lamp *lamp, float x, float y, float depth)
{
    float z = tyni_maxf(depth, TYNI_ENTRY_NEAREST) * view->far_depth;
    tyni_vec3 way;
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL)
        return threshold;
    way = tyni_vec_sub(lamp->position, tyni_view_point(view, x, y, z));
    return threshold * tyni_clampf(tyni_vec_length(way) / z, TYNI_GATHER_NARROW, 1.0f);
}

/* tyndall's shear grid: a pixel lies on the samples' own column, between two lines. */
static int gather_shear(const tyni_field *field, const tyni_slices *slices, float x, float y, float depth, float threshold,
                        float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f};
    float f;
    int32_t line, sample, r;
    if (!place_in(slices, x, y, &line, &f, &sample, &r))
        return 0;
    if (!r) {
        tap(&s, field, line, sample, depth, threshold, 1.0f - f);
        tap(&s, field, line + 1, sample, depth, threshold, f);
    } else {
        float g = (float)r / (float)slices->stride;
        tap(&s, field, line, sample, depth, threshold, (1.0f - f) * (1.0f - g));
        tap(&s, field, line + 1, sample, depth, threshold, f * (1.0f - g));
        tap(&s, field, line, sample + 1, depth, threshold, (1.0f - f) * g);
        tap(&s, field, line + 1, sample + 1, depth, threshold, f * g);
    }
    return settle(&s, TYNI_GATHER_ENOUGH, value);
}

/* A pixel's place on a line, in samples. */
static float place_on(const tyni_spoke *spoke, float x, float y)
{
    return (x - spoke->x) * spoke->ux + (y - spoke->y) * spoke->uy;
}

/* IVB section 6.6: the samples on either side on the two nearest lines. */
static int gather_ivb(const tyni_field *field, const tyni_slices *slices, float x, float y, float depth, float threshold,
                      float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f};
    int32_t slot[2];
    float blend;
    if (!tyni_border_find(slices, x, y, slot, &blend))
        return 0;
    for (int32_t i = 0; i < 2; i++) {
        int32_t line = tyni_border_slice(slices, slot[i]), j;
        float at, f, weight = i ? blend : 1.0f - blend;
        if (line < 0)
            continue;
        at = tyni_clampf(place_on(&slices->spokes[line], x, y), 0.0f, (float)(slices->samples - 1));
        j = tyni_mini((int32_t)at, slices->samples - 2);
        f = at - (float)j;
        tap(&s, field, line, j, depth, threshold, weight * (1.0f - f));
        tap(&s, field, line, j + 1, depth, threshold, weight * f);
    }
    return settle(&s, TYNI_GATHER_ENOUGH, value);
}

/* ED10 section 4.3: weights of a tap at a distance of r spacings, and of the depth between it and the pixel, in thresholds. The
 * paper leaves the constants open. Both start at 1, which Shepard's own 1 / x^2 does not. */
static float radial(tyn_kernel kernel, float r)
{
    if (kernel == TYN_KERNEL_SHEPARD)
        return 1.0f / (1.0f + 4.0f * r * r);
    if (kernel == TYN_KERNEL_GAUSSIAN)
        return tyni_num_exp(-2.0f * r * r);
    return 1.0f / (1.0f + r);
}

static float likeness(tyn_kernel kernel, float depth, uint32_t entry, float threshold)
{
    float other = tyni_entry_depth(entry), d;
    depth = tyni_maxf(depth, TYNI_ENTRY_NEAREST);
    d = tyni_absf(depth - other) / (threshold * tyni_minf(depth, other));
    if (kernel == TYN_KERNEL_SHEPARD)
        return 1.0f / (1.0f + d * d * d * d);
    if (kernel == TYN_KERNEL_GAUSSIAN)
        return tyni_num_exp(-tyni_minf(d * d, 80.0f));
    return d <= 1.0f ? 1.0f : 0.0f;
}

/* Distance between a pixel's projections on two lines. */
static float lines_apart(const tyni_slices *slices, const int32_t line[2], float x, float y)
{
    float p[2][2], dx, dy;
    if (line[0] < 0 || line[1] < 0)
        return slices->spacing;
    for (int32_t i = 0; i < 2; i++) {
        const tyni_spoke *s = &slices->spokes[line[i]];
        float at = place_on(s, x, y) / (s->ux * s->ux + s->uy * s->uy);
        p[i][0] = s->x + at * s->ux;
        p[i][1] = s->y + at * s->uy;
    }
    dx = p[0][0] - p[1][0];
    dy = p[0][1] - p[1][1];
    return sqrtf(dx * dx + dy * dy);
}

/* Taps along one line around the pixel's place on it. The radial weight is of the distance to the pixel itself, so that the
 * farther of two lines counts less. `spacing`: pixels between taps, but at least one sample, since near the epipole lines are
 * closer together than samples. */
static void along_line(sum *s, const tyni_gather *gather, const tyni_field *field, const tyni_slices *slices, int32_t line,
                       const float pixel[2], float spacing, float depth, float threshold)
{
    const tyni_spoke *spoke = &slices->spokes[line];
    float square = spoke->ux * spoke->ux + spoke->uy * spoke->uy, at = place_on(spoke, pixel[0], pixel[1]), pitch;
    spacing = tyni_maxf(spacing, 1.0f / sqrtf(square));
    pitch = spacing * sqrtf(square);
    for (int32_t k = 0; k < gather->taps; k++) {
        /* 0, 1, -1, 2, -2 */
        float place = at + pitch * (float)(k & 1 ? (k + 1) / 2 : -k / 2), dx, dy, r;
        int32_t j = (int32_t)tyni_clampf(place + 0.5f, 0.0f, (float)(slices->samples - 1));
        uint32_t entry = field->entries[(ptrdiff_t)line * field->pitch + j];
        if (!tyni_entry_code(entry))
            continue;
        dx = pixel[0] - (spoke->x + (float)j * spoke->ux / square);
        dy = pixel[1] - (spoke->y + (float)j * spoke->uy / square);
        r = sqrtf(dx * dx + dy * dy) / spacing;
        add(s, field, line, j, radial(gather->kernel, r) * likeness(gather->kernel, depth, entry, threshold));
    }
}

/* Two lines; where one has no fitting taps, the next outer one. */
static int gather_ed10(const tyni_gather *gather, const tyni_field *field, const tyni_slices *slices, float x, float y,
                       float depth, float threshold, float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f};
    int32_t slot[2], near[2];
    float blend, spacing, pixel[2];
    if (!tyni_border_find(slices, x, y, slot, &blend))
        return 0;
    pixel[0] = x;
    pixel[1] = y;
    near[0] = tyni_border_slice(slices, slot[0]);
    near[1] = tyni_border_slice(slices, slot[1]);
    spacing = lines_apart(slices, near, x, y);
    for (int32_t i = 0; i < 2; i++)
        for (int32_t outer = 0; outer < 2; outer++) {
            int32_t line = tyni_border_slice(slices, i ? slot[1] + outer : slot[0] - outer);
            sum one = {0.0f, 0.0f, 0.0f, 0.0f};
            if (line < 0)
                continue;
            along_line(&one, gather, field, slices, line, pixel, spacing, depth, threshold);
            s.low += one.low;
            s.high += one.high;
            s.third += one.third;
            s.weight += one.weight;
            if (one.weight > TYNI_GATHER_ENOUGH)
                break;
        }
    return settle(&s, TYNI_GATHER_ENOUGH, value);
}

int tyni_gather_lines(const tyni_gather *gather, const tyni_field *field, const tyni_slices *slices, float x, float y,
                      float depth, float threshold, float value[3])
{
    if (TYNI_HAS(TYN_PART_GATHERS) && gather->way == TYN_GATHER_IVB)
        return gather_ivb(field, slices, x, y, depth, threshold, value);
    if (TYNI_HAS(TYN_PART_GATHERS) && gather->way == TYN_GATHER_ED10)
        return gather_ed10(gather, field, slices, x, y, depth, threshold, value);
    return gather_shear(field, slices, x, y, depth, threshold, value);
}

/* The 2 x 2 points around a pixel: the first one's column and row, and how far the pixel lies beyond it. */
static void cell_of(const tyni_grid *g, float x, float y, int32_t at[2], float f[2])
{
    float gx = g->step_x > 0.0f ? tyni_clampf((x - 0.5f) / g->step_x, 0.0f, (float)(g->columns - 1)) : 0.0f;
    float gy = g->step_y > 0.0f ? tyni_clampf((y - 0.5f) / g->step_y, 0.0f, (float)(g->rows - 1)) : 0.0f;
    at[0] = tyni_mini((int32_t)gx, tyni_maxi(g->columns - 2, 0));
    at[1] = tyni_mini((int32_t)gy, tyni_maxi(g->rows - 2, 0));
    f[0] = gx - (float)at[0];
    f[1] = gy - (float)at[1];
}

int tyni_gather_grid(const tyni_grid *g, float x, float y, float depth, float threshold, float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f};
    int32_t at[2];
    float f[2];
    cell_of(g, x, y, at, f);
    for (int32_t n = 0; n < 4; n++) {
        int32_t dx = n & 1, dy = n >> 1;
        if (at[0] + dx < g->columns && at[1] + dy < g->rows)
            tap(&s, &g->field, at[1] + dy, at[0] + dx, depth, threshold, (dx ? f[0] : 1.0f - f[0]) * (dy ? f[1] : 1.0f - f[1]));
    }
    return settle(&s, TYNI_GATHER_ENOUGH, value);
}

void tyni_gather_nearest(const tyni_grid *g, float x, float y, float depth, float value[3])
{
    sum best = {0.0f, 0.0f, 0.0f, 0.0f};
    int32_t at[2];
    float f[2];
    cell_of(g, x, y, at, f);
    value[0] = value[1] = value[2] = 0.0f;
    for (int32_t n = 0; n < 4; n++) {
        int32_t dx = n & 1, dy = n >> 1;
        sum one = {0.0f, 0.0f, 0.0f, 0.0f};
        if (at[0] + dx >= g->columns || at[1] + dy >= g->rows)
            continue;
        tap(&one, &g->field, at[1] + dy, at[0] + dx, depth, g->field.threshold, 1.0f);
        if (one.weight > best.weight)
            best = one;
    }
    settle(&best, 0.0f, value);
}
