// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "lamina/camera.h"
#include "lamina/scene.h"
#include "parallel/fragment_code.h"
#include "parallel/shared_renderer.h"

namespace lamina {

// Directs the other ranks from rank 0: they open every scene that it opens and draw every frame
// with it (run_follower()), until it is destroyed.
class Leader {
  public:
    explicit Leader(const Ranks& ranks) : ranks_(ranks) {}
    Leader(const Leader&) = delete;
    Leader& operator=(const Leader&) = delete;
    ~Leader();

    const Ranks& ranks() const { return ranks_; }
    void set_wire(Wire wire) { wire_ = wire; }  // for scenes that are opened later

    // Opens a scene on all ranks and returns its number. `data`: rank 0's; the other ranks load the
    // scene's data themselves. Throws Error if ranks cannot share the scene or one of them fails.
    int open(const Scene& scene, SceneData data, const OmissionSwitch& omissions, bool many_frames);
    SharedRenderer& renderer(int scene) { return *renderers_.at(scene); }
    // Draws a frame on all ranks, with another camera or as before.
    void draw(int scene, const std::optional<Camera>& camera = {});
    void close(int scene);
    // Reports of all ranks on the first frame; empty before it.
    const std::vector<RankReport>& first_reports() const { return first_reports_; }

  private:
    const Ranks& ranks_;
    Wire wire_ = Wire::float32;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();  // for all scenes
    int next_ = 0;
    std::vector<RankReport> first_reports_;
    std::map<int, std::unique_ptr<SharedRenderer>> renderers_;
};

// Does what rank 0's Leader commands until that is destroyed. If a step fails on any rank
// (agree()), rank 0 prints why, and its exit code is that of the job.
void run_follower(const Ranks& ranks);

}  // namespace lamina
