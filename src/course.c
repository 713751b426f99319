/* course.c - see course.h */
#include "course.h"

#include "base.h"

void tyni_course_begin(tyni_course *c, const float u[2], const float v[2])
{
    const float *major, *other;
    c->across = tyni_absf(u[1] - u[0]) >= tyni_absf(v[1] - v[0]);
    major = c->across ? u : v;
    other = c->across ? v : u;
    c->sign = major[1] >= major[0] ? 1.0f : -1.0f;
    c->base = c->sign > 0.0f ? (float)tyni_floori(major[0]) : (float)tyni_ceili(major[0]);
    c->slope = major[1] != major[0] ? (other[1] - other[0]) / (c->sign * (major[1] - major[0])) : 0.0f;
    c->minor = other[0] - c->slope * (c->sign * (major[0] - c->base));
    c->from = c->sign * (major[0] - c->base);
    c->to = c->sign * (major[1] - c->base);
    c->steps = tyni_maxi(tyni_ceili(c->to), 1);
}

int32_t tyni_course_on(const tyni_course *c, const tyni_texels *texels, tyni_cells *cells)
{
    int32_t size = c->across ? texels->width : texels->height;
    int32_t first = tyni_clampi((int32_t)c->base - (c->sign < 0.0f), 0, size - 1);
    cells->minor = c->minor;
    cells->slope = c->slope;
    cells->first = (int16_t)first;
    cells->across = (int8_t)c->across;
    cells->way = c->sign > 0.0f ? 1 : -1;
    return tyni_mini(c->steps, c->sign > 0.0f ? size - first : first + 1);
}
