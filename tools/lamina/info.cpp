// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/png.h"
#include "verbs.h"
#include "volume/middle_slices.h"
#include "volume/min_max_bricks.h"
#include "volume/nrrd.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file, png;
    bool json = false;
};

Json json_of(const glm::dvec3& vector) {
    return Json::array({vector.x, vector.y, vector.z});
}

// One word where all axes agree, else one word an axis.
Json json_of(const std::array<Centering, 3>& centering) {
    const auto word = [](Centering c) { return c == Centering::cell ? "cell" : "node"; };
    if (centering[0] == centering[1] && centering[1] == centering[2]) return word(centering[0]);
    return Json::array({word(centering[0]), word(centering[1]), word(centering[2])});
}

Json describe(const Volume& volume, const MinMaxBricks& bricks) {
    const Grid& grid = volume.grid();
    const Grid::Bounds bounds = grid.bounds();
    Json info;
    info["kind"] = "volume";
    info["size"] = grid.size;
    info["type"] = name_of(volume.type());
    info["centers"] = json_of(grid.centering);
    info["bounds"] = {{"min", json_of(bounds.min)}, {"max", json_of(bounds.max)}};
    info["range"] = nullptr;  // no finite value
    if (!bricks.whole.empty()) info["range"] = Json::array({bricks.whole.lo, bricks.whole.hi});
    info["nan_count"] = bricks.non_finite;
    return info;
}

std::string table_text(const Json& info) {
    std::string text;
    for (const auto& [key, value] : info.items()) {
        text += fmt::format("{:<10} {}\n", key,
                            value.is_string() ? value.get<std::string>() : value.dump());
    }
    return text;
}

void check_kind(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".nrrd" || extension == ".nhdr") return;
    fail("{}: unknown kind of file: expected a volume (.nrrd, .nhdr)", file);
}

void run(const InfoOptions& options) {
    if (!options.png.empty() && std::filesystem::path(options.png).extension() != ".png") {
        throw UsageError(fmt::format("--png {}: expected a name that ends in .png", options.png));
    }
    check_kind(options.file);
    std::unique_ptr<AtomicFile> png;
    if (!options.png.empty()) png = std::make_unique<AtomicFile>(options.png);
    const Volume volume = read_nrrd(options.file);
    const MinMaxBricks bricks = measure_bricks(volume);
    if (png) {
        write_png(*png, middle_slices(volume, bricks.whole));
        png->commit();
    }
    const Json info = describe(volume, bricks);
    fmt::print("{}", options.json ? info.dump(2) + "\n" : table_text(info));
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand("info", "What a file contains");
    const auto options = std::make_shared<InfoOptions>();
    verb->add_option("FILE", options->file, "volume (.nrrd, .nhdr)")->required();
    verb->add_flag("--json", options->json, "print JSON instead of a table");
    verb->add_option("--png", options->png, "write the three middle slices side by side (.png)");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
