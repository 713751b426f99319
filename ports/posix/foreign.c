/* foreign.c - frame files, version 1: what they have beside the directives of scene files. */
#include "foreign.h"
#include "directives.h"
#include "file.h"
#include "output.h"
#include "pfm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    parser p; /* first: a pointer to it is one to the reader */
    foreign *f;
    int depths, colours, arts;
    token depth_name, colour_name; /* for complaints about their size */
    int32_t depth_line, colour_line;
} reader;

/* ---- images --------------------------------------------------------------------------------------------------------- */

/* A PFM of so many channels as an image of the scene. */
static tyn_image *load_floats(scene *s, const char *path, int32_t channels, tool_error *error)
{
    pfm file;
    tyn_image *image = NULL;
    if (pfm_load(&file, path, error) != 0)
        return NULL;
    if (file.channels != channels)
        error_set(error, path, 0, NULL, 0, channels == 3 ? "has one channel, not three" : "has three channels, not one");
    else if (!(image = scene_add_image(s, file.width, file.height, channels == 3 ? TYN_RGB_F32 : TYN_DEPTH_F32)))
        error_memory(error);
    else
        memcpy(image->pixels, file.values, sizeof(float) * (size_t)channels * (size_t)file.width * (size_t)file.height);
    free(file.values);
    return image;
}

static double from_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* 8 or 16 bit as floats, 1 being display white. */
static tyn_image *load_colours(scene *s, const char *path, int linear, tool_error *error)
{
    tyn_image *from = pnm_load_colour(s, path, error), *to;
    size_t count;
    float *out;
    if (!from)
        return NULL;
    to = scene_add_image(s, from->width, from->height, TYN_RGB_F32);
    if (!to) {
        error_memory(error);
        return NULL;
    }
    count = 3 * (size_t)from->width * (size_t)from->height;
    out = to->pixels;
    for (size_t i = 0; i < count; i++) {
        double v = from->format == TYN_RGB8_LINEAR ? ((const uint8_t *)from->pixels)[i] / 255.0
                                                   : ((const uint16_t *)from->pixels)[i] / 65535.0;
        out[i] = (float)(linear ? v : from_srgb(v));
    }
    return to;
}

typedef enum content { DEPTH, COLOUR_SRGB, COLOUR_LINEAR } content;

/* A file beside the frame file, PFM by its ending, else PNM. *maxval is that of a PGM, 0 of others. */
static int load_image(reader *r, token name, content what, tyn_image *out, int32_t *maxval)
{
    text *t = &r->p.t;
    char *path = file_beside(t->file, name.start, name.length);
    tyn_image *image;
    *maxval = 0;
    if (!path)
        return error_memory(t->error);
    if (output_kind_of(path) == OUTPUT_PFM)
        image = load_floats(r->p.s, path, what == DEPTH ? 1 : 3, t->error);
    else if (what == DEPTH)
        image = pnm_load_counts(r->p.s, path, maxval, t->error);
    else
        image = load_colours(r->p.s, path, what == COLOUR_LINEAR, t->error);
    free(path);
    if (!image)
        return error_wrap(t->error, t->file, t->line, name.start, name.length);
    *out = *image;
    return 0;
}

static int file_name(reader *r, token *name)
{
    return text_token(&r->p.t, name) ? 0 : text_fail(&r->p.t, r->p.directive, "a file name is missing after it");
}

/* A PGM whose values are parts of a whole, not counts, must use all of it. */
static int check_maxval(reader *r, token name, int32_t maxval)
{
    if (maxval == 0 || maxval == 65535)
        return 0;
    return text_fail(&r->p.t, name, "has a maxval of %ld; with this coding it must be 65535", (long)maxval);
}

/* ---- directives ----------------------------------------------------------------------------------------------------- */

