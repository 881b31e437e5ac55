// SPDX-License-Identifier: Apache-2.0
#include "choice/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/text.h"
#include "choice/automatic_transfer.h"
#include "choice/value_distribution.h"
#include "image/srgb.h"

namespace lamina {
namespace {

// Opacity of the median ray among those that meet something visible.
constexpr double median_opacity = .9;
// Share of the largest extinction below which a part of the data does not count as visible when a
// camera is fitted.
constexpr double seen_share = 1e-3;

double largest_extinction(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    return transfer_function.max_extinction(knots.front().value, knots.back().value);
}

std::vector<glm::dvec3> points_to_fit(const TransferFunction& transfer_function,
                                      const Field& field) {
    std::vector<glm::dvec3> points =
        field.shown_points(transfer_function, seen_share * largest_extinction(transfer_function));
    if (!points.empty()) return points;
    const auto corners = field.corners();
    return {corners.begin(), corners.end()};
}

std::string vector_text(const glm::dvec3& v, double fineness) {
    return fmt::format("({}, {}, {})", number_text(v.x, fineness), number_text(v.y, fineness),
                       number_text(v.z, fineness));
}

std::string camera_text(const Camera& camera) {
    const double fineness = fineness_of(0, glm::distance(camera.eye, camera.center));
    return fmt::format("camera: from {} to {}, up {}, fov_y {:.4g}",
                       vector_text(camera.eye, fineness), vector_text(camera.center, fineness),
                       vector_text(camera.up, fineness_of(0, 1)), camera.fov_y);
}

// Returns the file's name, or the name of data that are in memory.
std::string name_of_data(const Scene& scene) {
    if (const VolumeFile* const volume = scene.volume_file()) return volume->path.string();
    const MeshFile* const mesh = scene.mesh_file();
    return mesh != nullptr ? mesh->path.string() : "data";
}

// Share of the deepest ray's optical depth; rays below it meet noise alone.
constexpr double least_depth = 0.002;

// Depths are measured in float32: in the data's own unit of length they neither vanish nor
// overflow.
TransferFunction per_diagonal(const TransferFunction& transfer_function, const Field& field) {
    const auto corners = field.corners();
    return transfer_function.attenuated(1 / glm::distance(corners.front(), corners.back()));
}

// Returns the factor on extinction that makes the median ray as opaque as wanted; 1 if no ray meets
// anything.
double density_of(const Scene& scene, const Field& field) {
    std::vector<double> depths = field.optical_depths(scene);
    if (depths.empty()) return 1;
    const double least = least_depth * *std::ranges::max_element(depths);
    std::erase_if(depths, [&](double depth) { return !(depth > least); });
    if (depths.empty()) return 1;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::ranges::nth_element(depths, middle);
    return -std::log1p(-median_opacity) / *middle;
}

// Returns the transfer function with its colours as display values.
TransferFunction displayed(const TransferFunction& transfer_function) {
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    for (TransferKnot& knot : knots) {
        for (int c = 0; c < 3; ++c) knot.optics.color[c] = srgb_from_linear(knot.optics.color[c]);
    }
    return TransferFunction::linear(knots);
}

// Gradients below this share of (range of values / spacing) count as noise.
constexpr double smallest_gradient_share = .01;

bool leaves_gradient_open(const Scene& scene) {
    return scene.lighting && scene.lighting->smallest_gradient.is_automatic();
}

// Returns the range of the measured values, without padding.
ValueRange range_without_padding(const Field& field) {
    const Padding padding =
        find_padding(field.distribution(), field.whole_numbers(), field.least_padding_share());
    if (padding.values.empty()) return field.range();
    return {padding.rest.lowest(), padding.rest.highest()};
}

void choose_smallest_gradient(Choices& choices, const Field& field) {
    Scene& scene = choices.scene;
    if (!leaves_gradient_open(scene)) return;
    const ValueRange range = range_without_padding(field);
    const double height = range.empty() ? 0 : range.hi - range.lo;
    // Data of a single value have no gradient, so any number will do.
    const double chosen = height > 0 ? smallest_gradient_share * height / field.spacing() : 1;
    scene.lighting->smallest_gradient =
        std::clamp(chosen, Lighting::least_gradient, Lighting::largest_gradient);
    choices.reasons.push_back(fmt::format("lighting: smallest gradient {:.4g} per unit of length",
                                          *scene.lighting->smallest_gradient));
}

void change_transfer_function(Scene& scene, const Wishes& wishes) {
    TransferFunction& changed = *scene.transfer_function;
    if (wishes.transfer.range) changed = stretched(changed, *wishes.transfer.range);
    if (wishes.transfer.colormap) changed = recolored(changed, *wishes.transfer.colormap);
}

}  // namespace

bool leaves_something_open(const Scene& scene) {
    return scene.transfer_function.is_automatic() || scene.camera.is_automatic() ||
           leaves_gradient_open(scene);
}

Choices choose(Scene asked, const Field& field, const Wishes& wishes) {
    Choices choices{std::move(asked), {}};
    Scene& scene = choices.scene;
    choose_smallest_gradient(choices, field);
    if (!leaves_something_open(scene) && !wishes.transfer_function() && !wishes.camera())
        return choices;
    if (field.range().empty()) {
        fail("{}: all values are NaN or infinite, expected numbers to choose what shows by",
             name_of_data(scene));
    }
    const bool chooses_function = scene.transfer_function.is_automatic();
    const bool chooses_camera = scene.camera.is_automatic();
    std::string reason;
    if (chooses_function) {
        AutomaticTransfer chosen =
            choose_transfer_function(field.distribution(), field.whole_numbers(), wishes.transfer,
                                     field.least_padding_share());
        scene.transfer_function = std::move(chosen.transfer_function);
        if (scene.color_space == ImageColorSpace::display && !wishes.transfer.colormap)
            scene.transfer_function = displayed(*scene.transfer_function);
        reason = std::move(chosen.reason);
        if (!chosen.padding.empty())
            warn(fmt::format("{}: {}", name_of_data(scene), chosen.padding));
    } else {
        change_transfer_function(scene, wishes);
    }
    if (chooses_camera) {
        scene.camera = fitted_camera(points_to_fit(*scene.transfer_function, field), field.axes(),
                                     wishes.turn, scene.width, scene.height, wishes.all_around);
    } else {
        scene.camera = turned(*scene.camera, wishes.turn);
    }
    if (chooses_function) {
        scene.transfer_function = per_diagonal(*scene.transfer_function, field);
        const double density = density_of(scene, field);
        scene.transfer_function = scene.transfer_function->attenuated(density);
        choices.reasons.push_back(
            fmt::format("transfer function: {}; extinction up to {:.4g} per unit of length", reason,
                        wishes.density * largest_extinction(*scene.transfer_function)));
    }
    // Removes points that rounding has put on straight lines, as reading from a file does.
    const TransferFunction dense = scene.transfer_function->attenuated(wishes.density);
    scene.transfer_function =
        TransferFunction::linear({dense.knots().begin(), dense.knots().end()});
    scene.camera = zoomed(*scene.camera, wishes.zoom);
    if (chooses_camera) choices.reasons.push_back(camera_text(*scene.camera));
    return choices;
}

std::string chosen_text(const std::vector<std::string>& reasons) {
    std::string text;
    for (const std::string& line : reasons) text += "  " + line + "\n";
    return text.empty() ? text : "chosen\n" + text;
}

}  // namespace lamina
