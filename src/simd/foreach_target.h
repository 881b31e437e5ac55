// SPDX-License-Identifier: Apache-2.0
// Compiles a source file once for each instruction set. The file begins with
//
//   #undef LAMINA_TARGET_FILE
//   #define LAMINA_TARGET_FILE "its path from src/"
//   #include "simd/foreach_target.h"
//
// and then includes headers of vector code (-inl.h). Its vector functions stand between
// LAMINA_SIMD_BEGIN and LAMINA_SIMD_END, in a namespace for each instruction set. The functions
// that call them stand behind `#if LAMINA_ONCE`: LAMINA_EXPORT(f) makes a table of f's versions,
// and LAMINA_DISPATCH(f)(...) calls the best version that this machine can run and
// restrict_instructions() allows. There is no `#pragma once`, because Highway includes the file
// again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE LAMINA_TARGET_FILE
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "simd/target.h"
