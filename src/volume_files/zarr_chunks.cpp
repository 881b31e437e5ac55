// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2"), and
// numcodecs for the bytes of chunks.
#include "volume_files/zarr_chunks.h"

#include <blosc.h>
#include <fmt/ranges.h>
#include <lz4.h>
#include <sys/stat.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "base/client.h"
#include "base/output_file.h"
#include "volume_files/volume_formats.h"

namespace lamina {

// A compression of chunks. decode() returns false unless it gives exactly chunk.size() bytes.
struct ZarrCodec {
    const char* id;
    bool (*decode)(std::span<const char> stored, std::span<char> chunk);
};

namespace {

using Json = nlohmann::json;

// Upper bound on the bytes that one byte decodes to: zstd packs 2^17 equal bytes into 4.
constexpr std::size_t most_chunk_expansion = 1 << 16;

// Decodes zlib and gzip streams alike, each as a whole.
bool inflate_all(std::span<const char> stored, std::span<char> chunk) {
    constexpr int any_header = 15 + 32;
    if (stored.size() > std::numeric_limits<uInt>::max()) return false;
    z_stream stream{};
    if (inflateInit2(&stream, any_header) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
    stream.avail_in = static_cast<uInt>(stored.size());
    std::size_t done = 0;
    int result = Z_OK;
    while (result == Z_OK) {
        const std::size_t room =
            std::min<std::size_t>(chunk.size() - done, std::numeric_limits<uInt>::max());
        stream.next_out = reinterpret_cast<Bytef*>(chunk.data() + done);
        stream.avail_out = static_cast<uInt>(room);
        result = inflate(&stream, room == 0 ? Z_FINISH : Z_NO_FLUSH);
        done += room - stream.avail_out;
    }
    inflateEnd(&stream);
    return result == Z_STREAM_END && done == chunk.size();
}

bool decode_zstd(std::span<const char> stored, std::span<char> chunk) {
    return ZSTD_decompress(chunk.data(), chunk.size(), stored.data(), stored.size()) ==
           chunk.size();
}

// Decodes a block of LZ4. numcodecs puts the length before it, in four bytes.
bool decode_lz4(std::span<const char> stored, std::span<char> chunk) {
    std::uint32_t size = 0;
    if (stored.size() < sizeof size) return false;
    std::memcpy(&size, stored.data(), sizeof size);
    if constexpr (std::endian::native == std::endian::big) size = __builtin_bswap32(size);
    stored = stored.subspan(sizeof size);
    return size == chunk.size() && std::in_range<int>(stored.size()) &&
           LZ4_decompress_safe(stored.data(), chunk.data(), static_cast<int>(stored.size()),
                               static_cast<int>(size)) == static_cast<int>(size);
}

bool decode_blosc(std::span<const char> stored, std::span<char> chunk) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(stored.data(), stored.size(), &size) != 0) return false;
    if (size != chunk.size()) return false;
    if (size == 0) return true;
    return blosc_decompress_ctx(stored.data(), chunk.data(), chunk.size(), 1) ==
           static_cast<int>(size);
}

constexpr ZarrCodec codecs[] = {{"zlib", inflate_all},
                                {"gzip", inflate_all},
                                {"zstd", decode_zstd},
                                {"lz4", decode_lz4},
                                {"blosc", decode_blosc}};

// Returns the codec by its id; null if that is empty. Throws Error for others.
const ZarrCodec* zarr_codec(const std::string& id, const std::string& name) {
    if (id.empty()) return nullptr;
    for (const ZarrCodec& codec : codecs)
        if (id == codec.id) return &codec;
    fail("{}: compressor: found \"{}\", expected blosc, zlib, gzip, zstd, lz4 or null", name,
         one_line(id));
}

// Decodes a chunk of exactly chunk.size() bytes. Throws Error. `name`: its file, for messages.
void decode_chunk(const ZarrCodec* codec, std::span<const char> stored, std::span<char> chunk,
                  const std::string& name) {
    if (codec == nullptr) {
        if (stored.size() != chunk.size())
            fail("{}: found {} bytes, expected {}", name, stored.size(), chunk.size());
        std::memcpy(chunk.data(), stored.data(), chunk.size());
    } else if (!codec->decode(stored, chunk)) {
        fail("{}: damaged {} data in its {} bytes, or not of the {} bytes that a chunk has", name,
             codec->id, stored.size(), chunk.size());
    }
}

constexpr std::size_t most_zarr_axes = 16;

const Json& zarray_member(const Json& document, const char* key, const std::string& name) {
    const Json* const found = member_of(document, key);
    if (found == nullptr) fail("{}: {}: found none, expected one", name, key);
    return *found;
}

std::vector<std::int64_t> sizes_in(const Json& document, const char* key, const std::string& name) {
    const Json& list = zarray_member(document, key, name);
    std::vector<std::int64_t> sizes;
    bool good = list.is_array() && !list.empty() && list.size() <= most_zarr_axes;
    for (std::size_t i = 0; good && i < list.size(); ++i) {
        good = list[i].is_number_integer() && list[i] >= 1 && list[i] <= (std::int64_t{1} << 40);
        if (good) sizes.push_back(list[i].get<std::int64_t>());
    }
    if (!good) {
        fail("{}: {}: found {}, expected a list of 1 to {} whole numbers above 0", name, key,
             json_excerpt(list), most_zarr_axes);
    }
    return sizes;
}

// Reads NumPy's typestr: byte order, kind, bytes.
void read_type(const Json& document, ZarrArray& array, const std::string& name) {
    const Json& dtype = zarray_member(document, "dtype", name);
    const std::string word = dtype.is_string() ? dtype.get<std::string>() : "";
    const bool ordered = word.size() == 3 && std::string("<>|=").find(word[0]) != std::string::npos;
    const auto type = numpy_type(std::string_view(word).substr(word.empty() ? 0 : 1));
    if (ordered && type) {
        array.type = *type;
        const bool big = std::endian::native == std::endian::big;
        array.swap = (word[0] == '<' && big) || (word[0] == '>' && !big);
        return;
    }
    fail("{}: dtype: found {}, expected a number of 1, 2, 4 or 8 bytes, as in \"<u2\"", name,
         json_excerpt(dtype));
}

double fill_value(const Json& document, const std::string& name) {
    const Json& fill = zarray_member(document, "fill_value", name);
    if (fill.is_null()) return 0;
    if (fill.is_boolean()) return fill.get<bool>() ? 1 : 0;
    if (fill.is_number()) return fill.get<double>();
    if (fill == "NaN") return std::numeric_limits<double>::quiet_NaN();
    if (fill == "Infinity") return std::numeric_limits<double>::infinity();
    if (fill == "-Infinity") return -std::numeric_limits<double>::infinity();
    fail("{}: fill_value: found {}, expected a number", name, json_excerpt(fill));
}

std::string compressor_id(const Json& document, const std::string& name) {
    const Json& compressor = zarray_member(document, "compressor", name);
    if (compressor.is_null()) return "";
    const Json* const id = member_of(compressor, "id");
    if (id == nullptr || !id->is_string())
        fail("{}: compressor: found {}, expected one with an \"id\"", name,
             json_excerpt(compressor));
    return id->get<std::string>();
}

}  // namespace

