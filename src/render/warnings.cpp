// SPDX-License-Identifier: Apache-2.0
#include "render/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.h"
#include "choice/opacity_presets.h"
#include "mesh/tet_mesh.h"
#include "optics/colormap.h"
#include "scene/camera.h"
#include "scene/given_transfer.h"

namespace lamina {
namespace {

void add_cells(const CellCounts& cells, Warnings& to) {
    if (cells.merged_points > 0) {
        to.push_back(fmt::format("{} points that pieces of the mesh share are one each",
                                 cells.merged_points));
    }
    if (cells.skipped > 0)
        to.push_back(fmt::format("{} cells have no volume and are not drawn", cells.skipped));
    if (cells.straightened > 0) {
        to.push_back(
            fmt::format("{} quadratic or higher cells are drawn as straight pieces between their "
                        "points",
                        cells.straightened));
    }
    if (cells.turned_over > 0) {
        to.push_back(fmt::format(
            "{} tets of quadratic or higher cells are turned over by curved edges, and overlap "
            "others",
            cells.turned_over));
    }
    if (cells.not_star_shaped > 0) {
        to.push_back(fmt::format(
            "{} polyhedra are not star-shaped from the mean of their points, or not closed: their "
            "tets overlap or leave gaps",
            cells.not_star_shaped));
    }
    if (cells.split > 0) {
        to.push_back(fmt::format(
            "{} hexahedra or other cells are cut into tets, in which the field is linear, not "
            "trilinear: between points it differs from a volume's, most around single peaks "
            "(docs/meshes.md)",
            cells.split));
    }
}

void add_made(const Scene& scene, const MeshReport& report, Warnings& to) {
    const MeshSettings wanted = mesh_settings(scene);
    if (report.within_tolerance || wanted.kuhn) return;
    to.push_back(fmt::format(
        "the mesh stopped {} with {} tets: it differs from the volume by up to {:.3g} of the "
        "range of values, wanted {:.3g}",
        report.stopped_by_max_tets ? "at max_tets" : "where points would lie too close",
        report.tets, report.relative_error(), wanted.tolerance));
}

void add_clamped_colors(const Scene& scene, Warnings& to) {
    const std::int64_t count = clamped_colors(scene);
    if (count == 0) return;
    to.push_back(
        fmt::format("{} transfer-function points have a colour above 1, which the target {} clamps",
                    count, name_of(scene.target)));
}

std::string why_not_kept(const SlicePlan& plan, double wanted, double error) {
    if (plan.integrates_cells()) {
        return fmt::format(
            "exact segments in {} are off by up to {:.2g} / 255{}", name_of(plan.target), error,
            plan.segment_error > exact_segment_error ? ", in proportion to the brightest colour"
                                                     : "");
    }
    if (plan.table.error > wanted) {
        return fmt::format(
            "the pre-integration table is off by up to {:.2g} / 255 "
            "(render.slice.classification \"post\" does without)",
            plan.table.error);
    }
    if (plan.slab_trial) {
        return fmt::format(
            "of the numbers of slabs that were tried, {} are taken, with an error of {:.2g} / 255 "
            "(render.slice.samples sets another)",
            plan.slabs, error);
    }
    return fmt::format("{} slabs composited in {} are off by up to {:.2g} / 255", plan.slabs,
                       name_of(plan.target), error);
}

// Opacities below half a code of 8 bits are invisible.
constexpr float least_opacity = .5F / 255;
// A picture whose pixels are all below this shows almost nothing: eyes see a contrast of 1 in 100
// at best, and on white .01 is one code of a PNG.
constexpr float faint = .01F;
// A pixel at least this bright is stored as code 255 of a PNG: 254.5 / 255 as a display value, or
// in linear light the sRGB decoding of that value, .9956.
constexpr float full_display = 254.5F / 255, full_light = .9956F;

std::string name_of_scene(const Scene& scene) {
    return scene.file.empty() ? "picture" : scene.file.string();
}

std::string range_text(const ValueRange& range) {
    const double fineness = fineness_of(range.lo, range.hi);
    return number_text(range.lo, fineness, 6) + " to " + number_text(range.hi, fineness, 6);
}

// Returns where in the world a box lies, as text: "x from 0 to 1, y from ...".
std::string places_text(const std::array<glm::dvec3, 8>& corners) {
    glm::dvec3 lo = corners[0], hi = corners[0];
    for (const glm::dvec3& corner : corners) {
        lo = glm::min(lo, corner);
        hi = glm::max(hi, corner);
    }
    const auto along = [&](int axis) { return range_text({lo[axis], hi[axis]}); };
    return fmt::format("x from {}, y from {} and z from {}", along(0), along(1), along(2));
}

// Returns the values that the transfer function shows, as text. Beyond its first and last point it
// is constant.
std::string shown_values(const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    std::size_t first = 0, last = knots.size();
    while (first < last && knots[first].optics.extinction == 0) ++first;
    while (last > first && knots[last - 1].optics.extinction == 0) --last;
    if (first == last) return "no values at all";
    const ValueRange shown{knots[first > 0 ? first - 1 : 0].value,
                           knots[std::min(last, knots.size() - 1)].value};
    const double fineness = fineness_of(shown.lo, shown.hi);
    const std::string from = number_text(shown.lo, fineness, 6);
    const std::string to = number_text(shown.hi, fineness, 6);
    if (first == 0) return last == knots.size() ? "all values" : "values up to " + to;
    return last == knots.size() ? "values above " + from : "values from " + from + " to " + to;
}

// Returns the side of the picture beyond which all corners lie, or null.
const char* side_beside(const View& view, const std::array<glm::dvec3, 8>& corners) {
    const double half_width = .5 * view.width * view.pixel;
    const double half_height = .5 * view.height * view.pixel;
    int left = 0, right = 0, above = 0, below = 0;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 arm = corner - view.eye;
        const double depth =
            view.projection == Projection::perspective ? glm::dot(arm, view.forward) : 1;
        const double x = glm::dot(arm, view.right), y = glm::dot(arm, view.up);
        left += x < -half_width * depth;
        right += x > half_width * depth;
        below += y < -half_height * depth;
        above += y > half_height * depth;
    }
    const std::pair<int, const char*> sides[] = {
        {left, "left of"}, {right, "right of"}, {above, "above"}, {below, "below"}};
    for (const auto& [count, side] : sides) {
        if (count == 8) return side;
    }
    return nullptr;
}

// Returns why a picture is faint, and what to do unless the clip may be the cause. `largest`: its
// largest opacity, above 0.
std::string why_faint(const Scene& scene, const ValueRange& range, float largest) {
    if (!scene.clip.keeps_all())
        return fmt::format("the largest opacity in what the clip keeps is {:.2g}", largest);
    constexpr double visible = .9;  // opacity
    const double factor = std::log1p(-visible) / std::log1p(-double{largest});
    return fmt::format(
        "the largest opacity is {:.2g}, for the extinction of at most {:.3g} per unit of length is "
        "small for these data; {:.3g} times as much (--density; in Python density) gives {}",
        largest, scene.transfer_function->max_extinction(range.lo, range.hi), factor, visible);
}

std::string why_nothing_shows(const Scene& scene, const Field& field, float largest) {
    const ValueRange range = field.range();
    if (scene.transfer_function->transparent(range.lo, range.hi)) {
        return fmt::format("the transfer function shows {}, and the data have {}",
                           shown_values(*scene.transfer_function), range_text(range));
    }
    const View view(*scene.camera, scene.width, scene.height);
    const auto corners = field.corners();
    const bool behind = std::ranges::all_of(corners, [&](const glm::dvec3& corner) {
        return glm::dot(corner - view.eye, view.forward) <= 0;
    });
    if (behind) return "the camera looks away from the data, which lie behind the eye";
    if (const char* const side = side_beside(view, corners))
        return fmt::format("the camera looks past the data, which lie {} the picture", side);
    if (field.cut_away_by(scene.clip))
        return "the clip cuts all of the data away, which lie in " + places_text(corners);
    if (largest > 0) return why_faint(scene, range, largest);
    return scene.clip.keeps_all()
               ? "no pixel's ray meets a value that the transfer function shows"
               : "no pixel's ray meets a value that the transfer function shows in what "
                 "the clip keeps";
}

// Warns if the data lie beyond all values between which colours change, so that all get one colour.
void warn_of_colors(const Scene& scene, const ValueRange& range) {
    const auto knots = scene.transfer_function->knots();
    std::size_t first = 0, last = knots.size() - 1;
    const auto change = [&](std::size_t i) {
        return knots[i].optics.color != knots[i + 1].optics.color;
    };
    while (first < last && !change(first)) ++first;
    while (last > first && !change(last - 1)) --last;
    const ValueRange colors{knots[first].value, knots[last].value};
    if (first == last || range.lo == range.hi || (colors.hi > range.lo && colors.lo < range.hi))
        return;
    say("{}: the transfer function's colours change from {}, and the data have {}: "
        "they all get one colour",
        name_of_scene(scene), range_text(colors), range_text(range));
}

// Tells whether a transfer function has the colours of another one, to a 1000th of a code.
bool has_colors_of(const TransferFunction& function, const TransferFunction& other) {
    constexpr double same = 1e-3 / 255;
    return std::ranges::all_of(other.knots(), [&](const TransferKnot& knot) {
        const glm::dvec3 apart =
            glm::abs(function.at(knot.value).color - other.at(knot.value).color);
        return glm::all(glm::lessThan(apart, glm::dvec3(same)));
    });
}

// Warns if the scene's colour map is one in HU, unless a range or a word changed that, and the data
// cannot be in them.
void warn_of_units(const Scene& scene, const ValueRange& range) {
    const GivenTransfer* const given = scene.given_transfer.get();
    if (given == nullptr || !given->map || !given->map->own_range || range.empty()) return;
    if (given->colormap_range.is_given() || !is_colormap_name(given->colormap)) return;
    const auto mistake = mistake_in_hounsfield_units(range, *given->map, given->colormap);
    if (mistake && has_colors_of(*scene.transfer_function, transfer_function_of(*given)))
        say("{}.colormap: {}", given->place, *mistake);
}

}  // namespace

