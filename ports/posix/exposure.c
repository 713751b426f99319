/* exposure.c - the automatic exposure. Counts of whole numbers and one division: no libm, so that every machine finds the same
 * factor, and with it the same picture. */
#include "render.h"

#include <string.h>

/* A positive float's upper bits are its logarithm, piecewise linear: 16 bins an octave. */
#define SHIFT 19
#define BINS (0x7f800000 >> SHIFT)

static float bin_value(uint32_t bin)
{
    uint32_t bits = (bin << SHIFT) + (1u << (SHIFT - 1));
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t quantile(const uint64_t *bins, uint64_t total, uint64_t permille)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < BINS; i++) {
        sum += bins[i];
        if (sum * 1000 > total * permille)
            return i;
    }
    return BINS - 1;
}

float render_exposure(const float *radiance, int32_t width, int32_t height)
{
    uint64_t bins[BINS] = {0}, total = 0, weighted = 0, counted = 0;
    size_t count = (size_t)width * (size_t)height;
    uint32_t high, mean;
    float by_mean, by_high, by_top, exposure;
    for (size_t i = 0; i < count; i++) {
        const float *c = radiance + 3 * i;
        float l = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        uint32_t bits;
        if (!(l > 1e-30f) || !(l < 1e30f)) /* black, or no number to measure */
            continue;
        memcpy(&bits, &l, sizeof bits);
        bins[bits >> SHIFT]++;
        total++;
    }
    if (total == 0)
        return 1.0f;
    /* The logarithmic mean of what is not much darker than the bright parts: black corners must not wash out the rest. */
    high = quantile(bins, total, 980);
    for (uint32_t i = high > 10 * 16 ? high - 10 * 16 : 0; i < BINS; i++) {
        weighted += bins[i] * i;
        counted += bins[i];
    }
    mean = (uint32_t)(weighted / counted);
    by_mean = 0.2f / bin_value(mean);
    by_high = 2.5f / bin_value(high);
    /* Small and very bright, such as the sun's patches on the floor of a church: then the church may be dark, up to a limit. */
    by_top = 16.0f / bin_value(quantile(bins, total, 995));
    by_top = by_top < 0.25f * by_mean ? 0.25f * by_mean : by_top;
    exposure = by_mean < by_high ? by_mean : by_high;
    return exposure < by_top ? exposure : by_top;
}
