/* options.c */
#include "options.h"
#include "file.h"
#include "foreign_write.h"

#include <errno.h>
#include <stddef.h>
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
                               {"prefiltered", TYN_METHOD_PREFILTERED},
                               {"hybrid", TYN_METHOD_HYBRID},
                               {NULL, 0}};
static const word rays[] = {{"words", TYN_RAYS_WORDS},     {"tree", TYN_RAYS_TREE},   {"sweep", TYN_RAYS_SWEEP},
                            {"columns", TYN_RAYS_COLUMNS}, {"steps", TYN_RAYS_STEPS}, {NULL, 0}};
static const word gathers[] = {{"shear", TYN_GATHER_SHEAR}, {"ivb", TYN_GATHER_IVB}, {"ed10", TYN_GATHER_ED10}, {NULL, 0}};
static const word kernels[] = {
    {"gaussian", TYN_KERNEL_GAUSSIAN}, {"shepard", TYN_KERNEL_SHEPARD}, {"threshold", TYN_KERNEL_THRESHOLD}, {NULL, 0}};
static const word presets[] = {{"handheld", TYN_PRESET_HANDHELD},
                               {"balanced", TYN_PRESET_BALANCED},
                               {"quality", TYN_PRESET_QUALITY},
                               {"reference", TYN_PRESET_REFERENCE},
                               {NULL, 0}};
static const word debugs[] = {{"lines", TYN_DEBUG_LINES},
                              {"samples", TYN_DEBUG_SAMPLES},
                              {"breaks", TYN_DEBUG_BREAKS},
                              {"sources", TYN_DEBUG_SOURCES},
                              {"scatter", TYN_DEBUG_SCATTER},
                              {"row", TYN_DEBUG_ROW},
                              {"tree", TYN_DEBUG_TREE},
                              {"rejected", TYN_DEBUG_REJECTED},
                              {"outside", TYN_DEBUG_OUTSIDE},
                              {"basis", TYN_DEBUG_BASIS},
                              {NULL, 0}};
static const word weights[] = {{"transmittance", TYN_WEIGHTS_TRANSMITTANCE}, {"average", TYN_WEIGHTS_AVERAGE}, {NULL, 0}};
static const word rectifications[] = {{"epipolar", RENDER_EPIPOLAR - 1}, {"projective", RENDER_PROJECTIVE - 1}, {NULL, 0}};

static const word isas[] = {{"scalar", TYN_ISA_SCALAR},
                            {"sse2", TYN_ISA_SSE2},
                            {"avx2", TYN_ISA_AVX2},
                            {"avx512", TYN_ISA_AVX512},
                            {"neon", TYN_ISA_NEON},
                            {"wasm", TYN_ISA_WASM},
                            {NULL, 0}};

/* Options that set one number of the settings. */
typedef struct setting {
    const char *name;
    enum { COUNT, POWER_OF_TWO, FOURS, NUMBER, WORD } kind;
    size_t at;         /* in render_settings: int32_t, float for a NUMBER */
    int32_t low, high; /* of COUNT, POWER_OF_TWO and FOURS, multiples of 4 */
    float most;        /* of a NUMBER, which is above 0 */
    const word *words;
} setting;

#define COUNT_AT(name, field, low, high)                                                                                       \
    {                                                                                                                          \
        name, COUNT, offsetof(render_settings, field), low, high, 0.0f, NULL                                                   \
    }
#define POWER_AT(name, field, high)                                                                                            \
    {                                                                                                                          \
        name, POWER_OF_TWO, offsetof(render_settings, field), 1, high, 0.0f, NULL                                              \
    }
#define NUMBER_AT(name, field, most)                                                                                           \
    {                                                                                                                          \
        name, NUMBER, offsetof(render_settings, field), 0, 0, most, NULL                                                       \
    }
#define WORD_AT(name, field, words)                                                                                            \
    {                                                                                                                          \
        name, WORD, offsetof(render_settings, field), 0, 0, 0.0f, words                                                        \
    }

