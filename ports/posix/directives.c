/* directives.c */
#include "directives.h"
#include "file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

int directive_end(parser *p)
{
    token extra;
    return text_token(&p->t, &extra) ? text_fail(&p->t, extra, "one token too many") : 0;
}

int directive_once(parser *p, int *count)
{
    return ++*count > 1 ? text_fail(&p->t, p->directive, "given twice") : 0;
}

int directive_image(parser *p)
{
    int32_t *size[2] = {&p->s->width, &p->s->height};
    if (directive_once(p, &p->images) != 0)
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
    return directive_end(p);
}

/* The library squares these vectors in float; what only points somewhere gets a length that can bear it. */
static void settle_camera(scene_camera *c, const double forward[3])
{
    double up[3], up_length, distance = vector_length(forward), wanted = distance;
    for (int i = 0; i < 3; i++)
        up[i] = (double)c->up[i];
    up_length = vector_length(up);
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

int directive_camera_look(parser *p, scene_camera *c, const key *keys, float degrees)
{
    double forward[3];
    c->line = p->t.line;
    c->fov_y = (float)((double)degrees * DEGREE);
    vector_difference(c->target, c->position, forward);
    if (!(vector_length(forward) > 0.0))
        return text_fail(&p->t, keys[1].at, "the target is at the position");
    if (vector_is_zero(c->up))
        return text_fail(&p->t, keys[2].at, "has length 0");
    if (vector_parallel(forward, c->up))
        return text_fail(&p->t, keys[2].seen ? keys[2].at : p->directive, "up is parallel to the view");
    if (!(c->near_depth < c->far_depth))
        return text_fail(&p->t, keys[5].at, "must be beyond near");
    settle_camera(c, forward);
    return 0;
}

int directive_medium(parser *p)
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

tyn_image *directive_texture(parser *p, token name)
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

/* What a frame file holds was made of length 1 by somebody: another division would turn it by a rounding. */
static void set_direction(const parser *p, scene_light *light, const double v[3])
{
    double l = vector_length(v);
    if (p->frame && fabs(l - 1.0) < 1e-6)
        l = 1.0;
    for (int i = 0; i < 3; i++)
        light->light.direction[i] = (float)(v[i] / l);
}

static int add_light(parser *p, const scene_light *light)
{
    if (scene_add_light(p->s, light) != 0)
        return text_fail(&p->t, p->directive, "more than %d lights are not supported", TYN_MAX_LIGHTS);
    return 0;
}

/* What lights have in frame files only. */
#define FRAME_LIGHT_KEYS(light)                                                                                                \
    KEY("scale", NUMBERS, 1, NOT_NEGATIVE, 0, &(light)->scale), KEY("tint", NUMBERS, 3, NOT_NEGATIVE, 0, (light)->tint),       \
        KEY("outside", WORD, 0, ANY, 0, NULL)
#define FRAME_LIGHT_COUNT 3

/* The keys of a light. Those for frame files come last. */
#define READ_LIGHT(p, light, keys, frame_keys) read_light_keys(p, light, keys, sizeof(keys) / sizeof *(keys), frame_keys)

static int read_light_keys(parser *p, scene_light *light, key *keys, size_t count, size_t frame_keys)
{
    static const char *const words[] = {"default", "lit", "dark", NULL};
    const key *last = keys + count - FRAME_LIGHT_COUNT; /* scale, tint, outside */
    if (keys_read(&p->t, p->directive, keys, p->frame ? count : count - frame_keys) != 0)
        return -1;
    /* In the library 0 stands for "as physics has it"; in a file it means none. */
    if ((last[0].seen && !(light->light.scale > 0.0f)) || (last[1].seen && vector_is_zero(light->light.tint)))
        light->light.scale = -1.0f;
    if (last[2].seen) {
        int picked = keys_word(&p->t, &last[2], words);
        if (picked < 0)
            return -1;
        light->light.outside = (tyn_outside)picked;
    }
    return 0;
}

static int read_directional(parser *p, scene_light *light)
{
    float direction[3], zero[3] = {0.0f, 0.0f, 0.0f};
    double way[3];
    key keys[] = {
        KEY("direction", NUMBERS, 3, ANY, 1, direction),  KEY("irradiance", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour),
        KEY("texture", FILE_NAME, 0, ANY, 0, NULL),       KEY("extent", NUMBERS, 2, POSITIVE, 0, light->extent),
        KEY("up", NUMBERS, 3, ANY, 0, light->texture_up), FRAME_LIGHT_KEYS(&light->light)};
    if (READ_LIGHT(p, light, keys, FRAME_LIGHT_COUNT) != 0)
        return -1;
    for (int i = 2; i < 5; i++)
        if (!keys[i].seen && (keys[2].seen || keys[3].seen || keys[4].seen))
            return text_fail(&p->t, p->directive, "missing key '%s': texture, extent and up go together", keys[i].name);
    if (vector_is_zero(direction))
        return text_fail(&p->t, keys[0].at, "has length 0");
    vector_difference(direction, zero, way);
    light->light.kind = TYN_LIGHT_DIRECTIONAL;
    set_direction(p, light, way);
    if (keys[2].seen) {
        if (vector_is_zero(light->texture_up))
            return text_fail(&p->t, keys[4].at, "has length 0");
        if (vector_parallel(way, light->texture_up))
            return text_fail(&p->t, keys[4].at, "up is parallel to the direction");
        light->texture = directive_texture(p, keys[2].word);
        if (!light->texture)
            return -1;
    }
    return add_light(p, light);
}

static int read_spot(parser *p, scene_light *light)
{
    float target[3], direction[3], zero[3] = {0.0f, 0.0f, 0.0f}, degrees = 0.0f;
    double way[3];
    key keys[] = {KEY("position", NUMBERS, 3, ANY, 1, light->light.position),
                  KEY("target", NUMBERS, 3, ANY, 1, target),
                  KEY("angle", NUMBERS, 1, BELOW_170, 1, &degrees),
                  KEY("intensity", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour),
                  KEY("texture", FILE_NAME, 0, ANY, 0, NULL),
                  KEY("up", NUMBERS, 3, ANY, 0, light->texture_up),
                  KEY("direction", NUMBERS, 3, ANY, 0, direction),
                  FRAME_LIGHT_KEYS(&light->light)};
    light->texture_up[1] = 1.0f;
    keys[1].required = !p->frame; /* there a direction will do */
    if (READ_LIGHT(p, light, keys, 1 + FRAME_LIGHT_COUNT) != 0)
        return -1;
    if (keys[1].seen == keys[6].seen)
        return text_fail(&p->t, keys[1].seen ? keys[6].at : p->directive, "either 'target' or 'direction' is needed");
    if (keys[1].seen)
        vector_difference(target, light->light.position, way);
    else
        vector_difference(direction, zero, way);
    if (!(vector_length(way) > 0.0))
        return text_fail(&p->t, keys[1].seen ? keys[1].at : keys[6].at,
                         keys[1].seen ? "the target is at the position" : "has length 0");
    if (vector_is_zero(light->texture_up))
        return text_fail(&p->t, keys[5].at, "has length 0");
    light->light.kind = TYN_LIGHT_SPOT;
    light->light.angle = (float)((double)degrees * DEGREE);
    set_direction(p, light, way);
    if (keys[4].seen) {
        if (vector_parallel(way, light->texture_up)) /* without a texture an up has no meaning */
            return text_fail(&p->t, keys[5].seen ? keys[5].at : p->directive, "up is parallel to the axis");
        light->texture = directive_texture(p, keys[4].word);
        if (!light->texture)
            return -1;
    }
    return add_light(p, light);
}

static int read_point(parser *p, scene_light *light)
{
    key keys[] = {KEY("position", NUMBERS, 3, ANY, 1, light->light.position),
                  KEY("intensity", NUMBERS, 3, NOT_NEGATIVE, 1, light->light.colour), FRAME_LIGHT_KEYS(&light->light)};
    light->point = 1;
    return READ_LIGHT(p, light, keys, FRAME_LIGHT_COUNT) == 0 ? add_light(p, light) : -1;
}

int directive_light(parser *p)
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

/* ---- the file --------------------------------------------------------------------------------------------------------- */

int directives_missing(parser *p, const char *name)
{
    token at = {name, strlen(name)};
    if (p->t.line == 0)
        p->t.line = 1;
    return text_fail(&p->t, at, "missing in this %s", p->frame ? "frame" : "scene");
}

static int read_version(parser *p, const char *word)
{
    token version;
    if (!token_is(p->directive, word))
        return text_fail(&p->t, p->directive, "the first directive must be '%s 1'", word);
    if (!text_token(&p->t, &version))
        return text_fail(&p->t, p->directive, "a version is missing after it");
    if (!token_is(version, "1"))
        return text_fail(&p->t, version, "unknown version of the %s format: only 1 is known", p->frame ? "frame" : "scene");
    return directive_end(p);
}

int directives_read(parser *p, const char *word, int (*directive)(parser *p))
{
    int first = 1;
    while (text_line(&p->t)) {
        int result;
        if (!text_token(&p->t, &p->directive))
            continue;
        if (first)
            result = read_version(p, word);
        else if (token_is(p->directive, word))
            result = text_fail(&p->t, p->directive, "given twice");
        else
            result = directive(p);
        if (result != 0)
            return -1;
        first = 0;
    }
    return first ? directives_missing(p, word) : 0;
}
