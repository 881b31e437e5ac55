// SPDX-License-Identifier: Apache-2.0
// LAMINA_CLONE_FOR_FMA before a function compiles it for processors with fused multiply-add, too,
// and the loader chooses: without the instruction, std::fma is a call of the C library with the
// same result. What such a function calls belongs in it: LAMINA_IN_CLONES.
#pragma once

// Sanitizers are not ready when glibc's loader chooses between clones.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LAMINA_CLONE_FOR_FMA __attribute__((target_clones("default", "fma")))
#define LAMINA_IN_CLONES __attribute__((always_inline)) inline
#else
#define LAMINA_CLONE_FOR_FMA
#define LAMINA_IN_CLONES inline
#endif
