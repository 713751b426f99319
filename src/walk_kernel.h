/* walk_kernel.h - a template: texels and fixed steps of a ray side by side, for walk.c. */

/* Of steps k .. k + 31, a bit each: whether the ray is lit where it comes into the step's first texel and where it leaves it,
 * then the same of the second; where there is none, what the first one left behind. What lies behind the last step is anything.
 * A ray behind the farthest depth is at it, so that where a texel has no depth, 0, it is lit. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(walk_states)(const traversal *r, int32_t k, uint32_t lit[4])
{
    const tyni_texels *t = r->texels;
    const tyni_course *c = &r->course;
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const int32_t way = c->sign > 0.0f ? along : -along, base = r->cells.first * along;
    const v_int most = v_iset((c->across ? t->height : t->width) - 1), none = v_iset(0);
    const v_float zero = v_set(0.0f);
    uint32_t in0 = 0, out0 = 0, in1 = 0, out1 = 0;
    v_float to = zero, z2 = zero;
    v_int b = none;
    for (int32_t i = 0; i < 32 && k + i < r->steps; i += v_n) {
        const v_int step = v_imin(v_iadd(v_iset(k + i), v_index()), v_iset(r->steps - 1));
        const v_int texel = v_iadd(v_imul(step, v_iset(way)), v_iset(base));
        const v_float at = v_to_float(step), at0 = v_max(at, v_set(c->from)), at2 = v_min(at + 1.0f, v_set(c->to));
        v_float from = to, z0 = z2;
        v_int a = b;
        v_mask one;
        if (v_n > 1 || i == 0) { /* one lane has them: a step begins where the one before it ends */
            from = c->minor + c->slope * at;
            z0 = v_max(r->z + at0 * r->dz, zero);
            a = v_imin(v_trunc(v_max(from, v_set(0.0f))), most);
        }
        to = c->minor + c->slope * (at + 1.0f);
        z2 = v_max(r->z + at2 * r->dz, zero);
        b = v_imin(v_trunc(v_max(to, v_set(0.0f))), most);
        one = v_ieq(a, b);
        v_float depth = TYNI_V(door_texels)(t, v_iadd(texel, v_imul(a, v_iset(aside)))), z1 = z2;
        v_mask in, out;
        if (!v_all(one)) {
            const v_float cut = v_clamp(at + (v_to_float(v_imax(a, b)) - from) * r->rise, at0, at2);
            z1 = v_select(one, z2, v_max(r->z + cut * r->dz, zero));
        }
        in0 |= v_word(v_ge(z0, depth)) << i;
        out = v_ge(z1, depth);
        out0 |= v_word(out) << i;
        in = out;
        if (!v_all(one)) {
            depth = TYNI_V(door_texels)(t, v_iadd(texel, v_imul(b, v_iset(aside))));
            in = v_mor(v_mand(one, out), v_mandnot(v_ge(z1, depth), one));
            out = v_mor(v_mand(one, out), v_mandnot(v_ge(z2, depth), one));
        }
        in1 |= v_word(in) << i;
        out1 |= v_word(out) << i;
    }
    lit[0] = in0;
    lit[1] = out0;
    lit[2] = in1;
    lit[3] = out1;
}

/* track_t of a step coordinate. */
TYNI_V_INLINE v_float TYNI_V(walk_t)(const traversal *r, const track *way, v_float at)
{
    const v_float s = v_clamp((at - r->course.from) / (r->course.to - r->course.from), v_set(0.0f), v_set(1.0f));
    const v_float a = (1.0f - s) * way->w[1], b = s * way->w[0];
    return (a * way->t[0] + b * way->t[1]) / (a + b);
}

