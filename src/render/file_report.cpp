// SPDX-License-Identifier: Apache-2.0
#include "render/file_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "choice/field.h"
#include "image/png.h"
#include "lamina/scene.h"
#include "mesh/mesh_picture.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "mesh_files/mesh_file.h"
#include "volume/middle_slices.h"
#include "volume/min_max_bricks.h"
#include "volume/value_statistics.h"
#include "volume/volume_data.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr int narrowest_picture = 480;
constexpr int panel_side = 480;  // pixels

Json json_vector(const glm::dvec3& vector) {
    return Json::array({vector.x, vector.y, vector.z});
}

// Adds the keys "percentiles" {"0.1": value, ...} and "histogram" {edges, counts}; both are null if
// there is no finite value.
void add_statistics(const ValueStatistics& statistics, Json& info) {
    info["percentiles"] = nullptr;
    info["histogram"] = nullptr;
    if (statistics.percentiles.empty()) return;
    Json percentiles = Json::object();
    for (std::size_t i = 0; i < statistics.percentiles.size(); ++i) {
        const std::string name = fmt::format("{:g}", 0.1 * ValueStatistics::places[i]);
        percentiles[name] = statistics.percentiles[i];
    }
    info["percentiles"] = percentiles;
    info["histogram"] = {{"edges", statistics.histogram.edges},
                         {"counts", statistics.histogram.counts}};
}

// `mesh`: counts the faces at which scalars of points jump; null: scalars of cells.
Json describe(std::span<const MeshScalar> scalars, const TetMesh* mesh) {
    Json list = Json::array();
    for (const MeshScalar& scalar : scalars) {
        const auto [range, non_finite] = measure_range(scalar.values);
        Json entry{{"name", scalar.name}, {"range", nullptr}};  // null: no finite value
        if (!range.empty()) entry["range"] = Json::array({range.lo, range.hi});
        entry["nan_count"] = non_finite;
        if (mesh != nullptr) entry["jumps"] = count_jumps(*mesh, scalar.values);
        list.push_back(entry);
    }
    return list;
}

// `drawn`: the scalar that the statistics and the picture show, or null.
Json describe(const TetMesh& mesh, const MeshScalar* drawn, const ValueStatistics& statistics) {
    const MeshFindings& findings = mesh.findings();
    const double ratio = edge_lengths(mesh).ratio();
    Json info;
    info["kind"] = "mesh";
    info["points"] = mesh.points().size();
    info["places"] = std::ssize(mesh.points()) - findings.copies;
    info["tets"] = findings.tets_read;
    info["bounds"] = {{"min", json_vector(mesh.bounds().min)},
                      {"max", json_vector(mesh.bounds().max)}};
    info["scalars"] = describe(mesh.point_scalars(), &mesh);
    info["cell_scalars"] = describe(mesh.cell_scalars(), nullptr);
    info["drawn_scalar"] = nullptr;  // null: none, or a scene must choose an array of cell data
    if (drawn != nullptr) info["drawn_scalar"] = drawn->name;
    info["boundary_faces"] = findings.boundary_faces;
    info["conforming"] = findings.conforming();
    info["degenerate"] = findings.degenerate;
    info["inverted"] = findings.inverted;
    info["duplicates"] = findings.duplicates;
    info["nonmanifold_faces"] = findings.nonmanifold_faces;
    info["folded_faces"] = findings.folded_faces;
    info["unused_points"] = findings.unused_points;
    info["edge_ratio"] = nullptr;  // infinite: an edge without length
    if (std::isfinite(ratio)) info["edge_ratio"] = ratio;
    info["convex"] = convex(mesh);
    info["split_cells"] = findings.cells.split;
    info["skipped_cells"] = findings.cells.skipped;
    info["straightened_cells"] = findings.cells.straightened;
    info["turned_over_tets"] = findings.cells.turned_over;
    info["not_star_shaped_cells"] = findings.cells.not_star_shaped;
    info["made_points"] = findings.cells.made_points;
    info["ghost_cells"] = findings.cells.ghosts;
    info["merged_points"] = findings.cells.merged_points;
    add_statistics(statistics, info);
    return info;
}

// Returns `above` on white, and under it the picture below(width). `width` is that of `above`, but
// at least 480 pixels.
CodedImage above_one_another(const CodedImage& above, const std::function<CodedImage(int)>& below) {
    const int width = std::max(above.width, narrowest_picture);
    const CodedImage second = below(width);
    CodedImage image(width, above.height + second.height, 3, 8);
    fill_rectangle(image, 0, 0, image.width, image.height, {255, 255, 255});
    copy_into(image, above, 0, 0);
    copy_into(image, second, 0, above.height);
    return image;
}

// Returns the scalar that is drawn if a scene names none: the first at points, or the only array of
// cell data, averaged to points.
std::optional<MeshScalar> default_scalar(const MeshData& data) {
    if (!data.point_scalars.empty()) return data.point_scalars.front();
    if (const MeshScalar* const cells = only_array(data.cell_scalars))
        return average_to_points(data.points.size(), data.tets, *cells, data.cell_of_tet);
    return std::nullopt;
}

CodedImage picture_of(const TetMesh& mesh, std::span<const double> values,
                      const ValueStatistics& statistics) {
    const ValueRange range = values.empty() ? ValueRange{0, 0} : measure_range(values).range;
    return above_one_another(mesh_picture(mesh, values, range, panel_side),
                             [&](int width) { return histogram_picture(statistics, width); });
}