static int read_depth(reader *r)
{
    static const char *const codings[] = {"view", "projected", "distance", NULL};
    foreign *f = r->f;
    tyn_depth_coding *c = &f->coding;
    float at[2] = {0.0f, 1.0f}, planes[2] = {0.0f, 0.0f};
    int32_t maxval;
    int coding = TYN_CODING_VIEW;
    key keys[] = {KEY("coding", WORD, 0, ANY, 0, NULL),      KEY("scale", NUMBERS, 1, POSITIVE, 0, &c->scale),
                  KEY("at", NUMBERS, 2, ANY, 0, at),         KEY("planes", NUMBERS, 2, NOT_NEGATIVE, 0, planes),
                  KEY("sky", NUMBERS, 1, ANY, 0, &c->sky),   KEY("unknown", NUMBERS, 1, ANY, 0, &f->unknown),
                  KEY("zero-unknown", FLAG, 0, ANY, 0, NULL)};
    if (directive_once(&r->p, &r->depths) != 0 || file_name(r, &r->depth_name) != 0 || READ_KEYS(&r->p, keys) != 0)
        return -1;
    r->depth_line = r->p.t.line;
    if (keys[0].seen && (coding = keys_word(&r->p.t, &keys[0], codings)) < 0)
        return -1;
    for (int i = 1; i < 4; i++)
        if (keys[i].seen && (coding == TYN_CODING_PROJECTED) == (i == 1))
            return text_fail(&r->p.t, keys[i].at, "does not go with this coding");
    if (keys[3].seen && (!(planes[0] > 0.0f) || (planes[1] > 0.0f && !(planes[1] > planes[0]))))
        return text_fail(&r->p.t, keys[3].at, "the near plane must be above 0, the far one beyond it, or 0: there is none");
    if (keys[5].seen && keys[6].seen)
        return text_fail(&r->p.t, keys[6].at, "given twice: 'zero-unknown' is 'unknown 0'");
    if (!(at[0] > at[1] || at[0] < at[1]) || fabsf(at[0]) > 1e6f || fabsf(at[1]) > 1e6f)
        return text_fail(&r->p.t, keys[2].at, "must be two different numbers from -1e6 to 1e6");
    c->kind = (tyn_depth_kind)coding;
    c->at_near = coding == TYN_CODING_PROJECTED ? at[0] : 0.0f;
    c->at_far = coding == TYN_CODING_PROJECTED ? at[1] : 0.0f;
    c->near_depth = planes[0];
    c->far_depth = keys[3].seen && !(planes[1] > 0.0f) ? HUGE_VALF : planes[1];
    c->has_sky = keys[4].seen;
    f->has_unknown = keys[5].seen || keys[6].seen;
    if (load_image(r, r->depth_name, DEPTH, &f->depth, &maxval) != 0)
        return -1;
    return coding == TYN_CODING_PROJECTED ? check_maxval(r, r->depth_name, maxval) : 0;
}

static int read_colour(reader *r)
{
    key keys[] = {KEY("srgb", FLAG, 0, ANY, 0, NULL), KEY("linear", FLAG, 0, ANY, 0, NULL)};
    int32_t maxval;
    if (directive_once(&r->p, &r->colours) != 0 || file_name(r, &r->colour_name) != 0 || READ_KEYS(&r->p, keys) != 0)
        return -1;
    r->colour_line = r->p.t.line;
    if (keys[0].seen && keys[1].seen)
        return text_fail(&r->p.t, keys[1].at, "either 'srgb' or 'linear'");
    return load_image(r, r->colour_name, keys[1].seen ? COLOUR_LINEAR : COLOUR_SRGB, &r->f->colour, &maxval);
}

/* The three ways to say what a camera is: as scenes do; by its axes; by an engine's matrices. Bits of who takes a key. */
enum { LOOK = 1, AXES = 2, MATRICES = 4 };
enum {
    POSITION,
    TARGET,
    UP,
    FOV_Y,
    NEAR,
    FAR,
    RIGHT,
    FORWARD,
    WINDOW,
    PINHOLE,
    ORTHOGRAPHIC,
    VIEW,
    PROJECTION,
    CAMERA_KEY_COUNT
};

