// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

#include "executors/transfer_tables.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lamina/settings.h"

namespace lamina {

// The transfer function and, if it is needed, its pre-integration table, as the textures or blocks
// that shaders/optics/intervals.glsl and preintegration/knot_table.glsl read.
class GlTransferTables {
  public:
    static constexpr int first_free_unit = 3;  // the tables use the texture units below this one
    static constexpr int lit_unit = 10;        // and this one, if they are lit

    // `range`: the scalars that shaders see as [0, 1]; lo < hi. `table`: the pre-integration
    // table, or null. `filtered`: the table is read through the texture unit's filter.
    // `step_advance`: see make_intervals(). `block`: the transfer function is a storage block, for
    // programs with TABLE_BLOCKS.
    GlTransferTables(const TransferFunction& transfer_function, const ValueRange& range,
                     const KnotTable* table, bool filtered, double step_advance, bool block);

    int intervals() const { return interval_count_; }
    bool steps() const { return steps_; }      // ShaderIntervals::steps
    int nodes() const { return node_count_; }  // along an axis of the table; 0 without a table
    void bind(gl::Program& program) const;     // binds tables and sets uniforms

  private:
    int interval_count_ = 0, node_count_ = 0;
    bool steps_ = false;
    float layers_per_length_ = 0;
    gl::Texture intervals_, interval_starts_, knot_table_;
    gl::Buffer block_;  // in place of the former two
    std::optional<gl::Texture> front_parts_;
};

// Sets the definitions that specialise shaders/optics/lighting.glsl.
void set_light_defines(const Lighting& lighting, gl::Defines& defines);

// Sets the uniforms of shaders/optics/lighting.glsl. `axes`: the axes, in world space, along which
// the program's vectors are given; orthogonal, of any length.
void set_lights(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                gl::Program& program);
// Sets the thresholds at which lit pieces of rays are cut (LightCuts).
void set_light_cuts(const Lighting& lighting, gl::Program& program);

}  // namespace lamina
