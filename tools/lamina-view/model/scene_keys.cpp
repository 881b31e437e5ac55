// SPDX-License-Identifier: Apache-2.0
#include "model/scene_keys.h"

#include <algorithm>
#include <stdexcept>

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

// Reads nodes from the schema. It knows what the schema has, and throws std::logic_error for
// anything else: a new kind of key needs a control of its own.
class SchemaReader {
  public:
    explicit SchemaReader(const Json& schema) : schema_(schema) {}

    SettingNode node(const Json& given, const std::string& path, const std::string& key) const {
        SettingNode node;
        node.path = path;
        node.key = key;
        fill(given, node);
        return node;
    }

  private:
    void fill(const Json& given, SettingNode& node) const {
        if (given.contains("$ref")) fill_reference(given.at("$ref").get<std::string>(), node);
        if (given.contains("description")) node.description = given.at("description");
        if (given.contains("default")) node.otherwise = given.at("default");
        if (given.contains("$ref")) return;
        if (given.contains("oneOf")) return fill_alternatives(given.at("oneOf"), node);
        if (given.contains("const")) {
            node.kind = SettingKind::fixed;
            node.words = {given.at("const")};
        } else if (given.contains("enum")) {
            node.kind = SettingKind::choice;
            node.words = given.at("enum").get<std::vector<Json>>();
        } else {
            fill_type(given.at("type").get<std::string>(), given, node);
        }
    }

    void fill_reference(const std::string& name, SettingNode& node) const {
        const std::string word = name.substr(std::string("#/$defs/").size());
        fill(schema_.at("$defs").at(word), node);
        if (word == "color") {
            node.kind = SettingKind::color;
            node.parts.clear();
        }
    }

    void fill_type(const std::string& type, const Json& given, SettingNode& node) const {
        if (type == "boolean") {
            node.kind = SettingKind::flag;
        } else if (type == "string") {
            node.kind = SettingKind::text;
        } else if (type == "integer" || type == "number") {
            node.kind = type == "integer" ? SettingKind::whole : SettingKind::number;
            fill_limits(given, node);
        } else if (type == "object") {
            fill_group(given, node);
        } else if (type == "array") {
            fill_array(given, node);
        } else {
            throw std::logic_error("scene schema: no control for the type " + type);
        }
    }

    static void fill_limits(const Json& given, SettingNode& node) {
        node.least_excluded = given.contains("exclusiveMinimum");
        node.most_excluded = given.contains("exclusiveMaximum");
        const char* const least = node.least_excluded ? "exclusiveMinimum" : "minimum";
        const char* const most = node.most_excluded ? "exclusiveMaximum" : "maximum";
        node.least = given.value(least, node.least);
        node.most = given.value(most, node.most);
    }

    void fill_group(const Json& given, SettingNode& node) const {
        node.kind = SettingKind::group;
        const Json required = given.value("required", Json::array());
        for (const auto& [key, value] : given.at("properties").items()) {
            const std::string path = node.path.empty() ? key : node.path + "." + key;
            node.parts.push_back(this->node(value, path, key));
            node.parts.back().required =
                std::find(required.begin(), required.end(), Json(key)) != required.end();
        }
    }

    void fill_array(const Json& given, SettingNode& node) const {
        const Json& items = given.at("items");
        node.count = given.value("maxItems", std::size_t{0});
        node.least_count = given.value("minItems", std::size_t{0});
        if (items.value("type", "") == "object") {
            node.kind = SettingKind::list;
            node.parts.push_back(this->node(items, node.path + "[]", ""));
        } else {
            node.kind = SettingKind::vector;
            node.whole = items.value("type", "") == "integer";
            fill_limits(items, node);
        }
    }

    void fill_alternatives(const Json& alternatives, SettingNode& node) const {
        std::vector<Json> others;
        for (const Json& one : alternatives) {
            if (one.contains("const") && one.at("const").is_string()) {
                node.automatic = true;
                node.automatic_word = one.at("const");
            } else {
                others.push_back(one);
            }
        }
        if (others.size() == 1) {
            const Json otherwise = node.otherwise;
            const std::string description = node.description;
            fill(others.front(), node);
            if (!otherwise.is_null()) node.otherwise = otherwise;
            if (!description.empty()) node.description = description;
        } else if (is_factors(others)) {
            node.kind = SettingKind::factors;
        } else {
            node.kind = SettingKind::either;
            for (const Json& one : others)
                node.parts.push_back(this->node(one, node.path, node.key));
        }
    }

    // A list of factors, one, or a text.
    static bool is_factors(const std::vector<Json>& alternatives) {
        return std::ranges::any_of(alternatives, [](const Json& one) {
            return one.value("$ref", "") == "#/$defs/factor";
        });
    }

    const Json& schema_;
};

void add_paths(const SettingNode& node, std::vector<std::string>& paths) {
    for (const SettingNode& part : node.parts) {
        if (part.path != node.path) paths.push_back(part.path);
        add_paths(part, paths);
    }
}

const SettingNode* find(const SettingNode& node, std::string_view path) {
    for (const SettingNode& part : node.parts) {
        if (part.path == path) return &part;
        if (const SettingNode* const found = find(part, path)) return found;
    }
    return nullptr;
}

}  // namespace

const SettingNode& scene_keys() {
    static const SettingNode keys = [] {
        // Keys keep their order: related ones stand together there.
        const auto ordered = Json::parse(scene_schema());
        return SchemaReader(ordered).node(ordered, "", "");
    }();
    return keys;
}

std::vector<std::string> paths_below(const SettingNode& node) {
    std::vector<std::string> paths;
    add_paths(node, paths);
    return paths;
}

const SettingNode& scene_key(std::string_view path) {
    const SettingNode* const found = find(scene_keys(), path);
    if (found == nullptr) throw std::logic_error("no key " + std::string(path) + " in the schema");
    return *found;
}

}  // namespace lamina::view
