/* test_sample.c - packed breaks, ray samples and sources against the literal search of ED10 section 5.2. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sample.h"
#include "test.h"

enum { MOST = 700, WORDS = (MOST + 31) / 32 };

/* ED10's pseudo-code for one sample: from x walk to either side while depth does not jump, but no further than the segment. It
 * copies the segment's N samples alone and so can never reach the next segment's first, which leaves the last gap flat; here
 * the segment has that sample too. (The printed test has a comma where a minus is meant.) */
static void linear_search(const float *depth, int from, int to, int x, float threshold, int *left, int *right)
{
    for (*left = x; *left > from; (*left)--)
        if (fabsf(depth[*left - 1] - depth[*left]) > threshold * fminf(depth[*left - 1], depth[*left]))
            break;
    for (*right = x; *right < to; (*right)++)
        if (fabsf(depth[*right] - depth[*right + 1]) > threshold * fminf(depth[*right], depth[*right + 1]))
            break;
}

/* A line whose epipole is too far away for denser samples. */
static tyni_slice line_of(int first, int last)
{
    tyni_slice s;
    memset(&s, 0, sizeof s);
    s.first = first;
    s.last = last;
    s.p0 = 0.5f;
    s.dp = 1;
    s.epipole = -1e9f;
    return s;
}

/* All of a line: each sample's rays and sources as the search has them. */
static void check_line(const float *depth, int first, int last, int step)
{
    const float threshold = 0.06f;
    uint32_t breaks[WORDS], rays[WORDS];
    tyni_slice slice = line_of(first, last);
    int count = 0, jumps = 0, bad = 0;
    int32_t said;
    memset(breaks, 0xff, sizeof breaks);
    memset(rays, 0xff, sizeof rays);
    said = tyni_sample_breaks(breaks, TYN_ISA_SCALAR, depth, first, last, threshold);
    for (int j = first; j < last; j++)
        jumps += fabsf(depth[j] - depth[j + 1]) > threshold * fminf(depth[j], depth[j + 1]);
    CHECK(said == jumps);
    said = tyni_sample_rays(rays, breaks, &slice, step);
    for (int x = first; x <= last; x++) {
        /* segments begin at multiples of the step; the first and the last may be shorter */
        int from = x / step * step, to = from + step, left, right, ray, source;
        from = from > first ? from : first;
        to = to < last ? to : last;
        linear_search(depth, from, to, x, threshold, &left, &right);
        ray = left == x || right == x;
        bad += ray != tyni_sample_bit(rays, x);
        count += ray;
        if (ray)
            continue;
        /* the sources of an interpolated sample: the next rays on either side */
        source = tyni_sample_next(rays, x, last);
        bad += source != right;
        for (source = x; source > first && !tyni_sample_bit(rays, source); source--)
            ;
        bad += source != left;
    }
    CHECK(said == count);
    CHECK(bad == 0);
}

static void smooth(float *depth)
{
    for (int j = 0; j < MOST; j++)
        depth[j] = 10.0f + 0.01f * (float)j;
}

/* One jump, or two, at every place: the ends of the line and of words and segments among them. */
static void test_each_place(void)
{
    static const int lengths[] = {2, 3, 31, 32, 33, 63, 64, 65, 128, 129, MOST};
    float depth[MOST];
    TEST("a break at every place of lines of every length, as the linear search has it");
    for (int step = 1; step <= 64; step *= 2)
        for (size_t n = 0; n < sizeof lengths / sizeof *lengths; n++)
            for (int first = 0; first < 3 && first < lengths[n] - 1; first++)
                for (int at = first; at < lengths[n] - 1; at++) {
                    smooth(depth);
                    for (int j = at + 1; j < MOST; j++)
                        depth[j] += 5;
                    check_line(depth, first, lengths[n] - 1, step);
                    for (int j = at + 2; j < MOST; j++) /* a sample on its own */
                        depth[j] -= 5;
                    check_line(depth, first, lengths[n] - 1, step);
                }
}

static void test_random_breaks(void)
{
    float depth[MOST];
    TEST("random breaks, as the linear search has them");
    for (int n = 0; n < 20000; n++) {
        int length = 2 + (int)(test_random() % (MOST - 2)), first = (int)(test_random() % 40u);
        float often = test_random_float(0, 1) * test_random_float(0, 1);
        first = first < length - 1 ? first : 0;
        depth[0] = 10;
        for (int j = 1; j < MOST; j++)
            depth[j] = test_random_float(0, 1) < often ? test_random_float(0.5f, 40) : depth[j - 1] * 1.01f;
        check_line(depth, first, length - 1, 1 << (int)(test_random() % 7u));
    }
}

/* Near the epipole rays are four times as dense, on either side of it. */
static void test_dense(void)
{
    float depth[MOST];
    uint32_t breaks[WORDS], rays[WORDS];
    tyni_slice slice = line_of(0, MOST - 1);
    TEST("denser rays near the epipole");
    smooth(depth);
    tyni_sample_breaks(breaks, TYN_ISA_SCALAR, depth, 0, MOST - 1, 0.06f);
    slice.epipole = 130;
    tyni_sample_rays(rays, breaks, &slice, 16);
    for (int j = 0; j < MOST; j++) {
        int near = j >= 130 - 64 && j <= 130 + 64;
        CHECK(tyni_sample_bit(rays, j) == (j == MOST - 1 || j % 16 == 0 || (near && j % 4 == 0)));
    }
    /* a line that runs the other way, two pixels to a sample */
    slice.p0 = 599.5f;
    slice.dp = -2;
    slice.epipole = 599.5f - 2 * 200;
    tyni_sample_rays(rays, breaks, &slice, 16);
    for (int j = 0; j < MOST; j++) {
        int near = j >= 200 - 64 && j <= 200 + 64;
        CHECK(tyni_sample_bit(rays, j) == (j == MOST - 1 || j % 16 == 0 || (near && j % 4 == 0)));
    }
}

