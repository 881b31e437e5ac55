// SPDX-License-Identifier: Apache-2.0
#include "scene_files/color_json.h"

#include <glm/vector_relational.hpp>

#include "lamina/color.h"

namespace lamina {

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
