// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a mesh:
//   1. List the faces by which rays of each tile may enter.
//   2. Dispatch projection/walk.comp, a workgroup a tile, until no ray is unfinished.
// The mesh is uploaded once, as texels of integers, into which floats are stored by their bits:
//   tets         the corners' places (TetMesh::places()), combined by exclusive or: with three
//                corners of a tet, it tells the fourth; hidden_tet if it shows nothing
//   neighbors    tets behind the faces opposite to the corners, by ascending place of these
//   corners      if points have copies: the corners themselves, by ascending place
//   points       place from the mesh's center, in steps of place_steps_, and normalised scalar
//   gradients    if lit: StoredGradients
//   open faces   corners, counter-clockwise seen from outside, and the tet
//   tiles        TileLists::Tile
#include "projection/gl_mesh_walk.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "gl/context.h"
#include "scene/camera.h"

namespace lamina {
namespace {

constexpr std::uint32_t hidden_tet = 0x80000000u;

constexpr int most_rounds = 65000;

// Returns the number of rounds of a ray in the first dispatch. On GPUs, which have no bound, their
// time decides on those of the next ones (WalkPace). Software rasterisers end all loops of an
// invocation together after 65535 rounds, also those that integrate a segment, within a round. They
// draw up to 16 rays at once: where these enter the mesh at different times, the rounds add up.
int rounds_of(const ProjectPlan& plan, int intervals) {
    if (!gl::current_context()->capabilities().software) return WalkPace::first_rounds;
    constexpr int most = most_rounds / 16, least = 16;
    // Pieces of a lit segment are 1 / 256 of it or longer, and each may be shortened some times.
    if (plan.lighting) return least;
    // Three look-ups, and two searches for the interval of a scalar.
    if (plan.source == SegmentSource::cut_table) return std::max(most / (8 + 2 * intervals), least);
    // A search where a ray enters the mesh or a tet with values of its own.
    return std::max(most / (2 + intervals), least);
}

constexpr std::size_t bytes_of_tile = 64 * EntryTiles::size * EntryTiles::size;  // of its rays

// Returns the largest number of tiles in one dispatch: as many as OpenGL allows, since a GPU waits
// for the next dispatch; in software 64 MiB of rays.
std::size_t most_tiles_of(const Capabilities& capabilities) {
    const auto fitting = static_cast<std::size_t>(capabilities.max_storage_bytes) / bytes_of_tile;
    return std::min<std::size_t>(capabilities.software ? 16384 : 65535, fitting);
}

constexpr unsigned mesh_unit = 4;     // and those after it; behind those of GlProjectTables
constexpr unsigned mesh_binding = 5;  // and those after it, in blocks (walk_mesh.glsl)

using Texel = std::array<std::uint32_t, 4>;

// Returns the steps of places along each axis: 2^30 from the center to the sides of the box, so
// that these are exact, and rays along them go to the side that ray_perturbation() says.
glm::dvec3 steps_to(const glm::dvec3& sides) {
    glm::dvec3 steps = 0x1p-30 * sides;
    for (int axis = 0; axis < 3; ++axis)
        if (steps[axis] == 0) steps[axis] = 1;
    return steps;
}

template <typename T>
gl::TexelBuffer make_texels(const std::vector<T>& texels) {
    gl::TexelBuffer buffer(sizeof(T) / sizeof(std::uint32_t), texels.size());
    buffer.write(std::span(texels));
    return buffer;
}

}  // namespace

gl::Defines walk_defines(const ProjectPlan& plan, const GlProjectTables& tables, bool copies) {
    gl::Defines defines = project_defines(plan, FragmentKind::plain);
    if (copies) defines.set("COPIES", 1);
    tables.set_defines(defines);
    return defines;
}

PixelArea EntryTiles::area_of(const Triangle& face, const WindowView& window) {
    constexpr double margin = 1;      // pixel: more than rounding and ray_perturbation()
    constexpr double edge_on = 1e-7;  // sine of an angle: more than these
    const View& view = window.view();
    const PixelArea everywhere{0, view.width - 1, 0, view.height - 1}, nowhere{0, -1, 0, -1};
    const glm::dvec3 normal = glm::cross(face[1] - face[0], face[2] - face[0]);  // outwards
    std::array<glm::dvec3, 3> seen;
    for (std::size_t i = 0; i < 3; ++i) seen[i] = window.see(face[i]);
    const auto in_front = [](const glm::dvec3& p) { return p.z > 0; };
    const bool front = std::ranges::all_of(seen, in_front);
    if (window.perspective() && !front && std::ranges::any_of(seen, in_front)) return everywhere;
    const glm::dvec3 to_face = window.perspective() ? face[0] - view.eye : view.forward;
    const double sign = window.perspective() && !front ? -1 : 1;
    if (sign * glm::dot(normal, to_face) > edge_on * glm::length(normal) * glm::length(to_face))
        return nowhere;
    glm::dvec2 least(INFINITY), most(-INFINITY);
    for (const glm::dvec3& p : seen) {
        const glm::dvec2 place = window.to_window(p);
        least = glm::min(least, place);
        most = glm::max(most, place);
    }
    const auto pixel = [](double place, std::int32_t count) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(place), -1.0, static_cast<double>(count)));
    };
    return common_pixels({pixel(least.x - margin, view.width), pixel(most.x + margin, view.width),
                          pixel(view.height - most.y - margin, view.height),
                          pixel(view.height - least.y + margin, view.height)},
                         everywhere);
}

