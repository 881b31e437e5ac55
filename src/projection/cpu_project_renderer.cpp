// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a mesh on the CPU:
//   1. Sort the visible cell fragments into visibility order, and cut them into batches.
//   2. For each batch: project its cell fragments onto the window, in chunks, and list in which
//      tiles each chunk lies. TetSetup projects clear cases in vectors, TetProjector the
//      others, and FanGeometry makes the triangles of Kraus 2004.
//   3. While the next batch is projected: for each tile, composite the fragments of this batch's
//      chunks in order (cpu_fragments.h).
// With a compositing tree, steps 2 and 3 draw each leaf, and the leaves' opacities are composited.
#include "projection/cpu_project_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/client.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "executors/lights.h"
#include "executors/transfer_tables.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "scene/camera.h"

namespace lamina {
namespace {

FragmentOutput output_of(const ProjectPlan& plan) {
    if (plan.dither == ProjectDither::after_blend) return FragmentOutput::stochastic;
    if (plan.emulation) return FragmentOutput::emulated;
    return plan.dither == ProjectDither::alpha ? FragmentOutput::dithered : FragmentOutput::native;
}

}  // namespace

CpuProjectRenderer::CpuProjectRenderer(const SceneMesh& mesh,
                                       const TransferFunction& transfer_function,
                                       const ProjectPlan& plan, int width, int height,
                                       std::shared_ptr<VisibilityOrder> order)
    : ProjectRenderer(mesh, transfer_function, plan, std::move(order)),
      image_(width, height),
      fragment_counts_(static_cast<std::size_t>(image_.grid().count())) {
    if (plan_.nothing_visible) return;
    set_tables();
    fragments_.perspective = !plan_.orthographic;
    fragments_.colored = !plan_.single_color;
    fragments_.windowed = plan_.windowed;
    fragments_.divided =
        fragments_.perspective && plan_.interpolation == Interpolation::perspective;
    fragments_.output = output_of(plan_);
    fragments_.seed = plan_.seed;
    fragments_.blend = target_blend(plan_);
    if (plan_.lighting) {
        light_ = make_tile_light(*plan_.lighting, world_axes, plan_.most_bend, faint_share_of_tets);
        fragments_.light = &*light_;
        fragments_.smallest_square = gradients_.smallest_square(*plan_.lighting);
        fragments_.slanted = fragments_.perspective && plan_.thickness == Thickness::exact;
    }
    if (const std::optional<TreeShape> shape = tree_shape()) {
        const glm::vec3& color = fragments_.single_color;
        fragments_.opacity_only = true;
        tree_.emplace(plan_, *shape, std::array{color.r, color.g, color.b}, image_.grid());
    }
    // A batch has enough chunks that the tiles of all threads find work, and few enough that it
    // fits the caches (2 MB with 800 x 600 pixels). Two batches together take less memory than a
    // quarter of all cell fragments would (or two chunks), plus 64 bytes for each tile and chunk.
    const std::size_t chunks =
        std::clamp<std::size_t>(static_cast<std::size_t>(visible_->count()) / (8 * chunk_size()), 1,
                                TileBatch::most_chunks);
    for (auto& batch : batches_) {
        batch = std::make_unique<TileBatch>(chunks, image_.grid().count(), is_fan(),
                                            light_.has_value());
    }
}

// Returns the number of cell fragments that fit into a chunk in every view.
std::size_t CpuProjectRenderer::chunk_size() const {
    constexpr std::size_t most = TileBatch::chunk_size;
    return is_fan() ? 3 * most / FanGeometry::most_indices : most;
}

std::size_t CpuProjectRenderer::batch_count(std::size_t cell_fragments) const {
    return (cell_fragments + batch_size() - 1) / batch_size();
}

int CpuProjectRenderer::step_count() const {
    if (tree_) return tree_->step_count();
    return visible_ ? static_cast<int>(batch_count(static_cast<std::size_t>(visible_->count())))
                    : 0;
}

std::int64_t CpuProjectRenderer::fragments() const {
    return std::accumulate(fragment_counts_.begin(), fragment_counts_.end(), std::int64_t{0});
}

std::int64_t CpuProjectRenderer::byte_count() const {
    std::int64_t bytes =
        image_.byte_count() + static_cast<std::int64_t>(slants_.size() * sizeof(TilePixels::Plane));
    for (const auto& batch : batches_) bytes += batch ? batch->byte_count() : 0;
    if (table_) bytes += table_->byte_count();
    if (transfer_) bytes += transfer_->byte_count();
    if (tree_) bytes += tree_->byte_count();
    bytes += static_cast<std::int64_t>(gradients_.at_points.size() * sizeof(glm::vec3));
    return bytes;
}

void CpuProjectRenderer::draw(const View& view, Progress* progress) {
    order_ms_ = draw_ms_ = 0;
    tets_drawn_ = 0;
    last_tet_ = -1;
    parallel_for(image_.grid().count(), 8,
                 [&](std::int64_t tile) { image_.tile(static_cast<int>(tile)) = {}; });
    std::ranges::fill(fragment_counts_, 0);
    if (!visible_) return;
    Stage ordering("order");
    const DrawOrder<CellFragment> cell_fragments =
        visible_->sorted(*order_, view, plan_.scattered, plan_.solve_rings);
    ordering.count("parts", static_cast<double>(cell_fragments.items.size()));
    order_ms_ = ordering.end();
    Stage drawing("draw");
    set_view(view);
    const View seen = seeing_in_units(view, plan_.unit);
    const TetsInView tets{mesh_.mesh,     mesh_.scalar.values, plan_.range,
                          pieces_,        WindowView(seen),    plan_.near_depth,
                          outline_margin, gradients_.at_points};
    const Projectors projectors{tets, TetProjector(tets), {mesh_, transfer_function_, plan_, seen}};
    if (tree_) {
        draw_tree(projectors, cell_fragments, progress);
    } else {
        draw_cell_fragments(projectors, cell_fragments, nullptr, progress);
    }
    drawing.count("tets", static_cast<double>(tets_drawn_));
    drawing.count("fragments", static_cast<double>(fragments()));
    draw_ms_ = drawing.end();
}

void CpuProjectRenderer::draw_cell_fragments(const Projectors& projectors,
                                             const DrawOrder<CellFragment>& cell_fragments,
                                             CpuTetTree::Node* leaf, Progress* progress) {
    const std::size_t count = cell_fragments.items.size();
    const auto project_batch = [&](std::size_t batch) {
        const std::size_t first = batch * batch_size();
        if (first >= count) return;
        const Stage setting_up("set-up");
        project(projectors, cell_fragments.subrange(first, std::min(batch_size(), count - first)),
                *batches_[batch % 2]);
    };
    project_batch(0);
    for (std::size_t batch = 0; batch < batch_count(count); ++batch) {
        const TileBatch& projected = *batches_[batch % 2];
        // Cell fragments of one tet follow each other, even across batches: the tet counts once.
        for (std::size_t i = 0; i < projected.chunk_count(); ++i) {
            const TileBatch::Chunk& chunk = projected.chunk(i);
            if (chunk.empty()) continue;
            tets_drawn_ += chunk.tets() - (chunk.first_tet() == last_tet_);
            last_tet_ = chunk.last_tet();
        }
        parallel_invoke([&] { project_batch(batch + 1); }, [&] { draw_batch(projected, leaf); });
        if (progress != nullptr) progress->advance();
    }
}

// The tree's samples are the cell fragments of the mesh, the last one the farthest.
void CpuProjectRenderer::draw_tree(const Projectors& projectors,
                                   const DrawOrder<CellFragment>& cell_fragments,
                                   Progress* progress) {
    const auto draw_leaf = [&](const SampleSpan& span, double depth_scale, CpuTetTree::Node& leaf) {
        fragments_.depth_scale = static_cast<float>(depth_scale);
        draw_cell_fragments(projectors,
                            cell_fragments_of_leaf(cell_fragments, span, visible_->count()), &leaf,
                            nullptr);
    };
    tree_->draw(std::ref(draw_leaf), image_, progress);
}

void CpuProjectRenderer::set_tables() {
    Stage stage("tables");
    fragments_.source = plan_.source;
    fragments_.single_color = first_color(transfer_function_, plan_.range.lo, plan_.range.hi);
    switch (plan_.source) {
        case SegmentSource::constant: {
            const OpticalProperties constant = transfer_function_.at(plan_.range.lo);
            fragments_.constant_optics =
                glm::vec4(constant.color, std::min(constant.extinction, max_shader_extinction));
            break;
        }
        case SegmentSource::table:
            table_ = plan_.table.uniform_table();
            fragments_.table = table_.get();
            fragments_.inverse_first_length = static_cast<float>(table_->inverse_first_length());
            break;
        case SegmentSource::parts:
            if (!plan_.single_color)
                fragments_.front_weights = FrontWeightTable::get().texels().data();
            break;
        case SegmentSource::cut_table:
            transfer_.emplace(transfer_function_, plan_.range, plan_.table.knot_table(), 0);
            break;
        case SegmentSource::analytic:
            transfer_.emplace(transfer_function_, plan_.range, nullptr, 0);
            break;
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;
    }
    if (transfer_) fragments_.transfer = &*transfer_;
    table_ms_ = stage.end();
}

void CpuProjectRenderer::set_view(const View& view) {
    fragments_.axes = {glm::vec3(view.right), glm::vec3(view.up), glm::vec3(view.forward)};
    fragments_.image_middle = 0.5f * glm::vec2(view.width, view.height);
    fragments_.image_rows = view.height;
    fragments_.pixel_size = static_cast<float>(seeing_in_units(view, plan_.unit).pixel);
    // In perspective views depth is stored as -1 / z, which is linear in the window.
    fragments_.near_depth =
        static_cast<float>(fragments_.perspective ? -1 / plan_.near_depth : plan_.near_depth);
    fragments_.ray_perturbation = ray_perturbation(view);
    const auto& [min, max] = mesh_.mesh.bounds();
    const double farthest =
        glm::length(glm::max(glm::abs(min - view.eye), glm::abs(max - view.eye)));
    // A segment's ends can share a division if the squares of all depths are finite in float32.
    fragments_.shares_division =
        !is_fixed_point(plan_.target) && plan_.near_depth > 1e-18 && plan_.unit * farthest < 1e18;
    if (fragments_.perspective && plan_.thickness != Thickness::dz && !light_ &&
        slant_pixel_ != view.pixel)
        compute_slants(view);
}

void CpuProjectRenderer::compute_slants(const View& view) {
    slant_pixel_ = view.pixel;
    slants_.resize(fragment_counts_.size());
    parallel_for(image_.grid().count(), 1, [&](std::int64_t number) {
        const TileGrid::Tile area = image_.grid().tile(static_cast<int>(number));
        for (int row = 0; row < TileGrid::edge; ++row) {
            for (int column = 0; column < TileGrid::edge; ++column) {
                const glm::vec2 pixel(static_cast<float>(area.column + column) + 0.5f,
                                      static_cast<float>(view.height - area.row - row) - 0.5f);
                const glm::vec2 from_middle =
                    (pixel - fragments_.image_middle) * fragments_.pixel_size;
                slants_[static_cast<std::size_t>(number)]
                       [static_cast<std::size_t>(TileGrid::place(column, row))] = std::sqrt(
                           1.0f + (from_middle.x * from_middle.x + from_middle.y * from_middle.y));
            }
        }
    });
}

void CpuProjectRenderer::project(const Projectors& projectors,
                                 const DrawOrder<CellFragment>& cell_fragments,
                                 TileBatch& batch) const {
    const std::size_t count = cell_fragments.items.size();
    parallel_for(static_cast<std::int64_t>(batch.chunk_count()), 1, [&](std::int64_t number) {
        const std::size_t first = std::min(static_cast<std::size_t>(number) * chunk_size(), count);
        project_chunk(projectors,
                      cell_fragments.subrange(first, std::min(chunk_size(), count - first)),
                      batch.chunk(static_cast<std::size_t>(number)));
    });
}

void CpuProjectRenderer::project_chunk(const Projectors& projectors,
                                       const DrawOrder<CellFragment>& order,
                                       TileBatch::Chunk& chunk) const {
    chunk.clear();
    const std::span<const CellFragment> cell_fragments = order.items;
    if (is_fan()) {
        for (std::size_t i = 0; i < cell_fragments.size(); ++i)
            project_fan(projectors.fans, cell_fragments[i], order.pixels(i), chunk);
        return;
    }
    for (std::size_t first = 0; first < cell_fragments.size();
         first += TetSetup::most_cell_fragments) {
        const auto group = cell_fragments.subspan(
            first, std::min(TetSetup::most_cell_fragments, cell_fragments.size() - first));
        TetSetup done;
        // Records are written in the chunk, and moved up if one before them is not drawn.
        SilhouetteRecord* const records = &chunk.next();
        GradientRecord* const lit = chunk.next_gradient();
        set_up_tets(projectors.tets, group, cell_fragments.subspan(first + group.size()),
                    !plan_.plain, records, lit, done);
        for (std::size_t i = 0; i < group.size(); ++i) {
            const PixelArea* const limit = order.pixels(first + i);
            if (done.outcomes[i] == TetSetup::Outcome::done) {
                if (&chunk.next() != &records[i]) {
                    chunk.next() = records[i];
                    if (lit != nullptr) *chunk.next_gradient() = lit[i];
                }
                add(done.areas[i], group[i].tet, limit, chunk);
            } else if (done.outcomes[i] == TetSetup::Outcome::needs_care) {
                project_careful(projectors.careful, group[i], limit, chunk);
            }
        }
    }
}

void CpuProjectRenderer::project_careful(const TetProjector& projector,
                                         const CellFragment& cell_fragment, const PixelArea* limit,
                                         TileBatch::Chunk& chunk) const {
    const TileGrid& grid = image_.grid();
    ScreenOutline outline;
    const auto kind =
        projector.project(cell_fragment, chunk.next(), outline, chunk.next_gradient());
    if (!kind) return;
    const PixelBounds bounds =
        pixel_bounds(outline.points(), outline_margin, grid.width(), grid.height());
    // These few cell fragments are drawn as careful ones, which is right for every kind. Plans that
    // are not `plain`, which draw all this way, take DepthBound::any, because their weights come
    // from FrontWeightTable.
    add({{bounds.first_column, bounds.last_column, grid.height() - 1 - bounds.last_row,
          grid.height() - 1 - bounds.first_row},
         true,
         plan_.plain && *kind == FragmentKind::thin ? DepthBound::thin : DepthBound::any},
        cell_fragment.tet, limit, chunk);
}

void CpuProjectRenderer::project_fan(const FanGeometry& fans, const CellFragment& cell_fragment,
                                     const PixelArea* limit, TileBatch::Chunk& chunk) const {
    std::array<FanVertex, FanGeometry::most_vertices> vertices;
    std::array<std::uint32_t, FanGeometry::most_indices> indices;
    const TetGeometry::Written written = fans.write(
        cell_fragment,
        {reinterpret_cast<std::byte*>(vertices.data()), 0, indices.data(), nullptr, nullptr, 0});
    const TileGrid& grid = image_.grid();
    for (std::size_t i = 0; i < written.indices; i += 3) {
        const std::array<const FanVertex*, 3> corners{
            &vertices[indices[i]], &vertices[indices[i + 1]], &vertices[indices[i + 2]]};
        if (!make_triangle(corners, chunk.next_triangle())) continue;
        const std::array places{rounded_to_grid(corners[0]->position),
                                rounded_to_grid(corners[1]->position),
                                rounded_to_grid(corners[2]->position)};
        const PixelBounds bounds = pixel_bounds(places, 0, grid.width(), grid.height());
        if (bounds.empty()) continue;
        add({{bounds.first_column, bounds.last_column, grid.height() - 1 - bounds.last_row,
              grid.height() - 1 - bounds.first_row},
             false,
             DepthBound::any},
            cell_fragment.tet, limit, chunk);
    }
}

void CpuProjectRenderer::add(CoveredArea area, std::int32_t tet, const PixelArea* limit,
                             TileBatch::Chunk& chunk) const {
    constexpr int edge = TileGrid::edge;
    if (limit != nullptr) {
        static_cast<PixelArea&>(area) = common_pixels(area, *limit);
        if (area.empty()) return;
        area.bounded = true;
        // The outline is relative to the area's first pixel.
        if (area.careful) {
            area.outline = {};
        } else if (!is_fan()) {
            area.outline = outline_of(chunk.next(), area, image_.grid().height());
        }
    }
    chunk.add(area, tet);
    for (int row = area.first_row / edge; row <= area.last_row / edge; ++row) {
        for (int column = area.first_column / edge; column <= area.last_column / edge; ++column)
            chunk.touch(static_cast<std::size_t>(row * image_.grid().columns() + column));
    }
}

void CpuProjectRenderer::draw_batch(const TileBatch& batch, CpuTetTree::Node* leaf) {
    const Stage drawing("tiles");
    parallel_for(image_.grid().count(), 1, [&](std::int64_t place) {
        const auto tile = static_cast<std::size_t>(place);
        if (!batch.is_drawn_by(tile)) return;
        const int number = static_cast<int>(place);
        const TetTile target{tile, image_.grid().tile(number),
                             slants_.empty() ? nullptr : slants_[tile].data(), &image_.tile(number),
                             leaf != nullptr ? &leaf->opacity[tile] : nullptr};
        if (leaf != nullptr) leaf->touched[tile] = 1;
        fragment_counts_[tile] += draw_tets(fragments_, batch, target);
    });
}

void CpuProjectRenderer::read(Image& image) const {
    image_.read(fragments_.blend.largest, image);
}

std::map<std::string, double> CpuProjectRenderer::stages_ms() const {
    return {{"tables", table_ms_}, {"order", order_ms_}, {"draw", draw_ms_}};
}

CpuTetTree::CpuTetTree(const CompositingPlan& plan, const TreeShape& shape,
                       const std::array<float, 3>& single_color, const TileGrid& grid)
    : shape_(shape),
      tree_(plan, shape, single_color),
      grid_(grid),
      nodes_(static_cast<std::size_t>(shape.levels())) {
    for (Node& node : nodes_) {
        node.opacity.resize(static_cast<std::size_t>(grid.count()));
        node.touched.resize(node.opacity.size());
    }
}

void CpuTetTree::draw(const DrawLeaf& draw_leaf, TileImage& image, Progress* progress) {
    inserted_nodes_ = 0;
    evaluate(0, shape_.root(), draw_leaf, progress);
    parallel_for(grid_.count(), 8, [&](std::int64_t tile) {
        tree_.colorize(nodes_[0].opacity[static_cast<std::size_t>(tile)],
                       image.tile(static_cast<int>(tile)));
    });
}

void CpuTetTree::evaluate(int level, const SampleSpan& span, const DrawLeaf& draw_leaf,
                          Progress* progress) {
    Node& node = nodes_[static_cast<std::size_t>(level)];
    // Clears only the tiles that the last use of this level touched.
    for (std::size_t tile = 0; tile < node.touched.size(); ++tile) {
        if (node.touched[tile] != 0) node.opacity[tile].fill(0);
        node.touched[tile] = 0;
    }
    if (shape_.is_leaf(level, span)) {
        draw_leaf(span, static_cast<double>(shape_.samples()) / span.count, node);
        if (progress != nullptr) progress->advance();
        check_interrupt();
        return;
    }
    const int children = shape_.factor(level);
    for (int i = children; i-- > 0;) {  // back to front
        const SampleSpan child = child_span(span, i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, draw_leaf, progress);
        put_into_parent(level, child, span);
    }
}

// Skips tiles in which the child's opacity is 0: compositing it changes nothing.
void CpuTetTree::put_into_parent(int level, const SampleSpan& child, const SampleSpan& parent) {
    const Node& from = nodes_[static_cast<std::size_t>(level) + 1];
    Node& to = nodes_[static_cast<std::size_t>(level)];
    const std::uint32_t number = inserted_nodes_++;
    parallel_for(grid_.count(), 8, [&](std::int64_t place) {
        const auto tile = static_cast<std::size_t>(place);
        if (from.touched[tile] == 0) return;
        to.touched[tile] = 1;
        tree_.put_into_parent(child, parent, number, grid_.tile(static_cast<int>(place)),
                              from.opacity[tile], to.opacity[tile]);
    });
}

std::int64_t CpuTetTree::byte_count() const {
    std::int64_t bytes = tree_.byte_count();
    for (const Node& node : nodes_)
        bytes += static_cast<std::int64_t>(node.opacity.size() * (sizeof(TilePlane) + 1));
    return bytes;
}

}  // namespace lamina
