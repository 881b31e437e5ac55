// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/npy.h"
#include "volume_files/array_axes.h"
#include "volume_files/sample_sources.h"
#include "volume_files/zip_archive.h"

namespace lamina {
namespace {

// Reorders samples from Fortran order (the first axis, z, is fastest) to C order (the last, x).
template <typename T>
std::shared_ptr<void> turned(const void* stored, const std::array<std::int64_t, 3>& size) {
    const auto* const from = static_cast<const T*>(stored);
    const auto [nx, ny, nz] = size;
    std::shared_ptr<void> memory =
        filled_memory(static_cast<std::size_t>(nx * ny * nz) * sizeof(T));
    auto* const to = static_cast<T*>(memory.get());
    parallel_for(ny, 1, [&, nx = nx, ny = ny, nz = nz](std::int64_t y) {
        for (std::int64_t z = 0; z < nz; ++z)
            for (std::int64_t x = 0; x < nx; ++x)
                to[x + nx * (y + ny * z)] = from[z + nz * (y + ny * x)];
    });
    return memory;
}

// An array of NumPy: its samples, in a file of its own or in an archive.
struct NpyArray {
    StoredData data;                     // without files
    std::array<std::int64_t, 3> size{};  // of the volume along x, y and z
    bool is_half = false;                // the samples are binary16, in `data` uint16
    bool is_fortran = false;             // the first axis is the fastest
};

// Gives the axes of an array a meaning, slowest first. NumPy has no names for them: the last three
// are z, y and x, and those before them follow unnamed_axis(), unless ends_with_channels().
std::vector<StoredAxis> npy_axes(const std::string& name, std::vector<std::int64_t> shape,
                                 const VolumeRequest& request) {
    std::vector<StoredAxis> axes(shape.begin(), shape.end());
    const bool are_five = shape.size() == 5;
    if (are_five) axes[0] = taken_axis(name, "time", request.time, shape[0]);
    if (ends_with_channels(name, shape, request)) {
        axes.back() = taken_axis(name, "channel", request.channel, shape.back());
    } else if (are_five) {
        axes[1] = taken_axis(name, "channel", request.channel, shape[1]);
        say_five_axes(name);
    } else if (shape.size() == 4) {
        axes[0] = unnamed_axis(name, request.channel, request.time, shape[0]);
    } else {
        taken_axis(name, "channel", request.channel, 1);
        taken_axis(name, "time", request.time, 1);
    }
    return axes;
}

NpyArray npy_array(const std::filesystem::path& path, const std::string& name,
                   const NpyHeader& header, const VolumeRequest& request) {
    const std::string descr = header.descr();
    const std::string_view word = std::string_view(descr).substr(descr.empty() ? 0 : 1);
    NpyArray array;
    array.is_half = word == "f2";
    array.is_fortran = header.is_fortran_order();
    const auto type = array.is_half ? ValueType::uint16 : numpy_type(word);
    const bool ordered = !descr.empty() && std::string_view("<>|").find(descr[0]) != descr.npos;
    if (!type || !ordered)
        header.wrong("descr",
                     "integers or floats of up to 64 bits, such as '<f4'" + numpy_advice(word));
    std::vector<std::int64_t> shape = header.shape();
    if (shape.size() < 2 || shape.size() > 5 ||
        std::ranges::any_of(shape, [](std::int64_t size) { return size < 1; }))
        header.wrong("shape", "two to five numbers above 0: (y, x) of one slice, or (z, y, x)");
    if (shape.size() == 2) shape.insert(shape.begin(), 1);
    std::vector<StoredAxis> axes = npy_axes(name, shape, request);
    std::size_t axis = 3;
    for (const StoredAxis& each : axes)
        if (!each.taken) array.size[--axis] = each.size;
    if (!array.is_fortran) std::ranges::reverse(axes);
    array.data.path = path;
    array.data.type = *type;
    array.data.axes = axes;
    array.data.byte_skip = header.data_offset();
    set_byte_order(array.data, descr[0] == '>');
    return array;
}

// Makes the volume of an array's samples as they were read, in native byte order.
Volume npy_volume(const NpyArray& array, StoredSamples samples, const VolumeUse& use) {
    const Grid grid = plain_grid(array.size);
    if (array.is_half) samples = widened_halves(samples, grid.sample_count());
    if (array.is_fortran) {
        samples.bytes = with_type(samples.type, [&](auto zero) {
            return turned<decltype(zero)>(samples.bytes.get(), array.size);
        });
    }
    return drawn_volume(grid, samples, use.lookup);
}

// Opens an array that lies in files as it is.
Volume open_npy_array(const NpyArray& array, const VolumeUse& use) {
    if (!array.is_half && !array.is_fortran)
        return open_stored(plain_grid(array.size), array.data, use);
    const std::string name = array.data.path.string();
    expect_room(
        name, stored_bytes(name, array.data.axes, bytes_of(array.data.type)), use,
        array.is_half ? "its samples are floats of 16 bits" : "its first axis is the fastest");
    return npy_volume(array, read_stored(array.data), use);
}

// An archive (.npz) with the headers of its arrays.
class Npz {
  public:
    explicit Npz(const std::filesystem::path& path) : path_(path), archive_(path) {}

