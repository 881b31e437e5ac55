// SPDX-License-Identifier: Apache-2.0
// Data sets of HDF5, their types, and the filters that libhdf5 itself does not have
// (https://github.com/HDFGroup/hdf5_plugins, RegisteredFilterPlugins.md).
#include "volume_files/hdf5_array.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "base/error.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

constexpr int most_rank = 8;

// Most bytes that a byte of a packed data set gives: deflate's 1032, squared for data packed twice.
constexpr std::uint64_t most_hdf5_expansion = 1 << 20;

constexpr std::size_t most_numbers = 64, most_texts = 4096, most_letters = 1 << 20;

hid_t memory_type(ValueType type) {
    const hid_t types[] = {H5T_NATIVE_INT8,  H5T_NATIVE_UINT8,  H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
                           H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                           H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
    return types[static_cast<std::size_t>(type)];
}

// Returns the type of the values of an enumeration, such as h5py's truth values; else a copy.
Hdf5Handle stored_type_of(hid_t type) {
    return {H5Tget_class(type) == H5T_ENUM ? H5Tget_super(type) : H5Tcopy(type), H5Tclose};
}

// Tells if a type is one byte of bits, in which PyTables stores truth values.
bool is_byte_of_bits(hid_t type) {
    return H5Tget_class(type) == H5T_BITFIELD && H5Tget_size(type) == 1;
}

bool has_numbers(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM || is_byte_of_bits(type);
}

// Returns nothing if samples of this HDF5 type are not numbers that can be drawn.
std::optional<ValueType> type_of_hdf5(hid_t type) {
    if (!has_numbers(type)) return {};
    if (is_byte_of_bits(type)) return ValueType::uint8;
    const Hdf5Handle values = stored_type_of(type);
    const bool integers = H5Tget_class(values.id()) == H5T_INTEGER;
    const std::size_t bytes = H5Tget_size(values.id());
    const bool is_truth = H5Tget_class(type) == H5T_ENUM && bytes == 1;
    return number_type(!integers && bytes == 2 ? 4 : bytes, integers,
                       !integers || (H5Tget_sign(values.id()) == H5T_SGN_2 && !is_truth));
}

// Returns the words of a type that is not read, as a message says them.
std::string words_for(hid_t type) {
    constexpr const char* words[] = {
        "numbers", "numbers",   "times",      "text",  "bits",
        "opaque",  "compounds", "references", "names", "lists (of variable length)",
        "arrays"};
    const H5T_class_t kind = H5Tget_class(type);
    if (kind < 0 || kind >= H5T_NCLASSES) return "an unknown type";
    if (kind != H5T_COMPOUND) return fmt::format("{} of {} bytes", words[kind], H5Tget_size(type));
    std::vector<std::string> members;
    for (int i = 0; i < std::min(H5Tget_nmembers(type), 8); ++i) {
        char* const name = H5Tget_member_name(type, static_cast<unsigned>(i));
        members.push_back(one_line(name == nullptr ? "" : name));
        H5free_memory(name);
    }
    const bool complex =
        members.size() == 2 && members[0].starts_with('r') && members[1].starts_with('i');
    return fmt::format("{} of {}", complex ? "complex numbers" : "compounds",
                       fmt::join(members, ", "));
}

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

// Returns the number of bytes that a filter's values promise of each chunk if the filter is LZF,
// else nothing. Values that are missing promise 0.
std::optional<std::size_t> lzf_chunk_bytes(H5Z_filter_t number, std::span<const unsigned> values) {
    if (number != lzf) return {};
    return values.size() < 3 ? 0 : values[2];
}

// Returns the name of a filter that libhdf5 lacks; empty if it is not known.
std::string filter_name(H5Z_filter_t number) {
    const auto found =
        std::ranges::find_if(filters, [&](const auto& one) { return one.number == number; });
    return found == std::end(filters) ? "" : found->name;
}

}  // namespace

void add_lzf_filter() {
    if (H5Zfilter_avail(lzf) > 0) return;
    constexpr H5Z_class2_t filter{H5Z_CLASS_T_VERS, lzf, 0, 1, "LZF", nullptr, nullptr, read_lzf};
    H5Zregister(&filter);
}

std::vector<double> numbers_of(hid_t object, const std::string& key) {
    if (H5Aexists(object, key.c_str()) <= 0) return {};
    const Hdf5Handle found(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose);
    const Hdf5Handle space(H5Aget_space(found.id()), H5Sclose);
    const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
    if (!space.valid() || !type.valid() || !has_numbers(type.id())) return {};
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (count < 1 || count > static_cast<hssize_t>(most_numbers)) return {};
    std::vector<double> numbers(static_cast<std::size_t>(count));
    if (H5Aread(found.id(), H5T_NATIVE_DOUBLE, numbers.data()) < 0) return {};
    return numbers;
}

