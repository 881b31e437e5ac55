// SPDX-License-Identifier: Apache-2.0
#include "plan/omission.h"

#include <fmt/format.h>

namespace lamina {
namespace {

std::string with_prefix(double amount) {
    if (amount >= 1e9) return fmt::format("{:.3g} G ", amount / 1e9);
    if (amount >= 1e6) return fmt::format("{:.3g} M ", amount / 1e6);
    if (amount >= 1e3) return fmt::format("{:.3g} k ", amount / 1e3);
    return fmt::format("{:.3g} ", amount);
}

}  // namespace

std::vector<std::pair<const char*, double>> Work::amounts() const {
    std::vector<std::pair<const char*, double>> found;
    const auto add = [&](const char* name, double amount) {
        if (amount != 0) found.emplace_back(name, amount);
    };
    add("segments", segments);
    add("fetches", fetches);
    add("tets", tets);
    add("ordered tets", ordered);
    add("passes", passes);
    add("bytes", bytes);
    return found;
}

Work operator-(const Work& a, const Work& b) {
    return {a.segments - b.segments, a.fetches - b.fetches, a.tets - b.tets,
            a.ordered - b.ordered,   a.passes - b.passes,   a.bytes - b.bytes};
}

std::string to_text(const Work& work) {
    std::string text;
    for (const auto& [name, amount] : work.amounts()) {
        if (amount > 0)
            text += fmt::format("{}{}{}", text.empty() ? "" : ", ", with_prefix(amount), name);
    }
    return text;
}

std::vector<std::string> omission_names() {
    return {"blending",
            "clip_planes",
            "color",
            "constant_regions",
            "double_precision",
            "drawing",
            "early_termination",
            "empty_space",
            "length_layers",
            "order",
            "perspective",
            "scalars",
            "smooth_points",
            "table",
            "transparent_tets",
            "volume_texture"};
}

}  // namespace lamina
