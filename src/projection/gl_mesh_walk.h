// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "executors/gl_pixels.h"
#include "gl/api.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "gl/timeline.h"
#include "mesh/face_tree.h"
#include "projection/gl_project_renderer.h"
#include "projection/project_renderer.h"
#include "projection/tile_lists.h"
#include "scene/camera.h"

namespace lamina {

// Lists, for each tile of a picture that a mesh covers, the open faces by which rays may enter it.
struct EntryTiles : TileLists<std::uint32_t> {
    // Lists the faces, by index into `open_faces`, for a view. Throws Error if there are more than
    // `most` entries, which the OpenGL of this name allows.
    void list(const TetMesh& mesh, std::span<const TetFace> open_faces, const View& view,
              std::uint32_t most, const std::string& renderer);

  private:
    // Bounds the pixels whose rays may enter by a face: those around its corners, or all if it
    // crosses the plane of the eye. Faces by which rays surely leave get none.
    static PixelArea area_of(const Triangle& face, const WindowView& window);

    std::vector<PixelArea> areas_;  // of each open face
};

// Chooses the rounds of a ray in one dispatch on a GPU by the time of the dispatches before:
// drivers end programs that take seconds, and a desktop stands still until a dispatch is done.
class WalkPace {
  public:
    // Most that a dispatch should take, and what is aimed at, because the next view may show more.
    static constexpr double most_ms = 100, wanted_ms = most_ms / 2;
    static constexpr int first_rounds = 1024, least_rounds = 16;

    explicit WalkPace(int rounds) : rounds_(rounds) {}
    int rounds() const { return rounds_; }
    // A dispatch with rounds() took so long. `too_few`: it was the first of its rays in a frame,
    // and left some of them to the next one. Of later ones, which draw few rays, the time says
    // nothing. The first of all is ignored: the program's first use may have cost more.
    void took(double ms, bool too_few);

  private:
    int rounds_;
    bool begun_ = false;  // the first dispatch of all is done
};

// Returns the definitions of projection/walk.comp. `copies`: TetMesh::has_copies().
gl::Defines walk_defines(const ProjectPlan& plan, const GlProjectTables& tables, bool copies);

// Draws a mesh by a compute shader that walks each ray from tet to tet
// (shaders/projection/walk.comp), in the current OpenGL context, which must outlive it. It needs no
// order of tets.
class GlMeshWalk : public ProjectRenderer {
  public:
    // The plan must have `walk`. The mesh must outlive the renderer.
    GlMeshWalk(const SceneMesh& mesh, const TransferFunction& transfer_function,
               const ProjectPlan& plan, int width, int height,
               std::shared_ptr<VisibilityOrder> order = nullptr);

    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override { return 1; }
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    ProjectReuse reusable() const override { return {order_, nullptr}; }

  private:
    std::vector<char> choose_faces();
    void upload_tets();
    void upload_points();
    void upload_faces();
    void upload_tiles();
    void set_view(const View& view);

    int height_;
    glm::dvec3 center_;       // of the mesh's box
    glm::dvec3 place_steps_;  // of points' places along the axes, in world units
    GlProjectTables tables_;
    gl::Program program_;
    GlPixels picture_;
    std::size_t most_tiles_;  // in one dispatch
    WalkPace pace_;
    std::vector<TetFace> faces_;  // by which rays enter
    bool around_hidden_ = false;  // rays leave the mesh at tets that show nothing
    EntryTiles entries_;
    gl::TexelBuffer tets_, neighbors_, corners_, points_, gradient_texels_, open_faces_;
    gl::TexelBuffer tiles_, listed_faces_;
    gl::Buffer rays_, unfinished_;
    gl::ReadBack counting_;  // of the unfinished rays
    gl::Timeline timeline_;
    double list_ms_ = 0;
};

}  // namespace lamina
