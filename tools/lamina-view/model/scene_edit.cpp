// SPDX-License-Identifier: Apache-2.0
#include "model/scene_edit.h"

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include "lamina/color.h"
#include "lamina/error.h"
#include "lamina/scene_text.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> parts_of(const std::string& path) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= path.size();) {
        const std::size_t dot = std::min(path.find('.', start), path.size());
        parts.push_back(path.substr(start, dot - start));
        start = dot + 1;
    }
    return parts;
}

bool is_number(const std::string& part) {
    return !part.empty() &&
           std::ranges::all_of(part, [](unsigned char c) { return std::isdigit(c) != 0; });
}

Json* step_into(Json& node, const std::string& part) {
    if (is_number(part)) {
        const std::size_t number = std::stoul(part);
        return node.is_array() && number < node.size() ? &node[number] : nullptr;
    }
    if (node.is_null()) node = Json::object();
    return node.is_object() ? &node[part] : nullptr;
}

void set_at(Json& settings, const std::string& path, const Json& value) {
    const std::vector<std::string> parts = parts_of(path);
    Json* node = &settings;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        node = step_into(*node, parts[i]);
        if (node == nullptr) throw Error(path + ": there is no " + parts[i]);
    }
    if (!value.is_null()) {
        Json* const place = step_into(*node, parts.back());
        if (place == nullptr) throw Error(path + ": there is no " + parts.back());
        *place = value;
    } else if (node->is_array() && is_number(parts.back())) {
        const std::size_t number = std::stoul(parts.back());
        if (number < node->size()) node->erase(number);
    } else if (node->is_object()) {
        node->erase(parts.back());
    }
}

// Everything is drawn as it was, up to mixtures of colours.
void convert_colors(Scene& scene, ImageColorSpace from) {
    const ImageColorSpace to = scene.color_space;
    scene.background = converted_color(scene.background, from, to);
    if (!scene.lighting) return;
    for (Light& light : scene.lighting->lights)
        light.color = converted_color(light.color, from, to);
}

}  // namespace

Json settings_of(const Scene& scene) {
    Scene copy = scene;
    copy.transfer_function = automatic;
    copy.given_transfer.reset();
    return Json::parse(scene_text(copy));
}

Scene with_setting(const Scene& scene, const std::string& path, const Json& value) {
    Json settings = settings_of(scene);
    set_at(settings, path, value);
    Scene changed = parse_scene(settings.dump(), scene.file);
    changed.transfer_function = scene.transfer_function;
    changed.given_transfer = scene.given_transfer;
    if (changed.color_space != scene.color_space) convert_colors(changed, scene.color_space);
    return changed;
}

Json setting_at(const Json& settings, const std::string& path) {
    const Json* node = &settings;
    for (const std::string& part : parts_of(path)) {
        if (node->is_array() && is_number(part) && std::stoul(part) < node->size())
            node = &(*node)[std::stoul(part)];
        else if (node->is_object() && node->contains(part))
            node = &node->at(part);
        else
            return {};
    }
    return *node;
}

glm::dvec3 converted_color(const glm::dvec3& color, ImageColorSpace from, ImageColorSpace to) {
    if (from == to) return color;
    const glm::dvec3 display = display_of_color(color, from);
    glm::dvec3 converted = color_of_display(display, to);
    for (int c = 0; c < 3; ++c)
        if (color[c] > 1) converted[c] = color[c];
    return converted;
}

}  // namespace lamina::view