    Volume open(const VolumeRequest& request, const VolumeUse& use) const {
        const std::string chosen = request.array.empty() ? first_volume() : request.array;
        const ZipMember* member = archive_.find(chosen + ".npy");
        if (member == nullptr) member = archive_.find(chosen);
        if (member == nullptr) {
            fail("{}: array: found \"{}\", expected one of \"{}\"", path_.string(),
                 one_line(chosen), fmt::join(names(), "\", \""));
        }
        const NpyHeader header = header_of(*member);
        const std::string name = name_of_member(*member);
        NpyArray array = npy_array(path_, name, header, request);
        const std::size_t bytes = stored_bytes(name, array.data.axes, bytes_of(array.data.type));
        const auto begin = static_cast<std::size_t>(header.data_offset());
        if (member->bytes != begin + bytes)
            fail("{}: found {} bytes of samples, expected {}", name,
                 member->bytes - std::min(member->bytes, begin), bytes);
        if (use.contents != nullptr) use.contents->arrays = volumes();
        const bool in_place = member->is_stored() && !array.is_half && !array.is_fortran &&
                              FileSource::can_read(array.data);
        if (in_place && stays_in_files(plain_grid(array.size), *drawn_type(array.data.type), use)) {
            array.data.files = {path_};
            place_raw(array.data, archive_.place_of(*member) + begin);
            return open_stored(plain_grid(array.size), array.data, use);
        }
        expect_room(
            name, bytes, use,
            member->is_stored() ? "its samples are not drawn as they are" : "it is compressed");
        return npy_volume(array, read(*member, array, begin), use);
    }

  private:
    std::string name_of_member(const ZipMember& member) const {
        return path_.string() + ": " + one_line(member.name);
    }

    NpyHeader header_of(const ZipMember& member) const {
        constexpr std::size_t most = 1 << 17;  // image/npy.h reads shorter headers
        const ByteBuffer beginning = archive_.read_beginning(member, most);
        std::istringstream stream(std::string(beginning.text()));
        return {name_of_member(member), stream};
    }

    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& [name, member] : archive_.members())
            if (name.ends_with(".npy")) names.push_back(one_line(name.substr(0, name.size() - 4)));
        return names;
    }

    // Returns the names of arrays with three axes or more.
    std::vector<std::string> volumes() const {
        std::vector<std::string> found = names();
        std::erase_if(found, [&](const std::string& name) {
            const ZipMember* const member = archive_.find(name + ".npy");
            return member == nullptr || header_of(*member).shape().size() < 3;
        });
        return found;
    }

    std::string first_volume() const {
        const std::vector<std::string> found = volumes(), all = names();
        if (found.empty())
            fail(
                "{}: found no array of three axes or more, expected one; \"array\" takes one of "
                "two",
                path_.string());
        if (all.size() > 1)
            say("{}: array \"{}\" of \"{}\" is taken: {}", path_.string(), found[0],
                fmt::join(all, "\", \""), names_another("array", "NAME"));
        return found[0];
    }

    // Reads what is taken of an array whose samples begin at byte `begin` of its member.
    StoredSamples read(const ZipMember& member, const NpyArray& array, std::size_t begin) const {
        const std::string name = name_of_member(member);
        const auto contents = std::make_shared<ByteBuffer>(archive_.read(member));
        const std::size_t word = bytes_of(array.data.type);
        const std::size_t bytes = stored_bytes(name, array.data.axes, word, true);
        say_taken(name, array.data.axes);
        const char* const from = contents->data() + begin;
        std::shared_ptr<void> samples(contents, contents->data());
        if (bytes == contents->size() - begin) {
            std::memmove(samples.get(), from, bytes);  // there, memory is aligned for every type
        } else {
            samples = filled_memory(bytes);
            take_of_memory(from, array.data.axes, word, static_cast<char*>(samples.get()));
        }
        if (array.data.swap_bytes)
            swap_bytes(samples.get(), static_cast<std::int64_t>(bytes / word), word);
        return {name, array.data.type, samples};
    }

    std::filesystem::path path_;
    ZipArchive archive_;
};

}  // namespace

std::string numpy_advice(std::string_view word) {
    switch (word.empty() || word[0] == '(' ? 'V' : word[0]) {
        case 'c':
            return ": these are complex numbers, of which numpy.abs(array) can be drawn";
        case 'O':
            return ": these are Python objects, which would run code: array.astype(float) can be "
                   "drawn";
        case 'S':
        case 'U':
            return ": this is text";
        case 'M':
        case 'm':
            return ": these are dates and times, of which array.astype(int) can be drawn";
        case 'V':
            return ": these are records, of which one field, array[\"NAME\"], can be drawn";
        case 'f':
            return ": array.astype(\"f8\") can be drawn";
        default:
            return {};
    }
}

std::optional<ValueType> numpy_type(std::string_view word) {
    struct Word {
        std::string_view word;
        ValueType type;
    };
    constexpr Word words[] = {
        {"i1", ValueType::int8},    {"u1", ValueType::uint8},  {"b1", ValueType::uint8},
        {"i2", ValueType::int16},   {"u2", ValueType::uint16}, {"i4", ValueType::int32},
        {"u4", ValueType::uint32},  {"i8", ValueType::int64},  {"u8", ValueType::uint64},
        {"f4", ValueType::float32}, {"f8", ValueType::float64}};
    for (const Word& one : words)
        if (one.word == word) return one.type;
    return {};
}

bool is_npy(const std::filesystem::path& path) {
    if (file_beginning(path, npy_magic.size()) == npy_magic) return true;
    if (!has_zip_mark(path)) return false;
    try {
        return std::ranges::any_of(ZipArchive(path).members(), [](const auto& member) {
            return member.first.ends_with(".npy");
        });
    } catch (const Error&) {
        return false;
    }
}

Volume open_npy(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use) {
    expect_regular_file(path);
    if (has_zip_mark(path)) return Npz(path).open(request, use);
    if (!request.array.empty())
        fail("{}: array: expected no such key: .npy files hold only one", path.string());
    NpyArray array = npy_array(path, path.string(), NpyHeader(path), request);
    array.data.files = {path};
    return open_npy_array(array, use);
}

}  // namespace lamina