/* The step coordinate of a turn: what walk_states has of it. */
TYNI_V_INLINE v_float TYNI_V(walk_place)(const traversal *r, v_int step, v_int state)
{
    const tyni_texels *t = r->texels;
    const tyni_course *c = &r->course;
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const v_int most = v_iset((c->across ? t->height : t->width) - 1), none = v_iset(0);
    const v_int texel = v_iadd(v_imul(step, v_iset(c->sign > 0.0f ? along : -along)), v_iset(r->cells.first * along));
    const v_float at = v_to_float(step), from = c->minor + c->slope * at, to = c->minor + c->slope * (at + 1.0f);
    const v_int a = v_imin(v_trunc(v_max(from, v_set(0.0f))), most), b = v_imin(v_trunc(v_max(to, v_set(0.0f))), most);
    const v_float begin = v_max(at, v_set(c->from)), end = v_min(at + 1.0f, v_set(c->to));
    const v_float cut = v_select(v_ieq(a, b), end, v_clamp(at + (v_to_float(v_imax(a, b)) - from) * r->rise, begin, end));
    const v_mask second = v_igt(state, v_iset(1)), passes = v_igt(v_iand(state, v_iset(1)), none);
    const v_float s0 = v_select(second, cut, begin), s1 = v_select(second, end, cut);
    v_float z, z0, rise, part;
    if (v_none(passes))
        return s0;
    z = TYNI_V(door_texels)(t, v_iadd(texel, v_imul(v_iselect(second, b, a), v_iset(aside))));
    z0 = r->z + s0 * r->dz;
    rise = (r->z + s1 * r->dz) - z0;
    part = v_clamp((z - z0) / rise, v_set(0.0f), v_set(1.0f)); /* passes() */
    return s0 + v_select(v_mand(passes, v_ne(rise, v_set(0.0f))), part, v_set(0.0f)) * (s1 - s0);
}

/* tyni_meter_lit of turns, at most TURNS, for a sun without colours. For other light their t, in their places, and no more. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(walk_turns)(const traversal *r, const track *way, int32_t *turn, int32_t count,
                                                           int plain, tyni_meter *m)
{
    const tyni_integral *it = m->integral;
    const v_int one = v_iset(1);
    /* every other one begins what differs from outside, and the integral up to it is taken away */
    const v_float even = v_set(m->on ? 1.0f : -1.0f);
    v_float t[TURNS / v_n] = {v_set(0.0f)}, sum[TURNS / v_n];
    for (int32_t i = 0; i < count; i += v_n) {
        const v_int at = v_iload_n(turn + i, count - i);
        t[i / v_n] = TYNI_V(walk_t)(r, way, TYNI_V(walk_place)(r, v_shr(at, 2), v_iand(at, v_iset(3))));
        if (!plain)
            v_istore_n(turn + i, v_bits(t[i / v_n]), count - i);
    }
    for (int32_t c = 0; c < it->count && plain; c++) {
        const float sigma = it->sigma[c], inverse = sigma > TYNI_SIGMA_LEAST ? 1.0f / sigma : 0.0f;
        for (int32_t i = 0; i < TURNS; i += v_n) {
            const v_mask here = v_first(count - i), odd = v_ieq(v_iand(v_iadd(v_iset(i), v_index()), one), one);
            v_float before, left;
            sum[i / v_n] = v_set(0.0f);
            if (i >= count)
                continue;
            before = t[i / v_n];
            if (inverse > 0.0f) {
                v_fade(sigma * before, &left, &before);
                before = before * inverse;
            }
            sum[i / v_n] = before * v_select(here, v_select(odd, -even, even), v_set(0.0f));
        }
        m->sum[c] += v_sum16(sum);
    }
    if (plain)
        m->on ^= count & 1;
}

