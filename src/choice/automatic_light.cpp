// SPDX-License-Identifier: Apache-2.0
#include "choice/automatic_light.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "choice/variation.h"

namespace lamina {

namespace {

// Least share of what shows that lies on surfaces: half as much again as of white noise, of which
// it is a tenth. Noisy things look flat without light.
constexpr double least_surfaces = .15;
constexpr std::size_t light_bins = 256;
// Bound on the error, in 1/255, below which software OpenGL may refuse light: its loops are too
// short (docs/lighting.md). Choices must not depend on the context, so none of them lights then.
constexpr double least_lit_error = .25;
// Number of slabs below which it may refuse light, too: rays are cut into so many, and the longest
// piece takes some 16 cells of a volume of 2^28 samples, far less than its loops hold.
constexpr int least_lit_slabs = 256;

// Returns the key because of which light would be refused (docs/lighting.md), if there is one.
std::optional<std::string> refusal(const Scene& scene) {
    const ProjectSettings& project = scene.project;
    if (scene.max_error < least_lit_error)
        return fmt::format("render.max_error is below {}", least_lit_error);
    if (scene.method == Method::project) {
        if (project.coloring == Coloring::vertex || project.coloring == Coloring::attenuation)
            return "render.project.coloring mixes colours";
        if (project.interpolation == Interpolation::linear)
            return "render.project.interpolation is linear";
        if (project.geometry == ProjectGeometry::triangles)
            return "render.project.geometry is triangles";
        if (project.table.is_given()) return "render.project.table knows no gradient";
        if (project.tree) return "render.project.tree has no place for light";
    }
    if (scene.method != Method::slice) return std::nullopt;
    const SliceSettings& slice = scene.slice;
    const TreeSettings* const tree = given_tree(slice.tree);
    if (tree != nullptr && tree->nodes == NodeArithmetic::fixed)
        return "render.slice.tree.nodes know opacity alone";
    // Light needs exact segments unless the scene names others.
    if (slice.classification.is_given() && slice.classification != Classification::exact)
        return std::nullopt;
    if (slice.filter == Filter::hardware) return "render.slice.filter is hardware";
    double slabs = least_lit_slabs;
    if (tree != nullptr) {
        slabs = 1;
        for (const int factor : tree->factors) slabs *= factor;
    }
    if (slice.samples.is_given()) slabs = *slice.samples;
    if (slabs < least_lit_slabs) {
        return fmt::format(
            "render.slice.{} cuts rays into fewer than {} slabs, which software "
            "OpenGL may refuse",
            slice.samples.is_given() ? "samples" : "tree", least_lit_slabs);
    }
    return std::nullopt;
}

}  // namespace

// Surfaces are seen where opacity changes in space: a bin counts by how many places it has, by
// their gradient and by how much the opacity of a ray over the data's spacing changes over its
// values.
LightChoice choose_light(const Scene& scene, const TransferSubject& subject, const Padding& padding,
                         double smallest_gradient) {
    const Field& field = *subject.field;
    if (const auto key = refusal(scene)) return {false, "not lit, because " + *key};
    const ValueDistribution& values = padding.rest;
    if (values.distinct() < 2) return {false, "not lit: the data have a single value"};
    if (field.slice()) return {false, "not lit: one slice has no surface"};
    if (values.distinct() == 2) return {true, "lit: data of two values are a surface"};
    if (is_sheet(subject))
        return {false, "not lit: the mesh is a sheet, and gradients do not say how it is bent"};
    const ValueRange measured{values.lowest(), values.highest()};
    const Variation around =
        field.variation(measured, Variation(measured.lo, measured.hi, light_bins));
    const double half_bin = (measured.hi / 2 - measured.lo / 2) / static_cast<double>(light_bins);
    const double spacing = field.spacing();
    double shown = 0, surfaces = 0, changes = 0;
    for (std::size_t bin = 0; bin < light_bins; ++bin) {
        const auto opacity_at = [&](double value) {
            return -std::expm1(-scene.transfer_function->at(value).extinction * spacing);
        };
        const double middle = around.value(bin), here = opacity_at(middle);
        const double change = std::abs(here - opacity_at(middle - half_bin)) +
                              std::abs(here - opacity_at(middle + half_bin));
        const double seen = around.weight(bin) * around.slope(bin) * change;
        shown += seen;
        changes += change;
        if (around.slope(bin) >= smallest_gradient) surfaces += seen * around.coherence(bin);
    }
    if (!(shown > 0) && changes > 0)
        return {true, "lit: no sample has a value at which opacity changes, so edges are sharp"};
    if (!(shown > 0)) return {false, "not lit: nothing shows that has a surface"};
    const double share = surfaces / shown;
    const std::string found =
        fmt::format("{:.0f} % of what changes in the picture are surfaces", 100 * share);
    if (share < least_surfaces) return {false, fmt::format("not lit: only {}", found)};
    return {true, "lit: " + found};
}

}  // namespace lamina
