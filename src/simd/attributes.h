// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/base.h>

// Attributes of functions that compute with vectors. A lambda needs LAMINA_LAMBDA behind its
// parameters: compilers give it no instruction set of its own.
#define LAMINA_INLINE HWY_INLINE
#define LAMINA_NOINLINE HWY_NOINLINE
#define LAMINA_LAMBDA HWY_ATTR
