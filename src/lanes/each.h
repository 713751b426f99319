/* each.h - the kernel TYNI_KERNEL, a template, for each ISA that is built in. See lanes.h. */
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
#undef TYNI_KERNEL
