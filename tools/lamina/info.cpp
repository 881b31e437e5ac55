// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json_text.h"
#include "base/process.h"
#include "mesh_files/mesh_file.h"
#include "output_files.h"
#include "render/file_report.h"
#include "shared_options.h"
#include "verbs.h"
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

constexpr std::size_t most_rows = 16, narrowest_end = 8;
constexpr int bar_letters = 40;

std::string row_end(const std::vector<double>& edges, std::size_t number) {
    return number_text(edges[number], fineness_of(edges.front(), edges.back()), 5);
}

// Return the values of keys that are not null as text.
std::string percentiles_text(const Json& percentiles) {
    const double fineness =
        fineness_of(percentiles.front().get<double>(), percentiles.back().get<double>());
    std::string text;
    for (const auto& [name, value] : percentiles.items()) {
        text += fmt::format("{}{} %: {}", text.empty() ? "" : ", ", name,
                            number_text(value.get<double>(), fineness, 6));
    }
    return text;
}

// Lists at most 16 labels with their names and shares.
std::string labels_text(const Json& labels) {
    constexpr std::size_t most_entries = 16;
    std::string text;
    for (std::size_t i = 0; i < std::min(labels.size(), most_entries); ++i) {
        const std::string name = printable(labels[i].value("name", std::string()));
        text += fmt::format("{}{}{}{} ({:.3g} %)", i == 0 ? "" : ", ", labels[i]["number"].dump(),
                            name.empty() ? "" : " ", name, 100 * labels[i]["share"].get<double>());
    }
    return labels.size() > most_entries ? fmt::format("{}, ... {} in all", text, labels.size())
                                        : text;
}

// Has at most 16 rows.
std::string histogram_text(const Json& histogram) {
    const auto edges = histogram["edges"].get<std::vector<double>>();
    const auto counts = histogram["counts"].get<std::vector<std::int64_t>>();
    // Each row has `together` intervals, the last one maybe fewer.
    const std::size_t together = (counts.size() + most_rows - 1) / most_rows;
    std::vector<std::int64_t> sums;
    std::vector<std::string> ends{row_end(edges, 0)};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (i % together == 0) sums.push_back(0);
        sums.back() += counts[i];
        if ((i + 1) % together == 0 || i + 1 == counts.size())
            ends.push_back(row_end(edges, i + 1));
    }
    const auto most = static_cast<double>(*std::max_element(sums.begin(), sums.end()));
    const auto all = static_cast<double>(std::accumulate(sums.begin(), sums.end(), std::int64_t{}));
    std::size_t width = narrowest_end;
    for (const std::string& end : ends) width = std::max(width, end.size());
    std::string text = "(# is the logarithm of the count)\n";
    for (std::size_t row = 0; row < sums.size(); ++row) {
        const auto sum = static_cast<double>(sums[row]);
        const auto letters =
            static_cast<std::size_t>(std::lround(bar_letters * std::log1p(sum) / std::log1p(most)));
        text += fmt::format("  {:>{}} .. {:<{}} {:>7.3f} % {}\n", ends[row], width, ends[row + 1],
                            width, 100 * sum / all, std::string(letters, '#'));
    }
    return text;
}

// Returns the entry of a list as people read it: "1", "1 DAPI", "2 512x512x64".
std::string entry_text(std::size_t number, const Json& entry) {
    if (entry.is_array())
        return fmt::format("{} {}x{}x{}", number, entry[0].dump(), entry[1].dump(),
                           entry[2].dump());
    const auto name = printable(entry.get<std::string>());
    return name.empty() ? std::to_string(number) : fmt::format("{} {}", number, name);
}

// Returns the row of a table for the lists "arrays", "channels", "times" and "levels" of a report:
// what there is to choose from, and how. Empty if there is nothing to choose.
std::string choice_text(const std::string& key, const Json& list, const std::string& kind) {
    constexpr std::size_t most_entries = 16;
    if (list.size() < 2) return {};
    std::string text;
    for (std::size_t i = 0; i < std::min(list.size(), most_entries); ++i) {
        text += i == 0 ? "" : ", ";
        if (key != "arrays")
            text += entry_text(i, list[i]);
        else
            text += list[i] == "" ? "\"\"" : printable(list[i].get<std::string>());
    }
    if (list.size() > most_entries) text += fmt::format(", ... {} in all", list.size());
    return fmt::format("{} (choose by --set {}.{}={})", text, kind, key.substr(0, key.size() - 1),
                       key == "arrays" ? "NAME" : "NUMBER");
}

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

// Returns the part of a file that --set and --raw choose. Throws UsageError if --set has other
// keys.
VolumeRequest choice_of(const InfoOptions& options, const VolumeRequest& raw) {
    if (options.settings.empty()) return raw;
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
    if (const VolumeFile* const volume = scene.volume_file()) return volume->selection;
    VolumeRequest step;
    if (scene.mesh_file() != nullptr) step.time = scene.mesh_file()->time;
    return step;
}

void run(const InfoOptions& options) {
    if (!options.png.empty() && std::filesystem::path(options.png).extension() != ".png") {
        throw UsageError(fmt::format("--png {}: expected a name that ends in .png", options.png));
    }
    const VolumeRequest raw = request_of(options.raw);
    const bool is_volume = is_volume_data(options.file, raw);
    const VolumeRequest request = choice_of(options, raw);
    expect_different_files(
        is_volume ? files_of_volume(options.file, request) : files_of_mesh(options.file),
        {options.png});
    const Json info = file_report(options.file, request, options.png);
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
