/* test_oracle.c - the oracle against closed forms, against brute force, and against truth that others computed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "model.h"
#include "test.h"

#define PI 3.14159265358979323846

static double isotropic_inscatter(double sigma, double scatter, double light, double s)
{
    return light * scatter / (4 * PI) * (sigma > 0 ? -expm1(-sigma * s) / sigma : s);
}

static void test_closed_sun(void)
{
    static const double sigmas[] = {0.0, 1e-9, 0.01, 0.5, 20.0};
    TEST("oracle: a sun without occluders is (1 - exp(-sigma s)) / sigma");
    for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas; i++) {
        double v[3], out[3], scatter = i == 0 ? 0.0 : 0.75 * sigmas[i];
        oracle_scene *scene = model_new(8, 8);
        model_medium(scene, scatter, sigmas[i] - scatter, 1.0, TYN_PHASE_ISOTROPIC, 0);
        model_sun(scene, 0.3, -1, 0.2, 7);
        CHECK(oracle_prepare(scene));
        oracle_ray(scene, 1.5, 6.5, v);
        oracle_scatter(scene, v, 13.0, out);
        CHECK_NEAR(out[0], isotropic_inscatter(sigmas[i], scatter, 7, 13), 1e-12 * out[0]);
        CHECK_NEAR(out[2], 0.7 * out[0], 1e-12 * out[0]);
        model_free(scene);
    }
}

static void test_closed_spot(void)
{
    double v[3], out[3], to[3], foot, h, from, end, angle = 0;
    oracle_scene *scene = model_new(64, 64);
    TEST("oracle: a lamp in air that only scatters is (phi_b - phi_a) / h");
    /* Scattering without extinction does not exist, so it is taken to almost nothing. */
    model_medium(scene, 1e-9, 0, 1.0, TYN_PHASE_ISOTROPIC, 0);
    model_spot(scene, 2, 5, -10, 0, 0, -12, 160, 30);
    CHECK(oracle_prepare(scene));
    for (int i = 0; i < 64; i += 9) {
        oracle_ray(scene, i + 0.5, 40.5, v);
        oracle_scatter(scene, v, 60.0, out);
        for (int k = 0; k < 3; k++)
            to[k] = scene->light[0].position[k];
        foot = to[0] * v[0] + to[1] * v[1] + to[2] * v[2];
        h = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2] - foot * foot);
        /* The cone's ends by bisection on its own definition, not by the oracle's root formula. */
        for (int side = 0; side < 2; side++) {
            double in = foot, edge = side ? 60.0 : 0.0;
            for (int n = 0; n < 200; n++) {
                double t = 0.5 * (in + edge), p[3] = {t * v[0], t * v[1], t * v[2]};
                if (oracle_lit(scene, &scene->light[0], p, -1))
                    in = t;
                else
                    edge = t;
            }
            angle = atan((edge - foot) / h) - (side ? angle : 0);
        }
        CHECK_NEAR(out[0], 30 * 1e-9 / (4 * PI) * angle / h, 1e-6 * out[0]);
    }
    model_free(scene);
    scene = model_new(64, 64);
    /* Rayleigh, whole ray from minus to plus infinity: the integral over pi / h of (1 + sin2) is 3 pi / 2. */
    model_medium(scene, 1e-12, 0, 1.0, TYN_PHASE_RAYLEIGH, 0);
    model_spot(scene, 1e6, 1, 0, 1e6, 0, 0, 60, 1);
    scene->light[0].kind = ORACLE_POINT;
    model_camera(scene, 0, 0, 0, 1, 0, 0, 60, 0.1, 1e7);
    CHECK(oracle_prepare(scene));
    v[0] = 1, v[1] = v[2] = 0;
    oracle_scatter(scene, v, 2e6, out);
    from = 1e-12 * 3 / (16 * PI) * 1.5 * PI;
    end = out[0];
    CHECK_NEAR(end / from, 1.0, 1e-5);
    model_free(scene);
}

/* A court of posts, a lintel and a slanted board, with a sun and a lamp in hazy air. */
static oracle_scene *court(void)
{
    const double a[3] = {-3, 0.5, -9}, b[3] = {2, 3.5, -8}, c[3] = {-3, 2.5, -5};
    oracle_scene *scene = model_new(64, 48);
    model_camera(scene, 0.2, 1.5, 4, 0, 1.8, -6, 60, 0.1, 40);
    model_box(scene, -40, -1, -40, 40, 0, 40, 0.5);
    for (int i = -3; i <= 3; i++)
        model_box(scene, i * 1.1, 0, -5, i * 1.1 + 0.3, 3, -4.6, 0.4);
    model_box(scene, -4, 3, -5.2, 4, 3.4, -4.4, 0.6);
    model_quad(scene, a, b, c, 0.5);
    model_medium(scene, 0.04, 0.002, 1.3, TYN_PHASE_HG, 0.5);
    model_medium(scene, 0.02, 0, 2.0, TYN_PHASE_RAYLEIGH, 0);
    model_sun(scene, 0.25, -0.6, 1, 8);
    model_spot(scene, -3, 5, -7, 1, 0, -2, 70, 90);
    return scene;
}

