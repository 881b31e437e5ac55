// SPDX-License-Identifier: Apache-2.0
#include "papers/kraus.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "papers/compared_pictures.h"

namespace lamina::papers {
namespace {

constexpr double faint_opacity = 0.1;
constexpr double smooth_opacity = 0.48;  // measured on a coarse picture
constexpr double dense_opacity = 0.95;
constexpr int coarse = 4;  // divides the sides of the pictures that opacity is measured on

TransferKnot knot(double value, const glm::dvec3& color, double extinction) {
    return {value, {color, extinction}};
}

// Returns a peak of extinction: blue below `value` and orange above it, so that the two sides of an
// isosurface can be told apart.
std::vector<TransferKnot> peak(double value, double half_width) {
    const glm::dvec3 below(.1, .35, 1), above(1, .55, .1);
    return {knot(value - half_width, below, 0), knot(value, 0.5 * (below + above), 1),
            knot(value + half_width, above, 0)};
}

Camera camera(const glm::dvec3& eye, const glm::dvec3& center, double fov_y) {
    Camera made;
    made.eye = eye;
    made.center = center;
    made.up = {0, 0, 1};
    made.fov_y = fov_y;
    return made;
}

double largest_opacity(const PreciseImage& image) {
    double largest = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        largest = std::max(largest, image.rgba[i]);
    }
    return largest;
}

TransferFunction scaled(std::span<const TransferKnot> knots, double factor) {
    std::vector<TransferKnot> changed(knots.begin(), knots.end());
    for (TransferKnot& changed_knot : changed) changed_knot.optics.extinction *= factor;
    return TransferFunction::linear(std::move(changed));
}

// Returns the largest optical depth of the rays of a coarse picture, with extinctions `thin` times
// those of `knots`.
double largest_depth(study::TracedMesh& mesh, Scene scene, const std::vector<TransferKnot>& knots,
                     double thin) {
    scene.width = std::max(1, scene.width / coarse);
    scene.height = std::max(1, scene.height / coarse);
    scene.transfer_function = scaled(knots, thin);
    return -std::log1p(-largest_opacity(mesh.exact(scene)));
}

// Returns the files of an item that shows meshes one by one: NAME_MESH.csv for each, and `also`.
std::vector<std::string> files_of_meshes(const std::string& name,
                                         const std::vector<std::string>& meshes,
                                         std::vector<std::string> also = {}) {
    for (const std::string& mesh : meshes) also.push_back(name + "_" + mesh + ".csv");
    return also;
}

constexpr double graded_ratio = 1e4, bump = 0.25;
const std::vector<std::string> data_sets{"bluntfin", "combustor", "torso"};

std::filesystem::path file_of(const std::filesystem::path& data, const std::string& name) {
    return data / (name + ".vtu");
}

// Views and transfer functions of a subject. Extinctions are relative: they are scaled until the
// picture has the intended largest opacity.
struct KrausView {
    Camera camera, isosurface_camera;
    std::vector<TransferKnot> smooth, isosurface;
    double isosurface_opacity = 0.98;
};

KrausView view_of(const std::string& name) {
    KrausView view;
    if (name == "bluntfin") {
        view.camera = view.isosurface_camera = camera({-9, -12, 8}, {1.5, 3.5, 2.3}, 45);
        view.smooth = {knot(.2, {.05, .1, .6}, .1), knot(1, {.1, .4, .8}, .2),
                       knot(2, {.1, .8, .5}, .5), knot(3.5, {.9, .8, .2}, 1),
                       knot(5, {1, .2, .05}, 1.5)};
        view.isosurface = peak(1.6, .15);
    } else if (name == "combustor") {
        view.camera = camera({-3, -15, 42}, {8, 0, 30}, 45);
        view.isosurface_camera = camera({-1, -7, 35}, {9, 0, 29}, 60);
        view.smooth = {knot(.2, {.1, .2, .8}, 1), knot(.35, {.1, .7, .6}, .4),
                       knot(.5, {.9, .8, .2}, .4), knot(.71, {1, .2, .05}, 1.5)};
        view.isosurface = peak(.4, .015);
        view.isosurface_opacity = 0.9999;
    } else if (name == "torso") {
        view.camera = view.isosurface_camera = camera({450, -800, 550}, {0, 0, 295}, 45);
        view.smooth = {knot(-5000, {.05, .2, .9}, 4), knot(-600, {.1, .5, .9}, 2),
                       knot(0, {.8, .8, .8}, .3), knot(600, {.9, .4, .1}, 2),
                       knot(1800, {1, .2, 0}, 4)};
        view.isosurface = peak(-160, 130);
    } else if (name == "graded" || name == "plate") {
        view.camera = view.isosurface_camera = camera({-.25, -.6, 1.15}, {.5, .48, .05}, 45);
        view.smooth = {knot(0, {.1, .2, .9}, 0), knot(.4, {.1, .8, .5}, .4),
                       knot(1, {1, .4, .1}, 1)};
        view.isosurface = peak(.6, .1);
        // Rays that graze the bump cross the peak many times.
        view.isosurface_opacity = name == "graded" ? 0.99999 : 0.98;
    } else {
        assert(name == "box");
        view.camera = view.isosurface_camera = camera({-.6, -1.1, 1.3}, {.5, .5, .45}, 45);
        view.smooth = {knot(0, {.1, .2, .9}, .05), knot(.4, {.1, .8, .5}, .4),
                       knot(1, {1, .4, .1}, 1)};
        view.isosurface = peak(.5, .04);
    }
    return view;
}

}  // namespace

