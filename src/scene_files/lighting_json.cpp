// SPDX-License-Identifier: Apache-2.0
#include "scene_files/lighting_json.h"

#include "scene/lighting_check.h"
#include "scene_files/color_json.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

Light read_light(JsonReader reader, ImageColorSpace space) {
    Light light;
    if (reader.has("direction") && reader.value("direction") != "headlight") {
        if (!reader.value("direction").is_array())
            reader.reject("direction", "\"headlight\" or three finite numbers [x, y, z]");
        light.direction = reader.vector("direction");
    }
    light.color = read_color(reader, "color", light.color, space);
    reader.close();
    return light;
}

Json vector_json(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace

std::optional<Lighting> read_lighting(JsonReader& scene, ImageColorSpace space) {
    if (!scene.has("lighting")) return std::nullopt;
    if (!scene.value("lighting").is_object())
        scene.reject("lighting", "an object {...}, or nothing for colours as they are");
    JsonReader reader = scene.object("lighting");
    Lighting lighting;
    lighting.ambient = reader.number_or("ambient", lighting.ambient);
    lighting.diffuse = reader.number_or("diffuse", lighting.diffuse);
    lighting.specular = reader.number_or("specular", lighting.specular);
    lighting.power = reader.number_or("power", lighting.power);
    if (reader.has("smallest_gradient") && reader.value("smallest_gradient") != "auto") {
        if (!reader.value("smallest_gradient").is_number())
            reader.reject("smallest_gradient", "\"auto\" or a number above 0");
        lighting.smallest_gradient = reader.number("smallest_gradient");
    }
    if (reader.has("lights")) {
        lighting.lights.clear();
        for (const JsonReader& light : reader.objects("lights"))
            lighting.lights.push_back(read_light(light, space));
    }
    reader.close();
    if (const auto mistake = mistake_in(lighting)) reader.fail_at(mistake->key, mistake->message);
    return lighting;
}

Json lighting_json(const Lighting& lighting) {
    Json lights = Json::array();
    for (const Light& light : lighting.lights) {
        lights.push_back(
            {{"direction", light.direction ? vector_json(*light.direction) : Json("headlight")},
             {"color", vector_json(light.color)}});
    }
    return {{"ambient", lighting.ambient},
            {"diffuse", lighting.diffuse},
            {"specular", lighting.specular},
            {"power", lighting.power},
            {"smallest_gradient",
             lighting.smallest_gradient ? Json(*lighting.smallest_gradient) : Json("auto")},
            {"lights", lights}};
}

}  // namespace lamina
