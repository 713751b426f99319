/* lanes_ops.h - a kernel for tests/test_lanes.c: every operation of src/lanes on its numbers. What one ISA writes must be
 * what scalar writes. */

TYNI_V_INLINE v_float TYNI_V(test_wave)(v_float x, int second)
{
    v_float s, c;
    v_sincos(x, &s, &c);
    return second ? c : s;
}

TYNI_V_INLINE v_float TYNI_V(test_fade)(v_float x, int lost)
{
    v_float out[2], many[TYNI_CHAINS], left[TYNI_CHAINS], gone[TYNI_CHAINS];
    for (int32_t n = 0; n < TYNI_CHAINS; n++)
        many[n] = n == TYNI_CHAINS - 2 ? x : v_set(0.5f * (float)n);
    v_fades(many, TYNI_CHAINS, left, gone);
    v_fade(x, &out[0], &out[1]);
    return v_select(v_eq(out[lost], lost ? gone[TYNI_CHAINS - 2] : left[TYNI_CHAINS - 2]), out[lost],
                    v_set(-1.0f)); /* both are the same */
}

/* Results that hold numbers: any NaN is as good as any other. */
static TYNI_V_TARGET void TYNI_V(test_numbers)(const float *a, const float *b, const float *small, float *out)
{
#define EACH(expression)                                                                                                       \
    for (int32_t i = 0; i < OPS_COUNT; i += v_n) {                                                                             \
        const v_float x = v_load(a + i), y = v_load(b + i), s = v_load(small + i);                                             \
        (void)x, (void)y, (void)s;                                                                                             \
        v_store(out + i, expression);                                                                                          \
    }                                                                                                                          \
    out += OPS_COUNT;
    EACH(x + y)
    EACH(x - y)
    EACH(x * y)
    EACH(x / y)
    EACH(x * y + s)
    EACH(x * y - s * x)
    EACH(2.0f * x + 1.0f)
    EACH(1.0f - x / 3.0f)
    EACH(-x)
    EACH(v_sqrt(x))
    EACH(v_exp(x))
    EACH(v_exp(s))
    EACH(v_log(x))
    EACH(v_log(v_abs(s)))
    EACH(v_fog(v_abs(x)))
    EACH(v_fog(v_abs(s)))
    EACH(TYNI_V(test_fade)(v_abs(x), 0))
    EACH(TYNI_V(test_fade)(v_abs(s), 0))
    EACH(TYNI_V(test_fade)(v_abs(x), 1))
    EACH(TYNI_V(test_fade)(v_abs(s), 1))
    EACH(v_atan2(x, y))
    EACH(v_atan2(s, y))
    EACH(v_atan2(s, v_set(1.0f)))
    EACH(TYNI_V(test_wave)(s, 0))
    EACH(TYNI_V(test_wave)(s, 1))
    EACH(TYNI_V(test_wave)(s * 20.0f, 1))
#undef EACH
}

/* Results that must be the same bits. `in_range` can be made integers. */
static TYNI_V_TARGET void TYNI_V(test_bits)(const float *a, const float *b, const float *in_range, const int32_t *ia,
                                            const int32_t *ib, int32_t *out)
{
#define EACH(expression)                                                                                                       \
    for (int32_t i = 0; i < OPS_COUNT; i += v_n) {                                                                             \
        const v_float x = v_load(a + i), y = v_load(b + i), r = v_load(in_range + i);                                          \
        const v_int k = v_iload(ia + i), l = v_iload(ib + i);                                                                  \
        (void)x, (void)y, (void)r, (void)k, (void)l;                                                                           \
        v_istore(out + i, expression);                                                                                         \
    }                                                                                                                          \
    out += OPS_COUNT;
#define FLOAT(expression) EACH(v_bits(expression))
#define MASK(expression) EACH(v_iselect(expression, v_iset(1), v_iset(0)))
    FLOAT(v_set(1.5f))
    FLOAT(v_min(x, y))
    FLOAT(v_max(x, y))
    FLOAT(v_min(y, x))
    FLOAT(v_max(y, x))
    FLOAT(v_abs(x))
    FLOAT(v_clamp(x, y, r))
    FLOAT(v_clamp(x, v_set(-1.0f), v_set(1.0f)))
    FLOAT(v_select(v_lt(x, y), x, y))
    FLOAT(v_to_float(k))
    FLOAT(v_from_bits(k))
    MASK(v_lt(x, y))
    MASK(v_le(x, y))
    MASK(v_gt(x, y))
    MASK(v_ge(x, y))
    MASK(v_eq(x, y))
    MASK(v_ne(x, y))
    MASK(v_mand(v_lt(x, y), v_ilt(k, l)))
    MASK(v_mor(v_lt(x, y), v_ilt(k, l)))
    MASK(v_mandnot(v_lt(x, y), v_ilt(k, l)))
    MASK(v_ilt(k, l))
    MASK(v_igt(k, l))
    MASK(v_ieq(k, l))
    EACH(v_bits(x))
    EACH(v_trunc(r))
    EACH(v_floori(r))
    EACH(v_ceili(r))
    EACH(v_iadd(k, l))
    EACH(v_isub(k, l))
    EACH(v_imul(k, l))
    EACH(v_imin(k, l))
    EACH(v_imax(k, l))
    EACH(v_iand(k, l))
    EACH(v_ior(k, l))
    EACH(v_ixor(k, l))
    EACH(v_iandnot(k, l))
    EACH(v_iselect(v_lt(x, y), k, l))
    for (int32_t n = 0; n < 32; n++) {
        EACH(v_shl(k, n))
        EACH(v_shr(k, n))
        EACH(v_sar(k, n))
    }
#undef MASK
#undef FLOAT
#undef EACH
}