std::int64_t ZarrArray::chunk_samples() const {
    std::int64_t samples = 1;
    for (const std::int64_t edge : chunks) samples *= edge;
    return samples;
}

ZarrArray read_zarray(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / ".zarray";
    const std::string name = file.string();
    expect_allowed(file);
    const Json document = load_json(file);
    if (!document.is_object())
        fail("{}: found {}, expected an object", name, json_excerpt(document));
    if (const Json& format = zarray_member(document, "zarr_format", name); format != 2)
        fail("{}: zarr_format: found {}, expected 2", name, json_excerpt(format));
    ZarrArray array;
    array.folder = folder;
    array.shape = sizes_in(document, "shape", name);
    array.chunks = sizes_in(document, "chunks", name);
    if (array.chunks.size() != array.shape.size()) {
        fail("{}: chunks: found {} sizes, expected {}, as in its shape", name, array.chunks.size(),
             array.shape.size());
    }
    read_type(document, array, name);
    std::int64_t bytes = static_cast<std::int64_t>(bytes_of(array.type));
    bool overflow = false;
    for (const std::int64_t edge : array.chunks)
        overflow |= __builtin_mul_overflow(bytes, edge, &bytes);
    if (overflow || bytes > std::numeric_limits<std::int32_t>::max())
        fail("{}: chunks: found more than 2 GiB in each, expected fewer", name);
    const Json& order = zarray_member(document, "order", name);
    if (order != "C" && order != "F")
        fail("{}: order: found {}, expected \"C\" or \"F\"", name, json_excerpt(order));
    array.fortran = order == "F";
    array.fill = fill_value(document, name);
    array.codec = zarr_codec(compressor_id(document, name), name);
    const Json* const filters = member_of(document, "filters");
    if (filters != nullptr && !filters->is_null() && !filters->empty())
        fail("{}: filters: found {}, expected null", name, json_excerpt(*filters));
    if (const Json* const separator = member_of(document, "dimension_separator")) {
        if (*separator != "." && *separator != "/") {
            fail("{}: dimension_separator: found {}, expected \".\" or \"/\"", name,
                 json_excerpt(*separator));
        }
        array.separator = separator->get<std::string>()[0];
    }
    return array;
}