static void test_brute(void)
{
    enum { STEPS = 20000 };
    oracle_scene *scene = court();
    double gap = 0, sum = 0;
    TEST("oracle: intervals and quadrature against a march with traced shadow rays");
    CHECK(oracle_prepare(scene));
    for (int n = 0; n < 12; n++) {
        double x = (double)test_random_float(0, 64), y = (double)test_random_float(0, 48), v[3], brute[3] = {0, 0, 0}, s;
        oracle_pixel pixel;
        oracle_trace(scene, x, y, &pixel);
        oracle_ray(scene, x, y, v);
        s = pixel.depth / (v[0] * scene->camera.forward[0] + v[1] * scene->camera.forward[1] + v[2] * scene->camera.forward[2]);
        for (int i = 0; i < STEPS; i++) {
            double t = s * (i + 0.5) / STEPS, p[3];
            for (int k = 0; k < 3; k++)
                p[k] = scene->camera.position[k] + t * v[k];
            for (int l = 0; l < scene->lights; l++) {
                const oracle_light *light = &scene->light[l];
                double way[3], size, cosine;
                if (!oracle_lit(scene, light, p, -1))
                    continue;
                for (int k = 0; k < 3; k++)
                    way[k] = light->kind == ORACLE_DIRECTIONAL ? light->direction[k] : p[k] - light->position[k];
                size = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
                cosine = -(way[0] * v[0] + way[1] * v[1] + way[2] * v[2]) / size;
                for (int k = 0; k < 3; k++)
                    for (int m = 0; m < scene->media; m++) {
                        double sigma = oracle_extinction(scene, k);
                        brute[k] += exp(-sigma * t) * oracle_irradiance(light, p, sigma, k) * scene->medium[m].scatter[k] *
                                    oracle_phase(&scene->medium[m], cosine) * s / STEPS;
                    }
            }
        }
        for (int k = 0; k < 3; k++) {
            gap += fabs(brute[k] - pixel.scatter[k]);
            sum += pixel.scatter[k];
        }
    }
    CHECK_NEAR(gap / sum, 0.0, 3e-4); /* a march of 20000 steps is off by half a step at each transition */
    model_free(scene);
}

static void test_phase(void)
{
    static const oracle_medium media[] = {{{0}, {0}, TYN_PHASE_ISOTROPIC, 0},
                                          {{0}, {0}, TYN_PHASE_RAYLEIGH, 0},
                                          {{0}, {0}, TYN_PHASE_HG, 0.76},
                                          {{0}, {0}, TYN_PHASE_HG, -0.4}};
    TEST("oracle: phase functions integrate to 1 over the sphere");
    for (size_t m = 0; m < sizeof media / sizeof *media; m++) {
        double sum = 0;
        for (int i = 0; i < 100000; i++)
            sum += oracle_phase(&media[m], -1 + (i + 0.5) / 50000) / 50000;
        CHECK_NEAR(2 * PI * sum, 1.0, 1e-6);
    }
}

/* Every step-th pixel each way, from a corner of its own per scene. */
static void test_reference(const char *name, int from, int step)
{
    char path[128];
    int width, height, channels, count = 0, wrong_depth = 0;
    double gap = 0, sum = 0, radiance_gap = 0, radiance_sum = 0;
    const char *full;
    oracle_scene *scene = NULL;
    float *scatter = NULL, *radiance = NULL, *depth = NULL;
    snprintf(path, sizeof path, "reference/%s.scene", name);
    if ((full = test_shared(path)) == NULL)
        return;
    scene = model_read(full);
    snprintf(path, sizeof path, "reference/%s.depth.pfm", name);
    if ((full = test_shared(path)) != NULL)
        depth = model_read_pfm(full, &width, &height, &channels);
    snprintf(path, sizeof path, "reference/%s.radiance.pfm", name);
    if ((full = test_shared(path)) != NULL)
        radiance = model_read_pfm(full, &width, &height, &channels);
    snprintf(path, sizeof path, "reference/%s.scatter.pfm", name);
    if ((full = test_shared(path)) != NULL)
        scatter = model_read_pfm(full, &width, &height, &channels);
    CHECK(scene && scatter && radiance && depth && oracle_prepare(scene));
    if (scene && scene->scratch && scatter && radiance && depth) {
        CHECK(width == scene->width && height == scene->height && channels == 3);
        for (int y = from; y < height; y += step)
            for (int x = from; x < width; x += step) {
                oracle_pixel pixel;
                int at = y * width + x;
                oracle_trace(scene, x + 0.5, y + 0.5, &pixel);
                count++;
                wrong_depth += fabs(pixel.depth - (double)depth[at]) > 1e-5 * pixel.depth;
                for (int k = 0; k < 3; k++) {
                    double whole = pixel.scatter[k] + pixel.extinct[k] * pixel.surface[k];
                    gap += fabs(pixel.scatter[k] - (double)scatter[3 * at + k]);
                    sum += (double)scatter[3 * at + k];
                    radiance_gap += fabs(whole - (double)radiance[3 * at + k]);
                    radiance_sum += (double)radiance[3 * at + k];
                }
            }
        CHECK(count > 1000);
        CHECK_NEAR(gap / sum, 0.0, 2e-6);
        CHECK_NEAR(radiance_gap / radiance_sum, 0.0, 1e-5);
        CHECK_NEAR(wrong_depth, 0, 2);
    }
    free(scatter);
    free(radiance);
    free(depth);
    model_free(scene);
}

void test_oracle(void)
{
    test_closed_sun();
    test_closed_spot();
    test_phase();
    test_brute();
    TEST("oracle: reference 01_pillars");
    test_reference("01_pillars", 2, 5);
    TEST("oracle: reference 02_grating");
    test_reference("02_grating", 3, 5);
    TEST("oracle: reference 05_stained");
    test_reference("05_stained", 4, 11);
    TEST("oracle: reference 07_cage");
    test_reference("07_cage", 1, 5);
}
