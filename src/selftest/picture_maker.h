// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/image.h"
#include "lamina/volume.h"
#include "plan/capabilities.h"
#include "scene/scene_mesh.h"
#include "selftest/drawing_way.h"
#include "visibility/visibility_order.h"

namespace lamina::selftest {

// Draws as `lamina render` does: facts, plan, renderer. To check the self-test itself it can make a
// deliberate mistake, so that the picture is not the one that was asked for.
class PictureMaker {
  public:
    // `mistake`: one of mistakes(), or empty. Throws UsageError for anything else.
    PictureMaker(const Capabilities& capabilities, std::string mistake);

    PreciseImage draw(const Scene& scene, const Volume& volume) const;
    // `order`: receives the report of the visibility order, where there was one.
    PreciseImage draw(const Scene& scene, const SceneMesh& mesh,
                      OrderReport* order = nullptr) const;

    static const std::vector<std::string>& mistakes();

  private:
    Scene mistaken(Scene scene) const;

    const Capabilities& capabilities_;
    std::string mistake_;
};

}  // namespace lamina::selftest
