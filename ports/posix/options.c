/* options.c */
#include "options.h"
#include "foreign_write.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct word {
    const char *name;
    int value;
} word;

static const word methods[] = {{"epipolar", TYN_METHOD_EPIPOLAR},
                               {"march", TYN_METHOD_MARCH},
                               {"subsample", TYN_METHOD_SUBSAMPLE},
                               {"none", TYN_METHOD_NONE},
                               {NULL, 0}};
static const word rays[] = {{"words", TYN_RAYS_WORDS}, {"steps", TYN_RAYS_STEPS}, {NULL, 0}};
static const word presets[] = {{"handheld", TYN_PRESET_HANDHELD},
                               {"balanced", TYN_PRESET_BALANCED},
                               {"quality", TYN_PRESET_QUALITY},
                               {"reference", TYN_PRESET_REFERENCE},
                               {NULL, 0}};
static const word isas[] = {{"scalar", TYN_ISA_SCALAR},
                            {"sse2", TYN_ISA_SSE2},
                            {"avx2", TYN_ISA_AVX2},
                            {"avx512", TYN_ISA_AVX512},
                            {"neon", TYN_ISA_NEON},
                            {"wasm", TYN_ISA_WASM},
                            {NULL, 0}};
static const word debugs[] = {{"lines", TYN_DEBUG_LINES},
                              {"samples", TYN_DEBUG_SAMPLES},
                              {"breaks", TYN_DEBUG_BREAKS},
                              {"scatter", TYN_DEBUG_SCATTER},
                              {"rejected", TYN_DEBUG_REJECTED},
                              {"outside", TYN_DEBUG_OUTSIDE},
                              {NULL, 0}};

/* In the command line's plan, not in the library yet. */
static const char *const later[] = {"--gather",  "--downscale", "--bases",  "--weights",
                                    "--rectify", "--splits",    "--frames", NULL};

static int bad(const char *option, const char *value, const char *why)
{
    if (value)
        fprintf(stderr, "tyndall: %s '%s': %s\n", option, value, why);
    else
        fprintf(stderr, "tyndall: %s: %s\n", option, why);
    return -1;
}

static int whole(const char *text, long low, long high, const char **end, int32_t *out)
{
    char *stop;
    long value;
    errno = 0;
    if (*text < '0' || *text > '9')
        return -1;
    value = strtol(text, &stop, 10);
    if (errno || value < low || value > high || (!end && *stop))
        return -1;
    if (end)
        *end = stop;
    *out = (int32_t)value;
    return 0;
}

static int count_option(const char *name, const char *value, int32_t low, int32_t high, int32_t *out)
{
    char why[80];
    if (whole(value, low, high, NULL, out) == 0)
        return 0;
    snprintf(why, sizeof why, "must be a whole number from %ld to %ld", (long)low, (long)high);
    return bad(name, value, why);
}

static int number_option(const char *name, const char *value, float high, float *out)
{
    char *end;
    float x = strtof(value, &end);
    if (end != value && *end == '\0' && x > 0.0f && x <= high) {
        *out = x;
        return 0;
    }
    return bad(name, value, high > 1.0f ? "must be a number above 0" : "must be a number above 0, at most 1");
}

static int word_option(const char *name, const char *value, const word *words, int *out)
{
    char why[200] = "is not one of";
    for (const word *w = words; w->name; w++) {
        if (strcmp(value, w->name) == 0) {
            *out = w->value;
            return 0;
        }
        strcat(strcat(why, " "), w->name); /* the lists above are short */
    }
    return bad(name, value, why);
}

static int size_option(const char *value, render_settings *r)
{
    const char *at;
    if (whole(value, 1, TYN_MAX_SIZE, &at, &r->width) == 0 && *at == 'x' &&
        whole(at + 1, 1, TYN_MAX_SIZE, NULL, &r->height) == 0)
        return 0;
    return bad("--size", value, "must be WxH with whole numbers from 1 to 32768");
}

