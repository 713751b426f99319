/* each.h - the kernel TYNI_KERNEL, a template, for each ISA that is built in. See lanes.h. */
/* gcc 12, with AVX-512 allowed everywhere (-O3 -march=native), packs scalars of the four-lane kernels anew and loses some:
 * pixels differed. Kernels are vectors already. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__AVX512F__)
#pragma GCC push_options
#pragma GCC optimize("no-tree-slp-vectorize")
#define TYNI_LANES_POP
#endif
#define TYNI_ISA scalar
#include TYNI_KERNEL
#undef TYNI_ISA
#ifdef TYNI_LANES_X86
#define TYNI_ISA sse2
#include TYNI_KERNEL
#undef TYNI_ISA
#define TYNI_ISA avx2
#include TYNI_KERNEL
#undef TYNI_ISA
#endif
#ifdef TYNI_LANES_AVX512
#define TYNI_ISA avx512
#include TYNI_KERNEL
#undef TYNI_ISA
#endif
#ifdef TYNI_LANES_NEON
#define TYNI_ISA neon
#include TYNI_KERNEL
#undef TYNI_ISA
#endif
#ifdef TYNI_LANES_WASM
#define TYNI_ISA wasm
#include TYNI_KERNEL
#undef TYNI_ISA
#endif
#ifdef TYNI_LANES_POP
#pragma GCC pop_options
#undef TYNI_LANES_POP
#endif
#undef TYNI_KERNEL
