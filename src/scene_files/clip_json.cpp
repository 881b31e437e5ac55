// SPDX-License-Identifier: Apache-2.0
#include "scene_files/clip_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/largest_scene_coordinate.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

glm::dvec3 read_place(JsonReader& reader, const char* key) {
    const glm::dvec3 place = reader.vector(key);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(place[axis]) > largest_scene_coordinate)
            reader.reject(key, "coordinates from -1e100 to 1e100");
    }
    return place;
}

ClipPlane read_plane(JsonReader reader) {
    ClipPlane plane;
    plane.point = read_place(reader, "point");
    plane.normal = reader.vector("normal");
    if (plane.normal == glm::dvec3(0))
        reader.reject("normal", "a direction [x, y, z] that is not zero");
    reader.close();
    return plane;
}

ClipBox read_box(JsonReader reader) {
    ClipBox box;
    box.min = read_place(reader, "min");
    box.max = read_place(reader, "max");
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min[axis] > box.max[axis]) {
            reader.reject("max", fmt::format("at least clip.box.min, ({}, {}, {}), on each axis",
                                             box.min.x, box.min.y, box.min.z));
        }
    }
    reader.close();
    return box;
}

}  // namespace

Clip read_clip(JsonReader reader) {
    Clip clip;
    if (reader.has("planes")) {
        for (JsonReader& plane : reader.objects("planes")) {
            if (clip.planes.size() == Clip::most_planes) {
                reader.fail_at("planes",
                               fmt::format("found {} planes, expected at most {}",
                                           reader.value("planes").size(), Clip::most_planes));
            }
            clip.planes.push_back(read_plane(plane));
        }
    }
    if (reader.has("box")) clip.box = read_box(reader.object("box"));
    reader.close();
    return clip;
}

Json clip_json(const Clip& clip) {
    Json json = Json::object();
    for (const ClipPlane& plane : clip.planes)
        json["planes"].push_back(
            {{"point", triple(plane.point)}, {"normal", triple(plane.normal)}});
    if (clip.box) json["box"] = {{"min", triple(clip.box->min)}, {"max", triple(clip.box->max)}};
    return json;
}

}  // namespace lamina
