// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina::view {

// The control that sets a key of the scene file.
enum class SettingKind {
    fixed,   // one value alone
    flag,    // true or false
    choice,  // one of several words or numbers
    whole,   // a whole number
    number,
    text,     // a name or a path
    factors,  // of a tree
    vector,   // so many numbers
    color,
    group,  // an object
    list,   // of objects
    either  // one of several of these, told apart by the kind of the value
};

// A key of the scene file and its values, as docs/scene.schema.json has them.
struct SettingNode {
    std::string key;          // the last part of the path; empty for elements of lists
    std::string path;         // "render.slice.samples", "clip.planes[].point"
    std::string description;  // may be empty
    SettingKind kind = SettingKind::fixed;
    bool required = false;   // where the object around it stands
    bool automatic = false;  // may be "auto", or another word in place of a value
    std::string automatic_word;
    double least = -std::numeric_limits<double>::infinity();  // of numbers, their own included
    double most = std::numeric_limits<double>::infinity();
    bool least_excluded = false, most_excluded = false;
    bool whole = false;                // of a vector's numbers
    std::size_t count = 0;             // of a vector's numbers; the most elements of a list, or 0
    std::size_t least_count = 0;       // of a list
    nlohmann::ordered_json otherwise;  // where the key is left out; null: not said
    std::vector<nlohmann::ordered_json> words;  // of a choice
    std::vector<SettingNode> parts;             // of a group; the element of a list; alternatives
};

// The text of docs/scene.schema.json.
std::string_view scene_schema();

// The group of all keys of scene files, read from the schema: each key has a node.
const SettingNode& scene_keys();

// Returns the paths below a node, without its own.
std::vector<std::string> paths_below(const SettingNode& node);

// Returns the node of a path without numbers, "clip.planes[].point"; it must exist.
const SettingNode& scene_key(std::string_view path);

// Returns why a key changes nothing in this scene ("counts with the target emulated"); empty if it
// may change something. `path` is that of a SettingNode.
std::string why_without_effect(const Scene& scene, std::string_view path);

// The contents of the scene's file, with every key written out. The transfer function, which is
// edited by itself, is "auto" in it.
nlohmann::ordered_json settings_of(const Scene& scene);

// Returns the scene with another value of a key, one of those that settings_of() has. `path` has
// the indices of list elements: "clip.planes.0.normal". null removes the key. The scene is checked
// like scene files: throws Error.
Scene with_setting(const Scene& scene, const std::string& path,
                   const nlohmann::ordered_json& value);

// Returns the value at a path of settings_of(); null if there is none.
nlohmann::ordered_json setting_at(const nlohmann::ordered_json& settings, const std::string& path);

// Converts a colour to the numbers of another space. Components above 1 are kept.
glm::dvec3 converted_color(const glm::dvec3& color, ImageColorSpace from, ImageColorSpace to);

}  // namespace lamina::view
