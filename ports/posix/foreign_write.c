/* foreign_write.c - numbers with nine digits are read back to the bit. */
#include "foreign_write.h"
#include "file.h"
#include "pfm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

typedef struct writer {
    output_set *set;
    const char *prefix, *base; /* base: the prefix without folders, as the frame file names its neighbours */
    FILE *frame;
    tool_error *error;
} writer;

const char *foreign_prefix_fault(const char *prefix)
{
    const char *base = file_base(prefix);
    if (*base == '\0')
        return "must end in the beginning of a file name";
    for (; *base; base++)
        if (*base == '#' || *base == ' ' || (*base >= '\t' && *base <= '\r'))
            return "a blank or # in the file name can't be told in a frame file";
    return NULL;
}

int foreign_prefix_takes(const char *prefix, const char *name)
{
    static const char *const endings[] = {".frame", ".depth.", ".colour.", ".light"};
    const char *base = file_base(prefix), *other = file_base(name);
    size_t n = strlen(base), folder = (size_t)(base - prefix);
    int same_folder =
        (folder == (size_t)(other - name) && strncmp(prefix, name, folder) == 0) || file_same_folder(prefix, name);
    if (!same_folder || strncmp(other, base, n) != 0)
        return 0;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strncmp(other + n, endings[i], strlen(endings[i])) == 0)
            return 1;
    return 0;
}

static FILE *open_one(writer *w, const char *ending)
{
    char *path = malloc(strlen(w->prefix) + strlen(ending) + 1);
    FILE *file = NULL;
    if (!path)
        error_memory(w->error);
    else
        file = output_open(w->set, strcat(strcpy(path, w->prefix), ending), w->error);
    free(path);
    return file;
}

static int write_floats(writer *w, const char *ending, const float *values, int32_t width, int32_t height, int32_t channels)
{
    FILE *file = open_one(w, ending);
    if (!file)
        return -1;
    return pfm_write(file, values, width, height, channels) == 0 ? 0 : output_failed(w->set, file, w->error);
}

static int write_texture(writer *w, const char *ending, const tyn_image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    int wide = image->format == TYN_RGB16_LINEAR, good;
    FILE *file = open_one(w, ending);
    if (!file)
        return -1;
    good = fprintf(file, "P6\n%ld %ld\n%d\n", (long)image->width, (long)image->height, wide ? 65535 : 255) > 0;
    if (!wide)
        good = good && fwrite(image->pixels, 1, count, file) == count;
    else
        for (size_t i = 0; i < count && good; i++) {
            unsigned v = ((const uint16_t *)image->pixels)[i];
            good = putc((int)(v >> 8), file) != EOF && putc((int)(v & 255), file) != EOF;
        }
    return good ? 0 : output_failed(w->set, file, w->error);
}

static void numbers(writer *w, const char *key, const float *values, int count)
{
    fprintf(w->frame, " %s", key);
    for (int i = 0; i < count; i++)
        fprintf(w->frame, " %.9g", (double)values[i]);
}

static void write_camera(writer *w, const tyn_camera *c)
{
    float window[4] = {c->left_edge, c->right_edge, c->bottom_edge, c->top_edge};
    fprintf(w->frame, "camera");
    numbers(w, "position", c->position, 3);
    numbers(w, "right", c->right, 3);
    numbers(w, "up", c->up, 3);
    numbers(w, "forward", c->forward, 3);
    numbers(w, "window", window, 4);
    numbers(w, "near", &c->near_depth, 1);
    numbers(w, "far", &c->far_depth, 1);
    fprintf(w->frame, "%s\n", c->kind == TYN_CAMERA_ORTHOGRAPHIC ? " orthographic" : "");
}

static void write_medium(writer *w, const tyn_medium *m)
{
    fprintf(w->frame, "medium");
    numbers(w, "scatter", m->scatter, 3);
    numbers(w, "absorb", m->absorb, 3);
    if (m->phase == TYN_PHASE_HG)
        numbers(w, "phase hg", &m->g, 1);
    else
        fprintf(w->frame, " phase %s", m->phase == TYN_PHASE_RAYLEIGH ? "rayleigh" : "isotropic");
    fprintf(w->frame, "\n");
}

/* The degrees that are read back as exactly these radians: there are some if they were read from degrees at first. */
static float degrees_of(float radians)
{
    float middle = (float)((double)radians / DEGREE), low = middle, high = middle;
    for (int i = 0; i < 4; i++) {
        float tries[2] = {low, high};
        for (int k = 0; k < 2; k++) {
            float back = (float)((double)tries[k] * DEGREE);
            if (!(back < radians || back > radians))
                return tries[k];
        }
        low = nextafterf(low, 0.0f);
        high = nextafterf(high, 180.0f);
    }
    return middle;
}

static int write_light(writer *w, int i, const scene_light *light, const render_light *maps)
{
    const tyn_light *l = &light->light;
    char ending[48];
    int directional = !light->point && l->kind == TYN_LIGHT_DIRECTIONAL;
    float angle = degrees_of(l->angle);
    fprintf(w->frame, "light %s", light->point ? "point" : directional ? "directional" : "spot");
    if (!directional)
        numbers(w, "position", l->position, 3);
    if (!light->point)
        numbers(w, "direction", l->direction, 3);
    if (!light->point && !directional)
        numbers(w, "angle", &angle, 1);
    numbers(w, directional ? "irradiance" : "intensity", l->colour, 3);
    if (light->texture && !light->point) {
        snprintf(ending, sizeof ending, ".light%d.ppm", i);
        fprintf(w->frame, " texture %s%s", w->base, ending);
        numbers(w, "up", light->texture_up, 3);
        if (directional)
            numbers(w, "extent", light->extent, 2);
        if (write_texture(w, ending, light->texture) != 0)
            return -1;
    }
    fprintf(w->frame, "\n");
    for (int k = 0; k < maps->count; k++) {
        snprintf(ending, sizeof ending, ".light%d-map%d.pfm", i, k);
        fprintf(w->frame, "shadow %s%s", w->base, ending);
        numbers(w, "matrix", maps->faces[k].matrix, 16);
        fprintf(w->frame, "\n");
        if (write_floats(w, ending, maps->maps[k], maps->faces[k].size, maps->faces[k].size, 1) != 0)
            return -1;
    }
    return 0;
}

int foreign_write(output_set *set, const char *prefix, const scene *s, const render_result *r, tool_error *error)
{
    writer w = {set, prefix, file_base(prefix), NULL, error};
    w.frame = open_one(&w, ".frame");
    if (!w.frame)
        return -1;
    fprintf(w.frame, "tyndall-frame 1\nimage %ld %ld\n", (long)r->width, (long)r->height);
    fprintf(w.frame, "depth %s.depth.pfm\ncolour %s.colour.pfm\n", w.base, w.base);
    write_camera(&w, &r->camera);
    for (int32_t i = 0; i < s->medium_count; i++)
        write_medium(&w, &s->media[i]);
    for (int32_t i = 0; i < s->light_count; i++)
        if (write_light(&w, i, &s->lights[i], &r->lights[i]) != 0)
            return -1;
    return write_floats(&w, ".depth.pfm", r->depth, r->width, r->height, 1) != 0 ||
                   write_floats(&w, ".colour.pfm", r->surface, r->width, r->height, 3) != 0
               ? -1
               : 0; /* what went wrong with w.frame, output_commit finds */
}
