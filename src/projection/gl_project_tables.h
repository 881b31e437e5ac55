// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "executors/gl_optics.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lamina/transfer_function.h"
#include "plan/project_plan.h"

namespace lamina {

// The transfer function in the form that the fragments of tets read
// (shaders/projection/tet_color.glsl).
class GlProjectTables {
  public:
    GlProjectTables(const TransferFunction& transfer_function, const ProjectPlan& plan);

    void set_defines(gl::Defines& defines) const;
    void bind(gl::Program& program) const;  // textures and uniforms
    const glm::vec3& single_color() const { return single_color_; }
    double build_ms() const { return build_ms_; }
    std::int64_t table_bytes() const { return texture_ ? texture_->byte_count() : 0; }

  private:
    void upload(const UniformTable& table);
    void upload_front_weights();

    ProjectPlan plan_;
    glm::vec3 single_color_{0};
    OpticalProperties constant_;
    std::shared_ptr<const UniformTable> table_;
    // Holds table_, or FrontWeightTable for SegmentSource::parts.
    std::optional<gl::Texture> texture_;
    std::optional<GlTransferTables> intervals_;  // for SegmentSource::analytic and ::cut_table
    double build_ms_ = 0;
};

}  // namespace lamina
