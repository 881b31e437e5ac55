// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_keys.h"

#include "base/value_type.h"
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

// The form of a source that is only a path; all values but objects are read as one. `File`
// (VolumeFile or MeshFile) is written in this form if its other members have their defaults.
template <typename File, typename Source>
Alternative<Scene> path_alternative(Source Scene::*source) {
    const Form<std::filesystem::path> form = path_form();
    return {[](const nlohmann::json& value) { return !value.is_object(); },
            [source, form](JsonReader& reader, const std::string& key, Scene& scene) {
                scene.*source = File{form.read(reader, key), {}};
            },
            [source](const Scene& scene) {
                const File* const file = std::get_if<File>(&(scene.*source));
                return file != nullptr && *file == File{file->path, {}};
            },
            [source, form](const Scene& scene) {
                return form.write(std::get<File>(scene.*source).path);
            },
            form.schema};
}

// A source that is an object; object.has("path") makes "path" a known key for suggestions.
template <typename Kind, typename Source>
Alternative<Scene> object_alternative(Source Scene::*source,
                                      const std::function<bool(const nlohmann::json&)>& reads,
                                      const KeyTable<Kind>& (*table)()) {
    return {
        reads,
        [source, table](JsonReader& reader, const std::string& key, Scene& scene) {
            JsonReader object = reader.object(key);
            object.has("path");
            table().read(object, (scene.*source).template emplace<Kind>());
        },
        [source](const Scene& scene) { return std::holds_alternative<Kind>(scene.*source); },
        [source, table](const Scene& scene) { return table().json(std::get<Kind>(scene.*source)); },
        table().schema()};
}

Form<VolumeLookup> lookup_form() {
    return words_form<VolumeLookup>(
        {{"linear", VolumeLookup::linear}, {"nearest", VolumeLookup::nearest}});
}

constexpr const char* lookup_text =
    "Between samples: linear is trilinear; nearest is constant in each sample's voxel. If a file's "
    "samples are labels (docs/scene.md), nearest unless given.";

void generator_keys(KeyTable<GeneratorRequest>& keys) {
    // The types that generated_grid() can make.
    std::vector<std::pair<const char*, SampleType>> types;
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
    keys.key("lookup", &GeneratorRequest::lookup, lookup_form(), lookup_text);
    keys.check([](JsonReader& reader, GeneratorRequest& request) {
        try {
            generated_grid(request);
        } catch (const Error& error) {
            reader.fail_at("generate", error.what());
        }
    });
}

