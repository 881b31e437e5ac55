// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/json_text.h"
#include "base/process.h"
#include "file_report.h"
#include "mesh_files/mesh_file.h"
#include "output_files.h"
#include "shared_options.h"
#include "verbs.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file, png;
    RawOptions raw;
    bool json = false;
};

std::string text_of(const std::string& key, const Json& value) {
    if (value.is_string()) return printable(value.get<std::string>());
    if (key == "percentiles" && !value.is_null()) return percentiles_text(value);
    return printable(json_text(value));
}

std::string table_text(const Json& info) {
    std::string text;
    for (const auto& [key, value] : info.items()) {
        if (key == "histogram" && !value.is_null())
            text += fmt::format("{:<17} {}", key, histogram_text(value));
        else
            text += fmt::format("{:<17} {}\n", key, text_of(key, value));
    }
    return text;
}

void run(const InfoOptions& options) {
    if (!options.png.empty() && std::filesystem::path(options.png).extension() != ".png") {
        throw UsageError(fmt::format("--png {}: expected a name that ends in .png", options.png));
    }
    const VolumeRequest request = request_of(options.raw);
    const bool volume = request.raw || is_volume_file(options.file);
    if (!volume && !is_mesh_file(options.file)) {
        fail(
            "{}: unknown kind of file: expected a volume ({}) or a mesh (.vtu, .pvtu, .pvd, .vtk, "
            ".node, .ele)",
            options.file, volume_format_names());
    }
    expect_different_files(
        volume ? files_of_volume(options.file, request) : files_of_mesh(options.file),
        {options.png});
    const Json info = volume ? report_on_volume(options.file, options.png, request)
                             : report_on_mesh(options.file, options.png);
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
    verb->add_flag("--json", options->json, "Print JSON instead of a table");
    verb->add_option(
            "--png", options->png,
            "Write a picture (.png): a volume's three middle slices, a mesh's boundary and "
            "three cuts; and the histogram below")
        ->type_name("FILE");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
