// SPDX-License-Identifier: Apache-2.0
#include "choice/choose.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/client.h"
#include "base/error.h"
#include "choice/value_distribution.h"
#include "image/coded_image.h"

namespace lamina {
namespace {

constexpr double median_opacity = .9;  // median of the rays that meet something visible
constexpr double seen_share = 1e-3;    // of the largest extinction; fitted cameras ignore less

double largest_extinction(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    return transfer_function.max_extinction(knots.front().value, knots.back().value);
}

// Returns the points that the picture holds: of what shows, or of the data's box if it is drawn.
std::vector<glm::dvec3> points_to_fit(const Scene& scene, const Field& field) {
    const TransferFunction& function = *scene.transfer_function;
    std::vector<glm::dvec3> points;
    if (!scene.annotations.box)
        points = field.shown_points(function, seen_share * largest_extinction(function));
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

// Returns the name of the data for messages: of their file, or "data" if they are in memory.
std::string name_of_data(const Scene& scene) {
    if (const VolumeFile* const volume = scene.volume_file()) return volume->path.string();
    const MeshFile* const mesh = scene.mesh_file();
    return mesh != nullptr ? mesh->path.string() : "data";
}

// Rays with less than this share of the largest optical depth of all rays are ignored as noise.
constexpr double least_depth = 0.002;

// Divides extinctions by the diagonal of the data's box, so that float32 depths stay in range.
TransferFunction per_diagonal(const TransferFunction& transfer_function, const Field& field) {
    const auto corners = field.corners();
    return transfer_function.attenuated(1 / glm::distance(corners.front(), corners.back()));
}

// Returns the factor on extinction that gives median_opacity; 1 if no ray meets anything.
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
    // Data of a single value have no gradient, so the number does not matter.
    const double chosen = height > 0 ? smallest_gradient_share * height / field.spacing() : 1;
    scene.lighting->smallest_gradient =
        std::clamp(chosen, Lighting::least_gradient, Lighting::largest_gradient);
    choices.reasons.push_back(fmt::format("lighting: smallest gradient {:.4g} per unit of length",
                                          *scene.lighting->smallest_gradient));
}

// Constants of the automatic camera (docs/first-picture.md). Angles are in degrees.
constexpr double degree = std::numbers::pi / 180;
constexpr double three_quarter_azimuth = 30, three_quarter_elevation = 20;
constexpr double fov_y = 30;
constexpr double margin = 1.0 / 25;  // margin of the picture as a share of its half
// Least cosine between the data's up and the camera's; below it, the view is along the data's up.
constexpr double least_across = 0.02;

// A camera's own axes: right-handed and orthonormal.
struct Axes {
    glm::dvec3 right, up, toward;  // from the scene to the eye
};

// Returns the axes of a camera that looks at the data from in front. If the file names a patient's
// axes, the camera stands in front of the patient: its right is the patient's left.
Axes axes_of(WorldAxes axes) {
    switch (axes) {
        case WorldAxes::left_posterior_superior:
            return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
        case WorldAxes::right_anterior_superior:
            return {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::left_anterior_superior:  // a left-handed world
            return {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::unnamed:
            return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    }
    return {};
}

// Returns the axes of a camera moved right by the azimuth, then up by the elevation.
Axes turned(const Axes& axes, const ViewTurn& turn) {
    const double a = turn.azimuth * degree, e = turn.elevation * degree;
    const glm::dvec3 right = std::cos(a) * axes.right - std::sin(a) * axes.toward;
    const glm::dvec3 around = std::sin(a) * axes.right + std::cos(a) * axes.toward;
    return {right, std::cos(e) * axes.up - std::sin(e) * around,
            std::sin(e) * axes.up + std::cos(e) * around};
}

struct Extent {
    double lo = INFINITY, hi = -INFINITY;
    void add(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    double middle() const { return lo + (hi - lo) / 2; }
};

// Measures how far points extend in a direction or, if the camera turns all around, how far the
// circles extend that the points describe about `axis`.
struct Reach {
    glm::dvec3 axis;
    bool all_around;

    void add(const glm::dvec3& point, const glm::dvec3& along, Extent& extent) const {
        if (!all_around) return extent.add(glm::dot(point, along));
        const double upward = glm::dot(along, axis), height = glm::dot(point, axis);
        const double swing =
            glm::length(along - upward * axis) * glm::length(point - height * axis);
        extent.add(upward * height - swing);
        extent.add(upward * height + swing);
    }
};

glm::dvec3 middle_of(std::span<const glm::dvec3> points) {
    Extent box[3];
    for (const glm::dvec3& point : points) {
        for (int axis = 0; axis < 3; ++axis) box[axis].add(point[axis]);
    }
    return {box[0].middle(), box[1].middle(), box[2].middle()};
}

}  // namespace

bool leaves_something_open(const Scene& scene) {
    return scene.transfer_function.is_automatic() || scene.camera.is_automatic() ||
           leaves_gradient_open(scene);
}

Choices choose(Scene asked, const Field& field, const Adjustments& adjustments) {
    Choices choices{std::move(asked), {}};
    Scene& scene = choices.scene;
    choose_smallest_gradient(choices, field);
    if (!leaves_something_open(scene) && !adjustments.transfer_function() && !adjustments.camera())
        return choices;
    if (field.range().empty()) {
        fail("{}: all values are NaN or infinite, expected numbers to choose what shows by",
             name_of_data(scene));
    }
    const bool chooses_function = scene.transfer_function.is_automatic();
    const bool chooses_camera = scene.camera.is_automatic();
    std::string reason;
    if (chooses_function) {
        AutomaticTransfer chosen = choose_transfer_function(
            field.distribution(), field.whole_numbers(), adjustments.transfer,
            field.least_padding_share(), field.labels());
        scene.transfer_function = std::move(chosen.transfer_function);
        if (scene.color_space == ImageColorSpace::display && !adjustments.transfer.colormap)
            scene.transfer_function = displayed(*scene.transfer_function);
        reason = std::move(chosen.reason);
        if (!chosen.padding.empty())
            warn(fmt::format("{}: {}", name_of_data(scene), chosen.padding));
    } else {
        TransferFunction& changed = *scene.transfer_function;
        if (adjustments.transfer.range) changed = stretched(changed, *adjustments.transfer.range);
        if (adjustments.transfer.colormap)
            changed = recolored(changed, *adjustments.transfer.colormap);
    }
    if (chooses_camera) {
        const PictureMargins margins =
            annotation_margins(scene, annotated_data(field, scene.annotations.labels.has_value()));
        scene.camera = fitted_camera(points_to_fit(scene, field), field.axes(), adjustments.turn,
                                     scene.width, scene.height, adjustments.all_around, margins);
    } else {
        scene.camera = turned(*scene.camera, adjustments.turn);
    }
    if (chooses_function) {
        scene.transfer_function = per_diagonal(*scene.transfer_function, field);
        const double density = density_of(scene, field);
        scene.transfer_function = scene.transfer_function->attenuated(density);
        choices.reasons.push_back(
            fmt::format("transfer function: {}; extinction up to {:.4g} per unit of length", reason,
                        adjustments.density * largest_extinction(*scene.transfer_function)));
    }
    // linear() drops points on straight lines, so the function equals one read from a scene file.
    const TransferFunction dense = scene.transfer_function->attenuated(adjustments.density);
    scene.transfer_function =
        TransferFunction::linear({dense.knots().begin(), dense.knots().end()});
    scene.camera = zoomed(*scene.camera, adjustments.zoom);
    if (chooses_camera) choices.reasons.push_back(camera_text(*scene.camera));
    return choices;
}

std::string chosen_text(const std::vector<std::string>& reasons) {
    std::string text;
    for (const std::string& line : reasons) text += "  " + line + "\n";
    return text.empty() ? text : "chosen\n" + text;
}

// Coordinates are right, up and depth along the view. An eye (R, U, D), with edges of slope s, sees
// a point (r, u, d) if |r - R| <= s (d - D). So R lies between max(r - s d) + s D and min(r + s d)
// - s D; at the largest possible D, the nearest eye, both are equal. Likewise for u and U. With
// margins, the free part of the picture has its middle on another ray of slope m than the view's
// axis: then this holds for r - m d and R - m D.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around, PictureMargins margins) {
    // The camera's axis of turning stays in the middle of the picture.
    if (all_around) {
        margins.left = margins.right = std::min(std::max(margins.left, margins.right), 0.3 * width);
    }
    const Axes to = turned(axes_of(axes), {three_quarter_azimuth + turn.azimuth,
                                           three_quarter_elevation + turn.elevation});
    Camera camera;
    camera.fov_y = fov_y;
    // The camera's up is the data's, unless that is along the view, so turntables stand upright.
    const glm::dvec3 up = axes_of(axes).up;
    camera.up = glm::dot(up, to.up) > least_across ? up : to.up;
    const double slope_of_edge = std::tan(fov_y / 2 * degree);
    const double free_up = 1 - (margins.top + margins.bottom) / height;
    const double free_right = 1 - (margins.left + margins.right) / width;
    const double slope_up = slope_of_edge * (1 - margin) * free_up;
    const double slope_right = slope_of_edge * (1 - margin) * width / height * free_right;
    const double middle_up = slope_of_edge * (margins.bottom - margins.top) / height;
    const double middle_right = slope_of_edge * (margins.left - margins.right) / height;
    const glm::dvec3 right = to.right + middle_right * to.toward;
    const glm::dvec3 upward = to.up + middle_up * to.toward;
    // Points are taken relative to their middle, so that a distant origin costs no precision.
    const glm::dvec3 middle = middle_of(points);
    const Reach reach{camera.up, all_around};
    Extent right_near, right_far, up_near, up_far, toward;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 arm = point - middle;
        reach.add(arm, right + slope_right * to.toward, right_near);
        reach.add(arm, right - slope_right * to.toward, right_far);
        reach.add(arm, upward + slope_up * to.toward, up_near);
        reach.add(arm, upward - slope_up * to.toward, up_far);
        reach.add(arm, to.toward, toward);
    }
    const double eye_depth = std::min((right_far.lo - right_near.hi) / (2 * slope_right),
                                      (up_far.lo - up_near.hi) / (2 * slope_up));
    const double eye_right = (right_far.lo + right_near.hi) / 2 + middle_right * eye_depth;
    const double eye_up = (up_far.lo + up_near.hi) / 2 + middle_up * eye_depth;
    const glm::dvec3 across = eye_right * to.right + eye_up * to.up;
    camera.eye = middle + across - eye_depth * to.toward;
    // The centre lies on the view's axis: at the middle of the visible points or, if the camera
    // turns all around, where the axis passes the centre of the points' circles.
    const glm::dvec3 level = to.toward - glm::dot(to.toward, camera.up) * camera.up;
    const double along =
        all_around ? -glm::dot(across, level) / glm::dot(to.toward, level) : toward.middle();
    camera.center = middle + across + along * to.toward;
    return camera;
}

Camera turned(const Camera& camera, const ViewTurn& turn) {
    if (turn.azimuth == 0 && turn.elevation == 0) return camera;
    const glm::dvec3 arm = camera.eye - camera.center;
    const double distance = glm::length(arm);
    const glm::dvec3 toward = arm / distance;
    const glm::dvec3 right = glm::normalize(glm::cross(camera.up, toward));
    // camera.up need not be at a right angle to the view; the turn uses an up that is.
    const Axes around = turned(Axes{right, glm::cross(toward, right), toward}, turn);
    Camera result = camera;
    result.eye = camera.center + distance * around.toward;
    result.up = around.up;
    return result;
}

Camera zoomed(Camera camera, double factor) {
    camera.height /= factor;
    const double half = std::atan(std::tan(camera.fov_y / 2 * degree) / factor);
    if (factor != 1) camera.fov_y = 2 * half / degree;
    return camera;
}

}  // namespace lamina