Warnings data_warnings(const VolumeData& data) {
    if (data.bricks.non_finite == 0) return {};
    return {fmt::format("{} samples are NaN or infinite: their cells are drawn transparent",
                        data.bricks.non_finite)};
}

Warnings data_warnings(const Scene& scene, const SceneMesh& mesh) {
    Warnings warnings;
    add_cells(mesh.mesh.findings().cells, warnings);
    if (const std::int64_t copies = mesh.mesh.findings().copies; copies > 0) {
        const std::int64_t points = std::ssize(mesh.mesh.points());
        warnings.push_back(
            fmt::format("{} points lie at {} places: tets that meet there are neighbours, and each "
                        "keeps its own values",
                        points, points - copies));
    }
    if (mesh.averaged)
        warnings.push_back(
            fmt::format("\"{}\" is cell data: averaged to points", mesh.scalar.name));
    if (const std::int64_t count = measure_range(mesh.scalar.values).non_finite; count > 0) {
        warnings.push_back(
            fmt::format("{} values are NaN or infinite: their tets are drawn transparent", count));
    }
    if (mesh.report) add_made(scene, *mesh.report, warnings);
    return warnings;
}

Warnings plan_warnings(const Scene& scene, const SlicePlan& plan) {
    Warnings warnings;
    add_clamped_colors(scene, warnings);
    const double wanted = scene.max_error;
    const double error = plan.found_error() + plan.error_bound.value_or(0);
    const auto& trial = plan.slab_trial;
    if (error > wanted) {
        warnings.push_back(fmt::format("render.max_error: {:.4g} is not kept: {}", wanted,
                                       why_not_kept(plan, wanted, error)));
    } else if (trial && trial->doubtful) {
        warnings.push_back(
            fmt::format("render.max_error: {:.4g} is not sure to be kept: {} slabs are off by "
                        "{:.2g} / 255 on {} traced rays of {}, and others may be off by more",
                        wanted, plan.slabs, error, trial->traced, trial->rays));
    }
    return warnings;
}