std::optional<ValueType> type_of(hid_t object, const std::string& key) {
    if (H5Aexists(object, key.c_str()) <= 0) return {};
    const Hdf5Handle found(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
    return type_of_hdf5(type.id());
}

std::vector<std::string> texts_of(hid_t object, const std::string& key) {
    if (H5Aexists(object, key.c_str()) <= 0) return {};
    const Hdf5Handle found(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose);
    const Hdf5Handle space(H5Aget_space(found.id()), H5Sclose);
    const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
    if (!space.valid() || !type.valid() || H5Tget_class(type.id()) != H5T_STRING) return {};
    const hssize_t points = H5Sget_simple_extent_npoints(space.id());
    if (points < 1 || points > static_cast<hssize_t>(most_texts)) return {};
    const auto count = static_cast<std::size_t>(points), bytes = H5Tget_size(type.id());
    std::vector<std::string> texts;
    if (H5Tis_variable_str(type.id()) > 0) {
        std::vector<char*> words(count, nullptr);
        if (H5Aread(found.id(), type.id(), words.data()) < 0) return {};
        for (const char* const word : words) texts.emplace_back(word == nullptr ? "" : word);
        H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, words.data());
    } else if (bytes > 0 && bytes <= most_letters / count) {
        std::string letters(count * bytes, '\0');
        if (H5Aread(found.id(), type.id(), letters.data()) < 0) return {};
        for (std::size_t i = 0; i < count; ++i)
            texts.emplace_back(letters.substr(i * bytes, bytes).c_str());
    }
    return texts;
}

std::string text_of(hid_t object, const std::string& key) {
    return fmt::format("{}", fmt::join(texts_of(object, key), ""));
}

std::vector<double> numbers_in(hid_t set, std::size_t count) {
    const Hdf5Handle space(H5Dget_space(set), H5Sclose);
    const Hdf5Handle type(H5Dget_type(set), H5Tclose);
    if (!space.valid() || !type.valid() || !has_numbers(type.id())) return {};
    if (H5Dget_storage_size(set) == 0) return {};  // a dimension of NetCDF without coordinates
    const hssize_t points = H5Sget_simple_extent_npoints(space.id());
    if (points < 1 || (count != 0 && points != static_cast<hssize_t>(count))) return {};
    if (count == 0 && points > static_cast<hssize_t>(most_numbers)) return {};
    std::vector<double> numbers(static_cast<std::size_t>(points));
    if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
        return {};
    return numbers;
}

bool is_virtual(hid_t set) {
    const Hdf5Handle properties(H5Dget_create_plist(set), H5Pclose);
    return !properties.valid() || H5Pget_layout(properties.id()) == H5D_VIRTUAL;
}

bool stores_elsewhere(hid_t set) {
    const Hdf5Handle properties(H5Dget_create_plist(set), H5Pclose);
    return is_virtual(set) || H5Pget_external_count(properties.id()) > 0;
}

std::optional<ValueType> type_in(hid_t set) {
    const Hdf5Handle type(H5Dget_type(set), H5Tclose);
    return type_of_hdf5(type.id());
}

int rank_of(hid_t set) {
    const Hdf5Handle space(H5Dget_space(set), H5Sclose);
    return H5Sget_simple_extent_ndims(space.id());
}

bool has_axes_of_volume(hid_t set) {
    return rank_of(set) >= 3 && rank_of(set) <= most_rank;
}

bool can_be_volume(hid_t set) {
    const Hdf5Handle type(H5Dget_type(set), H5Tclose);
    return has_axes_of_volume(set) && has_numbers(type.id());
}

Hdf5Array::Hdf5Array(Hdf5Handle set, std::string name)
    : name_(std::move(name)), set_(std::move(set)) {
    if (!set_.valid()) fail("{}: found no data set of this name", name_);
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const int rank = rank_of(set_.id());
    if (rank < 2 || rank > most_rank)
        fail("{}: found {} dimensions, expected 2 to {}", name_, rank, most_rank);
    hsize_t sizes[most_rank] = {};
    H5Sget_simple_extent_dims(space.id(), sizes, nullptr);
    for (int axis = 0; axis < rank; ++axis) {
        if (sizes[axis] < 1 || sizes[axis] > (hsize_t{1} << 40))
            fail("{}: dimension {}: found {} samples", name_, axis, sizes[axis]);
        shape_.push_back(static_cast<std::int64_t>(sizes[axis]));
    }
    const Hdf5Handle stored(H5Dget_type(set_.id()), H5Tclose);
    const auto type = type_of_hdf5(stored.id());
    if (!type) {
        fail("{}: type: found {}, expected real numbers of 1, 2, 4 or 8 bytes", name_,
             words_for(stored.id()));
    }
    type_ = *type;
    memory_type_ = is_byte_of_bits(stored.id()) ? H5T_NATIVE_B8 : memory_type(type_);
}

