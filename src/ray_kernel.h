/* ray_kernel.h - a template: rays side by side, for ray.c. */

/* Words of visibility; what lies behind the last column is anything. */
static TYNI_V_TARGET void TYNI_V(ray_compare)(const uint16_t *threshold, int32_t words, uint32_t position, uint32_t *out)
{
    for (int32_t w = 0; w < words; w++)
        out[w] = v_above16(threshold + 32 * w, position);
}

/* integral of e^(-sigma t) from 0 to t */
TYNI_V_INLINE v_float TYNI_V(ray_integral)(v_float t, float sigma)
{
    return t * v_fog(sigma * t);
}

/* tyni_slice_sight of each ray; how far it goes; its integrals. */
static TYNI_V_TARGET void TYNI_V(ray_begin)(tyni_bundle *b, const tyni_slice *s, const tyni_view *view, float most,
                                            const float sigma[2])
{
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_float p = v_load(b->p + i), zero = v_set(0.0f);
        const v_float x = s->a.x + p * s->b.x, y = s->a.y + p * s->b.y, z = s->a.z + p * s->b.z;
        v_float to = v_load(b->depth + i);
        if (view->orthographic) {
            v_store(b->o[0] + i, x);
            v_store(b->o[1] + i, y);
            v_store(b->o[2] + i, z);
            v_store(b->d[0] + i, v_set(view->forward.x));
            v_store(b->d[1] + i, v_set(view->forward.y));
            v_store(b->d[2] + i, v_set(view->forward.z));
        } else {
            const v_float length = v_sqrt(x * x + y * y + z * z), inverse = 1.0f / length;
            v_store(b->o[0] + i, zero);
            v_store(b->o[1] + i, zero);
            v_store(b->o[2] + i, zero);
            v_store(b->d[0] + i, x * inverse);
            v_store(b->d[1] + i, y * inverse);
            v_store(b->d[2] + i, z * inverse);
            to = to * length;
        }
        if (most > 0.0f)
            to = v_min(v_set(most), to);
        v_store(b->to + i, to);
        for (int32_t k = 0; k < 2; k++) {
            v_store(b->all[k] + i, TYNI_V(ray_integral)(to, sigma[k]));
            v_store(b->sum[k] + i, zero);
        }
        v_store(b->texels + i, zero);
    }
}

/* A form along each ray. */
TYNI_V_INLINE void TYNI_V(ray_form)(const tyni_bundle *b, int32_t i, const tyni_form *f, v_float *c, v_float *d)
{
    *c = v_load(b->o[0] + i) * f->v.x + v_load(b->o[1] + i) * f->v.y + v_load(b->o[2] + i) * f->v.z + f->c;
    *d = v_load(b->d[0] + i) * f->v.x + v_load(b->d[1] + i) * f->v.y + v_load(b->d[2] + i) * f->v.z;
}

/* row_span of each ray: from >= until where it does not cross the piece. */
static TYNI_V_TARGET void TYNI_V(ray_spans)(tyni_bundle *b, const tyni_piece *piece)
{
    for (int32_t i = 0; i < TYNI_RAY_BUNDLE; i += v_n) {
        const v_float zero = v_set(0.0f), end = v_load(b->to + i);
        v_float rc, rd, wc, wd, near, far, low = zero, high = end, from, until, cut;
        v_mask crosses;
        TYNI_V(ray_form)(b, i, &piece->r, &rc, &rd);
        TYNI_V(ray_form)(b, i, &piece->w, &wc, &wd);
        /* the part in front of the map: w >= 1e-6 */
        near = wc - 1e-6f;
        far = near + end * wd;
        cut = end * (near / (near - far));
        low = v_select(v_mand(v_lt(near, zero), v_ge(far, zero)), cut, low);
        high = v_select(v_mand(v_ge(near, zero), v_lt(far, zero)), cut, high);
        crosses = v_mand(v_lt(low, high), v_mor(v_ge(near, zero), v_ge(far, zero)));
        from = v_max(v_set(piece->from), (rc + low * rd) / (wc + low * wd));
        until = v_min(v_set(piece->to), (rc + high * rd) / (wc + high * wd));
        crosses = v_mand(crosses, v_lt(from, until));
        v_store(b->rc + i, rc);
        v_store(b->rd + i, rd);
        v_store(b->wc + i, wc);
        v_store(b->wd + i, wd);
        v_store(b->from + i, v_select(crosses, from, zero));
        v_store(b->until + i, v_select(crosses, until, zero));
        v_store(b->texels + i, v_load(b->texels + i) + v_select(crosses, until - from, zero));
    }
}

/* Where on ray n the edges are, behind those that wait. */
static TYNI_V_TARGET void TYNI_V(ray_places)(tyni_bundle *b, int32_t n, const float *at, int32_t count)
{
    const float rc = b->rc[n], rd = b->rd[n], wc = b->wc[n], wd = b->wd[n];
    const v_float end = v_set(b->to[n]);
    for (int32_t i = 0; i < count; i += v_n) {
        const v_float a = v_load_n(at + i, count - i);
        v_store_n(b->t + b->edges + i, v_clamp((a * wc - rc) / (rd - a * wd), v_set(0.0f), end), count - i);
    }
}

static TYNI_V_TARGET void TYNI_V(ray_integrals)(tyni_bundle *b, const float sigma[2], int32_t channels)
{
    for (int32_t i = 0; i < b->edges; i += v_n) {
        const v_float t = v_load(b->t + i);
        for (int32_t k = 0; k < channels; k++)
            v_store(b->value[k] + i, TYNI_V(ray_integral)(t, sigma[k]));
    }
}
