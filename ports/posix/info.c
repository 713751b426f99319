/* info.c - tyndall info */
#include "commands.h"
#include "error.h"
#include "pool.h"

#include <stdio.h>

#include "tyndall.h"

static void print_isas(const char *name, int32_t isas)
{
    printf("%s", name);
    for (int32_t isa = 1; isa <= isas; isa *= 2)
        if (isas & isa)
            printf(" %s", tyn_isa_name(isa));
    printf("\n");
}

static int32_t best_of(int32_t isas)
{
    int32_t best = 1;
    while (isas / 2 >= best)
        best *= 2;
    return best;
}

int command_info(int argc, char **argv)
{
    static const struct {
        const char *name;
        tyn_preset preset;
    } presets[] = {{"handheld", TYN_PRESET_HANDHELD},
                   {"balanced", TYN_PRESET_BALANCED},
                   {"quality", TYN_PRESET_QUALITY},
                   {"reference", TYN_PRESET_REFERENCE}};
    static const int32_t sizes[3][2] = {{320, 240}, {1280, 720}, {1920, 1080}};
    if (argc > 0) {
        error_say("info: unknown option '%s'", argv[0]);
        return 2;
    }
    printf("version %s\n", tyn_version());
    print_isas("isa_built", tyn_isa_built());
    print_isas("isa_available", tyn_isa_available());
    print_isas("isa_picked", best_of(tyn_isa_available()));
    printf("threads %ld\n", (long)pool_default_workers());
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++)
        for (size_t i = 0; i < 3; i++) {
            tyn_config config;
            size_t bytes = 0;
            tyn_status status = tyn_config_preset(&config, presets[p].preset, sizes[i][0], sizes[i][1]);
            if (status == TYN_OK)
                status = tyn_measure(&config, &bytes);
            if (status == TYN_OK)
                printf("memory_%s_%ldx%ld_bytes %lu\n", presets[p].name, (long)sizes[i][0], (long)sizes[i][1],
                       (unsigned long)bytes);
            else
                error_say("%s at %ldx%ld: %s", presets[p].name, (long)sizes[i][0], (long)sizes[i][1], tyn_status_name(status));
        }
    return 0;
}
