// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2").
#include "volume_files/bricked_copy.h"

#include <blosc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/output_file.h"
#include "base/parallel.h"
#include "volume/volume_store.h"
#include "volume_files/sample_sources.h"
#include "volume_files/volume_file.h"
#include "volume_files/zarr_chunks.h"

namespace lamina {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

constexpr int level = 5;  // Blosc's compression level, 0 .. 9: its default

void write_small_file(const std::filesystem::path& path, const void* bytes, std::size_t count) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    bool written = file != nullptr && std::fwrite(bytes, 1, count, file) == count;
    // Some file systems say only when the file is closed that the disk is full.
    if (file != nullptr) written &= std::fclose(file) == 0;
    if (!written) fail("{}: cannot write: {}", path.string(), std::strerror(errno));
}

void write_json_file(const Path& path, const Json& json) {
    const std::string text = json_text(json, 2) + "\n";
    write_small_file(path, text.data(), text.size());
}

std::string type_text(ValueType type) {
    const char kind = !is_integer(type) ? 'f' : name_of(type)[0] == 'u' ? 'u' : 'i';
    const bool little = std::endian::native == std::endian::little;
    const char order = bytes_of(type) == 1 ? '|' : little ? '<' : '>';
    return fmt::format("{}{}{}", order, kind, bytes_of(type));
}

// Writes a Zarr v2 array of the axes z, y, x in chunks that Blosc compresses (lz4). Chunks of zeros
// get no file, because the fill value is 0; only the first chunk always has one.
class ZarrWriter {
  public:
    // `folder`: empty. `size`, `edge`: samples of array and chunk along x, y, z. Throws Error.
    ZarrWriter(std::filesystem::path folder, const std::array<std::int64_t, 3>& size,
               const std::array<std::int64_t, 3>& edge, ValueType type,
               const nlohmann::json& attributes)
        : folder_(std::move(folder)), size_(size), edge_(edge), bytes_(bytes_of(type)) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            counts_[axis] = (size_[axis] + edge_[axis] - 1) / edge_[axis];
        hashes_.assign(static_cast<std::size_t>(chunk_count()), no_chunk);
        const nlohmann::json compressor{{"id", "blosc"},
                                        {"cname", "lz4"},
                                        {"clevel", level},
                                        {"shuffle", BLOSC_SHUFFLE},
                                        {"blocksize", 0}};
        write_json_file(folder_ / ".zarray", {{"zarr_format", 2},
                                              {"shape", {size_[2], size_[1], size_[0]}},
                                              {"chunks", {edge_[2], edge_[1], edge_[0]}},
                                              {"dtype", type_text(type)},
                                              {"order", "C"},
                                              {"fill_value", 0},
                                              {"compressor", compressor},
                                              {"filters", nullptr},
                                              {"dimension_separator", "/"}});
        write_json_file(folder_ / ".zattrs", attributes);
    }

    // Writes the next layer (all chunks at one z) from slices in native byte order. Throws Error.
    void write_layer(const void* samples) {
        for (std::int64_t y = 0; y < counts_[1]; ++y)
            make_folder(folder_ / fmt::format("{}/{}", next_, y));
        std::atomic<std::uint64_t> written{0};
        parallel_for(counts_[0] * counts_[1], 1, [&](std::int64_t number) {
            written += write_chunk(number % counts_[0], number / counts_[0],
                                   static_cast<const char*>(samples));
        });
        bytes_written_ += written;
        ++next_;
    }

    // Writes the hashes of all chunks, after the last layer. Throws Error.
    void finish() const { write_chunk_hashes(folder_, hashes_); }

    std::int64_t layer_count() const { return counts_[2]; }
    // Returns the number of slices of a layer: those of a chunk, or fewer in the last layer.
    std::int64_t slices_of(std::int64_t layer) const {
        return std::min(edge_[2], size_[2] - layer * edge_[2]);
    }

    std::int64_t chunk_count() const { return counts_[0] * counts_[1] * counts_[2]; }
    std::uint64_t bytes_written() const { return bytes_written_; }

  private:
    // Writes the chunk (x, y) of layer next_, with zeros beyond the array's border. Returns the
    // number of bytes of its file; 0 if it gets none.
    std::uint64_t write_chunk(std::int64_t x, std::int64_t y, const char* layer) {
        const std::size_t row = static_cast<std::size_t>(edge_[0]) * bytes_;
        ByteBuffer chunk(row * static_cast<std::size_t>(edge_[1] * edge_[2]));
        std::memset(chunk.data(), 0, chunk.size());
        const std::int64_t first_x = x * edge_[0], first_y = y * edge_[1];
        const std::size_t copied =
            static_cast<std::size_t>(std::min(edge_[0], size_[0] - first_x)) * bytes_;
        const std::int64_t rows = std::min(edge_[1], size_[1] - first_y);
        for (std::int64_t k = 0; k < slices_of(next_); ++k) {
            for (std::int64_t j = 0; j < rows; ++j) {
                const std::int64_t from = (k * size_[1] + first_y + j) * size_[0] + first_x;
                std::memcpy(chunk.data() + static_cast<std::size_t>(k * edge_[1] + j) * row,
                            layer + static_cast<std::size_t>(from) * bytes_, copied);
            }
        }
        const bool first = x == 0 && y == 0 && next_ == 0;  // ZarrChunks rejects arrays without any
        if (!first && all_zero(chunk.data(), chunk.size())) return 0;
        ByteBuffer packed(chunk.size() + BLOSC_MAX_OVERHEAD);
        const int bytes =
            blosc_compress_ctx(level, BLOSC_SHUFFLE, bytes_, chunk.size(), chunk.data(),
                               packed.data(), packed.size(), BLOSC_LZ4_COMPNAME, 0, 1);
        const std::filesystem::path file = folder_ / fmt::format("{}/{}/{}", next_, y, x);
        if (bytes <= 0) fail("{}: Blosc does not pack {} bytes", file.string(), chunk.size());
        write_small_file(file, packed.data(), static_cast<std::size_t>(bytes));
        hashes_[static_cast<std::size_t>((next_ * counts_[1] + y) * counts_[0] + x)] =
            hash_of_chunk(packed.text().substr(0, static_cast<std::size_t>(bytes)));
        return static_cast<std::uint64_t>(bytes);
    }

    std::filesystem::path folder_;
    std::array<std::int64_t, 3> size_, edge_, counts_{};
    std::size_t bytes_;      // of a sample
    std::int64_t next_ = 0;  // layer to be written
    std::uint64_t bytes_written_ = 0;
    std::vector<std::uint64_t> hashes_;  // of chunks, as write_chunk_hashes() takes them
};

