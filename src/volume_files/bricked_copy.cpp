// SPDX-License-Identifier: Apache-2.0
#include "volume_files/bricked_copy.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/progress.h"
#include "volume/volume_store.h"
#include "volume_files/chunk_hashes.h"
#include "volume_files/file_state.h"
#include "volume_files/grid_check.h"
#include "volume_files/replaced_folder.h"
#include "volume_files/stored_samples.h"
#include "volume_files/volume_file.h"
#include "volume_files/zarr_source.h"
#include "volume_files/zarr_writer.h"

namespace lamina {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

constexpr const char* attribute = "lamina_bricks";

// Tells the files, as they are now, and what is taken of them, from others.
std::string copied(const Path& file, const VolumeRequest& request) {
    ContentHash hash;
    for (const Path& each : files_of_volume(file, request)) {
        const FileState state = FileState::of(each);
        hash.add(fmt::format("{} {} {}", each.lexically_relative(file).string(), state.bytes,
                             state.modified));
    }
    if (std::filesystem::is_regular_file(file)) hash.add(FileState::of(file).bytes_hash());
    hash.add(request.array);
    for (const auto& number : {request.level, request.channel, request.time})
        hash.add(std::to_string(number.value_or(0)));
    if (const auto& raw = request.raw) {
        hash.add(fmt::format("{} {} {} {} {} {}", raw->size[0], raw->size[1], raw->size[2],
                             raw->type, raw->offset, raw->big_endian));
    }
    return hash.hex();
}

Json json_of(const glm::dvec3& vector) {
    return {vector.x, vector.y, vector.z};
}

glm::dvec3 vector_in(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json json_of(const Grid& grid) {
    Json json{{"origin", json_of(grid.origin)}, {"axes", static_cast<int>(grid.axes)}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        json["step"].push_back(json_of(grid.step[axis]));
        json["cell_centered"].push_back(grid.centering[axis] == Centering::cell);
    }
    return json;
}

Grid grid_in(const Json& json, const ZarrArray& array) {
    Grid grid;
    grid.origin = vector_in(json.at("origin"));
    grid.axes = static_cast<WorldAxes>(std::clamp(json.at("axes").get<int>(), 0, 3));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = array.shape.at(2 - axis);
        grid.step[axis] = vector_in(json.at("step").at(axis));
        grid.centering[axis] =
            json.at("cell_centered").at(axis).get<bool>() ? Centering::cell : Centering::node;
    }
    return grid;
}

// A layer of chunks is in memory while it is written: a quarter of the limit at most, as far as
// that goes. Flatter chunks are wider.
std::array<std::int64_t, 3> chunk_edge(const Grid& grid, SampleType type) {
    std::array<std::int64_t, 3> edge{64, 64, 64};
    const std::uint64_t slice =
        static_cast<std::uint64_t>(grid.size[0] * grid.size[1]) * bytes_of(type);
    std::size_t wider = 0;
    for (; edge[2] > 4; wider = 1 - wider) {
        if (static_cast<std::uint64_t>(edge[2]) * slice <= memory_limit() / 4) break;
        edge[2] /= 2;
        edge[wider] *= 2;
    }
    const auto chunks = [&](std::size_t axis) {
        return (grid.size[axis] + edge[axis] - 1) / edge[axis];
    };
    for (; chunks(0) * chunks(1) * chunks(2) > most_chunks; wider = 1 - wider) edge[wider] *= 2;
    return edge;
}

// The type of a file's samples that are drawn as they are.
ValueType stored_type(SampleType type) {
    return *std::ranges::find(value_types, std::optional(type), drawn_type);
}

void write_layers(const Volume& volume, ZarrWriter& writer) {
    const auto& size = volume.grid().size;
    const auto slice = static_cast<std::size_t>(size[0] * size[1]) * bytes_of(volume.type());
    ByteBuffer read(volume.in_memory() ? 0 : slice * static_cast<std::size_t>(writer.slices_of(0)));
    Progress progress("writing bricks", writer.layer_count());
    std::int64_t z = 0;
    for (std::int64_t layer = 0; layer < writer.layer_count(); ++layer) {
        check_interrupt();
        const std::int64_t slices = writer.slices_of(layer);
        const void* samples = read.data();
        if (volume.in_memory())
            samples = static_cast<const char*>(volume.data()) + static_cast<std::size_t>(z) * slice;
        else
            volume.store().source().read({{0, 0, z}, {size[0], size[1], slices}}, read.data());
        writer.write_layer(samples);
        z += slices;
        progress.advance();
    }
}

}  // namespace