static const setting settings[] = {WORD_AT("--method", method, methods),
                                   WORD_AT("--rays", rays, rays),
                                   COUNT_AT("--steps", steps, 1, 4096),
                                   WORD_AT("--gather", gather, gathers),
                                   COUNT_AT("--taps", taps, 3, 5),
                                   WORD_AT("--kernel", kernel, kernels),
                                   COUNT_AT("--slices", slices, 8, 65536),
                                   COUNT_AT("--samples", samples, 2, 65536),
                                   POWER_AT("--initial-step", initial_step, 64),
                                   NUMBER_AT("--break", break_threshold, 1.0f),
                                   NUMBER_AT("--tolerance", tolerance, 1.0f),
                                   POWER_AT("--downscale", downscale, 8),
                                   {"--bases", FOURS, offsetof(render_settings, bases), 4, 128, 0.0f, NULL},
                                   COUNT_AT("--columns", columns, 4, 4096),
                                   COUNT_AT("--references", references, 1, 4),
                                   WORD_AT("--weights", weights, weights),
                                   WORD_AT("--rectify", rectify, rectifications),
                                   COUNT_AT("--splits", splits, 1, RENDER_FACES),
                                   COUNT_AT("--budget", budget, 1, 0x7fffffff),
                                   COUNT_AT("--shadow-size", shadow_size, 1, TYN_MAX_SHADOW),
                                   WORD_AT("--preset", preset, presets),
                                   NUMBER_AT("--exposure", exposure, 3.4e38f),
                                   WORD_AT("--debug", debug, debugs),
                                   WORD_AT("--isa", isa, isas)};
enum { SETTINGS = sizeof settings / sizeof *settings };

/* In the command line's plan, not in the library yet. */
static const char *const later[] = {"--frames", NULL};