Warnings plan_warnings(const Scene& scene, const ProjectPlan& plan, const MeshOverlap& overlap) {
    Warnings warnings;
    add_clamped_colors(scene, warnings);
    const Auto<ProjectOrder>& order = scene.project.order;
    if (!overlap.none() && !plan.single_color) {
        const std::string which =
            overlap.complete ? fmt::format("{} tets overlap others", overlap.tets)
                             : "too many tets overlap others, or lie too close together to tell";
        warnings.push_back(fmt::format(
            "{}: {}: {}", name_of_mesh(scene), which,
            orders_overlaps(order, overlap)
                ? "a ray shows them one after the other, whole, in the order in which it enters "
                  "them"
                : "they may not be drawn in the order in which a ray enters them, and the error of "
                  "a picture is unknown"));
        if (overlap.pairs && orders_slowly(order, overlap))
            warnings.back() += "; render.project.order \"exact\" orders them in all pixels, slowly";
    }
    return warnings;
}

Warnings frame_warnings(const OrderReport& order) {
    if (order.broken == 0) return {};
    return {
        fmt::format("{} tets hide one another in {} rings: {} pairs are drawn in the wrong order",
                    order.cyclic_tets, order.cycles, order.broken)};
}

Warnings trace_warnings(std::int64_t overlapping_rays) {
    if (overlapping_rays == 0) return {};
    return {
        fmt::format("the mesh overlaps itself on the rays of {} pixels: its tets are "
                    "composited there one after the other, as the ray enters them",
                    overlapping_rays)};
}