static int pick_camera(reader *r, const key *keys)
{
    static const int takes[CAMERA_KEY_COUNT] = {LOOK | AXES, LOOK, LOOK | AXES, LOOK, 7,        7,       AXES,
                                                AXES,        AXES, AXES,        AXES, MATRICES, MATRICES};
    static const int needs[CAMERA_KEY_COUNT] = {LOOK | AXES, LOOK, AXES, LOOK, 7, 7, AXES, AXES, 0, 0, 0, MATRICES, MATRICES};
    int way = keys[VIEW].seen || keys[PROJECTION].seen ? MATRICES : keys[RIGHT].seen || keys[FORWARD].seen ? AXES : LOOK;
    for (int i = 0; i < CAMERA_KEY_COUNT; i++) {
        if (keys[i].seen && !(takes[i] & way))
            return text_fail(&r->p.t, keys[i].at, "does not go with '%s'",
                             way == MATRICES ? "view"
                             : way == AXES   ? "right"
                                             : "target");
        if (!keys[i].seen && (needs[i] & way))
            return text_fail(&r->p.t, r->p.directive, "missing key '%s'", keys[i].name);
    }
    if (way == AXES && keys[WINDOW].seen == keys[PINHOLE].seen)
        return text_fail(&r->p.t, r->p.directive, "either 'window' or 'pinhole' is needed");
    return way;
}

/* fx fy cx cy in pixels: where the ray along `forward` goes, and how many pixels one at depth 1 are; y runs downwards there. */
static int pinhole_window(reader *r, const key *k, float window[4])
{
    const float *p = k->numbers;
    if (!r->p.images)
        return text_fail(&r->p.t, k->at, "'image' must come first");
    if (!(p[0] > 0.0f && p[1] > 0.0f))
        return text_fail(&r->p.t, k->at, "the focal lengths must be above 0");
    window[0] = -p[2] / p[0];
    window[1] = ((float)r->f->s.width - p[2]) / p[0];
    window[2] = (p[3] - (float)r->f->s.height) / p[1];
    window[3] = p[3] / p[1];
    return 0;
}

static int read_camera(reader *r)
{
    foreign *f = r->f;
    scene_camera *c = &f->s.camera;
    float degrees = 0.0f, right[3], forward[3], window[4], pinhole[4], view[16], projection[16];
    int way;
    tyn_status status = TYN_OK;
    key keys[CAMERA_KEY_COUNT] = {CAMERA_KEYS(c, &degrees),
                                  KEY("right", NUMBERS, 3, ANY, 0, right),
                                  KEY("forward", NUMBERS, 3, ANY, 0, forward),
                                  KEY("window", NUMBERS, 4, ANY, 0, window),
                                  KEY("pinhole", NUMBERS, 4, ANY, 0, pinhole),
                                  KEY("orthographic", FLAG, 0, ANY, 0, NULL),
                                  KEY("view", NUMBERS, 16, ANY, 0, view),
                                  KEY("projection", NUMBERS, 16, ANY, 0, projection)};
    for (int i = 0; i < CAMERA_KEY_COUNT; i++)
        keys[i].required = 0; /* pick_camera knows */
    if (directive_once(&r->p, &r->p.cameras) != 0 || READ_KEYS(&r->p, keys) != 0 || (way = pick_camera(r, keys)) < 0)
        return -1;
    c->line = r->p.t.line;
    if (way == LOOK)
        return directive_camera_look(&r->p, c, keys, degrees); /* and the rest when the image's size is known */
    if (way == MATRICES) {
        status = tyn_camera_from_matrices(&f->camera, view, projection, c->near_depth, c->far_depth);
    } else {
        if (keys[PINHOLE].seen && pinhole_window(r, &keys[PINHOLE], window) != 0)
            return -1;
        f->camera.kind = keys[ORTHOGRAPHIC].seen ? TYN_CAMERA_ORTHOGRAPHIC : TYN_CAMERA_PERSPECTIVE;
        memcpy(f->camera.position, c->position, sizeof c->position);
        memcpy(f->camera.right, right, sizeof right);
        memcpy(f->camera.up, c->up, sizeof c->up);
        memcpy(f->camera.forward, forward, sizeof forward);
        f->camera.left_edge = window[0];
        f->camera.right_edge = window[1];
        f->camera.bottom_edge = window[2];
        f->camera.top_edge = window[3];
        f->camera.near_depth = c->near_depth;
        f->camera.far_depth = c->far_depth;
    }
    if (status == TYN_OK && !(c->near_depth < c->far_depth))
        return text_fail(&r->p.t, keys[FAR].at, "must be beyond near");
    return status == TYN_OK ? 0
                            : text_fail(&r->p.t, keys[VIEW].at, "these matrices are no camera's: %s", tyn_status_name(status));
}

