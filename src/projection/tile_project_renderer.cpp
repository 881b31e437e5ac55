// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_project_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/profile.h"
#include "executors/lights.h"
#include "facts/world_unit.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Distance from the corners' outline within which pixels are examined. It exceeds the outline's
// rounding errors.
constexpr double margin = 1e-3;

// The chunks of a batch are enough for the tiles of all threads to find work, few enough for the
// caches (2 MB with 800 x 600 pixels), and few enough that two batches take less memory than a
// fourth of the mesh's cell fragments, beside 64 bytes for each tile and chunk.
std::size_t chunks_of_batch(std::size_t parts, std::size_t parts_a_chunk) {
    return std::clamp<std::size_t>(parts / (8 * parts_a_chunk), 1, TileBatch::most_chunks);
}

double farthest_corner(const TetMesh& mesh, const glm::dvec3& eye) {
    const auto& [min, max] = mesh.bounds();
    return glm::length(glm::max(glm::abs(min - eye), glm::abs(max - eye)));
}

FragmentOutput output_of(const ProjectPlan& plan) {
    if (plan.dither == ProjectDither::after_blend) return FragmentOutput::stochastic;
    if (plan.emulation) return FragmentOutput::emulated;
    return plan.dither == ProjectDither::alpha ? FragmentOutput::dithered : FragmentOutput::native;
}

}  // namespace

TileProjectRenderer::TileProjectRenderer(const SceneMesh& mesh,
                                         const TransferFunction& transfer_function,
                                         const ProjectPlan& plan, int width, int height,
                                         std::shared_ptr<VisibilityOrder> order)
    : mesh_(mesh),
      transfer_function_(in_units(transfer_function, plan.unit)),
      plan_(plan),
      pieces_(transfer_function_, plan.range),
      order_(order_for(mesh, plan, std::move(order))),
      image_(width, height),
      fragment_counts_(static_cast<std::size_t>(image_.grid().count())) {
    if (plan_.nothing_visible) return;
    tables_.emplace(transfer_function_, plan_);
    tables_->set(fragments_);
    fragments_.perspective = !plan_.orthographic;
    fragments_.colored = !plan_.single_color;
    fragments_.windowed = plan_.windowed;
    fragments_.divided =
        fragments_.perspective && plan_.interpolation == Interpolation::perspective;
    fragments_.output = output_of(plan_);
    fragments_.seed = plan_.seed;
    fragments_.blend = target_blend(plan_);
    if (plan_.lighting) set_light();
    Stage cutting("visible parts");
    parts_.emplace(mesh.mesh, mesh.scalar.values, pieces_, plan_.source == SegmentSource::parts,
                   plan_.draw_transparent);
    cutting.end();
    if (!plan_.tree.empty() && parts_->count() > 0) {
        const glm::vec3& color = fragments_.single_color;
        fragments_.opacity_only = true;
        tree_.emplace(plan_, TreeShape(plan_.tree, static_cast<int>(parts_->count())),
                      std::array{color.r, color.g, color.b}, image_.grid());
    }
    const std::size_t chunks =
        chunks_of_batch(static_cast<std::size_t>(parts_->count()), parts_a_chunk());
    for (auto& batch : batches_) {
        batch = std::make_unique<TileBatch>(chunks, image_.grid().count(), is_fan(),
                                            light_.has_value());
    }
}

// Returns the number of cell fragments that fit into a chunk in every view.
std::size_t TileProjectRenderer::parts_a_chunk() const {
    constexpr std::size_t most = TileBatch::chunk_parts;
    return is_fan() ? 3 * most / FanGeometry::most_indices : most;
}

std::size_t TileProjectRenderer::batch_count(std::size_t parts) const {
    return (parts + parts_a_batch() - 1) / parts_a_batch();
}

int TileProjectRenderer::step_count() const {
    if (tree_) return tree_->step_count();
    return parts_ ? static_cast<int>(batch_count(static_cast<std::size_t>(parts_->count()))) : 0;
}

std::int64_t TileProjectRenderer::fragments() const {
    return std::accumulate(fragment_counts_.begin(), fragment_counts_.end(), std::int64_t{0});
}

std::int64_t TileProjectRenderer::byte_count() const {
    std::int64_t bytes =
        image_.byte_count() + static_cast<std::int64_t>(slants_.size() * sizeof(TilePixels::Plane));
    for (const auto& batch : batches_) bytes += batch ? batch->byte_count() : 0;
    if (tables_) bytes += tables_->byte_count();
    if (tree_) bytes += tree_->byte_count();
    bytes += static_cast<std::int64_t>(gradients_.at_points.size() * sizeof(glm::vec3));
    return bytes;
}

bool TileProjectRenderer::take(const Plan& plan) {
    return plan.project.picture() == plan_.picture();
}

