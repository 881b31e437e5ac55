// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/enum_words.h"
#include "base/json_text.h"
#include "base/shortened.h"
#include "image/image_limits.h"
#include "scene/camera.h"
#include "scene/largest_scene_coordinate.h"
#include "scene_files/clip_json.h"
#include "scene_files/color_json.h"
#include "scene_files/data_range.h"
#include "scene_files/data_reader.h"
#include "scene_files/json_reader.h"
#include "scene_files/lighting_json.h"
#include "scene_files/project_reader.h"
#include "scene_files/slice_reader.h"
#include "scene_files/transfer_function_json.h"

namespace lamina {
namespace {

Camera read_camera(JsonReader reader) {
    Camera camera;
    camera.projection = reader.choice<Projection>("projection", enum_words<Projection>());
    camera.eye = reader.vector("eye");
    camera.center = reader.vector("center");
    camera.up = reader.vector_or("up", camera.up);
    camera.fov_y = reader.number_or("fov_y", camera.fov_y);
    if (!(camera.fov_y > 0 && camera.fov_y < 180))
        reader.reject("fov_y", "degrees between 0 and 180");
    if (camera.projection == Projection::orthographic)
        camera.height = reader.number("height");
    else
        camera.height = reader.number_or("height", camera.height);
    if (!(camera.height > 0)) reader.reject("height", "world units > 0");
    for (const char* key : {"eye", "center", "up"}) {
        const glm::dvec3 place = reader.vector_or(key, camera.up);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(place[axis]) > largest_scene_coordinate)
                reader.reject(key, "coordinates up to 1e100");
        }
    }
    if (camera.height > largest_scene_coordinate)
        reader.reject("height", "at most 1e100 world units");
    reader.close();
    return camera;
}

// Absent means the same as "auto".
bool is_automatic(JsonReader& reader, const char* key) {
    if (!reader.has(key) || reader.value(key) == "auto") return true;
    if (!reader.value(key).is_object()) reader.reject(key, "an object {...}, or \"auto\"");
    return false;
}

// What colours mean is known before the first one is read.
ImageColorSpace read_color_space(JsonReader& reader) {
    return reader.object("image").choice<ImageColorSpace>("color_space",
                                                          enum_words<ImageColorSpace>());
}

void read_image(JsonReader reader, Scene& scene) {
    const auto side = [&](const char* key, int otherwise) {
        return reader.has(key) ? reader.whole(key, 1, max_image_side) : std::int64_t{otherwise};
    };
    const std::int64_t width = side("width", scene.width);
    const std::int64_t height = side("height", scene.height);
    if (width * height > max_image_pixels) {
        reader.fail_at("width", fmt::format("found {} x {} pixels, expected at most {} in all",
                                            width, height, max_image_pixels));
    }
    scene.width = static_cast<int>(width);
    scene.height = static_cast<int>(height);
    reader.has("color_space");  // read_color_space() has read it
    scene.background = read_color(reader, "background", scene.background, scene.color_space);
    reader.close();
}

TraceOf read_trace_of(JsonReader& trace, const PresentData& data) {
    if (!trace.has("of")) return data.volume ? TraceOf::volume : TraceOf::mesh;
    const TraceOf of = trace.choice<TraceOf>("of", enum_words<TraceOf>());
    if (of == TraceOf::volume && !data.volume)
        trace.reject("of", "\"mesh\": the scene has no volume");
    if (of == TraceOf::mesh && !data.mesh) trace.reject("of", "\"volume\": the scene has no mesh");
    return of;
}

void check_project_dither(JsonReader& reader, const Scene& scene) {
    if (scene.method != Method::project || scene.target != Target::emulated) return;
    if (scene.project.dither == ProjectDither::alpha) {
        reader.fail_at("project.dither",
                       "found \"alpha\" with the target \"emulated\", expected \"none\" or "
                       "\"after_blend\": render.emulate.alpha says how opacity is rounded there");
    }
}

void read_target(JsonReader& reader, Scene& scene) {
    std::vector<std::pair<const char*, std::optional<Target>>> words;
    for (const auto& [word, target] : enum_words<Target>()) words.emplace_back(word, target);
    words.emplace_back("auto", std::nullopt);
    const auto target = reader.choice<std::optional<Target>>("target", words);
    scene.automatic_target = !target;
    scene.target = target.value_or(Target::float32);
}