static int read_art(reader *r)
{
    foreign *f = r->f;
    key keys[] = {KEY("shaft_contrast", NUMBERS, 1, NOT_NEGATIVE, 0, &f->shaft_contrast),
                  KEY("fog_scale", NUMBERS, 1, NOT_NEGATIVE, 0, &f->fog_scale),
                  KEY("max_distance", NUMBERS, 1, POSITIVE, 0, &f->max_distance)};
    if (directive_once(&r->p, &r->arts) != 0 || READ_KEYS(&r->p, keys) != 0)
        return -1;
    /* In the library 0 stands for physics; in a file it means none. */
    if (keys[0].seen && !(f->shaft_contrast > 0.0f))
        f->shaft_contrast = -1.0f;
    if (keys[1].seen && !(f->fog_scale > 0.0f))
        f->fog_scale = -1.0f;
    return 0;
}

/* shadow depth: made by post from what the camera sees. */
static int read_shadow_depth(reader *r, foreign_light *l)
{
    float size = 0.0f;
    key keys[] = {KEY("size", NUMBERS, 1, POSITIVE, 0, &size), KEY("jump", NUMBERS, 1, POSITIVE, 0, &l->jump),
                  KEY("thickness", NUMBERS, 1, NOT_NEGATIVE, 0, &l->thickness)};
    l->jump = 0.06f;
    if (l->count || l->from_depth)
        return text_fail(&r->p.t, r->p.directive, "this light has a shadow map already");
    if (READ_KEYS(&r->p, keys) != 0)
        return -1;
    if (keys[0].seen && (!(size >= 1.0f && size <= (float)TYN_MAX_SHADOW) || size > floorf(size)))
        return text_fail(&r->p.t, keys[0].at, "must be a whole number from 1 to %d", TYN_MAX_SHADOW);
    l->size = (int32_t)size;
    l->from_depth = 1;
    return 0;
}

static int read_map(reader *r, foreign_light *l, token name)
{
    static const char *const codings[] = {"reversed", "projected", "linear", NULL};
    tyn_shadow *map = &l->maps[l->count];
    tyn_image image;
    float at[2] = {0.0f, 0.0f};
    int32_t maxval;
    int coding = TYN_MAP_REVERSED;
    key keys[] = {KEY("matrix", NUMBERS, 16, ANY, 1, map->matrix),
                  KEY("coding", WORD, 0, ANY, 0, NULL),
                  KEY("at", NUMBERS, 2, ANY, 0, at),
                  KEY("scale", NUMBERS, 1, POSITIVE, 0, &map->scale),
                  KEY("bias", NUMBERS, 1, NOT_NEGATIVE, 0, &map->bias),
                  KEY("tint", FILE_NAME, 0, ANY, 0, NULL)};
    if (READ_KEYS(&r->p, keys) != 0)
        return -1;
    if (keys[1].seen && (coding = keys_word(&r->p.t, &keys[1], codings)) < 0)
        return -1;
    if (!matrix_is_invertible(map->matrix))
        return text_fail(&r->p.t, keys[0].at, "is not invertible");
    if (map->bias > 64.0f)
        return text_fail(&r->p.t, keys[4].at, "must be from 0 to 64");
    if (load_image(r, name, DEPTH, &image, &maxval) != 0 || (coding != TYN_MAP_LINEAR && check_maxval(r, name, maxval) != 0))
        return -1;
    if (image.width > TYN_MAX_SHADOW || image.height > TYN_MAX_SHADOW)
        return text_fail(&r->p.t, name, "is larger than %d texels", TYN_MAX_SHADOW);
    if (keys[5].seen && !(map->tint = directive_texture(&r->p, keys[5].word)))
        return -1;
    map->depth = image.pixels;
    map->size = image.width;
    map->height = image.height;
    map->format = image.format;
    map->coding = (tyn_map_coding)coding;
    map->at_near = at[0];
    map->at_far = at[1];
    l->count++;
    return 0;
}

