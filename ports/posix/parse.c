/* parse.c - each directive is a table of its keys; read_keys does what all have in common. */
#include "parse.h"
#include "file.h"
#include "obj.h"
#include "pnm.h"
#include "text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

typedef enum range { ANY, NOT_NEGATIVE, UNIT, POSITIVE, BELOW_180, BELOW_170 } range;
typedef enum kind { NUMBERS, FILE_NAME, PHASE } kind;

typedef struct key {
    const char *name;
    kind kind;
    int count; /* of numbers */
    range range;
    int required;
    float *numbers; /* holds the default */
    /* What was found: */
    int seen;
    token at, word; /* the key; the file name, or the phase */
} key;

#define KEY(name, kind, count, range, required, numbers)                                                                       \
    {                                                                                                                          \
        name, kind, count, range, required, numbers, 0, {NULL, 0},                                                             \
        {                                                                                                                      \
            NULL, 0                                                                                                            \
        }                                                                                                                      \
    }

typedef struct parser {
    text t;
    scene *s;
    texture_cache textures;
    token directive;
    int images, cameras, backgrounds, ambients;
} parser;

static int check_range(text *t, token at, float x, range r)
{
    static const char *const words[] = {"",
                                        "must be 0 or more",
                                        "must be from 0 to 1",
                                        "must be above 0",
                                        "must be between 0 and 180",
                                        "must be between 0 and 170"};
    int good = 1;
    switch (r) {
    case ANY:
        break;
    case NOT_NEGATIVE:
        good = x >= 0.0f;
        break;
    case UNIT:
        good = x >= 0.0f && x <= 1.0f;
        break;
    case POSITIVE:
        good = x > 0.0f;
        break;
    case BELOW_180:
        good = x > 0.0f && x < 180.0f;
        break;
    case BELOW_170:
        good = x > 0.0f && x < 170.0f;
        break;
    }
    return good ? 0 : text_fail(t, at, "%s", words[r]);
}

static int read_numbers(text *t, token of, int count, range r, float *out)
{
    for (int i = 0; i < count; i++) {
        text ahead = *t;
        token number;
        text_token(&ahead, &number);
        if (text_number(t, of, &out[i]) != 0 || check_range(t, number, out[i], r) != 0)
            return -1;
    }
    return 0;
}

/* isotropic, rayleigh or hg G */
static int read_phase(text *t, key *k)
{
    if (!text_token(t, &k->word))
        return text_fail(t, k->at, "a phase function is missing after it");
    if (token_is(k->word, "isotropic") || token_is(k->word, "rayleigh"))
        return 0;
    if (!token_is(k->word, "hg"))
        return text_fail(t, k->word, "is no phase function (isotropic, rayleigh, hg G)");
    text ahead = *t;
    token number;
    text_token(&ahead, &number);
    if (text_number(t, k->word, k->numbers) != 0)
        return -1;
    if (!(k->numbers[0] > -1.0f && k->numbers[0] < 1.0f))
        return text_fail(t, number, "G must be between -1 and 1");
    return 0;
}

static int read_keys(parser *p, key *keys, size_t count)
{
    text *t = &p->t;
    token word;
    while (text_token(t, &word)) {
        key *k = NULL;
        for (size_t i = 0; i < count; i++)
            if (token_is(word, keys[i].name))
                k = &keys[i];
        if (!k)
            return text_fail(t, word, "unknown key, or a token too many");
        if (k->seen)
            return text_fail(t, word, "given twice");
        k->seen = 1;
        k->at = word;
        if (k->kind == NUMBERS && read_numbers(t, word, k->count, k->range, k->numbers) != 0)
            return -1;
        if (k->kind == FILE_NAME && !text_token(t, &k->word))
            return text_fail(t, word, "a file name is missing after it");
        if (k->kind == PHASE && read_phase(t, k) != 0)
            return -1;
    }
    for (size_t i = 0; i < count; i++)
        if (keys[i].required && !keys[i].seen)
            return text_fail(t, p->directive, "missing key '%s'", keys[i].name);
    return 0;
}