KrausSubject make_kraus_subject(study::TracedMesh mesh, const std::string& name, int width,
                                int height) {
    const KrausView view = view_of(name);
    KrausSubject subject{name, std::move(mesh), {}, {}, {}, {}};
    Scene scene;
    scene.method = Method::project;
    scene.camera = view.camera;
    scene.width = width;
    scene.height = height;
    scene.project.table = TableSettings{.store = TableStore::opacity};
    // Optical depth is proportional to extinction, so one measurement with thin extinctions gives
    // the factor for any opacity. Relative extinctions are about 1.
    const auto& bounds = subject.mesh.tets().bounds();
    const double thin = 1e-3 / glm::distance(bounds.min, bounds.max);
    const auto with = [&](const std::vector<TransferKnot>& knots, double depth, double opacity) {
        Scene made = scene;
        made.transfer_function = scaled(knots, thin * -std::log1p(-opacity) / depth);
        return made;
    };
    const double depth = largest_depth(subject.mesh, scene, view.smooth, thin);
    subject.smooth = with(view.smooth, depth, smooth_opacity);
    subject.faint = with(view.smooth, depth, faint_opacity);
    subject.dense = with(view.smooth, depth, dense_opacity);
    scene.camera = view.isosurface_camera;
    subject.isosurface =
        with(view.isosurface, largest_depth(subject.mesh, scene, view.isosurface, thin),
             view.isosurface_opacity);
    return subject;
}

const std::vector<KrausItem>& kraus_items() {
    static const std::vector<KrausItem> items{
        {"figure7", {"figure7.csv"}, nullptr, draw_kraus_figure7},
        {"figure8", {"figure8.csv"}, nullptr, draw_kraus_figure8},
        {"figure9", {"figure9.csv"}, nullptr, draw_kraus_figure9},
        {"figure10", files_of_meshes("figure10", {"graded", "plate", "bluntfin"}), nullptr,
         draw_kraus_figure10},
        {"artifacts", {"artifacts.csv"}, nullptr, draw_kraus_artifacts},
        {"preintegration", {"preintegration.csv"}, nullptr, draw_kraus_preintegration},
        {"orders",
         files_of_meshes("orders", {"bluntfin", "combustor", "torso", "box", "graded", "plate"},
                         {"orders.csv"}),
         nullptr, draw_kraus_orders},
        {"table1", {"table1.csv"}, nullptr, draw_kraus_table1},
        {"table2", {"table2.csv"}, nullptr, draw_kraus_table2},
    };
    return items;
}

KrausStage::KrausStage(const Capabilities& capabilities, KrausSizes sizes,
                       std::filesystem::path data)
    : capabilities_(capabilities), sizes_(std::move(sizes)), data_(std::move(data)) {
    capabilities_.max_buffer_texels = 0;  // the paper's tets are drawn by the rasteriser: no walks
}

std::filesystem::path KrausStage::data_folder() {
    const char* const data = std::getenv("LAMINA_DATA");
    return data == nullptr ? std::filesystem::path() : std::filesystem::path(data);
}

bool KrausStage::has(const std::string& data_set) const {
    return !data_.empty() && std::filesystem::exists(file_of(data_, data_set));
}

KrausSubject KrausStage::make(const std::string& name) const {
    const auto mesh = [&] {
        if (name == "graded" || name == "plate")
            return study::TracedMesh(make_graded_mesh(sizes_.graded_cells, sizes_.graded_layers,
                                                      graded_ratio, name == "graded" ? bump : 0));
        if (name == "box")
            return study::TracedMesh(
                make_box_mesh({sizes_.box_cells, sizes_.box_cells, sizes_.box_cells}));
        Scene scene;
        scene.mesh = MeshFile{file_of(data_, name)};
        SceneData data;
        data.mesh(scene);
        return study::TracedMesh(std::move(data));
    };
    return make_kraus_subject(mesh(), name, sizes_.width, sizes_.height);
}

KrausSubject& KrausStage::subject(const std::string& name) {
    const bool generated = name == "graded" || name == "plate";
    const std::string there = generated || has(name) ? name : "box";
    auto& subject = subjects_[there];
    if (!subject) {
        subject = std::make_unique<KrausSubject>(make(there));
        subject->tables = tables_;
    }
    return *subject;
}

std::vector<KrausSubject*> KrausStage::subjects() {
    std::vector<KrausSubject*> found;
    for (const std::string& name : data_sets) {
        if (has(name)) found.push_back(&subject(name));
    }
    if (found.empty()) found.push_back(&subject("box"));
    for (const char* name : {"graded", "plate"}) found.push_back(&subject(name));
    return found;
}

nlohmann::ordered_json result_with_data(Findings findings, nlohmann::ordered_json values,
                                        nlohmann::ordered_json printed, const std::string& more,
                                        const KrausStage& stage,
                                        const std::vector<std::string>& data_sets,
                                        const std::string& instead) {
    std::vector<std::string> missing;
    for (const std::string& name : data_sets) {
        if (!stage.has(name)) missing.push_back(name + ".vtu");
    }
    if (!missing.empty()) findings.make_untestable();
    auto result = findings.result(std::move(values), std::move(printed), more);
    if (missing.empty()) return result;
    for (const char* const key : {"remark", "note"}) {
        result[key] =
            fmt::format("Set LAMINA_DATA to a folder that holds {}; {}. {}",
                        fmt::join(missing, ", "), instead, result[key].get<std::string>());
    }
    return result;
}

}  // namespace lamina::papers
