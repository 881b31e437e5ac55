// SPDX-License-Identifier: Apache-2.0
#include "study/study_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/json_text.h"
#include "scene_files/scene_reader.h"

namespace lamina::study {
namespace {

constexpr std::int64_t largest_product = 65536;  // slabs that a tree can have
constexpr std::int64_t most_levels = 16;
constexpr std::size_t most_keys = 256;  // of a grid; a scene has fewer

// Appends all lists of `levels` factors with the product `of`; stops after more than most_runs.
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

// Returns the values of a key. `listed` counts the factorizations so far, because a short file
// could ask for more than fit the memory.
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

constexpr std::size_t most_drops = 1000;  // each is compared with every run

Settings read_settings(JsonReader& reader, const std::string& key) {
    Settings settings;
    if (!reader.has(key)) return settings;
    const nlohmann::json& found = reader.value(key);
    if (!found.is_object()) reader.reject(key, "an object {\"render.target\": \"fixed8\", ...}");
    for (const auto& [name, value] : found.items()) settings.emplace_back(name, value);
    return settings;
}

// Reads one entry of `scenes`: a path, or {"scene": path, "name": ..., "set": {...}}.
StudyFile::SceneEntry read_scene_entry(JsonReader& study, std::size_t number,
                                       const nlohmann::json& entry, const Settings& base) {
    const std::string at = fmt::format("scenes.{}", number);
    const nlohmann::json as_object = entry.is_string() ? nlohmann::json{{"scene", entry}} : entry;
    JsonReader reader(as_object, study.file(), at);
    StudyFile::SceneEntry scene;
    scene.file = reader.path_of("scene");
    scene.name = reader.has("name") ? reader.text("name") : scene.file.stem().string();
    scene.own = read_settings(reader, "set");
    reader.close();
    try {
        scene.document = load_json(scene.file);
        if (!scene.document.is_object())
            fail("{}: found no object, expected a scene {{...}}", scene.file.string());
        apply_settings(base, scene.document);
        apply_settings(scene.own, scene.document);
    } catch (const Error& error) {
        study.fail_at(at, error.what());
    }
    return scene;
}

bool is_data_folder_set() {
    const char* const folder = std::getenv("LAMINA_DATA");
    return folder != nullptr && *folder != '\0';
}

// Tells whether a string in the value has ${LAMINA_DATA}, the folder of the data sets.
bool names_data_folder(const nlohmann::json& value) {
    if (value.is_string())
        return value.get_ref<const std::string&>().find("${LAMINA_DATA}") != std::string::npos;
    return value.is_structured() && std::ranges::any_of(value, names_data_folder);
}

// Moves scenes that need ${LAMINA_DATA} to `skipped` if it is not set.
void skip_scenes_without_data(StudyFile& file) {
    if (is_data_folder_set()) return;
    for (const StudyFile::SceneEntry& scene : file.scenes) {
        if (!names_data_folder(scene.document)) continue;
        file.skipped.push_back(
            {scene.name,
             fmt::format(
                 "scene \"{}\" is skipped: set LAMINA_DATA to the folder with the data sets",
                 scene.name)});
    }
    std::erase_if(file.scenes, [](const StudyFile::SceneEntry& scene) {
        return names_data_folder(scene.document);
    });
}

void read_scenes(JsonReader& study, const Settings& base, StudyFile& file) {
    if (!study.has("scenes") || !study.value("scenes").is_array() || study.value("scenes").empty())
        study.reject("scenes", "a list of scene files");
    std::set<std::string> names;
    for (const nlohmann::json& entry : study.value("scenes")) {
        file.scenes.push_back(read_scene_entry(study, file.scenes.size(), entry, base));
        if (!names.insert(file.scenes.back().name).second) {
            study.fail_at("scenes", fmt::format("two scenes are called \"{}\", expected \"name\"s "
                                                "that differ",
                                                file.scenes.back().name));
        }
    }
    skip_scenes_without_data(file);
}

using Keys = std::set<std::string>;

Keys keys_to_match(const StudyFile& file) {
    Keys keys{"scene"};
    for (const SweepGrid& grid : file.sweep)
        for (const SweepAxis& axis : grid.axes) keys.insert(axis.key);
    return keys;
}

void check_swept(const Keys& swept, JsonReader& reader, const std::string& field,
                 const std::string& key) {
    if (swept.contains(key)) return;
    reader.fail_at(field,
                   fmt::format("\"{}\" is not swept, expected a key of \"sweep\"", shortened(key)));
}

void read_drops(JsonReader& study, const Keys& swept, StudyFile& file) {
    if (!study.has("drop")) return;
    std::vector<JsonReader> readers = study.objects("drop");
    if (readers.size() > most_drops) {
        study.fail_at(
            "drop", fmt::format("found {} rules, expected at most {}", readers.size(), most_drops));
    }
    for (JsonReader& reader : readers) {
        StudyFile::Drop drop;
        drop.because = reader.text("because");
        for (auto& [key, value] : read_settings(reader, "where")) {
            check_swept(swept, reader, "where", key);
            // A list means each of its elements, and also itself, because bifurcation factors are a
            // list.
            std::vector<nlohmann::json> values{value};
            if (value.is_array()) values.insert(values.end(), value.begin(), value.end());
            drop.where.push_back({key, std::move(values)});
        }
        if (drop.where.empty()) reader.reject("where", "an object with keys that are swept");
        reader.close();
        file.drops.push_back(std::move(drop));
    }
}

void read_baseline(JsonReader& study, const Keys& swept, StudyFile& file) {
    if (!study.has("baseline")) return;
    file.baseline = read_settings(study, "baseline");
    for (const auto& [key, value] : *file.baseline) check_swept(swept, study, "baseline", key);
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

void apply_settings(const Settings& settings, nlohmann::json& document) {
    for (const auto& [key, value] : settings) {
        try {
            set_key(document, key, json_text(value));
        } catch (const UsageError&) {
            fail(
                "{}: not a key of a scene: expected at most {} parts with single dots between, "
                "which lead through objects",
                shortened(key), most_json_depth);
        }
    }
}

StudyFile load_study(const std::filesystem::path& path) {
    const nlohmann::json document = load_json(path);
    StudyFile file;
    file.file = path;
    JsonReader study(document, file.file);
    study.whole("version", 1, 1);
    file.title = study.has("title") ? study.text("title") : path.stem().string();
    file.base = read_settings(study, "base");
    Settings base = file.base;
    if (const nlohmann::json* const context = find_setting(base, "context")) {
        file.context = setting_text(*context);
        std::erase_if(base, [](const auto& setting) { return setting.first == "context"; });
    }
    if (!study.has("sweep"))
        study.reject("sweep", "an object {\"render.slice.samples\": [256, 512]}");
    file.sweep = read_sweep(study);
    read_scenes(study, base, file);
    const Keys swept = keys_to_match(file);
    read_drops(study, swept, file);
    read_baseline(study, swept, file);
    if (study.has("reference")) {
        file.reference = study.choice<TraceOf>("reference", enum_words<TraceOf>());
    }
    if (study.has("rounds")) file.rounds = static_cast<int>(study.whole("rounds", 1, 1000));
    if (study.has("frames")) file.frames = static_cast<int>(study.whole("frames", 1, 1000));
    study.close();
    return file;
}

}  // namespace lamina::study
