/* medium.h - extinction, phase functions, and the light that a ray gathers in closed form (method.md section 2). */
#ifndef TYNI_MEDIUM_H
#define TYNI_MEDIUM_H

#include "base.h"
#include "lanes/lanes.h"
#include "vec.h"
#include "view.h"

/* Below this extinction, 1/m, nothing is lost. */
#define TYNI_SIGMA_LEAST 1e-20f

/* The sum of scatter and absorb of all components, 1/m. */
void tyni_medium_extinction(const tyn_medium *media, int32_t count, float sigma[3]);

/* The components, ready to evaluate. */
typedef struct tyni_medium {
    float sigma[3];
    float isotropic[3]; /* scatter / (4 pi) of all isotropic ones */
    float rayleigh[3];  /* 3 / (16 pi) scatter */
    int32_t hg_count;
    struct {
        float scale[3]; /* (1 - g^2) / (4 pi) scatter */
        float g;
    } hg[TYN_MAX_MEDIA];
    float peak;   /* largest |g| */
    int backward; /* that g is negative */
    int scatters; /* any scatter > 0 */
    /* Two channels carry the visibility of all three: those of the least and the largest extinction. The third's lies at
     * `blend` between them. */
    int32_t low, high, middle;
    float blend;
} tyni_medium;

void tyni_medium_prepare(tyni_medium *medium, const tyn_medium *media, int32_t count);

/* mix[c] = sum over components of scatter[c] * p(cosine): what the medium scatters per metre and steradian. */
void tyni_medium_mix(const tyni_medium *medium, float cosine, float mix[3]);

#define TYNI_MEDIUM_KNOTS 33

/* The part of a ray that a light at a point can reach, by the angle psi under which the light sees it, from 0 at t0. With T = t
 * - (closest approach) and h the distance there, dt / r^2 = d psi / h (method.md section 2): the light's singularity is gone,
 * and what is left under the integral is smooth. Angles are taken from t0, not from the closest approach: small ones keep their
 * precision when the ray runs straight at the light. */
typedef struct tyni_path {
    float t0, t1;
    float near_t; /* t of the closest approach */
    float from;   /* T at t0 */
    float h;      /* at least the light's radius: the ray into the light stays finite */
    float span;   /* psi at t1, 0 .. pi */
} tyni_path;

/* The light gathered from t0 to t along one ray, if all of it were lit, in up to three channels:
 *   directional:    integral of e^(-sigma t); the phase function is constant and comes in at the pixel
 *   spot and point: integral of e^(-sigma (t + r)) mix(cos) / r^2; r is the distance to the light
 * The first is closed. The second is tabulated once per ray over psi by Simpson's rule and read by cubic Hermite interpolation,
 * for any phase function. */
typedef struct tyni_integral {
    int32_t channels[3];
    int32_t count; /* of channels */
    float sigma[3];
    float t0, t1; /* t1 <= t0: nothing is gathered */
    int local;    /* not directional */
    tyni_path path;
    /* Knots lie at equal steps of s, 0 .. 1, and psi = span * s^power: densest at the end where a peaked phase function has its
     * peak, forward at the start, backward (`reversed`) at the far end. */
    int32_t power, reversed;
    int32_t knots;
    float sum[3][TYNI_MEDIUM_KNOTS];   /* integral up to the knot */
    float value[3][TYNI_MEDIUM_KNOTS]; /* the integrand there, per knot */
} tyni_integral;

/* t0 .. t1 must lie inside the light's volume (tyni_view_clip). */
void tyni_integral_begin(tyni_integral *integral, const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v,
                         float t0, float t1, const int32_t *channels, int32_t count);

/* out[n]: from t0 to t. Never falls with t beyond rounding. */
void tyni_integral_at(const tyni_integral *integral, float t, float *out);

/* The same by the variable in which the integrand is smooth: psi for a local light, else t itself. For those who take many
 * steps. */
float tyni_integral_variable(const tyni_integral *integral, float t);
float tyni_integral_t(const tyni_integral *integral, float variable);
void tyni_integral_at_variable(const tyni_integral *integral, float variable, float *out);

/* A cheap stand-in for the whole integral that is exact for a directional light and smooth over the screen for a spot: radiance
 * is divided by it where it is sampled and multiplied by it at each pixel, so that only the smooth ratio is interpolated. All
 * three channels. */
void tyni_integral_norm(const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float t0, float t1,
                        float norm[3]);

/* The integrand per dt in all channels. */
void tyni_integral_density(const tyni_medium *medium, const tyni_lamp *lamp, const tyni_sight *v, float t, float density[3]);

#define TYNI_KERNEL "medium_kernel.h"
#include "lanes/each.h"

#endif
