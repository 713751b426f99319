/* pixels.h - a template: shades a block of pixels for shade.c. Every lane takes the steps of light.c, texture.c and add_light
 * in their order; what they decide by branches is decided here by masks. Lanes outside of a mask hold anything: nothing is
 * read from memory for them. */

typedef struct TYNI_V(raster_vec) {
    v_float x, y, z;
} TYNI_V(raster_vec);

/* Pixels that are shaded together: faces of one mesh, and what shading needs of them, lane by lane. */
typedef struct TYNI_V(raster_group) {
    int32_t count;
    int32_t whole; /* one face, whose numbers are in all lanes */
    const tyni_raster_face *face[v_n];
    v_mask mask[v_n];                    /* its lanes */
    v_float number[TYNI_RASTER_NUMBERS]; /* of tyni_raster_face, from its corner on */
    TYNI_V(raster_vec) point;            /* relative to the camera */
    v_float sum[3];
    float block[3 * TYNI_RASTER_BLOCK]; /* their light: planes of red, green, blue */
    uint32_t mesh[TYNI_RASTER_BLOCK], triangle[TYNI_RASTER_BLOCK];
} TYNI_V(raster_group);

/* It lives in the worker's memory, not on the stack. */
typedef char TYNI_V(raster_group_fits)[sizeof(TYNI_V(raster_group)) <= TYNI_RASTER_GROUP ? 1 : -1];

TYNI_V_INLINE v_float TYNI_V(raster_form)(const float row[4], TYNI_V(raster_vec) point)
{
    return row[0] * point.x + row[1] * point.y + row[2] * point.z + row[3];
}

/* ---- shadow maps ---------------------------------------------------------------------------------------------------- */

TYNI_V_INLINE v_float TYNI_V(raster_texels_z)(const tyni_texels *t, v_int x, v_int y, v_mask m)
{
    const v_int at = v_iadd(v_imul(y, v_iset((int32_t)t->pitch)), v_shl(x, 2));
    const v_float z = (v_from_bits(v_igather_where(t->pixels, at, m)) - t->end) * t->step;
    return v_select(v_gt(z, v_set(0.0f)), v_min(z, v_set(1.0f)), v_set(0.0f));
}

/* compare() of light.c */
TYNI_V_INLINE v_float TYNI_V(raster_compare)(const tyni_texels *t, v_float u, v_float v, v_float z, v_float slope_u,
                                             v_float slope_v, v_mask m)
{
    const v_int left = v_floori(u), top = v_floori(v), one = v_iset(1);
    const v_int x[2] = {v_imax(left, v_iset(0)), v_imin(v_iadd(left, one), v_iset(t->width - 1))};
    const v_int y[2] = {v_imax(top, v_iset(0)), v_imin(v_iadd(top, one), v_iset(t->height - 1))};
    const v_float s = u - v_to_float(left), r = v - v_to_float(top);
    const v_float share_x[2] = {1.0f - s, s}, share_y[2] = {1.0f - r, r};
    v_float sum = v_set(0.0f);
    for (int32_t j = 0; j < 2; j++)
        for (int32_t i = 0; i < 2; i++) {
            const v_float blocker = TYNI_V(raster_texels_z)(t, x[i], y[j], m);
            const v_float here = z + slope_u * (v_to_float(x[i]) - u) + slope_v * (v_to_float(y[j]) - v);
            const v_mask dark = v_mand(v_gt(blocker, v_set(0.0f)), v_gt(blocker, here));
            sum = v_select(dark, sum, sum + share_x[i] * share_y[j]);
        }
    return v_clamp((sum - 0.5f) * TYNI_RASTER_SHARPNESS + 0.5f, v_set(0.0f), v_set(1.0f));
}

/* Slopes of the faces at hand on map k of light i; `in`: where the map covers. */
TYNI_V_INLINE void TYNI_V(raster_slopes)(shader *sh, const TYNI_V(raster_group) * g, int32_t i, int32_t k,
                                         TYNI_V(raster_vec) world, v_mask in, v_float *slope_u, v_float *slope_v)
{
    for (int32_t n = 0; n < g->count; n++) {
        const v_mask m = v_mand(g->mask[n], in);
        const float *slope;
        if (v_none(m))
            continue;
        slope = known_slopes(sh, g->face[n], i, k);
        if (!slope) {
            const int32_t lane = tyni_ctz32(v_word(m));
            float p[3][v_n];
            v_store(p[0], world.x);
            v_store(p[1], world.y);
            v_store(p[2], world.z);
            slope = find_slopes(sh, g->face[n], i, k, tyni_vec(p[0][lane], p[1][lane], p[2][lane]));
        }
        *slope_u = v_select(m, v_set(slope[0]), *slope_u);
        *slope_v = v_select(m, v_set(slope[1]), *slope_v);
    }
}