void TileProjectRenderer::draw(const View& view, Progress* progress) {
    order_ms_ = draw_ms_ = 0;
    tets_drawn_ = 0;
    last_tet_ = -1;
    clear();
    if (!parts_) return;
    Stage ordering("order");
    const DrawOrder<TetPart> parts =
        parts_->sorted(*order_, view, plan_.scattered, plan_.solve_rings);
    ordering.count("parts", static_cast<double>(parts.items.size()));
    order_ms_ = ordering.end();
    Stage drawing("draw");
    set_view(view);
    const View seen = seeing_in_units(view, plan_.unit);
    const auto& gradients = gradients_.at_points;
    const Projectors projectors{{mesh_.mesh, mesh_.scalar.values, plan_.range, pieces_, seen,
                                 plan_.near_depth, margin, gradients},
                                {mesh_.mesh, mesh_.scalar.values, plan_.range, pieces_, seen,
                                 plan_.near_depth, margin, gradients},
                                {mesh_, transfer_function_, plan_, seen}};
    if (tree_) {
        draw_tree(projectors, parts, progress);
    } else {
        draw_parts(projectors, parts, nullptr, progress);
    }
    drawing.count("tets", static_cast<double>(tets_drawn_));
    drawing.count("fragments", static_cast<double>(fragments()));
    draw_ms_ = drawing.end();
}

void TileProjectRenderer::draw_parts(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                                     TileTetTree::Node* leaf, Progress* progress) {
    const std::size_t count = parts.items.size();
    const auto project_batch = [&](std::size_t batch) {
        const std::size_t first = batch * parts_a_batch();
        if (first >= count) return;
        const Stage setting_up("set-up");
        project(projectors, parts.part(first, std::min(parts_a_batch(), count - first)),
                *batches_[batch % 2]);
    };
    project_batch(0);
    for (std::size_t batch = 0; batch < batch_count(count); ++batch) {
        const TileBatch& projected = *batches_[batch % 2];
        count_tets(projected);
        parallel_invoke([&] { project_batch(batch + 1); }, [&] { draw(projected, leaf); });
        if (progress != nullptr) progress->advance();
    }
}

// The samples of a ray are the cell fragments, the last one the farthest.
void TileProjectRenderer::draw_tree(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                                    Progress* progress) {
    const auto draw_leaf = [&](const SampleSpan& span, double depth_scale,
                               TileTetTree::Node& leaf) {
        fragments_.depth_scale = static_cast<float>(depth_scale);
        draw_parts(projectors, parts_of_leaf(parts, span, parts_->count()), &leaf, nullptr);
    };
    tree_->draw(std::ref(draw_leaf), image_, progress);
}

void TileProjectRenderer::set_light() {
    const Stage stage("gradients");
    gradients_ = StoredGradients(gradients_of(mesh_), *plan_.lighting->smallest_gradient);
    light_ = make_tile_light(*plan_.lighting, world_axes, plan_.most_bend, faint_share_of_tets);
    fragments_.light = &*light_;
    fragments_.smallest_square = gradients_.smallest_square(*plan_.lighting);
    fragments_.slanted = fragments_.perspective && plan_.thickness == Thickness::exact;
}

void TileProjectRenderer::set_view(const View& view) {
    fragments_.axes = {glm::vec3(view.right), glm::vec3(view.up), glm::vec3(view.forward)};
    fragments_.image_middle = 0.5f * glm::vec2(view.width, view.height);
    fragments_.image_rows = view.height;
    fragments_.pixel_size = static_cast<float>(seeing_in_units(view, plan_.unit).pixel);
    fragments_.near_depth =
        static_cast<float>(fragments_.perspective ? -1 / plan_.near_depth : plan_.near_depth);
    fragments_.ray_perturbation = ray_perturbation(view);
    fragments_.one_division = !is_fixed_point(plan_.target) && plan_.near_depth > 1e-18 &&
                              plan_.unit * farthest_corner(mesh_.mesh, view.eye) < 1e18;
    if (!fragments_.perspective || plan_.thickness == Thickness::dz || light_ ||
        slant_pixel_ == view.pixel)
        return;
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

void TileProjectRenderer::clear() {
    parallel_for(image_.grid().count(), 8,
                 [&](std::int64_t tile) { image_.tile(static_cast<int>(tile)) = {}; });
    std::ranges::fill(fragment_counts_, 0);
}

void TileProjectRenderer::project(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                                  TileBatch& batch) const {
    const std::size_t count = parts.items.size();
    parallel_for(static_cast<std::int64_t>(batch.chunk_count()), 1, [&](std::int64_t number) {
        const std::size_t first =
            std::min(static_cast<std::size_t>(number) * parts_a_chunk(), count);
        project_chunk(projectors, parts.part(first, std::min(parts_a_chunk(), count - first)),
                      batch.chunk(static_cast<std::size_t>(number)));
    });
}

void TileProjectRenderer::project_chunk(const Projectors& projectors,
                                        const DrawOrder<TetPart>& order,
                                        TileBatch::Chunk& chunk) const {
    chunk.clear();
    const std::span<const TetPart> parts = order.items;
    if (is_fan() || !plan_.plain) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (is_fan()) {
                project_fan(projectors.fans, parts[i], order.pixels(i), chunk);
            } else {
                project_doubtful(projectors.careful, parts[i], order.pixels(i), chunk);
            }
        }
        return;
    }
    for (std::size_t first = 0; first < parts.size(); first += TetSetup::most_parts) {
        const auto group =
            parts.subspan(first, std::min(TetSetup::most_parts, parts.size() - first));
        TetSetup::Parts done;
        // Records are written in place, and moved if one before them is not drawn.
        SilhouetteRecord* const records = &chunk.next();
        GradientRecord* const lit = chunk.next_gradient();
        projectors.setup.set_up(group, parts.subspan(first + group.size()), records, lit, done);
        for (std::size_t i = 0; i < group.size(); ++i) {
            const PixelArea* const limit = order.pixels(first + i);
            if (done.outcomes[i] == TetSetup::Outcome::done) {
                if (&chunk.next() != &records[i]) {
                    chunk.next() = records[i];
                    if (lit != nullptr) *chunk.next_gradient() = lit[i];
                }
                add(done.areas[i], group[i].tet, limit, chunk);
            } else if (done.outcomes[i] == TetSetup::Outcome::doubtful) {
                project_doubtful(projectors.careful, group[i], limit, chunk);
            }
        }
    }
}

