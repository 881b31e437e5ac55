// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_tet_stream.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gl/check.h"

namespace lamina {
namespace {

// Small enough that the second core has work soon, large enough that a draw costs little.
constexpr std::size_t most_batch_tets = 32768;
constexpr std::size_t chunk_tets = 64;

std::size_t chunks_of(std::size_t tets) {
    return (tets + chunk_tets - 1) / chunk_tets;
}

const void* offset_of(std::size_t index) {
    return reinterpret_cast<const void*>(index * sizeof(std::uint32_t));
}

}  // namespace

GlTetStream::GlTetStream(const TetGeometry::Size& size, std::span<const Attribute> attributes,
                         std::size_t tets)
    : size_(size),
      batch_tets_(std::min(most_batch_tets, chunks_of(tets) * chunk_tets)),
      chunks_(chunks_of(batch_tets_)) {
    counts_.reserve(chunks_.size());
    offsets_.reserve(chunks_.size());
    for (Batch& batch : batches_) {
        batch.vertices = gl::Buffer::make_mapped(batch_tets_ * size_.vertices * size_.vertex_bytes);
        batch.indices =
            gl::Buffer::make_mapped(batch_tets_ * size_.indices * sizeof(std::uint32_t));
        if (size_.has_record)
            batch.records = gl::Buffer::make_mapped(batch_tets_ * sizeof(TetRecord));
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

std::size_t GlTetStream::batch_count(std::size_t tets) const {
    return (tets + batch_tets_ - 1) / batch_tets_;
}

std::int64_t GlTetStream::draw(const TetGeometry& geometry, std::span<const std::int32_t> tets,
                               const Programs& programs, const std::function<void()>& batch_done) {
    std::int64_t drawn = 0;
    write_ms_ = 0;
    for (std::size_t number = 0, first = 0; first < tets.size(); ++number, first += batch_tets_) {
        const auto part = tets.subspan(first, std::min(batch_tets_, tets.size() - first));
        Batch& batch = batches_[number % batches_.size()];
        batch.drawn.wait();
        const Stopwatch watch;
        write(geometry, part, batch);
        write_ms_ += watch.milliseconds();
        for (std::size_t chunk = 0; chunk < chunks_of(part.size()); ++chunk)
            drawn += chunks_[chunk].tets;
        batch.vertex_array.bind();
        if (size_.has_record) batch.records.bind_storage(0);
        if (barriers_) {
            submit_with_barriers(part.size(), programs);
        } else {
            submit(chunks_of(part.size()), programs);
        }
        batch.drawn.set();
        check_interrupt();
        batch_done();
    }
    gl::check("drawing tets");
    return drawn;
}

void GlTetStream::write(const TetGeometry& geometry, std::span<const std::int32_t> tets,
                        Batch& batch) {
    if (barriers_) tet_indices_.assign(tets.size(), 0);
    parallel_for(static_cast<std::int64_t>(chunks_of(tets.size())), 4, [&](std::int64_t chunk) {
        write_chunk(geometry, tets, static_cast<std::size_t>(chunk), batch);
    });
}

void GlTetStream::write_chunk(const TetGeometry& geometry, std::span<const std::int32_t> tets,
                              std::size_t number, const Batch& batch) {
    const std::size_t first = number * chunk_tets;
    const std::size_t end = std::min(first + chunk_tets, tets.size());
    std::size_t vertex = first * size_.vertices, index = first * size_.indices;
    auto* const indices = reinterpret_cast<std::uint32_t*>(batch.indices.mapped());
    auto* const records = reinterpret_cast<TetRecord*>(batch.records.mapped());
    Chunk& chunk = chunks_[number];
    chunk = {};
    for (std::size_t i = first; i < end; ++i) {
        const TetGeometry::Written written = geometry.write(
            tets[i], {batch.vertices.mapped() + vertex * size_.vertex_bytes,
                      static_cast<std::uint32_t>(vertex), indices + index,
                      size_.has_record ? records + i : nullptr, static_cast<std::uint32_t>(i)});
        vertex += written.vertices;
        index += written.indices;
        chunk.tets += written.indices > 0;
        chunk.careful |= written.careful;
        if (barriers_) tet_indices_[i] = static_cast<int>(written.indices);
    }
    chunk.indices = static_cast<int>(index - first * size_.indices);
}

// Runs of chunks with the same program. Empty ones are left out: at a draw of no indices Mesa 22.3
// forgets the rest of a multi-draw.
void GlTetStream::submit(std::size_t chunks, const Programs& programs) {
    for (std::size_t chunk = 0; chunk < chunks;) {
        const bool careful = chunks_[chunk].careful;
        counts_.clear();
        offsets_.clear();
        for (; chunk < chunks && chunks_[chunk].careful == careful; ++chunk) {
            if (chunks_[chunk].indices == 0) continue;
            counts_.push_back(chunks_[chunk].indices);
            offsets_.push_back(offset_of(chunk * chunk_tets * size_.indices));
        }
        (careful ? programs.careful : programs.plain).use();
        glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                            static_cast<GLsizei>(counts_.size()));
    }
}

void GlTetStream::submit_with_barriers(std::size_t tets, const Programs& programs) const {
    std::size_t index = 0;
    for (std::size_t i = 0; i < tets; ++i) {
        if (i % chunk_tets == 0) {
            index = i * size_.indices;
            (chunks_[i / chunk_tets].careful ? programs.careful : programs.plain).use();
        }
        const int count = tet_indices_[i];
        if (count == 0) continue;
        glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, offset_of(index));
        glTextureBarrier();
        index += static_cast<std::size_t>(count);
    }
}

}  // namespace lamina
