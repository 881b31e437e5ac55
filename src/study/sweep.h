// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scene_files/json_reader.h"

namespace lamina::study {

// Keys of a scene, by name, with the values that a run gives them. null removes the key.
using Settings = std::vector<std::pair<std::string, nlohmann::json>>;

const nlohmann::json* find_setting(const Settings& settings, const std::string& key);

constexpr std::uint64_t most_runs = 100000;  // runs of a study

// All values of one key.
struct SweepAxis {
    std::string key;
    std::vector<nlohmann::json> values;  // at least one
};

// All combinations of the values of its axes.
struct SweepGrid {
    std::vector<SweepAxis> axes;  // at least one

    std::uint64_t count() const;               // saturates at 2^63 - 1
    Settings settings(std::uint64_t n) const;  // the n-th; the last axis changes first
};

// Reads `sweep` of a study file: a grid {key: values, ...} or a list of grids. Values are a list,
// one value, or {"factorizations": N, "levels": k}. Throws KeyError, also for more than most_runs
// factorizations in all.
std::vector<SweepGrid> read_sweep(JsonReader& study);

// All ordered lists of factors >= 2 with the product `of` >= 2 and at most `levels` factors; short
// lists come first. Where there are more than most_runs, it stops soon after that number.
std::vector<std::vector<int>> factorizations(int of, int levels);

// A setting as a name and for a cell of a table: a list of whole numbers as "32x32", words without
// quotes, everything else as JSON.
std::string setting_text(const nlohmann::json& value);

}  // namespace lamina::study