Path bricked_copy_of(const Path& file) {
    std::string name = file.lexically_normal().string();
    while (name.size() > 1 && name.back() == '/') name.pop_back();
    // "." and ".." are no names that another could follow.
    if (name.ends_with('.')) name = std::filesystem::canonical(file).string();
    // "FILE.h5:/group/array" lies in no folder.
    std::error_code absent;
    const std::size_t inside = name.find(":/");
    if (inside != std::string::npos && !std::filesystem::exists(file, absent)) {
        std::replace(name.begin() + static_cast<std::ptrdiff_t>(inside), name.end(), '/', '.');
        name.erase(inside, 1);
    }
    return name + ".lamina-bricks";
}

BrickedCopy write_bricked_copy(const Path& file, const VolumeRequest& request) {
    VolumeRequest stored = request;
    stored.spacing.reset();
    stored.origin.reset();
    const std::string of = copied(file, stored);
    const Volume volume = open_volume(file, stored, {.residence = VolumeUse::Residence::in_order});
    ReplacedFolder folder(bricked_copy_of(file));
    const Json attributes{{attribute, {{"of", of}, {"grid", json_of(volume.grid())}}}};
    ZarrWriter writer(folder.temporary(), volume.grid().size,
                      chunk_edge(volume.grid(), volume.type()), stored_type(volume.type()),
                      attributes);
    write_layers(volume, writer);
    writer.finish();
    if (copied(file, stored) != of)
        fail("{}: the file was changed while it was read", file.string());
    folder.commit();
    return {bricked_copy_of(file), writer.chunk_count(), writer.bytes_written()};
}

std::optional<Volume> open_bricked_copy(const Path& file, const VolumeRequest& request,
                                        const VolumeUse& use) {
    const Path folder = bricked_copy_of(file);
    std::error_code absent;
    if (!std::filesystem::exists(folder, absent)) return {};
    expect_allowed(folder / ".zattrs");
    const auto is_not_used = [&](const char* why) {
        warn(
            fmt::format("{}: the bricks are {}, and are not used: lamina index --bricks makes "
                        "them again",
                        folder.string(), why));
        return std::nullopt;
    };
    try {
        const Json attributes = load_json(folder / ".zattrs");
        const Json& about = attributes.at(attribute);
        const ZarrArray array = read_zarray(folder);
        const auto type = drawn_type(array.type);
        if (array.shape.size() != 3 || !type) return is_not_used("damaged");
        const Grid grid = grid_in(about.at("grid"), array);
        check_grid(folder.string(), grid, {"step", "origin"});
        if (!stays_in_files(grid, *type, use)) return {};
        if (about.at("of") != copied(file, request)) return is_not_used("of other samples");
        ZarrChunks chunks(array, {{0, 1, 2}, {0, 0, 0}});
        auto hashes = read_chunk_hashes(folder, chunks.count());
        if (!hashes) return is_not_used("damaged");
        chunks.expect(std::move(*hashes));
        return stored_volume(grid, *type, std::make_unique<ZarrSource>(std::move(chunks)));
    } catch (const Json::exception&) {
        return is_not_used("damaged");
    } catch (const Error&) {
        return is_not_used("damaged");
    }
}

}  // namespace lamina
