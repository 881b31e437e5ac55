// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <optional>

#include "base/output_file.h"
#include "file_report.h"
#include "image/png.h"
#include "json_vector.h"
#include "statistics_report.h"
#include "volume/middle_slices.h"
#include "volume/min_max_bricks.h"
#include "volume/value_statistics.h"
#include "volume/volume_data.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

// Returns one word if all axes agree, else one word an axis.
Json json_of(const std::array<Centering, 3>& centering) {
    const auto word = [](Centering c) { return c == Centering::cell ? "cell" : "node"; };
    if (centering[0] == centering[1] && centering[1] == centering[2]) return word(centering[0]);
    return Json::array({word(centering[0]), word(centering[1]), word(centering[2])});
}

Json describe(const Volume& volume, const MinMaxBricks& bricks, const ValueStatistics& statistics) {
    const Grid& grid = volume.grid();
    const Grid::Bounds bounds = grid.bounds();
    Json info;
    info["kind"] = "volume";
    info["size"] = grid.size;
    info["type"] = name_of(volume.type());
    info["centers"] = json_of(grid.centering);
    info["bounds"] = {{"min", json_vector(bounds.min)}, {"max", json_vector(bounds.max)}};
    info["range"] = nullptr;  // no finite value
    if (!bricks.whole.empty()) info["range"] = Json::array({bricks.whole.lo, bricks.whole.hi});
    info["nan_count"] = bricks.non_finite;
    info["spacing"] = json_vector(
        {glm::length(grid.step[0]), glm::length(grid.step[1]), glm::length(grid.step[2])});
    info["origin"] = json_vector(grid.origin);  // the centre of the first sample
    add_statistics(statistics, info);
    return info;
}

CodedImage picture_of(const Volume& volume, const ValueRange& range,
                      const ValueStatistics& statistics) {
    return above_one_another(middle_slices(volume, range),
                             [&](int width) { return histogram_picture(statistics, width); });
}

}  // namespace

nlohmann::ordered_json report_on_volume(const std::string& file, const std::string& png,
                                        const VolumeRequest& request) {
    std::optional<AtomicFile> picture;  // first: a path that cannot be written fails at once
    if (!png.empty()) picture.emplace(png);
    const VolumeData data(open_volume(file, request, {.residence = VolumeUse::Residence::as_fits}));
    const auto& [volume, bricks, values] = data;
    const ValueStatistics statistics = measure_values(data);
    if (picture) {
        write_png(*picture, picture_of(volume, bricks.whole, statistics));
        picture->commit();
    }
    return describe(volume, bricks, statistics);
}

}  // namespace lamina