/* tyni_raster_visible, of maps without tints. */
TYNI_V_INLINE v_float TYNI_V(raster_visible)(shader *sh, const TYNI_V(raster_group) * g, int32_t i, TYNI_V(raster_vec) world,
                                             v_mask m)
{
    const tyni_raster_lamp *lamp = &sh->s->lamps[i];
    v_float share = v_set(lamp->outside);
    for (int32_t k = 0; k <= lamp->light->more_count; k++) {
        const tyn_shadow *shadow = tyni_raster_shadow_of(lamp->light, k);
        const tyni_raster_map *map = &lamp->maps[k];
        const v_float zero = v_set(0.0f), one = v_set(1.0f);
        v_float w, inverse, u, v, z, slope_u = zero, slope_v = zero;
        v_mask in;
        if (!shadow->depth)
            continue;
        w = TYNI_V(raster_form)(shadow->matrix + 12, world);
        inverse = 1.0f / w;
        u = TYNI_V(raster_form)(shadow->matrix, world) * inverse;
        v = TYNI_V(raster_form)(shadow->matrix + 4, world) * inverse;
        in = v_mand(m, v_gt(w, zero));
        in = v_mand(in, v_mand(v_ge(u, zero), v_le(u, one)));
        in = v_mand(in, v_mand(v_ge(v, zero), v_le(v, one)));
        if (v_none(in))
            continue;
        TYNI_V(raster_slopes)(sh, g, i, k, world, in, &slope_u, &slope_v);
        z = TYNI_V(raster_form)(map->z, world) * inverse;
        z = z + v_abs(map->bias - map->bias_z * z);
        u = u * (float)map->texels.width - 0.5f;
        v = v * (float)map->texels.height - 0.5f;
        z = TYNI_V(raster_compare)(&map->texels, u, v, z, slope_u, slope_v, in);
        share = v_select(in, z, share);
        m = v_mandnot(m, in);
        if (v_none(m))
            break;
    }
    return share;
}

/* ---- lights --------------------------------------------------------------------------------------------------------- */

/* What kernels leave to scalar code: slides, tints, maps that are not floats. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(raster_one_by_one)(shader *sh, TYNI_V(raster_group) * g, int32_t i)
{
    float p[3][v_n], lanes[3][v_n];
    v_store(p[0], g->point.x);
    v_store(p[1], g->point.y);
    v_store(p[2], g->point.z);
    for (int32_t c = 0; c < 3; c++)
        v_store(lanes[c], g->sum[c]);
    for (int32_t n = 0; n < g->count; n++)
        for (uint32_t word = v_word(g->mask[n]); word; word &= word - 1) {
            const int32_t lane = tyni_ctz32(word);
            float one[3] = {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
            add_light(sh, g->face[n], i, tyni_vec(p[0][lane], p[1][lane], p[2][lane]), one);
            for (int32_t c = 0; c < 3; c++)
                lanes[c][lane] = one[c];
        }
    for (int32_t c = 0; c < 3; c++)
        g->sum[c] = v_load(lanes[c]);
}

/* add_light() of shade.c */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(raster_add_light)(shader *sh, TYNI_V(raster_group) * g, int32_t i,
                                                                 const v_mask *lanes)
{
    const TYNI_V(raster_vec) point = g->point;
    const tyni_raster_shading *s = sh->s;
    const tyni_raster_lamp *lamp = &s->lamps[i];
    const tyn_light *light = lamp->light;
    const int local = light->kind != TYN_LIGHT_DIRECTIONAL;
    v_float amount, distance = v_set(0.0f);
    v_mask m = *lanes;
    if (local)
        amount = g->number[3] * (lamp->position.x - g->number[0]) + g->number[4] * (lamp->position.y - g->number[1]) +
                 g->number[5] * (lamp->position.z - g->number[2]);
    else
        amount = g->number[3] * lamp->towards.x + g->number[4] * lamp->towards.y + g->number[5] * lamp->towards.z;
    m = v_mand(m, v_gt(amount, v_set(0.0f)));
    if (v_none(m))
        return;
    if (local) {
        const TYNI_V(raster_vec) to = {lamp->position.x - point.x, lamp->position.y - point.y, lamp->position.z - point.z};
        const v_float square = v_max(to.x * to.x + to.y * to.y + to.z * to.z, v_set(1e-12f));
        distance = v_sqrt(square);
        if (light->kind == TYN_LIGHT_SPOT) {
            const v_float along = to.x * lamp->towards.x + to.y * lamp->towards.y + to.z * lamp->towards.z;
            m = v_mandnot(m, v_lt(along, lamp->cosine * distance));
        }
        amount = v_max(g->number[3] * to.x + g->number[4] * to.y + g->number[5] * to.z, v_set(0.0f)) / (distance * square);
    }
    if (lamp->mapped && v_any(m)) {
        const float *eye = s->surface->camera.position;
        const TYNI_V(raster_vec) world = {point.x + eye[0], point.y + eye[1], point.z + eye[2]};
        amount = amount * TYNI_V(raster_visible)(sh, g, i, world, m);
    }
    m = v_mand(m, v_gt(amount, v_set(0.0f)));
    if (v_none(m))
        return;
    for (int32_t c = 0; c < 3; c++) {
        v_float more = light->colour[c] * amount;
        if (local && s->hazy)
            more = more * v_exp(-s->sigma[c] * distance);
        g->sum[c] = v_select(m, g->sum[c] + more, g->sum[c]);
    }
}

