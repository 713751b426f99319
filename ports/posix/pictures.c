/* pictures.c */
#include "pictures.h"
#include "pfm.h"
#include "progress.h"

#include <stdlib.h>
#include <string.h>

static double ms(uint64_t ns)
{
    return (double)ns * 1e-6;
}

static void print_counts(const tyn_stats *s)
{
    const struct {
        const char *name;
        int64_t count;
    } counts[] = {{"pixels", s->pixels},   {"slices", s->slices},   {"culled", s->culled},     {"samples", s->samples},
                  {"breaks", s->breaks},   {"initial", s->initial}, {"rays", s->rays},         {"walks", s->walks},
                  {"columns", s->columns}, {"looked", s->looked},   {"rejected", s->rejected}, {"corrected", s->corrected}};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        printf("%s %lld\n", counts[i].name, (long long)counts[i].count);
    printf("rays_percent %.4g\n", (double)s->rays_percent);
    printf("looked_per_ray %.4g\n", (double)s->looked_per_ray);
    printf("memory_bytes %llu\n", (unsigned long long)s->memory);
}

/* On the wall from "load" to "gather" and "shafts"; the stages between them, called stage_, are sums over threads. */
static void print_times(const render_result *r, uint64_t load_ns)
{
    const tyn_stats *s = &r->stats;
    const struct {
        const char *name;
        uint64_t ns;
    } times[] = {{"load", load_ns},
                 {"shadow", r->times.shadow_ns},
                 {"surface", r->times.surface_ns},
                 {"slice", s->slice_ns},
                 {"stage_sample", s->sample_ns},
                 {"stage_row", s->row_ns},
                 {"stage_ray", s->ray_ns},
                 {"stage_line", s->line_ns},
                 {"gather", s->gather_ns},
                 {"stage_unwarp", s->unwarp_ns},
                 {"stage_upscale", s->upscale_ns},
                 {"stage_correct", s->correct_ns},
                 {"stage_composite", s->composite_ns},
                 {"shafts", s->total_ns}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        printf("%s_ms %.3f\n", times[i].name, ms(times[i].ns));
}

void pictures_stats(const render_result *r, uint64_t load_ns, uint64_t start)
{
    print_counts(&r->stats);
    printf("exposure %.9g\n", (double)r->exposure);
    print_times(r, load_ns);
    printf("total_ms %.3f\n", ms(clock_now(NULL) - start));
}

/* .pfm: linear, multiplied by an exposure only where one was given. */
static int write_linear(FILE *file, const options *o, const render_result *r)
{
    float *values = o->settings.debug ? r->debug : r->radiance;
    size_t count = 3 * (size_t)r->width * (size_t)r->height;
    if (!o->settings.debug && o->settings.exposure > 0.0f)
        for (size_t i = 0; i < count; i++)
            values[i] *= o->settings.exposure;
    return pfm_write(file, values, r->width, r->height, 3);
}

static int write_display(FILE *file, const options *o, const render_result *r, const output_set *files, tool_error *error)
{
    void *pixels = r->debug;
    int result;
    if (!pixels)
        pixels = render_display(r, r->exposure, o->kind == OUTPUT_RGB565 ? TYN_RGB565_SRGB : TYN_RGBA8_SRGB, error);
    if (!pixels)
        return -1;
    result = output_picture(file, o->kind, pixels, r->width, r->height);
    if (result != 0)
        output_failed(files, file, error);
    if (pixels != r->debug)
        free(pixels);
    return result;
}

int pictures_open(pictures *p, const options *o, tool_error *error)
{
    memset(p, 0, sizeof *p);
    return !(p->out = output_open(&p->set, o->out, error)) ||
                   (o->scatter && !(p->scatter = output_open(&p->set, o->scatter, error))) ||
                   (o->surface && !(p->surface = output_open(&p->set, o->surface, error))) ||
                   (o->depth && !(p->depth = output_open(&p->set, o->depth, error)))
               ? -1
               : 0;
}

static int write_one(const pictures *p, FILE *file, const float *values, const render_result *r, int channels,
                     tool_error *error)
{
    if (file && pfm_write(file, values, r->width, r->height, channels) != 0)
        return output_failed(&p->set, file, error);
    return 0;
}

int pictures_write(pictures *p, const options *o, const render_result *r, tool_error *error)
{
    if (o->kind != OUTPUT_PFM) {
        if (write_display(p->out, o, r, &p->set, error) != 0)
            return -1;
    } else if (write_linear(p->out, o, r) != 0) {
        return output_failed(&p->set, p->out, error);
    }
    return write_one(p, p->scatter, r->scatter, r, 3, error) != 0 || write_one(p, p->surface, r->surface, r, 3, error) != 0 ||
                   write_one(p, p->depth, r->depth, r, 1, error) != 0
               ? -1
               : 0;
}
