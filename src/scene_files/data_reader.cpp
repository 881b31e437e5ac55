// SPDX-License-Identifier: Apache-2.0
#include "scene_files/data_reader.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/enum_words.h"
#include "scene_files/json_reader.h"
#include "scene_files/volume_selection_json.h"
#include "volume/generate.h"

namespace lamina {
namespace {

constexpr std::int64_t most_steps = 1'000'000'000;

constexpr std::int64_t most_tets = 500000000;

GeneratorRequest read_generator(JsonReader reader) {
    GeneratorRequest request;
    request.name = reader.text("generate");
    if (reader.has("size")) {
        const nlohmann::json& size = reader.value("size");
        const bool good = size.is_array() && size.size() == 3 &&
                          std::all_of(size.begin(), size.end(), [](const nlohmann::json& edge) {
                              return edge.is_number_integer() && edge.get<std::int64_t>() >= 1 &&
                                     edge.get<std::int64_t>() <= largest_generated_axis;
                          });
        if (!good) {
            reader.reject("size",
                          fmt::format("three whole numbers from 1 to {}", largest_generated_axis));
        }
        request.size = {{size[0].get<std::int64_t>(), size[1].get<std::int64_t>(),
                         size[2].get<std::int64_t>()}};
    }
    std::vector<std::pair<const char*, SampleType>> types;  // generated_grid() knows no others
    for (const SampleType type : {SampleType::uint8, SampleType::uint16, SampleType::float32})
        types.emplace_back(name_of(type), type);
    request.type = reader.choice<SampleType>("type", types);
    try {
        generated_grid(request);
    } catch (const Error& error) {
        reader.fail_at("generate", error.what());
    }
    reader.close();
    return request;
}

void read_volume_source(JsonReader& reader, Scene& scene) {
    if (!reader.has("volume")) return;
    if (!reader.value("volume").is_object()) {
        scene.volume_file = reader.path_of("volume");
    } else if (JsonReader volume = reader.object("volume"); volume.has("path")) {
        scene.volume_file = volume.path_of("path");
        scene.volume_selection = read_volume_selection(volume);
    } else {
        scene.volume_request = read_generator(volume);
    }
}

MeshSettings read_mesh_settings(JsonReader reader) {
    MeshSettings settings;
    settings.tolerance = reader.number_or("tolerance", settings.tolerance);
    if (!(settings.tolerance > 0 && settings.tolerance <= 1))
        reader.reject("tolerance", "a number above 0 and up to 1 (of the range of values)");
    if (reader.has("max_tets")) settings.max_tets = reader.whole("max_tets", 6, most_tets);
    settings.kuhn = reader.flag_or("kuhn", settings.kuhn);
    reader.close();
    return settings;
}

void read_mesh_source(JsonReader& reader, Scene& scene, bool has_volume) {
    if (!reader.has("mesh")) return;
    if (!reader.value("mesh").is_object()) {
        scene.mesh_file = reader.path_of("mesh");
        return;
    }
    JsonReader mesh = reader.object("mesh");
    if (mesh.has("path")) {
        scene.mesh_file = mesh.path_of("path");
        if (mesh.has("time")) scene.mesh_time = mesh.whole("time", 0, most_steps);
        mesh.close();
        return;
    }
    scene.mesh_request = read_mesh_settings(mesh);
    if (!has_volume) reader.reject("volume", "a volume, which \"mesh\" is made from");
}

}  // namespace

PresentData read_data(JsonReader& reader, Scene& scene, const GivenData* given) {
    const bool given_volume = given != nullptr && given->kind == GivenData::Kind::volume;
    const bool given_mesh = given != nullptr && given->kind == GivenData::Kind::mesh;
    read_volume_source(reader, scene);
    const bool has_volume = given_volume || scene.has_volume();
    read_mesh_source(reader, scene, has_volume);
    const bool has_mesh = given_mesh || scene.has_mesh();
    if (!has_volume && !has_mesh)
        reader.reject("volume", "a path, an object {...}, or a mesh under \"mesh\"");
    if (reader.has("scalar")) {
        scene.scalar = reader.text("scalar");
        if (!given_mesh && scene.mesh_file.empty())
            reader.reject("scalar", "a mesh from a file beside it");
    }
    scene.nan = reader.choice<NanPolicy>("nan", enum_words<NanPolicy>());
    return {has_volume, has_mesh};
}

}  // namespace lamina
