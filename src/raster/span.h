/* span.h - a template: the pixels of a row between two edges, for fill.c. Vectors start at multiples of their width, so that
 * one lies in one block of the colour image, and lanes before and behind the span are masked. Each pixel is calculated from
 * scratch: neither the span's ends nor the order of bands change a value. */

/* The numbers of what is seen; x .. x + v_n - 1 within one block, `room` of them in the row. */
TYNI_V_INLINE void TYNI_V(raster_mark)(const span *s, int32_t x, int32_t room, v_mask m)
{
    uint8_t *mesh = s->colour + tyni_raster_mark_at(x), *triangle = mesh + tyni_raster_mark_step(x, s->width);
    if (room >= v_n) {
        v_istore_where(mesh, m, v_iset((int32_t)s->mesh));
        v_istore_where(triangle, m, v_iset((int32_t)s->triangle));
        return;
    }
    v_istore_n(mesh, v_iselect(m, v_iset((int32_t)s->mesh), v_iload_n(mesh, room)), room);
    v_istore_n(triangle, v_iselect(m, v_iset((int32_t)s->triangle), v_iload_n(triangle, room)), room);
}

/* Adds 1 to `passed` for each pixel that passes the depth test. value: low <= high, so that two selections clamp. */
TYNI_V_INLINE v_int TYNI_V(raster_span)(const span *s, tyni_raster_kind kind, v_int passed)
{
    const v_float low = v_set(s->low), high = v_set(s->high);
    for (int32_t x = s->from & ~(v_n - 1); x < s->to; x += v_n) {
        const int32_t room = s->width - x;
        const v_float at = v_to_float(v_iadd(v_iset(x - s->x0), v_index()));
        const v_float value = v_min(v_max(s->dx * at + s->row, low), high);
        const v_float old = room >= v_n ? v_load(s->depth + x) : v_load_n(s->depth + x, room);
        v_mask m = v_mandnot(v_first(s->to - x), v_first(s->from - x));
        v_float z;
        if (kind == TYNI_RASTER_SHADOW) {
            z = v_min(value, v_set(1.0f));
            m = v_mand(m, v_gt(z, old));
        } else {
            z = 1.0f / value;
            m = v_mand(m, v_mand(v_lt(z, old), v_ge(z, v_set(s->nearest))));
        }
        if (v_none(m))
            continue;
        passed = v_iadd(passed, v_iselect(m, v_iset(1), v_iset(0)));
        if (room >= v_n)
            v_store(s->depth + x, v_select(m, z, old)); /* whole: the next span may want to load it at once */
        else
            v_store_n(s->depth + x, v_select(m, z, old), room);
        if (kind == TYNI_RASTER_SEEN)
            TYNI_V(raster_mark)(s, x, room, m);
    }
    return passed;
}

/* Rows y .. end - 1 between two edges; says whether they cover anything. */
static TYNI_V_TARGET int TYNI_V(raster_fill_rows)(brush *b, edge *left, edge *right, int32_t y, int32_t end)
{
    const tyni_raster_pass *pass = b->pass;
    v_int passed = v_iset(0);
    int covered = 0;
    span s;
    begin_spans(b, &s);
    for (; y < end; y++) {
        s.from = tyni_maxi(left->x, 0);
        s.to = tyni_mini(right->x, s.width);
        if (s.from < s.to) {
            covered = 1;
            begin_row(b, &s, y);
            for (int32_t i = 1; i <= 2; i++) /* the caches do not guess where a triangle goes on; below the image is no harm */
                TYNI_PREFETCH((const void *)((uintptr_t)(s.depth + s.from) +
                                             (uintptr_t)(i * (pass->depth_stride + 4 * (ptrdiff_t)left->step))));
            if (pass->kind == TYNI_RASTER_SHADOW)
                passed = TYNI_V(raster_span)(&s, TYNI_RASTER_SHADOW, passed);
            else if (pass->kind == TYNI_RASTER_SEEN)
                passed = TYNI_V(raster_span)(&s, TYNI_RASTER_SEEN, passed);
            else
                passed = TYNI_V(raster_span)(&s, TYNI_RASTER_DEPTH, passed);
        }
        advance(left);
        advance(right);
    }
    b->pixels += v_isum(passed);
    return covered;
}
