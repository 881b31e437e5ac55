// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/base.h>

// How functions that compute with vectors are compiled. A lambda needs LAMINA_LAMBDA behind its
// parameters: compilers give it no instruction set of its own.
#define LAMINA_INLINE HWY_INLINE
#define LAMINA_NOINLINE HWY_NOINLINE
#define LAMINA_LAMBDA HWY_ATTR
