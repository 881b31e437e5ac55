// SPDX-License-Identifier: Apache-2.0
#include "model/key_effects.h"

namespace lamina::view {
namespace {

bool is_in(std::string_view path, std::string_view group) {
    return path == group ||
           (path.starts_with(group) && path.size() > group.size() && path[group.size()] == '.');
}

std::string for_camera(const Scene& scene, std::string_view path) {
    if (path == "camera") return {};
    if (scene.camera.is_automatic()) return "chosen from the data: camera is auto";
    const bool orthographic = scene.camera->projection == Projection::orthographic;
    if (path == "camera.fov_y" && orthographic) return "of perspective views";
    if (path == "camera.height" && !orthographic) return "of orthographic views";
    return {};
}

std::string for_mesh(const Scene& scene, std::string_view path) {
    if (path == "mesh") return {};
    if (!scene.has_mesh()) return "the scene has no mesh";
    if (!scene.draws_mesh()) return "the mesh is not drawn by this method";
    if (path == "scalar" && scene.mesh_file() == nullptr) return "of a mesh from a file";
    if (path == "mesh.tolerance" && scene.made_mesh() != nullptr && scene.made_mesh()->kuhn)
        return "Kuhn's split has every sample";
    return {};
}

std::string for_tree(const TreeSettings* tree, const Auto<Target>& target, std::string_view key) {
    if (tree == nullptr || (key != "code" && key != "alpha_bits")) return {};
    if (tree->nodes == NodeArithmetic::fixed) return "of nodes computed in a shader";
    if (key == "alpha_bits" && target != Target::fixed8) return "of the target fixed8";
    return {};
}

// Returns the scenes in which dithering of slabs has an effect, for a scene in which it has none:
// only slabs that are rounded to codes are dithered (docs/scene.md, "How it is drawn"). Empty if it
// has an effect.
std::string for_slice_dither(const Scene& scene) {
    const TreeSettings* const tree = given_tree(scene.slice.tree);
    if (scene.target.is_given() && !is_fixed_point(*scene.target))
        return "of the targets fixed8, fixed16 and emulated";
    if (tree != nullptr && tree->nodes == NodeArithmetic::shader)
        return "of blended slabs and fixed nodes: the tree's nodes are computed in a shader";
    return {};
}

std::string for_slice(const Scene& scene, std::string_view path) {
    constexpr std::string_view tree = "render.slice.tree.";
    if (scene.method != Method::slice) return "counts with the method slice";
    if (is_in(path, "render.slice.dither")) return for_slice_dither(scene);
    const Auto<Classification>& classification = scene.slice.classification;
    if (is_in(path, "render.slice.table") &&
        (classification == Classification::post || classification == Classification::exact))
        return "of pre-integrated segments";
    if (path.starts_with(tree))
        return for_tree(given_tree(scene.slice.tree), scene.target, path.substr(tree.size()));
    return {};
}

std::string for_project(const Scene& scene, std::string_view path) {
    constexpr std::string_view tree = "render.project.tree.";
    if (scene.method != Method::project) return "counts with the method project";
    const ProjectSettings& project = scene.project;
    if (path == "render.project.interpolation" && project.coloring == Coloring::vertex)
        return "the colouring vertex is linear always";
    if (path == "render.project.dither" && !is_fixed_point(scene.target.value_or(Target::float32)))
        return "of fixed-point targets";
    if (is_in(path, "render.project.table") && project.coloring != Coloring::preintegrated)
        return "of the colouring preintegrated";
    if (path.starts_with(tree))
        return for_tree(given_tree(project.tree), scene.target, path.substr(tree.size()));
    return {};
}

std::string for_emulate(const Scene& scene, std::string_view path) {
    if (scene.target != Target::emulated) return "counts with the target emulated";
    if (path == "render.emulate.seed" && scene.emulate.alpha != AlphaRounding::stochastic)
        return "of stochastic rounding";
    return {};
}

}  // namespace

std::string why_without_effect(const Scene& scene, std::string_view path) {
    if (is_in(path, "camera")) return for_camera(scene, path);
    if (is_in(path, "mesh") || path == "scalar") return for_mesh(scene, path);
    if (is_in(path, "render.slice")) return for_slice(scene, path);
    if (is_in(path, "render.project")) return for_project(scene, path);
    if (path == "render.trace.of" && !(scene.has_volume() && scene.has_mesh()))
        return "the scene has one kind of data alone";
    const bool traced = scene.method == Method::trace;
    if (is_in(path, "render.emulate"))
        return traced ? "the tracer computes in double precision" : for_emulate(scene, path);
    if (path == "render.target" && traced) return "the tracer computes in double precision";
    if (path == "render.max_error" && traced) return "the tracer keeps to render.trace.tolerance";
    return {};
}

}  // namespace lamina::view