/* Loads and stores of n lanes, against plain loops; `at` is the end of readable memory. */
static TYNI_V_TARGET void TYNI_V(test_memory)(uint8_t *at, int32_t n)
{
    const int32_t count = tyni_clampi(n, 0, v_n);
    float f[v_n];
    int32_t k[v_n];
    uint8_t before[256], *bytes = at - 256;
    const uint32_t one = 1;
    const int low_first = *(const uint8_t *)&one;
    for (int32_t i = 0; i < 256; i++)
        before[i] = bytes[i] = (uint8_t)test_random();
    v_store(f, v_load_n((float *)(void *)(at - 4 * count), n));
    v_istore(k, v_iload_n(at - 4 * count, n));
    for (int32_t i = 0; i < v_n; i++) {
        CHECK(i < count ? memcmp(&f[i], at - 4 * count + 4 * i, 4) == 0 : tyni_float_bits(f[i]) == 0);
        CHECK(i < count ? memcmp(&k[i], at - 4 * count + 4 * i, 4) == 0 : k[i] == 0);
    }
    v_istore(k, v_load_u8_n(at - count, n));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(k[i] == (i < count ? at[i - count] : 0));
    CHECK(memcmp(before, bytes, 256) == 0);
    for (int32_t i = 0; i < v_n; i++) {
        k[i] = (int32_t)test_random();
        memcpy(&f[i], &k[i], 4);
    }
#define STORED(size, store)                                                                                                    \
    store;                                                                                                                     \
    for (int32_t i = 0; i < count; i++) {                                                                                      \
        memcpy(before + 256 - (size) * (count - i), at - (size) * (count - i), (size));                                        \
        CHECK(memcmp(at - (size) * (count - i), (uint8_t *)&k[i] + (low_first ? 0 : 4 - (size)), (size)) == 0);                \
    }                                                                                                                          \
    CHECK(memcmp(before, bytes, 256) == 0);
    STORED(4, v_store_n((float *)(void *)(at - 4 * count), v_load(f), n))
    STORED(4, v_istore_n(at - 4 * count, v_iload(k), n))
    STORED(2, v_store_u16_n((uint16_t *)(void *)(at - 2 * count), v_iload(k), n))
    STORED(1, v_store_u8_n(at - count, v_iload(k), n))
#undef STORED
    v_store_rgba8_n(at - 4 * count, v_iload(k), v_iadd(v_iload(k), v_iset(1)), v_shr(v_iload(k), 8), v_iset(255), n);
    for (int32_t i = 0; i < count; i++) {
        uint8_t *p = at - 4 * (count - i);
        CHECK(p[0] == (uint8_t)k[i] && p[1] == (uint8_t)(k[i] + 1) && p[2] == (uint8_t)(k[i] >> 8) && p[3] == 255);
        memcpy(before + 256 - 4 * (count - i), p, 4);
    }
    CHECK(memcmp(before, bytes, 256) == 0);
    v_store_rgb_n((float *)(void *)(at - 12 * count), v_load(f), v_from_bits(v_iset(7)), v_from_bits(v_index()), n);
    for (int32_t i = 0; i < count; i++) {
        int32_t rgb[3];
        memcpy(rgb, at - 12 * (count - i), 12);
        CHECK(rgb[0] == k[i] && rgb[1] == 7 && rgb[2] == i);
        memcpy(before + 256 - 12 * (count - i), rgb, 12);
    }
    CHECK(memcmp(before, bytes, 256) == 0);
}

