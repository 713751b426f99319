/* model.c - see model.h */
#include "model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define RADIANS(degrees) ((degrees) * (PI / 180.0))

static void normalise(double v[3])
{
    double size = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= size;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

oracle_scene *model_new(int width, int height)
{
    oracle_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return NULL;
    scene->width = width;
    scene->height = height;
    model_camera(scene, 0, 0, 0, 0, 0, -1, 60, 0.1, 100);
    return scene;
}

void model_free(oracle_scene *scene)
{
    if (scene)
        oracle_release(scene);
    free(scene);
}

static void look(oracle_scene *scene, const double position[3], const double target[3], const double up[3], double fov,
                 double near_depth, double far_depth)
{
    oracle_camera *c = &scene->camera;
    memcpy(c->position, position, sizeof c->position);
    for (int k = 0; k < 3; k++)
        c->forward[k] = target[k] - position[k];
    normalise(c->forward);
    cross(c->forward, up, c->right);
    normalise(c->right);
    cross(c->right, c->forward, c->up);
    c->top_edge = tan(RADIANS(fov) / 2);
    c->right_edge = c->top_edge * scene->width / scene->height;
    c->bottom_edge = -c->top_edge;
    c->left_edge = -c->right_edge;
    c->near_depth = near_depth;
    c->far_depth = far_depth;
}

void model_camera(oracle_scene *scene, double px, double py, double pz, double tx, double ty, double tz, double fov_degrees,
                  double near_depth, double far_depth)
{
    const double position[3] = {px, py, pz}, target[3] = {tx, ty, tz}, up[3] = {0, 1, 0};
    look(scene, position, target, up, fov_degrees, near_depth, far_depth);
}

static void parallelogram(oracle_scene *scene, const double a[3], const double b[3], const double c[3], const double albedo[3])
{
    oracle_polygon *p = &scene->polygon[scene->polygons];
    if (scene->polygons >= ORACLE_POLYGONS) {
        fprintf(stderr, "more than %d polygons\n", ORACLE_POLYGONS);
        exit(1);
    }
    scene->polygons++;
    p->corners = 4;
    for (int k = 0; k < 3; k++) {
        p->corner[0][k] = a[k];
        p->corner[1][k] = b[k];
        p->corner[2][k] = b[k] + c[k] - a[k];
        p->corner[3][k] = c[k];
        p->albedo[k] = albedo[k];
    }
}

void model_quad(oracle_scene *scene, const double a[3], const double b[3], const double c[3], double albedo)
{
    const double grey[3] = {albedo, albedo, albedo};
    parallelogram(scene, a, b, c, grey);
}

static void box(oracle_scene *scene, const double low[3], const double high[3], const double albedo[3])
{
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        for (int side = 0; side < 2; side++) {
            double a[3], b[3], c[3];
            a[k] = b[k] = c[k] = side ? high[k] : low[k];
            a[u] = c[u] = low[u];
            b[u] = high[u];
            a[v] = b[v] = low[v];
            c[v] = high[v];
            parallelogram(scene, a, b, c, albedo);
        }
    }
}

void model_box(oracle_scene *scene, double x0, double y0, double z0, double x1, double y1, double z1, double albedo)
{
    const double low[3] = {x0, y0, z0}, high[3] = {x1, y1, z1}, grey[3] = {albedo, albedo, albedo};
    box(scene, low, high, grey);
}

void model_medium(oracle_scene *scene, double scatter, double absorb, double blue, tyn_phase phase, double g)
{
    oracle_medium *m = &scene->medium[scene->media++];
    for (int k = 0; k < 3; k++) {
        m->scatter[k] = k == 2 ? scatter * blue : scatter;
        m->absorb[k] = absorb;
    }
    m->phase = phase;
    m->g = g;
}

static oracle_light *new_light(oracle_scene *scene, oracle_kind kind)
{
    oracle_light *light = &scene->light[scene->lights++];
    light->kind = kind;
    return light;
}

static void set3(double v[3], double x, double y, double z)
{
    v[0] = x;
    v[1] = y;
    v[2] = z;
}

