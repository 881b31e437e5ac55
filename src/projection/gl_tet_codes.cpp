// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a mesh on codes:
//   1. Sort the visible cell fragments into visibility order.
//   2. For each batch: project them on all cores.
//   3. List as many as fit into a storage block for the tiles that they may cover, and dispatch
//      projection/codes.comp, a workgroup a tile, until all lists are done; and so on with the
//      rest.
// With a compositing tree, steps 2 and 3 draw each leaf, and GlCodeTree composites the leaves.
#include "projection/gl_tet_codes.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "compositing/codes.h"
#include "gl/api.h"
#include "gl/context.h"

namespace lamina {
namespace {

constexpr std::size_t batch_size = 32768;  // cell fragments
constexpr std::size_t words_of_entry = sizeof(CodeEntry) / sizeof(std::uint32_t);

template <typename Record>
constexpr std::size_t texels_of = sizeof(Record) / (4 * sizeof(std::uint32_t));

// Entries of each tile's list in the first dispatch of a GPU: a slow one computes in doubles at
// 100 GFlop/s, and takes 60 ms for so many in each pixel of 800 x 600, of 400 operations.
constexpr int step_of_list = 32;

constexpr int tiles_of_dispatch = 16384;  // in one dispatch; OpenGL allows 65535

enum StorageBinding : unsigned { picture_binding, tile_binding };

// Units behind those of GlTransferTables and GlTree.
enum TexelUnit { record_unit = GlTransferTables::lit_unit + 1, gradient_unit, entry_unit };

// Returns the entries of all lists that a buffer of texels holds, at most `wanted`. Throws Error if
// these are fewer than the tiles of a picture, since a cell fragment may cover all.
std::size_t entries_that_fit(std::size_t wanted, int width, int height) {
    const Capabilities& capabilities = gl::current_context()->capabilities();
    const std::size_t most =
        std::min(wanted, static_cast<std::size_t>(capabilities.max_buffer_texels) / words_of_entry);
    const std::size_t tiles = CodeLists::count(width) * CodeLists::count(height);
    if (tiles > most) {
        fail(
            "image: found {} x {} pixels, which are {} tiles, expected at most {} tiles for a mesh "
            "on codes: {}; or use --context cpu",
            width, height, tiles, most, capabilities.renderer);
    }
    return most;
}

}  // namespace

gl::Defines tet_code_defines(const ProjectPlan& plan, const GlProjectTables& tables) {
    // Doubles are right for all fragments, and software rasterisers skip no branches.
    gl::Defines defines = project_defines(plan, FragmentKind::careful);
    tables.set_defines(defines);
    return defines;
}

TilePixelBits pixels_in_tile(const PixelArea& area, const TetOutline& outline, int column,
                             int row) {
    constexpr int size = CodeLists::size;
    // Least and greatest columns in the tile, by row. Those of the area are whole numbers.
    std::array<float, size> least, greatest;
    least.fill(static_cast<float>(std::max(area.first_column - column, 0)));
    greatest.fill(static_cast<float>(std::min(area.last_column - column, size - 1)));
    const auto from_area = static_cast<float>(column - area.first_column);
    for (std::size_t line = 0; line < outline.per_row.size(); ++line) {
        if (outline.at_first[line] == TetOutline::none) continue;
        const float per_row = outline.per_row[line];
        const float first =
            outline.at_first[line] + per_row * static_cast<float>(row - area.first_row) - from_area;
        if ((outline.least >> line & 1) != 0) {
            for (std::size_t i = 0; i < size; ++i)
                least[i] = std::max(least[i], first + per_row * static_cast<float>(i));
        } else {
            for (std::size_t i = 0; i < size; ++i)
                greatest[i] = std::min(greatest[i], first + per_row * static_cast<float>(i));
        }
    }
    TilePixelBits pixels = 0;
    const int end_row = std::min(area.last_row - row + 1, size);
    for (int i = std::max(area.first_row - row, 0); i < end_row; ++i) {
        const auto place = static_cast<std::size_t>(i);
        if (!(least[place] <= greatest[place])) continue;  // now both are in [0, size - 1]
        const auto first = static_cast<int>(std::ceil(least[place]));
        const auto end = static_cast<int>(std::floor(greatest[place])) + 1;
        if (first < end) pixels |= TilePixelBits{(1u << end) - (1u << first)} << (size * i);
    }
    return pixels;
}

// Software rasterisers end all loops of an invocation together after 65535 rounds, also those that
// integrate a fragment, and draw up to 16 pixels at once, whose rounds add up if they meet other
// fragments; with one entry, they meet the same. GPUs have no such bound: their time decides
// (WorkPace).
int most_in_dispatch(const ProjectPlan& plan, int intervals, const Capabilities& capabilities) {
    constexpr std::int64_t most_rounds = 65000, most = most_rounds / 16;
    if (!capabilities.software) return static_cast<int>(most);
    // Look-ups before the window, in it and behind it, each with two searches.
    const std::int64_t rounds = 2 + (plan.windowed ? 3 : 1) * (6 + 2 * std::int64_t{intervals});
    if (rounds > most_rounds) {
        fail(
            "transfer function: found {} intervals, which take up to {} rounds of a loop to find, "
            "expected at most {} rounds with {}, which ends longer loops; or use --context cpu",
            intervals, rounds, most_rounds, capabilities.renderer);
    }
    // Pieces of a lit segment are 1 / 256 of it or longer, and each may be shortened some times.
    constexpr std::int64_t most_lit = 16;
    const std::int64_t fitting = std::max<std::int64_t>(most / rounds, 1);
    return static_cast<int>(plan.lighting ? std::min(fitting, most_lit) : fitting);
}

struct GlTetCodes::Leaves : CodeLeaves {
    Leaves(GlTetCodes& owner, const TetProjector& projection,
           const DrawOrder<CellFragment>& fragments)
        : renderer(owner), projector(projection), cell_fragments(fragments) {}

