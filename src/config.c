/* config.c - see config.h */
#include "config.h"

#include "base.h"

tyn_status tyn_config_preset(tyn_config *config, tyn_preset preset, int32_t width, int32_t height)
{
    static const struct {
        int32_t divisor, most, samples, rays, shadow;
        float tolerance;
    } table[] = {{16, 256, 2, 16, 256, 0.04f},
                 {8, 512, 2, 32, 1024, 0.02f},
                 {1, 1024, 1, 96, 2048, 0.01f},
                 {1, 4096, 1, 192, 4096, 0.003f}};
    const int32_t longer = tyni_maxi(width, height);
    if (!config)
        return TYN_E_NULL;
    if (width < 1 || height < 1 || width > TYN_MAX_SIZE || height > TYN_MAX_SIZE || (uint32_t)preset > TYN_PRESET_REFERENCE)
        return TYN_E_CONFIG;
    memset(config, 0, sizeof *config);
    config->width = width;
    config->height = height;
    config->slices = tyni_clampi(2 * (width + height) / table[preset].divisor, 16, table[preset].most);
    config->samples = tyni_maxi((longer - 2 + table[preset].samples) / table[preset].samples + 1, 2);
    /* as many initial rays on a line whatever the size of the picture: what is between two of them looks the same */
    config->initial_step = 1;
    while (config->initial_step < 16 && 2 * config->initial_step * table[preset].rays <= config->samples)
        config->initial_step *= 2;
    config->break_threshold = 0.06f;
    config->tolerance = table[preset].tolerance;
    config->shadow_size = table[preset].shadow;
    config->steps = 150;
    config->taps = 3;
    config->downscale = 1;
    config->maps = 1;
    config->lights = 1;
    config->workers = 1;
    config->bases = 32;
    config->columns = 96;
    config->references = 4;
    config->quads = TYNI_HAS(TYN_PART_QUADS) && preset == TYN_PRESET_HANDHELD;
    return TYN_OK;
}

static int outside(int32_t x, int32_t low, int32_t high)
{
    return x < low || x > high;
}

/* What this build has left out. */
static int absent(const tyn_config *c)
{
    int prefiltered = c->method == TYN_METHOD_PREFILTERED || c->method == TYN_METHOD_HYBRID;
    int gathers = c->gather != TYN_GATHER_SHEAR || c->downscale > 1 || c->method == TYN_METHOD_SUBSAMPLE;
    return (!TYNI_HAS(TYN_PART_PREFILTERED) && prefiltered) || (!TYNI_HAS(TYN_PART_GATHERS) && gathers) ||
           (!TYNI_HAS(TYN_PART_RAYS) && c->rays != TYN_RAYS_WORDS) || (!TYNI_HAS(TYN_PART_SLIDES) && c->textured) ||
           (!TYNI_HAS(TYN_PART_QUADS) && c->quads);
}

/* What prefiltered rows are made of. */
static tyn_status fill_rows(tyn_config *c, const tyn_config *preset)
{
    c->bases = c->bases ? c->bases : preset->bases;
    c->columns = c->columns ? c->columns : preset->columns;
    c->references = c->references ? c->references : preset->references;
    if (outside(c->bases, 4, 128) || c->bases % 4 || outside(c->columns, 4, 4096) || outside(c->references, 1, 4) ||
        outside(c->paper, 0, 15) || (uint32_t)c->weights > (uint32_t)TYN_WEIGHTS_AVERAGE ||
        (uint32_t)c->reference > (uint32_t)TYN_REFERENCE_GEOMETRIC)
        return TYN_E_CONFIG;
    return TYN_OK;
}

tyn_status tyni_config_fill(tyn_config *c)
{
    tyn_config preset;
    if (tyn_config_preset(&preset, TYN_PRESET_QUALITY, c->width, c->height) != TYN_OK)
        return TYN_E_CONFIG;
    c->slices = c->slices ? c->slices : preset.slices;
    c->samples = c->samples ? c->samples : preset.samples;
    c->initial_step = c->initial_step ? c->initial_step : preset.initial_step;
    c->break_threshold = c->break_threshold == 0.0f ? preset.break_threshold : c->break_threshold;
    c->tolerance = c->tolerance == 0.0f ? preset.tolerance : c->tolerance;
    c->shadow_size = c->shadow_size ? c->shadow_size : preset.shadow_size;
    c->steps = c->steps ? c->steps : preset.steps;
    c->taps = c->taps ? c->taps : preset.taps;
    c->downscale = c->downscale ? c->downscale : preset.downscale;
    c->maps = c->maps ? c->maps : preset.maps;
    c->lights = c->lights ? c->lights : preset.lights;
    c->workers = c->workers ? c->workers : preset.workers;
    if (outside(c->slices, 8, 65536) || outside(c->samples, 2, 65536) || outside(c->initial_step, 1, 64) ||
        (c->initial_step & (c->initial_step - 1)) || outside(c->shadow_size, 1, TYN_MAX_SHADOW) || outside(c->steps, 1, 4096) ||
        outside(c->maps, 1, TYN_MAX_MAPS) || outside(c->lights, 1, TYN_MAX_LIGHTS) || outside(c->workers, 1, TYN_MAX_WORKERS) ||
        outside(c->isa, 0, 2 * TYN_ISA_WASM - 1))
        return TYN_E_CONFIG;
    if ((int64_t)c->slices * tyni_mini(c->samples, tyni_maxi(c->width, c->height)) > 1 << 28)
        return TYN_E_CONFIG;
    if (!(c->break_threshold > 0.0f && c->break_threshold <= 1.0f) || !(c->tolerance > 0.0f && c->tolerance <= 1.0f))
        return TYN_E_CONFIG;
    if ((uint32_t)c->method > (uint32_t)TYN_METHOD_HYBRID || (uint32_t)c->rays > (uint32_t)TYN_RAYS_COLUMNS ||
        (uint32_t)c->gather > (uint32_t)TYN_GATHER_ED10 || (uint32_t)c->kernel > (uint32_t)TYN_KERNEL_THRESHOLD)
        return TYN_E_CONFIG;
    if (outside(c->taps, 3, 5) || outside(c->downscale, 1, 8) || (c->downscale & (c->downscale - 1)) || c->budget < 0)
        return TYN_E_CONFIG;
    return absent(c) ? TYN_E_CONFIG : fill_rows(c, &preset);
}
