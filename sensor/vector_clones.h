#pragma once

/// Before a function: compile it for AVX-512, for AVX2 and for any x86-64, and choose when the
/// program starts. Its loops are plain loops over arrays that compilers turn into vector code
/// (#pragma omp simd). All versions give the same bits: every operation in them is one that IEEE
/// 754 rounds one way, and none is fused (-ffp-contract=off).
#if defined(__x86_64__) && defined(__linux__)
#define NEXTVIEW_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define NEXTVIEW_VECTOR_CLONES
#endif