void read_render(JsonReader reader, Scene& scene, const PresentData& data) {
    scene.method = reader.has("method") ? reader.choice<Method>("method", enum_words<Method>())
                   : data.volume        ? Method::slice
                                        : Method::project;
    read_target(reader, scene);
    scene.emulate = read_emulation(reader.object("emulate"));
    scene.max_error = reader.number_or("max_error", scene.max_error);
    if (!(scene.max_error > 0 && scene.max_error <= 255)) {
        reader.reject("max_error", "a number above 0 and up to 255 (in 1/255 of full scale)");
    }
    scene.slice = read_slice(reader.object("slice"));
    scene.project = read_project(reader.object("project"));
    JsonReader trace = reader.object("trace");
    scene.trace_of = read_trace_of(trace, data);
    scene.trace_tolerance = trace.number_or("tolerance", scene.trace_tolerance);
    // Below 1e-12 the tracer's own rounding would be larger than the tolerance.
    if (!(scene.trace_tolerance >= 1e-12 && scene.trace_tolerance <= 1)) {
        trace.reject("tolerance", "a number from 1e-12 to 1");
    }
    trace.close();
    if (scene.method == Method::slice && !data.volume)
        reader.reject("method", "\"project\" or \"trace\" for a scene without a volume");
    if (scene.method == Method::project && !data.mesh)
        reader.reject("method", "\"slice\" or \"trace\" for a scene without a mesh");
    check_project_dither(reader, scene);
    reader.close();
}

std::vector<std::string> parts_of(const std::string& key) {
    // The parts of a key make nested objects, which are held to the depth limit of files.
    const auto count = static_cast<std::size_t>(std::ranges::count(key, '.')) + 1;
    if (count > most_json_depth) {
        throw UsageError(fmt::format("--set {}: found {} parts between dots, expected at most {}",
                                     shortened(key), count, most_json_depth));
    }
    std::vector<std::string> parts;
    std::size_t start = 0;
    while (true) {
        const std::size_t dot = std::min(key.find('.', start), key.size());
        parts.push_back(key.substr(start, dot - start));
        if (parts.back().empty()) {
            throw UsageError(fmt::format("--set {}: expected KEY=VALUE, as in render.target=fixed8",
                                         shortened(key)));
        }
        if (dot == key.size()) return parts;
        start = dot + 1;
    }
}

// Returns `text` parsed as JSON, or the text itself where it is none.
nlohmann::json value_of(const std::string& key, const std::string& text) {
    try {
        return parse_json(text);
    } catch (const JsonSyntaxError&) {
        return text;
    } catch (const Error& error) {
        throw UsageError(fmt::format("--set {}: {}", shortened(key), error.what()));
    }
}

}  // namespace

Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 std::set<std::string>* known, const GivenData* given) {
    JsonReader reader(document, file, "", known);
    Scene scene;
    scene.file = file;
    reader.whole("version", 1, 1);
    const PresentData data = read_data(reader, scene, given);
    scene.color_space = read_color_space(reader);
    scene.automatic_transfer_function = is_automatic(reader, "transfer_function");
    if (!scene.automatic_transfer_function) {
        JsonReader transfer_function = reader.object("transfer_function");
        scene.colormap_file = colormap_file_of(transfer_function);
        scene.transfer_function = read_transfer_function(
            transfer_function,
            {.space = scene.color_space,
             .data_range = [&] { return given ? given->range() : data_range(scene); },
             .warnings = &scene.warnings});
    }
    scene.automatic_camera = is_automatic(reader, "camera");
    if (!scene.automatic_camera) scene.camera = read_camera(reader.object("camera"));
    if (reader.has("clip")) scene.clip = read_clip(reader.object("clip"));
    scene.lighting = read_lighting(reader, scene.color_space);
    read_image(reader.object("image"), scene);
    read_render(reader.object("render"), scene, data);
    reader.close();
    try {
        View(scene.camera, scene.width, scene.height);
    } catch (const Error& error) {
        throw KeyError("camera", fmt::format("{}: {}", file.string(), error.what()));
    }
    return scene;
}

void set_key(nlohmann::json& document, const std::string& key, const std::string& value) {
    nlohmann::json set = value_of(key, value);
    if (set.is_null()) return remove_key(document, key);
    nlohmann::json* node = &document;
    for (const std::string& part : parts_of(key)) {
        if (node->is_array()) {
            const bool number =
                part.find_first_not_of("0123456789") == std::string::npos && part.size() < 9;
            if (!number || std::stoul(part) >= node->size()) {
                throw UsageError(
                    fmt::format("--set {}: found \"{}\", expected the number of one of {} elements",
                                shortened(key), shortened(part), node->size()));
            }
            node = &(*node)[std::stoul(part)];
        } else if (node->is_object()) {
            node = &(*node)[part];
        } else if (node->is_null()) {
            *node = nlohmann::json::object();
            node = &(*node)[part];
        } else {
            throw UsageError(fmt::format("--set {}: \"{}\" is not inside an object", shortened(key),
                                         shortened(part)));
        }
    }
    *node = std::move(set);
}

void remove_key(nlohmann::json& document, const std::string& key) {
    nlohmann::json::json_pointer place;
    for (const std::string& part : parts_of(key)) place /= part;
    if (!document.contains(place)) return;
    nlohmann::json& parent = document[place.parent_pointer()];
    if (parent.is_array())
        parent.erase(std::stoul(place.back()));
    else
        parent.erase(place.back());
}

}  // namespace lamina
