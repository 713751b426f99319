/* walk_kernel.h - a template: texels and fixed steps of a ray side by side, for walk.c. */

/* Steps k .. k + 31; what lies behind the last is anything. A ray behind the farthest depth is at it, so that where a texel has
 * no depth, 0, it is lit. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(walk_states)(const traversal *r, int32_t k, states *lit)
{
    const tyni_texels *t = r->texels;
    const tyni_course *c = &r->course;
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const int32_t way = c->sign > 0.0f ? along : -along, base = r->first * along;
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
            a = v_imin(v_imax(v_floori(from), none), most);
        }
        to = c->minor + c->slope * (at + 1.0f);
        z2 = v_max(r->z + at2 * r->dz, zero);
        b = v_imin(v_imax(v_floori(to), none), most);
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
    lit->in[0] = in0;
    lit->out[0] = out0;
    lit->in[1] = in1;
    lit->out[1] = out1;
}

/* Whether the middles of paces k .. k + 31 are lit. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(walk_paces)(const traversal *r, int32_t pace, int32_t k, uint32_t *lit)
{
    const tyni_texels *t = r->texels;
    const tyni_course *c = &r->course;
    const int32_t pitch = (int32_t)t->pitch, along = c->across ? t->bytes : pitch, aside = c->across ? pitch : t->bytes;
    const int32_t way = c->sign > 0.0f ? along : -along, base = r->first * along, most = (c->across ? t->height : t->width) - 1;
    uint32_t word = 0;
    for (int32_t i = 0; i < 32 && (k + i) * pace < r->steps; i += v_n) {
        const v_float middle = (v_to_float(v_iadd(v_iset(k + i), v_index())) + 0.5f) * (float)pace;
        const v_float at = v_clamp(middle, v_set(c->from), v_set(c->to));
        const v_int step = v_imin(v_trunc(at), v_iset(r->steps - 1));
        const v_int beside = v_imin(v_imax(v_floori(c->minor + c->slope * at), v_iset(0)), v_iset(most));
        const v_int texel = v_iadd(v_iadd(v_imul(step, v_iset(way)), v_iset(base)), v_imul(beside, v_iset(aside)));
        const v_float z = v_max(r->z + at * r->dz, v_set(0.0f));
        word |= v_word(v_ge(z, TYNI_V(door_texels)(t, texel))) << i;
    }
    *lit = word;
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
            float at[v_n], rgb[3][v_n];
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
