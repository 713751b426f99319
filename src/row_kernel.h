/* row_kernel.h - a template: thresholds of a row, for row.c. */

/* The threshold of a surface at column coordinate g and map depth z: 0 is dark even at the lit end, 65535 is lit to the dark
 * end, as it is where there is nothing (z = 0). */
TYNI_V_INLINE v_int TYNI_V(row_column)(const ends *e, v_float g, v_float z)
{
    const v_float f0 = e->g[0] * g + e->z[0] * z + e->c[0], f1 = e->g[1] * g + e->z[1] * z + e->c[1], zero = v_set(0.0f);
    const v_mask dark = v_le(f0, zero), lit = v_gt(f1, zero), some = v_gt(z, zero);
    v_float part = f0 / (f0 - f1);
    part = v_clamp(65534.0f * part + 0.9999f, zero, v_set(65535.0f));
    part = v_select(lit, v_set(65535.0f), part);
    part = v_select(dark, zero, part);
    return v_trunc(v_select(some, part, v_set(65535.0f)));
}

/* Two numbers of 16 bits each to memory, those of n lanes. */
TYNI_V_INLINE void TYNI_V(row_pairs)(uint16_t *p, v_int a, v_int b, int32_t n)
{
    const uint16_t one = 1;
    uint8_t low_first;
    memcpy(&low_first, &one, 1);
    v_istore_n(p, low_first ? v_ior(a, v_shl(b, 16)) : v_ior(b, v_shl(a, 16)), n);
}

/* last: the cells of the row before this one, or NULL; 2^-shift: the unit of edges. */
static TYNI_V_TARGET void TYNI_V(row_fill)(const tyni_texels *t, const tyni_cells *c, const tyni_cells *last, float from,
                                           const ends *e, int32_t steps, int32_t shift, uint16_t *threshold, uint16_t *edge)
{
    const float units = (float)(1 << shift);
    /* of step 0, what lies before the row: its surface would be judged from behind the camera, where lit is dark */
    v_float before = v_max(from - v_to_float(v_index()), v_set(0.0f));
    for (int32_t k = 0; k < steps; k += v_n) {
        /* lanes behind the last step do it again */
        const v_int step = v_imin(v_iadd(v_iset(k), v_index()), v_iset(steps - 1));
        const v_float at = v_to_float(step);
        v_int ta, tb, first, second, cell[2];
        v_float cut;
        const v_mask same = TYNI_V(course_cells)(t, c, step, cell, &cut);
        if (v_n > 1 && last)
            TYNI_V(course_ahead)(t, c, last, step);
        ta = TYNI_V(row_column)(e, at + 0.5f * (before + cut), TYNI_V(door_texels)(t, cell[0]));
        tb = ta;
        first = v_shl(step, shift);
        second = v_iadd(first, v_iset(1 << shift));
        if (!v_all(same)) {
            tb = v_iselect(same, ta,
                           TYNI_V(row_column)(e, at + 0.5f + 0.5f * v_max(before, cut), TYNI_V(door_texels)(t, cell[1])));
            second = v_iadd(first, v_trunc(cut * units + 0.5f));
        }
        TYNI_V(row_pairs)(threshold + 2 * k, ta, tb, steps - k);
        TYNI_V(row_pairs)(edge + 2 * k, first, second, steps - k);
        before = v_set(0.0f);
    }
}

static TYNI_V_TARGET void TYNI_V(row_bound)(const uint16_t *threshold, int32_t columns, uint16_t *low, uint16_t *high)
{
    for (int32_t i = 0; i < columns; i += 64, low++, high++) {
        const int32_t from = tyni_maxi(i - 1, 0), end = tyni_mini(i + 64, columns);
        int32_t least = threshold[from], most = least, c = i;
        if (end == i + 64) {
            int32_t lows[v_n], highs[v_n];
            v_int l = v_load_u16(threshold + i), h = l;
            for (c += v_n; c < end; c += v_n) {
                const v_int t = v_load_u16(threshold + c);
                l = v_imin(l, t);
                h = v_imax(h, t);
            }
            v_istore(lows, l);
            v_istore(highs, h);
            for (int32_t k = 0; k < v_n; k++) {
                least = tyni_mini(least, lows[k]);
                most = tyni_maxi(most, highs[k]);
            }
        }
        for (; c < end; c++) {
            least = tyni_mini(least, threshold[c]);
            most = tyni_maxi(most, threshold[c]);
        }
        *low = (uint16_t)least;
        *high = (uint16_t)most;
    }
}
