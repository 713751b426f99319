/* noise.c - hashes and gradient noise. */
#include "noise.h"

#include <math.h>
#include <stddef.h>

uint32_t noise_hash(int32_t x, int32_t y, uint32_t seed)
{
    uint32_t h = seed * 0x9E3779B9u ^ (uint32_t)x * 0x85EBCA6Bu ^ (uint32_t)y * 0xC2B2AE35u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    return h;
}

float noise_unit(int32_t x, int32_t y, uint32_t seed)
{
    return (float)(noise_hash(x, y, seed) >> 8) * (1.0f / 16777216.0f);
}

float noise_next(uint32_t *state, float low, float high)
{
    *state += 1;
    return low + (high - low) * noise_unit((int32_t)(*state & 0xFFFF), (int32_t)(*state >> 16), 77);
}

static int32_t wrap(int32_t i, int32_t period)
{
    if (period <= 0) {
        return i;
    }
    int32_t rest = i % period;
    return rest < 0 ? rest + period : rest;
}

float noise_gradient(float x, float y, int32_t period, uint32_t seed, float slope[2])
{
    /* Eight directions would show; a slope pair of a 16-bit grid does not. */
    float fx = floorf(x), fy = floorf(y), rx = x - fx, ry = y - fy;
    float corner[4], gx[4], gy[4];
    for (int i = 0; i < 4; i++) {
        int32_t cx = (int32_t)fx + (i & 1), cy = (int32_t)fy + (i >> 1);
        uint32_t h = noise_hash(wrap(cx, period), wrap(cy, period), seed);
        gx[i] = (float)(h & 0xFFFF) * (2.4f / 65535.0f) - 1.2f;
        gy[i] = (float)(h >> 16) * (2.4f / 65535.0f) - 1.2f;
        corner[i] = gx[i] * (rx - (float)(i & 1)) + gy[i] * (ry - (float)(i >> 1));
    }
    float u = rx * rx * rx * (rx * (rx * 6 - 15) + 10), v = ry * ry * ry * (ry * (ry * 6 - 15) + 10);
    float low = corner[0] + u * (corner[1] - corner[0]), high = corner[2] + u * (corner[3] - corner[2]);
    if (slope != NULL) {
        float du = 30 * rx * rx * (rx * (rx - 2) + 1), dv = 30 * ry * ry * (ry * (ry - 2) + 1);
        float bottom = gx[0] + u * (gx[1] - gx[0]) + du * (corner[1] - corner[0]);
        float top = gx[2] + u * (gx[3] - gx[2]) + du * (corner[3] - corner[2]);
        slope[0] = bottom + v * (top - bottom);
        bottom = gy[0] + u * (gy[1] - gy[0]);
        top = gy[2] + u * (gy[3] - gy[2]);
        slope[1] = bottom + v * (top - bottom) + dv * (high - low);
    }
    return low + v * (high - low);
}

float noise_sum(float x, float y, int32_t octaves, int32_t period, uint32_t seed)
{
    float sum = 0, height = 0.6f;
    for (int32_t i = 0; i < octaves; i++) {
        sum += height * noise_gradient(x, y, period, seed + (uint32_t)i, NULL);
        x *= 2;
        y *= 2;
        period *= 2;
        height *= 0.5f;
    }
    return sum;
}

void noise_cells(float x, float y, int32_t period, uint32_t seed, float *f1, float *f2, uint32_t *which)
{
    int32_t cx = (int32_t)floorf(x), cy = (int32_t)floorf(y);
    *f1 = *f2 = 9;
    for (int32_t i = cx - 1; i <= cx + 1; i++) {
        for (int32_t j = cy - 1; j <= cy + 1; j++) {
            uint32_t h = noise_hash(wrap(i, period), wrap(j, period), seed);
            float dx = (float)i + (float)(h & 0xFFFF) / 65536.0f - x, dy = (float)j + (float)(h >> 16) / 65536.0f - y;
            float d = sqrtf(dx * dx + dy * dy);
            if (d < *f1) {
                *f2 = *f1;
                *f1 = d;
                *which = h;
            } else if (d < *f2) {
                *f2 = d;
            }
        }
    }
}
