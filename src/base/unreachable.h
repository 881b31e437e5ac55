// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>

namespace lamina {

// Stands after a `switch` over an enum class that returns in a case for every value. Such a switch
// has no `default:`, so that the compiler (-Wswitch) warns where a new value lacks a case. But then
// the compiler assumes that other numbers may pass the switch, and warns that nothing is returned
// for these.
[[noreturn]] inline void unreachable_enum() {
    assert(false);
    __builtin_unreachable();
}

}  // namespace lamina
