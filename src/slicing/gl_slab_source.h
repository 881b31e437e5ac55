// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "executors/gl_optics.h"
#include "gl/program.h"
#include "lamina/transfer_function.h"
#include "plan/plan.h"
#include "slicing/gl_volume.h"
#include "slicing/slab_geometry.h"

namespace lamina {

// How texels become scalars. A texel is code / largest, and the scalar, normalised so that the
// drawn range is [0, 1], is (code - base) * scale. The codes of floats are normalised scalars.
struct SampleCodes {
    double largest = 1, base = 0, scale = 1;
};

// Returns the definitions that specialise slicing/segment.glsl for a plan and its tables' sizes.
// `steps`: ShaderIntervals::steps.
gl::Defines segment_defines(const SlicePlan& plan, int intervals, int table_nodes, bool steps);

// The data that fragments of slabs read (slicing/segment.glsl): volume, transfer function, rays.
class GlSlabSource {
  public:
    // First of the texture units, up to 7, that this object leaves to compositing.
    static constexpr int first_free_unit = GlTransferTables::first_free_unit + 1;

    // Uploads the volume unless `ready` can be used, and builds the tables. The transfer function
    // is in the plan's units, as views are; facts are in the world's.
    GlSlabSource(const Volume& volume, const TransferFunction& transfer_function,
                 const Facts& facts, const SlicePlan& plan, std::shared_ptr<const GlVolume> ready);

    // Replaces the plan by that of another view, which differs only in what belongs to one view.
    void take_plan(const SlicePlan& plan);
    gl::Defines defines() const;

    // Set the uniforms that never change, that depend on the view, and that depend on a brick.
    void bind(gl::Program& program) const;
    void set_view(gl::Program& program, const View& view, const Slabs& slabs) const;
    void set_brick(gl::Program& program, const View& view, const Slabs& slabs,
                   std::size_t brick) const;

    // Returns the part of a brick's box that the plan draws, in index space.
    IndexBox drawn_box(std::size_t brick) const;
    const Grid& grid() const { return facts_.grid; }
    const glm::vec3& single_color() const { return single_color_; }
    // Returns the textures; if the plan fetches no scalar, the constructor's `ready`, or null.
    std::shared_ptr<const GlVolume> volume() const { return volume_; }
    double upload_ms() const { return upload_ms_; }
    double table_ms() const { return table_ms_; }

  private:
    // `first`: the sample of the volume at which the texture begins.
    void set_clip(gl::Program& program, const glm::dvec3& first) const;
    void bind_lights(gl::Program& program) const;
    void set_real(gl::Program& program, const char* name, const glm::dvec3& value) const;

    Facts facts_;
    SlicePlan plan_;
    ValueRange range_;  // scalars that become [0, 1] in shaders
    glm::vec3 single_color_{0};
    OpticalProperties constant_;              // used if no scalar is fetched
    std::optional<GlTransferTables> tables_;  // set if scalars are fetched
    std::shared_ptr<const GlVolume> volume_;
    SampleCodes codes_;
    std::optional<gl::Texture> distances_;  // OccupiedBricks::distance, if a plan needs it
    double upload_ms_ = 0, table_ms_ = 0;
};

}  // namespace lamina
