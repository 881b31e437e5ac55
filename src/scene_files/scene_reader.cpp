// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_reader.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/text.h"
#include "scene/camera.h"
#include "scene_files/json_reader.h"
#include "scene_files/scene_keys.h"

namespace lamina {
namespace {

std::vector<std::string> parts_of(const std::string& key) {
    // The parts of a key make nested objects, which are held to the depth limit of files.
    const auto count = static_cast<std::size_t>(std::ranges::count(key, '.')) + 1;
    if (count > most_json_depth) {
        throw UsageError(fmt::format("--set {}: found {} parts between dots, expected at most {}",
                                     shortened(key), count, most_json_depth));
    }
    std::vector<std::string> parts;
    std::size_t start = 0;
    while (true) {
        const std::size_t dot = std::min(key.find('.', start), key.size());
        parts.push_back(key.substr(start, dot - start));
        if (parts.back().empty()) {
            throw UsageError(fmt::format("--set {}: expected KEY=VALUE, as in render.target=fixed8",
                                         shortened(key)));
        }
        if (dot == key.size()) return parts;
        start = dot + 1;
    }
}

// Returns `text` parsed as JSON, or the text itself where it is none.
nlohmann::json value_of(const std::string& key, const std::string& text) {
    try {
        return parse_json(text);
    } catch (const JsonSyntaxError&) {
        return text;
    } catch (const Error& error) {
        throw UsageError(fmt::format("--set {}: {}", shortened(key), error.what()));
    }
}

}  // namespace

Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 GivenData given) {
    JsonReader reader(document, file);
    reader.context.volume_given = given == GivenData::volume;
    reader.context.mesh_given = given == GivenData::mesh;
    Scene scene;
    scene.file = file;
    scene_keys().read(reader, scene);
    try {
        if (scene.camera.is_given()) View(*scene.camera, scene.width, scene.height);
    } catch (const Error& error) {
        throw KeyError("camera", fmt::format("{}: {}", file.string(), error.what()));
    }
    return scene;
}

void set_key(nlohmann::json& document, const std::string& key, const std::string& value) {
    nlohmann::json set = value_of(key, value);
    if (set.is_null()) return remove_key(document, key);
    nlohmann::json* node = &document;
    for (const std::string& part : parts_of(key)) {
        if (node->is_array()) {
            const bool number =
                part.find_first_not_of("0123456789") == std::string::npos && part.size() < 9;
            if (!number || std::stoul(part) >= node->size()) {
                throw UsageError(
                    fmt::format("--set {}: found \"{}\", expected the number of one of {} elements",
                                shortened(key), shortened(part), node->size()));
            }
            node = &(*node)[std::stoul(part)];
        } else if (node->is_object()) {
            node = &(*node)[part];
        } else if (node->is_null()) {
            *node = nlohmann::json::object();
            node = &(*node)[part];
        } else {
            throw UsageError(fmt::format("--set {}: \"{}\" is not inside an object", shortened(key),
                                         shortened(part)));
        }
    }
    *node = std::move(set);
}

void remove_key(nlohmann::json& document, const std::string& key) {
    nlohmann::json::json_pointer place;
    for (const std::string& part : parts_of(key)) place /= part;
    if (!document.contains(place)) return;
    nlohmann::json& parent = document[place.parent_pointer()];
    if (parent.is_array())
        parent.erase(std::stoul(place.back()));
    else
        parent.erase(place.back());
}

}  // namespace lamina
