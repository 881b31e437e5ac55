// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/image.h"
#include "lamina/volume.h"
#include "plan/capabilities.h"
#include "scene/scene_mesh.h"
#include "selftest/drawing_way.h"
#include "visibility/visibility_order.h"

namespace lamina::selftest {

// Draws as `lamina render` does: facts, plan, renderer. Virtual for checks of the self-test itself,
// which must find what a wrong renderer draws.
class PictureMaker {
  public:
    explicit PictureMaker(const Capabilities& capabilities) : capabilities_(capabilities) {}
    virtual ~PictureMaker() = default;

    virtual PreciseImage draw(const Scene& scene, const Volume& volume) const;
    // `order`: what was found of the visibility order, where something was drawn in one.
    virtual PreciseImage draw(const Scene& scene, const SceneMesh& mesh,
                              OrderReport* order = nullptr) const;

  private:
    const Capabilities& capabilities_;
};

}  // namespace lamina::selftest