#define READ_KEYS(parser, keys) read_keys(parser, keys, sizeof(keys) / sizeof *(keys))

static int at_end(parser *p)
{
    token extra;
    return text_token(&p->t, &extra) ? text_fail(&p->t, extra, "one token too many") : 0;
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void difference(const float a[3], const float b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i] - (double)b[i];
}

static int is_zero(const float v[3])
{
    return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f;
}

/* Beyond rounding: parallel within a ten thousandth of a degree. */
static int parallel(const double a[3], const float b[3])
{
    double c[3], wide[3] = {(double)b[0], (double)b[1], (double)b[2]};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * wide[k] - a[k] * wide[j];
    }
    return length(c) <= 1e-6 * length(a) * length(wide);
}

/* ---- directives ----------------------------------------------------------------------------------------------------- */

static int once(parser *p, int *count)
{
    return ++*count > 1 ? text_fail(&p->t, p->directive, "given twice") : 0;
}

static int read_image(parser *p)
{
    int32_t *size[2] = {&p->s->width, &p->s->height};
    if (once(p, &p->images) != 0)
        return -1;
    for (int i = 0; i < 2; i++) {
        text ahead = p->t;
        token number;
        float value;
        text_token(&ahead, &number);
        if (text_number(&p->t, p->directive, &value) != 0)
            return -1;
        if (!(value >= 1.0f && value <= (float)TYN_MAX_SIZE) || value > floorf(value))
            return text_fail(&p->t, number, "must be a whole number from 1 to 32768");
        *size[i] = (int32_t)value;
    }
    return at_end(p);
}

/* The library squares these vectors in float; what only points somewhere gets a length that can bear it. */
static void settle_camera(scene_camera *c, const double forward[3])
{
    double up[3], up_length, distance = length(forward), wanted = distance;
    for (int i = 0; i < 3; i++)
        up[i] = (double)c->up[i];
    up_length = length(up);
    if (distance > 1e15)
        wanted = 1e12;
    if (distance < 1e-15)
        wanted = 1.0;
    for (int i = 0; i < 3; i++) {
        c->up[i] = (float)(up[i] / up_length);
        if (wanted < distance || wanted > distance)
            c->target[i] = (float)((double)c->position[i] + forward[i] / distance * wanted);
    }
}

static int read_camera(parser *p)
{
    scene_camera *c = &p->s->camera;
    float degrees = 0.0f;
    double forward[3];
    key keys[] = {KEY("position", NUMBERS, 3, ANY, 1, c->position),
                  KEY("target", NUMBERS, 3, ANY, 1, c->target),
                  KEY("up", NUMBERS, 3, ANY, 0, c->up),
                  KEY("fov_y", NUMBERS, 1, BELOW_180, 1, &degrees),
                  KEY("near", NUMBERS, 1, POSITIVE, 1, &c->near_depth),
                  KEY("far", NUMBERS, 1, POSITIVE, 1, &c->far_depth)};
    if (once(p, &p->cameras) != 0 || READ_KEYS(p, keys) != 0)
        return -1;
    c->line = p->t.line;
    c->fov_y = (float)((double)degrees * DEGREE);
    difference(c->target, c->position, forward);
    if (!(length(forward) > 0.0))
        return text_fail(&p->t, keys[1].at, "the target is at the position");
    if (is_zero(c->up))
        return text_fail(&p->t, keys[2].at, "has length 0");
    if (parallel(forward, c->up))
        return text_fail(&p->t, keys[2].seen ? keys[2].at : p->directive, "up is parallel to the view");
    if (!(c->near_depth < c->far_depth))
        return text_fail(&p->t, keys[5].at, "must be beyond near");
    settle_camera(c, forward);
    return 0;
}

static int read_colour(parser *p, int *count, float out[3])
{
    if (once(p, count) != 0 || read_numbers(&p->t, p->directive, 3, NOT_NEGATIVE, out) != 0)
        return -1;
    return at_end(p);
}

