// SPDX-License-Identifier: Apache-2.0
// A fixture for tests that run once with every instruction set of the machine.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simd/instruction_set.h"
#include "tiles/vector_functions.h"

namespace lamina {

class EveryInstructionSet : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        restrict_instructions(GetParam());
        ASSERT_EQ(instruction_set(), GetParam());
        const int lanes = GetParam() == "AVX3" ? 16 : GetParam() == "AVX2" ? 8 : 4;
        ASSERT_EQ(vector_lanes(), lanes) << "runs on something else";
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