void TileProjectRenderer::project_doubtful(const TetProjector& projector, const TetPart& part,
                                           const PixelArea* limit, TileBatch::Chunk& chunk) const {
    const TileGrid& grid = image_.grid();
    ScreenOutline outline;
    const auto kind = projector.project(part, chunk.next(), outline, chunk.next_gradient());
    if (!kind) return;
    const PixelBounds bounds = pixel_bounds(outline.points(), margin, grid.width(), grid.height());
    // Doubtful cell fragments are drawn as careful ones, which is right for every kind. They are
    // few, unless all are drawn so; then the table gives the weights (the plan's weight_error).
    add({{bounds.first_column, bounds.last_column, grid.height() - 1 - bounds.last_row,
          grid.height() - 1 - bounds.first_row},
         true,
         plan_.plain && *kind == FragmentKind::thin ? PartDepth::thin : PartDepth::any},
        part.tet, limit, chunk);
}

void TileProjectRenderer::project_fan(const FanGeometry& fans, const TetPart& part,
                                      const PixelArea* limit, TileBatch::Chunk& chunk) const {
    std::array<FanVertex, FanGeometry::most_vertices> vertices;
    std::array<std::uint32_t, FanGeometry::most_indices> indices;
    const TetGeometry::Written written = fans.write(
        part,
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
             PartDepth::any},
            part.tet, limit, chunk);
    }
}

void TileProjectRenderer::add(const PartArea& area, std::int32_t tet, const PixelArea* limit,
                              TileBatch::Chunk& chunk) const {
    constexpr int edge = TileGrid::edge;
    if (limit != nullptr) {
        PartArea limited = area;
        static_cast<PixelArea&>(limited) = common_pixels(area, *limit);
        if (limited.empty()) return;
        limited.bounded = true;
        // The outline is relative to the area's first pixel.
        if (!is_fan() && !area.careful)
            limited.outline = outline_of(chunk.next(), limited, image_.grid().height());
        add(limited, tet, nullptr, chunk);
        return;
    }
    chunk.add(area, tet);
    for (int row = area.first_row / edge; row <= area.last_row / edge; ++row) {
        for (int column = area.first_column / edge; column <= area.last_column / edge; ++column)
            chunk.touch(static_cast<std::size_t>(row * image_.grid().columns() + column));
    }
}

// Cell fragments of one tet follow each other, also from chunk to chunk.
void TileProjectRenderer::count_tets(const TileBatch& batch) {
    for (std::size_t i = 0; i < batch.chunk_count(); ++i) {
        const TileBatch::Chunk& chunk = batch.chunk(i);
        if (chunk.empty()) continue;
        tets_drawn_ += chunk.tets() - (chunk.first_tet() == last_tet_);
        last_tet_ = chunk.last_tet();
    }
}

void TileProjectRenderer::draw(const TileBatch& batch, TileTetTree::Node* leaf) {
    const Stage drawing("tiles");
    parallel_for(image_.grid().count(), 1, [&](std::int64_t tile) {
        draw_tile(batch, static_cast<std::size_t>(tile), leaf);
    });
}

void TileProjectRenderer::draw_tile(const TileBatch& batch, std::size_t tile,
                                    TileTetTree::Node* leaf) {
    if (!batch.is_drawn_by(tile)) return;
    const int number = static_cast<int>(tile);
    const TetTile target{tile, image_.grid().tile(number),
                         slants_.empty() ? nullptr : slants_[tile].data(), &image_.tile(number),
                         leaf != nullptr ? &leaf->opacity[tile] : nullptr};
    if (leaf != nullptr) leaf->touched[tile] = 1;
    fragment_counts_[tile] += draw_tets(fragments_, batch, target);
}

void TileProjectRenderer::read(Image& image) const {
    image_.read(fragments_.blend.largest, image);
}

std::map<std::string, double> TileProjectRenderer::stages_ms() const {
    return {{"tables", table_ms()}, {"order", order_ms()}, {"draw", draw_ms()}};
}

}  // namespace lamina
