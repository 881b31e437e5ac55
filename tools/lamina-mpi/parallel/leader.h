// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "parallel/shared_renderer.h"

namespace lamina {

// Rank 0's view of the other ranks, which follow it (followers.h) until it is gone. They are told
// of every scene that it opens, and of every frame.
class Leader {
  public:
    explicit Leader(const Ranks& ranks) : ranks_(ranks) {}
    Leader(const Leader&) = delete;
    Leader& operator=(const Leader&) = delete;
    ~Leader();

    const Ranks& ranks() const { return ranks_; }
    void set_wire(Wire wire) { wire_ = wire; }  // of scenes that are opened from now on

    // Opens a scene on all ranks and returns its number. `data`: the scene's; the other ranks
    // load them for themselves. Throws Error where ranks cannot share the scene or one of them
    // fails.
    int open(const Scene& scene, SceneData data, const OmissionSwitch& omissions, bool many_frames);
    SharedRenderer& renderer(int scene) { return *renderers_.at(scene); }
    // Draws a frame on all ranks, with another camera or as before.
    void draw(int scene, const std::optional<Camera>& camera = {});
    void close(int scene);
    // Reports of all ranks on the first frame that was drawn; empty before.
    const std::vector<RankReport>& first_reports() const { return first_reports_; }

  private:
    const Ranks& ranks_;
    Wire wire_ = Wire::float32;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();  // for all scenes
    int next_ = 0;
    std::vector<RankReport> first_reports_;
    std::map<int, std::unique_ptr<SharedRenderer>> renderers_;
};

}  // namespace lamina
