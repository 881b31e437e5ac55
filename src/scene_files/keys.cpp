// SPDX-License-Identifier: Apache-2.0
#include "scene_files/keys.h"

#include <algorithm>

#include "scene_files/json_reader.h"

namespace lamina {

namespace {

KeyJson triple(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

KeyJson three(KeyJson items) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", 3}, {"maxItems", 3}};
}

KeyJson limits_schema(const char* type, const Limits& limits) {
    KeyJson schema{{"type", type}};
    if (limits.from) schema["minimum"] = *limits.from;
    if (limits.above) schema["exclusiveMinimum"] = *limits.above;
    if (limits.up_to) schema["maximum"] = *limits.up_to;
    if (limits.below) schema["exclusiveMaximum"] = *limits.below;
    return schema;
}

}  // namespace

KeyJson reference_to(const std::string& definition) {
    return {{"$ref", "#/$defs/" + definition}};
}

Form<bool> flag_form() {
    return {[](JsonReader& reader, const std::string& key) { return reader.flag_or(key, false); },
            [](const bool& value) { return KeyJson(value); },
            {{"type", "boolean"}}};
}

Form<std::string> text_form() {
    return {[](JsonReader& reader, const std::string& key) { return reader.text(key); },
            [](const std::string& text) { return text.empty() ? KeyJson() : KeyJson(text); },
            {{"type", "string"}}};
}

Form<std::filesystem::path> path_form() {
    return {[](JsonReader& reader, const std::string& key) { return reader.path_of(key); },
            [](const std::filesystem::path& path) {
                return path.empty() ? KeyJson() : KeyJson(std::filesystem::absolute(path).string());
            },
            {{"type", "string"}}};
}

Form<glm::dvec3> vector_form() {
    return {[](JsonReader& reader, const std::string& key) { return reader.vector(key); }, triple,
            reference_to("vector")};
}

Form<glm::dvec3> color_form() {
    return {[](JsonReader& reader, const std::string& key) { return read_color(reader, key); },
            triple, reference_to("color")};
}

Form<std::array<std::int64_t, 3>> sizes_form(std::int64_t most, const std::string& expected) {
    const auto read = [most, expected](JsonReader& reader, const std::string& key) {
        const nlohmann::json& size = reader.value(key);
        const auto is_good = [&](const nlohmann::json& edge) {
            return edge.is_number_integer() && edge >= 1 && edge <= most;
        };
        if (!size.is_array() || size.size() != 3 || !std::ranges::all_of(size, is_good))
            reader.reject(key, expected);
        return size.get<std::array<std::int64_t, 3>>();
    };
    return {read, [](const std::array<std::int64_t, 3>& size) { return KeyJson(size); },
            three({{"type", "integer"}, {"minimum", 1}, {"maximum", most}})};
}

Form<double> number_form(const Limits& limits, const std::string& expected) {
    const auto read = [limits, expected](JsonReader& reader, const std::string& key) {
        const double number = reader.number(key);
        if (!expected.empty() && !limits.contain(number)) reader.reject(key, expected);
        return number;
    };
    return {read, [](const double& number) { return KeyJson(number); },
            limits_schema("number", limits)};
}

Form<std::uint32_t> seed_form() {
    Form<std::uint32_t> form = whole_form<std::uint32_t>(0, 0xffffffff);
    form.schema = reference_to("seed");
    return form;
}

KeyJson vector_schema() {
    return three({{"type", "number"}});
}

KeyJson color_schema() {
    const KeyJson srgb{
        {"type", "object"},
        {"additionalProperties", false},
        {"required", {"srgb"}},
        {"properties", {{"srgb", three({{"type", "number"}, {"minimum", 0}, {"maximum", 1}})}}}};
    return {{"description",
             "A triple in the numbers of image.color_space, or display values (sRGB), which are "
             "converted to them: #rrggbb, the name of a CSS colour, or {srgb: [r, g, b]}."},
            {"oneOf", KeyJson::array({reference_to("vector"), {{"type", "string"}}, srgb})}};
}

}  // namespace lamina