/* ---- textures ------------------------------------------------------------------------------------------------------- */

TYNI_V_INLINE v_float TYNI_V(raster_fraction)(v_float x)
{
    x = v_select(v_lt(v_abs(x), v_set(8388608.0f)), x, v_set(0.0f));
    return x - v_to_float(v_floori(x));
}

/* neighbours() of texture.c */
TYNI_V_INLINE v_float TYNI_V(raster_neighbours)(v_float at, int32_t n, v_int *first, v_int *second)
{
    const v_float x = TYNI_V(raster_fraction)(at) * (float)n - 0.5f;
    const v_int i = v_imin(v_imax(v_floori(x), v_iset(-1)), v_iset(n - 1)), next = v_iadd(i, v_iset(1));
    *first = v_iselect(v_ilt(i, v_iset(0)), v_iset(n - 1), i);
    *second = v_iselect(v_ilt(next, v_iset(n)), next, v_iset(0));
    return x - v_to_float(i);
}

/* The three bytes at an offset, low ones first; a word would reach past the last texel: there one byte earlier. */
TYNI_V_INLINE v_int TYNI_V(raster_bytes)(const texture *t, v_int at, v_mask m)
{
    const v_mask last = v_igt(at, v_iset(t->last_word));
    const v_int word = v_igather_where(t->pixels, v_imin(at, v_iset(t->last_word)), m);
    return v_iselect(last, v_shr(word, 8), word);
}

/* Components of the texel at an offset. */
TYNI_V_INLINE void TYNI_V(raster_components)(const texture *t, v_int at, v_mask m, v_float rgb[3])
{
    if (t->bytes == 3) {
        const v_int word = TYNI_V(raster_bytes)(t, at, m), low = v_iset(255);
        rgb[0] = v_to_float(v_iand(word, low));
        rgb[1] = v_to_float(v_iand(v_shr(word, 8), low));
        rgb[2] = v_to_float(v_iand(v_shr(word, 16), low));
    } else if (t->bytes == 6) {
        const v_int word = v_igather_where(t->pixels, at, m), next = v_igather_where(t->pixels, v_iadd(at, v_iset(2)), m);
        rgb[0] = v_to_float(v_iand(word, v_iset(65535)));
        rgb[1] = v_to_float(v_shr(word, 16));
        rgb[2] = v_to_float(v_shr(next, 16));
    } else
        for (int32_t c = 0; c < 3; c++)
            rgb[c] = v_clamp(v_from_bits(v_igather_where(t->pixels, v_iadd(at, v_iset(4 * c)), m)), v_set(0.0f), v_set(1e30f));
}

