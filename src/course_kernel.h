/* course_kernel.h - a template: texels of steps side by side, for who includes course.h. */

/* Asks for the texels beside these steps that the next courses read, which lie as far from this one as this from `before`, and
 * as far again. Along v each step has a line of memory of its own, which neighbours share: there it is the line beside it. */
TYNI_V_INLINE void TYNI_V(course_ahead)(const tyni_texels *t, const tyni_cells *c, const tyni_cells *before, v_int step)
{
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const int32_t line = 64 / t->bytes;
    const v_float most = v_set((float)((c->across ? t->height : t->width) - 1)), at = v_to_float(step);
    const v_float shift = (c->minor - before->minor) + (c->slope - before->slope) * at, there = c->minor + c->slope * at;
    int32_t next[v_n];
    v_float to = there + 2.0f * shift;
    if (!c->across)
        to = there + v_select(v_lt(shift, v_set(0.0f)), v_min(shift, v_set(-(float)line)), v_max(shift, v_set((float)line)));
    v_istore(next, v_iadd(v_imul(v_iadd(v_iset(c->first), v_imul(step, v_iset(c->way))), v_iset(along)),
                          v_imul(v_trunc(v_clamp(to, v_set(0.0f), most)), v_iset(aside))));
    for (int32_t i = 0; i < v_n; i += c->across ? 4 : 1)
        TYNI_PREFETCH(t->pixels + next[i]);
}

/* Where the texels of steps are, as offsets of bytes: of the first one, and of the second, which begins at step + cut. Returns
 * where there is none: cut is 1 then, and both are the same. */
TYNI_V_INLINE v_mask TYNI_V(course_cells)(const tyni_texels *t, const tyni_cells *c, v_int step, v_int cell[2], v_float *cut)
{
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const v_int most = v_iset((c->across ? t->height : t->width) - 1);
    const v_float zero = v_set(0.0f);
    const v_float at = v_to_float(step), from = c->minor + c->slope * at, to = c->minor + c->slope * (at + 1.0f);
    const v_int a = v_imin(v_trunc(v_max(from, zero)), most), b = v_imin(v_trunc(v_max(to, zero)), most);
    const v_int base = v_imul(v_iadd(v_iset(c->first), v_imul(step, v_iset(c->way))), v_iset(along));
    const v_mask one = v_ieq(a, b);
    *cut = v_set(1.0f);
    if (!v_all(one)) /* |slope| <= 1: they are neighbours */
        *cut = v_select(one, *cut, v_clamp((v_to_float(v_imax(a, b)) - from) / c->slope, zero, v_set(1.0f)));
    cell[0] = v_iadd(base, v_imul(a, v_iset(aside)));
    cell[1] = v_iadd(base, v_imul(b, v_iset(aside)));
    return one;
}
