/* beside_kernel.h - a template, for unwarp.c: pixels that fit no sample at their place look for some beside it, as ED10's taps
 * do, and on the next outer lines (ED10 section 4.3). */

/* Gives those of the `open` pixels in `list` their value that have seen enough samples that fit. Returns the others. */
TYNI_V_INLINE v_mask TYNI_V(pixel_settle)(const tyni_run *r, const uint16_t *list, v_mask open, const TYNI_V(pixel_sum) * s)
{
    const v_mask fits = v_mand(open, v_gt(s->weight, v_set(TYNI_GATHER_ENOUGH)));
    const v_float scale = 1.0f / (s->weight * (1023.0f * 1023.0f));
    float low[v_n], high[v_n];
    v_store(low, s->low * scale);
    v_store(high, s->high * scale);
    for (uint32_t lanes = v_word(fits); lanes; lanes &= lanes - 1) {
        const int32_t lane = tyni_ctz32(lanes), j = list[lane];
        r->rejected[j >> 5] &= ~(1u << (j & 31));
        r->value[0][j] = low[lane];
        r->value[1][j] = high[lane];
    }
    return v_mandnot(open, fits);
}

/* Pixels of `list`, n of them and at most a vector, all in one sector of the shear grid: on their two lines as near as there is
 * a sample that fits, and then on the lines on either side of those, twice, no farther than one sample. */
TYNI_V_INLINE void TYNI_V(pixel_look)(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector, const uint16_t *list,
                                      int32_t n)
{
    const tyni_field *field = &p->lines;
    const int32_t most = field->pitch - 1, start = sector->start, end = start + sector->count - 1;
    const v_float zero = v_set(0.0f), threshold = v_set(field->threshold);
    /* lanes behind the last pixel are the first */
    const v_int i = v_iselect(v_first(n), v_load_u16(list), v_iset(list[0])), x = v_iadd(i, v_iset(r->x));
    const v_int sample = v_shr(sector->along_y ? v_iset(r->y) : x, shift_of(&p->slices));
    const v_float k = TYNI_V(pixel_place)(p, r->y, sector, x);
    const v_float at = v_max(v_gather(r->to, i) * v_gather(r->nearness, i), v_set(TYNI_ENTRY_NEAREST));
    TYNI_V(pixel_sum) s;
    TYNI_V(pixel_lines) l;
    v_mask open = v_first(n);
    v_float share[2];
    v_int line[2], entry[2];
    line[0] = v_imin(v_trunc(k), v_iset(sector->count - 2));
    share[1] = k - v_to_float(line[0]);
    share[0] = 1.0f - share[1];
    line[0] = v_iadd(line[0], v_iset(start));
    line[1] = v_iadd(line[0], v_iset(1));
    for (int32_t outer = 0; outer < 3 && v_any(open); outer++) {
        const int32_t farthest = outer ? 1 : TYNI_GATHER_BESIDE;
        TYNI_UNROLL
        for (int32_t c = 0; c < 4; c++)
            l.scale[c >> 1][c & 1] = v_gather(field->scales[c & 1], line[c >> 1]);
        for (int32_t away = outer ? 0 : 1; away <= farthest && v_any(open); away++) {
            s.weight = s.low = s.high = zero;
            for (int32_t way = -away; way <= away; way += tyni_maxi(2 * away, 1)) {
                const v_int place = v_imin(v_imax(v_iadd(sample, v_iset(way)), v_iset(0)), v_iset(most));
                TYNI_UNROLL
                for (int32_t side = 0; side < 2; side++)
                    entry[side] = v_igather(field->entries, v_shl(v_iadd(v_imul(line[side], v_iset(field->pitch)), place), 2));
                TYNI_V(pixel_taps)(&s, threshold, entry, &l, at, share);
            }
            open = TYNI_V(pixel_settle)(r, list, open, &s);
        }
        line[0] = v_imax(v_isub(line[0], v_iset(1)), v_iset(start));
        line[1] = v_imin(v_iadd(line[1], v_iset(1)), v_iset(end));
    }
}

/* Those of pixels first .. end - 1 of the run that fit no sample at their place: side by side, as they are few and far apart.
 */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(pixel_beside)(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector,
                                                             int32_t first, int32_t end)
{
    uint16_t list[15 + 32 + 16]; /* some that wait, those of a word, and what a vector loads behind the last */
    int32_t n = 0;
    for (int32_t base = first & ~31; base < end; base += 32) {
        uint32_t bits = r->rejected[base >> 5];
        if (base < first)
            bits &= 0xffffffffu << (first - base);
        if (end - base < 32)
            bits &= (1u << (end - base)) - 1u;
        for (; bits; bits &= bits - 1)
            list[n++] = (uint16_t)(base + tyni_ctz32(bits));
        for (; n >= v_n || (n && base + 32 >= end); n -= tyni_mini(n, v_n)) {
            TYNI_V(pixel_look)(p, r, sector, list, tyni_mini(n, v_n));
            for (int32_t k = v_n; k < n; k++)
                list[k - v_n] = list[k];
        }
    }
}
