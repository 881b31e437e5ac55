// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_tet_stream.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/client.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "gl/api.h"

namespace lamina {
namespace {

// Cell fragments in a batch and in a chunk. Batches are small enough that drawing starts soon, and
// large enough that a draw call costs little.
constexpr std::size_t most_batch_parts = 32768;
constexpr std::size_t chunk_parts = 64;

std::size_t chunks_of(std::size_t parts) {
    return (parts + chunk_parts - 1) / chunk_parts;
}

std::size_t batch_parts_of(std::size_t parts) {
    return std::min(most_batch_parts, chunks_of(parts) * chunk_parts);
}

const void* offset_of(std::size_t index) {
    return reinterpret_cast<const void*>(index * sizeof(std::uint32_t));
}

// Limits drawing to some pixels; null: no limit. `rows`: of the picture.
void set_scissor(const PixelArea* pixels, int rows) {
    const auto& api = gl::api();
    if (pixels == nullptr) {
        api.Disable(GL_SCISSOR_TEST);
        return;
    }
    api.Enable(GL_SCISSOR_TEST);
    api.Scissor(pixels->first_column, rows - 1 - pixels->last_row,
                pixels->last_column - pixels->first_column + 1,
                pixels->last_row - pixels->first_row + 1);
}

}  // namespace

GlTetStream::GlTetStream(const TetGeometry::Size& size, std::span<const Attribute> attributes,
                         std::size_t parts)
    : size_(size), batch_parts_(batch_parts_of(parts)), chunks_(chunks_of(batch_parts_)) {
    counts_.reserve(chunks_.size());
    offsets_.reserve(chunks_.size());
    for (Batch& batch : batches_) {
        batch.vertices =
            gl::Buffer::make_mapped(batch_parts_ * size_.vertices * size_.vertex_bytes);
        batch.indices =
            gl::Buffer::make_mapped(batch_parts_ * size_.indices * sizeof(std::uint32_t));
        if (size_.has_record)
            batch.records = gl::Buffer::make_mapped(batch_parts_ * sizeof(SilhouetteRecord));
        if (size_.has_gradient)
            batch.gradients = gl::Buffer::make_mapped(batch_parts_ * sizeof(GradientRecord));
        batch.vertex_array.set_indices(batch.indices);
        unsigned location = 0;
        for (const auto& [components, offset, integer] : attributes) {
            if (integer) {
                batch.vertex_array.set_integers(location, batch.vertices, components,
                                                size_.vertex_bytes, offset);
            } else {
                batch.vertex_array.set_floats(location, batch.vertices, components,
                                              size_.vertex_bytes, offset);
            }
            ++location;
        }
    }
}

bool GlTetStream::serves(const TetGeometry::Size& size, std::size_t parts) const {
    return size == size_ && batch_parts_of(parts) == batch_parts_;
}

void GlTetStream::set_barriers(bool barriers) {
    barriers_ = barriers;
    if (barriers) part_indices_.reserve(batch_parts_);
}

std::size_t GlTetStream::batch_count(std::size_t parts) const {
    return (parts + batch_parts_ - 1) / batch_parts_;
}

std::int64_t GlTetStream::draw(const TetGeometry& geometry, const DrawOrder<TetPart>& parts,
                               int rows, const Programs& programs,
                               const std::function<void()>& batch_done) {
    const std::size_t count = parts.items.size();
    std::int64_t drawn = 0;
    std::int32_t last_tet = none;
    for (std::size_t first = 0; first < count; first += batch_parts_) {
        const DrawOrder<TetPart> batch_order =
            parts.part(first, std::min(batch_parts_, count - first));
        const std::span<const TetPart> batch_parts = batch_order.items;
        const bool one_by_one = barriers_ || !batch_order.limited.empty();
        Batch& batch = batches_[next_batch_++ % batches_.size()];
        Stage waiting("wait for buffer");
        batch.drawn.wait();
        waiting.end();
        Stage writing("geometry");
        writing.count("parts", static_cast<double>(batch_parts.size()));
        part_indices_.assign(one_by_one ? batch_parts.size() : 0, 0);
        parallel_for(static_cast<std::int64_t>(chunks_of(batch_parts.size())), 4,
                     [&](std::int64_t chunk) {
                         write_chunk(geometry, batch_parts, static_cast<std::size_t>(chunk), batch);
                     });
        write_ms_ += writing.end();
        for (std::size_t i = 0; i < chunks_of(batch_parts.size()); ++i) {
            const Chunk& chunk = chunks_[i];
            if (chunk.tets == 0) continue;
            drawn += chunk.tets - (chunk.first_tet == last_tet);  // one tet on both sides
            last_tet = chunk.last_tet;
        }
        const Stage submitting("submit");
        timeline_.begin("draw");
        batch.vertex_array.bind();
        if (size_.has_record) batch.records.bind_storage(0);
        if (size_.has_gradient) batch.gradients.bind_storage(1);
        if (one_by_one) {
            submit_one_by_one(batch_order, rows, programs);
        } else {
            submit(chunks_of(batch_parts.size()), programs);
        }
        timeline_.end();
        batch.drawn.set();
        check_interrupt();
        batch_done();
    }
    gl::check("drawing tets");
    return drawn;
}

void GlTetStream::write_chunk(const TetGeometry& geometry, std::span<const TetPart> parts,
                              std::size_t number, const Batch& batch) {
    const std::size_t first = number * chunk_parts;
    const std::size_t end = std::min(first + chunk_parts, parts.size());
    std::size_t vertex = first * size_.vertices, index = first * size_.indices;
    auto* const indices = reinterpret_cast<std::uint32_t*>(batch.indices.mapped());
    auto* const records = reinterpret_cast<SilhouetteRecord*>(batch.records.mapped());
    auto* const gradients = reinterpret_cast<GradientRecord*>(batch.gradients.mapped());
    Chunk& chunk = chunks_[number];
    chunk = {};
    for (std::size_t i = first; i < end; ++i) {
        const TetGeometry::Written written =
            geometry.write(parts[i], {batch.vertices.mapped() + vertex * size_.vertex_bytes,
                                      static_cast<std::uint32_t>(vertex), indices + index,
                                      size_.has_record ? records + i : nullptr,
                                      size_.has_gradient ? gradients + i : nullptr,
                                      static_cast<std::uint32_t>(i)});
        vertex += written.vertices;
        index += written.indices;
        if (written.indices > 0 && parts[i].tet != chunk.last_tet) {
            ++chunk.tets;
            chunk.last_tet = parts[i].tet;
            if (chunk.first_tet == none) chunk.first_tet = parts[i].tet;
        }
        chunk.kind = std::max(chunk.kind, written.kind);
        if (!part_indices_.empty()) part_indices_[i] = static_cast<int>(written.indices);
    }
    chunk.indices = static_cast<int>(index - first * size_.indices);
}

// Submits consecutive chunks of one program together. Empty chunks are skipped, because at a draw
// of no indices Mesa 22.3 forgets the other draws of a multi-draw.
void GlTetStream::submit(std::size_t chunks, const Programs& programs) {
    const auto program_of = [&](std::size_t chunk) {
        return programs[static_cast<std::size_t>(chunks_[chunk].kind)];
    };
    for (std::size_t chunk = 0; chunk < chunks;) {
        const gl::Program* const program = program_of(chunk);
        counts_.clear();
        offsets_.clear();
        for (; chunk < chunks && program_of(chunk) == program; ++chunk) {
            if (chunks_[chunk].indices == 0) continue;
            counts_.push_back(chunks_[chunk].indices);
            offsets_.push_back(offset_of(chunk * chunk_parts * size_.indices));
        }
        program->use();
        gl::api().MultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                                    static_cast<GLsizei>(counts_.size()));
    }
}

void GlTetStream::submit_one_by_one(const DrawOrder<TetPart>& parts, int rows,
                                    const Programs& programs) const {
    const auto& api = gl::api();
    const PixelArea* limit = nullptr;
    std::size_t index = 0;
    for (std::size_t i = 0; i < parts.items.size(); ++i) {
        if (i % chunk_parts == 0) {
            index = i * size_.indices;
            programs[static_cast<std::size_t>(chunks_[i / chunk_parts].kind)]->use();
        }
        const int count = part_indices_[i];
        if (count == 0) continue;
        if (const PixelArea* const pixels = parts.pixels(i); pixels != limit) {
            limit = pixels;
            set_scissor(limit, rows);
        }
        api.DrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, offset_of(index));
        if (barriers_) api.TextureBarrier();
        index += static_cast<std::size_t>(count);
    }
    if (limit != nullptr) set_scissor(nullptr, rows);
}

}  // namespace lamina
