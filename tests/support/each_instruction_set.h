// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simd/instruction_set.h"
namespace lamina::test {

// Calls action(name) with each instruction set that this machine has, and goes back to the best.
template <typename Action>
void for_each_instruction_set(const Action& action) {
    const std::vector<std::string> names = instruction_sets();
    for (const std::string& name : names) {
        restrict_instructions(name);
        action(name);
    }
    restrict_instructions(names.front());
}

}  // namespace lamina::test
