// SPDX-License-Identifier: Apache-2.0
// Compiles a source file once for each instruction set. The file begins with
//
//   #undef LAMINA_TARGET_FILE
//   #define LAMINA_TARGET_FILE "its path from src/"
//   #include "simd/foreach_target.h"
//
// and includes headers of vectors (-inl.h) behind that. Its functions of vectors stand between
// LAMINA_SIMD_BEGIN and LAMINA_SIMD_END, in a namespace for each instruction set, and what calls
// them behind `#if LAMINA_ONCE`: LAMINA_EXPORT(f) makes a table of f's versions, and
// LAMINA_DISPATCH(f)(...) calls the one for this machine, or that restrict_instructions() leaves.
// No `#pragma once`: Highway's headers see to what is included again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE LAMINA_TARGET_FILE
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/target.h"
