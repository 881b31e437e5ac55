// SPDX-License-Identifier: Apache-2.0
// Tests that run once on every instruction set of the machine.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tiles/instruction_set.h"

namespace lamina {

class EveryInstructionSet : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        restrict_instructions(GetParam());
        ASSERT_EQ(instruction_set(), GetParam());
    }
    void TearDown() override { restrict_instructions(instruction_sets_.front()); }

  private:
    const std::vector<std::string> instruction_sets_ = instruction_sets();
};

inline const auto every_instruction_set = testing::ValuesIn(instruction_sets());

inline std::string instruction_set_name(const testing::TestParamInfo<std::string>& info) {
    return info.param;
}

}  // namespace lamina
