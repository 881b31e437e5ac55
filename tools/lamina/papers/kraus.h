// SPDX-License-Identifier: Apache-2.0
// Reproduces tables and figures of Kraus, Qiao, Ebert, "Projecting Tetrahedra without Rendering
// Artifacts", 2004.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lamina/scene.h"
#include "papers/paper_item.h"
#include "plan/capabilities.h"
#include "preintegration/preintegration_table.h"
#include "render/pipeline.h"
#include "study/data_store.h"
#include "study/study_frames.h"

namespace lamina::papers {

// A mesh with the scenes in which the reproduction of Kraus 2004 shows it: method `project`, target
// float32, and the paper's table (256 x 256 x 16, opacity, 16 bits, exact entries, octaves).
struct KrausSubject {
    std::string name;
    study::TracedMesh mesh;
    Scene smooth;      // opacity of a ray up to .5
    Scene faint;       // as `smooth`, with opacity up to .1
    Scene dense;       // as `smooth`, with opacity up to .95
    Scene isosurface;  // a sharp peak, nearly opaque; may have another camera
    // Pre-integration tables of the subject's pictures. Subjects of one KrausStage share the
    // stage's.
    std::shared_ptr<TableCache> tables = std::make_shared<TableCache>();
};

// `name`: "bluntfin", "combustor", "torso", "graded", "plate" or "box"
// (papers/compared_pictures.h).
KrausSubject make_kraus_subject(study::TracedMesh mesh, const std::string& name, int width,
                                int height);

// Functions that switch off one remedy of Kraus 2004 in a scene that has all of them.

// The first two need a scene with a table of its own.
inline Scene with_table_format(Scene scene, TableFormat format) {
    scene.project.table->format = format;
    return scene;
}
inline Scene with_mapping(Scene scene, LengthMapping mapping) {
    scene.project.table->mapping = mapping;
    return scene;
}
inline Scene with_default_integration(Scene scene) {
    scene.project.table = automatic;
    return scene;
}

inline Scene with_linear_interpolation(Scene scene) {
    scene.project.interpolation = Interpolation::linear;
    return scene;
}
inline Scene with_depth_as_thickness(Scene scene) {
    scene.project.thickness = Thickness::dz;
    return scene;
}
inline Scene with_coloring(Scene scene, Coloring coloring) {
    scene.project.coloring = coloring;
    return scene;
}
inline Scene with_target(Scene scene, Target target, ProjectDither dither = ProjectDither::none) {
    scene.target = target;
    scene.project.dither = dither;
    return scene;
}
inline Scene with_geometry(Scene scene, const Auto<ProjectGeometry>& geometry) {
    scene.project.geometry = geometry;
    return scene;
}
inline Scene with_order(Scene scene, ProjectOrder order) {
    scene.project.order = order;
    return scene;
}

class KrausStage;
using KrausItem = PaperItem<KrausStage>;

// Returns the items in the paper's order, followed by items on questions that it leaves open. Data
// sets come from LAMINA_DATA. Without it, generated meshes replace them, and the paper's statements
// cannot be tested.
const std::vector<KrausItem>& kraus_items();

// Draw pairs of pictures with insets and signed differences, and measure errors against the tracer.
nlohmann::ordered_json draw_kraus_figure7(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure8(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure9(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_figure10(const std::filesystem::path& folder, KrausStage& stage);

// Measure the times of the enhancements, one after the other, and of several mesh sizes.
nlohmann::ordered_json draw_kraus_table1(const std::filesystem::path& folder, KrausStage& stage);
nlohmann::ordered_json draw_kraus_table2(const std::filesystem::path& folder, KrausStage& stage);

// Switches off every remedy in turn, on all meshes.
nlohmann::ordered_json draw_kraus_artifacts(const std::filesystem::path& folder, KrausStage& stage);

// Treat the paper's future work (section 6): numerical against analytic pre-integration, and wrong
// orders.
nlohmann::ordered_json draw_kraus_preintegration(const std::filesystem::path& folder,
                                                 KrausStage& stage);
nlohmann::ordered_json draw_kraus_orders(const std::filesystem::path& folder, KrausStage& stage);

// Sizes of pictures and generated meshes; tests use smaller ones.
struct KrausSizes {
    int width = 640, height = 480;              // of pictures and of measurements in them
    int timed_width = 800, timed_height = 600;  // as in the paper
    std::int32_t graded_cells = 24, graded_layers = 40;
    std::int32_t box_cells = 31;  // along an edge of the box that replaces data sets: 178,746 tets
    // Cells of the boxes for Table 2: 20,250 tets, and then as many tets as the paper's heat sink,
    // cylinder and X38 have.
    std::vector<std::int32_t> timed_box_cells{15, 27, 47, 69};
    int rounds = 3;
};

// Holds what the paper's items share: the current context, meshes with their traced pictures, and
// pre-integration tables.
class KrausStage {
  public:
    // Meshes of data sets are read from `data`, unless it is empty or lacks them.
    explicit KrausStage(const Capabilities& capabilities, KrausSizes sizes = {},
                        std::filesystem::path data = data_folder());

    const Capabilities& capabilities() const { return capabilities_; }
    const KrausSizes& sizes() const { return sizes_; }
    const std::shared_ptr<TableCache>& tables() const { return tables_; }

    bool has(const std::string& data_set) const;
    // Returns a subject of make_kraus_subject(), made when it is first needed. "box" replaces a
    // missing data set. "graded" has a bump and "plate" has none; both have an edge ratio of 1e4.
    KrausSubject& subject(const std::string& name);
    // Returns all subjects whose data exist (or "box" if none does), and "graded" and "plate".
    std::vector<KrausSubject*> subjects();

    static std::filesystem::path data_folder();  // LAMINA_DATA, or empty

  private:
    KrausSubject make(const std::string& name) const;
    Capabilities capabilities_;
    KrausSizes sizes_;
    std::filesystem::path data_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    std::map<std::string, std::unique_ptr<KrausSubject>> subjects_;
};

// Returns Findings::result(values, printed, more). If one of the `data_sets` that an item needs is
// missing, the note says so first, with what happens `instead`, and the paper's statements count as
// untestable.
nlohmann::ordered_json result_with_data(Findings findings, nlohmann::ordered_json values,
                                        nlohmann::ordered_json printed, const std::string& more,
                                        const KrausStage& stage,
                                        const std::vector<std::string>& data_sets,
                                        const std::string& instead);

// A scene of a mesh, prepared to be drawn again and again. The context must outlive it.
struct MeshFrame {
    MeshFrame(std::string of, const study::TracedMesh& mesh, const Scene& scene,
              const Capabilities& capabilities, std::shared_ptr<TableCache> tables)
        : name(std::move(of)),
          pipeline(std::make_unique<Pipeline>(
              scene, mesh.data(),
              PipelineOptions{.capabilities = capabilities, .tables = std::move(tables)})) {
        pipeline->set_up();
    }

    std::string name;
    std::unique_ptr<Pipeline> pipeline;
};

// Returns the frames for time_interleaved(). `frames` must not move in memory while it is used.
inline std::vector<study::TimedFrame> timed(const std::vector<MeshFrame>& frames) {
    std::vector<study::TimedFrame> all;
    for (const MeshFrame& frame : frames) {
        const auto draw = [&frame] { frame.pipeline->draw_frame(); };
        all.push_back({frame.name, draw, draw});
    }
    return all;
}

}  // namespace lamina::papers
