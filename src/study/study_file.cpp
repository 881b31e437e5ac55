// SPDX-License-Identifier: Apache-2.0
#include "study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/text.h"
#include "scene_files/scene_reader.h"

namespace lamina::study {
namespace {

constexpr std::size_t most_drops = 1000;  // each is held against every run

Settings read_settings(JsonReader& reader, const std::string& key) {
    Settings settings;
    if (!reader.has(key)) return settings;
    const nlohmann::json& found = reader.value(key);
    if (!found.is_object()) reader.reject(key, "an object {\"render.target\": \"fixed8\", ...}");
    for (const auto& [name, value] : found.items()) settings.emplace_back(name, value);
    return settings;
}

// Reads a scene as the study uses it. `entry` is a path or
// {"scene": path, "name": ..., "set": {...}}.
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

// Tells whether a scene names a file of the data sets.
bool names_data_folder(const nlohmann::json& value) {
    if (value.is_string())
        return value.get_ref<const std::string&>().find("${LAMINA_DATA}") != std::string::npos;
    return value.is_structured() && std::ranges::any_of(value, names_data_folder);
}

// Moves the scenes that cannot be drawn without the data sets to those that are skipped.
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

// The keys that a study sweeps, for comparison with other keys.
class SweptKeys {
  public:
    explicit SweptKeys(const StudyFile& file) {
        for (const SweepGrid& grid : file.sweep)
            for (const SweepAxis& axis : grid.axes) keys_.insert(axis.key);
    }
    void check(JsonReader& reader, const std::string& field, const std::string& key) const {
        if (!keys_.contains(key)) {
            reader.fail_at(field, fmt::format("\"{}\" is not swept, expected a key of \"sweep\"",
                                              shortened(key)));
        }
    }

  private:
    std::set<std::string> keys_{"scene"};
};

void read_drops(JsonReader& study, const SweptKeys& swept, StudyFile& file) {
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
            swept.check(reader, "where", key);
            // A list stands for its elements and also for itself, because bifurcation factors are a
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

void read_baseline(JsonReader& study, const SweptKeys& swept, StudyFile& file) {
    if (!study.has("baseline")) return;
    file.baseline = read_settings(study, "baseline");
    for (const auto& [key, value] : *file.baseline) swept.check(study, "baseline", key);
}

}  // namespace

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
    const SweptKeys swept(file);
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
