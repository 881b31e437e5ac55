// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nrrd_grid.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "volume_files/volume_grid.h"

namespace lamina {
namespace {

bool has_direction(const Nrrd& nrrd, unsigned axis) {
    return nrrd.spaceDim > 0 && !std::isnan(nrrd.axis[axis].spaceDirection[0]);
}

bool any_direction(const Nrrd& nrrd) {
    for (unsigned axis = 0; axis < nrrd.dim; ++axis)
        if (has_direction(nrrd, axis)) return true;
    return false;
}

// Tells if the header says that an axis does not lie in space.
bool is_apart(const Nrrd& nrrd, unsigned axis) {
    const int kind = nrrd.axis[axis].kind;
    if (kind != nrrdKindUnknown && kind != nrrdKindDomain)
        return !nrrdKindIsDomain(kind) || kind == nrrdKindTime;
    return any_direction(nrrd) && !has_direction(nrrd, axis);
}

// Returns the three axes that span the volume. If there are more axes, those are left out first
// that do not lie in space, then axes of one sample, beginning with those without a direction in
// space.
std::vector<unsigned> volume_axes(const std::string& file, const Nrrd& nrrd) {
    std::vector<unsigned> axes(nrrd.dim);
    std::vector<std::size_t> sizes(nrrd.dim);
    for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
        axes[axis] = axis;
        sizes[axis] = nrrd.axis[axis].size;
    }
    if (nrrd.dim > 3) std::erase_if(axes, [&](unsigned axis) { return is_apart(nrrd, axis); });
    for (const bool keep_directed : {true, false}) {
        for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 3;) {
            const bool keep = keep_directed && has_direction(nrrd, axes[i]);
            if (nrrd.axis[axes[i]].size == 1 && !keep)
                axes.erase(axes.begin() + static_cast<long>(i));
        }
    }
    if (axes.size() != 3) {
        fail(
            "{}: dimension: found {} axes (sizes {}), {} of them in space by kinds and directions, "
            "expected 3",
            file, nrrd.dim, fmt::join(sizes, " "), axes.size());
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

// Returns the known spacing, or 1 if the file gives none.
double spacing_of(const NrrdAxisInfo& axis) {
    const double known = known_spacing_of(axis);
    return std::isnan(known) ? 1 : known;
}

// Throws Error if an axis has no spacing: a field `spacings` gives those of all axes that have no
// mins and maxs.
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

}  // namespace

Grid nrrd_grid(const std::string& file, const Nrrd& nrrd, bool has_spacings) {
    const std::vector<unsigned> axes = volume_axes(file, nrrd);
    Grid grid;
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
    turn_to_lps(grid, axes_of(nrrd.space));
    check_grid(file, grid, {"space directions", "space origin"});
    return grid;
}

std::vector<StoredAxis> nrrd_axes(const std::string& file, const Nrrd& nrrd,
                                  const VolumeRequest& request) {
    const std::vector<unsigned> spanning = volume_axes(file, nrrd);
    std::vector<StoredAxis> axes(nrrd.dim);
    int channels = 0, times = 0;
    for (unsigned i = 0; i < nrrd.dim; ++i) {
        axes[i].size = static_cast<std::int64_t>(nrrd.axis[i].size);
        if (axes[i].size == 1 || std::ranges::find(spanning, i) != spanning.end()) continue;
        const bool time = nrrd.axis[i].kind == nrrdKindTime;
        if (++(time ? times : channels) > 1)
            fail("{}: dimension: found several axes of {}s, expected one", file,
                 time ? "time" : "channel");
        axes[i] = taken_axis(file, time ? "time" : "channel", time ? request.time : request.channel,
                             axes[i].size);
    }
    if (channels == 0) taken_axis(file, "channel", request.channel, 1);
    if (times == 0) taken_axis(file, "time", request.time, 1);
    return axes;
}

}  // namespace lamina
