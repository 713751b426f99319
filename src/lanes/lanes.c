/* lanes.c - which ISA there is, and which one is taken. */
#include "lanes/lanes.h"

#include "base.h"

#ifdef TYNI_LANES_X86
/* eax, ebx, ecx, edx */
static void cpuid(uint32_t leaf, uint32_t subleaf, uint32_t r[4])
{
    __asm__ volatile("cpuid" : "=a"(r[0]), "=b"(r[1]), "=c"(r[2]), "=d"(r[3]) : "a"(leaf), "c"(subleaf));
}

/* Which registers the operating system saves. */
static uint32_t saved(void)
{
    uint32_t low, high;
    __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0)); /* xgetbv, which old assemblers lack */
    return low;
}

static int32_t here(void)
{
    const uint32_t popcnt_osxsave_avx = 1u << 23 | 1u << 27 | 1u << 28, bmi_avx2_bmi2 = 1u << 3 | 1u << 5 | 1u << 8;
    const uint32_t f_dq_bw_vl = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31, vbmi2 = 1u << 6;
    int32_t isas = TYN_ISA_SCALAR | TYN_ISA_SSE2;
    uint32_t most[4], one[4], seven[4], state;
    cpuid(0, 0, most);
    cpuid(1, 0, one);
    if (most[0] < 7 || (one[2] & popcnt_osxsave_avx) != popcnt_osxsave_avx)
        return isas;
    cpuid(7, 0, seven);
    state = saved();
    if ((state & 0x06u) == 0x06u && (seven[1] & bmi_avx2_bmi2) == bmi_avx2_bmi2) {
        isas |= TYN_ISA_AVX2;
        if ((state & 0xe6u) == 0xe6u && (seven[1] & f_dq_bw_vl) == f_dq_bw_vl && (seven[2] & vbmi2))
            isas |= TYN_ISA_AVX512;
    }
    return isas & tyn_isa_built();
}
#else
static int32_t here(void)
{
    return tyn_isa_built();
}
#endif

int32_t tyn_isa_built(void)
{
#if defined(TYNI_LANES_AVX512)
    return TYN_ISA_SCALAR | TYN_ISA_SSE2 | TYN_ISA_AVX2 | TYN_ISA_AVX512;
#elif defined(TYNI_LANES_X86)
    return TYN_ISA_SCALAR | TYN_ISA_SSE2 | TYN_ISA_AVX2;
#elif defined(TYNI_LANES_NEON)
    return TYN_ISA_SCALAR | TYN_ISA_NEON;
#elif defined(TYNI_LANES_WASM)
    return TYN_ISA_SCALAR | TYN_ISA_WASM;
#else
    return TYN_ISA_SCALAR;
#endif
}

int32_t tyn_isa_available(void)
{
    return here();
}

const char *tyn_isa_name(int32_t isa)
{
    switch (isa) {
    case TYN_ISA_SCALAR:
        return "scalar";
    case TYN_ISA_SSE2:
        return "sse2";
    case TYN_ISA_AVX2:
        return "avx2";
    case TYN_ISA_AVX512:
        return "avx512";
    case TYN_ISA_NEON:
        return "neon";
    case TYN_ISA_WASM:
        return "wasm";
    default:
        return "unknown";
    }
}

tyn_status tyni_lanes_choose(int32_t wanted, int32_t *isa)
{
    const int32_t there = here(), all = 2 * TYN_ISA_WASM - 1;
    int32_t left = wanted ? wanted & there : there;
    if (wanted < 0 || wanted > all)
        return TYN_E_CONFIG;
    if (!left)
        return TYN_E_ISA;
    /* later bits are wider */
    while (left & (left - 1))
        left &= left - 1;
    *isa = left;
    return TYN_OK;
}
