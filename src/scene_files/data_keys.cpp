// SPDX-License-Identifier: Apache-2.0
#include "scene_files/data_keys.h"

#include "base/value_type.h"
#include "scene_files/forms.h"
#include "volume/generate.h"

namespace lamina {
namespace {

constexpr std::int64_t largest_number = std::int64_t{1} << 40;
constexpr std::int64_t most_steps = 1'000'000'000;
constexpr std::int64_t most_tets = 500000000;

const auto is_any = [](const nlohmann::json&) { return true; };
const auto has_key = [](const char* key) {
    return [key](const nlohmann::json& value) { return value.is_object() && value.contains(key); };
};

// A path alone, in place of an object: all but objects are read as paths, or refused as such.
template <typename Access>
Alternative<Scene> path_alternative(const Access& access,
                                    const std::function<bool(const Scene&)>& writes) {
    const Form<std::filesystem::path> form = path_form();
    return {[](const nlohmann::json& value) { return !value.is_object(); },
            [access, form](JsonReader& reader, const std::string& key, Scene& scene) {
                access(scene) = form.read(reader, key);
            },
            writes, [access, form](const Scene& scene) { return form.write(access(scene)); },
            form.schema};
}

// An object with the keys of a table of the scene's own.
Alternative<Scene> object_alternative(const std::function<bool(const nlohmann::json&)>& reads,
                                      const KeyTable<Scene>& (*table)(),
                                      const std::function<bool(const Scene&)>& writes) {
    return {reads,
            [table](JsonReader& reader, const std::string& key, Scene& scene) {
                JsonReader object = reader.object(key);
                table().read(object, scene);
            },
            writes, [table](const Scene& scene) { return table().json(scene); }, table().schema()};
}

// --- volume

const KeyTable<GeneratorRequest>& generator_keys() {
    static const auto table = [] {
        KeyTable<GeneratorRequest> keys;
        std::vector<std::pair<const char*, SampleType>> types;  // generated_grid() knows no others
        for (const SampleType type : {SampleType::uint8, SampleType::uint16, SampleType::float32})
            types.emplace_back(name_of(type), type);
        Form<std::string> name = text_form();
        name.schema = {{"enum", generator_names()}};
        keys.key("generate", &GeneratorRequest::name, name).required();
        keys.key("type", &GeneratorRequest::type, words_form<SampleType>(types));
        keys.key("size", &GeneratorRequest::size,
                 optional_form(sizes_form(
                     largest_generated_axis,
                     fmt::format("three whole numbers from 1 to {}", largest_generated_axis))));
        keys.check([](JsonReader& reader, GeneratorRequest& request) {
            try {
                generated_grid(request);
            } catch (const Error& error) {
                reader.fail_at("generate", error.what());
            }
        });
        return keys;
    }();
    return table;
}

const KeyTable<RawLayout>& raw_keys() {
    static const auto table = [] {
        KeyTable<RawLayout> keys;
        keys.key("size", &RawLayout::size,
                 sizes_form(largest_number, "three whole numbers above 0"),
                 "Samples of a file without a header.")
            .required();
        Form<std::string> type = checked(
            text_form(), [](const std::string& word) { return value_type_of(word); },
            "one of " + value_type_list());
        type.schema = {{"enum", value_type_words}};
        keys.key("type", &RawLayout::type, type).required();
        keys.key("offset", &RawLayout::offset, whole_form<std::int64_t>(0, largest_number),
                 "Bytes before the first sample.");
        keys.key("endian", &RawLayout::big_endian,
                 words_form<bool>({{"little", false}, {"big", true}}));
        return keys;
    }();
    return table;
}

// The keys of a raw file, which stand beside the others: each of them needs the size and the type.
void add_raw_keys(KeyTable<VolumeRequest>& keys) {
    const auto any_given = [](JsonReader& reader) {
        bool any = false;
        for (const Key<RawLayout>& key : raw_keys().keys()) any |= reader.has(key.name);
        return any;
    };
    for (const Key<RawLayout>& key : raw_keys().keys()) {
        keys.add({key.name, key.schema, false,
                  [key, any_given](JsonReader& reader, VolumeRequest& request) {
                      if (!any_given(reader)) return;
                      if (!request.raw) request.raw.emplace();
                      key.read(reader, *request.raw);
                  },
                  [key](const VolumeRequest& request, KeyJson& json) {
                      if (request.raw) key.write(*request.raw, json);
                  }});
    }
}

const KeyTable<Scene>& volume_file_keys() {
    static const auto table = [] {
        KeyTable<Scene> keys;
        keys.key("path", &Scene::volume_file, path_form()).required();
        keys.part(&Scene::volume_selection, volume_selection_keys());
        keys.also(
            "dependentRequired",
            {{"size", {"type"}}, {"type", {"size"}}, {"offset", {"size"}}, {"endian", {"size"}}});
        return keys;
    }();
    return table;
}

void add_volume(KeyTable<Scene>& keys) {
    const auto file_alone = [](const Scene& scene) {
        return !scene.volume_file.empty() && scene.volume_selection == VolumeRequest{} &&
               !scene.volume_request;
    };
    const Alternative<Scene> generated{
        [](const nlohmann::json& value) { return value.is_object() && !value.contains("path"); },
        [](JsonReader& reader, const std::string& key, Scene& scene) {
            JsonReader object = reader.object(key);
            object.has("path");  // which messages then name, too
            generator_keys().read(object, scene.volume_request.emplace());
        },
        [](const Scene& scene) { return scene.volume_request.has_value(); },
        [](const Scene& scene) { return generator_keys().json(*scene.volume_request); },
        generator_keys().schema()};
    const auto in_file = [](const Scene& scene) { return !scene.volume_file.empty(); };
    const std::vector<Alternative<Scene>> forms{
        path_alternative(
            [](auto& scene) -> auto& { return scene.volume_file; }, file_alone),
        generated, object_alternative(has_key("path"), volume_file_keys, in_file)};
    keys.variant("volume", forms, "",
                 "Path of a file or folder (relative to the scene; ${LAMINA_DATA} expands), with "
                 "what of it is drawn, or a generated volume.");
}

// --- mesh

const KeyTable<Scene>& mesh_file_keys() {
    static const auto table = [] {
        KeyTable<Scene> keys;
        keys.key("path", &Scene::mesh_file, path_form()).required();
        keys.key("time", &Scene::mesh_time, whole_form<std::int64_t>(0, most_steps),
                 "Step of a .pvd, counted from 0 in the order of time.");
        return keys;
    }();
    return table;
}

const KeyTable<MeshSettings>& mesh_keys() {
    static const auto table = [] {
        KeyTable<MeshSettings> keys;
        keys.key("tolerance", &MeshSettings::tolerance,
                 number_form({.above = 0, .up_to = 1},
                             "a number above 0 and up to 1 (of the range of values)"),
                 "Largest difference from the trilinear field, of the volume's range of values.");
        keys.key("max_tets", &MeshSettings::max_tets, whole_form<std::int64_t>(6, most_tets),
                 "The making of the mesh stops at so many.");
        keys.key("kuhn", &MeshSettings::kuhn, flag_form(), "Every sample, six tets a cell.");
        return keys;
    }();
    return table;
}

void add_mesh(KeyTable<Scene>& keys) {
    const auto file_alone = [](const Scene& scene) {
        return !scene.mesh_request && !scene.mesh_file.empty() && scene.mesh_time == 0;
    };
    const auto in_file = [](const Scene& s) { return !s.mesh_request && !s.mesh_file.empty(); };
    const Alternative<Scene> made{
        is_any,
        [](JsonReader& reader, const std::string& key, Scene& scene) {
            JsonReader object = reader.object(key);
            object.has("path");  // which messages then name, too
            mesh_keys().read(object, scene.mesh_request.emplace());
            if (!has_volume(reader, scene))
                reader.reject("volume", "a volume, which \"mesh\" is made from");
        },
        [](const Scene& scene) { return scene.mesh_request.has_value(); },
        [](const Scene& scene) { return mesh_keys().json(*scene.mesh_request); },
        mesh_keys().schema()};
    const std::vector<Alternative<Scene>> forms{
        path_alternative(
            [](auto& scene) -> auto& { return scene.mesh_file; }, file_alone),
        object_alternative(has_key("path"), mesh_file_keys, in_file), made};
    keys.variant("mesh", forms, "",
                 "Path of a mesh (.vtu, .pvtu, .pvd, legacy .vtk, TetGen .node with its .ele; "
                 "relative to the scene; ${LAMINA_DATA} expands), or one made from the volume.");
}

}  // namespace

bool has_volume(const JsonReader& reader, const Scene& scene) {
    return reader.context.volume_given || scene.has_volume();
}

bool has_mesh(const JsonReader& reader, const Scene& scene) {
    return reader.context.mesh_given || scene.has_mesh();
}

const KeyTable<VolumeRequest>& volume_selection_keys() {
    static const auto table = [] {
        KeyTable<VolumeRequest> keys;
        const auto number = optional_form(whole_form<std::int64_t>(0, largest_number));
        keys.key("array", &VolumeRequest::array, text_form(),
                 "By its name; the first unless told.");
        keys.key("level", &VolumeRequest::level, number, "Of a pyramid.").otherwise(0);
        keys.key("channel", &VolumeRequest::channel, number).otherwise(0);
        keys.key("time", &VolumeRequest::time, number).otherwise(0);
        Form<glm::dvec3> spacing = checked(
            vector_form(), [](const glm::dvec3& v) { return v.x > 0 && v.y > 0 && v.z > 0; },
            "three numbers above 0");
        spacing.schema = vector_schema();
        spacing.schema["items"]["exclusiveMinimum"] = 0;
        keys.key("spacing", &VolumeRequest::spacing, optional_form(spacing),
                 "In place of the file's.");
        keys.key("origin", &VolumeRequest::origin, optional_form(vector_form()),
                 "The first sample, in place of the file's.");
        add_raw_keys(keys);
        return keys;
    }();
    return table;
}

void add_data_keys(KeyTable<Scene>& scene) {
    add_volume(scene);
    add_mesh(scene);
    scene.check([](JsonReader& reader, Scene& read) {
        if (!has_volume(reader, read) && !has_mesh(reader, read))
            reader.reject("volume", "a path, an object {...}, or a mesh under \"mesh\"");
    });
    scene.key("scalar", &Scene::scalar, text_form(),
              "Array of the mesh file, of points or (averaged to points) of cells; the first one "
              "of points if nothing is said.");
    scene.check([](JsonReader& reader, Scene& read) {
        if (reader.has("scalar") && !reader.context.mesh_given && read.mesh_file.empty())
            reader.reject("scalar", "a mesh from a file beside it");
    });
    scene.key("nan", &Scene::nan, words_form<NanPolicy>(),
              "What NaN and infinite values do: refuse the volume or mesh, or make the cells and "
              "tets around them transparent.");
}

KeyJson volume_selection_json(const std::string& path, const VolumeRequest& selection) {
    if (selection == VolumeRequest{}) return path;
    KeyJson json{{"path", path}};
    volume_selection_keys().write(selection, json);
    return json;
}

}  // namespace lamina
