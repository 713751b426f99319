/* test_lanes.c - src/lanes: every operation of every ISA against scalar, bit by bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#ifndef __wasi__
#include <sys/mman.h>
#endif

#include "lanes/lanes.h"
#include "num.h"
#include "test.h"

#define OPS_COUNT 256 /* numbers that an operation gets */
#define NUMBERS 26    /* operations of lanes_ops.h */
#define BITS (37 + 3 * 32)

#define TYNI_KERNEL "../tests/lanes_ops.h" /* from src/ */
#include "lanes/each.h"

static const int32_t isas[] = {TYN_ISA_SCALAR, TYN_ISA_SSE2, TYN_ISA_AVX2, TYN_ISA_AVX512, TYN_ISA_NEON, TYN_ISA_WASM};
#define ISAS ((int)(sizeof isas / sizeof *isas))

/* Begins a test of an ISA; 0 where it cannot run. */
static int begin(const char *what, int32_t isa)
{
    static char name[80];
    strcpy(name, "lanes: ");
    strcat(strcat(strcat(name, tyn_isa_name(isa)), ", "), what);
    TEST(name);
    if (tyn_isa_available() & isa)
        return 1;
    test_skip(tyn_isa_built() & isa ? "this machine lacks it" : "not built for this machine");
    return 0;
}

/* Any bits, with extremes among them. */
static uint32_t any_bits(void)
{
    static const uint32_t extreme[] = {0,           0x80000000u, 0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00000u,
                                       0x7f800001u, 1,           0x80000001u, 0x007fffffu, 0x00800000u, 0x7f7fffffu,
                                       0xff7fffffu, 0x3f800000u, 0xbf800000u, 0x7fffffffu, 0xffffffffu, 0x4b000000u,
                                       0x3f000000u, 0x42b00000u, 0xc2ae0000u};
    const uint32_t r = test_random();
    if (r % 4 == 0)
        return extreme[(r >> 8) % (sizeof extreme / sizeof *extreme)];
    return test_random() ^ test_random() << 16;
}

/* clang's fmaxnm for AArch64 gives NaN for a signalling one, where `x > 0 ? x : 0` gives 0: it takes all NaNs for quiet. */
static float any_float(void)
{
    const uint32_t bits = any_bits();
#if defined(__clang__) && defined(__aarch64__)
    return tyni_bits_float((bits & 0x7fffffffu) > 0x7f800000u ? bits | 0x400000u : bits);
#else
    return tyni_bits_float(bits);
#endif
}

typedef struct numbers {
    float a[OPS_COUNT], b[OPS_COUNT], small[OPS_COUNT], in_range[OPS_COUNT];
    int32_t ia[OPS_COUNT], ib[OPS_COUNT];
} numbers;

static void draw(numbers *n)
{
    for (int i = 0; i < OPS_COUNT; i++) {
        n->a[i] = any_float();
        n->b[i] = i % 5 ? any_float() : n->a[i];
        n->small[i] = test_random_float(-95, 95) * (i % 3 ? 1.0f : 0.01f);
        n->in_range[i] = (i & 1) ? test_random_float(-2147483000.0f, 2147483000.0f) : test_random_float(-9, 9);
        if (i % 7 == 0)
            n->in_range[i] = (float)(int32_t)n->in_range[i];
        n->ia[i] = (int32_t)any_bits();
        n->ib[i] = (int32_t)any_bits();
    }
}

static int same_number(float a, float b)
{
    return memcmp(&a, &b, 4) == 0 || (a != a && b != b);
}

static void test_ops(int32_t isa)
{
    static numbers n;
    static float floats[2][NUMBERS * OPS_COUNT];
    static int32_t bits[2][BITS * OPS_COUNT];
    if (!begin("operations", isa))
        return;
    for (int round = 0; round < 40; round++) {
        int wrong = -1;
        draw(&n);
        memset(floats, 0x11, sizeof floats);
        memset(bits, 0x11, sizeof bits);
        tyni_scalar_test_numbers(n.a, n.b, n.small, floats[0]);
        TYNI_LANES_CALL(isa, test_numbers, (n.a, n.b, n.small, floats[1]));
        for (int i = 0; i < NUMBERS * OPS_COUNT; i++)
            wrong = same_number(floats[0][i], floats[1][i]) ? wrong : i / OPS_COUNT;
        CHECK_NEAR(wrong, -1, 0); /* else the number of an operation in lanes_ops.h */
        tyni_scalar_test_bits(n.a, n.b, n.in_range, n.ia, n.ib, bits[0]);
        TYNI_LANES_CALL(isa, test_bits, (n.a, n.b, n.in_range, n.ia, n.ib, bits[1]));
        for (int i = 0; i < BITS * OPS_COUNT; i++)
            wrong = bits[0][i] == bits[1][i] ? wrong : i / OPS_COUNT;
        CHECK_NEAR(wrong, -1, 0);
        TYNI_LANES_CALL(isa, test_whole, (n.a, n.ia));
    }
}

