/* parse.c - what scene files alone have: surfaces and their light. The rest is in directives.c. */
#include "parse.h"
#include "directives.h"
#include "file.h"
#include "obj.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

static int read_camera(parser *p)
{
    float degrees = 0.0f;
    key keys[] = {CAMERA_KEYS(&p->s->camera, &degrees)};
    if (directive_once(p, &p->cameras) != 0 || READ_KEYS(p, keys) != 0)
        return -1;
    return directive_camera_look(p, &p->s->camera, keys, degrees);
}

static int read_colour(parser *p, int *count, float out[3])
{
    if (directive_once(p, count) != 0 || keys_numbers(&p->t, p->directive, 3, NOT_NEGATIVE, out) != 0)
        return -1;
    return directive_end(p);
}

/* scale, then rotate about an axis through the origin (counter-clockwise as seen against it), then translate */
static void set_place(obj_place *place, float scale, const float rotate[4], const float translate[3])
{
    double axis[3] = {(double)rotate[0], (double)rotate[1], (double)rotate[2]}, l = vector_length(axis);
    double angle = (double)rotate[3] * DEGREE, c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++) {
        place->translate[i] = (double)translate[i];
        for (int k = 0; k < 3; k++)
            place->matrix[i][k] = (double)scale * ((1.0 - c) * axis[i] / l * axis[k] / l + (i == k ? c : 0.0));
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        place->matrix[j][i] += (double)scale * s * axis[k] / l;
        place->matrix[i][j] -= (double)scale * s * axis[k] / l;
    }
}

static int read_mesh(parser *p)
{
    obj_place place;
    float albedo[3] = {0.7f, 0.7f, 0.7f}, translate[3] = {0}, rotate[4] = {0.0f, 1.0f, 0.0f, 0.0f}, scale = 1.0f;
    token name;
    char *path;
    int result;
    key keys[] = {KEY("albedo", NUMBERS, 3, UNIT, 0, albedo), KEY("translate", NUMBERS, 3, ANY, 0, translate),
                  KEY("scale", NUMBERS, 1, POSITIVE, 0, &scale), KEY("rotate", NUMBERS, 4, ANY, 0, rotate)};
    if (!text_token(&p->t, &name))
        return text_fail(&p->t, p->directive, "a file name is missing after it");
    if (READ_KEYS(p, keys) != 0)
        return -1;
    if (vector_is_zero(rotate))
        return text_fail(&p->t, keys[3].at, "the axis has length 0");
    set_place(&place, scale, rotate, translate);
    memcpy(place.albedo, albedo, sizeof albedo);
    path = file_beside(p->t.file, name.start, name.length);
    if (!path)
        return error_memory(p->t.error);
    result = obj_load(p->s, path, &place, &p->textures, p->t.error);
    if (result != 0)
        error_wrap(p->t.error, p->t.file, p->t.line, name.start, name.length);
    free(path);
    return result;
}

static int read_quad(parser *p)
{
    float a[3], b[3], c[3], albedo[3];
    key keys[] = {KEY("a", NUMBERS, 3, ANY, 1, a), KEY("b", NUMBERS, 3, ANY, 1, b), KEY("c", NUMBERS, 3, ANY, 1, c),
                  KEY("albedo", NUMBERS, 3, UNIT, 1, albedo)};
    if (READ_KEYS(p, keys) != 0)
        return -1;
    for (int i = 0; i < 3; i++)
        if (!isfinite(b[i] + c[i] - a[i]))
            return text_fail(&p->t, p->directive, "its fourth corner is out of a float's range");
    return scene_add_quad(p->s, a, b, c, albedo) == 0 ? 0 : error_memory(p->t.error);
}

static int read_box(parser *p)
{
    float min[3], max[3], albedo[3];
    key keys[] = {KEY("min", NUMBERS, 3, ANY, 1, min), KEY("max", NUMBERS, 3, ANY, 1, max),
                  KEY("albedo", NUMBERS, 3, UNIT, 1, albedo)};
    if (READ_KEYS(p, keys) != 0)
        return -1;
    for (int i = 0; i < 3; i++)
        if (min[i] > max[i])
            return text_fail(&p->t, keys[0].at, "min is above max in %c", "xyz"[i]);
    return scene_add_box(p->s, min, max, albedo) == 0 ? 0 : error_memory(p->t.error);
}

static int read_directive(parser *p)
{
    token d = p->directive;
    if (token_is(d, "image"))
        return directive_image(p);
    if (token_is(d, "camera"))
        return read_camera(p);
    if (token_is(d, "background"))
        return read_colour(p, &p->backgrounds, p->s->background);
    if (token_is(d, "ambient"))
        return read_colour(p, &p->ambients, p->s->ambient);
    if (token_is(d, "medium"))
        return directive_medium(p);
    if (token_is(d, "light"))
        return directive_light(p);
    if (token_is(d, "mesh"))
        return read_mesh(p);
    if (token_is(d, "quad"))
        return read_quad(p);
    if (token_is(d, "box"))
        return read_box(p);
    return text_fail(&p->t, d, "unknown directive");
}

static int read_scene(parser *p)
{
    if (directives_read(p, "tyndall-scene", read_directive) != 0)
        return -1;
    if (!p->images)
        return directives_missing(p, "image");
    if (!p->cameras)
        return directives_missing(p, "camera");
    return p->backgrounds ? 0 : directives_missing(p, "background");
}

int scene_load(scene *s, const char *path, tool_error *error)
{
    parser p;
    int result;
    memset(&p, 0, sizeof p);
    scene_init(s);
    error->text[0] = '\0';
    p.s = s;
    if (text_open(&p.t, path, TEXT_SCENE, error) != 0)
        return -1;
    result = read_scene(&p);
    text_close(&p.t);
    texture_cache_free(&p.textures);
    if (result != 0)
        scene_free(s);
    return result;
}
