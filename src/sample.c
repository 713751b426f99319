/* sample.c - see sample.h */
#include "sample.h"

#include "base.h"
#include "lanes/lanes.h"

/* Pixels are read at offsets of 32 bits from the first of 16 samples; farther apart than this they are read one by one. */
#define FAR_APART (1 << 30)

#define TYNI_KERNEL "sample_kernel.h"
#include "lanes/each.h"

void tyni_sample_depths(float *depth, int32_t isa, const tyni_slice *slice, const tyni_view *view, const tyni_door *door)
{
    const tyn_image *image = door->image;
    int32_t last_p = (slice->along_y ? image->height : image->width) - 1;
    int32_t last_m = (slice->along_y ? image->width : image->height) - 1;
    float stride = (float)(door->stride < 0 ? -door->stride : door->stride);
    for (int32_t j = slice->first & ~31; j < slice->first; j++)
        depth[j] = 0.0f;
    if (door->plain && (16.0f * tyni_absf(slice->dp) + 18.0f) * (stride + 4.0f) < (float)FAR_APART) {
        TYNI_LANES_CALL(isa, sample_depths, (depth, slice, view, door, last_p, last_m));
        return;
    }
    for (int32_t j = slice->first; j <= slice->last; j++) {
        float at = tyni_slice_p(slice, j), m = slice->m0 + slice->slope * at;
        int32_t p = (int32_t)tyni_clampf(at, 0.0f, (float)last_p);
        int32_t i = (int32_t)tyni_clampf(m, 0.0f, (float)last_m);
        depth[j] = tyni_view_depth(view, slice->along_y ? tyni_door_depth(door, i, p) : tyni_door_depth(door, p, i));
    }
}

int32_t tyni_sample_breaks(uint32_t *breaks, int32_t isa, const float *depth, int32_t first, int32_t last, float threshold)
{
    int32_t count = 0, words = tyni_sample_words(last + 1);
    TYNI_LANES_CALL(isa, sample_breaks, (breaks, depth, first, last, threshold));
    for (int32_t w = 0; w < words; w++)
        for (uint32_t bits = breaks[w]; bits; bits &= bits - 1)
            count++;
    return count;
}

static void set(uint32_t *words, int32_t j)
{
    words[j >> 5] |= 1u << (j & 31);
}

int32_t tyni_sample_rays(uint32_t *rays, const uint32_t *breaks, const tyni_slice *slice, int32_t step)
{
    int32_t words = tyni_sample_words(slice->last + 1), count = 0, dense, from, to;
    uint32_t carry = 0;
    /* a break bit stands for both of its sides */
    for (int32_t w = 0; w < words; w++) {
        rays[w] = breaks[w] | breaks[w] << 1 | carry;
        carry = breaks[w] >> 31;
    }
    for (int32_t j = (slice->first + step - 1) / step * step; j <= slice->last; j += step)
        set(rays, j);
    /* near the epipole light varies faster: IVB section 6.2. Four initial steps on either side of it. */
    dense = tyni_maxi(step / 4, 1);
    from = (int32_t)tyni_clampf((tyni_clampf(slice->epipole, -1e6f, 1e6f) - slice->p0) / slice->dp + 0.5f, -1e6f, 1e6f);
    to = tyni_mini(from + 4 * step, slice->last);
    from = tyni_maxi(from - 4 * step, slice->first);
    for (int32_t j = (from + dense - 1) / dense * dense; j <= to; j += dense)
        set(rays, j);
    set(rays, slice->first);
    set(rays, slice->last);
    for (int32_t w = 0; w < words; w++)
        for (uint32_t bits = rays[w]; bits; bits &= bits - 1)
            count++;
    return count;
}

int32_t tyni_sample_next(const uint32_t *words, int32_t j, int32_t last)
{
    int32_t w = j >> 5, end = last >> 5;
    uint32_t bits;
    if (j > last)
        return last + 1;
    bits = words[w] & (0xffffffffu << (j & 31));
    while (!bits && w < end)
        bits = words[++w];
    if (!bits)
        return last + 1;
    return tyni_mini(w * 32 + tyni_ctz32(bits), last + 1);
}

static int bent(const float *value, int32_t a, int32_t b, int32_t c, float tolerance)
{
    float between = value[a] + (value[c] - value[a]) * ((float)(b - a) / (float)(c - a));
    return tyni_absf(value[b] - between) > tolerance;
}

static int any_bent(float *const value[3], int32_t values, int32_t a, int32_t b, int32_t c, float tolerance)
{
    for (int32_t i = 0; i < values; i++)
        if (bent(value[i], a, b, c, tolerance))
            return 1;
    return 0;
}

static int32_t halve(uint32_t *fresh, int32_t a, int32_t b)
{
    if (b - a < 2)
        return 0;
    a += (b - a) / 2;
    if (tyni_sample_bit(fresh, a))
        return 0;
    set(fresh, a);
    return 1;
}

int32_t tyni_sample_refine(uint32_t *fresh, uint32_t *rays, const uint32_t *breaks, float *const value[3], int32_t values,
                           int32_t first, int32_t last, float tolerance)
{
    int32_t a = first, before = -1, words = tyni_sample_words(last + 1), count = 0;
    memset(fresh, 0, sizeof *fresh * (size_t)words);
    while (a < last) {
        int32_t b = tyni_sample_next(rays, a + 1, last);
        int broken = b == a + 1 && tyni_sample_bit(breaks, a);
        int alone = before < 0 && (b == last || tyni_sample_bit(breaks, b));
        if (broken) {
            before = -1; /* nothing is interpolated across it, so nothing is compared */
        } else {
            if (alone && b - a > 4)
                count += halve(fresh, a, b);
            if (before >= 0 && any_bent(value, values, before, a, b, tolerance))
                count += halve(fresh, before, a) + halve(fresh, a, b);
            before = a;
        }
        a = b;
    }
    for (int32_t w = 0; w < words; w++)
        rays[w] |= fresh[w];
    return count;
}

void tyni_sample_interpolate(float *value, int32_t isa, const uint32_t *rays, int32_t first, int32_t last)
{
    TYNI_LANES_CALL(isa, sample_interpolate, (value, rays, first, last));
}
