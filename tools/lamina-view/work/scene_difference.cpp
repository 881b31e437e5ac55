// SPDX-License-Identifier: Apache-2.0
#include "work/scene_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lamina/scene_text.h"

namespace lamina::view {
namespace {

nlohmann::json flat(const Scene& scene) {
    return nlohmann::json::parse(scene_text(scene)).flatten();
}

std::string dotted(std::string pointer) {
    std::ranges::replace(pointer, '/', '.');
    return pointer.substr(1);
}

}  // namespace

std::vector<std::string> automatic_differences(const Scene& before, const Scene& after,
                                               const Scene& asked) {
    const nlohmann::json from = flat(before), to = flat(after), open = flat(asked);
    std::vector<std::string> differences;
    for (const auto& [key, value] : to.items()) {
        if (open.value(key, nlohmann::json("auto")) != "auto") continue;
        const nlohmann::json was = from.value(key, nlohmann::json());
        if (was != value)
            differences.push_back(
                fmt::format("{}: {} -> {}", dotted(key), was.dump(), value.dump()));
    }
    return differences;
}

}  // namespace lamina::view