// A folder NAME that is written as NAME.part, which commit() renames to NAME; without commit(),
// NAME.part is removed.
class ReplacedFolder {
  public:
    // Throws Error if NAME is a folder that is no Zarr array, or if another command writes it now.
    // Removes files that a killed command left in NAME.part.
    explicit ReplacedFolder(std::filesystem::path path)
        : path_(std::move(path)), temporary_(path_.string() + ".part") {
        std::error_code absent;
        if (std::filesystem::exists(path_, absent) && !std::filesystem::exists(path_ / ".zarray"))
            fail("{}: found a folder that lamina has not written, expected none", path_.string());
        make_folder(temporary_);
        lock_ = open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
            if (lock_ >= 0) close(lock_);
            fail("{}: another command writes it now", temporary_.string());
        }
        for (const auto& left : std::filesystem::directory_iterator(temporary_, absent))
            std::filesystem::remove_all(left.path(), absent);
    }

    ~ReplacedFolder() {
        std::error_code absent;
        if (!committed_) std::filesystem::remove_all(temporary_, absent);
        close(lock_);
    }

    ReplacedFolder(const ReplacedFolder&) = delete;
    ReplacedFolder& operator=(const ReplacedFolder&) = delete;

    const std::filesystem::path& temporary() const { return temporary_; }

    // Throws Error.
    void commit() {
        const std::filesystem::path old = path_.string() + ".old";
        std::error_code error, absent;
        std::filesystem::remove_all(old, absent);
        if (std::filesystem::exists(path_, absent)) std::filesystem::rename(path_, old, error);
        if (!error) std::filesystem::rename(temporary_, path_, error);
        if (error) fail("{}: cannot write: {}", path_.string(), error.message());
        committed_ = true;
        std::filesystem::remove_all(old, absent);
    }

  private:
    std::filesystem::path path_, temporary_;
    int lock_ = -1;
    bool committed_ = false;
};

// Key in .zattrs of the members that lamina adds: the grid and the hash from copied().
constexpr const char* attribute = "lamina_bricks";

// Returns a copy's identity: a hash of the files' state and of the request's selection.
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
    Json json{{"origin", json_of(grid.origin)},
              {"axes", static_cast<int>(grid.axes)},
              {"unit", grid.unit}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        json["step"].push_back(json_of(grid.step[axis]));
        json["cell_centered"].push_back(grid.centering[axis] == Centering::cell);
    }
    return json;
}

Grid grid_in(const Json& json, const ZarrArray& array) {
    Grid grid;
    grid.origin = vector_in(json.at("origin"));
    grid.axes = static_cast<WorldAxes>(std::clamp(json.at("axes").get<int>(), 0, 4));
    grid.unit = json.value("unit", std::string());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = array.shape.at(2 - axis);
        grid.step[axis] = vector_in(json.at("step").at(axis));
        grid.centering[axis] =
            json.at("cell_centered").at(axis).get<bool>() ? Centering::cell : Centering::node;
    }
    return grid;
}