static int read_medium(parser *p)
{
    tyn_medium m;
    memset(&m, 0, sizeof m);
    key keys[] = {KEY("scatter", NUMBERS, 3, NOT_NEGATIVE, 1, m.scatter), KEY("absorb", NUMBERS, 3, NOT_NEGATIVE, 0, m.absorb),
                  KEY("phase", PHASE, 0, ANY, 1, &m.g)};
    if (READ_KEYS(p, keys) != 0)
        return -1;
    m.phase = token_is(keys[2].word, "hg")         ? TYN_PHASE_HG
              : token_is(keys[2].word, "rayleigh") ? TYN_PHASE_RAYLEIGH
                                                   : TYN_PHASE_ISOTROPIC;
    if (scene_add_medium(p->s, &m) != 0)
        return text_fail(&p->t, p->directive, "more than %d phase functions are not supported", TYN_MAX_MEDIA);
    return 0;
}

static tyn_image *read_texture(parser *p, token name)
{
    text *t = &p->t;
    tyn_image *image;
    char *path = file_beside(t->file, name.start, name.length);
    if (!path) {
        error_memory(t->error);
        return NULL;
    }
    image = texture_load(&p->textures, p->s, path, 0, t->error);
    free(path);
    if (!image)
        error_wrap(t->error, t->file, t->line, name.start, name.length);
    return image;
}

static void set_direction(scene_light *light, const double v[3])
{
    double l = length(v);
    for (int i = 0; i < 3; i++)
        light->light.direction[i] = (float)(v[i] / l);
}

static int add_light(parser *p, const scene_light *light)
{
    if (scene_add_light(p->s, light) != 0)
        return text_fail(&p->t, p->directive, "more than %d lights are not supported", TYN_MAX_LIGHTS);
    return 0;
}

static int read_directional(parser *p, scene_light *light)
{
    float direction[3], zero[3] = {0.0f, 0.0f, 0.0f};
    double way[3];
    key keys[] = {KEY("direction", NUMBERS, 3, ANY, 1, direction),
                  KEY("irradiance", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour),
                  KEY("texture", FILE_NAME, 0, ANY, 0, NULL), KEY("extent", NUMBERS, 2, POSITIVE, 0, light->extent),
                  KEY("up", NUMBERS, 3, ANY, 0, light->texture_up)};
    if (READ_KEYS(p, keys) != 0)
        return -1;
    for (int i = 2; i < 5; i++)
        if (!keys[i].seen && (keys[2].seen || keys[3].seen || keys[4].seen))
            return text_fail(&p->t, p->directive, "missing key '%s': texture, extent and up go together", keys[i].name);
    if (is_zero(direction))
        return text_fail(&p->t, keys[0].at, "has length 0");
    difference(direction, zero, way);
    light->light.kind = TYN_LIGHT_DIRECTIONAL;
    set_direction(light, way);
    if (keys[2].seen) {
        if (is_zero(light->texture_up))
            return text_fail(&p->t, keys[4].at, "has length 0");
        if (parallel(way, light->texture_up))
            return text_fail(&p->t, keys[4].at, "up is parallel to the direction");
        light->texture = read_texture(p, keys[2].word);
        if (!light->texture)
            return -1;
    }
    return add_light(p, light);
}

