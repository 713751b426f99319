/* sample.c - see sample.h */
#include "sample.h"

#include "base.h"
#include "lanes/lanes.h"

/* Pixels are read at offsets of 32 bits from the first of 16 samples; farther apart than this they are read one by one. */
#define FAR_APART (1 << 30)

/* The set bit before j; `first` if there is none. */
static int32_t previous(const uint32_t *words, int32_t j, int32_t first)
{
    int32_t w = j >> 5;
    uint32_t bits = words[w] & ((1u << (j & 31)) - 1u);
    while (!bits && w > first >> 5)
        bits = words[--w];
    return bits ? w * 32 + 31 - tyni_clz32(bits) : first;
}

static void set(uint32_t *words, int32_t j)
{
    words[j >> 5] |= 1u << (j & 31);
}

static void halve(uint32_t *fresh, int32_t a, int32_t b, int32_t least)
{
    if (b - a > least)
        set(fresh, a + (b - a) / 2);
}

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

float tyni_sample_reach(const float *depth, int32_t isa, const tyni_slice *slice, const tyni_view *view)
{
    float reach = tyni_maxf(TYNI_LANES_CALL(isa, sample_reach, (depth, slice, view)), 0.0f);
    reach -= tyni_vec_dot(slice->origin, slice->ex);
    return reach + 1e-5f * tyni_absf(reach);
}

int32_t tyni_sample_breaks(uint32_t *breaks, int32_t isa, const float *depth, int32_t first, int32_t last, float threshold)
{
    int32_t count = 0, words = tyni_sample_words(last + 1);
    TYNI_LANES_CALL(isa, sample_breaks, (breaks, depth, first, last, threshold));
    for (int32_t w = 0; w < words; w++)
        count += tyni_ones32(breaks[w]);
    return count;
}

int32_t tyni_sample_breaks_at(uint32_t *breaks, const float *depth, const tyni_slice *slice, const tyni_view *view,
                              tyni_vec3 lamp, float threshold)
{
    int32_t count = 0;
    float before = 0.0f;
    for (int32_t j = slice->first; j <= slice->last; j++) {
        const tyni_vec3 at = tyni_vec_mad(slice->a, tyni_slice_p(slice, j), slice->b);
        const tyni_vec3 end = view->orthographic ? tyni_vec_mad(at, depth[j], view->forward) : tyni_vec_scale(at, depth[j]);
        const tyni_vec3 way = tyni_vec_sub(lamp, end);
        const float far = tyni_vec_dot(way, way);
        if (j > slice->first) {
            const float jump = depth[j] - depth[j - 1];
            if (jump * jump > threshold * threshold * tyni_minf(before, far) && !tyni_sample_bit(breaks, j - 1)) {
                set(breaks, j - 1);
                count++;
            }
        }
        before = far;
    }
    return count;
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
        count += tyni_ones32(rays[w]);
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

/* b lies off the line through a and c. No branch on the sign: nobody can foretell it. */
static int bent(float *const value[3], int32_t values, int32_t a, int32_t b, int32_t c, float tolerance)
{
    const float near = (float)(b - a), far = (float)(c - a), most = tolerance * far;
    int off = 0;
    for (int32_t i = 0; i < values; i++) {
        const float *v = value[i];
        const float d = (v[b] - v[a]) * far - (v[c] - v[a]) * near;
        off |= (d > most) | (d < -most);
    }
    return off;
}

/* Compares rays from `a` on, until none of three is fresh; returns the last of those. New rays are not in `rays` yet, which
 * tells them from the fresh ones. */
static int32_t refine_from(int32_t a, uint32_t *fresh, const uint32_t *rays, const uint32_t *breaks, float *const value[3],
                           int32_t values, int32_t last, float tolerance, int32_t least)
{
    int32_t before = -1, stale = 0, w = a >> 5;
    uint32_t bits = rays[w] & (0xfffffffeu << (a & 31));
    while (a < last && stale < 2) {
        int32_t b;
        while (!bits)
            bits = rays[++w];
        b = w * 32 + tyni_ctz32(bits);
        if (b == a + 1 && tyni_sample_bit(breaks, a)) {
            before = -1; /* nothing is interpolated across it, so nothing is compared */
        } else {
            /* alone between breaks: so it is in the first round or never, and its start is fresh then */
            if (before < 0 && b - a > 4 && tyni_sample_bit(fresh, a) && (b == last || tyni_sample_bit(breaks, b)))
                halve(fresh, a, b, least);
            if (before >= 0 && bent(value, values, before, a, b, tolerance)) {
                halve(fresh, before, a, least);
                halve(fresh, a, b, least);
            }
            before = a;
        }
        stale = fresh[w] & bits & (0u - bits) ? 0 : stale + 1;
        bits &= bits - 1;
        a = b;
    }
    return a;
}

/* About each that is fresh. */
static void refine_about(uint32_t *fresh, const uint32_t *rays, const uint32_t *breaks, float *const value[3], int32_t values,
                         int32_t first, int32_t last, float tolerance, int32_t least)
{
    for (int32_t j = tyni_sample_next(fresh, first, last); j <= last;) {
        int32_t a = previous(rays, previous(rays, j, first), first);
        a = refine_from(a, fresh, rays, breaks, value, values, last, tolerance, least);
        do /* the next one that is fresh */
            j = a = tyni_sample_next(fresh, a + 1, last);
        while (j <= last && !tyni_sample_bit(rays, j));
    }
}

int32_t tyni_sample_refine(uint32_t *fresh, uint32_t *rays, const uint32_t *breaks, int32_t isa, float *const value[3],
                           int32_t values, int32_t first, int32_t last, float tolerance, int32_t least)
{
    const int32_t words = tyni_sample_words(last + 1);
    uint32_t stale = 0;
    int32_t count = 0;
    for (int32_t w = first >> 5; w < words; w++)
        stale |= rays[w] & ~fresh[w];
    if (TYNI_LANES_WIDE(isa) && !stale)
        TYNI_LANES_CALL(isa, sample_bends, (fresh, rays, breaks, value, values, first, last, tolerance, least));
    else
        refine_about(fresh, rays, breaks, value, values, first, last, tolerance, least);
    for (int32_t w = 0; w < words; w++) {
        fresh[w] &= ~rays[w];
        if (!fresh[w])
            continue;
        rays[w] |= fresh[w];
        count += tyni_ones32(fresh[w]);
    }
    return count;
}

void tyni_sample_interpolate(float *const value[3], int32_t values, int32_t isa, const uint32_t *rays, int32_t first,
                             int32_t last)
{
    TYNI_LANES_CALL(isa, sample_interpolate, (value, values, rays, first, last));
}