void WalkPace::took(double ms, bool too_few) {
    if (!std::exchange(begun_, true)) return;
    if (ms > most_ms) {
        rounds_ = std::max(rounds_ / 4, least_rounds);
    } else if (too_few && ms < wanted_ms) {
        const double longer = std::min(wanted_ms / ms, 4.0) * rounds_;
        rounds_ = static_cast<int>(std::min<double>(longer, most_rounds));
    }
}

void EntryTiles::list(const TetMesh& mesh, std::span<const TetFace> open_faces, const View& view,
                      std::uint32_t most, const std::string& renderer) {
    const WindowView window(view);
    areas_.resize(open_faces.size());
    parallel_for(std::ssize(open_faces), 1024, [&](std::int64_t i) {
        const auto face = static_cast<std::size_t>(i);
        areas_[face] = area_of(mesh.corners(open_faces[face]), window);
    });
    const std::size_t places = TileLists::list(
        areas_, view.width, view.height, most,
        [](std::size_t face, int, int) { return static_cast<std::uint32_t>(face); });
    if (places > most) {
        fail(
            "mesh: found {} places where rays may enter by a face, in tiles of an image of {} x {} "
            "pixels, expected at most {}, which {} allows; use fewer pixels or --context cpu",
            places, view.width, view.height, most, renderer);
    }
}

GlMeshWalk::GlMeshWalk(const SceneMesh& mesh, const TransferFunction& transfer_function,
                       const ProjectPlan& plan, int width, int height,
                       std::shared_ptr<VisibilityOrder> order)
    : ProjectRenderer(mesh, transfer_function, plan, std::move(order)),
      height_(height),
      center_(0.5 * mesh.mesh.bounds().min + 0.5 * mesh.mesh.bounds().max),
      place_steps_(steps_to(mesh.mesh.bounds().max - center_)),
      tables_(transfer_function_, plan_),
      program_("projection/walk.comp", walk_defines(plan_, tables_, mesh.mesh.has_copies())),
      picture_(PixelPacking::floats, width, height),
      most_tiles_(most_tiles_of(gl::current_context()->capabilities())),
      pace_(rounds_of(plan_, tables_.intervals())) {
    const std::size_t tiles = EntryTiles::count(width) * EntryTiles::count(height);
    rays_ = gl::Buffer(std::min(most_tiles_, tiles) * bytes_of_tile);
    unfinished_ = gl::Buffer::make_readable(sizeof(std::uint32_t));
    const Stage uploading("upload mesh");
    upload_tets();
    upload_points();
    upload_faces();
    // Else the first dispatch would wait for what a GPU has yet to copy.
    if (!gl::current_context()->capabilities().software) gl::api().Finish();
}

