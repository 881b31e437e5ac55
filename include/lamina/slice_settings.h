// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "lamina/auto.h"
#include "lamina/order.h"
#include "lamina/tree_settings.h"

namespace lamina {

enum class Classification { post, preintegrated, exact };
enum class Filter { exact, hardware };

struct DitherSettings {
    Auto<int> period = 16;  // slabs after which the pattern repeats; all of them if automatic
    std::uint32_t seed = 1;
    bool color = false;
    int increment = 1;
};

inline constexpr int max_slabs = 65536;

// Size of a pre-integration table whose nodes lie on the transfer function's points.
struct SliceTableSettings {
    int scalars = 256;      // about the number of scalar nodes
    int lengths = 1;        // number of layers along length
    double max_length = 0;  // largest length of a segment in the table, in world units
};

struct SliceSettings {
    Auto<int> samples;  // number of slabs
    Auto<Classification> classification;
    Order order = Order::back_to_front;
    Auto<Filter> filter = Filter::exact;
    std::optional<DitherSettings> dither;
    std::optional<Auto<TreeSettings>> tree;  // without one, slabs are blended one by one
    Auto<SliceTableSettings> table;
};

}  // namespace lamina