/* Between sources a line, on them what they are; a source never reaches over a break. */
static void test_interpolate(void)
{
    float value[MOST], kept[MOST], *values[3] = {value, NULL, NULL};
    uint32_t rays[WORDS];
    TEST("interpolation between sources");
    for (int n = 0; n < 2000; n++) {
        int last = 1 + (int)(test_random() % (MOST - 1)), bad = 0;
        memset(rays, 0, sizeof rays);
        for (int j = 0; j <= last; j++) {
            int ray = j == 0 || j == last || test_random() % 9u == 0;
            rays[j >> 5] |= (uint32_t)ray << (j & 31);
            kept[j] = value[j] = ray ? test_random_float(0, 1) : NAN;
        }
        tyni_sample_interpolate(values, 1, TYN_ISA_SCALAR, rays, 0, last);
        for (int j = 0, a = 0; j <= last; j++) {
            int b = tyni_sample_next(rays, j, last);
            float f = b > a ? (float)(j - a) / (float)(b - a) : 0;
            if (tyni_sample_bit(rays, j)) {
                bad += memcmp(&value[j], &kept[j], sizeof *value) != 0;
                a = j;
            } else {
                bad += !(fabsf(value[j] - (kept[a] + f * (kept[b] - kept[a]))) < 1e-6f);
            }
        }
        CHECK(bad == 0);
    }
}

/* Refinement leaves no stretch whose middle ray is off the line by more than the tolerance, and no ray where light is straight.
 */
static void test_refine(void)
{
    static float values[3][MOST];
    float *const value[3] = {values[0], values[1], values[2]};
    uint32_t breaks[WORDS], rays[WORDS], fresh[WORDS], whole[WORDS], again[WORDS], other[WORDS];
    const int32_t isas = tyn_isa_available();
    TEST("refinement on light");
    for (int n = 0; n < 400; n++) {
        int last = 80 + (int)(test_random() % (MOST - 80)), rounds = 0, total = 0;
        int first = n % 3 ? 0 : (int)(test_random() % (uint32_t)(last / 2 - 32)); /* well before the step */
        int32_t least = 1 << test_random() % 4u;
        float bend = test_random_float(0, 4e-4f), tolerance = test_random_float(0.002f, 0.05f);
        memset(breaks, 0, sizeof breaks);
        memset(rays, 0, sizeof rays);
        for (int j = 0; j <= last; j++) {
            values[0][j] = 0.3f + 0.001f * (float)j;
            values[1][j] = bend * (float)j * (float)j * 0.05f + (j > last / 2 ? 0.2f : 0.0f);
            rays[j >> 5] |= (uint32_t)(j >= first && (j % 16 == 0 || j == first || j == last)) << (j & 31);
        }
        for (int j = first; j < last && n & 1; j += 1 + (int)(test_random() % 80u))
            breaks[j >> 5] |= 1u << (j & 31);
        for (int j = first; j < last; j++) /* a ray on either side of each */
            for (int k = 0; k < 2 && tyni_sample_bit(breaks, j); k++)
                rays[(j + k) >> 5] |= 1u << ((j + k) & 31);
        memcpy(fresh, rays, sizeof fresh);
        memcpy(whole, rays, sizeof whole);
        for (int found = 1; found > 0; rounds++) {
            total += found = tyni_sample_refine(fresh, rays, breaks, TYN_ISA_SCALAR, value, 2, first, last, tolerance, least);
            for (int32_t isa = TYN_ISA_SCALAR; isa <= isas; isa *= 2) /* all compared once more: nothing else is found */
                if (isa & isas) {
                    memcpy(other, whole, sizeof other);
                    memcpy(again, whole, sizeof again);
                    CHECK(tyni_sample_refine(again, other, breaks, isa, value, 2, first, last, tolerance, least) == found);
                    CHECK(memcmp(other, rays, sizeof other) == 0 && memcmp(again, fresh, sizeof again) == 0);
                }
            memcpy(whole, rays, sizeof whole);
        }
        CHECK(rounds < 20 && (total > 0 || n & 1)); /* the step is found, if no break is there */
        for (int a = first, b; (b = tyni_sample_next(rays, a + 1, last)) < last; a = b) {
            int c = tyni_sample_next(rays, b + 1, last);
            float between;
            if ((b == a + 1 && tyni_sample_bit(breaks, a)) || (c == b + 1 && tyni_sample_bit(breaks, b)))
                continue;
            between = values[1][a] + (values[1][c] - values[1][a]) * (float)(b - a) / (float)(c - a);
            CHECK(fabsf(values[1][b] - between) <= tolerance + 1e-6f || (b - a <= least && c - b <= least));
        }
        memcpy(fresh, rays, sizeof fresh);
        CHECK(tyni_sample_refine(fresh, rays, breaks, TYN_ISA_SCALAR, value, 1, first, last, tolerance, least) == 0);
    }
}

void test_sample(void)
{
    test_each_place();
    test_random_breaks();
    test_dense();
    test_interpolate();
    test_refine();
}