namespace {

// The file of hashes has one for each chunk, then one for .zarray and .zattrs together, then one
// for all hashes before.
constexpr const char* file_name = "lamina-chunks";
constexpr std::size_t more_hashes = 2;

std::uint64_t hash_of_headers(const std::filesystem::path& folder) {
    ContentHash hash;
    for (const char* const name : {".zarray", ".zattrs"})
        hash.add(read_large_file(folder / name).text());
    return hash.word();
}

std::uint64_t hash_of_all(std::span<const std::uint64_t> hashes) {
    ContentHash hash;
    hash.add(hashes.data(), hashes.size_bytes());
    return hash.word();
}

template <typename Word>
void copy_row(const char* from, std::size_t step, char* to, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i)
        std::memcpy(to + static_cast<std::size_t>(i) * sizeof(Word),
                    from + static_cast<std::size_t>(i) * step, sizeof(Word));
}

std::array<std::int64_t, 3> x_first(const ZarrChunks::Triple& of) {
    return {of[2], of[1], of[0]};
}

}  // namespace

std::uint64_t hash_of_chunk(std::span<const char> stored) {
    ContentHash hash;
    hash.add(stored.data(), stored.size());
    return hash.word() | 1;  // not no_chunk
}

void write_chunk_hashes(const std::filesystem::path& folder,
                        const std::vector<std::uint64_t>& hashes) {
    std::vector<std::uint64_t> all = hashes;
    all.push_back(hash_of_headers(folder));
    all.push_back(hash_of_all(all));
    AtomicFile file(folder / file_name);
    file.write(all.data(), all.size() * sizeof all[0]);
    file.commit();
}

std::optional<std::vector<std::uint64_t>> read_chunk_hashes(const std::filesystem::path& folder,
                                                            std::int64_t count) {
    std::vector<std::uint64_t> all(static_cast<std::size_t>(count) + more_hashes);
    const std::filesystem::path file = folder / file_name;
    std::error_code absent;
    if (!std::filesystem::is_regular_file(file, absent)) return std::nullopt;
    const ByteBuffer bytes = read_large_file(file);
    if (bytes.size() != all.size() * sizeof all[0]) return std::nullopt;
    std::memcpy(all.data(), bytes.text().data(), bytes.size());
    const std::uint64_t of_all = all.back();
    all.pop_back();
    if (hash_of_all(all) != of_all || hash_of_headers(folder) != all.back()) return std::nullopt;
    all.pop_back();
    return all;
}

ZarrChunks::ZarrChunks(ZarrArray array, ZarrSelection selection)
    : array_(std::move(array)), selection_(std::move(selection)), bytes_(bytes_of(array_.type)) {
    const std::string name = array_.folder.string();
    std::int64_t total = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const int axis = selection_.axes[i];
        if (axis >= 0) {
            const auto at = static_cast<std::size_t>(axis);
            size_[i] = array_.shape[at];
            edge_[i] = array_.chunks[at];
            counts_[i] = array_.chunk_count(at);
        }
        if (__builtin_mul_overflow(total, counts_[i], &total)) total = most_chunks + 1;
    }
    if (total > most_chunks) {
        fail("{}: chunks: found {} x {} x {} of them, expected at most {}", name, counts_[2],
             counts_[1], counts_[0], most_chunks);
    }
    selected_bytes();
    states_.reserve(static_cast<std::size_t>(total));
    for (std::int64_t chunk = 0; chunk < total; ++chunk) {
        if ((chunk & 0xfff) == 0) check_interrupt();
        const FileNow file = file_now(chunk);
        states_.push_back(file.state);
        stored_ += file.bytes;
        files_.add(&file, sizeof file);
    }
    if (stored_ == 0) {
        fail("{}: found no chunk, expected files as {}", name,
             file_of(0).lexically_relative(array_.folder).string());
    }
}

