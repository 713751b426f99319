/* line.h - a linear form along a view ray. */
#ifndef TYNI_LINE_H
#define TYNI_LINE_H

#include "slide.h"
#include "vec.h"
#include "view.h"

#include "base.h"

/* c + t * d */
typedef struct tyni_line {
    float c, d;
} tyni_line;

static inline tyni_line tyni_line_along(const tyni_form *f, const tyni_sight *v)
{
    tyni_line l;
    l.c = tyni_form_at(f, v->o);
    l.d = tyni_vec_dot(f->v, v->d);
    return l;
}

static inline float tyni_line_at(tyni_line l, float t)
{
    return l.c + t * l.d;
}

/* Narrows t[0] .. t[1] to where l >= 0; t[1] < t[0] where that is nowhere. */
static inline void tyni_line_clip(tyni_line l, float t[2])
{
    float a = tyni_line_at(l, t[0]), b = tyni_line_at(l, t[1]);
    if (a < 0.0f && b < 0.0f)
        t[1] = t[0] - 1.0f;
    else if (a < 0.0f)
        t[0] = t[0] + (t[1] - t[0]) * (a / (a - b));
    else if (b < 0.0f)
        t[1] = t[0] + (t[1] - t[0]) * (a / (a - b));
}

#endif
