// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/error.h"

namespace lamina::fuzz {

// Thrown if something that must hold for every input does not hold: a finding.
class Violation : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& what) {
    if (!holds) throw Violation(what);
}

inline void require_finite(double number, const std::string& what) {
    require(std::isfinite(number), what + " is " + std::to_string(number));
}

// Calls `action`, which may throw Error, but only with a message that can be printed.
template <typename Action>
void may_fail(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        require(!one_line(error.what()).empty(), "an Error says nothing");
    }
}

}  // namespace lamina::fuzz