std::int64_t clamped_colors(const Scene& scene) {
    if (!is_fixed_point(*scene.target)) return 0;
    return std::ranges::count_if(scene.transfer_function->knots(), [](const TransferKnot& knot) {
        return glm::any(glm::greaterThan(knot.optics.color, glm::dvec3(1)));
    });
}

void warn_of_all(const Warnings& all) {
    for (const std::string& warning : all) warn(warning);
}

void warn_of_picture(const Scene& scene, const Field& field, const Image& picture) {
    const float full = scene.color_space == ImageColorSpace::display ? full_display : full_light;
    float largest = 0, brightest = 0;
    std::size_t shown = 0, saturated = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        const float* const pixel = &picture.rgba[i];
        largest = std::max(largest, pixel[3]);
        brightest = std::max({brightest, pixel[0], pixel[1], pixel[2]});
        if (pixel[3] < least_opacity) continue;
        ++shown;
        saturated += std::max({pixel[0], pixel[1], pixel[2]}) >= full ? 1U : 0U;
    }
    warn_of_units(scene, field.range());
    if (glm::any(glm::greaterThan(scene.background, glm::dvec3(1)))) {
        say("image.background: found {:.4g}, {:.4g}, {:.4g}: colours are from 0 to 1, and a PNG "
            "clamps more",
            scene.background.r, scene.background.g, scene.background.b);
    }
    if (shown > 0) warn_of_colors(scene, field.range());
    if (shown == 0) {
        say("{}: the picture shows nothing: {}", name_of_scene(scene),
            why_nothing_shows(scene, field, largest));
    } else if (std::max(largest, brightest) < faint) {
        say("{}: the picture shows almost nothing: {}", name_of_scene(scene),
            why_faint(scene, field.range(), largest));
    } else if (2 * saturated > shown) {
        say("{}: {:.0f} % of the pixels that show something are saturated: less "
            "extinction or darker colours would show more of the data",
            name_of_scene(scene),
            100 * static_cast<double>(saturated) / static_cast<double>(shown));
    }
}

}  // namespace lamina
