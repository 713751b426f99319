/* coarse_kernel.h - a template: rays of a bundle from texel to texel, for ray.c. */

/* Of rays that `turn` at step coordinate `at`, those that differ from outside end to do so, and others begin. */
TYNI_V_INLINE v_mask TYNI_V(ray_turn)(tyni_bundle *b, int flat, const float rate[2], int32_t i, v_mask turn, v_mask on,
                                      v_float at)
{
    const v_float t = TYNI_V(ray_t)(b, flat, i, at), zero = v_set(0.0f);
    const v_float sign = v_select(turn, v_select(on, v_set(1.0f), v_set(-1.0f)), zero);
    v_store(b->visible[0] + i, v_load(b->visible[0] + i) + sign * TYNI_V(ray_dimmed)(rate[0] * t));
    v_store(b->visible[1] + i, v_load(b->visible[1] + i) + sign * TYNI_V(ray_dimmed)(rate[1] * t));
    return v_mor(v_mandnot(on, turn), v_mandnot(turn, on));
}

/* Where coarse rays come into a piece, and their map depth along it. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(ray_set_out)(const tyni_bundle *b, const tyni_slice *slice,
                                                            const tyni_view *view, const tyni_piece *piece, const tyni_map *map,
                                                            paces *w)
{
    const int flat = is_flat(piece);
    float first = 1e9f, last = -1.0f;
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_float from = v_load(b->from + i), until = v_load(b->until + i), zero = v_set(0.0f);
        const v_mask here = v_mand(v_unword(b->coarse >> i), v_lt(from, until));
        const v_float t0 = TYNI_V(ray_t)(b, flat, i, from), t1 = TYNI_V(ray_t)(b, flat, i, until);
        v_float v[3], c, d, wc, wd, z;
        TYNI_V(ray_way)(b, i, slice, view, v);
        TYNI_V(ray_form)(v, view, &map->z, &c, &d);
        TYNI_V(ray_form)(v, view, &map->w, &wc, &wd);
        z = (c + t0 * d) / (wc + t0 * wd);
        v_store(w->z + i, z);
        v_store(w->rise + i, v_select(here, ((c + t1 * d) / (wc + t1 * wd) - z) / (until - from), zero));
        v_store(w->at + i, v_select(here, from, until));
        first = tyni_minf(first, v_hmin(v_select(here, from, v_set(1e9f))));
        last = tyni_maxf(last, v_hmax(v_select(here, until, v_set(-1.0f))));
    }
    w->on = 0;
    w->first = (int32_t)first;
    w->last = tyni_mini((int32_t)last, piece->steps - 1);
}

/* Texels of so many steps from k on, at most PACES, and where they end. */
TYNI_V_INLINE void TYNI_V(ray_texels)(const tyni_piece *piece, const tyni_texels *t, int32_t k, int32_t steps,
                                      float z[2 * PACES], float end[2 * PACES])
{
    float part[3][PACES];
    for (int32_t i = 0; i < steps; i += v_n) {
        const v_int step = v_imin(v_iadd(v_iset(k + i), v_index()), v_iset(piece->steps - 1));
        v_int cell[2];
        v_float cut;
        TYNI_V(course_cells)(t, &piece->cells, step, cell, &cut);
        v_store(part[0] + i, TYNI_V(door_texels)(t, cell[0]));
        v_store(part[1] + i, TYNI_V(door_texels)(t, cell[1]));
        v_store(part[2] + i, cut);
    }
    for (int32_t i = 0; i < steps; i++) {
        z[2 * i] = part[0][i];
        z[2 * i + 1] = part[1][i];
        end[2 * i] = (float)(k + i) + part[2][i];
        end[2 * i + 1] = (float)(k + i + 1);
    }
}

/* Coarse rays over these texels. They change where they pass a texel's depth, and not where the ray through the middle of the
 * column does. A ray behind the farthest depth is at it, so that where a texel has no depth, 0, it is lit. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(ray_pass)(tyni_bundle *b, const tyni_piece *piece, const tyni_texels *t,
                                                         int32_t k, int outside, const float sigma[2], paces *w)
{
    const int flat = is_flat(piece);
    const int32_t steps = tyni_mini(w->last + 1 - k, PACES);
    float depth[2 * PACES], end[2 * PACES], rate[2];
    uint32_t on_word = 0;
    rate[0] = TYNI_V(ray_rate)(sigma[0]);
    rate[1] = TYNI_V(ray_rate)(sigma[1]);
    TYNI_V(ray_texels)(piece, t, k, steps, depth, end);
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_float from = v_load(b->from + i), until = v_load(b->until + i), zero = v_set(0.0f);
        const v_float base = v_load(w->z + i), rise = v_load(w->rise + i);
        v_float at = v_load(w->at + i), z = v_max(base + rise * (at - from), zero);
        v_mask on = v_unword(w->on >> i), turn;
        if (v_none(v_lt(at, until)))
            continue;
        for (int32_t e = 0; e < 2 * steps; e++) {
            const v_float next = v_clamp(v_set(end[e]), at, until), z1 = v_max(base + rise * (next - from), zero);
            const v_mask moves = v_lt(at, next), lit0 = v_ge(z, v_set(depth[e])), lit1 = v_ge(z1, v_set(depth[e]));
            v_mask in = v_mand(moves, lit0), out = v_mand(moves, lit1);
            if (outside) { /* from lit to what differs */
                in = v_mandnot(moves, lit0);
                out = v_mandnot(moves, lit1);
            }
            turn = v_mor(v_mandnot(in, on), v_mandnot(v_mand(moves, on), in));
            if (v_any(turn))
                on = TYNI_V(ray_turn)(b, flat, rate, i, turn, on, at);
            turn = v_mor(v_mandnot(in, out), v_mandnot(out, in));
            if (v_any(turn))
                on = TYNI_V(ray_turn)(b, flat, rate, i, turn, on,
                                      at + v_clamp((depth[e] - z) / (z1 - z), zero, v_set(1.0f)) * (next - at));
            at = next;
            z = z1;
        }
        v_store(w->at + i, at);
        turn = v_mandnot(on, v_lt(at, until)); /* behind the piece all is as outside */
        if (v_any(turn))
            on = TYNI_V(ray_turn)(b, flat, rate, i, turn, on, until);
        on_word |= v_word(on) << i;
    }
    w->on = on_word;
}