// A copy keeps what its file says of labels.
Json json_of(const std::shared_ptr<const VolumeLabels>& labels) {
    if (!labels) return nullptr;
    Json list = Json::array();
    for (const Label& label : labels->list) {
        list.push_back({label.code, label.number, label.name, nullptr, label.opacity});
        if (label.color) list.back()[3] = json_of(*label.color);
    }
    return {{"renumbered", labels->renumbered}, {"list", list}};
}

std::shared_ptr<const VolumeLabels> labels_in(const Json& json) {
    if (json.is_null()) return nullptr;
    VolumeLabels labels{json.at("renumbered"), {}};
    for (const Json& entry : json.at("list")) {
        labels.list.push_back({entry.at(0), entry.at(1), entry.at(2)});
        if (!entry.at(3).is_null()) labels.list.back().color = vector_in(entry.at(3));
        if (entry.size() > 4) labels.list.back().opacity = entry[4];  // an older copy has none
    }
    return std::make_shared<const VolumeLabels>(std::move(labels));
}

// A copy keeps what its file lists, which is not opened when the copy is.
Json json_of(const VolumeContents& contents) {
    return {{"arrays", contents.arrays},
            {"channels", contents.channels},
            {"times", contents.times},
            {"levels", contents.levels},
            {"colour", contents.is_colour}};
}

VolumeContents contents_in(const Json& json) {
    return {json.at("arrays"), json.at("channels"), json.at("times"), json.at("levels"),
            json.at("colour")};
}

// Returns the samples of a chunk along each axis: 64, unless a layer of chunks, which is in memory
// while it is written, would exceed a quarter of the memory limit. Chunks are then flatter (min 4
// slices) and wider; if there would be more than most_chunks, they are wider still.
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
    // "." and ".." are no names to which an extension can be added.
    if (name.ends_with('.')) name = std::filesystem::canonical(file).string();
    // "FILE.h5:/group/array", an array in a file, has the copy FILE.h5.group.array.lamina-bricks.
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
    stored.lookup.reset();
    const std::string of = copied(file, stored);
    VolumeContents contents;
    const Volume volume = open_volume(
        file, stored, {.residence = VolumeUse::Residence::in_order, .contents = &contents});
    ReplacedFolder folder(bricked_copy_of(file));
    const Json attributes{{attribute,
                           {{"of", of},
                            {"grid", json_of(volume.grid())},
                            {"contents", json_of(contents)},
                            {"are_labels", volume.grid().lookup == VolumeLookup::nearest},
                            {"labels", json_of(volume.labels())}}}};
    ZarrWriter writer(folder.temporary(), volume.grid().size,
                      chunk_edge(volume.grid(), volume.type()),
                      *value_type_of(name_of(volume.type())), attributes);
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
        say("{}: the bricks are {}, and are not used: lamina index --bricks makes "
            "them again",
            folder.string(), why);
        return std::nullopt;
    };
    try {
        const Json attributes = load_json(folder / ".zattrs");
        const Json& about = attributes.at(attribute);
        const ZarrArray array = read_zarray({}, folder);
        const auto type = drawn_type(array.type);
        if (array.shape.size() != 3 || !type) return is_not_used("damaged");
        Grid grid = grid_in(about.at("grid"), array);
        check_grid(folder.string(), grid, {"step", "origin"});
        if (!stays_in_files(grid, *type, use)) return {};
        if (about.at("of") != copied(file, request)) return is_not_used("of other samples");
        if (!about.contains("labels")) return is_not_used("of an older version");
        const auto labels = labels_in(about["labels"]);
        // A copy of codes has not the numbers between which a user wants to interpolate.
        if (labels && labels->renumbered && use.lookup == VolumeLookup::linear) return {};
        if (about.at("are_labels").get<bool>())
            take_for_labels(file.string(), "the copied file", use, grid);
        ZarrChunks chunks(array, {{0, 1, 2}, {0, 0, 0}});
        auto hashes = read_chunk_hashes(folder, chunks.count());
        if (!hashes) return is_not_used("damaged");
        chunks.set_expected_hashes(std::move(*hashes));
        if (use.contents != nullptr) *use.contents = contents_in(about["contents"]);
        return stored_volume(grid, *type, std::make_unique<ZarrSource>(std::move(chunks)))
            .labelled(labels);
    } catch (const Json::exception&) {
    } catch (const Error&) {
    }
    return is_not_used("damaged");
}

}  // namespace lamina
