// SPDX-License-Identifier: MIT
#pragma once

// Two versions of a function, and the loader takes the one for this processor. Without fused
// multiplication in either they compute the same bits. Sanitizers run before they can cope with it.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAMWAY_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define CAMWAY_FOR_EVERY_PROCESSOR
#endif
