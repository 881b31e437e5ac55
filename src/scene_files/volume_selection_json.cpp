// SPDX-License-Identifier: Apache-2.0
#include "scene_files/volume_selection_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/value_type.h"

namespace lamina {
namespace {

constexpr std::int64_t largest_number = std::int64_t{1} << 40;

std::optional<std::int64_t> number_of(JsonReader& reader, const char* key) {
    if (!reader.has(key)) return {};
    return reader.whole(key, 0, largest_number);
}

std::optional<glm::dvec3> spacing_of(JsonReader& reader) {
    if (!reader.has("spacing")) return {};
    const glm::dvec3 spacing = reader.vector("spacing");
    if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
        reader.reject("spacing", "three numbers above 0");
    return spacing;
}

RawLayout read_raw_layout(JsonReader& reader) {
    RawLayout raw;
    const nlohmann::json& size = reader.value("size");
    const bool good = size.is_array() && size.size() == 3 &&
                      std::ranges::all_of(size, [](const nlohmann::json& edge) {
                          return edge.is_number_integer() && edge >= 1 && edge <= largest_number;
                      });
    if (!good) reader.reject("size", "three whole numbers above 0");
    for (std::size_t axis = 0; axis < 3; ++axis) raw.size[axis] = size[axis].get<std::int64_t>();
    raw.type = reader.text("type");
    if (!value_type_of(raw.type)) reader.reject("type", "one of " + value_type_list());
    raw.offset = number_of(reader, "offset").value_or(0);
    raw.big_endian = reader.choice<bool>("endian", {{"little", false}, {"big", true}});
    return raw;
}

}  // namespace

VolumeRequest read_volume_selection(JsonReader& reader) {
    VolumeRequest selection;
    if (reader.has("array")) selection.array = reader.text("array");
    selection.level = number_of(reader, "level");
    selection.channel = number_of(reader, "channel");
    selection.time = number_of(reader, "time");
    selection.spacing = spacing_of(reader);
    if (reader.has("origin")) selection.origin = reader.vector("origin");
    bool raw = false;
    for (const char* const key : {"size", "type", "offset", "endian"}) raw |= reader.has(key);
    if (raw) selection.raw = read_raw_layout(reader);
    reader.close();
    return selection;
}

nlohmann::ordered_json volume_selection_json(const std::string& path,
                                             const VolumeRequest& selection) {
    if (selection == VolumeRequest{}) return path;
    nlohmann::ordered_json json{{"path", path}};
    if (!selection.array.empty()) json["array"] = selection.array;
    if (selection.level) json["level"] = *selection.level;
    if (selection.channel) json["channel"] = *selection.channel;
    if (selection.time) json["time"] = *selection.time;
    const auto put = [&](const char* key, const std::optional<glm::dvec3>& vector) {
        if (vector) json[key] = {vector->x, vector->y, vector->z};
    };
    put("spacing", selection.spacing);
    put("origin", selection.origin);
    if (selection.raw) {
        json["size"] = selection.raw->size;
        json["type"] = selection.raw->type;
        json["offset"] = selection.raw->offset;
        json["endian"] = selection.raw->big_endian ? "big" : "little";
    }
    return json;
}

}  // namespace lamina