void ZarrChunks::check_plausible_size() const {
    if (const std::size_t bytes = selected_bytes(); bytes / most_chunk_expansion > stored_) {
        fail("{}: the array promises {} bytes, its chunks have {}, which cannot hold them",
             array_.folder.string(), bytes, stored_);
    }
}

std::size_t ZarrChunks::selected_bytes() const {
    const StoredAxis axes[] = {{size_[2], {}}, {size_[1], {}}, {size_[0], {}}};
    return stored_bytes(array_.folder.string(), axes, bytes_);
}

std::int64_t ZarrChunks::missing() const {
    return std::ranges::count(states_, std::uint64_t{0});
}

std::string ZarrChunks::selection_text() const {
    return fmt::format("{} {}", fmt::join(selection_.axes, " "), fmt::join(selection_.index, " "));
}

void ZarrChunks::set_expected_hashes(std::vector<std::uint64_t> hashes) {
    for (std::size_t chunk = 0; chunk < hashes.size(); ++chunk) {
        if (hashes[chunk] != no_chunk && states_[chunk] == 0)
            fail("{}: is missing", file_of(static_cast<std::int64_t>(chunk)).string());
    }
    hashes_ = std::move(hashes);
}

ZarrChunks::FileNow ZarrChunks::file_now(std::int64_t chunk) const {
    const std::filesystem::path file = file_of(chunk);
    expect_allowed(file);
    struct stat found {};
    if (stat(file.c_str(), &found) != 0) return {};
    ContentHash hash;
    const std::int64_t words[] = {found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
    hash.add(words, sizeof words);
    return {hash.word() | 1,  // not 0
            static_cast<std::uint64_t>(found.st_size), static_cast<std::uint64_t>(found.st_ino),
            found.st_ctim.tv_sec * std::int64_t{1'000'000'000} + found.st_ctim.tv_nsec};
}

ZarrChunks::Triple ZarrChunks::place_of(std::int64_t chunk) const {
    return {chunk / (counts_[1] * counts_[2]), chunk / counts_[2] % counts_[1], chunk % counts_[2]};
}

std::filesystem::path ZarrChunks::file_of(std::int64_t chunk) const {
    const Triple place = place_of(chunk);
    std::string name;
    for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
        std::int64_t number = selection_.index[axis] / array_.chunks[axis];
        for (std::size_t i = 0; i < 3; ++i) {
            if (selection_.axes[i] == static_cast<int>(axis)) number = place[i];
        }
        if (axis > 0) name += array_.separator;
        name += std::to_string(number);
    }
    return array_.folder / name;
}

// Returns the bytes between neighbours along an axis in a chunk.
std::size_t ZarrChunks::step_of(std::size_t axis) const {
    std::size_t step = bytes_;
    for (std::size_t i = 0; i < array_.chunks.size(); ++i) {
        if (array_.fortran ? i < axis : i > axis)
            step *= static_cast<std::size_t>(array_.chunks[i]);
    }
    return step;
}

ByteBuffer ZarrChunks::decoded(std::int64_t chunk) const {
    const std::filesystem::path file = file_of(chunk);
    ByteBuffer samples(chunk_bytes());
    if (file_now(chunk).state != state(chunk))
        fail("{}: the file was changed while the array was read", file.string());
    if (state(chunk) == 0) {
        fill(samples);
        return samples;
    }
    const ByteBuffer stored = read_large_file(file);
    if (!hashes_.empty() &&
        hash_of_chunk(stored.text()) != hashes_[static_cast<std::size_t>(chunk)])
        fail(
            "{}: is damaged: it has other bytes than were written; lamina index --bricks makes "
            "the copy again",
            file.string());
    if (samples.size() / most_chunk_expansion > stored.size()) {
        fail("{}: found {} bytes, which cannot hold the {} of a chunk", file.string(),
             stored.size(), samples.size());
    }
    decode_chunk(array_.codec, stored.text(), samples.span(), file.string());
    return samples;
}

template <typename Value>
Value ZarrChunks::fill_as() const {
    if constexpr (std::is_floating_point_v<Value>) {
        return static_cast<Value>(array_.fill);
    } else {
        // A fill value beyond the type's range is no value of a sample.
        const double most = static_cast<double>(std::numeric_limits<Value>::max());
        const double least = static_cast<double>(std::numeric_limits<Value>::min());
        if (!(array_.fill >= least && array_.fill <= most)) {
            fail("{}: fill_value: found {}, expected one that {} holds",
                 (array_.folder / ".zarray").string(), array_.fill, name_of(array_.type));
        }
        return array_.fill >= most ? std::numeric_limits<Value>::max()
                                   : static_cast<Value>(array_.fill);
    }
}

// Fills a chunk with the fill value, in the byte order of the file.
void ZarrChunks::fill(ByteBuffer& samples) const {
    with_type(array_.type, [&](auto zero) {
        using Value = decltype(zero);
        Value value = fill_as<Value>();
        char word[sizeof(Value)];
        std::memcpy(word, &value, sizeof(Value));
        if (array_.swap) std::reverse(word, word + sizeof(Value));
        for (std::size_t at = 0; at < samples.size(); at += sizeof(Value))
            std::memcpy(samples.data() + at, word, sizeof(Value));
    });
}

void ZarrChunks::copy(const ByteBuffer& samples, std::int64_t chunk, const SampleBox& box,
                      char* to) const {
    const char* from = samples.text().data();
    for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
        if (std::ranges::count(selection_.axes, static_cast<int>(axis)) > 0) continue;
        from +=
            static_cast<std::size_t>(selection_.index[axis] % array_.chunks[axis]) * step_of(axis);
    }
    const Triple place = place_of(chunk);
    Triple begin{}, count{}, into{};
    std::array<std::size_t, 3> step{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t first = box.first[2 - i], edge = place[i] * edge_[i];
        begin[i] = std::max(first, edge);
        count[i] =
            std::min(first + box.size[2 - i], std::min(edge + edge_[i], size_[i])) - begin[i];
        into[i] = begin[i] - first;
        const int axis = selection_.axes[i];
        step[i] = axis < 0 ? 0 : step_of(static_cast<std::size_t>(axis));
        from += static_cast<std::size_t>(begin[i] - edge) * step[i];
    }
    for (std::int64_t z = 0; z < count[0]; ++z) {
        for (std::int64_t y = 0; y < count[1]; ++y) {
            const std::int64_t row = (into[0] + z) * box.size[1] + into[1] + y;
            copy_samples(from + static_cast<std::size_t>(z) * step[0] +
                             static_cast<std::size_t>(y) * step[1],
                         step[2],
                         to + static_cast<std::size_t>(row * box.size[0] + into[2]) * bytes_,
                         count[2]);
        }
    }
}

void ZarrChunks::copy_samples(const char* from, std::size_t step, char* to,
                              std::int64_t count) const {
    if (step == bytes_) {
        std::memcpy(to, from, static_cast<std::size_t>(count) * bytes_);
        return;
    }
    with_type(array_.type, [&](auto zero) { copy_row<decltype(zero)>(from, step, to, count); });
}

ZarrSource::ZarrSource(ZarrChunks chunks)
    : ChunkedSource(x_first(chunks.size()), x_first(chunks.edge()), bytes_of(chunks.array().type)),
      chunks_(std::move(chunks)),
      header_(FileState::of(chunks_.array().folder / ".zarray")) {}

void ZarrSource::decode(std::int64_t chunk, const SampleBox& box, void* to) const {
    chunks_.copy(chunks_.decoded(chunk), chunk, box, static_cast<char*>(to));
    const ZarrArray& array = chunks_.array();
    if (array.swap) swap_bytes_alone(to, box.count(), bytes_of(array.type));
}

bool ZarrSource::is_zero(std::int64_t chunk) const {
    return chunks_.array().fill == 0 && chunks_.state(chunk) == 0;
}

std::string ZarrSource::name() const {
    return fmt::format("{} {} {}", std::filesystem::absolute(chunks_.array().folder).string(),
                       fmt::join(chunks_.size(), " "), chunks_.selection_text());
}

std::string ZarrSource::identity() const {
    ContentHash hash;
    hash.add(name());
    hash.add(header_.text());
    const std::uint64_t files = chunks_.files();
    hash.add(&files, sizeof files);
    return hash.hex();
}

}  // namespace lamina
