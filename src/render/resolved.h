// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// Names the automatic keys that the scene's method needs. Tables are left out: they are chosen with
// each view. So is the order of tets below a tree: its leaves take tets from all over the mesh,
// which no word for an order says.
std::vector<std::string> open_keys(const Scene& scene);

// A scene in which everything that its method needs was chosen: it has no open_keys(). Only a
// Drawing makes one from a plan. Later views are planned, and pictures drawn, from it.
class Resolved {
  public:
    explicit Resolved(Scene scene);

    const Scene& scene() const { return scene_; }
    // Calls change_scene(scene), which must leave nothing open.
    template <typename Change>
    void change(const Change& change_scene) {
        change_scene(scene_);
    }

  private:
    Scene scene_;
};

}  // namespace lamina
