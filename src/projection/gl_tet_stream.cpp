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

// Cell fragments per batch and per chunk. Batches are small enough that drawing starts soon, and
// large enough that a draw call costs little.
constexpr std::size_t most_in_batch = 32768;
constexpr std::size_t chunk_size = 64;

std::size_t chunks_of(std::size_t cell_fragments) {
    return (cell_fragments + chunk_size - 1) / chunk_size;
}

std::size_t batch_size_of(std::size_t cell_fragments) {
    return std::min(most_in_batch, chunks_of(cell_fragments) * chunk_size);
}

const void* offset_of(std::size_t index) {
    return reinterpret_cast<const void*>(index * sizeof(std::uint32_t));
}

// Limits drawing to some pixels; null: no limit. `rows`: the picture's rows.
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
                         std::size_t cell_fragments)
    : size_(size), batch_size_(batch_size_of(cell_fragments)), chunks_(chunks_of(batch_size_)) {
    counts_.reserve(chunks_.size());
    offsets_.reserve(chunks_.size());
    for (Batch& batch : batches_) {
        batch.vertices = gl::Buffer::make_mapped(batch_size_ * size_.vertices * size_.vertex_bytes);
        batch.indices =
            gl::Buffer::make_mapped(batch_size_ * size_.indices * sizeof(std::uint32_t));
        if (size_.has_record)
            batch.records = gl::Buffer::make_mapped(batch_size_ * sizeof(SilhouetteRecord));
        if (size_.has_gradient)
            batch.gradients = gl::Buffer::make_mapped(batch_size_ * sizeof(GradientRecord));
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

bool GlTetStream::can_replace(const TetGeometry::Size& size, std::size_t cell_fragments) const {
    return size == size_ && batch_size_of(cell_fragments) == batch_size_;
}

std::size_t GlTetStream::batch_count(std::size_t cell_fragments) const {
    return (cell_fragments + batch_size_ - 1) / batch_size_;
}

std::int64_t GlTetStream::draw(const TetGeometry& geometry,
                               const DrawOrder<CellFragment>& cell_fragments, int rows,
                               const Programs& programs, const std::function<void()>& batch_done) {
    const std::size_t count = cell_fragments.items.size();
    std::int64_t drawn = 0;
    std::int32_t last_tet = none;
    for (std::size_t first = 0; first < count; first += batch_size_) {
        const DrawOrder<CellFragment> batch_order =
            cell_fragments.subrange(first, std::min(batch_size_, count - first));
        const std::span<const CellFragment> in_batch = batch_order.items;
        const bool one_by_one = !batch_order.limited.empty();
        Batch& batch = batches_[next_batch_++ % batches_.size()];
        Stage waiting("wait for buffer");
        batch.drawn.wait();
        waiting.end();
        Stage writing("geometry");
        writing.count("parts", static_cast<double>(in_batch.size()));
        index_counts_.assign(one_by_one ? in_batch.size() : 0, 0);
        parallel_for(static_cast<std::int64_t>(chunks_of(in_batch.size())), 4,
                     [&](std::int64_t chunk) {
                         write_chunk(geometry, in_batch, static_cast<std::size_t>(chunk), batch);
                     });
        write_ms_ += writing.end();
        for (std::size_t i = 0; i < chunks_of(in_batch.size()); ++i) {
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
            submit(chunks_of(in_batch.size()), programs);
        }
        timeline_.end();
        batch.drawn.set();
        check_interrupt();
        batch_done();
    }
    gl::check("drawing tets");
    return drawn;
}

void GlTetStream::write_chunk(const TetGeometry& geometry,
                              std::span<const CellFragment> cell_fragments, std::size_t number,
                              const Batch& batch) {
    const std::size_t first = number * chunk_size;
    const std::size_t end = std::min(first + chunk_size, cell_fragments.size());
    std::size_t vertex = first * size_.vertices, index = first * size_.indices;
    auto* const indices = reinterpret_cast<std::uint32_t*>(batch.indices.mapped());
    auto* const records = reinterpret_cast<SilhouetteRecord*>(batch.records.mapped());
    auto* const gradients = reinterpret_cast<GradientRecord*>(batch.gradients.mapped());
    Chunk& chunk = chunks_[number];
    chunk = {};
    for (std::size_t i = first; i < end; ++i) {
        const TetGeometry::Written written = geometry.write(
            cell_fragments[i],
            {batch.vertices.mapped() + vertex * size_.vertex_bytes,
             static_cast<std::uint32_t>(vertex), indices + index,
             size_.has_record ? records + i : nullptr, size_.has_gradient ? gradients + i : nullptr,
             static_cast<std::uint32_t>(i)});
        vertex += written.vertices;
        index += written.indices;
        if (written.indices > 0 && cell_fragments[i].tet != chunk.last_tet) {
            ++chunk.tets;
            chunk.last_tet = cell_fragments[i].tet;
            if (chunk.first_tet == none) chunk.first_tet = cell_fragments[i].tet;
        }
        chunk.kind = std::max(chunk.kind, written.kind);
        if (!index_counts_.empty()) index_counts_[i] = static_cast<int>(written.indices);
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
            offsets_.push_back(offset_of(chunk * chunk_size * size_.indices));
        }
        program->use();
        gl::api().MultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                                    static_cast<GLsizei>(counts_.size()));
    }
}

void GlTetStream::submit_one_by_one(const DrawOrder<CellFragment>& cell_fragments, int rows,
                                    const Programs& programs) const {
    const auto& api = gl::api();
    const PixelArea* limit = nullptr;
    std::size_t index = 0;
    for (std::size_t i = 0; i < cell_fragments.items.size(); ++i) {
        if (i % chunk_size == 0) {
            index = i * size_.indices;
            programs[static_cast<std::size_t>(chunks_[i / chunk_size].kind)]->use();
        }
        const int count = index_counts_[i];
        if (count == 0) continue;
        if (const PixelArea* const pixels = cell_fragments.pixels(i); pixels != limit) {
            limit = pixels;
            set_scissor(limit, rows);
        }
        api.DrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, offset_of(index));
        index += static_cast<std::size_t>(count);
    }
    if (limit != nullptr) set_scissor(nullptr, rows);
}

}  // namespace lamina