/* Scalar's own rules, which the others then have. */
static void test_scalar(void)
{
    float wave[2], fade[2];
    numbers n;
    TEST("lanes: scalar is what the helpers and num.c are");
    for (int round = 0; round < 100; round++) {
        draw(&n);
        for (int i = 0; i < OPS_COUNT; i++) {
            const float x = n.a[i], y = n.b[i], s = n.small[i], r = n.in_range[i];
            CHECK(same_number(tyni_scalar_exp(x), tyni_num_exp(x)) && same_number(tyni_scalar_exp(s), tyni_num_exp(s)));
            CHECK(same_number(tyni_scalar_log(x), tyni_num_log(x)) && same_number(tyni_scalar_log(s), tyni_num_log(s)));
            CHECK(same_number(tyni_scalar_fog(tyni_absf(x)), tyni_num_fog(tyni_absf(x))));
            CHECK(same_number(tyni_scalar_fog(tyni_absf(s)), tyni_num_fog(tyni_absf(s))));
            tyni_num_fade(tyni_absf(s), &fade[0], &fade[1]);
            CHECK(same_number(tyni_scalar_test_fade(tyni_absf(s), 0), fade[0]));
            CHECK(same_number(tyni_scalar_test_fade(tyni_absf(s), 1), fade[1]));
            CHECK_NEAR(fade[0], exp(-fabs((double)s)), (6 + fabs((double)s)) * 1e-7 * exp(-fabs((double)s)) + 2e-38);
            CHECK_NEAR(fade[1], -expm1(-fabs((double)s)), -8e-7 * expm1(-fabs((double)s)));
            CHECK(same_number(tyni_scalar_atan2(x, y), tyni_num_atan2(x, y)));
            CHECK(same_number(tyni_scalar_atan2(s, r), tyni_num_atan2(s, r)));
            tyni_num_sincos(s, &wave[0], &wave[1]);
            CHECK(same_number(tyni_scalar_test_wave(s, 0), wave[0]) && same_number(tyni_scalar_test_wave(s, 1), wave[1]));
            CHECK(same_number(tyni_scalar_min(x, y), tyni_minf(x, y)) && same_number(tyni_scalar_max(x, y), tyni_maxf(x, y)));
            CHECK(same_number(tyni_scalar_abs(x), tyni_absf(x)));
            CHECK(same_number(tyni_scalar_clamp(x, y, s), tyni_clampf(x, y, s)));
            CHECK(tyni_scalar_floori(r) == tyni_floori(r) && tyni_scalar_ceili(r) == tyni_ceili(r));
        }
    }
}

static int protect(void *page, size_t size, int on)
{
#ifdef __wasi__
    (void)page, (void)size, (void)on;
    return 0;
#else
    return mprotect(page, size, on ? PROT_NONE : PROT_READ | PROT_WRITE) == 0;
#endif
}

static void test_memory(int32_t isa)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    void *block = NULL;
    uint8_t *end;
    if (!begin("partial loads and stores up to a page that must not be touched", isa))
        return;
    if (posix_memalign(&block, page, 3 * page)) {
        test_skip("no memory");
        return;
    }
    end = (uint8_t *)block + page;
    if (!protect(end, page, 1))
        test_skip("memory cannot be protected, what is loaded and stored is checked");
    for (int round = 0; round < 10; round++)
        for (int32_t n = -3; n <= 19; n++)
            TYNI_LANES_CALL(isa, test_memory, (end, n));
    protect(end, page, 0);
    free(block);
}

