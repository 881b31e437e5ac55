// SPDX-License-Identifier: Apache-2.0
#include "reference/volume_tracer.h"

#include <algorithm>
#include <glm/common.hpp>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "reference/cell_walk.h"
#include "reference/chord.h"
#include "reference/ray_integrator.h"
#include "reference/transfer_intervals.h"
#include "reference/trilinear.h"

namespace lamina {
namespace {

// Adds the part of the chord inside one cell, from parameter `from` to `to`.
template <typename Sample>
void add_cell(const CellSamples<Sample>& samples, const TransferIntervals& transfer,
              const Chord& chord, const CellIndex& cell, double from, double to,
              RayIntegrator& integrator) {
    const CellCorners corners = samples.corners(cell);
    const auto [lo, hi] = corners.range();
    if (!transfer.visible(lo, hi) || !CellSamples<Sample>::finite(corners)) return;
    const glm::dvec3 corner(cell[0], cell[1], cell[2]);
    const glm::dvec3 local = chord.entry + from * chord.direction - corner;
    const Cubic scalar = corners.along(glm::clamp(local, glm::dvec3(0), glm::dvec3(1)),
                                       (to - from) * chord.direction);
    integrator.add(scalar, lo, hi, (to - from) * chord.world_per_z);
}

struct TracedRay {
    glm::dvec4 rgba{0};
    double error_estimate = 0;
    std::int64_t segments = 0;
};

template <typename Sample>
TracedRay trace_ray(const Grid& grid, const CellSamples<Sample>& samples,
                    const TransferIntervals& transfer, const View::Ray& ray,
                    const TraceOptions& options) {
    const Chord chord = clip_to_box(grid, ray, options.clip);
    if (!(chord.length_z > 0)) return {};
    RayIntegrator integrator(transfer, options.tolerance, chord.world_length());
    CellWalk(grid, chord).run([&](const CellIndex& cell, double from, double to) {
        add_cell(samples, transfer, chord, cell, from, to, integrator);
        return !integrator.opaque();
    });
    return {glm::dvec4(integrator.color(), integrator.alpha()), integrator.error_estimate(),
            integrator.pieces()};
}

void check(const TraceOptions& options) {
    if (!(options.tolerance >= TraceOptions::smallest_tolerance && options.tolerance <= 1)) {
        fail("render.trace.tolerance: {} is out of range, expected {} to 1", options.tolerance,
             TraceOptions::smallest_tolerance);
    }
}

}  // namespace

TraceResult trace_volume(const Volume& volume, const TransferFunction& transfer_function,
                         const View& view, const TraceOptions& options) {
    check(options);
    TraceResult result{PreciseImage(view.width, view.height)};
    const TransferIntervals transfer(transfer_function);
    struct RowTotals {
        double error_estimate = 0;
        std::int64_t segments = 0;
    };
    std::vector<RowTotals> rows(static_cast<std::size_t>(view.height));
    Progress progress("tracing", view.height);
    volume.visit([&](const auto* first_sample) {
        const CellSamples samples(volume.grid(), first_sample);
        parallel_for(view.height, 1, [&](std::int64_t number) {
            const int row = static_cast<int>(number);
            RowTotals& totals = rows[static_cast<std::size_t>(number)];
            for (int column = 0; column < view.width; ++column) {
                const TracedRay ray =
                    trace_ray(volume.grid(), samples, transfer, view.ray(column, row), options);
                double* const pixel = result.image.pixel(column, row);
                for (int channel = 0; channel < 4; ++channel) pixel[channel] = ray.rgba[channel];
                totals.error_estimate = std::max(totals.error_estimate, ray.error_estimate);
                totals.segments += ray.segments;
            }
            progress.advance();
        });
    });
    for (const RowTotals& row : rows) {
        result.error_estimate = std::max(result.error_estimate, row.error_estimate);
        result.segments += row.segments;
    }
    return result;
}

TracedPixels trace_pixels(const Volume& volume, const TransferFunction& transfer_function,
                          const View& view, std::span<const glm::ivec2> pixels,
                          const TraceOptions& options) {
    check(options);
    const TransferIntervals transfer(transfer_function);
    std::vector<TracedRay> rays(pixels.size());
    Progress progress("tracing trial rays", static_cast<std::int64_t>(pixels.size()));
    volume.visit([&](const auto* first_sample) {
        const CellSamples samples(volume.grid(), first_sample);
        parallel_for(static_cast<std::int64_t>(pixels.size()), 64, [&](std::int64_t number) {
            const auto i = static_cast<std::size_t>(number);
            rays[i] = trace_ray(volume.grid(), samples, transfer,
                                view.ray(pixels[i].x, pixels[i].y), options);
            progress.advance();
        });
    });
    TracedPixels traced;
    for (const TracedRay& ray : rays) {
        traced.rgba.push_back(ray.rgba);
        traced.error_estimate = std::max(traced.error_estimate, ray.error_estimate);
    }
    return traced;
}

}  // namespace lamina
