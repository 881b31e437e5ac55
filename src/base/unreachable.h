// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>

namespace lamina {

// Stands after a `switch` over an enum class that returns in a case for every value. Such a switch
// has no `default:`, so that the compiler (-Wswitch) names it where a new value lacks a case; but
// then it also takes it that another number may pass the switch, and asks what is returned there.
[[noreturn]] inline void unreachable_enum() {
    assert(false);
    __builtin_unreachable();
}

}  // namespace lamina
