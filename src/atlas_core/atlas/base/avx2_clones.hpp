// SPDX-License-Identifier: MIT
// A loop compiled twice, for AVX2 and for any processor; which one runs is found out when the program starts.
// The results are the same bits: integers, or floats without contraction of operations.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define ATLAS_AVX2_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ATLAS_AVX2_CLONES  // sanitizers do not know functions that are chosen at the start
#endif
