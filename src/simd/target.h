// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/base.h>

// Attributes of functions that compute with vectors. A lambda needs LAMINA_LAMBDA behind its
// parameters: compilers give it no instruction set of its own.
#define LAMINA_INLINE HWY_INLINE
#define LAMINA_NOINLINE HWY_NOINLINE
#define LAMINA_LAMBDA HWY_ATTR

// Begins and ends the code that is compiled for one instruction set, in a namespace of its own.
#define LAMINA_SIMD_BEGIN   \
    HWY_BEFORE_NAMESPACE(); \
    namespace lamina::HWY_NAMESPACE {
#define LAMINA_SIMD_END \
    }                   \
    HWY_AFTER_NAMESPACE();

#define LAMINA_ONCE HWY_ONCE
#define LAMINA_EXPORT(function) HWY_EXPORT(function)
#define LAMINA_DISPATCH(function) HWY_DYNAMIC_DISPATCH(function)
// Calls the version for the baseline instruction set, in files that are compiled for no other.
#define LAMINA_LEAST(function) HWY_STATIC_DISPATCH(function)
