// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/fence.h"
#include "gl/program.h"
#include "gl/timeline.h"
#include "gl/vertex_array.h"
#include "projection/tet_geometry.h"

namespace lamina {

// Streams tets or parts of them through mapped buffers in batches: while the context draws one, all
// cores write the next. Takes its memory once.
class GlTetStream {
  public:
    // An attribute of a vertex, from location 0 on.
    struct Attribute {
        int components;
        std::size_t byte_offset;
        bool integer;
    };
    // `parts`: at most so many are drawn at a time.
    GlTetStream(const TetGeometry::Size& size, std::span<const Attribute> attributes,
                std::size_t parts);

    // Whether it is what the constructor would make, for geometry of one kind.
    bool serves(const TetGeometry::Size& size, std::size_t parts) const;

    // Waits between parts, for programs that read the target as a texture.
    void set_barriers(bool barriers);

    using Programs = std::array<gl::Program*, fragment_kinds>;  // by FragmentKind; some the same
    // Draws parts in their order with the state that is bound; Ctrl-C ends it between batches.
    // `batch_done` is called after each. Returns how many tets were drawn: those that cover
    // the centre of a pixel.
    std::int64_t draw(const TetGeometry& geometry, std::span<const TetPart> parts,
                      const Programs& programs, const std::function<void()>& batch_done);

    std::size_t batch_count(std::size_t parts) const;
    void start_frame() { write_ms_ = 0; }
    void end_frame() { timeline_.collect(); }
    double write_ms() const { return write_ms_; }  // of the frame's draws

  private:
    struct Batch {
        gl::Buffer vertices, indices, records;
        gl::VertexArray vertex_array;
        gl::Fence drawn;
    };
    static constexpr std::int32_t none = -1;
    // Parts that one task writes to a region of the buffers of its own.
    struct Chunk {
        int indices = 0;
        std::int64_t tets = 0;  // drawn; parts of one that follow each other are one
        std::int32_t first_tet = none, last_tet = none;  // of these
        FragmentKind kind = FragmentKind::thin;          // the last that a part of it needs
    };
    void write(const TetGeometry& geometry, std::span<const TetPart> parts, Batch& batch);
    void write_chunk(const TetGeometry& geometry, std::span<const TetPart> parts,
                     std::size_t number, const Batch& batch);
    static const gl::Program* program_of(const Chunk& chunk, const Programs& programs);
    void submit(std::size_t chunks, const Programs& programs);
    void submit_with_barriers(std::size_t parts, const Programs& programs) const;

    TetGeometry::Size size_;
    bool barriers_ = false;
    std::size_t batch_parts_;
    std::array<Batch, 3> batches_;
    std::size_t next_batch_ = 0;  // not always the first: a draw of few tets need not wait
    std::vector<Chunk> chunks_;
    std::vector<int> part_indices_;  // of each part of the batch, for barriers
    std::vector<int> counts_;        // of indices, of the chunks of one draw
    std::vector<const void*> offsets_;
    gl::Timeline timeline_;
    double write_ms_ = 0;
};

}  // namespace lamina