static int read_spot(parser *p, scene_light *light)
{
    float target[3], degrees = 0.0f;
    double way[3];
    key keys[] = {KEY("position", NUMBERS, 3, ANY, 1, light->light.position),
                  KEY("target", NUMBERS, 3, ANY, 1, target),
                  KEY("angle", NUMBERS, 1, BELOW_170, 1, &degrees),
                  KEY("intensity", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour),
                  KEY("texture", FILE_NAME, 0, ANY, 0, NULL),
                  KEY("up", NUMBERS, 3, ANY, 0, light->texture_up)};
    light->texture_up[1] = 1.0f;
    if (READ_KEYS(p, keys) != 0)
        return -1;
    difference(target, light->light.position, way);
    if (!(length(way) > 0.0))
        return text_fail(&p->t, keys[1].at, "the target is at the position");
    if (is_zero(light->texture_up))
        return text_fail(&p->t, keys[5].at, "has length 0");
    light->light.kind = TYN_LIGHT_SPOT;
    light->light.angle = (float)((double)degrees * DEGREE);
    set_direction(light, way);
    if (keys[4].seen) {
        if (parallel(way, light->texture_up)) /* without a texture an up has no meaning */
            return text_fail(&p->t, keys[5].seen ? keys[5].at : p->directive, "up is parallel to the axis");
        light->texture = read_texture(p, keys[4].word);
        if (!light->texture)
            return -1;
    }
    return add_light(p, light);
}

static int read_point(parser *p, scene_light *light)
{
    key keys[] = {KEY("position", NUMBERS, 3, ANY, 1, light->light.position),
                  KEY("intensity", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour)};
    light->point = 1;
    return READ_KEYS(p, keys) == 0 ? add_light(p, light) : -1;
}

static int read_light(parser *p)
{
    scene_light light;
    token sort;
    memset(&light, 0, sizeof light);
    light.line = p->t.line;
    if (!text_token(&p->t, &sort))
        return text_fail(&p->t, p->directive, "a kind is missing after it (directional, spot, point)");
    if (token_is(sort, "directional"))
        return read_directional(p, &light);
    if (token_is(sort, "spot"))
        return read_spot(p, &light);
    if (token_is(sort, "point"))
        return read_point(p, &light);
    return text_fail(&p->t, sort, "is no kind of light (directional, spot, point)");
}

/* scale, then rotate about an axis through the origin (counter-clockwise as seen against it), then translate */
static void set_place(obj_place *place, float scale, const float rotate[4], const float translate[3])
{
    double axis[3] = {(double)rotate[0], (double)rotate[1], (double)rotate[2]}, l = length(axis);
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
    if (is_zero(rotate))
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
        return read_image(p);
    if (token_is(d, "camera"))
        return read_camera(p);
    if (token_is(d, "background"))
        return read_colour(p, &p->backgrounds, p->s->background);
    if (token_is(d, "ambient"))
        return read_colour(p, &p->ambients, p->s->ambient);
    if (token_is(d, "medium"))
        return read_medium(p);
    if (token_is(d, "light"))
        return read_light(p);
    if (token_is(d, "mesh"))
        return read_mesh(p);
    if (token_is(d, "quad"))
        return read_quad(p);
    if (token_is(d, "box"))
        return read_box(p);
    if (token_is(d, "tyndall-scene"))
        return text_fail(&p->t, d, "given twice");
    return text_fail(&p->t, d, "unknown directive");
}

static int missing(parser *p, const char *name)
{
    token at = {name, strlen(name)};
    if (p->t.line == 0)
        p->t.line = 1;
    return text_fail(&p->t, at, "missing in this scene");
}

static int read_scene(parser *p)
{
    int first = 1;
    while (text_line(&p->t)) {
        token version;
        if (!text_token(&p->t, &p->directive))
            continue;
        if (!first) {
            if (read_directive(p) != 0)
                return -1;
            continue;
        }
        first = 0;
        if (!token_is(p->directive, "tyndall-scene"))
            return text_fail(&p->t, p->directive, "the first directive must be 'tyndall-scene 1'");
        if (!text_token(&p->t, &version))
            return text_fail(&p->t, p->directive, "a version is missing after it");
        if (!token_is(version, "1"))
            return text_fail(&p->t, version, "unknown version of the scene format: only 1 is known");
        if (at_end(p) != 0)
            return -1;
    }
    if (first)
        return missing(p, "tyndall-scene");
    if (!p->images)
        return missing(p, "image");
    if (!p->cameras)
        return missing(p, "camera");
    if (!p->backgrounds)
        return missing(p, "background");
    return 0;
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