static int read_shadow(reader *r)
{
    int32_t count = r->f->s.light_count;
    token name;
    foreign_light *l;
    if (count == 0)
        return text_fail(&r->p.t, r->p.directive, "comes before any light");
    if (file_name(r, &name) != 0)
        return -1;
    l = &r->f->lights[count - 1];
    if (token_is(name, "depth"))
        return read_shadow_depth(r, l);
    if (l->from_depth)
        return text_fail(&r->p.t, r->p.directive, "this light has a shadow map already");
    if (l->count == TYN_MAX_MAPS)
        return text_fail(&r->p.t, r->p.directive, "more than %d maps of a light are not supported", TYN_MAX_MAPS);
    return read_map(r, l, name);
}

static int read_directive(parser *p)
{
    reader *r = (reader *)p;
    token d = p->directive;
    if (token_is(d, "image"))
        return directive_image(p);
    if (token_is(d, "depth"))
        return read_depth(r);
    if (token_is(d, "colour"))
        return read_colour(r);
    if (token_is(d, "camera"))
        return read_camera(r);
    if (token_is(d, "medium"))
        return directive_medium(p);
    if (token_is(d, "light"))
        return directive_light(p);
    if (token_is(d, "shadow"))
        return read_shadow(r);
    if (token_is(d, "art"))
        return read_art(r);
    return text_fail(&p->t, d, "unknown directive");
}

/* ---- the whole ------------------------------------------------------------------------------------------------------ */

static int check_size(const reader *r, const tyn_image *image, token name, int32_t line)
{
    const scene *s = &r->f->s;
    if (!image->pixels || (image->width == s->width && image->height == s->height))
        return 0;
    return error_set(r->p.t.error, r->p.t.file, line, name.start, name.length, "is %ld x %ld pixels, the image %ld x %ld",
                     (long)image->width, (long)image->height, (long)s->width, (long)s->height);
}

static int read_frame(reader *r)
{
    foreign *f = r->f;
    if (directives_read(&r->p, "tyndall-frame", read_directive) != 0)
        return -1;
    if (!r->p.images)
        return directives_missing(&r->p, "image");
    if (!r->depths)
        return directives_missing(&r->p, "depth");
    if (!r->p.cameras)
        return directives_missing(&r->p, "camera");
    if (check_size(r, &f->depth, r->depth_name, r->depth_line) != 0 ||
        check_size(r, &f->colour, r->colour_name, r->colour_line) != 0)
        return -1;
    if (!(f->camera.far_depth > 0.0f) && scene_camera_make(&f->s, f->s.width, f->s.height, &f->camera) != TYN_OK)
        return error_set(r->p.t.error, r->p.t.file, f->s.camera.line, "camera", 6, "out of a float's range");
    return 0;
}

int foreign_load(foreign *f, const char *path, tool_error *error)
{
    reader r;
    int result;
    memset(&r, 0, sizeof r);
    memset(f, 0, sizeof *f);
    scene_init(&f->s);
    error->text[0] = '\0';
    r.f = f;
    r.p.s = &f->s;
    r.p.frame = 1;
    if (text_open(&r.p.t, path, TEXT_SCENE, error) != 0)
        return -1;
    result = read_frame(&r);
    text_close(&r.p.t);
    texture_cache_free(&r.p.textures);
    if (result != 0)
        foreign_free(f);
    return result;
}

void foreign_free(foreign *f)
{
    scene_free(&f->s);
    memset(f, 0, sizeof *f);
}
