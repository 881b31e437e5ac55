// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include "simd/attributes.h"

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
// Calls the version for the least instruction set, in files that are compiled for no other.
#define LAMINA_LEAST(function) HWY_STATIC_DISPATCH(function)
