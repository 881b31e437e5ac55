// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/json_text.h"
#include "base/process.h"
#include "file_report.h"
#include "mesh_files/mesh_file.h"
#include "output_files.h"
#include "shared_options.h"
#include "verbs.h"
#include "volume_files/folder_contents.h"
#include "volume_files/foreign_files.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file, png;
    std::vector<std::string> settings;  // --set KEY=VALUE
    RawOptions raw;
    bool json = false;
};

std::string text_of(const std::string& key, const Json& value) {
    if (value.is_string()) return printable(value.get<std::string>());
    if (key == "percentiles" && !value.is_null()) return percentiles_text(value);
    return printable(json_text(value));
}

// The keys that list what a file has of which one part is shown.
bool is_choice(const std::string& key) {
    return key == "arrays" || key == "channels" || key == "times" || key == "levels";
}

std::string table_text(const Json& info) {
    std::string text;
    for (const auto& [key, value] : info.items()) {
        if (key == "colour") {
            const bool is_clear = info["channels"].size() > 3;
            if (value.get<bool>())
                text += fmt::format("colour            yes: its channels are red, green, blue{}\n",
                                    is_clear ? " and opacity" : "");
        } else if (is_choice(key)) {
            const std::string row = choice_text(key, value, info["kind"]);
            if (!row.empty()) text += fmt::format("{:<17} {}\n", key, row);
        } else if (key == "labels") {
            if (!value.empty()) text += fmt::format("labels            {}\n", labels_text(value));
        } else if (key == "histogram" && !value.is_null())
            text += fmt::format("{:<17} {}", key, histogram_text(value));
        else
            text += fmt::format("{:<17} {}\n", key, text_of(key, value));
    }
    return text;
}

// The part of a file that --set and --raw choose.
struct Choice {
    VolumeRequest of_volume;
    std::int64_t time_of_mesh = 0;
};

// Throws UsageError if --set has other keys than those that choose a part of the file.
Choice choice_of(const InfoOptions& options, const VolumeRequest& raw) {
    if (options.settings.empty()) return {raw};
    for (const std::string& setting : options.settings) {
        const std::string key = setting.substr(0, setting.find('='));
        if (key == "volume.path" || !(key.starts_with("volume.") || key == "mesh.time")) {
            throw UsageError(
                fmt::format("--set {}: expected a key that chooses a part of the file: "
                            "volume.array, .level, .channel or .time, or mesh.time",
                            shortened(setting)));
        }
    }
    nlohmann::json document;
    const Scene scene = load_scene({options.file, options.settings, {}, options.raw}, {}, document);
    if (const auto* const volume = std::get_if<VolumeFile>(&scene.volume))
        return {volume->selection};
    return {{}, scene.mesh_file() == nullptr ? 0 : scene.mesh_file()->time};
}

void run(const InfoOptions& options) {
    if (!options.png.empty() && std::filesystem::path(options.png).extension() != ".png") {
        throw UsageError(fmt::format("--png {}: expected a name that ends in .png", options.png));
    }
    const VolumeRequest request = request_of(options.raw);
    if (!request.raw) expect_no_foreign_mesh(options.file);
    const bool volume = request.raw || is_volume_file(options.file);
    if (!volume && !is_mesh_file(options.file)) {
        expect_no_folder(options.file);
        expect_no_foreign_file(options.file);
        std::error_code unknown;
        if (!std::filesystem::exists(options.file, unknown)) fail("{}: no such file", options.file);
        fail(
            "{}: unknown kind of file: expected a volume ({}) or a mesh (.vtu, .pvtu, .pvd, .vtk, "
            ".node, .ele)",
            options.file, volume_format_names());
    }
    const Choice choice = choice_of(options, request);
    expect_different_files(
        volume ? files_of_volume(options.file, choice.of_volume) : files_of_mesh(options.file),
        {options.png});
    const Json info = volume ? report_on_volume(options.file, options.png, choice.of_volume)
                             : report_on_mesh(options.file, options.png, choice.time_of_mesh);
    write_result(options.json ? json_text(info, 2) + "\n" : table_text(info));
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand("info", "What a file contains");
    const auto options = std::make_shared<InfoOptions>();
    verb->add_option("FILE", options->file,
                     "Volume (as for render) or mesh (.vtu, .pvtu, .pvd, .vtk, .node, .ele)")
        ->required();
    add_memory_option(*verb);
    add_only_below_option(*verb);
    add_raw_options(*verb, options->raw);
    verb->add_option("--set", options->settings,
                     "Choose a part of the file, as in volume.channel=1")
        ->option_text("KEY=VALUE")
        ->allow_extra_args(false);
    verb->add_flag("--json", options->json, "Print JSON instead of a table");
    verb->add_option(
            "--png", options->png,
            "Write a picture (.png): a volume's three middle slices, a mesh's boundary and "
            "three cuts; and the histogram below")
        ->type_name("FILE");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