void model_sun(oracle_scene *scene, double dx, double dy, double dz, double irradiance)
{
    oracle_light *light = new_light(scene, ORACLE_DIRECTIONAL);
    set3(light->direction, dx, dy, dz);
    normalise(light->direction);
    set3(light->colour, irradiance, 0.9 * irradiance, 0.7 * irradiance);
}

void model_spot(oracle_scene *scene, double px, double py, double pz, double tx, double ty, double tz, double angle_degrees,
                double intensity)
{
    oracle_light *light = new_light(scene, ORACLE_SPOT);
    set3(light->position, px, py, pz);
    set3(light->direction, tx - px, ty - py, tz - pz);
    normalise(light->direction);
    light->cosine = cos(RADIANS(angle_degrees) / 2);
    set3(light->colour, intensity, 0.9 * intensity, 0.7 * intensity);
}

/* ---- files ---------------------------------------------------------------------------------------------------------- */

/* The numbers after a key, or 0. */
static int key(const char *line, const char *name, double *out, int count)
{
    size_t size = strlen(name);
    for (const char *at = strstr(line, name); at; at = strstr(at + 1, name)) {
        char *end = (char *)(at + size);
        if (at == line || at[-1] != ' ' || *end != ' ')
            continue;
        for (int i = 0; i < count; i++)
            out[i] = strtod(end, &end);
        return 1;
    }
    return 0;
}

static int read_medium(oracle_scene *scene, const char *line)
{
    oracle_medium *m = &scene->medium[scene->media++];
    if (!key(line, "scatter", m->scatter, 3))
        return 0;
    key(line, "absorb", m->absorb, 3);
    m->phase = strstr(line, "phase hg")         ? TYN_PHASE_HG
               : strstr(line, "phase rayleigh") ? TYN_PHASE_RAYLEIGH
                                                : TYN_PHASE_ISOTROPIC;
    return m->phase != TYN_PHASE_HG || key(line, "hg", &m->g, 1);
}

/* A binary PPM of 8 bits, linear; what the reference scenes have. */
static float *read_ppm(const char *path, int *width, int *height)
{
    FILE *file = fopen(path, "rb");
    float *rgb = NULL;
    if (file && fscanf(file, "P6 %d %d 255", width, height) == 2 && fgetc(file) != EOF) {
        size_t count = 3 * (size_t)*width * (size_t)*height;
        rgb = malloc(count * sizeof *rgb);
        for (size_t i = 0; rgb && i < count; i++)
            rgb[i] = (float)fgetc(file) / 255.0f;
    }
    if (file)
        fclose(file);
    return rgb;
}

/* "texture F.ppm", beside the scene file. */
static int read_texture(oracle_light *light, const char *line, const char *path)
{
    const char *name = strstr(line, " texture "), *slash = strrchr(path, '/');
    char full[1024];
    if (!name)
        return 1;
    snprintf(full, sizeof full, "%.*s%.*s", slash ? (int)(slash + 1 - path) : 0, path, (int)strcspn(name + 9, " "), name + 9);
    light->texture.rgb = read_ppm(full, &light->texture.width, &light->texture.height);
    light->texture.up[1] = 1;
    key(line, "up", light->texture.up, 3);
    return light->texture.rgb && (light->kind == ORACLE_SPOT || key(line, "extent", light->texture.extent, 2));
}

static int read_light(oracle_scene *scene, const char *line, const char *path)
{
    double target[3], angle;
    if (strncmp(line, "light directional ", 18) == 0) {
        oracle_light *light = new_light(scene, ORACLE_DIRECTIONAL);
        int read = key(line, "direction", light->direction, 3) && key(line, "irradiance", light->colour, 3);
        normalise(light->direction);
        return read && read_texture(light, line, path);
    }
    if (strncmp(line, "light point ", 12) == 0) {
        oracle_light *light = new_light(scene, ORACLE_POINT);
        return key(line, "position", light->position, 3) && key(line, "intensity", light->colour, 3);
    }
    if (strncmp(line, "light spot ", 11) == 0) {
        oracle_light *light = new_light(scene, ORACLE_SPOT);
        if (!key(line, "position", light->position, 3) || !key(line, "target", target, 3) || !key(line, "angle", &angle, 1))
            return 0;
        for (int k = 0; k < 3; k++)
            light->direction[k] = target[k] - light->position[k];
        normalise(light->direction);
        light->cosine = cos(RADIANS(angle) / 2);
        return key(line, "intensity", light->colour, 3) && read_texture(light, line, path);
    }
    return 0;
}

