// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scene_files/json_reader.h"

namespace lamina::study {

// Keys of a scene with the values that a run gives them, by name; null is as if the scene did not
// have the key.
using Settings = std::vector<std::pair<std::string, nlohmann::json>>;

const nlohmann::json* find_setting(const Settings& settings, const std::string& key);

constexpr std::uint64_t most_runs = 100000;  // of a study

// All values of one key.
struct SweepAxis {
    std::string key;
    std::vector<nlohmann::json> values;  // at least one
};

// Every value of every axis with every one of the others.
struct SweepGrid {
    std::vector<SweepAxis> axes;  // at least one

    std::uint64_t count() const;               // saturates at 2^63 - 1
    Settings settings(std::uint64_t n) const;  // the n-th; the last axis changes first
};

// Of a study file: `sweep`, a grid {key: values, ...} or a list of them. Values: a list, one value,
// or {"factorizations": N, "levels": k}. Throws KeyError, also for more than most_runs
// factorizations in all.
std::vector<SweepGrid> read_sweep(JsonReader& study);

// All lists of factors of at least 2 with the product `of`, ordered, at most `levels` long; the
// short ones first. of >= 2. Where there are more than most_runs, only some more than those.
std::vector<std::vector<int>> factorizations(int of, int levels);

// As a name and as a table's cell: "32x32" of a list of whole numbers, words without quotes, else
// JSON.
std::string setting_text(const nlohmann::json& value);

}  // namespace lamina::study
