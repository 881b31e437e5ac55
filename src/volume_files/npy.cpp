// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/npy.h"

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

}  // namespace

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
    return file_beginning(path, npy_magic.size()) == npy_magic;
}

Volume open_npy(const std::filesystem::path& path, const VolumeRequest&, const VolumeUse& use) {
    expect_regular_file(path);
    const NpyHeader header(path);
    const std::string descr = header.descr();
    const auto type = numpy_type(std::string_view(descr).substr(descr.empty() ? 0 : 1));
    const bool ordered = !descr.empty() && std::string_view("<>|").find(descr[0]) != descr.npos;
    if (!type || !ordered)
        header.wrong("descr", "integers or floats of up to 64 bits, such as '<f4'");
    const std::vector<std::int64_t> shape = header.shape();
    if (shape.size() != 3 || shape[0] < 1 || shape[1] < 1 || shape[2] < 1)
        header.wrong("shape", "three numbers above 0, (z, y, x)");
    const std::array<std::int64_t, 3> size{shape[2], shape[1], shape[0]};
    StoredData data;
    data.path = path;
    data.type = *type;
    data.axes = {size[0], size[1], size[2]};
    set_byte_order(data, descr[0] == '>');
    data.files = {path};
    data.byte_skip = header.data_offset();
    if (!header.is_fortran_order()) return open_stored(plain_grid(size), data, use);
    expect_room(path.string(), stored_bytes(path.string(), data.axes, bytes_of(*type)), use,
                "its first axis is the fastest");
    StoredSamples samples = read_stored(data);
    samples.bytes = with_type(
        *type, [&](auto zero) { return turned<decltype(zero)>(samples.bytes.get(), size); });
    return drawn_volume(plain_grid(size), samples);
}

}  // namespace lamina