/* Whether the middles of paces k .. k + 31 are lit, as walk_states has it of steps. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(walk_paces)(const traversal *r, int32_t pace, int32_t k, uint32_t lit[4])
{
    const tyni_texels *t = r->texels;
    const tyni_course *c = &r->course;
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const int32_t way = c->sign > 0.0f ? along : -along, base = r->cells.first * along,
                  most = (c->across ? t->height : t->width) - 1;
    uint32_t word = 0;
    for (int32_t i = 0; i < 32 && (k + i) * pace < r->steps; i += v_n) {
        const v_float middle = (v_to_float(v_iadd(v_iset(k + i), v_index())) + 0.5f) * (float)pace;
        const v_float at = v_clamp(middle, v_set(c->from), v_set(c->to));
        const v_int step = v_imin(v_trunc(at), v_iset(r->steps - 1));
        const v_int beside = v_imin(v_trunc(v_max(c->minor + c->slope * at, v_set(0.0f))), v_iset(most));
        const v_int texel = v_iadd(v_iadd(v_imul(step, v_iset(way)), v_iset(base)), v_imul(beside, v_iset(aside)));
        const v_float z = v_max(r->z + at * r->dz, v_set(0.0f));
        word |= v_word(v_ge(z, TYNI_V(door_texels)(t, texel))) << i;
    }
    lit[0] = lit[1] = lit[2] = lit[3] = word;
}

/* Which steps are lit: each is looked up in the first map that covers it. */
TYNI_V_INLINE v_mask TYNI_V(walk_lit)(const tyni_lamp *lamp, const tyni_sight *v, v_float t, v_mask wanted)
{
    const v_float zero = v_set(0.0f);
    const v_mask none = v_mandnot(wanted, wanted);
    v_mask lit = lamp->outside ? wanted : none, open = wanted;
    for (int32_t i = 0; i < lamp->map_count && v_any(open); i++) {
        const tyni_texels *texels = &lamp->maps[i].texels;
        trail k;
        v_float w, x, y, z, depth;
        v_mask here, clear;
        v_int at;
        trail_of(&k, &lamp->maps[i], v);
        w = k.w.c + t * k.w.d;
        x = (k.u.c + t * k.u.d) / w;
        y = (k.v.c + t * k.v.d) / w;
        here = v_mand(v_mand(open, v_gt(w, zero)), v_mand(v_ge(x, zero), v_ge(y, zero)));
        here = v_mand(here, v_mand(v_lt(x, v_set((float)texels->width)), v_lt(y, v_set((float)texels->height))));
        if (v_none(here))
            continue;
        x = v_select(here, x, zero);
        y = v_select(here, y, zero);
        at = v_iadd(v_imul(v_trunc(x), v_iset(texels->bytes)), v_imul(v_trunc(y), v_iset((int32_t)texels->pitch)));
        depth = TYNI_V(door_texels)(texels, at);
        z = (k.z.c + t * k.z.d) / w;
        clear = v_mand(here, v_mor(v_le(depth, zero), v_ge(z, depth)));
        lit = v_mor(v_mandnot(lit, here), clear);
        open = v_mandnot(open, here);
    }
    return lit;
}

/* tyni_integral_density of each step. */
TYNI_V_INLINE void TYNI_V(walk_density)(const tyni_medium *m, const tyni_lamp *lamp, const tyni_sight *v, v_float t,
                                        v_float density[3])
{
    const tyni_vec3 from = tyni_vec_sub(lamp->position, v->o);
    v_float x, y, z, r2, r, cosine;
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        for (int32_t c = 0; c < 3; c++)
            density[c] = v_exp(-m->sigma[c] * t);
        return;
    }
    x = from.x - t * v->d.x;
    y = from.y - t * v->d.y;
    z = from.z - t * v->d.z;
    r2 = v_max(x * x + y * y + z * z, v_set(lamp->radius * lamp->radius));
    r = v_sqrt(r2);
    cosine = v_clamp((x * v->d.x + y * v->d.y + z * v->d.z) / r, v_set(-1.0f), v_set(1.0f));
    TYNI_V(medium_mix)(m, cosine, density);
    for (int32_t c = 0; c < 3; c++)
        density[c] = density[c] * v_exp(-m->sigma[c] * (t + r)) / r2;
}

/* Adds what the steps scatter that are lit, or those that are not. */
static TYNI_V_TARGET void TYNI_V(walk_steps)(const tyni_lamp *lamp, const tyni_medium *m, const tyni_sight *v, const stride *s,
                                             int lit_ones, float light[3])
{
    v_float sum[3][16 / v_n];
    for (int32_t c = 0; c < 3; c++)
        for (int32_t i = 0; i < 16 / v_n; i++)
            sum[c][i] = v_set(0.0f);
    for (int32_t i = 0; i < s->steps; i += v_n) {
        const v_mask wanted = v_first(s->steps - i);
        const v_float t = s->from + (v_to_float(v_iadd(v_iset(i), v_index())) + 0.5f) * s->dt, zero = v_set(0.0f);
        const int32_t part = i / v_n % (16 / v_n);
        v_mask these = TYNI_V(walk_lit)(lamp, v, t, wanted);
        v_float density[3];
        if (!lit_ones)
            these = v_mandnot(wanted, these);
        if (v_none(these))
            continue;
        TYNI_V(walk_density)(m, lamp, v, t, density);
        if (tyni_view_coloured(lamp)) {
            float at[v_n], rgb[3][v_n] = {{0.0f}};
            v_store(at, t);
            colours(lamp, v, at, tyni_mini(v_n, s->steps - i), rgb[0], v_n);
            for (int32_t c = 0; c < 3; c++)
                density[c] = density[c] * v_load_n(rgb[c], s->steps - i);
        }
        for (int32_t c = 0; c < 3; c++)
            sum[c][part] = sum[c][part] + v_select(these, density[c], zero);
    }
    for (int32_t c = 0; c < 3; c++)
        light[c] += v_sum16(sum[c]) * s->dt;
}
