// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "optics/ray_lights.h"
#include "reference/cell_walk.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "reference/cut.h"
#include "reference/ray_integrator.h"
#include "reference/traced_ray.h"
#include "reference/traced_volume.h"
#include "scene/camera.h"

namespace lamina {

// One ray through a volume, whose cells are integrated some at a time: the first are few, in case
// that they hide the others. It serves for one ray after the other.
template <typename Samples>
class VolumeRay {
  public:
    explicit VolumeRay(const TracedVolume<Samples>& traced)
        : traced_(traced), integrator_(traced.transfer, traced.options.tolerance) {}

    // Begins a ray with its chord, which is not empty.
    void begin(const View::Ray& ray, const Chord& chord) {
        chord_ = chord;
        lights_.reset();
        if (traced_.options.lighting) lights_.emplace(*traced_.options.lighting, -ray.direction);
        integrator_.begin(chord.world_length(), lights_ ? &*lights_ : nullptr);
        cells_.wanted = first_together;
    }

    // The cells along the chord are to be added here, front to back. Where they are complete(),
    // integrate() is to be called.
    CellBatch& cells() { return cells_; }

    // Returns whether what follows is seen, as far as is known.
    bool integrate() {
        traced_.samples.fetch(cells_);
        make_segments(cells_, chord_, traced_.transfer.columns(), segments_);
        if (traced_.options.lighting)
            integrator_.add_lit(segments_, [&](std::size_t segment) {
                return gradient(static_cast<std::size_t>(segments_.cell[segment]));
            });
        else
            integrator_.add(segments_);
        cells_.count = 0;
        cells_.wanted = std::min(2 * cells_.wanted, CellBatch::capacity);
        return !integrator_.opaque();
    }

    TracedRay finish() {
        integrate();
        return {glm::dvec4(integrator_.color(), integrator_.alpha()), integrator_.error_estimate(),
                integrator_.pieces()};
    }

    // Traces a ray through all of its cells.
    TracedRay trace(const View::Ray& ray) {
        const Chord chord = clip_to_box(traced_.axes, ray, traced_.options.clip);
        if (!(chord.length_z > 0)) return {};
        begin(ray, chord);
        CellWalk(traced_.grid, chord_).run([&](const CellIndex& cell, double from, double to) {
            cells_.add(cell, from, to);
            return !cells_.complete() || integrate();
        });
        return finish();
    }

  private:
    static constexpr std::size_t first_together = 8;

    GradientAlong gradient(std::size_t number) const {
        const CellIndex cell{cells_.cell[0][number], cells_.cell[1][number],
                             cells_.cell[2][number]};
        const glm::dvec3 corner(cell[0], cell[1], cell[2]);
        const double from = cells_.from[number], to = cells_.to[number];
        return traced_.gradients.along(cell, chord_.place_in_cell(corner, from),
                                       (to - from) * chord_.direction);
    }

    const TracedVolume<Samples>& traced_;
    Chord chord_;
    std::optional<RayLights> lights_;
    RayIntegrator integrator_;
    CellBatch cells_;
    SegmentBatch segments_;
};

}  // namespace lamina
