// SPDX-License-Identifier: Apache-2.0
#include "scene_files/keys.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/vector_relational.hpp>

#include "lamina/color.h"

namespace lamina {

namespace {

KeyJson triple(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

KeyJson three(KeyJson items) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", 3}, {"maxItems", 3}};
}

constexpr std::size_t most_of_path = 100;  // bytes of a path that a message shows
const nlohmann::json empty_object = nlohmann::json::object();

// Returns the value as JSON text, shortened if it is long.
std::string shown(const nlohmann::json& value) {
    return shortened(json_text(value));
}

std::string expand_data_folder(JsonReader& reader, const std::string& key, std::string text) {
    static const std::string variable = "${LAMINA_DATA}";
    const std::size_t at = text.find(variable);
    if (at == std::string::npos) return text;
    const char* const folder = std::getenv("LAMINA_DATA");
    if (folder == nullptr || *folder == '\0') {
        reader.fail_at(key,
                       "names ${LAMINA_DATA}, which is not set: set the environment variable "
                       "LAMINA_DATA to the folder with the data sets");
    }
    return text.replace(at, variable.size(), folder);
}

}  // namespace

KeyJson reference_to(const std::string& definition) {
    return {{"$ref", "#/$defs/" + definition}};
}

Form<bool> flag_form() {
    return {[](JsonReader& reader, const std::string& key) { return reader.flag(key); },
            [](const bool& value) { return KeyJson(value); },
            {{"type", "boolean"}}};
}

Form<int> code_bits_form() {
    return {[](JsonReader& reader, const std::string& key) {
                const nlohmann::json& value = reader.value(key);
                if (value != 8 && value != 16) reader.reject(key, "8 or 16");
                return value.get<int>();
            },
            [](const int& value) { return KeyJson(value); },
            {{"enum", {8, 16}}}};
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
    KeyJson schema{{"type", "number"}};
    if (limits.from) schema["minimum"] = *limits.from;
    if (limits.above) schema["exclusiveMinimum"] = *limits.above;
    if (limits.up_to) schema["maximum"] = *limits.up_to;
    if (limits.below) schema["exclusiveMaximum"] = *limits.below;
    return {read, [](const double& number) { return KeyJson(number); }, schema};
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

JsonReader::JsonReader(const nlohmann::json& object, const std::filesystem::path& file,
                       std::string path, const JsonContext& given_context)
    : context(given_context), object_(object), file_(file), path_(std::move(path)) {
    if (!object_.is_object()) {
        throw KeyError(path_,
                       fmt::format("{}: {}found {}, expected an object {{...}}", file_.string(),
                                   path_.empty() ? "" : shortened(path_, most_of_path) + ": ",
                                   shown(object_)));
    }
}

std::string JsonReader::path_to(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
}

std::string JsonReader::place() const {
    return fmt::format("{}: {}", file_.string(), shortened(path_, most_of_path));
}

void JsonReader::fail_at(const std::string& key, const std::string& message) const {
    throw KeyError(path_to(key), fmt::format("{}: {}: {}", file_.string(),
                                             shortened(path_to(key), most_of_path), message));
}

void JsonReader::reject(const std::string& key, const std::string& expected) {
    fail_at(key, has(key) ? fmt::format("found {}, expected {}", shown(object_[key]), expected)
                          : fmt::format("is missing, expected {}", expected));
}

bool JsonReader::has(const std::string& key) {
    asked_.insert(key);
    return object_.contains(key);
}

const nlohmann::json& JsonReader::value(const std::string& key) {
    if (!has(key)) fail_at(key, "is missing");
    return object_[key];
}

JsonReader JsonReader::object(const std::string& key) {
    const nlohmann::json& found = has(key) ? object_[key] : empty_object;
    return JsonReader(found, file_, path_to(key), context);
}

std::vector<JsonReader> JsonReader::objects(const std::string& key) {
    if (!has(key) || !object_[key].is_array()) reject(key, "a list [...]");
    std::vector<JsonReader> readers;
    readers.reserve(object_[key].size());
    for (const nlohmann::json& element : object_[key]) {
        readers.emplace_back(element, file_, fmt::format("{}.{}", path_to(key), readers.size()),
                             context);
    }
    return readers;
}

double JsonReader::number(const std::string& key) {
    if (!has(key) || !object_[key].is_number()) reject(key, "a number");
    const double found = object_[key].get<double>();
    if (!std::isfinite(found)) reject(key, "a finite number");
    return found;
}

std::int64_t JsonReader::whole(const std::string& key, std::int64_t lo, std::int64_t hi) {
    const std::string expected =
        lo == hi ? fmt::format("{}", lo) : fmt::format("a whole number from {} to {}", lo, hi);
    if (!has(key) || !object_[key].is_number()) reject(key, expected);
    const double found = object_[key].get<double>();  // 8.0 and 8e0 are whole numbers, too
    if (!(found >= static_cast<double>(lo) && found <= static_cast<double>(hi)) ||
        found != std::floor(found)) {
        reject(key, expected);
    }
    return static_cast<std::int64_t>(found);
}

bool JsonReader::flag(const std::string& key) {
    if (!has(key) || !object_[key].is_boolean()) reject(key, "true or false");
    return object_[key].get<bool>();
}

std::string JsonReader::text(const std::string& key) {
    if (!has(key) || !object_[key].is_string()) reject(key, "a string");
    return object_[key].get<std::string>();
}

glm::dvec3 JsonReader::vector(const std::string& key) {
    const bool three_numbers =
        has(key) && object_[key].is_array() && object_[key].size() == 3 &&
        std::all_of(object_[key].begin(), object_[key].end(), [](const nlohmann::json& element) {
            return element.is_number() && std::isfinite(element.get<double>());
        });
    if (!three_numbers) reject(key, "three finite numbers [x, y, z]");
    return {object_[key][0].get<double>(), object_[key][1].get<double>(),
            object_[key][2].get<double>()};
}

std::filesystem::path JsonReader::path_of(const std::string& key) {
    const std::filesystem::path path = expand_data_folder(*this, key, text(key));
    if (path.empty() || path.native().find('\0') != std::string::npos)
        reject(key, "the path of a file");
    return path.is_absolute() ? path : file_.parent_path() / path;
}

void JsonReader::close() const {
    for (const auto& [key, ignored] : object_.items()) {
        if (asked_.contains(key)) continue;
        throw UnknownKeyError(path_to(key), fmt::format("{}: {}: unknown key{}", file_.string(),
                                                        shortened(path_to(key), most_of_path),
                                                        suggestion(asked_, key)));
    }
}

glm::dvec3 read_color(JsonReader& reader, const std::string& key) {
    const ImageColorSpace space = reader.context.color_space;
    const nlohmann::json& given = reader.value(key);
    if (given.is_array()) return reader.vector(key);
    if (given.is_string()) {
        try {
            return color_of(given.get<std::string>(), space);
        } catch (const Error& error) {
            reader.fail_at(key, error.what());
        }
    }
    if (!given.is_object())
        reader.reject(key,
                      R"([r, g, b], "#rrggbb", the name of a CSS colour or {"srgb": [r, g, b]})");
    JsonReader object = reader.object(key);
    const glm::dvec3 display = object.vector("srgb");
    if (glm::any(glm::lessThan(display, glm::dvec3(0))) ||
        glm::any(glm::greaterThan(display, glm::dvec3(1))))
        object.reject("srgb", "three numbers from 0 to 1");
    object.close();
    return color_of_display(display, space);
}

}  // namespace lamina