// Marks the tets that show nothing, and lists the faces by which rays enter. Rays leave the mesh at
// marked tets and enter it behind them if that costs fewer faces than it saves tets.
std::vector<char> GlMeshWalk::choose_faces() {
    const TetMesh& mesh = mesh_.mesh;
    const auto& values = mesh_.scalar.values;
    std::vector<char> hidden(mesh.tets().size());
    parallel_for(std::ssize(mesh.tets()), 4096, [&](std::int64_t index) {
        const auto i = static_cast<std::size_t>(index);
        const TetPieces::Span span = plan_.draw_transparent
                                         ? pieces_.met(values, mesh.tets()[i])
                                         : pieces_.visible(values, mesh.tets()[i]);
        hidden[i] = span.empty() ? 1 : 0;
    });
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        for (std::size_t face = 0; face < 4 && hidden[i] == 0; ++face) {
            const std::int32_t behind = mesh.neighbors()[i][face];
            if (behind == TetMesh::no_neighbor || hidden[static_cast<std::size_t>(behind)] != 0)
                faces_.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(face)});
        }
    }
    const auto hidden_tets = std::ranges::count(hidden, 1);
    tets_drawn_ = std::ssize(hidden) - hidden_tets;
    around_hidden_ =
        !faces_.empty() && std::ssize(faces_) - std::ssize(mesh.open_faces()) < hidden_tets;
    if (!around_hidden_) faces_.assign(mesh.open_faces().begin(), mesh.open_faces().end());
    return hidden;
}

void GlMeshWalk::upload_tets() {
    const TetMesh& mesh = mesh_.mesh;
    const std::vector<char> hidden = choose_faces();
    std::vector<std::uint32_t> combined(mesh.tets().size());
    std::vector<Texel> neighbors(mesh.tets().size()), corners;
    if (mesh.has_copies()) corners.resize(mesh.tets().size());
    parallel_for(std::ssize(mesh.tets()), 4096, [&](std::int64_t index) {
        const auto i = static_cast<std::size_t>(index);
        const Tet places = mesh.place(mesh.tets()[i]);
        combined[i] = static_cast<std::uint32_t>(places[0] ^ places[1] ^ places[2] ^ places[3]) |
                      (hidden[i] != 0 ? hidden_tet : 0);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const auto below = static_cast<std::size_t>(std::ranges::count_if(
                places, [&](std::int32_t other) { return other < places[corner]; }));
            const std::int32_t behind = mesh.neighbors()[i][corner];
            const bool ends = behind == TetMesh::no_neighbor ||
                              (around_hidden_ && hidden[static_cast<std::size_t>(behind)] != 0);
            neighbors[i][below] = static_cast<std::uint32_t>(ends ? TetMesh::no_neighbor : behind);
            if (!corners.empty())
                corners[i][below] = static_cast<std::uint32_t>(mesh.tets()[i][corner]);
        }
    });
    tets_ = make_texels(combined);
    neighbors_ = make_texels(neighbors);
    if (!corners.empty()) corners_ = make_texels(corners);
}

void GlMeshWalk::upload_points() {
    const TetMesh& mesh = mesh_.mesh;
    const auto& values = mesh_.scalar.values;
    const double per_scalar = 1 / (plan_.range.hi - plan_.range.lo);
    std::vector<Texel> texels(mesh.points().size());
    for (std::size_t i = 0; i < mesh.points().size(); ++i) {
        const glm::dvec3 place = (mesh.points()[i] - center_) / place_steps_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Points without tets may lie beyond the box.
            const double steps = std::clamp(place[static_cast<int>(axis)], -0x1p31, 0x1p31 - 1);
            texels[i][axis] = static_cast<std::uint32_t>(std::llrint(steps));
        }
        // Tets with a scalar that is not finite are hidden, but rays pass them.
        const double scalar =
            std::isfinite(values[i]) ? (values[i] - plan_.range.lo) * per_scalar : 0;
        texels[i][3] = std::bit_cast<std::uint32_t>(static_cast<float>(scalar));
    }
    points_ = make_texels(texels);
    for (std::size_t i = 0; i < gradients_.at_points.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            texels[i][axis] =
                std::bit_cast<std::uint32_t>(gradients_.at_points[i][static_cast<int>(axis)]);
    }
    if (plan_.lighting) gradient_texels_ = make_texels(texels);
}

void GlMeshWalk::upload_faces() {
    const TetMesh& mesh = mesh_.mesh;
    std::vector<Texel> texels(faces_.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const TetFace& face = faces_[i];
        const auto of_face =
            corners_of_face(mesh.place(mesh.tets()[static_cast<std::size_t>(face.tet)]),
                            static_cast<std::size_t>(face.face));
        for (std::size_t corner = 0; corner < 3; ++corner)
            texels[i][corner] = static_cast<std::uint32_t>(of_face[corner]);
        texels[i][3] = static_cast<std::uint32_t>(face.tet);
    }
    open_faces_ = make_texels(texels);
}

