// SPDX-License-Identifier: Apache-2.0
#include "scene_files/tree_reader.h"

#include "base/enum_words.h"
#include "compositing/tree_shape.h"
#include "lamina/scene.h"

namespace lamina {
namespace {

// Reads a list [root, ..., leaf], or a text from the command line: 32x32, 4^5, 1024.
std::vector<int> read_factors(JsonReader& reader) {
    const std::string expected = fmt::format(
        "1 to {} bifurcation factors from 1 to {}, root first, as in [32, 32] or \"32x32\"",
        max_tree_levels, max_tree_factor);
    if (!reader.has("factors")) reader.reject("factors", expected);
    const nlohmann::json& value = reader.value("factors");
    const auto is_factor = [](const nlohmann::json& factor) {
        return factor.is_number_integer() && factor.get<double>() >= 1 &&
               factor.get<double>() <= max_tree_factor;
    };
    if (value.is_string()) {
        try {
            return parse_factors(value.get<std::string>());
        } catch (const Error&) {
            reader.reject("factors", expected);
        }
    }
    if (is_factor(value)) return {value.get<int>()};
    if (!value.is_array() || value.empty() || value.size() > max_tree_levels ||
        !std::all_of(value.begin(), value.end(), is_factor)) {
        reader.reject("factors", expected);
    }
    return value.get<std::vector<int>>();
}

TreeSettings read_object(JsonReader reader) {
    TreeSettings tree;
    tree.factors = read_factors(reader);
    tree.nodes = reader.choice<NodeArithmetic>("nodes", enum_words<NodeArithmetic>());
    tree.code = reader.choice<NodeCode>("code", enum_words<NodeCode>());
    if (reader.has("alpha_bits")) {
        if (reader.value("alpha_bits") != 8 && reader.value("alpha_bits") != 16) {
            reader.reject("alpha_bits", "8 or 16");
        }
        tree.alpha_bits = reader.value("alpha_bits").get<int>();
    }
    reader.close();
    return tree;
}

}  // namespace

std::optional<TreeSettings> read_tree(JsonReader& method) {
    if (!method.has("tree")) return {};
    if (method.value("tree") == "auto") return TreeSettings{.automatic = true, .factors = {}};
    if (!method.value("tree").is_object())
        method.reject("tree", "an object {\"factors\": ...}, or \"auto\"");
    return read_object(method.object("tree"));
}

}  // namespace lamina
