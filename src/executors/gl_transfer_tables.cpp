// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_transfer_tables.h"

#include <algorithm>
#include <vector>

namespace lamina {
namespace {

enum TextureUnit {
    intervals_unit,
    interval_starts_unit,
    knot_table_unit,
    front_parts_unit = GlTransferTables::lit_unit
};
static_assert(knot_table_unit < GlTransferTables::first_free_unit);

// The texels of a coloured table are emission and mean extinction, those of a table without colour
// mean extinction alone. Each length is a layer.
gl::Texture upload_table(const KnotTable& table) {
    const std::size_t nodes = table.nodes.size();
    const int size = static_cast<int>(nodes);
    if (!table.request.colored) {
        gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::r32f, size, size);
        texture.upload({0, 0, 0, size, size, 1}, std::span<const float>(table.mean_extinction));
        return texture;
    }
    const int layers = static_cast<int>(table.lengths.size());
    gl::Texture texture = gl::Texture::make_3d(gl::TextureFormat::rgba32f, size, size, layers);
    std::vector<float> texels(4 * nodes * nodes);
    for (int layer = 0; layer < layers; ++layer) {
        const float* const emission =
            table.emission.data() + 3 * nodes * nodes * static_cast<std::size_t>(layer);
        for (std::size_t i = 0; i < nodes * nodes; ++i) {
            std::copy_n(emission + 3 * i, 3, texels.begin() + static_cast<std::ptrdiff_t>(4 * i));
            texels[4 * i + 3] = table.mean_extinction[i];
        }
        texture.upload({0, 0, layer, size, size, 1}, std::span<const float>(texels));
    }
    return texture;
}

// Front parts of a lit table's emission and extinction, layer by layer.
gl::Texture upload_front_parts(const KnotTable& table) {
    const int size = static_cast<int>(table.nodes.size());
    const int layers = static_cast<int>(table.lengths.size());
    gl::Texture texture = gl::Texture::make_3d(gl::TextureFormat::rgba32f, size, size, layers);
    texture.upload({0, 0, 0, size, size, layers}, std::span<const float>(table.front_parts));
    return texture;
}

}  // namespace

GlTransferTables::GlTransferTables(const TransferFunction& transfer_function,
                                   const ValueRange& range, const KnotTable* table, bool filtered,
                                   double step_advance) {
    if (table != nullptr) {
        anchors_ = table->anchors;
        knot_table_ = upload_table(*table);
        if (table->request.lit) front_parts_.emplace(upload_front_parts(*table));
        if (filtered) knot_table_.set_filter(gl::TextureFilter::linear);
        if (filtered && front_parts_) front_parts_->set_filter(gl::TextureFilter::linear);
        node_count_ = static_cast<int>(table->nodes.size());
        const TableRequest& request = table->request;
        if (request.max_length > 0) {
            layers_per_length_ =
                static_cast<float>((request.length_layers - 1) / request.max_length);
        }
    }
    const ShaderIntervals intervals =
        make_intervals(transfer_function, range, anchors_, step_advance);
    interval_count_ = intervals.count;
    intervals_ =
        gl::Texture::make_2d(gl::TextureFormat::rgba32f, intervals.count, ShaderIntervals::rows);
    intervals_.upload({0, 0, 0, intervals.count, ShaderIntervals::rows, 1},
                      std::span<const float>(intervals.texels));
    interval_starts_ =
        gl::Texture::make_2d(gl::TextureFormat::r32f, ShaderIntervals::start_count, 1);
    interval_starts_.upload({0, 0, 0, ShaderIntervals::start_count, 1, 1},
                            std::span<const float>(intervals.starts));
}

void GlTransferTables::bind(gl::Program& program) const {
    intervals_.bind(intervals_unit);
    interval_starts_.bind(interval_starts_unit);
    program.set("intervals", intervals_unit);
    program.set("interval_starts", interval_starts_unit);
    if (node_count_ == 0) return;
    knot_table_.bind(knot_table_unit);
    program.set("knot_table", knot_table_unit);
    program.set("layers_per_length", layers_per_length_);
    if (!front_parts_) return;
    front_parts_->bind(front_parts_unit);
    program.set("front_parts", front_parts_unit);
}

}  // namespace lamina
