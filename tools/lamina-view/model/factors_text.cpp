// SPDX-License-Identifier: Apache-2.0
#include "model/factors_text.h"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "lamina/error.h"
#include "model/scene_keys.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

const std::optional<Auto<TreeSettings>>& tree_of(const Scene& scene) {
    return scene.method == Method::project ? scene.project.tree : scene.slice.tree;
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Returns the factors as a list, or as a text that the scene's reader understands.
Json factors_json(const std::string& text) {
    if (text.front() != '[') return text;
    Json list = Json::parse(text, nullptr, false);
    if (list.is_discarded())
        throw Error(fmt::format(
            "factors: found {}, expected a list such as [16, 8, 4], or 16x8x4, 4^5, auto, none",
            text));
    return list;
}

}  // namespace

std::string factors_text(const Scene& scene) {
    const std::optional<Auto<TreeSettings>>& tree = tree_of(scene);
    if (!tree) return "none";
    if (tree->is_automatic()) return "auto";
    return fmt::format("[{}]", fmt::join((*tree)->factors, ", "));
}

Scene with_factors(const Scene& scene, const std::string& text) {
    if (scene.method == Method::trace)
        throw Error("factors: the method trace has no tree, expected slice or project");
    const std::string path =
        scene.method == Method::project ? "render.project.tree" : "render.slice.tree";
    const std::string asked = trimmed(text);
    if (asked.empty() || asked == "none") return with_setting(scene, path, nullptr);
    if (asked == "auto") return with_setting(scene, path, asked);
    const Json factors = factors_json(asked);
    if (given_tree(tree_of(scene)) != nullptr)
        return with_setting(scene, path + ".factors", factors);
    Json group = {{"factors", factors}};
    // Trees of tets have no other nodes.
    if (scene.method == Method::project) group["nodes"] = "fixed";
    return with_setting(scene, path, group);
}

void without_tree(Scene& scene) {
    scene.slice.tree.reset();
    scene.project.tree.reset();
}

}  // namespace lamina::view
