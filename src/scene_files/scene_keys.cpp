// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_keys.h"

#include <cmath>

#include "compositing/tree_shape.h"

namespace lamina {
namespace {

constexpr std::size_t columns = 160;  // width of a line of the schema's text, in characters

// Reads image.color_space before all other keys, because the meaning of colours depends on it.
void read_color_space(JsonReader& reader, Scene& /*scene*/) {
    reader.context.color_space =
        reader.object("image").choice("color_space", enum_words<ImageColorSpace>());
}

KeyJson scene_schema() {
    KeyJson schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "lamina scene, version 1"}};
    schema.update(table_of<scene_keys>().schema());
    schema["$defs"] = {{"tree", tree_schema()},
                       {"seed", whole_form<std::uint32_t>(0, 0xffffffff).schema},
                       {"factor", whole_form<int>(1, max_tree_factor).schema},
                       {"vector", vector_schema()},
                       {"color", color_schema()}};
    return schema;
}

std::string flat_json(const KeyJson& json) {
    if (json.is_number_float() && json.get<double>() == std::trunc(json.get<double>()) &&
        std::abs(json.get<double>()) < 1e9)
        return fmt::format("{:.0f}", json.get<double>());
    if (!json.is_structured()) return json_text(json);
    std::string text;
    for (const auto& [key, value] : json.items()) {
        if (!text.empty()) text += ", ";
        if (json.is_object()) text += json_text(KeyJson(key)) + ": ";
        text += flat_json(value);
    }
    return json.is_object() ? fmt::format("{{{}}}", text) : fmt::format("[{}]", text);
}

// Appends JSON; what fits goes on one line. `used`: characters before the value, beside its indent.
void write_folded(const KeyJson& json, std::size_t depth, std::size_t used, std::string& text) {
    const std::string flat = flat_json(json);
    if (!json.is_structured() || json.empty() || depth * 2 + used + flat.size() <= columns) {
        text += flat;
        return;
    }
    const std::string indent(2 * (depth + 1), ' ');
    text += json.is_object() ? '{' : '[';
    const char* separator = "\n";
    for (const auto& [key, value] : json.items()) {
        const std::string name = json.is_object() ? flat_json(KeyJson(key)) + ": " : "";
        text.append(separator).append(indent).append(name);
        write_folded(value, depth + 1, name.size() + 1, text);
        separator = ",\n";
    }
    text.append(1, '\n').append(2 * depth, ' ').append(1, json.is_object() ? '}' : ']');
}

}  // namespace

void scene_keys(KeyTable<Scene>& keys) {
    keys.add({"version",
              {{"const", 1}},
              true,
              [](JsonReader& reader, Scene&) { reader.whole("version", 1, 1); },
              [](const Scene&, KeyJson& json) { json["version"] = 1; }});
    add_data_keys(keys);
    keys.check(read_color_space);
    add_transfer_function(keys);
    add_view_keys(keys);
    keys.object("render", table_of<render_keys>);
    keys.also("anyOf", KeyJson::array({{{"required", {"volume"}}}, {{"required", {"mesh"}}}}));
}

std::string scene_schema_text() {
    std::string text;
    write_folded(scene_schema(), 0, 0, text);
    return text + "\n";
}

}  // namespace lamina