/* Whole vectors, in place, and what goes over lanes. */
static TYNI_V_TARGET void TYNI_V(test_whole)(const float *a, const int32_t *ia)
{
    float table[64], f[4 * 16], rgb[3 * 16 + 8];
    int32_t k[16];
    uint8_t bytes[4 * 16 + 8];
    uint16_t words[256];
    v_float r, g, b, part[16 / v_n];
    v_mask m = v_lt(v_load(a), v_load(a + 16));
    memcpy(table, a, sizeof table);
    for (int32_t i = 0; i < 256; i++)
        words[i] = (uint16_t)(i * 257 ^ i << 5);
    for (int32_t i = 0; i < v_n; i++)
        k[i] = (int32_t)(test_random() % 64);
    v_store(f, v_gather(table, v_iload(k)));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(memcmp(&f[i], &table[k[i]], 4) == 0);
    for (int32_t i = 0; i < v_n; i++)
        k[i] = (int32_t)test_random();
    v_store(f, v_pick16(table + 5, v_iload(k)));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(memcmp(&f[i], &table[5 + (k[i] & 15)], 4) == 0);
    for (int32_t i = 0; i < v_n; i++)
        k[i] = (int32_t)(test_random() % (uint32_t)v_n);
    v_store(f, v_pick(table + 3, v_iload(k)));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(memcmp(&f[i], &table[3 + k[i]], 4) == 0);
    v_store(f, v_from_bits(v_ipick(table + 5, v_iload(k))));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(memcmp(&f[i], &table[5 + k[i]], 4) == 0);
    for (int32_t n = 0; n < 8; n++) {
        const int32_t byte[3] = {(int32_t)(test_random() & 3u), (int32_t)(test_random() & 3u), (int32_t)(test_random() & 3u)};
        v_int three[3];
        for (int32_t i = 0; i < 4 * v_n; i++)
            bytes[i] = (uint8_t)test_random();
        v_rgb_words(words, bytes, byte, three);
        for (int32_t c = 0; c < 3; c++) {
            v_istore(k, three[c]);
            for (int32_t i = 0; i < v_n; i++)
                CHECK(k[i] == words[bytes[4 * i + byte[c]]]);
        }
    }
    for (int32_t i = 0; i < v_n; i++)
        k[i] = (int32_t)(test_random() % 253) - 128;
    v_store(f, v_from_bits(v_igather(table + 32, v_iload(k))));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(memcmp(&f[i], (uint8_t *)&table[32] + k[i], 4) == 0);
    for (int32_t apart = 0; apart <= 15; apart += 5) {
        v_store(f, v_from_bits(v_iload_apart((uint8_t *)table + 3, apart)));
        for (int32_t i = 0; i < v_n; i++)
            CHECK(memcmp(&f[i], (uint8_t *)table + 3 + i * apart, 4) == 0);
    }
    for (int32_t i = 0; i < v_n; i++)
        k[i] = a[i] < a[16 + i] ? k[i] : 2000000000;
    v_store(f, v_from_bits(v_igather_where(table + 32, v_iload(k), m)));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(a[i] < a[16 + i] ? memcmp(&f[i], (uint8_t *)&table[32] + k[i], 4) == 0 : tyni_float_bits(f[i]) == 0);
    /* bytes and words, both ways; nothing beyond */
    memset(bytes, 0x5a, sizeof bytes);
    memset(words, 0x5a, sizeof words);
    v_store_u8(bytes, v_iload(ia));
    v_store_u16(words, v_iload(ia));
    CHECK(bytes[v_n] == 0x5a && words[v_n] == 0x5a5a);
    for (int32_t i = 0; i < v_n; i++)
        CHECK(bytes[i] == (uint8_t)ia[i] && words[i] == (uint16_t)ia[i]);
    v_istore(k, v_load_u8(bytes));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(k[i] == bytes[i]);
    v_istore(k, v_load_u16(words));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(k[i] == words[i]);
    v_store_rgba8(bytes, v_iload(ia), v_iset(-1), v_index(), v_iset(0));
    CHECK(bytes[4 * v_n] == 0x5a || v_n == 1);
    for (int32_t i = 0; i < v_n; i++)
        CHECK(bytes[4 * i] == (uint8_t)ia[i] && bytes[4 * i + 1] == 255 && bytes[4 * i + 2] == i && bytes[4 * i + 3] == 0);
    /* triples, there and back */
    memset(rgb, 0x5a, sizeof rgb);
    v_store_rgb(rgb, v_load(a), v_load(a + 16), v_load(a + 32));
    for (int32_t i = 0; i < v_n; i++)
        CHECK(!memcmp(&rgb[3 * i], &a[i], 4) && !memcmp(&rgb[3 * i + 1], &a[16 + i], 4) &&
              !memcmp(&rgb[3 * i + 2], &a[32 + i], 4));
    CHECK(tyni_float_bits(rgb[3 * v_n]) == 0x5a5a5a5au);
    v_load_rgb(rgb, &r, &g, &b);
    v_store(f, r);
    v_store(f + 16, g);
    v_store(f + 32, b);
    for (int32_t c = 0; c < 3; c++)
        CHECK(memcmp(f + 16 * c, a + 16 * c, 4 * v_n) == 0);
    /* masks */
    memcpy(f, a, sizeof f);
    v_store_where(f, m, v_load(a + 32));
    for (int32_t i = 0; i < v_n; i++) {
        CHECK(memcmp(&f[i], a[i] < a[16 + i] ? &a[32 + i] : &a[i], 4) == 0);
        CHECK((v_word(m) >> i & 1u) == (uint32_t)(a[i] < a[16 + i]));
    }
    CHECK(memcmp(f + v_n, a + v_n, sizeof f - 4 * v_n) == 0);
    memcpy(rgb, a, 4 * 48);
    v_istore_where(rgb, m, v_bits(v_load(a + 32)));
    CHECK(memcmp(rgb, f, 4 * 48) == 0);
    CHECK(v_any(m) == (v_word(m) != 0) && v_none(m) == !v_any(m) && v_all(m) == (v_word(m) == (1u << v_n) - 1u));
    for (int32_t n = -2; n < 20; n++)
        CHECK(v_word(v_first(n)) == (1u << tyni_clampi(n, 0, v_n)) - 1u);
    /* in place */
    memcpy(f, a, sizeof f);
    for (int32_t i = 0; i < 16; i += v_n)
        v_store(f + i, v_min(v_load(f + i), v_load(f + 16 + i)));
    for (int32_t i = 0; i < 16; i++) {
        const float least = tyni_minf(a[i], a[16 + i]);
        CHECK(memcmp(&f[i], &least, 4) == 0);
    }
    /* over lanes */
    for (int32_t i = 0; i < 16; i++)
        f[i] = (float)(ia[i] >> 8) * 1e-3f;
    for (int32_t i = 0; i < 16; i += v_n)
        part[i / v_n] = v_load(f + i);
    {
        float sum = v_sum16(part), expected = tyni_scalar_sum16(f), low = f[0], high = f[0];
        uint32_t whole = 0;
        CHECK(memcmp(&sum, &expected, 4) == 0);
        for (int32_t i = 0; i < v_n; i++) {
            low = tyni_minf(f[i], low);
            high = tyni_maxf(f[i], high);
            whole += (uint32_t)ia[i];
        }
        CHECK(v_hmin(part[0]) <= low && v_hmin(part[0]) >= low && v_hmax(part[0]) <= high && v_hmax(part[0]) >= high);
        CHECK((uint32_t)v_isum(v_iload(ia)) == whole);
    }
}

static TYNI_V_TARGET uint32_t TYNI_V(test_unword)(uint32_t word)
{
    return v_word(v_unword(word)) ^ (word & ((1u << v_n) - 1u));
}

static TYNI_V_TARGET uint32_t TYNI_V(test_word)(const uint16_t *t, uint32_t position)
{
    return v_above16(t, position);
}

static TYNI_V_TARGET uint64_t TYNI_V(test_words)(const uint16_t *t, uint32_t position)
{
    return v_above64(t, position);
}

static TYNI_V_TARGET int32_t TYNI_V(test_pack)(uint16_t *out, const uint16_t *from, uint64_t bits)
{
    return v_pack64(out, from, bits);
}

static TYNI_V_TARGET void TYNI_V(test_dots8)(const int16_t *a, const int8_t *const b[4], int32_t n, int32_t *out)
{
    v_dots8(a, b, n, out);
}
