// SPDX-License-Identifier: Apache-2.0
#include "data_series.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/mesh_file.h"
#include "output_files.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

constexpr std::int64_t largest_number = 1'000'000'000, most_steps = 100'000;

// Returns up to four whole numbers >= 0 that colons separate; empty if the text is anything else.
std::vector<std::int64_t> numbers_of(const std::string& text) {
    std::vector<std::int64_t> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (numbers.size() < 4) {
        std::int64_t number = 0;
        const auto [stop, problem] = std::from_chars(at, end, number);
        if (problem != std::errc{} || number < 0 || number > largest_number) return {};
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != ':') return {};
        at = stop + 1;
    }
    return {};
}

using Path = std::filesystem::path;

std::string name_at(const FilePattern& pattern, std::int64_t step) {
    return names_of(pattern, step, step, 1).value().front();
}

// Returns the path in "volume": PATH or "volume": {"path": PATH} of a scene's document, or null.
std::string* path_in(nlohmann::json& document, const char* key) {
    const auto found = document.is_object() ? document.find(key) : document.end();
    if (found == document.end()) return nullptr;
    nlohmann::json* value = &*found;
    if (value->is_object()) {
        const auto path = value->find("path");
        if (path == value->end()) return nullptr;
        value = &*path;
    }
    return value->is_string() ? value->get_ptr<std::string*>() : nullptr;
}

}  // namespace

std::vector<std::int64_t> TimeRange::steps() const {
    std::vector<std::int64_t> all;
    for (std::int64_t at = first; at <= last; at += step) all.push_back(at);
    return all;
}

TimeRange time_range(const std::string& text) {
    const std::vector<std::int64_t> numbers = numbers_of(text);
    TimeRange range;
    const bool good = numbers.size() == 2 || numbers.size() == 3;
    if (good) range = {numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 1};
    if (!good || range.last < range.first || range.step < 1) {
        throw UsageError(fmt::format(
            "--time {}: expected FIRST:LAST or FIRST:LAST:STEP, whole numbers as in 0:99:3{}",
            shortened(text),
            numbers.size() == 1
                ? fmt::format("; --set volume.time={} (of a mesh mesh.time) draws one step",
                              numbers[0])
                : ""));
    }
    if ((range.last - range.first) / range.step >= most_steps) {
        throw UsageError(fmt::format("--time {}: found {} steps, expected at most {}", text,
                                     (range.last - range.first) / range.step + 1, most_steps));
    }
    return range;
}

// Returns the pattern in the file's name, and replaces it in `path` by the first step's name;
// nothing if there is no '%'. In a folder's name '%' has no meaning.
std::optional<FilePattern> DataSeries::take(std::string& path, const std::string& what) const {
    const std::size_t name = path.rfind('/') + 1;  // 0 if there is no folder
    if (path.find('%', name) == std::string::npos) return {};
    const auto pattern = file_pattern(path.substr(name));
    if (!pattern) {
        throw UsageError(fmt::format(
            "--time: {}: found {}, expected one number, as in head_%04d.nrrd", what, path));
    }
    path = path.substr(0, name) + name_at(*pattern, steps_.front());
    return pattern;
}

DataSeries::DataSeries(std::string file, const TimeRange& range)
    : steps_(range.steps()), first_file_(std::move(file)) {
    if (first_file_ == standard_stream) return;
    file_ = take(first_file_, "SCENE");
    if (file_ && Path(first_file_).extension() == ".json") {
        throw UsageError(fmt::format(
            "--time: {}: found a scene, expected a data file, or a scene whose volume or mesh has "
            "the number in its path",
            first_file_));
    }
}

void DataSeries::begin(nlohmann::json& document) {
    for (const auto& [key, pattern] : {std::pair{"volume", &volume_}, std::pair{"mesh", &mesh_}}) {
        std::string* const path = path_in(document, key);
        if (path == nullptr) continue;
        *pattern = file_ ? file_ : take(*path, key);
    }
    if (volume_ || mesh_) return;
    for (const char* const key : {"mesh", "volume"}) {  // as in at()
        const std::string* const path = path_in(document, key);
        if (path == nullptr) continue;
        nlohmann::json& data = document[key];
        if (data.is_string()) data = {{"path", *path}};
        data["time"] = steps_.front();
        return;
    }
}

Scene DataSeries::at(Scene scene, std::int64_t step) const {
    VolumeFile* const volume = scene.volume_file();
    MeshFile* const mesh = scene.mesh_file();
    if (volume_) volume->path.replace_filename(name_at(*volume_, step));
    if (mesh_) mesh->path.replace_filename(name_at(*mesh_, step));
    if (volume_ || mesh_) return scene;
    if (mesh != nullptr) {
        mesh->time = step;
    } else if (volume != nullptr) {
        volume->selection.time = step;
    }
    return scene;
}

std::vector<Path> DataSeries::files_of_step(const Scene& scene, std::int64_t step) const {
    const Scene there = at(scene, step);
    std::vector<Path> files;
    if (volume_) files = files_of_volume(there.volume_file()->path, there.volume_file()->selection);
    if (mesh_) {
        for (const Path& file : files_of_mesh(there.mesh_file()->path)) files.push_back(file);
    }
    return files;
}

void DataSeries::check(const Scene& scene) const {
    const auto check_file = [this](const Path& file, std::int64_t step) {
        expect_allowed(file);
        if (std::filesystem::exists(file)) return;
        fail("{}: step {} of --time is not there, expected steps {} to {}", file.string(), step,
             steps_.front(), steps_.back());
    };
    for (const std::int64_t step : steps_) {
        const Scene there = at(scene, step);
        if (volume_) check_file(there.volume_file()->path, step);
        if (mesh_) check_file(there.mesh_file()->path, step);
    }
    if (volume_ || mesh_) return;
    const MeshFile* const mesh = scene.mesh_file();
    if (mesh == nullptr) {
        if (scene.volume_file() == nullptr)
            throw UsageError("--time: the scene's volume is generated, expected files");
        // The number of steps is known only once the file is read.
        load_volume(at(scene, steps_.back()));
        return;
    }
    const std::int64_t there = steps_of_mesh(mesh->path);
    if (steps_.back() >= there) {
        fail("{}: --time: found step {}, expected 0 to {}: the file has {}", mesh->path.string(),
             steps_.back(), there - 1, there);
    }
}

}  // namespace lamina
