// SPDX-License-Identifier: Apache-2.0
#include "study/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "base/json_text.h"
#include "base/text.h"

namespace lamina::study {
namespace {

constexpr std::int64_t largest_product = 65536;  // slabs of a tree
constexpr std::int64_t most_levels = 16;
constexpr std::size_t most_keys = 256;  // of a grid: more than a scene has

// Stops after more than most_runs.
void append_factorizations(int of, int levels, std::vector<int>& factors,
                           std::vector<std::vector<int>>& all) {
    if (levels == 1) {
        factors.push_back(of);
        all.push_back(factors);
        factors.pop_back();
        return;
    }
    for (int factor = 2; factor <= of / 2 && all.size() <= most_runs; ++factor) {
        if (of % factor != 0) continue;
        factors.push_back(factor);
        append_factorizations(of / factor, levels - 1, factors, all);
        factors.pop_back();
    }
}

// `listed` is the number of factorizations so far: a short file could ask for more than any memory
// holds.
std::vector<nlohmann::json> read_values(JsonReader& grid, const std::string& key,
                                        std::size_t& listed) {
    const nlohmann::json& found = grid.value(key);
    if (found.is_object() && found.contains("factorizations")) {
        JsonReader reader = grid.object(key);
        const auto of = reader.whole("factorizations", 2, largest_product);
        const auto levels =
            reader.has("levels") ? reader.whole("levels", 1, most_levels) : most_levels;
        reader.close();
        auto found_factors = factorizations(static_cast<int>(of), static_cast<int>(levels));
        listed += found_factors.size();
        if (listed > most_runs) {
            grid.fail_at(key, fmt::format("more than {} factorizations in all, expected fewer "
                                          "\"levels\"",
                                          most_runs));
        }
        std::vector<nlohmann::json> values;
        for (auto& factors : found_factors) values.emplace_back(std::move(factors));
        return values;
    }
    if (!found.is_array()) return {found};
    if (found.empty()) grid.reject(key, "a list of at least one value");
    return {found.begin(), found.end()};
}

SweepGrid read_grid(JsonReader& study, const std::string& at, const nlohmann::json& object,
                    std::size_t& listed) {
    if (!object.is_object() || object.empty())
        study.fail_at(at,
                      fmt::format("found {}, expected an object with a key of the scene and its "
                                  "values, as {{\"render.slice.samples\": [256, 512]}}",
                                  shortened(json_text(object))));
    if (object.size() > most_keys)
        study.fail_at(at,
                      fmt::format("found {} keys, expected at most {}", object.size(), most_keys));
    JsonReader reader(object, study.file(), at);
    SweepGrid grid;
    for (const auto& [key, values] : object.items())
        grid.axes.push_back({key, read_values(reader, key, listed)});
    return grid;
}

bool is_list_of_whole_numbers(const nlohmann::json& value) {
    return value.is_array() && !value.empty() &&
           std::all_of(value.begin(), value.end(),
                       [](const nlohmann::json& each) { return each.is_number_integer(); });
}

}  // namespace

const nlohmann::json* find_setting(const Settings& settings, const std::string& key) {
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const auto& setting) { return setting.first == key; });
    return found == settings.end() ? nullptr : &found->second;
}

std::uint64_t SweepGrid::count() const {
    constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
    std::uint64_t product = 1;
    for (const SweepAxis& axis : axes) {
        if (product > most / axis.values.size()) return most;
        product *= axis.values.size();
    }
    return product;
}

Settings SweepGrid::settings(std::uint64_t n) const {
    Settings settings(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        const SweepAxis& axis = axes[i];
        settings[i] = {axis.key, axis.values[n % axis.values.size()]};
        n /= axis.values.size();
    }
    return settings;
}

std::vector<SweepGrid> read_sweep(JsonReader& study) {
    const nlohmann::json& found = study.value("sweep");
    std::vector<SweepGrid> grids;
    std::size_t listed = 0;
    if (found.is_array() && !found.empty()) {
        for (const nlohmann::json& grid : found)
            grids.push_back(read_grid(study, fmt::format("sweep.{}", grids.size()), grid, listed));
    } else {
        grids.push_back(read_grid(study, "sweep", found, listed));
    }
    return grids;
}

std::vector<std::vector<int>> factorizations(int of, int levels) {
    std::vector<std::vector<int>> all;
    std::vector<int> factors;
    for (int length = 1; length <= levels; ++length)
        append_factorizations(of, length, factors, all);
    return all;
}

std::string setting_text(const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (is_list_of_whole_numbers(value))
        return fmt::format("{}", fmt::join(value.get<std::vector<std::int64_t>>(), "x"));
    return value.is_null() ? "" : json_text(value);
}

}  // namespace lamina::study
