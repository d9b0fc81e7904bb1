// SPDX-License-Identifier: MIT
#pragma once

// Compiles a function in two versions; the loader chooses the one for this processor. Neither
// version uses fused multiplication, so both compute the same bits. Disabled under sanitizers,
// which cannot run this early.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAMWAY_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
// For a function with a version of its own for AVX2, which may use intrinsics. Calls choose between
// the two in files that see both.
#define CAMWAY_WITH_AVX2 __attribute__((target("avx2")))
#define CAMWAY_WITHOUT_AVX2 __attribute__((target("default")))
#else
#define CAMWAY_FOR_EVERY_PROCESSOR
#define CAMWAY_WITHOUT_AVX2
#endif