// Returns the number of bytes of a chunk as the file stores it; 0 if there are no chunks.
std::size_t Hdf5Array::stored_chunk_bytes() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    const Hdf5Handle type(H5Dget_type(set_.id()), H5Tclose);
    hsize_t edges[most_rank] = {};
    const int rank = H5Pget_chunk(properties.id(), most_rank, edges);
    std::size_t bytes = rank > 0 ? H5Tget_size(type.id()) : 0;
    for (int axis = 0; axis < rank; ++axis) bytes *= static_cast<std::size_t>(edges[axis]);
    return bytes;
}

// Throws Error if the data set is packed by a filter that this machine's library does not have.
void Hdf5Array::expect_filters() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    const int count = properties.valid() ? H5Pget_nfilters(properties.id()) : 0;
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0, config = 0;
        unsigned values[4] = {};
        std::size_t value_count = std::size(values);
        char word[64] = {};
        const H5Z_filter_t filter =
            H5Pget_filter2(properties.id(), static_cast<unsigned>(i), &flags, &value_count, values,
                           sizeof word, word, &config);
        // The library reads a whole chunk from what a filter gives, whatever the filter says.
        const auto unpacked = lzf_chunk_bytes(
            filter, std::span(values).first(std::min(value_count, std::size(values))));
        if (unpacked && *unpacked != stored_chunk_bytes()) {
            fail("{}: damaged filter LZF: found chunks of {} bytes, expected {}", name_, *unpacked,
                 stored_chunk_bytes());
        }
        if (filter >= 0 && H5Zfilter_avail(filter) <= 0) {
            const std::string known = filter_name(filter);
            fail(
                "{}: found the filter {} ({}), expected one that HDF5 has here: h5repack -f NONE, "
                "or h5py with hdf5plugin, writes the data without it",
                name_, filter,
                !known.empty()    ? known
                : word[0] == '\0' ? "without a name"
                                  : one_line(word));
        }
    }
}

std::vector<std::int64_t> Hdf5Array::chunk() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    if (!properties.valid() || H5Pget_layout(properties.id()) != H5D_CHUNKED) return {};
    hsize_t edges[most_rank] = {};
    const int rank = static_cast<int>(shape_.size());
    if (H5Pget_chunk(properties.id(), most_rank, edges) != rank) return {};
    std::vector<std::int64_t> chunk;
    for (std::size_t axis = 0; axis < shape_.size(); ++axis)
        chunk.push_back(
            std::clamp<std::int64_t>(static_cast<std::int64_t>(edges[axis]), 1, shape_[axis]));
    return chunk;
}

std::optional<Hdf5Array::RawPlace> Hdf5Array::raw_place() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    if (!properties.valid() || H5Pget_layout(properties.id()) != H5D_CONTIGUOUS) return {};
    const haddr_t place = H5Dget_offset(set_.id());
    if (place == HADDR_UNDEF || place > (haddr_t{1} << 62)) return {};
    const Hdf5Handle type(H5Dget_type(set_.id()), H5Tclose), stored = stored_type_of(type.id());
    for (const H5T_order_t order : {H5T_ORDER_LE, H5T_ORDER_BE}) {
        const Hdf5Handle plain(H5Tcopy(memory_type_), H5Tclose);
        if (H5Tset_order(plain.id(), order) >= 0 && H5Tequal(stored.id(), plain.id()) > 0)
            return RawPlace{static_cast<std::int64_t>(place), order == H5T_ORDER_BE};
    }
    return {};
}

void Hdf5Array::expect_readable(std::uint64_t bytes, std::uint64_t file_bytes) const {
    const std::uint64_t stored =
        is_virtual(set_.id()) ? file_bytes
                              : std::min<std::uint64_t>(H5Dget_storage_size(set_.id()), file_bytes);
    if (stored == 0) fail("{}: found no samples in it, expected {} bytes", name_, bytes);
    if (bytes / most_hdf5_expansion > stored) {
        fail("{}: the array promises {} bytes, the file has {}, which cannot hold them", name_,
             bytes, stored);
    }
    expect_filters();
}

void Hdf5Array::read(const std::vector<std::int64_t>& begin, const std::vector<std::int64_t>& count,
                     void* to) const {
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const std::vector<hsize_t> first(begin.begin(), begin.end()), sizes(count.begin(), count.end());
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first.data(), nullptr, sizes.data(), nullptr);
    const Hdf5Handle memory(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                            H5Sclose);
    if (H5Dread(set_.id(), memory_type_, memory.id(), space.id(), H5P_DEFAULT, to) < 0) {
        fail("{}: damaged data: HDF5 cannot read the samples from {} on, {} of each dimension",
             name_, fmt::join(begin, ", "), fmt::join(count, ", "));
    }
}

}  // namespace lamina
