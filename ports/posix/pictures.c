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

void pictures_stats(const render_result *r, uint64_t load_ns, uint64_t start)
{
    const tyn_stats *s = &r->stats;
    printf("pixels %lld\n", (long long)s->pixels);
    printf("slices %lld\n", (long long)s->slices);
    printf("samples %lld\n", (long long)s->samples);
    printf("breaks %lld\n", (long long)s->breaks);
    printf("rays %lld\n", (long long)s->rays);
    printf("rays_percent %.4g\n", (double)s->rays_percent);
    printf("walks %lld\n", (long long)s->walks);
    printf("rejected %lld\n", (long long)s->rejected);
    printf("memory_bytes %llu\n", (unsigned long long)s->memory);
    printf("exposure %.9g\n", (double)r->exposure);
    printf("load_ms %.3f\n", ms(load_ns));
    printf("shadow_ms %.3f\n", ms(r->times.shadow_ns));
    printf("surface_ms %.3f\n", ms(r->times.surface_ns));
    printf("slice_ms %.3f\n", ms(s->slice_ns));
    printf("gather_ms %.3f\n", ms(s->gather_ns));
    printf("shafts_ms %.3f\n", ms(s->total_ns));
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