static int bad(const char *option, const char *value, const char *why)
{
    if (value)
        error_say("%.500s '%.500s': %s", option, value, why);
    else
        error_say("%.500s: %s", option, why);
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

static int take_count(const setting *s, const char *value, int32_t *out)
{
    char why[80], *at = why;
    if (whole(value, s->low, s->high, NULL, out) == 0 &&
        (s->kind == COUNT || (s->kind == FOURS ? *out % 4 == 0 : (*out & (*out - 1)) == 0)))
        return 0;
    at += sprintf(at, "must be a %s", s->kind == COUNT ? "whole number" : s->kind == FOURS ? "multiple of 4" : "power of two");
    sprintf(at, " from %ld to %ld", (long)s->low, (long)s->high);
    return bad(s->name, value, why);
}

static int take_number(const setting *s, const char *value, float *out)
{
    char *end;
    float x = strtof(value, &end);
    if (end != value && *end == '\0' && x > 0.0f && x <= s->most) {
        *out = x;
        return 0;
    }
    return bad(s->name, value, s->most > 1.0f ? "must be a number above 0" : "must be a number above 0, at most 1");
}

static int take_word(const setting *s, const char *value, int32_t *out)
{
    char why[200] = "is not one of";
    for (const word *w = s->words; w->name; w++) {
        if (strcmp(value, w->name) == 0) {
            *out = w->value + 1; /* 0 stands for "not given" */
            return 0;
        }
        strcat(strcat(why, " "), w->name); /* the lists above are short */
    }
    return bad(s->name, value, why);
}

static int take_setting(const setting *s, const char *value, render_settings *r)
{
    void *at = (char *)r + s->at;
    if (s->kind == NUMBER)
        return take_number(s, value, at);
    return s->kind == WORD ? take_word(s, value, at) : take_count(s, value, at);
}

static const setting *setting_of(const char *name)
{
    for (int i = 0; i < SETTINGS; i++)
        if (strcmp(name, settings[i].name) == 0)
            return &settings[i];
    return NULL;
}

static int size_option(const char *value, render_settings *r)
{
    const char *at;
    if (whole(value, 1, TYN_MAX_SIZE, &at, &r->width) == 0 && *at == 'x' &&
        whole(at + 1, 1, TYN_MAX_SIZE, NULL, &r->height) == 0)
        return 0;
    return bad("--size", value, "must be WxH with whole numbers from 1 to 32768");
}

/* A pixel of --debug row and tree. */
static int point_option(const char *value, render_settings *r)
{
    const char *at;
    int32_t x, y;
    if (whole(value, 0, TYN_MAX_SIZE - 1, &at, &x) == 0 && *at == ',' && whole(at + 1, 0, TYN_MAX_SIZE - 1, NULL, &y) == 0) {
        r->debug_x = (float)x + 0.5f;
        r->debug_y = (float)y + 0.5f;
        return 0;
    }
    return bad("--at", value, "must be X,Y, a pixel");
}

static int take(options *o, const char *name, const char *value)
{
    render_settings *r = &o->settings;
    const setting *s = setting_of(name);
    static const setting count_of_threads = {"--threads", COUNT, 0, 1, TYN_MAX_WORKERS, 0.0f, NULL};
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
    if (strcmp(name, "--at") == 0)
        return point_option(value, r);
    if (strcmp(name, "--threads") == 0)
        return take_count(&count_of_threads, value, &o->threads);
    if (!s)
        return bad(name, NULL, "unknown option");
    if (take_setting(s, value, r) != 0)
        return -1;
    if (r->isa && !(tyn_isa_available() & (r->isa - 1)))
        return bad(name, value, tyn_isa_built() & (r->isa - 1) ? "this machine lacks it" : "is not built in");
    return 0;
}

static int is_in(const char *name, const char *const *list)
{
    for (; *list; list++)
        if (strcmp(name, *list) == 0)
            return 1;
    return 0;
}

/* What only `render` can do: a frame has its size and its surfaces already. */
static const char *const of_scenes[] = {"--rectify", "--splits", "--size", "--surface", "--depth", "--frame", NULL};

static int takes_value(const char *name)
{
    static const char *const others[] = {"-o",      "--scatter", "--surface", "--depth", "--size",
                                         "--frame", "--threads", "--at",      NULL};
    return setting_of(name) || is_in(name, others);
}

/* Two outputs of one name would overwrite each other. */
static int check_names(const options *o)
{
    const char *names[4] = {o->out, o->scatter, o->surface, o->depth};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++)
            if (names[i] && names[k] && file_same(names[i], names[k]))
                return bad("-o, --scatter, --surface, --depth", names[i], "is one file given twice");
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

/* What bench has besides the settings. 0: not one of these; -1: bad. */
static int take_bench(options *o, const char *name, const char *value)
{
    static const setting count_of_repeats = {"--repeats", COUNT, 0, 1, 10000, 0.0f, NULL};
    if (strcmp(name, "--bench-scene") == 0) {
        static const char *const scenes[] = {"simple-on", "simple-off", "leafy-on", "leafy-off", NULL};
        o->bench_scene = value;
        return is_in(value, scenes) ? 1 : bad(name, value, "is not one of simple-on simple-off leafy-on leafy-off");
    }
    if (strcmp(name, "--repeats") == 0)
        return take_count(&count_of_repeats, value, &o->repeats) == 0 ? 1 : -1;
    return 0;
}

int options_parse_bench(options *o, int argc, char **argv)
{
    static const char *const valued[] = {"--bench-scene", "--repeats", "--size", "--threads", NULL};
    static const char *const not_here[] = {"--debug", "--exposure", "--rectify", "--splits", NULL};
    memset(o, 0, sizeof *o);
    for (int i = 0; i < argc; i++) {
        const char *a = argv[i];
        if (strcmp(a, "--help") == 0) {
            o->help = 1;
            return 0;
        }
        if (strcmp(a, "--brief") == 0) {
            o->brief = 1;
        } else if ((setting_of(a) && !is_in(a, not_here)) || is_in(a, valued)) {
            int taken;
            if (i + 1 == argc)
                return bad(a, NULL, "a value is missing after it");
            taken = take_bench(o, a, argv[++i]);
            if (taken < 0 || (!taken && take(o, a, argv[i]) != 0))
                return -1;
        } else {
            return bad("bench", a, "unknown option; see tyndall bench --help");
        }
    }
    return 0;
}

void options_help_bench(void)
{
    printf(
        "usage: tyndall bench [options]\n"
        "\n"
        "Times the post process on a built-in scene: ms, minima over the repeats, and how far the picture is from the exact\n"
        "march, in the same run.\n"
        "\n"
        "  --brief            one \"name value\" a line, nothing else\n"
        "  --bench-scene S    simple-on, simple-off, leafy-on, leafy-off (default)\n"
        "  --repeats N        default 15\n"
        "  --size WxH         default 1920x1080\n"
        "  --threads N        of shafts_ms; default 1\n"
        "\n"
        "and --preset, --method, --rays, --gather, --slices, --samples, --isa ... as tyndall render has them.\n");
}

static void help_of_render(void)
{
    printf("usage: tyndall render SCENE -o OUT [options]\n"
           "\n"
           "  --surface F.pfm    also the surfaces, not attenuated\n"
           "  --depth F.pfm      also the view-space depth\n"
           "  --frame PREFIX     also PREFIX.frame and what it names: all that tyndall post needs for the same picture\n"
           "  --size WxH         instead of the scene's\n"
           "  --shadow-size N    shadow map, texels, 1 .. 16384\n"
           "  --rectify R        epipolar (default) or projective: shadow maps whose rows are view rays, for a directional\n"
           "                     light off the screen\n"
           "  --splits N         of projective ones, 1 .. 6 (default 4)\n");
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
        "  --method M         epipolar (default), march (every pixel), subsample, none, prefiltered, hybrid\n"
        "  --rays R           words (default), tree, sweep, columns: the same picture; steps: fixed steps, see --steps\n"
        "  --steps N          per ray, 1 .. 4096\n"
        "  --gather G         shear (default), ivb, ed10: lines on the screen, and pixels from them\n"
        "  --taps N           of ed10, on each line, 3 .. 5\n"
        "  --kernel K         of ed10: gaussian (default), shepard, threshold\n"
        "  --slices N         epipolar slices, 8 .. 65536\n"
        "  --samples N        along a slice, 2 .. 65536\n"
        "  --initial-step N   samples between rays, 1, 2, 4 .. 64\n"
        "  --break T          relative jump of depth that counts as a break, above 0, at most 1\n"
        "  --tolerance T      refinement on light: error that rays between rays are set for, above 0, at most 1 (never)\n"
        "  --downscale F      1, 2, 4, 8: computed for each such row and column, then scaled up\n"
        "  --budget N         of --method subsample: rays, about\n"
        "  --bases M          of prefiltered and hybrid: sines and cosines, 4, 8 .. 128 (default 32)\n"
        "  --weights W        transmittance (default) or average\n"
        "  --references N     reference rays of a slice, 1 .. 4 (default 4)\n"
        "  --columns N        stored columns of a slice, 4 .. 4096 (default 96)\n"
        "  --threads N        1 .. 64; default: the machine's\n"
        "  --exposure E       multiplies radiance; default: automatic for display output, 1 for .pfm\n"
        "  --debug V          draw lines, samples, breaks, sources, scatter, row, tree, rejected, outside or basis instead\n"
        "  --at X,Y           of --debug row and tree: the pixel whose slice and ray are drawn; default: the middle\n"
        "  --isa I            scalar, sse2, avx2, avx512, neon or wasm; default: the best there is. All give the same bytes\n"
        "  --stats            print one \"name value\" a line\n"
        "\n"
        "All outputs appear when all are complete, or none; what was read was read before, so one may take an input's place.\n"
        "Exit status: 0 complete, 1 bad input, 2 bad usage.\n");
}