/* Multiplies by tyni_raster_texel. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(raster_texel)(const texture *t, const v_float *u, const v_float *v,
                                                             const v_mask *lanes, v_float rgb[3])
{
    const v_mask m = *lanes;
    v_int x0, x1, y0, y1;
    v_float a[3], b[3], c[3], d[3];
    const v_float s = TYNI_V(raster_neighbours)(*u, t->image->width, &x0, &x1);
    const v_float r = TYNI_V(raster_neighbours)(1.0f - TYNI_V(raster_fraction)(*v), t->image->height, &y0, &y1);
    const v_int bytes = v_iset(t->bytes), stride = v_iset(t->stride);
    x0 = v_imul(x0, bytes);
    x1 = v_imul(x1, bytes);
    y0 = v_imul(y0, stride);
    y1 = v_imul(y1, stride);
    TYNI_V(raster_components)(t, v_iadd(y0, x0), m, a);
    TYNI_V(raster_components)(t, v_iadd(y0, x1), m, b);
    TYNI_V(raster_components)(t, v_iadd(y1, x0), m, c);
    TYNI_V(raster_components)(t, v_iadd(y1, x1), m, d);
    for (int32_t i = 0; i < 3; i++) {
        const v_float top = a[i] + s * (b[i] - a[i]), bottom = c[i] + s * (d[i] - c[i]);
        v_float texel = top + r * (bottom - top);
        if (t->bytes != 12)
            texel = texel * t->unit;
        rgb[i] = rgb[i] * texel;
    }
}

static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(raster_texels_one_by_one)(const texture *t, const v_float *u, const v_float *v,
                                                                         uint32_t word, v_float rgb[3])
{
    float us[v_n], vs[v_n], lanes[3][v_n] = {{0}};
    v_store(us, *u);
    v_store(vs, *v);
    for (; word; word &= word - 1) {
        const int32_t lane = tyni_ctz32(word);
        float one[3];
        tyni_raster_texel(t->image, us[lane], vs[lane], one);
        for (int32_t c = 0; c < 3; c++)
            lanes[c][lane] = one[c];
    }
    for (int32_t c = 0; c < 3; c++)
        rgb[c] = rgb[c] * v_load(lanes[c]);
}

/* ---- pixels --------------------------------------------------------------------------------------------------------- */

/* A face's numbers into lanes m of the group's. */
TYNI_V_INLINE void TYNI_V(raster_add_face)(TYNI_V(raster_group) * g, const tyni_raster_face *f, v_mask m)
{
    float number[TYNI_RASTER_NUMBERS];
    memcpy(number, &f->corner, sizeof number);
    g->face[g->count] = f;
    g->mask[g->count++] = m;
    for (int32_t i = 0; i < TYNI_RASTER_NUMBERS; i++)
        g->number[i] = v_select(m, v_set(number[i]), g->number[i]);
}

/* Collects the faces of the first lane's mesh out of `left`; gives their lanes. Where pixels must come in order, one run. */
TYNI_V_INLINE v_mask TYNI_V(raster_collect)(shader *sh, TYNI_V(raster_group) * g, v_mask left, v_int mesh, v_int triangle,
                                            const uint32_t *meshes, const uint32_t *triangles)
{
    int32_t lane = tyni_ctz32(v_word(left));
    v_mask rest = v_mand(left, v_ieq(mesh, v_iset((int32_t)meshes[lane]))), all;
    v_mask m = v_mand(rest, v_ieq(triangle, v_iset((int32_t)triangles[lane])));
    if (sh->in_order) /* lanes up to the first that is not of it */
        m = v_mand(m, v_first(lane + tyni_ctz32(~(v_word(m) >> lane))));
    else if (g->whole && g->face[0]->mesh == meshes[lane] && g->face[0]->triangle == triangles[lane] &&
             v_none(v_mandnot(rest, m))) {
        g->mask[0] = m;
        return m;
    }
    dress(sh, meshes[lane]);
    /* The first one's go into all lanes, whose own does not matter: the next group may then find them ready. */
    g->count = 0;
    TYNI_V(raster_add_face)(g, take_face(sh, meshes[lane], triangles[lane], g->face, 0), v_first(v_n));
    g->mask[0] = m;
    g->whole = 1;
    all = m;
    if (sh->in_order)
        return m;
    for (rest = v_mandnot(rest, m); v_any(rest); rest = v_mandnot(rest, m)) {
        const tyni_raster_face *f;
        lane = tyni_ctz32(v_word(rest));
        f = take_face(sh, meshes[lane], triangles[lane], g->face, g->count);
        if (!f) /* its place is taken by one of these */
            break;
        m = v_mand(rest, v_ieq(triangle, v_iset((int32_t)triangles[lane])));
        TYNI_V(raster_add_face)(g, f, m);
        g->whole = 0;
        all = v_mor(all, m);
    }
    return all;
}

