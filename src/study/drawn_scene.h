// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "image/image.h"
#include "image/metrics.h"
#include "scene/capabilities.h"
#include "scene/plan.h"
#include "volume/min_max_bricks.h"
#include "volume/volume.h"

namespace lamina {

// A volume, ready for scenes that show it. To draw, the context of the capabilities must be
// current.
class DrawnVolume {
  public:
    explicit DrawnVolume(Volume volume);

    Facts measure_for(const Scene& scene, const Capabilities& capabilities) const;
    // As `lamina render` draws the scene.
    Image draw(const Scene& scene, const Capabilities& capabilities) const;
    const Volume& volume() const { return volume_; }

  private:
    Volume volume_;
    MinMaxBricks bricks_;
};

// Target `emulated`: 8 bits, as LaMar's hardware composites (2004, section 4).
Scene with_paper_hardware(Scene scene);

// Norms of a channel (0..3: R, G, B, A) of `image` - `exact`, in units of 1/255.
ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel);

}  // namespace lamina
