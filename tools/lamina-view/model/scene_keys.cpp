// SPDX-License-Identifier: Apache-2.0
#include "model/scene_keys.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "lamina/color.h"
#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

// Reads nodes from the schema. Throws std::logic_error for a type that it does not know, which
// would need a new kind of control.
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
            } else if (one.value("type", "") != "boolean") {
                // true and false stand for an object with its defaults and for none.
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

    // Returns true if the alternatives are a tree's factors: a list, one factor, or a text.
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

bool is_in(std::string_view path, std::string_view group) {
    return path == group ||
           (path.starts_with(group) && path.size() > group.size() && path[group.size()] == '.');
}

std::string for_camera(const Scene& scene, std::string_view path) {
    if (path == "camera") return {};
    if (scene.camera.is_automatic()) return "chosen from the data: camera is auto";
    const bool orthographic = scene.camera->projection == Projection::orthographic;
    if (path == "camera.fov_y" && orthographic) return "of perspective views";
    if (path == "camera.height" && !orthographic) return "of orthographic views";
    return {};
}

std::string for_mesh(const Scene& scene, std::string_view path) {
    if (path == "mesh") return {};
    if (!scene.has_mesh()) return "the scene has no mesh";
    if (!scene.draws_mesh()) return "the mesh is not drawn by this method";
    if (path == "scalar" && scene.mesh_file() == nullptr) return "of a mesh from a file";
    if (path == "mesh.tolerance" && scene.made_mesh() != nullptr && scene.made_mesh()->kuhn)
        return "Kuhn's split has every sample";
    return {};
}

std::string for_tree(const TreeSettings* tree, const Auto<Target>& target, std::string_view key) {
    if (tree == nullptr || (key != "code" && key != "alpha_bits")) return {};
    if (tree->nodes == NodeArithmetic::fixed) return "of nodes computed in a shader";
    if (key == "alpha_bits" && target != Target::fixed8) return "of the target fixed8";
    return {};
}

// Returns why dithering of slabs has no effect, or an empty text: only slabs that are rounded to
// codes are dithered (docs/scene.md, "How it is drawn").
std::string for_slice_dither(const Scene& scene) {
    const TreeSettings* const tree = given_tree(scene.slice.tree);
    if (scene.target.is_given() && !is_fixed_point(*scene.target))
        return "of the targets fixed8, fixed16 and emulated";
    if (tree != nullptr && tree->nodes == NodeArithmetic::shader)
        return "of blended slabs and fixed nodes: the tree's nodes are computed in a shader";
    return {};
}

std::string for_slice(const Scene& scene, std::string_view path) {
    constexpr std::string_view tree = "render.slice.tree.";
    if (scene.method != Method::slice) return "counts with the method slice";
    if (is_in(path, "render.slice.dither")) return for_slice_dither(scene);
    const Auto<Classification>& classification = scene.slice.classification;
    if (is_in(path, "render.slice.table") &&
        (classification == Classification::post || classification == Classification::exact))
        return "of pre-integrated segments";
    if (path.starts_with(tree))
        return for_tree(given_tree(scene.slice.tree), scene.target, path.substr(tree.size()));
    return {};
}

std::string for_project(const Scene& scene, std::string_view path) {
    constexpr std::string_view tree = "render.project.tree.";
    if (scene.method != Method::project) return "counts with the method project";
    const ProjectSettings& project = scene.project;
    if (path == "render.project.interpolation" && project.coloring == Coloring::vertex)
        return "the colouring vertex is linear always";
    if (path == "render.project.dither" && !is_fixed_point(scene.target.value_or(Target::float32)))
        return "of fixed-point targets";
    if (is_in(path, "render.project.table") && project.coloring != Coloring::preintegrated)
        return "of the colouring preintegrated";
    if (path.starts_with(tree))
        return for_tree(given_tree(project.tree), scene.target, path.substr(tree.size()));
    return {};
}

std::string for_emulate(const Scene& scene, std::string_view path) {
    if (scene.target != Target::emulated) return "counts with the target emulated";
    if (path == "render.emulate.seed" && scene.emulate.alpha != AlphaRounding::stochastic)
        return "of stochastic rounding";
    return {};
}

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

// Converts the colours of background and lights from the space `from` to the scene's new space. The
// scene then looks the same, except that mixtures of colours differ.
void convert_colors(Scene& scene, ImageColorSpace from) {
    const ImageColorSpace to = scene.color_space;
    scene.background = converted_color(scene.background, from, to);
    if (!scene.lighting || scene.lighting->is_automatic()) return;
    for (Light& light : (*scene.lighting)->lights)
        light.color = converted_color(light.color, from, to);
}

// Reads an open colour map again after the colour space has changed: the numbers of its colours
// depend on the space. A map is open if it has no range and is to be stretched over the data.
void read_open_colormap_again(Scene& scene) {
    if (!scene.transfer_function.is_automatic() || !scene.given_transfer) return;
    const Scene read = parse_scene(scene_text(scene), scene.file);
    if (read.given_transfer) scene.given_transfer = read.given_transfer;
}

}  // namespace

const SettingNode& scene_keys() {
    static const SettingNode keys = [] {
        // The order of keys is kept: related keys are together in the schema.
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

std::string why_without_effect(const Scene& scene, std::string_view path) {
    if (is_in(path, "camera")) return for_camera(scene, path);
    if (is_in(path, "mesh") || path == "scalar") return for_mesh(scene, path);
    if (is_in(path, "render.slice")) return for_slice(scene, path);
    if (is_in(path, "render.project")) return for_project(scene, path);
    if (path == "render.trace.of" && !(scene.has_volume() && scene.has_mesh()))
        return "the scene has one kind of data alone";
    const bool traced = scene.method == Method::trace;
    if (is_in(path, "render.emulate"))
        return traced ? "the tracer computes in double precision" : for_emulate(scene, path);
    if (path == "render.target" && traced) return "the tracer computes in double precision";
    if (path == "render.max_error" && traced) return "the tracer keeps to render.trace.tolerance";
    return {};
}

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
    if (changed.color_space != scene.color_space) {
        convert_colors(changed, scene.color_space);
        read_open_colormap_again(changed);
    }
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
