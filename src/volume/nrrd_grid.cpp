// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_grid.h"

#include <fmt/ranges.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace lamina {
namespace {

// Directions count as orthogonal up to this cosine: headers print some 6 digits, and it moves
// samples by less than a hundredth of a voxel over 1000 voxels.
constexpr double orthogonal_cosine = 1e-5;

// Steps outside of this range would overflow or vanish when squared.
constexpr double shortest_step = 1e-100;
constexpr double longest_step = 1e100;

bool has_direction(const Nrrd& nrrd, unsigned axis) {
    return nrrd.spaceDim > 0 && !std::isnan(nrrd.axis[axis].spaceDirection[0]);
}

// Returns the three axes that span the volume. Where there are more, axes of one sample are
// dropped, first those without a direction in space.
std::vector<unsigned> volume_axes(const std::string& file, const Nrrd& nrrd) {
    std::vector<unsigned> axes(nrrd.dim);
    std::vector<std::size_t> sizes(nrrd.dim);
    for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
        axes[axis] = axis;
        sizes[axis] = nrrd.axis[axis].size;
    }
    for (const bool keep_directed : {true, false}) {
        for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 3;) {
            const bool keep = keep_directed && has_direction(nrrd, axes[i]);
            if (nrrd.axis[axes[i]].size == 1 && !keep)
                axes.erase(axes.begin() + static_cast<long>(i));
        }
    }
    if (axes.size() != 3) {
        fail("{}: dimension: found {} axes (sizes {}), expected 3, one scalar a sample", file,
             nrrd.dim, fmt::join(sizes, " "));
    }
    for (const unsigned axis : axes) {
        const int kind = nrrd.axis[axis].kind;
        if (kind != nrrdKindUnknown && !nrrdKindIsDomain(kind)) {
            fail("{}: kinds: axis {} is '{}', expected three spatial axes, one scalar a sample",
                 file, axis, airEnumStr(nrrdKind, kind));
        }
    }
    return axes;
}

Centering centering_of(const NrrdAxisInfo& axis) {
    return axis.center == nrrdCenterCell ? Centering::cell : Centering::node;
}

// Returns the distance of samples along an axis without a direction: its spacing, else what its
// mins and maxs imply, else NaN.
double known_spacing_of(const NrrdAxisInfo& axis) {
    if (!std::isnan(axis.spacing)) return axis.spacing;
    const bool cell = centering_of(axis) == Centering::cell;
    const double intervals = static_cast<double>(axis.size) - (cell ? 0 : 1);
    if (intervals == 0) return 1;
    return (axis.max - axis.min) / intervals;
}

// The same, or 1 where the file does not say.
double spacing_of(const NrrdAxisInfo& axis) {
    const double known = known_spacing_of(axis);
    return std::isnan(known) ? 1 : known;
}

// A field `spacings` gives the spacing of every axis that has no mins and maxs.
void expect_spacings(const std::string& file, const Nrrd& nrrd, const std::vector<unsigned>& axes) {
    for (const unsigned axis : axes) {
        if (std::isnan(known_spacing_of(nrrd.axis[axis])))
            fail("{}: spacings: found nan for axis {}, expected a number above 0", file, axis);
    }
}

// Returns the position of the first sample along an axis without a direction. The min of an axis of
// cells is the border of the first cell (format, "axis mins").
double first_position_of(const NrrdAxisInfo& axis) {
    if (std::isnan(axis.min)) return 0;
    return centering_of(axis) == Centering::cell ? axis.min + spacing_of(axis) / 2 : axis.min;
}

WorldAxes axes_of(int space) {
    switch (space) {
        case nrrdSpaceLeftPosteriorSuperior:
        case nrrdSpaceScannerXYZ:  // the same by definition
            return WorldAxes::left_posterior_superior;
        case nrrdSpaceRightAnteriorSuperior:
            return WorldAxes::right_anterior_superior;
        case nrrdSpaceLeftAnteriorSuperior:
            return WorldAxes::left_anterior_superior;
        default:
            return WorldAxes::unnamed;
    }
}

void set_steps_by_directions(const std::string& file, const Nrrd& nrrd,
                             const std::vector<unsigned>& axes, Grid& grid) {
    if (nrrd.spaceDim != 3) {
        fail("{}: space: found {} dimensions, expected 3", file, nrrd.spaceDim);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (!has_direction(nrrd, axes[i])) {
            fail("{}: space directions: axis {} has none, expected three directions", file,
                 axes[i]);
        }
        const double* const direction = nrrd.axis[axes[i]].spaceDirection;
        grid.step[i] = {direction[0], direction[1], direction[2]};
    }
}

void set_steps_by_spacings(const Nrrd& nrrd, const std::vector<unsigned>& axes, Grid& grid) {
    for (int i = 0; i < 3; ++i) {
        const NrrdAxisInfo& axis = nrrd.axis[axes[static_cast<std::size_t>(i)]];
        grid.step[i] = glm::dvec3{0};
        grid.step[i][i] = spacing_of(axis);
        grid.origin[i] = first_position_of(axis);
    }
}

void check_steps(const std::string& file, const Grid& grid) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double length = std::hypot(grid.step[i].x, grid.step[i].y, grid.step[i].z);
        if (!(length >= shortest_step && length <= longest_step)) {
            fail("{}: axis {}: found a distance of {} between samples, expected one from {} to {}",
                 file, i, length, shortest_step, longest_step);
        }
        if (!(std::abs(grid.origin[static_cast<int>(i)]) <= longest_step)) {
            fail("{}: space origin: found {}, expected finite numbers up to {}", file,
                 grid.origin[static_cast<int>(i)], longest_step);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double cosine = glm::dot(glm::normalize(grid.step[i]), glm::normalize(grid.step[j]));
        if (std::abs(cosine) > orthogonal_cosine) {
            fail("{}: space directions: axes {} and {} meet at {:.4f} degrees, expected 90", file,
                 std::min(i, j), std::max(i, j),
                 glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
        }
    }
}

}  // namespace

Grid nrrd_grid(const std::string& file, const Nrrd& nrrd, bool has_spacings) {
    const std::vector<unsigned> axes = volume_axes(file, nrrd);
    Grid grid;
    grid.axes = axes_of(nrrd.space);
    for (std::size_t i = 0; i < 3; ++i) {
        const NrrdAxisInfo& axis = nrrd.axis[axes[i]];
        grid.size[i] = static_cast<std::int64_t>(axis.size);
        grid.centering[i] = axis.size == 1 ? Centering::cell : centering_of(axis);
    }
    const bool directed = std::any_of(axes.begin(), axes.end(),
                                      [&](unsigned axis) { return has_direction(nrrd, axis); });
    if (directed) {
        set_steps_by_directions(file, nrrd, axes, grid);
    } else {
        if (has_spacings) expect_spacings(file, nrrd, axes);
        set_steps_by_spacings(nrrd, axes, grid);
    }
    if (nrrd.spaceDim == 3 && !std::isnan(nrrd.spaceOrigin[0])) {
        grid.origin = {nrrd.spaceOrigin[0], nrrd.spaceOrigin[1], nrrd.spaceOrigin[2]};
    }
    check_steps(file, grid);
    return grid;
}

}  // namespace lamina
