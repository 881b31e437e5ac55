// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "selftest/drawing_way.h"

namespace lamina::selftest {

// Mistakes of a renderer that the self-test must find.
enum class Mistake {
    extinction,  // opacities corrected wrongly: extinction 1 % too high
    position,    // rays off by 1e-3 of their distance
    slabs,       // one slab too few
    thickness,   // Kraus's thickness along the depth axis
    order,       // no visibility order
    bits,        // two bits too few
    clip,        // planes of the clip off by 1e-3
    light        // ambient light off by .01
};

// Makes the mistake by drawing another scene than the one that was asked for.
class MistakenMaker : public PictureMaker {
  public:
    MistakenMaker(const Capabilities& capabilities, Mistake mistake)
        : PictureMaker(capabilities), mistake_(mistake) {}

    PreciseImage draw(const Scene& scene, const SceneData& data,
                      FrameStatistics* statistics) const override;

  private:
    Scene mistaken(Scene scene) const;

    Mistake mistake_;
};

}  // namespace lamina::selftest