/* Lanes m of the pixels from x on into block[] (planes of red, green, blue). */
TYNI_V_INLINE void TYNI_V(raster_shade_group)(shader *sh, TYNI_V(raster_group) * g, int32_t x, v_float depth, v_mask m,
                                              float *block)
{
    const v_float rx = sh->middle + (v_to_float(v_iadd(v_iset(x), v_index())) + 0.5f - sh->half) * sh->step;
    g->point.x = (sh->ray.x + rx * sh->right.x) * depth;
    g->point.y = (sh->ray.y + rx * sh->right.y) * depth;
    g->point.z = (sh->ray.z + rx * sh->right.z) * depth;
    for (int32_t c = 0; c < 3; c++)
        g->sum[c] = v_set(sh->s->surface->ambient[c]);
    for (int32_t i = 0; i < sh->s->surface->light_count; i++)
        if (sh->s->lamps[i].plain)
            TYNI_V(raster_add_light)(sh, g, i, &m);
        else
            TYNI_V(raster_one_by_one)(sh, g, i);
    for (int32_t c = 0; c < 3; c++)
        g->sum[c] = sh->albedo[c] * g->sum[c];
    if (sh->texture.image) {
        const v_float *n = g->number;
        const TYNI_V(raster_vec) way = {g->point.x - n[0], g->point.y - n[1], g->point.z - n[2]};
        const v_float u = n[6] + (n[8] * way.x + n[9] * way.y + n[10] * way.z);
        const v_float v = n[7] + (n[11] * way.x + n[12] * way.y + n[13] * way.z);
        if (sh->texture.plain)
            TYNI_V(raster_texel)(&sh->texture, &u, &v, &m, g->sum);
        else
            TYNI_V(raster_texels_one_by_one)(&sh->texture, &u, &v, v_word(m), g->sum);
    }
    for (int32_t c = 0; c < 3; c++)
        v_store_where(block + TYNI_RASTER_BLOCK * c, m, v_clamp(g->sum[c], v_set(0.0f), v_set(3e38f)));
}

/* `count` pixels from x on, a block, vector by vector. */
TYNI_V_INLINE void TYNI_V(raster_shade_block)(shader *sh, TYNI_V(raster_group) * g, int32_t x, int32_t count,
                                              const float *depth, float *colour)
{
    const float *background = sh->s->surface->background;
    for (int32_t i = 0; i < count; i += v_n) {
        v_istore(g->mesh + i, v_iload_n(colour + i, count - i));
        v_istore(g->triangle + i, v_iload_n(colour + count + i, count - i));
    }
    for (int32_t i = 0; i < count; i += v_n) {
        const v_int mesh = v_iload(g->mesh + i), triangle = v_iload(g->triangle + i);
        const v_float d = i + v_n <= count ? v_load(depth + i) : v_load_n(depth + i, count - i);
        v_mask left = v_mandnot(v_first(count - i), v_ieq(mesh, v_iset(-1))); /* -1: TYNI_RASTER_NOTHING */
        for (int32_t c = 0; c < 3; c++)
            v_store(g->block + TYNI_RASTER_BLOCK * c + i, v_set(background[c]));
        while (v_any(left)) {
            const v_mask m = TYNI_V(raster_collect)(sh, g, left, mesh, triangle, g->mesh + i, g->triangle + i);
            TYNI_V(raster_shade_group)(sh, g, x + i, d, m, g->block + i);
            left = v_mandnot(left, m);
        }
    }
    for (int32_t i = 0; i < count; i += v_n)
        v_store_rgb_n(colour + 3 * i, v_load(g->block + i), v_load(g->block + TYNI_RASTER_BLOCK + i),
                      v_load(g->block + 2 * TYNI_RASTER_BLOCK + i), count - i);
}

/* Rows first .. end - 1, columns from .. to - 1, row by row; `from` begins a block. */
static TYNI_V_TARGET TYNI_NOINLINE void TYNI_V(raster_shade_area)(shader *sh, int32_t from, int32_t to, int32_t first,
                                                                  int32_t end)
{
    TYNI_V(raster_group) *g = sh->group;
    g->whole = 0;
    for (int32_t y = first; y < end; y++) {
        const float *depth;
        float *colour;
        begin_row(sh, y, &depth, &colour);
        for (int32_t x = from; x < to; x += TYNI_RASTER_BLOCK)
            TYNI_V(raster_shade_block)(sh, g, x, tyni_mini(TYNI_RASTER_BLOCK, to - x), depth + x, colour + 3 * (ptrdiff_t)x);
    }
}
