// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_json.h"

#include <nlohmann/json.hpp>

#include "scene_files/clip_json.h"
#include "scene_files/lighting_json.h"
#include "scene_files/volume_selection_json.h"

namespace lamina {

using Json = nlohmann::ordered_json;

namespace {

Json vector_json(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

std::string path_text(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).string();
}

Json volume_json(const Scene& scene) {
    if (!scene.volume_request) {
        return volume_selection_json(path_text(scene.volume_file), scene.volume_selection);
    }
    const GeneratorRequest& request = *scene.volume_request;
    Json volume{{"generate", request.name}, {"type", name_of(request.type)}};
    if (request.size) volume["size"] = *request.size;
    return volume;
}

Json mesh_json(const Scene& scene) {
    if (!scene.mesh_request) {
        if (scene.mesh_time == 0) return path_text(scene.mesh_file);
        return {{"path", path_text(scene.mesh_file)}, {"time", scene.mesh_time}};
    }
    const MeshSettings& settings = *scene.mesh_request;
    return {{"tolerance", settings.tolerance},
            {"max_tets", settings.max_tets},
            {"kuhn", settings.kuhn}};
}

}  // namespace

Json transfer_function_json(const TransferFunction& transfer_function) {
    Json points = Json::array();
    for (const TransferKnot& knot : transfer_function.knots()) {
        points.push_back({{"value", knot.value},
                          {"color", vector_json(knot.optics.color)},
                          {"extinction", knot.optics.extinction}});
        if (knot.smooth) points.back()["smooth"] = true;
    }
    return {{"points", points}};
}

Json camera_json(const Camera& camera) {
    return {{"projection", name_of(camera.projection)},
            {"eye", vector_json(camera.eye)},
            {"center", vector_json(camera.center)},
            {"up", vector_json(camera.up)},
            {"fov_y", camera.fov_y},
            {"height", camera.height}};
}

namespace {

Json emulate_json(const Emulation& emulation) {
    return {{"bits", emulation.bits},
            {"alpha", name_of(emulation.alpha)},
            {"over", name_of(emulation.over)},
            {"seed", emulation.seed}};
}

Json tree_json(const TreeSettings& tree) {
    if (tree.automatic) return "auto";
    return {{"factors", tree.factors},
            {"nodes", name_of(tree.nodes)},
            {"code", name_of(tree.code)},
            {"alpha_bits", tree.alpha_bits}};
}

Json dither_json(const DitherSettings& dither) {
    Json json{{"seed", dither.seed}, {"color", dither.color}, {"increment", dither.increment}};
    json["period"] = dither.period ? Json(*dither.period) : Json("auto");
    return json;
}

Json slice_json(const SliceSettings& slice) {
    Json json{{"samples", slice.samples ? Json(*slice.samples) : Json("auto")},
              {"classification", name_of(slice.classification)},
              {"order", name_of(slice.order)},
              {"filter", name_of(slice.filter)}};
    if (slice.dither) json["dither"] = dither_json(*slice.dither);
    if (slice.tree) json["tree"] = tree_json(*slice.tree);
    if (slice.table) {
        json["table"] = {{"scalar", slice.table->scalars},
                         {"length", slice.table->lengths},
                         {"max_length", slice.table->max_length}};
    }
    return json;
}

Json project_json(const ProjectSettings& project) {
    Json json{{"coloring", name_of(project.coloring)},
              {"interpolation", name_of(project.interpolation)},
              {"thickness", name_of(project.thickness)},
              {"order", name_of(project.order)},
              {"geometry", name_of(project.geometry)},
              {"dither", name_of(project.dither)}};
    if (project.table) {
        const TableSettings& table = *project.table;
        json["table"] = {{"scalar", table.scalar},
                         {"length", table.length},
                         {"mapping", name_of(table.mapping)},
                         {"store", name_of(table.store)},
                         {"format", name_of(table.format)},
                         {"construction", name_of(table.construction)}};
    }
    if (project.tree) json["tree"] = tree_json(*project.tree);
    return json;
}

Json render_json(const Scene& scene) {
    return {{"method", name_of(scene.method)},
            {"target", scene.automatic_target ? "auto" : name_of(scene.target)},
            {"emulate", emulate_json(scene.emulate)},
            {"max_error", scene.max_error},
            {"slice", slice_json(scene.slice)},
            {"project", project_json(scene.project)},
            {"trace", {{"of", name_of(scene.trace_of)}, {"tolerance", scene.trace_tolerance}}}};
}

}  // namespace

Json scene_json(const Scene& scene) {
    Json json{{"version", 1}};
    if (scene.has_volume()) json["volume"] = volume_json(scene);
    if (scene.has_mesh()) json["mesh"] = mesh_json(scene);
    if (!scene.scalar.empty()) json["scalar"] = scene.scalar;
    json["nan"] = name_of(scene.nan);
    json["transfer_function"] = scene.automatic_transfer_function
                                    ? Json("auto")
                                    : transfer_function_json(scene.transfer_function);
    json["camera"] = scene.automatic_camera ? Json("auto") : camera_json(scene.camera);
    if (!scene.clip.keeps_all()) json["clip"] = clip_json(scene.clip);
    if (scene.lighting) json["lighting"] = lighting_json(*scene.lighting);
    json["image"] = {{"width", scene.width},
                     {"height", scene.height},
                     {"color_space", name_of(scene.color_space)},
                     {"background", vector_json(scene.background)}};
    json["render"] = render_json(scene);
    return json;
}

}  // namespace lamina
