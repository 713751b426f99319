/* derived.h - a template: the operations of lanes.h that are made of others, the same text for every ISA. */

TYNI_V_INLINE v_mask v_gt(v_float a, v_float b)
{
    return v_lt(b, a);
}
TYNI_V_INLINE v_mask v_ge(v_float a, v_float b)
{
    return v_le(b, a);
}
TYNI_V_INLINE v_mask v_ne(v_float a, v_float b)
{
    return v_mandnot(v_first(v_n), v_eq(a, b));
}
TYNI_V_INLINE v_float v_abs(v_float x)
{
    return v_max(-x, x);
}
TYNI_V_INLINE v_float v_clamp(v_float x, v_float low, v_float high)
{
    return v_min(v_max(x, low), high);
}
TYNI_V_INLINE v_mask v_igt(v_int a, v_int b)
{
    return v_ilt(b, a);
}
TYNI_V_INLINE v_int v_floori(v_float x)
{
    const v_int i = v_trunc(x);
    return v_iadd(i, v_iselect(v_gt(v_to_float(i), x), v_iset(-1), v_iset(0)));
}
TYNI_V_INLINE v_int v_ceili(v_float x)
{
    const v_int i = v_trunc(x);
    return v_iadd(i, v_iselect(v_lt(v_to_float(i), x), v_iset(1), v_iset(0)));
}
TYNI_V_INLINE int v_any(v_mask m)
{
    return v_word(m) != 0;
}
TYNI_V_INLINE int v_all(v_mask m)
{
    return v_word(m) == (1u << v_n) - 1u;
}
TYNI_V_INLINE int v_none(v_mask m)
{
    return v_word(m) == 0;
}

TYNI_V_INLINE v_mask v_unword(uint32_t word)
{
    static const int32_t bit[16] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
    return v_igt(v_iand(v_iset((int32_t)(word & 0xffffu)), v_iload(bit)), v_iset(0));
}

/* ---- parts of vectors ---- */

TYNI_V_INLINE v_int v_load_u8_n(const uint8_t *p, int32_t n)
{
    uint8_t part[v_n] = {0};
    if (n >= v_n)
        return v_load_u8(p);
    for (int32_t i = 0; i < n; i++)
        part[i] = p[i];
    return v_load_u8(part);
}
TYNI_V_INLINE void v_store_u8_n(uint8_t *p, v_int x, int32_t n)
{
    uint8_t part[v_n];
    if (n >= v_n) {
        v_store_u8(p, x);
        return;
    }
    v_store_u8(part, x);
    for (int32_t i = 0; i < n && i < v_n; i++)
        p[i] = part[i];
}
TYNI_V_INLINE void v_store_u16_n(uint16_t *p, v_int x, int32_t n)
{
    uint16_t part[v_n];
    if (n >= v_n) {
        v_store_u16(p, x);
        return;
    }
    v_store_u16(part, x);
    for (int32_t i = 0; i < n && i < v_n; i++)
        p[i] = part[i];
}
TYNI_V_INLINE void v_store_rgb_n(float *p, v_float r, v_float g, v_float b, int32_t n)
{
    float part[3 * v_n];
    if (n >= v_n) {
        v_store_rgb(p, r, g, b);
        return;
    }
    v_store_rgb(part, r, g, b);
    for (int32_t i = 0, left = 3 * n; left > 0; i += v_n, left -= v_n)
        v_store_n(p + i, v_load(part + i), left);
}
/* Bytes in memory have an order of their own; a word has the machine's. */
TYNI_V_INLINE v_int TYNI_V(rgba)(v_int r, v_int g, v_int b, v_int a)
{
    const v_int low = v_iset(255);
    const uint32_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    r = v_iand(r, low);
    g = v_iand(g, low);
    b = v_iand(b, low);
    a = v_iand(a, low);
    if (first)
        return v_ior(v_ior(r, v_shl(g, 8)), v_ior(v_shl(b, 16), v_shl(a, 24)));
    return v_ior(v_ior(a, v_shl(b, 8)), v_ior(v_shl(g, 16), v_shl(r, 24)));
}
TYNI_V_INLINE void v_store_rgba8(uint8_t *p, v_int r, v_int g, v_int b, v_int a)
{
    v_istore(p, TYNI_V(rgba)(r, g, b, a));
}
TYNI_V_INLINE void v_store_rgba8_n(uint8_t *p, v_int r, v_int g, v_int b, v_int a, int32_t n)
{
    v_istore_n(p, TYNI_V(rgba)(r, g, b, a), n);
}