void GlMeshWalk::upload_tiles() {
    if (entries_.tiles.empty()) return;
    tiles_.reserve(4, entries_.tiles.size());
    listed_faces_.reserve(1, entries_.entries.size());
    tiles_.write(std::span(entries_.tiles));
    listed_faces_.write(std::span(entries_.entries));
}

void GlMeshWalk::set_view(const View& view) {
    const View in_units = seeing_in_units(view, plan_.unit);
    tables_.bind(program_);
    const std::array axes{view.right, view.up, view.forward};
    program_.set("view_axes", std::span<const glm::dvec3>(axes));
    const glm::dvec3 from_eye = plan_.unit * (center_ - view.eye);
    const glm::dvec3 center(glm::dot(from_eye, view.right), glm::dot(from_eye, view.up),
                            glm::dot(from_eye, view.forward));
    program_.set("mesh_center", center);
    program_.set("image_middle", 0.5 * glm::dvec2(view.width, view.height));
    program_.set("image_size", glm::ivec2(view.width, view.height));
    program_.set("pixel_size", in_units.pixel);
    program_.set("ray_perturbation", ray_perturbation(view));
    program_.set("near_depth", plan_.near_depth - center.z);
    program_.set("place_steps", place_steps_ * plan_.unit);
    if (plan_.lighting) set_lit_view(*plan_.lighting, gradients_, plan_.most_bend, program_);
    using Tables = std::initializer_list<std::pair<const char*, const gl::TexelBuffer*>>;
    unsigned unit = mesh_unit, binding = mesh_binding;
    const auto bind = [&](const Tables& tables, bool blocks) {
        for (const auto& [name, table] : tables) {
            if (blocks) {
                table->bind_storage(binding++);
                continue;
            }
            table->bind(unit);
            program_.set(name, static_cast<int>(unit++));
        }
    };
    bind({{"tets", &tets_},
          {"neighbors", &neighbors_},
          {"points", &points_},
          {"corners", &corners_},
          {"gradients", &gradient_texels_}},
         plan_.blocks);
    bind({{"open_faces", &open_faces_}, {"tiles", &tiles_}, {"listed_faces", &listed_faces_}},
         false);
    program_.set("picture_row", picture_.row_words() / words_of(PixelPacking::floats));
    picture_.bind(0, 0, height_);
    rays_.bind_storage(1);
    unfinished_.bind_storage(2);
}

void GlMeshWalk::draw(const View& view, Progress* progress) {
    Stage listing("geometry");
    const Capabilities& capabilities = gl::current_context()->capabilities();
    entries_.list(mesh_.mesh, faces_, view,
                  static_cast<std::uint32_t>(capabilities.max_buffer_texels),
                  capabilities.renderer);
    upload_tiles();
    list_ms_ = listing.end();
    Stage drawing("draw");
    timeline_.begin("draw");
    picture_.clear();
    if (!entries_.tiles.empty()) set_view(view);
    for (std::size_t first = 0; first < entries_.tiles.size(); first += most_tiles_) {
        const std::size_t count = std::min(most_tiles_, entries_.tiles.size() - first);
        program_.set("first_tile", static_cast<int>(first));
        std::uint32_t unfinished = 1;
        for (int begins = 1; unfinished > 0; begins = 0) {
            const Stopwatch watch;
            program_.set("begins", begins);
            program_.set("rounds", pace_.rounds());
            unfinished_.clear();
            program_.dispatch(static_cast<int>(count));
            counting_.take(unfinished_);
            unfinished = counting_.values<std::uint32_t>().front();
            if (!capabilities.software)
                pace_.took(watch.milliseconds(), begins == 1 && unfinished > 0);
            check_interrupt();
        }
    }
    timeline_.end();
    if (entries_.tiles.empty()) gl::api().Finish();  // else the last dispatch was waited for
    gl::check("walking through a mesh");
    if (progress != nullptr) progress->advance();
    drawing.count("tets", static_cast<double>(tets_drawn_));
    draw_ms_ = drawing.end();
    timeline_.collect();
}

void GlMeshWalk::read(Image& image) const {
    picture_.read(image, 1);
}

std::map<std::string, double> GlMeshWalk::stages_ms() const {
    return {{"tables", table_ms_}, {"geometry", list_ms_}, {"draw", draw_ms_}};
}

}  // namespace lamina
