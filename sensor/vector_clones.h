#pragma once

/// Before a function: compile it for AVX-512, for AVX2 and for any x86-64, and choose when the
/// program starts. Its loops are plain loops over arrays that compilers turn into vector code
/// (#pragma omp simd). All versions give the same bits: every operation in them is one that IEEE
/// 754 rounds one way, and none is fused (-ffp-contract=off). A test that compiles for one
/// instruction set alone defines what to put before functions
/// (tests/system/vector_clones_test.cpp).
#if defined(NEXTVIEW_VECTOR_CLONES)
#elif defined(__x86_64__) && defined(__linux__)
#define NEXTVIEW_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define NEXTVIEW_VECTOR_CLONES
#endif
