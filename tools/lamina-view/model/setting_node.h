// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

}  // namespace lamina::view
