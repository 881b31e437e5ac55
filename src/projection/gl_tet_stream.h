// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "gl/api.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "gl/timeline.h"
#include "plan/compositing_plan.h"
#include "projection/tet_projector.h"
#include "visibility/ring_order.h"

namespace lamina {

// Streams cell fragments (CellFragment) to OpenGL through mapped buffers, in batches. While the
// context draws one batch, all cores write the next. It takes its memory once.
class GlTetStream {
  public:
    // An attribute of a vertex; attributes have the locations 0, 1, ...
    struct Attribute {
        int components;
        std::size_t byte_offset;
        bool integer;
    };
    // `cell_fragments`: the largest number that one call of draw() gets.
    GlTetStream(const TetGeometry::Size& size, std::span<const Attribute> attributes,
                std::size_t cell_fragments);

    // Tells whether this stream can replace a new one with these arguments and equal attributes.
    bool can_replace(const TetGeometry::Size& size, std::size_t cell_fragments) const;

    using Programs = std::array<gl::Program*, fragment_kinds>;  // by FragmentKind; may repeat
    // Draws cell fragments in order with the bound state; the viewport is the picture. Ctrl-C ends
    // it between batches, and `batch_done` is called after each. Returns the number of tets drawn,
    // that is, that cover a pixel centre. `rows`: the picture's number of rows.
    std::int64_t draw(const TetGeometry& geometry, const DrawOrder<CellFragment>& cell_fragments,
                      int rows, const Programs& programs, const std::function<void()>& batch_done);

    std::size_t batch_count(std::size_t cell_fragments) const;
    void start_frame() { write_ms_ = 0; }
    void end_frame() { timeline_.collect(); }
    double write_ms() const { return write_ms_; }  // sum over the draws of the frame

  private:
    struct Batch {
        gl::Buffer vertices, indices, records, gradients;
        gl::VertexArray vertex_array;
        gl::Fence drawn;
    };
    static constexpr std::int32_t none = -1;
    // The cell fragments that one task writes, each task to its own region of the buffers.
    struct Chunk {
        int indices = 0;
        // Tets that are drawn; consecutive cell fragments of one tet count once.
        std::int64_t tets = 0;
        std::int32_t first_tet = none, last_tet = none;  // first and last tet drawn
        // The last FragmentKind, in the enum's order, that one of its cell fragments needs.
        FragmentKind kind = FragmentKind::thin;
    };
    void write_chunk(const TetGeometry& geometry, std::span<const CellFragment> cell_fragments,
                     std::size_t number, const Batch& batch);
    void submit(std::size_t chunks, const Programs& programs);
    void submit_one_by_one(const DrawOrder<CellFragment>& cell_fragments, int rows,
                           const Programs& programs) const;

    TetGeometry::Size size_;
    std::size_t batch_size_;
    std::array<Batch, 3> batches_;
    // The batch that is written next. It is not reset between draws, so that a draw of few tets
    // need not wait for the buffers of the previous draw.
    std::size_t next_batch_ = 0;
    std::vector<Chunk> chunks_;
    // Number of indices of each cell fragment of the batch; empty unless these are submitted one by
    // one, because some are limited to some pixels.
    std::vector<int> index_counts_;
    std::vector<int> counts_;  // number of indices of each chunk of one draw
    std::vector<const void*> offsets_;
    gl::Timeline timeline_;
    double write_ms_ = 0;
};

}  // namespace lamina