// Returns one word if all axes agree, else a list of a word for each axis.
Json json_of(const std::array<Centering, 3>& centering) {
    const auto word = [](Centering c) { return c == Centering::cell ? "cell" : "node"; };
    if (centering[0] == centering[1] && centering[1] == centering[2]) return word(centering[0]);
    return Json::array({word(centering[0]), word(centering[1]), word(centering[2])});
}

// Lists the labels of a volume by the file's numbers; empty if its samples are no labels.
Json labels_of(const VolumeData& data) {
    Json list = Json::array();
    const VolumeField field(data);
    if (field.labels() == nullptr) return list;
    const std::vector<Label>& described = field.labels()->list;
    const ValueDistribution values = field.distribution();
    auto label = described.begin();
    for (std::size_t i = 0; i < values.distinct(); ++i) {
        const double code = values.value(i);
        label = std::ranges::lower_bound(label, described.end(), code, {}, &Label::code);
        Json entry{{"number", static_cast<std::int64_t>(code)},
                   {"share", values.share(code, code)}};
        if (label != described.end() && label->code == code) {
            entry["number"] = parse_json(label->number);
            if (!label->name.empty()) entry["name"] = label->name;
            if (label->color) entry["color"] = json_vector(*label->color);
            if (label->opacity != 1) entry["opacity"] = label->opacity;
        }
        list.push_back(entry);
    }
    return list;
}

Json describe(const VolumeData& data, const VolumeContents& contents,
              const ValueStatistics& statistics) {
    const auto& [volume, bricks, values] = data;
    const Grid& grid = volume.grid();
    const Grid::Bounds bounds = grid.bounds();
    Json info;
    info["kind"] = "volume";
    info["size"] = grid.size;
    info["type"] = name_of(volume.type());
    info["centers"] = json_of(grid.centering);
    info["bounds"] = {{"min", json_vector(bounds.min)}, {"max", json_vector(bounds.max)}};
    info["range"] = nullptr;  // null: no finite value
    if (!bricks.whole.empty()) info["range"] = Json::array({bricks.whole.lo, bricks.whole.hi});
    info["nan_count"] = bricks.non_finite;
    info["spacing"] = json_vector(
        {glm::length(grid.step[0]), glm::length(grid.step[1]), glm::length(grid.step[2])});
    info["origin"] = json_vector(grid.origin);  // centre of the first sample
    info["unit"] = nullptr;                     // null: the file names none
    if (!grid.unit.empty()) info["unit"] = grid.unit;
    info["lookup"] = grid.lookup == VolumeLookup::nearest ? "nearest" : "linear";
    info["labels"] = labels_of(data);
    info["arrays"] = contents.arrays;
    info["channels"] = contents.channels;
    info["times"] = contents.times;
    info["levels"] = contents.levels;
    info["colour"] = contents.is_colour;
    add_statistics(statistics, info);
    return info;
}

CodedImage picture_of(const Volume& volume, const ValueRange& range,
                      const ValueStatistics& statistics) {
    return above_one_another(middle_slices(volume, range),
                             [&](int width) { return histogram_picture(statistics, width); });
}

Json report_on_mesh(const std::string& file, const std::string& png, std::int64_t time) {
    std::optional<AtomicFile> picture;  // opened first: an unwritable path fails at once
    if (!png.empty()) picture.emplace(png);
    MeshData data = read_mesh(file, time);
    const std::optional<MeshScalar> drawn = default_scalar(data);
    const std::span<const double> values = drawn ? drawn->values : std::span<const double>();
    const TetMesh mesh(std::move(data), file);
    const ValueStatistics statistics = measure_values(values);
    if (picture) {
        write_png(*picture, picture_of(mesh, values, statistics));
        picture->commit();
    }
    Json info = describe(mesh, drawn ? &*drawn : nullptr, statistics);
    info["times"] = Json::array();
    for (const double step_time : times_of_mesh(file))
        info["times"].push_back(fmt::format("{}", step_time));
    return info;
}

Json report_on_volume(const std::string& file, const std::string& png,
                      const VolumeRequest& request) {
    std::optional<AtomicFile> picture;  // opened first: an unwritable path fails at once
    if (!png.empty()) picture.emplace(png);
    VolumeContents contents;
    const VolumeData data(open_volume(
        file, request, {.residence = VolumeUse::Residence::as_fits, .contents = &contents}));
    const ValueStatistics statistics = measure_values(data);
    if (picture) {
        write_png(*picture, picture_of(data.volume, data.bricks.whole, statistics));
        picture->commit();
    }
    return describe(data, contents, statistics);
}

}  // namespace

bool is_volume_data(const std::string& file, const VolumeRequest& request) {
    const FileKind kind = request.raw ? FileKind::volume : kind_of_file(file);
    if (kind == FileKind::scene) {
        load_json(file);  // says what is wrong with a file that is missing, empty or no JSON
        fail("{}: holds a scene, expected a volume or a mesh", file);
    }
    return kind == FileKind::volume;
}

Json file_report(const std::string& file, const VolumeRequest& request, const std::string& png) {
    if (is_volume_data(file, request)) return report_on_volume(file, png, request);
    return report_on_mesh(file, png, request.time.value_or(0));
}

}  // namespace lamina