static int take(options *o, const char *name, const char *value)
{
    render_settings *r = &o->settings;
    int picked = 0, result;
    if (strcmp(name, "-o") == 0) {
        o->out = value;
        o->kind = output_kind_of(value);
        return o->kind == OUTPUT_UNKNOWN ? bad(name, value, "must end in .png, .ppm, .pfm, .rgb565 or .rgba") : 0;
    }
    if (strcmp(name, "--scatter") == 0 || strcmp(name, "--surface") == 0 || strcmp(name, "--depth") == 0) {
        *(name[2] == 'd' ? &o->depth : name[3] == 'c' ? &o->scatter : &o->surface) = value;
        return output_kind_of(value) == OUTPUT_PFM ? 0 : bad(name, value, "must end in .pfm");
    }
    if (strcmp(name, "--frame") == 0) {
        const char *fault = foreign_prefix_fault(value);
        o->frame = value;
        return fault ? bad(name, value, fault) : 0;
    }
    if (strcmp(name, "--size") == 0)
        return size_option(value, r);
    if (strcmp(name, "--method") == 0) {
        result = word_option(name, value, methods, &picked);
        r->method = (tyn_method)picked;
        r->method_given = 1;
        return result;
    }
    if (strcmp(name, "--rays") == 0) {
        result = word_option(name, value, rays, &picked);
        r->rays = (tyn_rays)picked;
        r->rays_given = 1;
        return result;
    }
    if (strcmp(name, "--preset") == 0) {
        result = word_option(name, value, presets, &picked);
        r->preset = (tyn_preset)picked;
        r->preset_given = 1;
        return result;
    }
    if (strcmp(name, "--debug") == 0) {
        result = word_option(name, value, debugs, &picked);
        r->debug = (tyn_debug)picked;
        return result;
    }
    if (strcmp(name, "--isa") == 0) {
        result = word_option(name, value, isas, &picked);
        r->isa = (int32_t)picked;
        if (result == 0 && !(tyn_isa_available() & picked))
            return bad(name, value, tyn_isa_built() & picked ? "this machine lacks it" : "is not built in");
        return result;
    }
    if (strcmp(name, "--steps") == 0)
        return count_option(name, value, 1, 4096, &r->steps);
    if (strcmp(name, "--slices") == 0)
        return count_option(name, value, 8, 65536, &r->slices);
    if (strcmp(name, "--samples") == 0)
        return count_option(name, value, 2, 65536, &r->samples);
    if (strcmp(name, "--shadow-size") == 0)
        return count_option(name, value, 1, TYN_MAX_SHADOW, &r->shadow_size);
    if (strcmp(name, "--threads") == 0)
        return count_option(name, value, 1, TYN_MAX_WORKERS, &o->threads);
    if (strcmp(name, "--initial-step") == 0) {
        if (whole(value, 1, 64, NULL, &r->initial_step) == 0 && (r->initial_step & (r->initial_step - 1)) == 0)
            return 0;
        return bad(name, value, "must be 1, 2, 4, 8, 16, 32 or 64");
    }
    if (strcmp(name, "--break") == 0)
        return number_option(name, value, 1.0f, &r->break_threshold);
    if (strcmp(name, "--exposure") == 0)
        return number_option(name, value, 3.4e38f, &r->exposure);
    return bad(name, NULL, "unknown option");
}

static int is_in(const char *name, const char *const *list)
{
    for (; *list; list++)
        if (strcmp(name, *list) == 0)
            return 1;
    return 0;
}

/* What only `render` can do: a frame has its size and its surfaces already. */
static const char *const of_scenes[] = {"--size", "--surface", "--depth", "--frame", NULL};

static int takes_value(const char *name)
{
    static const char *const valued[] = {
        "-o",       "--scatter", "--surface",      "--depth", "--size",        "--method", "--rays",    "--steps",
        "--slices", "--samples", "--initial-step", "--break", "--shadow-size", "--preset", "--threads", "--exposure",
        "--debug",  "--frame",   "--isa",          NULL};
    return is_in(name, valued);
}

/* Two outputs of one name would overwrite each other. */
static int check_names(const options *o)
{
    const char *names[4] = {o->out, o->scatter, o->surface, o->depth};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++)
            if (names[i] && names[k] && strcmp(names[i], names[k]) == 0)
                return bad("-o, --scatter, --surface, --depth", names[i], "is given twice");
    for (int i = 0; i < 4 && o->frame; i++)
        if (names[i] && foreign_prefix_takes(o->frame, names[i]))
            return bad("--frame", names[i], "is one of its own files");
    return 0;
}