    void draw(const SampleSpan& span, const GlPixels& opacity, double depth_scale) override {
        renderer.program_->set("depth_scale", static_cast<float>(depth_scale));
        renderer.composite(projector,
                           cell_fragments_of_leaf(cell_fragments, span, renderer.visible_->count()),
                           opacity, [] {});
    }

    GlTetCodes& renderer;
    const TetProjector& projector;
    const DrawOrder<CellFragment>& cell_fragments;
};

GlTetCodes::GlTetCodes(const SceneMesh& mesh, const TransferFunction& transfer_function,
                       const ProjectPlan& plan, int width, int height,
                       std::shared_ptr<VisibilityOrder> order, std::size_t entries)
    : ProjectRenderer(mesh, transfer_function, plan, std::move(order)),
      width_(width),
      height_(height),
      picture_(plan.code_bits() > 8 ? PixelPacking::shorts : PixelPacking::bytes, width, height),
      most_entries_(entries_that_fit(entries, width, height)) {
    if (plan_.nothing_visible) return;
    Stage tables("tables");
    tables_.emplace(transfer_function_, plan_);
    table_ms_ = tables.end();
    program_.emplace("projection/codes.comp", tet_code_defines(plan_, *tables_));
    const Capabilities& capabilities = gl::current_context()->capabilities();
    pace_.emplace(most_in_dispatch(plan_, tables_->intervals(), capabilities), step_of_list,
                  !capabilities.software);
    const auto most_texels = static_cast<std::size_t>(capabilities.max_buffer_texels);
    records_.resize(std::min({batch_size, most_texels / texels_of<SilhouetteRecord>,
                              static_cast<std::size_t>(visible_->count())}));
    record_texels_.reserve(4, records_.size() * texels_of<SilhouetteRecord>);
    if (plan_.lighting) gradient_records_.resize(records_.size());
    gradient_texels_.reserve(4, gradient_records_.size() * texels_of<GradientRecord>);
    tile_buffer_ =
        gl::Buffer(CodeLists::count(width) * CodeLists::count(height) * sizeof(CodeLists::Tile));
    areas_.resize(records_.size());
    if (capabilities.software) outlines_.resize(records_.size());
    if (const std::optional<TreeShape> shape = tree_shape())
        tree_.emplace(plan_, *shape, tables_->single_color(), width, height);
}

int GlTetCodes::step_count() const {
    if (tree_) return tree_->step_count();
    if (records_.empty()) return 0;
    const auto cell_fragments = static_cast<std::size_t>(visible_->count());
    return static_cast<int>((cell_fragments + records_.size() - 1) / records_.size());
}

void GlTetCodes::draw(const View& view, Progress* progress) {
    picture_.clear();
    order_ms_ = draw_ms_ = list_ms_ = 0;
    tets_drawn_ = 0;
    if (records_.empty()) return;
    Stage ordering("order");
    const DrawOrder<CellFragment> cell_fragments =
        visible_->sorted(*order_, view, plan_.scattered, plan_.solve_rings);
    order_ms_ = ordering.end();
    Stage drawing("draw");
    set_view(view);
    pace_->begin_frame();
    const TetProjector projector({mesh_.mesh, mesh_.scalar.values, plan_.range, pieces_,
                                  WindowView(seeing_in_units(view, plan_.unit)), plan_.near_depth,
                                  outline_margin, gradients_.at_points});
    timeline_.begin("draw");
    if (tree_) {
        Leaves leaves(*this, projector, cell_fragments);
        tree_->draw(leaves, picture_, progress);
    } else {
        composite(projector, cell_fragments, picture_, [&] {
            if (progress != nullptr) progress->advance();
        });
    }
    timeline_.end();
    pace_->end_frame();
    gl::check("drawing tets on codes");
    drawing.count("tets", static_cast<double>(tets_drawn_));
    draw_ms_ = drawing.end();
    timeline_.collect();
}

void GlTetCodes::set_view(const View& view) {
    tables_->bind(*program_);
    set_projection(plan_, gradients_, view, *program_);
    program_->set("picture_size", glm::ivec2(width_, height_));
    program_->set("records", record_unit);
    if (plan_.lighting) program_->set("gradient_records", gradient_unit);
    program_->set("listed", entry_unit);
}

void GlTetCodes::composite(const TetProjector& projector,
                           const DrawOrder<CellFragment>& cell_fragments, const GlPixels& picture,
                           const std::function<void()>& batch_done) {
    program_->set("picture_row", picture.row_words());
    const std::size_t count = cell_fragments.items.size();
    for (std::size_t first = 0; first < count; first += records_.size()) {
        Stage listing("geometry");
        const std::size_t in_batch = std::min(records_.size(), count - first);
        project(projector, cell_fragments.subrange(first, in_batch));
        upload_records(in_batch);
        list_ms_ += listing.end();
        const auto areas = std::span<const PixelArea>(areas_).first(in_batch);
        for (std::size_t begin = 0; begin < in_batch;) {
            Stage tiling("geometry");
            const std::size_t fitting = CodeLists::fitting(areas.subspan(begin), most_entries_);
            list(begin, fitting);
            list_ms_ += tiling.end();
            picture.bind(picture_binding, 0, height_);
            dispatch();
            // While one round of lists is drawn, the next one is made.
            drawn_[rounds_++ % drawn_.size()].end_step();
            check_interrupt();
            begin += fitting;
        }
        batch_done();
    }
}

void GlTetCodes::project(const TetProjector& projector, const DrawOrder<CellFragment>& batch) {
    const PixelArea nowhere{0, -1, 0, -1};
    const std::size_t count = batch.items.size();
    parallel_for(static_cast<std::int64_t>(count), 64, [&](std::int64_t index) {
        const auto i = static_cast<std::size_t>(index);
        ScreenOutline outline;
        GradientRecord* const lit = gradient_records_.empty() ? nullptr : &gradient_records_[i];
        areas_[i] = nowhere;
        const std::optional<FragmentKind> kind =
            projector.project(batch.items[i], records_[i], outline, lit);
        if (!kind) return;
        const PixelBounds bounds =
            pixel_bounds(outline.points(), projector.tets().margin, width_, height_);
        if (bounds.empty()) return;
        areas_[i] = {bounds.first_column, bounds.last_column, height_ - 1 - bounds.last_row,
                     height_ - 1 - bounds.first_row};
        if (const PixelArea* const limit = batch.pixels(i))
            areas_[i] = common_pixels(areas_[i], *limit);
        if (!outlines_.empty() && !areas_[i].empty()) outlines_[i] = outline_of_record(i, *kind);
    });
    std::int32_t last_tet = -1;
    for (std::size_t i = 0; i < count; ++i) {
        if (areas_[i].empty()) continue;
        if (batch.items[i].tet != last_tet) ++tets_drawn_;
        last_tet = batch.items[i].tet;
    }
}

// Software rasterisers skip no branches: a pixel takes as long for a cell fragment that it does not
// meet as for one that it meets. So they get the outlines, which take the processor less time.
TetOutline GlTetCodes::outline_of_record(std::size_t number, FragmentKind kind) const {
    const SilhouetteRecord& record = records_[number];
    const bool found_in_float = kind != FragmentKind::careful && record.front_faces() > 0;
    return found_in_float ? outline_of(record, areas_[number], height_, 1) : TetOutline();
}

void GlTetCodes::upload_records(std::size_t count) {
    record_texels_.write(std::span(records_).first(count));
    record_texels_.bind(record_unit);
    if (gradient_records_.empty()) return;
    gradient_texels_.write(std::span(gradient_records_).first(count));
    gradient_texels_.bind(gradient_unit);
}

void GlTetCodes::list(std::size_t first, std::size_t count) {
    const TetOutline everywhere;
    lists_.list(
        std::span(areas_).subspan(first, count), width_, height_,
        static_cast<std::uint32_t>(most_entries_), [&](std::size_t item, int column, int row) {
            const std::size_t number = first + item;
            const TilePixelBits pixels = pixels_in_tile(
                areas_[number], outlines_.empty() ? everywhere : outlines_[number], column, row);
            return CodeEntry{static_cast<std::uint32_t>(pixels),
                             static_cast<std::uint32_t>(pixels >> 32),
                             static_cast<std::uint32_t>(number)};
        });
    if (lists_.tiles.empty()) return;
    // Longest lists first, so that those which a dispatch draws are the first ones.
    std::ranges::sort(lists_.tiles, std::ranges::greater(),
                      [](const CodeLists::Tile& tile) { return tile.end - tile.first; });
    tile_buffer_.write(std::span(lists_.tiles));
    tile_buffer_.bind_storage(tile_binding);
    entry_texels_.reserve(1, words_of_entry * lists_.entries.size());
    entry_texels_.write(std::span(lists_.entries));
    entry_texels_.bind(entry_unit);
}

// Later dispatches draw the few tiles whose lists are longest. Their entries count by the share of
// tiles that they draw, so that entries of all tiles are not taken to be as quick.
void GlTetCodes::dispatch() {
    const auto tiles = static_cast<int>(lists_.tiles.size());
    int left = tiles;  // whose lists are not done
    const auto length = [&](int tile) {
        const CodeLists::Tile& list = lists_.tiles[static_cast<std::size_t>(tile)];
        return static_cast<int>(list.end - list.first);
    };
    for (int begin = 0; left > 0;) {
        const int entries = pace_->next(length(0) - begin);  // of the longest list
        program_->set("most_of_list", entries);
        program_->set("first_of_list", begin);
        for (int first = 0; first < left; first += tiles_of_dispatch) {
            program_->set("first_tile", first);
            program_->dispatch(std::min(tiles_of_dispatch, left - first));
        }
        pace_->dispatched(std::max(1, static_cast<int>(std::int64_t{entries} * left / tiles)));
        begin += entries;
        while (left > 0 && length(left - 1) <= begin) --left;
    }
}

void GlTetCodes::read(Image& image) const {
    picture_.read(image, largest_code(plan_.code_bits()));
}

std::map<std::string, double> GlTetCodes::stages_ms() const {
    return {
        {"tables", table_ms_}, {"order", order_ms_}, {"geometry", list_ms_}, {"draw", draw_ms_}};
}

}  // namespace lamina