TYNI_V_INLINE uint64_t v_above64(const uint16_t *t, uint32_t position)
{
    return v_above16(t, position) | (uint64_t)v_above16(t + 32, position) << 32;
}

/* ---- over lanes ---- */

TYNI_V_INLINE float v_sum16(const v_float *part)
{
    v_float half[16 / v_n];
    half[0] = part[0];
    TYNI_UNROLL_MORE
    for (int32_t i = 0; i < 8 / v_n; i++)
        half[i] = part[i] + part[i + 8 / v_n];
    TYNI_UNROLL
    for (int32_t n = 4 / v_n; n; n /= 2) {
        TYNI_UNROLL_MORE
        for (int32_t i = 0; i < n; i++)
            half[i] = half[i] + half[i + n];
    }
    return TYNI_V(halves)(half[0]);
}
TYNI_V_INLINE float v_hmin(v_float x)
{
    float all[v_n], least;
    v_store(all, x);
    least = all[0];
    for (int32_t i = 1; i < v_n; i++)
        least = tyni_minf(all[i], least);
    return least;
}
TYNI_V_INLINE float v_hmax(v_float x)
{
    float all[v_n], most;
    v_store(all, x);
    most = all[0];
    for (int32_t i = 1; i < v_n; i++)
        most = tyni_maxf(all[i], most);
    return most;
}
TYNI_V_INLINE int32_t v_isum(v_int x)
{
    int32_t all[v_n];
    uint32_t sum = 0;
    v_istore(all, x);
    for (int32_t i = 0; i < v_n; i++)
        sum += (uint32_t)all[i];
    return (int32_t)sum;
}

/* ---- num.c's, step by step: what is changed there must be changed here ---- */

TYNI_V_INLINE v_float v_exp(v_float x)
{
    const v_mask some = v_ge(x, v_set(-87.0f));
    v_float n, r, p;
    v_int i;
    x = v_select(some, v_select(v_gt(x, v_set(88.0f)), v_set(88.0f), x), v_set(0.0f));
    i = v_floori(x * 1.44269504f + 0.5f);
    n = v_to_float(i);
    r = (x - n * 0.693145752f) - n * 1.42860677e-6f;
    p = v_set(1.0f / 5040.0f);
    p = p * r + 1.0f / 720.0f;
    p = p * r + 1.0f / 120.0f;
    p = p * r + 1.0f / 24.0f;
    p = p * r + 1.0f / 6.0f;
    p = p * r + 0.5f;
    p = p * r * r + r;
    p = (p + 1.0f) * v_from_bits(v_shl(v_iadd(i, v_iset(127)), 23));
    return v_select(some, p, v_set(0.0f));
}

TYNI_V_INLINE v_float v_fog(v_float x)
{
    const v_mask small = v_lt(x, v_set(0.5f));
    v_float p = v_set(-1.0f / 40320.0f);
    p = p * x + 1.0f / 5040.0f;
    p = p * x - 1.0f / 720.0f;
    p = p * x + 1.0f / 120.0f;
    p = p * x - 1.0f / 24.0f;
    p = p * x + 1.0f / 6.0f;
    p = p * x - 0.5f;
    p = p * x + 1.0f;
    if (v_all(small))
        return p;
    return v_select(small, p, (1.0f - v_exp(-x)) / x);
}

/* Of n at once, 1 .. TYNI_CHAINS, term by term: each is one long chain, and one after the other they would be waited for. */
TYNI_V_INLINE void v_fades(const v_float *x, int32_t n, v_float *left, v_float *lost)
{
    static const float term[4] = {0.00966636837f, 0.0555038117f, 0.240223497f, 0.693147182f};
    v_float r[TYNI_CHAINS], scale[TYNI_CHAINS], p[TYNI_CHAINS];
    TYNI_UNROLL_MORE
    for (int32_t k = 0; k < n; k++) {
        const v_float t = v_max(x[k] * -1.44269504f, v_set(-126.0f)), whole = t + TYNI_WHOLE;
        r[k] = t - (whole - TYNI_WHOLE);
        scale[k] = v_from_bits(v_shl(v_bits(whole), 23));
        p[k] = v_set(0.00133813021f);
    }
    TYNI_UNROLL
    for (int32_t j = 0; j < 4; j++) {
        TYNI_UNROLL_MORE
        for (int32_t k = 0; k < n; k++)
            p[k] = p[k] * r[k] + term[j];
    }
    TYNI_UNROLL_MORE
    for (int32_t k = 0; k < n; k++) {
        p[k] = p[k] * r[k] * scale[k];
        left[k] = p[k] + scale[k];
        lost[k] = (1.0f - scale[k]) - p[k];
    }
}

