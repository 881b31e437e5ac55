// SPDX-License-Identifier: Apache-2.0
#include "file_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "choice/field.h"
#include "image/png.h"
#include "mesh/mesh_picture.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "mesh_files/mesh_file.h"
#include "volume/middle_slices.h"
#include "volume/min_max_bricks.h"
#include "volume/volume_data.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_rows = 16;
constexpr int bar_letters = 40, narrowest_picture = 480;
constexpr std::size_t narrowest_end = 8;

std::string row_end(const std::vector<double>& edges, std::size_t number) {
    return number_text(edges[number], fineness_of(edges.front(), edges.back()), 5);
}

constexpr int panel_side = 480;  // pixels

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

// Returns the entry of a list as people read it: "1", "1 DAPI", "2 512x512x64".
std::string entry_text(std::size_t number, const Json& entry) {
    if (entry.is_array())
        return fmt::format("{} {}x{}x{}", number, entry[0].dump(), entry[1].dump(),
                           entry[2].dump());
    const auto name = printable(entry.get<std::string>());
    return name.empty() ? std::to_string(number) : fmt::format("{} {}", number, name);
}

CodedImage picture_of(const Volume& volume, const ValueRange& range,
                      const ValueStatistics& statistics) {
    return above_one_another(middle_slices(volume, range),
                             [&](int width) { return histogram_picture(statistics, width); });
}

}  // namespace

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

CodedImage above_one_another(const CodedImage& above, const std::function<CodedImage(int)>& below) {
    const int width = std::max(above.width, narrowest_picture);
    const CodedImage second = below(width);
    CodedImage image(width, above.height + second.height, 3, 8);
    fill_rectangle(image, 0, 0, image.width, image.height, {255, 255, 255});
    copy_into(image, above, 0, 0);
    copy_into(image, second, 0, above.height);
    return image;
}

nlohmann::ordered_json report_on_mesh(const std::string& file, const std::string& png,
                                      std::int64_t time) {
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

nlohmann::ordered_json report_on_volume(const std::string& file, const std::string& png,
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

}  // namespace lamina