int options_parse(options *o, options_command command, int argc, char **argv)
{
    const char *name = command == OPTIONS_POST ? "post" : "render";
    int plain = 0; /* after "--" */
    memset(o, 0, sizeof *o);
    for (int i = 0; i < argc; i++) {
        const char *a = argv[i];
        if (plain || a[0] != '-' || a[1] == '\0') {
            if (o->input)
                return bad(name, a, command == OPTIONS_POST ? "more than one frame" : "more than one scene");
            o->input = a;
        } else if (strcmp(a, "--") == 0) {
            plain = 1;
        } else if (strcmp(a, "--help") == 0) {
            o->help = 1;
            return 0;
        } else if (strcmp(a, "--stats") == 0) {
            o->stats = 1;
        } else if (command == OPTIONS_POST && is_in(a, of_scenes)) {
            return bad(a, NULL, "is for tyndall render");
        } else if (takes_value(a)) {
            if (i + 1 == argc)
                return bad(a, NULL, "a value is missing after it");
            if (take(o, a, argv[++i]) != 0)
                return -1;
        } else {
            return bad(a, NULL, is_in(a, later) ? "is not in this version" : "unknown option; see --help after the command");
        }
    }
    if (!o->input)
        return bad(name, NULL,
                   command == OPTIONS_POST ? "no frame given; see tyndall post --help"
                                           : "no scene given; see tyndall render --help");
    if (!o->out)
        return bad("-o", NULL, "is required: where the picture goes");
    o->settings.want_scatter = o->scatter != NULL;
    o->settings.debug_format = o->kind == OUTPUT_PFM      ? TYN_RGB_F32
                               : o->kind == OUTPUT_RGB565 ? TYN_RGB565_SRGB
                                                          : TYN_RGBA8_SRGB;
    return check_names(o);
}

static void help_of_render(void)
{
    printf("usage: tyndall render SCENE -o OUT [options]\n"
           "\n"
           "  --surface F.pfm    also the surfaces, not attenuated\n"
           "  --depth F.pfm      also the view-space depth\n"
           "  --frame PREFIX     also PREFIX.frame and what it names: all that tyndall post needs for the same picture\n"
           "  --size WxH         instead of the scene's\n"
           "  --shadow-size N    shadow map, texels, 1 .. 16384\n");
}

static void help_of_post(void)
{
    printf("usage: tyndall post FRAME -o OUT [options]\n"
           "\n"
           "Adds shafts to a frame that something else has drawn. FRAME is a text file, one directive a line, # a comment;\n"
           "file names are relative to it. Formats, matrices and the rest of the keys: ports/posix/README.md.\n"
           "\n"
           "  tyndall-frame 1\n"
           "  image W H\n"
           "  depth F            PFM or PGM; [coding view|projected|distance] [scale s] [at near far] [planes n f]\n"
           "                     [sky v] [unknown v | zero-unknown]\n"
           "  colour F           PFM (linear) or PPM (sRGB; [linear]); without: black\n"
           "  camera ...         as in a scene; or position right up forward window|pinhole near far [orthographic];\n"
           "                     or view (16) projection (16) near far; matrices row-major, for column vectors\n"
           "  medium ...         as in a scene\n"
           "  light ...          as in a scene; also [scale s] [tint r g b] [outside lit|dark], spot: [direction x y z]\n"
           "  shadow F           of the light before, up to 8: matrix (16) [coding reversed|projected|linear] [at n f]\n"
           "                     [scale s] [bias texels] [tint F.ppm]\n"
           "  shadow depth       made from the frame's own depth: [size n] [jump r] [thickness m]\n"
           "  art                [shaft_contrast x] [fog_scale x] [max_distance m]\n"
           "\n"
           "  --shadow-size N    of maps made from depth, texels, 1 .. 16384\n");
}

void options_help(options_command command)
{
    if (command == OPTIONS_POST)
        help_of_post();
    else
        help_of_render();
    printf(
        "  -o FILE            .png, .ppm (display, 8 bit), .pfm (linear radiance), .rgb565, .rgba (raw, no header;\n"
        "                     16 bit values low byte first)\n"
        "  --scatter F.pfm    also the scattered light alone\n"
        "  --preset P         handheld, balanced, quality (default), reference\n"
        "  --method M         epipolar (default), march (every pixel), subsample, none\n"
        "  --rays R           words (default, exact on the row), steps (fixed steps, see --steps)\n"
        "  --steps N          per ray, 1 .. 4096\n"
        "  --slices N         epipolar slices, 8 .. 65536\n"
        "  --samples N        along a slice, 2 .. 65536\n"
        "  --initial-step N   samples between rays, 1, 2, 4 .. 64\n"
        "  --break T          relative jump of depth that counts as a break, above 0, at most 1\n"
        "  --threads N        1 .. 64; default: the machine's\n"
        "  --exposure E       multiplies radiance; default: automatic for display output, 1 for .pfm\n"
        "  --debug V          draw lines, samples, breaks, scatter, rejected or outside instead of the picture\n"
        "  --isa I            scalar, sse2, avx2, avx512, neon or wasm; default: the best there is. All give the same bytes\n"
        "  --stats            print one \"name value\" a line\n"
        "\n"
        "A file appears when it is complete, or not at all. Exit status: 0 complete, 1 bad input, 2 bad usage.\n");
}
