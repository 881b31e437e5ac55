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

// Kinds of controls, one for each kind of a key's values.
enum class SettingKind {
    fixed,   // a single value
    flag,    // true or false
    choice,  // one of `words`
    whole,   // a whole number
    number,
    text,     // a name or a path
    factors,  // factors of a tree: a list, a number or a text
    vector,   // several numbers
    color,
    group,  // an object
    list,   // of objects
    either  // a text or a group, told apart by the value
};

// A key of the scene file with its possible values, from docs/scene.schema.json.
struct SettingNode {
    std::string key;          // the last part of the path; empty for elements of lists
    std::string path;         // "render.slice.samples", "clip.planes[].point"
    std::string description;  // may be empty
    SettingKind kind = SettingKind::fixed;
    bool required = false;   // in the object that contains it
    bool automatic = false;  // may be "auto", or the word automatic_word
    std::string automatic_word;
    double least = -std::numeric_limits<double>::infinity();  // limits of a number, or of each
                                                              // number of a vector
    double most = std::numeric_limits<double>::infinity();
    bool least_excluded = false, most_excluded = false;
    bool whole = false;                         // a vector has whole numbers
    std::size_t count = 0;                      // numbers of a vector; largest size of a list, or 0
    std::size_t least_count = 0;                // smallest size of a list
    nlohmann::ordered_json otherwise;           // value if the key is missing; null: not documented
    std::vector<nlohmann::ordered_json> words;  // possible values of a choice
    std::vector<SettingNode> parts;  // keys of a group, element of a list, or alternatives
};

// Returns the text of docs/scene.schema.json.
std::string_view scene_schema();

// Returns the group of all keys of scene files, read from the schema.
const SettingNode& scene_keys();

std::vector<std::string> paths_below(const SettingNode& node);

// Returns the node of a path without indices, such as "clip.planes[].point"; it must exist.
const SettingNode& scene_key(std::string_view path);

// Returns why a key has no effect in this scene ("counts with the target emulated"); empty if it
// may have one. `path` is that of a SettingNode.
std::string why_without_effect(const Scene& scene, std::string_view path);

// Returns the contents of the scene's file with every key written out. The transfer function is
// "auto" in it: it has an editor of its own.
nlohmann::ordered_json settings_of(const Scene& scene);

// Returns the scene with another value of a key. `path`: as in settings_of(), with indices of list
// elements: "clip.planes.0.normal". The value null removes the key. Throws Error if the scene would
// be invalid.
Scene with_setting(const Scene& scene, const std::string& path,
                   const nlohmann::ordered_json& value);

// Returns the value at a path of settings_of(); null if there is none.
nlohmann::ordered_json setting_at(const nlohmann::ordered_json& settings, const std::string& path);

// Converts a colour to the numbers of another space. Components above 1 stay as they are.
glm::dvec3 converted_color(const glm::dvec3& color, ImageColorSpace from, ImageColorSpace to);

}  // namespace lamina::view
