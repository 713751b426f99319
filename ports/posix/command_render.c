/* command_render.c - tyndall render: load, draw, write. */
#include "commands.h"
#include "options.h"
#include "parse.h"
#include "pfm.h"
#include "progress.h"

#include <stdlib.h>
#include <string.h>

static double ms(uint64_t ns)
{
    return (double)ns * 1e-6;
}

static void print_stats(const render_result *r, uint64_t load_ns, uint64_t start)
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

typedef struct targets {
    output_set set;
    FILE *out, *scatter, *surface, *depth;
} targets;

static int open_all(targets *t, const options *o, tool_error *error)
{
    memset(t, 0, sizeof *t);
    return !(t->out = output_open(&t->set, o->out, error)) ||
                   (o->scatter && !(t->scatter = output_open(&t->set, o->scatter, error))) ||
                   (o->surface && !(t->surface = output_open(&t->set, o->surface, error))) ||
                   (o->depth && !(t->depth = output_open(&t->set, o->depth, error)))
               ? -1
               : 0;
}

static int write_one(const targets *t, FILE *file, const float *values, const render_result *r, int channels, tool_error *error)
{
    if (file && pfm_write(file, values, r->width, r->height, channels) != 0)
        return output_failed(&t->set, file, error);
    return 0;
}

static int write_all(targets *t, const options *o, const render_result *r, tool_error *error)
{
    if (o->kind != OUTPUT_PFM) {
        if (write_display(t->out, o, r, &t->set, error) != 0)
            return -1;
    } else if (write_linear(t->out, o, r) != 0) {
        return output_failed(&t->set, t->out, error);
    }
    return write_one(t, t->scatter, r->scatter, r, 3, error) != 0 || write_one(t, t->surface, r->surface, r, 3, error) != 0 ||
                   write_one(t, t->depth, r->depth, r, 1, error) != 0
               ? -1
               : 0;
}

static int draw(const options *o, const scene *s, uint64_t load_ns, uint64_t start, tool_error *error)
{
    render_result result;
    targets files;
    int status = -1;
    pool *threads = pool_create(o->threads ? o->threads : pool_default_workers());
    if (!threads)
        return error_memory(error);
    if (open_all(&files, o, error) == 0 && render_scene(s, o->scene, &o->settings, threads, &result, error) == 0) {
        if (write_all(&files, o, &result, error) == 0)
            status = output_commit(&files.set, error);
        if (status == 0 && o->stats)
            print_stats(&result, load_ns, start);
        render_free(&result);
    }
    if (status != 0)
        output_abort(&files.set);
    pool_free(threads);
    return status;
}

int command_render(int argc, char **argv)
{
    options o;
    scene s;
    tool_error error;
    uint64_t start = clock_now(NULL);
    int status;
    if (options_parse(&o, argc, argv) != 0)
        return 2;
    if (o.help) {
        options_help();
        return 0;
    }
    o.settings.want_scatter = o.scatter != NULL;
    o.settings.want_surface = o.surface != NULL;
    o.settings.debug_format = o.kind == OUTPUT_PFM ? TYN_RGB_F32 : o.kind == OUTPUT_RGB565 ? TYN_RGB565_SRGB : TYN_RGBA8_SRGB;
    progress_stage("scene");
    status = scene_load(&s, o.scene, &error);
    if (status == 0) {
        status = draw(&o, &s, clock_now(NULL) - start, start, &error);
        scene_free(&s);
    }
    progress_end();
    if (status != 0)
        fprintf(stderr, "tyndall: %s\n", error.text);
    return status == 0 ? 0 : 1;
}
