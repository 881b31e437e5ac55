// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_reader.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include <nlohmann/json.hpp>
#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "mesh_files/mesh_file.h"
#include "scene/camera.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"
#include "volume_files/foreign_files.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

// Tells whether a file begins as an object of JSON does. Samples without a header may begin with a
// brace, but hardly with a key's quote behind it, and text alone.
bool begins_as_object(std::string_view beginning) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t brace = beginning.find_first_not_of(blanks);
    if (brace == beginning.npos || beginning[brace] != '{') return false;
    const std::size_t next = beginning.find_first_not_of(blanks, brace + 1);
    return next != beginning.npos && (beginning[next] == '"' || beginning[next] == '}') &&
           std::ranges::all_of(beginning, [&](char letter) {
               return static_cast<unsigned char>(letter) >= ' ' ||
                      blanks.find(letter) != blanks.npos;
           });
}

}  // namespace

FileKind kind_of_file(const std::filesystem::path& file, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    expect_no_foreign_mesh(file);
    const std::string beginning = file_beginning(file, 64);
    if (begins_as_object(beginning)) return FileKind::scene;  // whatever its name
    if (is_volume_file(file)) return FileKind::volume;
    if (is_mesh_file(file)) return FileKind::mesh;
    expect_no_folder(file);
    expect_no_foreign_file(file);
    // A file that cannot be read counts as a scene, whose reader says what is wrong.
    if (file.extension() == ".json" || beginning.empty()) return FileKind::scene;
    fail(
        "{}: unknown kind of file: expected a scene (JSON), a volume ({}) or a mesh (.vtu, .pvtu, "
        ".pvd, .vtk, .node, .ele), or raw samples with their size and type (--raw)",
        file.string(), volume_format_names());
}

nlohmann::json scene_document(const std::filesystem::path& file, const VolumeRequest& request) {
    const FileKind kind = request.raw ? FileKind::volume : kind_of_file(file);
    if (kind == FileKind::scene) return load_json(file);
    const std::string path = std::filesystem::absolute(file).string();
    nlohmann::json document{{"version", 1},
                            {"nan", "transparent"},
                            {"lighting", "auto"},
                            {"image", {{"background", {1, 1, 1}}}}};
    if (kind == FileKind::volume)
        document["volume"] = volume_selection_json(path, request);
    else
        document["mesh"] = path;
    return document;
}

nlohmann::ordered_json transfer_function_json(const TransferFunction& transfer_function) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const TransferKnot& knot : transfer_function.knots()) {
        const glm::dvec3& color = knot.optics.color;
        points.push_back({{"value", knot.value},
                          {"color", {color.r, color.g, color.b}},
                          {"extinction", knot.optics.extinction}});
        if (knot.smooth) points.back()["smooth"] = true;
    }
    nlohmann::ordered_json json{{"points", points}};
    if (transfer_function.of_codes()) json["codes"] = true;
    if (!transfer_function.labels().empty()) json["codes_of"] = transfer_function.labels();
    return json;
}

nlohmann::ordered_json camera_json(const Camera& camera) {
    return table_of<camera_keys>().json(camera);
}

nlohmann::ordered_json scene_json(const Scene& scene) {
    return table_of<scene_keys>().json(scene);
}

namespace {

std::vector<std::string> parts_of(const std::string& key) {
    // Each part between dots makes an inner object, so the depth limit of JSON files holds.
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

// Returns a number or a list of numbers as JSON wants it, 0.5 for .5 and 5.0 for 5.; other texts as
// they are.
std::string with_whole_fractions(const std::string& text) {
    if (text.find_first_not_of("0123456789.,-+eE[] ") != text.npos) return text;
    const auto is_digit = [&](std::size_t i) { return i < text.size() && std::isdigit(text[i]); };
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool before = i > 0 && is_digit(i - 1), after = is_digit(i + 1);
        if (text[i] == '.' && !before && after) result += '0';
        result += text[i];
        if (text[i] == '.' && before && !after) result += '0';
    }
    return result;
}

// Returns `text` parsed as JSON; nothing if it is none.
std::optional<nlohmann::json> parsed(const std::string& key, const std::string& text) {
    try {
        return parse_json(text);
    } catch (const JsonSyntaxError&) {
        return std::nullopt;
    } catch (const Error& error) {
        throw UsageError(fmt::format("--set {}: {}", shortened(key), error.what()));
    }
}

// Returns `text` parsed as JSON, or the text itself if it is none.
nlohmann::json value_of(const std::string& key, const std::string& text) {
    if (auto value = parsed(key, text)) return *std::move(value);
    if (auto number = parsed(key, with_whole_fractions(text))) return *std::move(number);
    return text;
}

}  // namespace

Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 GivenData given) {
    JsonReader reader(document, file);
    reader.context.volume_given = given == GivenData::volume;
    reader.context.mesh_given = given == GivenData::mesh;
    Scene scene;
    scene.file = file;
    table_of<scene_keys>().read(reader, scene);
    try {
        if (scene.camera.is_given()) View(*scene.camera, scene.width, scene.height);
    } catch (const Error& error) {
        throw KeyError("camera", fmt::format("{}: {}", file.string(), error.what()));
    }
    return scene;
}

void set_key(nlohmann::json& document, const std::string& key, const std::string& value) {
    nlohmann::json set = value_of(key, value);
    if (set.is_null()) return remove_key(document, key);
    if (key == "mesh.scalar" || key == "mesh.array") {
        throw UsageError(fmt::format(
            "--set {}: expected scalar={}: the array of a mesh is a key of the scene itself", key,
            shortened(value)));
    }
    // A file's name stands for an object with a path.
    for (const char* const data : {"volume", "mesh"}) {
        if (key.starts_with(std::string(data) + ".") && document.contains(data) &&
            document[data].is_string())
            document[data] = {{"path", document[data]}};
    }
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
        } else if (node->is_null() || *node == "auto") {
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

Scene load_scene(const std::filesystem::path& file, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(scene_document(file), file);
}

void save_scene(const Scene& scene, const std::filesystem::path& file) {
    AtomicFile output(file);
    output.write(json_text(scene_json(scene), 1) + "\n");
    output.commit();
}

}  // namespace lamina
