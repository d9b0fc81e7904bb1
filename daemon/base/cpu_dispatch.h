// SPDX-License-Identifier: MIT
#pragma once

// Compiles a function in two versions; the loader chooses the one for this processor. Neither
// version uses fused multiplication, so both compute the same bits. Disabled under sanitizers,
// which cannot run this early.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAMWAY_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define CAMWAY_FOR_EVERY_PROCESSOR
#endif
