// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "image/image.h"
#include "optics/transfer_function.h"
#include "scene/camera.h"
#include "scene/facts.h"
#include "scene/plan.h"
#include "slicing/gl_transfer_tables.h"
#include "slicing/gl_volume_textures.h"
#include "slicing/slab_polygons.h"

namespace lamina {

// What a program of the slicing renderer is specialised by; the plan and the sizes of its tables
// decide.
gl::Defines slab_defines(const SlicePlan& plan, int intervals, int table_nodes);

// Draws a volume as the plan says, in the current OpenGL context, which must outlive it.
class GlSliceRenderer {
  public:
    // Uploads the volume, builds the tables and compiles the program; errors of OpenGL are Errors.
    GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                    const Facts& facts, const SlicePlan& plan, int width, int height);

    // Complete when it returns. Ctrl-C ends it between batches of slabs; `progress` advances by
    // batch_count in all.
    void draw(const View& view, Progress* progress = nullptr);
    int batch_count() const { return plan_.nothing_visible ? 0 : plan_.batches; }
    Image read() const { return target_.read_back(); }
    std::uint64_t draw_counting(const View& view, Progress* progress);  // returns its fragments

    double upload_ms() const { return upload_ms_; }
    double table_ms() const { return table_ms_; }
    double geometry_ms() const { return geometry_ms_; }  // of the last frame
    double draw_ms() const { return draw_ms_; }

  private:
    struct BrickDraw {
        std::size_t brick;
        std::size_t first_vertex, end_vertex;
    };

    void make_program(const TransferFunction& transfer_function);
    void make_geometry(const View& view);
    void set_view(const View& view);
    void draw_batches(const View& view, Progress* progress);
    void set_ray(const char* name, const glm::dvec3& coefficient);
    void set_brick(const View& view, std::size_t brick);

    Facts facts_;
    SlicePlan plan_;
    ValueRange range_;  // of scalars, as [0, 1] in shaders
    gl::Framebuffer target_;
    VolumeTextures volume_;
    std::optional<GlTransferTables> tables_;  // none where no scalar is fetched
    std::optional<gl::Program> program_;      // none where nothing is visible
    gl::VertexArray vertex_array_;
    gl::Buffer vertices_;
    Slabs slabs_;
    std::vector<SlabVertex> triangles_;  // kept from frame to frame
    std::vector<BrickDraw> draws_;
    double upload_ms_ = 0, table_ms_ = 0, geometry_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
