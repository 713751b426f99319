/* devices.c - the table of memory in ports/README.md, as tyn_measure has it. */
#include <stdio.h>

#include "tyndall.h"

static const struct {
    int32_t width, height;
    tyn_preset preset;
    tyn_format format; /* of colour and picture, in place */
    int32_t map;       /* texels of a side; its texels are 16 bits */
    int32_t dots;      /* not 0: a display of 1 bit a pixel beside it, of this many bytes */
} devices[] = {
    {160, 120, TYN_PRESET_HANDHELD, TYN_RGB565_SRGB, 128, 0}, {240, 160, TYN_PRESET_HANDHELD, TYN_RGB565_SRGB, 256, 0},
    {320, 240, TYN_PRESET_HANDHELD, TYN_RGB565_SRGB, 256, 0}, {400, 240, TYN_PRESET_HANDHELD, TYN_RGB565_SRGB, 256, 52 * 240},
    {480, 272, TYN_PRESET_HANDHELD, TYN_RGB565_SRGB, 512, 0}, {640, 480, TYN_PRESET_BALANCED, TYN_RGB565_SRGB, 1024, 0},
    {960, 544, TYN_PRESET_BALANCED, TYN_RGBA8_SRGB, 1024, 0}, {1280, 720, TYN_PRESET_BALANCED, TYN_RGBA8_SRGB, 1024, 0},
    {1280, 720, TYN_PRESET_QUALITY, TYN_RGBA8_SRGB, 2048, 0},
};

static int failed;

static double kib(const tyn_config *config)
{
    size_t bytes = 0;
    failed |= tyn_measure(config, &bytes) != TYN_OK;
    return (double)bytes / 1024;
}

/* What the config takes more than `base`, with one field set. */
static double more(tyn_config config, double base, int32_t *field, int32_t value, tyn_config *own)
{
    *own = config;
    *field = value;
    return kib(own) - base;
}

int main(void)
{
    static const char *const names[] = {"handheld", "balanced", "quality", "reference"};
    printf("| picture | preset, map | lines x samples | context | textured | 2nd worker | 2nd light | sweep | pictures | in "
           "all |\n"
           "|---|---|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof devices / sizeof *devices; i++) {
        const int32_t width = devices[i].width, height = devices[i].height, map = devices[i].map;
        const size_t pixels = (size_t)width * (size_t)height;
        const size_t pictures = pixels * (2 + (size_t)tyn_format_bytes(devices[i].format)) + 2 * (size_t)map * (size_t)map +
                                (size_t)devices[i].dots;
        tyn_config c, own;
        double base;
        failed |= tyn_config_preset(&c, devices[i].preset, width, height) != TYN_OK;
        c.shadow_size = map;
        base = kib(&c);
        printf("| %dx%d%s | %s, %d | %d x %d | %.1f |", (int)width, (int)height, devices[i].dots ? " dots" : "",
               names[devices[i].preset], (int)map, (int)c.slices, (int)c.samples, base);
        printf(" %+.1f |", more(c, base, &own.textured, 1, &own));
        printf(" %+.1f |", more(c, base, &own.workers, 2, &own));
        printf(" %+.1f |", more(c, base, &own.lights, 2, &own));
        own = c;
        own.rays = TYN_RAYS_SWEEP;
        printf(" %+.1f | %.1f | %.1f |\n", kib(&own) - base, (double)pictures / 1024, base + (double)pictures / 1024);
    }
    return failed;
}