static void test_dots(int32_t isa)
{
    int16_t a[128];
    int8_t b[4][128];
    const int8_t *const rows[4] = {b[0], b[1], b[2], b[3]};
    if (!begin("sums of products", isa))
        return;
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < 128; i++) {
            a[i] = (int16_t)(round >= 4 ? any_bits() : round & 1 ? 0x8000u : 0x7fffu);
            for (int k = 0; k < 4; k++)
                b[k][i] = (int8_t)(round >= 4 ? any_bits() : round & 2 ? 0x80u : 0x7fu);
        }
        for (int32_t n = 0; n <= 128; n += 16) {
            int32_t out[2][4];
            TYNI_LANES_CALL(isa, test_dots8, (a, rows, n, out[0]));
            tyni_scalar_dots8(a, rows, n, out[1]);
            CHECK(memcmp(out[0], out[1], sizeof out[0]) == 0);
        }
    }
}

static void test_words(int32_t isa)
{
    static const uint32_t extreme[] = {0, 1, 0x7fff, 0x8000, 0x8001, 0xfffe, 0xffff};
    if (!begin("thresholds to words", isa))
        return;
    for (int round = 0; round < 2000; round++) {
        uint16_t t[64] = {0};
        uint32_t position = round % 3 ? test_random() & 0xffffu : extreme[test_random() % 7];
        uint64_t words = 0;
        for (int i = 0; i < 64; i++) {
            t[i] = (uint16_t)(test_random() % 3 ? test_random() : test_random() % 2 ? position : extreme[test_random() % 7]);
            words |= (uint64_t)(position < t[i]) << i;
        }
        CHECK(TYNI_LANES_CALL(isa, test_word, (t, position)) == (uint32_t)words);
        CHECK(TYNI_LANES_CALL(isa, test_words, (t, position)) == words);
        CHECK(TYNI_LANES_CALL(isa, test_unword, ((uint32_t)words)) == 0);
    }
}

static void test_pack(int32_t isa)
{
    if (!begin("words of the bits that are set", isa))
        return;
    for (int round = 0; round < 2000; round++) {
        uint16_t out[65], from[64];
        uint64_t bits = (uint64_t)test_random() << 32 | test_random();
        int32_t n = 0, count;
        for (int k = round % 5; k > 0; k--)
            bits &= (uint64_t)test_random() << 32 | test_random();
        bits = round % 97 ? bits : round % 2 ? 0 : ~(uint64_t)0;
        for (int i = 0; i < 64; i++)
            from[i] = (uint16_t)test_random();
        out[64] = 0x5a5a;
        count = TYNI_LANES_CALL(isa, test_pack, (out, from, bits));
        for (int i = 0; i < 64; i++)
            if (bits >> i & 1u) {
                CHECK(out[n] == from[i]);
                n++;
            }
        CHECK(count == n && out[64] == 0x5a5a);
    }
}

static void test_choice(void)
{
    const int32_t built = tyn_isa_built(), there = tyn_isa_available();
    int32_t isa = 0;
    TEST("lanes: what is built in, available, and picked");
    CHECK((there & ~built) == 0 && (there & TYN_ISA_SCALAR));
    CHECK(tyni_lanes_choose(0, &isa) == TYN_OK && (isa & there) && isa > there / 2);
    CHECK(tyni_lanes_choose(2 * TYN_ISA_WASM - 1, &isa) == TYN_OK && isa > there / 2);
    CHECK(tyni_lanes_choose(TYN_ISA_SCALAR, &isa) == TYN_OK && isa == TYN_ISA_SCALAR);
    CHECK(tyni_lanes_choose(-1, &isa) == TYN_E_CONFIG && tyni_lanes_choose(2 * TYN_ISA_WASM, &isa) == TYN_E_CONFIG);
    for (int i = 0; i < ISAS; i++) {
        CHECK(tyni_lanes_choose(isas[i], &isa) == (there & isas[i] ? TYN_OK : TYN_E_ISA));
        CHECK(!(there & isas[i]) || isa == isas[i]);
        CHECK(strcmp(tyn_isa_name(isas[i]), "unknown") != 0);
    }
    CHECK(strcmp(tyn_isa_name(TYN_ISA_AVX2), "avx2") == 0 && strcmp(tyn_isa_name(3), "unknown") == 0);
}

void test_lanes(void)
{
    test_scalar();
    test_choice();
    for (int i = 0; i < ISAS; i++) {
        test_ops(isas[i]);
        test_memory(isas[i]);
        test_words(isas[i]);
        test_pack(isas[i]);
        test_dots(isas[i]);
    }
}
