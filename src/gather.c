/* gather.c - see gather.h */
#include "gather.h"

#include "base.h"
#include "entry.h"

/* Below this sum of weights the samples tell too little of the pixel. A sample one and a half thresholds off has a fifth. */
#define ENOUGH 0.15f

typedef struct sum {
    float low, high, third, weight;
} sum;

/* 1 within the threshold, then falling with the fourth power (IVB section 6.6). */
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

static void tap(sum *s, const tyni_field *field, int32_t line, int32_t sample, float depth, float weight)
{
    uint32_t entry = field->entries[(ptrdiff_t)line * field->pitch + sample];
    if (!tyni_entry_code(entry) || weight <= 0.0f)
        return;
    weight *= depth_weight(depth, entry, field->threshold);
    s->weight += weight;
    s->low += weight * tyni_entry_low(entry, field->scales[line]);
    s->high += weight * tyni_entry_high(entry, field->scales[line]);
    if (field->thirds)
        s->third +=
            weight * tyni_entry_third_value(field->thirds[(ptrdiff_t)line * field->pitch + sample], field->scales[line][2]);
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

int tyni_gather_slices(const tyni_field *field, const tyni_slices *slices, float x, float y, float depth, float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f};
    float k, f;
    const tyni_sector *sector = tyni_slice_find(slices, x, y, &k);
    int32_t line, sample, p, r;
    if (!sector->count)
        return 0;
    p = (int32_t)(sector->along_y ? y : x);
    sample = p / slices->stride;
    r = p - sample * slices->stride;
    line = tyni_mini((int32_t)k, sector->count - 2);
    f = k - (float)line;
    line += sector->start;
    if (!r) {
        tap(&s, field, line, sample, depth, 1.0f - f);
        tap(&s, field, line + 1, sample, depth, f);
    } else {
        float g = (float)r / (float)slices->stride;
        tap(&s, field, line, sample, depth, (1.0f - f) * (1.0f - g));
        tap(&s, field, line + 1, sample, depth, f * (1.0f - g));
        tap(&s, field, line, sample + 1, depth, (1.0f - f) * g);
        tap(&s, field, line + 1, sample + 1, depth, f * g);
    }
    return settle(&s, ENOUGH, value);
}

void tyni_gather_grid(const tyni_field *field, float x, float y, float depth, float value[3])
{
    sum s = {0.0f, 0.0f, 0.0f, 0.0f}, best = {0.0f, 0.0f, 0.0f, 0.0f};
    float gx = tyni_clampf((x - 0.5f) / (float)field->spacing, 0.0f, (float)(field->columns - 1));
    float gy = tyni_clampf((y - 0.5f) / (float)field->spacing, 0.0f, (float)(field->rows - 1));
    int32_t i = tyni_mini((int32_t)gx, tyni_maxi(field->columns - 2, 0)),
            j = tyni_mini((int32_t)gy, tyni_maxi(field->rows - 2, 0));
    float fx = gx - (float)i, fy = gy - (float)j;
    value[0] = value[1] = value[2] = 0.0f;
    for (int32_t n = 0; n < 4; n++) {
        int32_t dx = n & 1, dy = n >> 1;
        sum one = {0.0f, 0.0f, 0.0f, 0.0f};
        if (i + dx >= field->columns || j + dy >= field->rows)
            continue;
        tap(&s, field, j + dy, i + dx, depth, (dx ? fx : 1.0f - fx) * (dy ? fy : 1.0f - fy));
        tap(&one, field, j + dy, i + dx, depth, 1.0f);
        if (one.weight > best.weight)
            best = one;
    }
    if (!settle(&s, ENOUGH, value))
        settle(&best, 0.0f, value);
}
