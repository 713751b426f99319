/* art.c - see art.h */
#include "art.h"

#include "base.h"

void tyni_art_lamp(tyni_lamp *lamp, const tyn_light *light, const tyn_frame *frame)
{
    const float *tint = light->tint;
    int white = !(tint[0] > 0.0f || tint[1] > 0.0f || tint[2] > 0.0f);
    float scale = tyni_art_factor(light->scale);
    for (int32_t c = 0; c < 3; c++) { /* no brighter than a colour may be given */
        float factor = tyni_minf(white ? scale : scale * tint[c], TYN_MAX_COLOUR);
        lamp->colour[c] = tyni_minf(lamp->colour[c] * factor, TYN_MAX_COLOUR);
    }
    lamp->lift = 1.0f - tyni_art_factor(frame->shaft_contrast);
}

void tyni_art_fog(float fog[3], const float sigma[3], const tyn_frame *frame)
{
    float scale = tyni_art_factor(frame->fog_scale);
    for (int32_t c = 0; c < 3; c++)
        fog[c] = sigma[c] * scale;
}

tyn_status tyni_art_check(const tyn_frame *frame)
{
    if (!tyni_finite(frame->shaft_contrast) || !tyni_finite(frame->fog_scale) || !tyni_finite(frame->max_distance) ||
        frame->max_distance < 0.0f)
        return TYN_E_MEDIUM;
    return TYN_OK;
}