static int read_line(oracle_scene *scene, const char *line, const char *path)
{
    double a[3], b[3], c[3], albedo[3], up[3] = {0, 1, 0}, fov, reach[2];
    if (line[0] == '#' || line[0] == '\0' || strcmp(line, "tyndall-scene 1") == 0)
        return 1;
    if (strncmp(line, "image ", 6) == 0)
        return sscanf(line, "image %d %d", &scene->width, &scene->height) == 2;
    if (strncmp(line, "camera ", 7) == 0) {
        key(line, "up", up, 3);
        if (!key(line, "position", a, 3) || !key(line, "target", b, 3) || !key(line, "fov_y", &fov, 1) ||
            !key(line, "near", &reach[0], 1) || !key(line, "far", &reach[1], 1))
            return 0;
        look(scene, a, b, up, fov, reach[0], reach[1]);
        return 1;
    }
    if (strncmp(line, "background ", 11) == 0)
        return sscanf(line, "background %lf %lf %lf", scene->background, scene->background + 1, scene->background + 2) == 3;
    if (strncmp(line, "ambient ", 8) == 0)
        return sscanf(line, "ambient %lf %lf %lf", scene->ambient, scene->ambient + 1, scene->ambient + 2) == 3;
    if (strncmp(line, "medium ", 7) == 0)
        return read_medium(scene, line);
    if (strncmp(line, "light ", 6) == 0)
        return read_light(scene, line, path);
    if (strncmp(line, "quad ", 5) == 0 && key(line, "a", a, 3) && key(line, "b", b, 3) && key(line, "c", c, 3) &&
        key(line, "albedo", albedo, 3)) {
        parallelogram(scene, a, b, c, albedo);
        return 1;
    }
    if (strncmp(line, "box ", 4) == 0 && key(line, "min", a, 3) && key(line, "max", b, 3) && key(line, "albedo", albedo, 3)) {
        box(scene, a, b, albedo);
        return 1;
    }
    return 0;
}

oracle_scene *model_read(const char *path)
{
    char line[512];
    FILE *file = fopen(path, "r");
    oracle_scene *scene = model_new(1, 1);
    while (file && scene && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\r\n")] = '\0';
        if (!read_line(scene, line, path)) {
            fprintf(stderr, "%s: %s: not for these tests\n", path, line);
            model_free(scene);
            scene = NULL;
        }
    }
    if (file)
        fclose(file);
    return scene;
}

float *model_read_pfm(const char *path, int *width, int *height, int *channels)
{
    char kind;
    float scale, *pixels = NULL;
    size_t row, rows;
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    if (fscanf(file, "P%c %d %d %f", &kind, width, height, &scale) == 4 && fgetc(file) == '\n' && *width > 0 && *height > 0) {
        *channels = kind == 'F' ? 3 : 1;
        row = (size_t)*width * (size_t)*channels;
        rows = (size_t)*height;
        pixels = malloc(row * rows * sizeof *pixels);
        for (size_t y = rows; pixels && y-- > 0;)
            for (size_t x = 0; x < row; x++) {
                unsigned char b[4] = {0, 0, 0, 0};
                uint32_t bits;
                size_t got = fread(b, 1, 4, file);
                bits = got < 4 ? 0x7fc00000u /* a short file is full of NaN */
                               : (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
                memcpy(&pixels[y * row + x], &bits, 4);
            }
    }
    fclose(file);
    return pixels;
}
