// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "lamina/scene.h"
#include "model/revisions.h"

namespace lamina::view {

// The scene as it is edited.
class Document {
  public:
    const Scene& scene() const { return scene_; }
    const Revisions& revisions() const { return revisions_; }
    bool is_open() const { return revisions_.data > 0; }
    bool dirty() const { return dirty_; }  // has been edited since it was opened or saved

    void open(Scene scene);  // a scene of other data
    // Ends `automatic_camera` and `automatic_transfer_function`.
    void set_camera(const Camera& camera);
    void set_transfer_function(const TransferFunction& transfer_function);
    void set_clip(const Clip& clip);
    void set_size(int width, int height);
    // Any other change of the scene of the same data.
    void edit(const std::function<void(Scene&)>& change);
    void mark_saved() { dirty_ = false; }

    // What was chosen from the data where the scene has something automatic: what is seen is edited
    // from there on. No change.
    void take_chosen(const Scene& chosen);

  private:
    Scene scene_;
    Revisions revisions_;
    bool dirty_ = false;
};

}  // namespace lamina::view
