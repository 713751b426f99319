/* walk_kernel.h - a template: the fixed steps of a ray side by side, for walk.c. */

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
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
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
        if (lamp->coloured) {
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
