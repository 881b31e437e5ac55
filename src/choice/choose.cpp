// SPDX-License-Identifier: Apache-2.0
#include "choice/choose.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <optional>

#include "base/client.h"
#include "base/error.h"
#include "choice/automatic_light.h"
#include "choice/value_distribution.h"
#include "choice/words.h"
#include "image/coded_image.h"
#include "scene/camera.h"

namespace lamina {
namespace {

constexpr double seen_share = 1e-3;  // of the largest extinction; fitted cameras ignore less
constexpr double seen_depth = .01;   // over the diagonal of the data, likewise

double largest_extinction(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    return transfer_function.max_extinction(knots.front().value, knots.back().value);
}

// Returns the points that the picture holds: of what shows and the clip keeps, or of the data's box
// if it is drawn. `per_world_unit`: extinctions are absolute.
std::vector<glm::dvec3> points_to_fit(const Scene& scene, const Field& field, bool per_world_unit) {
    const TransferFunction& function = *scene.transfer_function;
    double least = seen_share * largest_extinction(function);
    if (per_world_unit) least = std::min(least, seen_depth / diagonal_of(field));
    std::vector<glm::dvec3> points;
    if (!scene.annotations.box) points = field.shown_points(function, least, scene.clip);
    if (!points.empty()) return points;
    const auto corners = field.corners();
    return {corners.begin(), corners.end()};
}

std::string vector_text(const glm::dvec3& v, double fineness) {
    return fmt::format("({}, {}, {})", number_text(v.x, fineness), number_text(v.y, fineness),
                       number_text(v.z, fineness));
}

std::string camera_text(const Camera& camera, const std::string& orientation) {
    const double fineness = fineness_of(0, glm::distance(camera.eye, camera.center));
    return fmt::format("camera: from {} to {}, up {}, fov_y {:.4g}; {}",
                       vector_text(camera.eye, fineness), vector_text(camera.center, fineness),
                       vector_text(camera.up, fineness_of(0, 1)), camera.fov_y, orientation);
}

// Returns the name of the data for messages: of their file, or "data" if they are in memory.
std::string name_of_data(const Scene& scene) {
    if (const VolumeFile* const volume = scene.volume_file()) return volume->path.string();
    const MeshFile* const mesh = scene.mesh_file();
    return mesh != nullptr ? mesh->path.string() : "data";
}

// Rays with less than this share of the largest optical depth of all rays are ignored as noise.
constexpr double least_depth = 0.002;
constexpr int square_side = 512;  // pixels of the picture in which depths are measured

// Divides extinctions by the diagonal of the data's box, so that float32 depths stay in range.
TransferFunction per_diagonal(const TransferFunction& transfer_function, const Field& field) {
    return transfer_function.attenuated(1 / diagonal_of(field));
}

// Returns the orientation of the data. One slice is seen straight unless a side is asked for.
Orientation orientation_in(const Field& field, const std::optional<UpAxis>& up = {},
                           const std::optional<ViewSide>& side = {}) {
    const std::optional<SliceAxes> slice = side ? std::nullopt : field.slice();
    const auto straight =
        slice ? orientation_of_slice(*slice, field.axes(), up) : std::optional<Orientation>();
    return straight ? *straight
                    : orientation_of(field.axes(), field.corners(), up, field.axial_slices());
}

// Returns the median optical depth of rays through what shows, as seen all over in a square picture
// of these points: so it does not depend on the picture that is drawn. 0 if no ray meets anything.
double median_depth(Scene scene, const TransferFunction& transfer_function,
                    std::span<const glm::dvec3> points, const Field& field) {
    scene.transfer_function = transfer_function;
    scene.width = scene.height = square_side;
    const Orientation from = orientation_in(field);
    scene.camera =
        fitted_camera(points, from.front, turn_to(ViewSide::iso, from), square_side, square_side);
    std::vector<double> depths = field.optical_depths(scene);
    if (depths.empty()) return 0;
    const double least = least_depth * *std::ranges::max_element(depths);
    std::erase_if(depths, [&](double depth) { return !(depth > least); });
    if (depths.empty()) return 0;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::ranges::nth_element(depths, middle);
    return *middle;
}

// Scales relative extinctions for this opacity of the median ray; not at all if no ray meets
// anything.
void take_density(const Field& field, double median_opacity, Scene& scene) {
    scene.transfer_function = per_diagonal(*scene.transfer_function, field);
    Scene bare = scene;  // annotations change no density
    bare.annotations = {};
    const double depth =
        median_depth(bare, *bare.transfer_function, points_to_fit(bare, field, false), field);
    if (depth > 0)
        scene.transfer_function =
            scene.transfer_function->attenuated(-std::log1p(-median_opacity) / depth);
}

// Returns the world length of the median ray through the data.
double median_path(const Scene& scene, const Field& field) {
    const auto corners = field.corners();
    const double diagonal = diagonal_of(field);
    const auto even = TransferFunction::linear({{field.range().lo, {glm::dvec3(0), 1 / diagonal}}});
    return diagonal * median_depth(scene, even, corners, field);
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

// Warns of labels among the values that have the background's colour by the file's own words.
void warn_of_background(const VolumeLabels& labels, const ValueDistribution& values,
                        const Scene& scene) {
    constexpr double same = 1. / 512;  // half a step of 8 bits
    const bool display = scene.color_space == ImageColorSpace::display;
    std::string numbers;
    int count = 0;
    for (const Label& label : labels.list) {
        if (!label.color || label.opacity == 0 || label.number == "0") continue;
        if (!(values.share(label.code, label.code) > 0)) continue;
        double largest = 0;
        for (int c = 0; c < 3; ++c) {
            const double linear = (*label.color)[c];
            const double shown = display ? srgb_from_linear(linear) : linear;
            largest = std::max(largest, std::abs(shown - scene.background[c]));
        }
        if (largest > same) continue;
        if (++count <= 8) numbers += (count == 1 ? "" : ", ") + label.number;
    }
    if (count == 0) return;
    say("{}: the file gives the background's colour to {} of its labels ({}{}), which "
        "hide others but cannot be seen",
        name_of_data(scene), count, numbers, count > 8 ? ", ..." : "");
}

AutomaticTransfer chosen_function(const Scene& scene, const TransferSubject& subject,
                                  const ValueDistribution& values,
                                  const TransferAdjustments& adjustments) {
    const Field& field = *subject.field;
    AutomaticTransfer chosen =
        choose_transfer_function(values, field.whole_numbers(), adjustments,
                                 field.least_padding_share(), field.labels(), subject);
    if (scene.color_space == ImageColorSpace::display && !adjustments.colormap)
        chosen.transfer_function = displayed(chosen.transfer_function);
    if (field.labels() != nullptr && !adjustments.colormap)
        warn_of_background(*field.labels(), values, scene);
    if (!chosen.padding.empty()) say("{}: {}", name_of_data(scene), chosen.padding);
    return chosen;
}

void change(TransferFunction& function, const TransferAdjustments& adjustments,
            const Scene& scene) {
    if (adjustments.range && function.of_codes()) {
        fail(
            "{}: found a range of values and a transfer function of labels that are numbered anew: "
            "expected one of both",
            name_of_data(scene));
    }
    if (adjustments.range) function = stretched(function, *adjustments.range);
    if (adjustments.colormap) function = recolored(function, *adjustments.colormap);
}

// Gradients below this share of (range of values / spacing) count as noise.
constexpr double smallest_gradient_share = .01;

bool leaves_light_open(const Scene& scene) {
    return scene.lighting && scene.lighting->is_automatic();
}

bool leaves_gradient_open(const Scene& scene) {
    const Lighting* const given = given_lighting(scene.lighting);
    return given != nullptr && given->smallest_gradient.is_automatic();
}

// Returns the length of gradients below which they count as noise. `bordered`: the field's range is
// also that of a border that is left out.
double smallest_gradient_of(const Padding& padding, const Field& field, bool bordered) {
    // The ends of the range may lie between the places that a distribution counts.
    const ValueRange range = (padding.values.empty() && !bordered) || padding.rest.empty()
                                 ? field.range()
                                 : ValueRange{padding.rest.lowest(), padding.rest.highest()};
    const double height = range.empty() ? 0 : range.hi - range.lo;
    // Data of a single value have no gradient, so the number does not matter.
    const double chosen = height > 0 ? smallest_gradient_share * height / field.spacing() : 1;
    return std::clamp(chosen, Lighting::least_gradient, Lighting::largest_gradient);
}

// Chooses whether the scene is lit, and the smallest gradient that is, if they are open.
void choose_lighting(Choices& choices, const TransferSubject& subject,
                     const ValueDistribution& values, bool bordered) {
    const Field& field = *subject.field;
    Scene& scene = choices.scene;
    const bool open = leaves_light_open(scene);
    if (!open && !leaves_gradient_open(scene)) return;
    const Padding padding =
        find_padding(values, field.whole_numbers(), field.least_padding_share());
    const double smallest = smallest_gradient_of(padding, field, bordered);
    if (open) {
        const LightChoice light = choose_light(scene, subject, padding, smallest);
        choices.reasons.push_back("lighting: " + light.reason);
        scene.lighting.reset();
        if (!light.lit) return;
        scene.lighting = Lighting{};
    }
    (*scene.lighting)->smallest_gradient = smallest;
    choices.reasons.push_back(
        fmt::format("lighting: smallest gradient {:.4g} per unit of length", smallest));
}

// Constants of the automatic camera (docs/first-picture.md). Angles are in degrees.
constexpr double degree = std::numbers::pi / 180;
constexpr double fov_y = 30;
constexpr double margin = 1.0 / 25;  // margin of the picture as a share of its half

// Returns a camera's `up`: the one that it had, unless the view is along it or beyond a pole.
glm::dvec3 upright(const glm::dvec3& up, const Axes& axes) {
    return glm::dot(up, axes.up) > least_across * glm::length(up) ? up : axes.up;
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
           leaves_gradient_open(scene) || leaves_light_open(scene);
}

namespace {

// Replaces the extinctions by those of the wanted curve. Returns what was done, for people.
std::string take_opacity(const Adjustments& adjustments, TransferFunction& transfer_function) {
    const OpacityCurve& curve = *adjustments.opacity;
    if (curve.form == OpacityCurve::Form::of_colormap) {
        Colormap colormap = *adjustments.transfer.colormap;
        const auto& range = adjustments.transfer.range;
        if (range) stretch(colormap, range->lo, range->hi);
        transfer_function = with_opacity_of(transfer_function, colormap);
        return fmt::format("the preset {}", adjustments.opacity_word);
    }
    const ValueRange shown = adjustments.transfer.range.value_or(shown_range(transfer_function));
    const ValueRange range = curve.range.value_or(shown);
    transfer_function = with_opacity(transfer_function, curve, range);
    return fmt::format("opacity {} from {:.6g} to {:.6g}", shortened(adjustments.opacity_word),
                       range.lo, range.hi);
}

std::string clip_text(const Clip& clip) {
    const std::size_t planes = clip.planes.size();
    if (planes == 0) return "clip: a box, as asked";
    return fmt::format("clip: {} plane{}{}, as asked", planes, planes == 1 ? "" : "s",
                       clip.box ? " and a box" : "");
}

// Sets the directions of the wanted lights, for which the camera must be known, and says which
// lights were asked for.
void add_lights(const Adjustments& adjustments, Choices& choices) {
    Scene& scene = choices.scene;
    if (adjustments.light && given_lighting(scene.lighting) != nullptr) {
        (*scene.lighting)->lights = lights_of(*adjustments.light, *scene.camera);
        choices.reasons.push_back(
            fmt::format("lighting: {}, as asked", name_of(*adjustments.light)));
    }
}

// Chooses the camera of a scene whose transfer function is known. Returns why it is upright so, for
// people.
std::string choose_camera(const Adjustments& adjustments, const Field& field, bool per_world_unit,
                          Scene& scene) {
    const Orientation from = orientation_in(field, adjustments.up, adjustments.side);
    ViewTurn turn = turn_to(adjustments.side.value_or(ViewSide::iso), from);
    turn.azimuth += adjustments.turn.azimuth;
    turn.elevation += adjustments.turn.elevation;
    const PictureMargins margins =
        annotation_margins(scene, annotated_data(field, scene.annotations, scene.clip));
    scene.camera = fitted_camera(points_to_fit(scene, field, per_world_unit), from.front, turn,
                                 scene.width, scene.height, adjustments.all_around, margins);
    if (!adjustments.side) return from.reason;
    return fmt::format("{}; view: {}", from.reason, name_of(*adjustments.side));
}

// Keeps those planes of a border's clip behind which something would show: the border itself, or
// values between it and what is inside, as a skin. `own`: the clip without them.
void clip_border(const BorderlessField& inner, const Clip& own, Choices& choices) {
    Scene& scene = choices.scene;
    scene.clip = own;
    std::string values;
    std::int64_t widest = 0;
    std::vector<double> said;
    for (const BorderSide& side : inner.sides) {
        const auto [lo, hi] = std::minmax(side.value, side.behind);
        if (scene.transfer_function->transparent(lo, hi)) continue;
        scene.clip.planes.push_back(side.inside);
        widest = std::max(widest, side.width);
        if (std::ranges::find(said, side.value) != said.end()) continue;
        said.push_back(side.value);
        values += fmt::format("{}{:.9g}", values.empty() ? "" : " and ", side.value);
    }
    if (said.empty()) return;
    choices.reasons.push_back(
        fmt::format("clip: a border of {}, up to {} sample{} wide, is cut away (--crop :,:,: keeps "
                    "it)",
                    values, widest, widest == 1 ? "" : "s"));
}

// Tells whether a point lies at the plane that would cut a side of a border away, or farther in.
bool is_inside(const glm::dvec3& point, const BorderSide& side) {
    constexpr double rounding = 1e-9;  // of places, which may be written with few digits
    const glm::dvec3 slack = rounding * glm::abs(point);
    const glm::dvec3& normal = side.inside.normal;
    return glm::dot(point + glm::sign(normal) * slack - side.inside.point, normal) >= 0;
}

// Tells whether a clip cuts a side of a border away, by its box or by a plane along the side.
bool is_cut_away(const BorderSide& side, const Clip& clip) {
    constexpr double parallel = 1 - 1e-12;  // cosine
    const glm::dvec3& normal = side.inside.normal;
    if (clip.box) {
        const auto upper = glm::lessThan(normal, glm::dvec3(0));
        if (is_inside(glm::mix(clip.box->min, clip.box->max, upper), side)) return true;
    }
    return std::ranges::any_of(clip.planes, [&](const ClipPlane& plane) {
        return glm::dot(glm::normalize(plane.normal), normal) > parallel &&
               is_inside(plane.point, side);
    });
}

// Adds a reason that names what is left of a border because the scene or --crop says what is kept.
void say_kept_border(const BorderlessField& inner, Choices& choices) {
    const Scene& scene = choices.scene;
    for (const BorderSide& side : inner.sides) {
        const auto [lo, hi] = std::minmax(side.value, side.behind);
        if (is_cut_away(side, scene.clip) || scene.transfer_function->transparent(lo, hi)) continue;
        choices.reasons.push_back(fmt::format(
            "clip: a border of {:.9g}, up to {} sample{} wide, is kept, because the crop leaves it",
            side.value, side.width, side.width == 1 ? "" : "s"));
        return;
    }
}

// Chooses all but the directions of lights that were asked for.
Choices choose_unlit(Scene asked, const Field& whole, const Adjustments& adjustments) {
    Choices choices{std::move(asked), {}};
    Scene& scene = choices.scene;
    std::optional<BorderlessField> inner;
    // A box says itself what it keeps. If this has a part of the border, the border counts.
    const bool has_box = scene.clip.box || adjustments.own_crop;
    // A picture of one slice keeps its border.
    if (scene.transfer_function.is_automatic() && !whole.slice() &&
        scene.clip.planes.size() + 6 <= Clip::most_planes)
        inner = whole.without_border();
    std::optional<BorderlessField> kept;  // a border that counts
    if (inner && has_box && !std::ranges::all_of(inner->sides, [&](const BorderSide& side) {
            return is_cut_away(side, scene.clip);
        }))
        kept.swap(inner);
    const Field& field = inner ? *inner->field : whole;
    const Clip own = scene.clip;
    if (inner && !has_box)
        for (const BorderSide& side : inner->sides) scene.clip.planes.push_back(side.inside);
    const bool lights = leaves_light_open(scene);
    const ValueDistribution values =
        scene.transfer_function.is_automatic() || lights || leaves_gradient_open(scene)
            ? field.distribution()
            : ValueDistribution();
    std::optional<double> path;
    const TransferSubject subject{&field, [&] {
                                      if (!path) path = median_path(scene, field);
                                      return *path;
                                  }};
    if (!lights) choose_lighting(choices, subject, values, inner.has_value());
    if (!leaves_something_open(scene) && !adjustments.transfer_function() && !adjustments.camera())
        return choices;
    if (field.range().empty()) {
        fail("{}: all values are NaN or infinite, expected numbers to choose what shows by",
             name_of_data(scene));
    }
    if (!adjustments.map_in_hu.empty()) {
        if (const auto mistake = mistake_in_hounsfield_units(
                field.range(), *adjustments.transfer.colormap, adjustments.map_in_hu))
            fail("{}: {}", name_of_data(scene), *mistake);
    }
    const bool chooses_function = scene.transfer_function.is_automatic();
    const bool chooses_camera = scene.camera.is_automatic() || adjustments.up || adjustments.side;
    AutomaticTransfer chosen;
    if (chooses_function) {
        chosen = chosen_function(scene, subject, values, adjustments.transfer);
        scene.transfer_function = chosen.transfer_function;
    } else {
        change(*scene.transfer_function, adjustments.transfer, scene);
    }
    if (adjustments.opacity) {
        chosen.reason = take_opacity(adjustments, *scene.transfer_function);
        chosen.per_world_unit = false;
        chosen.median_opacity = AutomaticTransfer().median_opacity;
    }
    if (inner && !has_box) clip_border(*inner, own, choices);
    if (kept) say_kept_border(*kept, choices);
    std::string orientation;
    if (chooses_camera)
        orientation = choose_camera(adjustments, field, chosen.per_world_unit, scene);
    else
        scene.camera = turned(*scene.camera, adjustments.turn);
    if (chooses_function || adjustments.opacity) {
        if (!chosen.per_world_unit) take_density(field, chosen.median_opacity, scene);
        choices.reasons.push_back(fmt::format(
            "transfer function: {}; extinction up to {:.4g} per unit of length", chosen.reason,
            adjustments.density * largest_extinction(*scene.transfer_function)));
    }
    // linear() drops points on straight lines, so the function equals one read from a scene file.
    const TransferFunction dense = scene.transfer_function->attenuated(adjustments.density);
    scene.transfer_function =
        TransferFunction::linear({dense.knots().begin(), dense.knots().end()});
    scene.camera = zoomed(*scene.camera, adjustments.zoom);
    if (chooses_camera) choices.reasons.push_back(camera_text(*scene.camera, orientation));
    if (lights) choose_lighting(choices, subject, values, inner.has_value());
    return choices;
}

}  // namespace

Choices choose(Scene asked, const Field& field, const Adjustments& adjustments) {
    const Clip own = asked.clip;  // without the planes that are chosen
    Choices choices = choose_unlit(std::move(asked), field, adjustments);
    add_lights(adjustments, choices);
    if (!adjustments.clip.keeps_all()) choices.reasons.push_back(clip_text(own));
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
Camera fitted_camera(std::span<const glm::dvec3> points, const Axes& front, const ViewTurn& turn,
                     int width, int height, bool all_around, PictureMargins margins) {
    // The camera's axis of turning stays in the middle of the picture.
    if (all_around) {
        margins.left = margins.right = std::min(std::max(margins.left, margins.right), 0.3 * width);
    }
    const Axes to = turned(front, turn);
    Camera camera;
    camera.fov_y = fov_y;
    camera.up = upright(front.up, to);
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
    result.up = upright(camera.up, around);
    return result;
}

Camera zoomed(Camera camera, double factor) {
    camera.height /= factor;
    const double half = std::atan(std::tan(camera.fov_y / 2 * degree) / factor);
    if (factor != 1) camera.fov_y = 2 * half / degree;
    return camera;
}

}  // namespace lamina
