// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "facts/mesh_facts.h"
#include "projection/project_renderer.h"
#include "render/drawing.h"
#include "scene/scene_mesh.h"

namespace lamina {

class ProjectDrawing : public Drawing {
  public:
    ProjectDrawing(std::shared_ptr<const SceneMesh> mesh, std::shared_ptr<TableCache> tables)
        : whole_(std::move(mesh)), mesh_(whole_), tables_(std::move(tables)) {}

    const char* activity() const override { return "projecting"; }
    void measure_data(const Scene& scene) override;
    void measure_view(const Scene& scene, const Plan* planned) override;
    Plan plan(const Scene& scene, const Capabilities& capabilities, const OmissionSwitch& omissions,
              bool for_people) const override;
    Resolved resolve(Scene scene, const Plan& plan) const override;
    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override;
    Warnings warnings(const Resolved& resolved, const Plan& plan) override;
    void add_to(FrameStatistics& statistics) const override;
    void make_renderer(const Resolved& resolved, const Plan& plan,
                       const Capabilities& capabilities) override;
    FrameRenderer* renderer() const override { return renderer_.get(); }

  private:
    void clip_mesh(const Scene& scene);
    void measure_overlap(const Scene& scene);

    std::shared_ptr<const SceneMesh> whole_;
    std::shared_ptr<const SceneMesh> mesh_;  // mesh that the clip leaves; whole_ if that is nothing
    std::shared_ptr<TableCache> tables_;
    Clip clip_;
    bool lit_ = false;
    bool clipped_away_ = false;
    std::optional<std::int64_t> overlapping_tets_;  // of mesh_, once they are counted
    std::optional<Warnings> data_warnings_;         // of whole_, once they are asked for
    MeshFacts facts_;
    std::unique_ptr<ProjectRenderer> renderer_;
};

}  // namespace lamina
