/* picture.c - see picture.h */
#include "picture.h"

#include "base.h"
#include "check.h"
#include "composite.h"
#include "lanes/lanes.h"

typedef char picture_fits[sizeof(tyni_picture) <= TYN_BUNDLE_BYTES ? 1 : -1]; /* it has that part of the worker's scratch */

#define TYNI_KERNEL "picture_kernel.h"
#include "lanes/each.h"

static int four_bytes(tyn_format format)
{
    return format == TYN_RGBA8_SRGB || format == TYN_BGRA8_SRGB;
}

int tyni_picture_begin(const tyni_pass *p, tyni_picture *q)
{
    const tyn_frame *f = p->frame;
    const tyni_medium *m = &p->medium;
    const int32_t order[3] = {m->low, m->high, m->middle};
    if (!p->first || !p->last || p->count == 3 || p->method == TYN_METHOD_NONE ||
        (p->method == TYN_METHOD_MARCH && !tyni_pass_gridded(p)) || tyni_prefilter_kept(p->method) ||
        tyni_view_kind(p->lamp) != TYN_LIGHT_DIRECTIONAL || tyni_view_bounded(p->lamp))
        return 0;
    if (f->debug || f->scatter.pixels || f->transmittance.pixels || !f->colour.pixels || !f->target.pixels ||
        !four_bytes(f->colour.format) || !four_bytes(f->target.format))
        return 0;
    q->medium = *m;
    for (int32_t n = 0; n < 3; n++) {
        const int32_t c = order[n];
        if (p->fog[c] != m->sigma[c] || m->sigma[c] <= TYNI_SIGMA_LEAST)
            return 0;
        q->medium.sigma[n] = m->sigma[c];
        q->medium.isotropic[n] = m->isotropic[c];
        q->medium.rayleigh[n] = m->rayleigh[c];
        for (int32_t i = 0; i < m->hg_count; i++)
            q->medium.hg[i].scale[n] = m->hg[i].scale[c];
        q->inverse[n] = 1.0f / m->sigma[c];
        q->colour[n] = p->lamp->colour[c];
        q->from_byte[n] = f->colour.format == TYN_BGRA8_SRGB ? 2 - c : c;
        q->shift[n] = 8 * (f->target.format == TYN_BGRA8_SRGB ? 2 - c : c);
    }
    q->between[0] = (1.0f - m->blend) * (1.0f - m->blend);
    q->between[1] = m->blend * m->blend;
    q->between[2] = 2.0f * (1.0f - m->blend) * m->blend;
    for (int32_t i = 0; i < m->hg_count; i++) {
        q->base[i] = (1.0f - m->hg[i].g) * (1.0f - m->hg[i].g);
        q->slope[i] = 2.0f * m->hg[i].g;
    }
    q->opaque = (int32_t)0xff000000u;
    q->exposure = f->display.exposure > 0.0f ? f->display.exposure : 1.0f;
    q->tone = f->display.tone;
    return 1;
}

void tyni_picture_run(const tyni_pass *p, const tyni_run *r, tyni_picture *q)
{
    q->from = (const uint8_t *)tyni_image_row(&p->frame->colour, r->y) + (ptrdiff_t)r->x * 4;
    q->target = (uint8_t *)tyni_image_row(&p->frame->target, r->y) + (ptrdiff_t)r->x * 4;
    tyni_composite_offsets(&p->frame->display, r->y, q->offset);
    TYNI_LANES_CALL(p->context->config.isa, pixel_picture, (r, q));
}