void raw_keys(KeyTable<RawLayout>& keys) {
    keys.key("size", &RawLayout::size, sizes_form(largest_number, "three whole numbers above 0"),
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
}

// Adds the keys of a raw file (RawLayout): if one is given, size and type must be, too.
void add_raw_keys(KeyTable<VolumeRequest>& keys) {
    const auto any_given = [](JsonReader& reader) {
        bool any = false;
        for (const Key<RawLayout>& key : table_of<raw_keys>().keys()) any |= reader.has(key.name);
        return any;
    };
    for (const Key<RawLayout>& key : table_of<raw_keys>().keys()) {
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

void volume_file_keys(KeyTable<VolumeFile>& keys) {
    keys.key("path", &VolumeFile::path, path_form()).required();
    keys.part(&VolumeFile::selection, table_of<volume_selection_keys>());
    keys.also("dependentRequired",
              {{"size", {"type"}}, {"type", {"size"}}, {"offset", {"size"}}, {"endian", {"size"}}});
}

void add_volume(KeyTable<Scene>& keys) {
    const auto is_generated = [](const nlohmann::json& value) {
        return value.is_object() && !value.contains("path");
    };
    keys.variant(
        "volume",
        {path_alternative<VolumeFile>(&Scene::volume),
         object_alternative<GeneratorRequest>(&Scene::volume, is_generated,
                                              table_of<generator_keys>),
         object_alternative<VolumeFile>(&Scene::volume, has_key("path"),
                                        table_of<volume_file_keys>)},
        "",
        "Path of a file or folder (relative to the scene; ${LAMINA_DATA} expands), with what of it "
        "is drawn, or a generated volume.");
}

void mesh_file_keys(KeyTable<MeshFile>& keys) {
    keys.key("path", &MeshFile::path, path_form()).required();
    keys.key("time", &MeshFile::time, whole_form<std::int64_t>(0, most_steps),
             "Step of a .pvd, counted from 0 in the order of time.");
    keys.key("join", &MeshFile::join,
             number_form({.from = 0, .up_to = 1e100}, "a distance from 0 to 1e100 (world units)"),
             "Points this near to an earlier one are moved to its place (world units).");
}

void mesh_keys(KeyTable<MeshSettings>& keys) {
    keys.key("tolerance", &MeshSettings::tolerance,
             number_form({.above = 0, .up_to = 1},
                         "a number above 0 and up to 1 (of the range of values)"),
             "Largest difference from the trilinear field, of the volume's range of values.");
    keys.key("max_tets", &MeshSettings::max_tets, whole_form<std::int64_t>(6, most_tets),
             "The making of the mesh stops at so many.");
    keys.key("kuhn", &MeshSettings::kuhn, flag_form(), "Every sample, six tets a cell.");
}

void add_mesh(KeyTable<Scene>& keys) {
    keys.variant(
        "mesh",
        {path_alternative<MeshFile>(&Scene::mesh),
         object_alternative<MeshFile>(&Scene::mesh, has_key("path"), table_of<mesh_file_keys>),
         object_alternative<MeshSettings>(&Scene::mesh, is_any, table_of<mesh_keys>)},
        "",
        "Path of a mesh (.vtu, .pvtu, .pvd, legacy .vtk, TetGen .node with its .ele; "
        "relative to the scene; ${LAMINA_DATA} expands), or one made from the volume.");
    keys.check([](JsonReader& reader, Scene& read) {
        if (read.made_mesh() != nullptr && !has_volume(reader, read))
            reader.reject("volume", "a volume, which \"mesh\" is made from");
    });
}

}  // namespace

bool has_volume(const JsonReader& reader, const Scene& scene) {
    return reader.context.volume_given || scene.has_volume();
}

bool has_mesh(const JsonReader& reader, const Scene& scene) {
    return reader.context.mesh_given || scene.has_mesh();
}

void volume_selection_keys(KeyTable<VolumeRequest>& keys) {
    const auto number = optional_form(whole_form<std::int64_t>(0, largest_number));
    keys.key("array", &VolumeRequest::array, text_form(), "By its name; the first unless given.");
    keys.key("level", &VolumeRequest::level, number, "Of a pyramid.").otherwise(0);
    keys.key("channel", &VolumeRequest::channel, number).otherwise(0);
    keys.key("time", &VolumeRequest::time, number).otherwise(0);
    Form<glm::dvec3> spacing = checked(
        vector_form(), [](const glm::dvec3& v) { return v.x > 0 && v.y > 0 && v.z > 0; },
        "three numbers above 0");
    spacing.schema = vector_schema();
    spacing.schema["items"]["exclusiveMinimum"] = 0;
    keys.key("spacing", &VolumeRequest::spacing, optional_form(spacing), "In place of the file's.");
    keys.key("origin", &VolumeRequest::origin, optional_form(vector_form()),
             "The first sample, in place of the file's.");
    keys.key("lookup", &VolumeRequest::lookup, optional_form(lookup_form()), lookup_text);
    add_raw_keys(keys);
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
        if (reader.has("scalar") && !reader.context.mesh_given && read.mesh_file() == nullptr)
            reader.reject("scalar", "a mesh from a file beside it");
    });
    scene.key("nan", &Scene::nan, words_form<NanPolicy>(),
              "What NaN and infinite values do: refuse the volume or mesh, or make the cells and "
              "tets around them transparent.");
}

KeyJson volume_selection_json(const std::string& path, const VolumeRequest& selection) {
    if (selection == VolumeRequest{}) return path;
    KeyJson json{{"path", path}};
    table_of<volume_selection_keys>().write(selection, json);
    return json;
}

}  // namespace lamina
