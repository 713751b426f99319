/* num.c - see num.h */
#include "num.h"

#include "base.h"

/* ln 2 in two parts; n * LN2_HIGH is exact for |n| < 2^11. */
#define LN2_HIGH 0.693145752f
#define LN2_LOW 1.42860677e-6f

float tyni_num_exp(float x)
{
    float n, r, p;
    int32_t i;
    if (!(x >= -87.0f))
        return 0.0f;
    if (x > 88.0f)
        x = 88.0f;
    i = tyni_floori(x * 1.44269504f + 0.5f);
    n = (float)i;
    r = (x - n * LN2_HIGH) - n * LN2_LOW;
    p = 1.0f / 5040.0f;
    p = p * r + 1.0f / 720.0f;
    p = p * r + 1.0f / 120.0f;
    p = p * r + 1.0f / 24.0f;
    p = p * r + 1.0f / 6.0f;
    p = p * r + 0.5f;
    p = p * r * r + r;
    return (p + 1.0f) * tyni_bits_float((uint32_t)(i + 127) << 23);
}

float tyni_num_fog(float x)
{
    float p;
    if (!(x < 0.5f))
        return (1.0f - tyni_num_exp(-x)) / x;
    p = -1.0f / 40320.0f;
    p = p * x + 1.0f / 5040.0f;
    p = p * x - 1.0f / 720.0f;
    p = p * x + 1.0f / 120.0f;
    p = p * x - 1.0f / 24.0f;
    p = p * x + 1.0f / 6.0f;
    p = p * x - 0.5f;
    return p * x + 1.0f;
}

void tyni_num_fade(float x, float *left, float *lost)
{
    const float t = tyni_maxf(x * -1.44269504f, -126.0f), whole = t + TYNI_WHOLE;
    const float r = t - (whole - TYNI_WHOLE), scale = tyni_bits_float(tyni_float_bits(whole) << 23);
    float p;
    /* 2^r - 1 for |r| <= 1/2: with i = 0 nothing is lost to a 1 */
    p = 0.00133813021f;
    p = p * r + 0.00966636837f;
    p = p * r + 0.0555038117f;
    p = p * r + 0.240223497f;
    p = (p * r + 0.693147182f) * r * scale;
    *left = p + scale;
    *lost = (1.0f - scale) - p;
}

float tyni_num_log(float x)
{
    uint32_t bits;
    int32_t e;
    float m, s, q, p;
    if (!(x > 1.17549435e-38f))
        x = 1.17549435e-38f;
    bits = tyni_float_bits(x);
    /* m in sqrt(1/2) .. sqrt(2), so that the series in (m - 1) / (m + 1) is short */
    e = (int32_t)((bits - 0x3f3504f3u) >> 23);
    e = e >= 256 ? e - 512 : e;
    m = tyni_bits_float(bits - ((uint32_t)e << 23));
    s = (m - 1.0f) / (m + 1.0f);
    q = s * s;
    p = 1.0f / 9.0f;
    p = p * q + 1.0f / 7.0f;
    p = p * q + 1.0f / 5.0f;
    p = p * q + 1.0f / 3.0f;
    p = 2.0f * s + 2.0f * s * q * p;
    return (float)e * LN2_HIGH + ((float)e * LN2_LOW + p);
}

void tyni_num_sincos(float x, float *sine, float *cosine)
{
    /* pi / 2 in three parts of 12 bits and more, so that n * part is exact for |n| < 2^13 */
    int32_t n = tyni_floori(tyni_clampf(x, -8192.0f, 8192.0f) * 0.636619772f + 0.5f);
    float f = (float)n, r, q, s, c;
    r = ((x - f * 1.5703125f) - f * 4.83751297e-4f) - f * 7.54978995e-8f;
    q = r * r;
    s = 1.0f / 362880.0f;
    s = s * q - 1.0f / 5040.0f;
    s = s * q + 1.0f / 120.0f;
    s = s * q - 1.0f / 6.0f;
    s = s * q * r + r;
    c = -1.0f / 3628800.0f;
    c = c * q + 1.0f / 40320.0f;
    c = c * q - 1.0f / 720.0f;
    c = c * q + 1.0f / 24.0f;
    c = c * q - 0.5f;
    c = c * q + 1.0f;
    *sine = (n & 1) ? c : s;
    *cosine = (n & 1) ? s : c;
    if (n & 2)
        *sine = -*sine;
    if ((n + 1) & 2)
        *cosine = -*cosine;
}

/* 0 <= x <= tan(pi / 8) */
static float atan_small(float x)
{
    float q = x * x, p;
    p = 1.0f / 17.0f;
    p = -p * q + 1.0f / 15.0f;
    p = -p * q + 1.0f / 13.0f;
    p = -p * q + 1.0f / 11.0f;
    p = -p * q + 1.0f / 9.0f;
    p = -p * q + 1.0f / 7.0f;
    p = -p * q + 1.0f / 5.0f;
    p = -p * q + 1.0f / 3.0f;
    return x - x * q * p;
}

float tyni_num_atan2(float y, float x)
{
    float a = tyni_absf(y), b = tyni_absf(x), low = tyni_minf(a, b), high = tyni_maxf(a, b), angle;
    if (!(high > 0.0f))
        return 0.0f;
    if (low > 0.414213562f * high)
        angle = 0.25f * TYNI_PI + (low < high ? -atan_small((high - low) / (high + low)) : 0.0f);
    else
        angle = atan_small(low / high);
    if (a > b)
        angle = 0.5f * TYNI_PI - angle;
    if (x < 0.0f)
        angle = TYNI_PI - angle;
    return y < 0.0f ? -angle : angle;
}