TYNI_V_INLINE void v_fade(v_float x, v_float *left, v_float *lost)
{
    const v_float t = v_max(x * -1.44269504f, v_set(-126.0f)), whole = t + TYNI_WHOLE;
    const v_float r = t - (whole - TYNI_WHOLE), scale = v_from_bits(v_shl(v_bits(whole), 23));
    v_float p = v_set(0.00133813021f);
    p = p * r + 0.00966636837f;
    p = p * r + 0.0555038117f;
    p = p * r + 0.240223497f;
    p = (p * r + 0.693147182f) * r * scale;
    *left = p + scale;
    *lost = (1.0f - scale) - p;
}

TYNI_V_INLINE v_float v_log(v_float x)
{
    v_int bits, e;
    v_float m, s, q, p;
    x = v_select(v_gt(x, v_set(1.17549435e-38f)), x, v_set(1.17549435e-38f));
    bits = v_bits(x);
    e = v_shr(v_isub(bits, v_iset(0x3f3504f3)), 23);
    e = v_iselect(v_igt(e, v_iset(255)), v_isub(e, v_iset(512)), e);
    m = v_from_bits(v_isub(bits, v_shl(e, 23)));
    s = (m - 1.0f) / (m + 1.0f);
    q = s * s;
    p = v_set(1.0f / 9.0f);
    p = p * q + 1.0f / 7.0f;
    p = p * q + 1.0f / 5.0f;
    p = p * q + 1.0f / 3.0f;
    p = 2.0f * s + 2.0f * s * q * p;
    return v_to_float(e) * 0.693145752f + (v_to_float(e) * 1.42860677e-6f + p);
}

TYNI_V_INLINE void v_sincos(v_float x, v_float *sine, v_float *cosine)
{
    const v_int n = v_floori(v_clamp(x, v_set(-8192.0f), v_set(8192.0f)) * 0.636619772f + 0.5f), two = v_iset(2);
    const v_mask even = v_ieq(v_iand(n, v_iset(1)), v_iset(0));
    const v_float f = v_to_float(n), r = ((x - f * 1.5703125f) - f * 4.83751297e-4f) - f * 7.54978995e-8f, q = r * r;
    v_float s = v_set(1.0f / 362880.0f), c = v_set(-1.0f / 3628800.0f), a, b;
    s = s * q - 1.0f / 5040.0f;
    s = s * q + 1.0f / 120.0f;
    s = s * q - 1.0f / 6.0f;
    s = s * q * r + r;
    c = c * q + 1.0f / 40320.0f;
    c = c * q - 1.0f / 720.0f;
    c = c * q + 1.0f / 24.0f;
    c = c * q - 0.5f;
    c = c * q + 1.0f;
    a = v_select(even, s, c);
    b = v_select(even, c, s);
    *sine = v_select(v_ieq(v_iand(n, two), two), -a, a);
    *cosine = v_select(v_ieq(v_iand(v_iadd(n, v_iset(1)), two), two), -b, b);
}

TYNI_V_INLINE v_float v_atan2(v_float y, v_float x)
{
    const v_float a = v_abs(y), b = v_abs(x), low = v_min(a, b), high = v_max(a, b), zero = v_set(0.0f);
    const v_mask big = v_gt(low, 0.414213562f * high);
    const v_float t = v_select(big, high - low, low) / v_select(big, high + low, high), q = t * t;
    v_float p = v_set(1.0f / 17.0f), angle;
    p = -p * q + 1.0f / 15.0f;
    p = -p * q + 1.0f / 13.0f;
    p = -p * q + 1.0f / 11.0f;
    p = -p * q + 1.0f / 9.0f;
    p = -p * q + 1.0f / 7.0f;
    p = -p * q + 1.0f / 5.0f;
    p = -p * q + 1.0f / 3.0f;
    angle = t - t * q * p;
    angle = v_select(big, v_set(0.25f * TYNI_PI) + v_select(v_lt(low, high), -angle, zero), angle);
    angle = v_select(v_gt(a, b), 0.5f * TYNI_PI - angle, angle);
    angle = v_select(v_lt(x, zero), TYNI_PI - angle, angle);
    angle = v_select(v_lt(y, zero), -angle, angle);
    return v_select(v_gt(high, zero), angle, zero);
}
