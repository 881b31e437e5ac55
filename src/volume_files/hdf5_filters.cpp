// SPDX-License-Identifier: Apache-2.0
// Filters of data sets that libhdf5 itself does not have
// (https://github.com/HDFGroup/hdf5_plugins, RegisteredFilterPlugins.md).
#include "volume_files/hdf5_filters.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

namespace lamina {
namespace {

constexpr H5Z_filter_t lzf = 32000;

constexpr struct {
    H5Z_filter_t number;
    const char* name;
} filters[] = {{307, "bzip2"},        {lzf, "LZF"},   {32001, "Blosc"}, {32004, "LZ4"},
               {32008, "bitshuffle"}, {32013, "ZFP"}, {32015, "zstd"},  {32017, "SZ"},
               {32018, "FCIDECOMP"},  {32024, "SZ3"}, {32026, "Blosc2"}};

// Most bytes that a byte of LZF gives: three bytes repeat up to 264.
constexpr std::size_t lzf_expansion = 264 / 3;

// Unpacks LZF (http://oldhome.schmorp.de/marc/liblzf.html): a byte below 32 begins a run of one
// byte more than it says, others repeat bytes that lie behind by a distance of 13 bits. Returns the
// number of bytes; 0 if the data are damaged or `to` is too short.
std::size_t unpack_lzf(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) {
    std::size_t in = 0, out = 0;
    while (in < from.size()) {
        const std::size_t control = from[in++];
        if (control < 32) {
            const std::size_t count = control + 1;
            if (count > from.size() - in || count > to.size() - out) return 0;
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(in), count,
                        to.begin() + static_cast<std::ptrdiff_t>(out));
            in += count;
            out += count;
            continue;
        }
        std::size_t count = control >> 5;
        if (count == 7 && in < from.size()) count += from[in++];
        count += 2;
        if (in == from.size()) return 0;
        const std::size_t distance = ((control & 31) << 8 | from[in++]) + 1;
        if (distance > out || count > to.size() - out) return 0;
        for (std::size_t i = 0; i < count; ++i, ++out) to[out] = to[out - distance];
    }
    return out;
}

// Unpacks a chunk (H5Z_func_t). h5py's third value is the size of a chunk (lzf_chunk_bytes()).
std::size_t read_lzf(unsigned flags, std::size_t count, const unsigned values[], std::size_t bytes,
                     std::size_t* size, void** buffer) {
    if ((flags & H5Z_FLAG_REVERSE) == 0 || count < 3) return 0;
    const std::size_t unpacked = values[2];
    if (unpacked == 0 || unpacked / lzf_expansion > bytes) return 0;
    void* const memory = H5allocate_memory(unpacked, false);
    if (memory == nullptr) return 0;
    const std::size_t found = unpack_lzf({static_cast<const std::uint8_t*>(*buffer), bytes},
                                         {static_cast<std::uint8_t*>(memory), unpacked});
    const bool is_whole =
        found == unpacked;  // the rest would be memory that nothing was written to
    H5free_memory(is_whole ? *buffer : memory);
    if (!is_whole) return 0;
    *buffer = memory;
    *size = unpacked;
    return found;
}

}  // namespace

void add_lzf_filter() {
    if (H5Zfilter_avail(lzf) > 0) return;
    constexpr H5Z_class2_t filter{H5Z_CLASS_T_VERS, lzf, 0, 1, "LZF", nullptr, nullptr, read_lzf};
    H5Zregister(&filter);
}

std::optional<std::size_t> lzf_chunk_bytes(H5Z_filter_t number, std::span<const unsigned> values) {
    if (number != lzf) return {};
    return values.size() < 3 ? 0 : values[2];
}

std::string filter_name(H5Z_filter_t number) {
    const auto found =
        std::ranges::find_if(filters, [&](const auto& one) { return one.number == number; });
    return found == std::end(filters) ? "" : found->name;
}

}  // namespace lamina
