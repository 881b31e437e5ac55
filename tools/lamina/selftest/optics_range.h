// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "lamina/transfer_function.h"
#include "selftest/interval.h"

namespace lamina::selftest {

// The optics of a transfer function over a closed interval of scalars. Both sides of steps count.
struct OpticsRange {
    Interval extinction;
    std::array<Interval, 3> color;

    void include(const OpticsRange& other);
};

OpticsRange optics_range(const TransferFunction& transfer_function, const Interval& scalars);

}  // namespace lamina::selftest
