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
// with it (run_follower()), until the Leader is destroyed.
class Leader {
  public:
    explicit Leader(const Ranks& ranks) : ranks_(ranks) {}
    Leader(const Leader&) = delete;
    Leader& operator=(const Leader&) = delete;
    ~Leader();

    const Ranks& ranks() const { return ranks_; }
    void set_wire(Wire wire) { wire_ = wire; }  // for scenes opened from now on

    // Opens a scene on all ranks and returns its number. Rank 0 uses `data`; the other ranks load
    // the scene's data themselves. Throws Error if ranks cannot share the scene or if one of
    // them fails.
    int open(const Scene& scene, SceneData data, const OmissionSwitch& omissions, bool many_frames);
    SharedRenderer& renderer(int scene) { return *renderers_.at(scene); }
    // Draws a frame on all ranks. `camera`, if given, replaces the scene's last camera.
    void draw(int scene, const std::optional<Camera>& camera = {});
    void close(int scene);
    // Returns the reports of all ranks on the first frame; empty before it.
    const std::vector<RankReport>& first_reports() const { return first_reports_; }

  private:
    const Ranks& ranks_;
    Wire wire_ = Wire::float32;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();  // of all scenes
    int next_ = 0;  // number of the next scene that is opened
    std::vector<RankReport> first_reports_;
    std::map<int, std::unique_ptr<SharedRenderer>> renderers_;
};

// Carries out the commands of rank 0's Leader until the Leader is destroyed. If a step fails on any
// rank (agree()), rank 0 prints the reason, and its exit code is the job's.
void run_follower(const Ranks& ranks);

}  // namespace lamina
