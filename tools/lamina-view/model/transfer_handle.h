// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>

namespace lamina::view {

// A point of one of the two curves of a transfer function, by its number there.
struct TransferHandle {
    enum class Curve { density, color };

    Curve curve = Curve::density;
    std::size_t index = 0;

    friend auto operator<=>(const TransferHandle&, const TransferHandle&) = default;
};

}  // namespace lamina::view
