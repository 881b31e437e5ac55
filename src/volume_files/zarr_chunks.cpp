// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zarr_chunks.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/client.h"
#include "base/output_file.h"
#include "volume_files/stored_samples.h"

namespace lamina {

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
            each_file_[i] = array_.files[at] / array_.chunks[at];
        }
        if (__builtin_mul_overflow(total, counts_[i], &total)) total = most_chunks + 1;
    }
    if (total > most_chunks) {
        fail("{}: chunks: found {} x {} x {} of them, expected at most {}", name, counts_[2],
             counts_[1], counts_[0], most_chunks);
    }
    selected_bytes();
    places_.resize(static_cast<std::size_t>(total));
    for (std::int64_t z = 0; z < counts_[0]; z += each_file_[0]) {
        for (std::int64_t y = 0; y < counts_[1]; y += each_file_[1]) {
            check_interrupt();
            for (std::int64_t x = 0; x < counts_[2]; x += each_file_[2]) find_chunks({z, y, x});
        }
    }
    if (stored_ == 0) {
        fail("{}: found no chunk, expected files as {}", name,
             file_of({}).lexically_relative(array_.folder).string());
    }
    if (missing() > 0 && !array_.fill) {
        fail("{}: fill_value: found {}, expected one that {} holds", array_.header_name(),
             array_.fill_text, name_of(array_.type));
    }
}

// Finds the chunks of the file of which `first` is the first chunk.
void ZarrChunks::find_chunks(const Triple& first) {
    const std::filesystem::path file = file_of(first);
    const ZarrFileState now = array_.store.state(file);
    stored_ += now.bytes;
    files_.add(&now, sizeof now);
    if (now.state == 0) return;
    ByteBuffer index;
    if (array_.shards) index = read_index(file, now.bytes);
    Triple end{};
    for (std::size_t i = 0; i < 3; ++i) end[i] = std::min(counts_[i], first[i] + each_file_[i]);
    for (std::int64_t z = first[0]; z < end[0]; ++z) {
        for (std::int64_t y = first[1]; y < end[1]; ++y) {
            for (std::int64_t x = first[2]; x < end[2]; ++x) {
                Place& here =
                    places_[static_cast<std::size_t>((z * counts_[1] + y) * counts_[2] + x)];
                here = {now.state, 0, now.bytes};
                if (!array_.shards) continue;
                std::uint64_t entry[2];
                const std::uint64_t number = number_in_file({z, y, x});
                std::memcpy(entry, index.data() + number * sizeof entry, sizeof entry);
                here.begin = entry[0];
                here.bytes = entry[1];
                const bool is_empty = here.begin == nowhere && here.bytes == nowhere;
                if (!is_empty && (here.begin > now.bytes || here.bytes > now.bytes - here.begin)) {
                    fail(
                        "{}: chunk {}: found {} bytes from byte {} on, expected them in the {} "
                        "of the file",
                        file.string(), number, here.bytes, here.begin, now.bytes);
                }
            }
        }
    }
}

// Reads the index of a file with several chunks (sharding codec, "Binary shard format"): begin and
// bytes of each, 64 bits each, here in native byte order.
ByteBuffer ZarrChunks::read_index(const std::filesystem::path& file,
                                  std::uint64_t file_bytes) const {
    constexpr std::uint64_t entry_bytes = 16, checksum_bytes = 4;
    const ZarrShards& shards = *array_.shards;
    std::uint64_t count = 1;
    bool overflow = false;
    for (std::size_t axis = 0; axis < array_.files.size(); ++axis) {
        overflow |= __builtin_mul_overflow(
            count, static_cast<std::uint64_t>(array_.files[axis] / array_.chunks[axis]), &count);
    }
    const std::uint64_t sums = shards.index_codecs.size() * checksum_bytes;
    if (overflow || count > file_bytes / entry_bytes || count * entry_bytes + sums > file_bytes) {
        fail("{}: found {} bytes, which cannot hold the index of the {} chunks of a file",
             file.string(), file_bytes, overflow ? "very many" : std::to_string(count));
    }
    const std::uint64_t bytes = count * entry_bytes + sums;
    const ByteBuffer stored =
        array_.store.read(file, shards.index_at_end ? file_bytes - bytes : 0, bytes);
    ByteBuffer index(count * entry_bytes);
    decode_chunk(shards.index_codecs, stored.text(), index.span(), file.string() + ": index");
    if (shards.swap_index)
        swap_bytes_alone(index.data(), static_cast<std::int64_t>(2 * count), sizeof count);
    return index;
}

// Returns a chunk's number in the index of its file.
std::uint64_t ZarrChunks::number_in_file(const Triple& index) const {
    std::uint64_t number = 0;
    for (const std::size_t axis : array_.shards->axes) {
        const std::int64_t count = array_.files[axis] / array_.chunks[axis];
        std::int64_t here = selection_.index[axis] / array_.chunks[axis];
        for (std::size_t i = 0; i < 3; ++i)
            if (selection_.axes[i] == static_cast<int>(axis)) here = index[i];
        number =
            number * static_cast<std::uint64_t>(count) + static_cast<std::uint64_t>(here % count);
    }
    return number;
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
    return std::ranges::count(places_, nowhere, &Place::begin);
}

std::string ZarrChunks::selection_text() const {
    return fmt::format("{} {}", fmt::join(selection_.axes, " "), fmt::join(selection_.index, " "));
}

void ZarrChunks::set_expected_hashes(std::vector<std::uint64_t> hashes) {
    for (std::size_t chunk = 0; chunk < hashes.size(); ++chunk) {
        if (const auto number = static_cast<std::int64_t>(chunk);
            hashes[chunk] != no_chunk && !has(number))
            fail("{}: is missing", file_of(index_of(number)).string());
    }
    hashes_ = std::move(hashes);
}

ZarrChunks::Triple ZarrChunks::index_of(std::int64_t chunk) const {
    return {chunk / (counts_[1] * counts_[2]), chunk / counts_[2] % counts_[1], chunk % counts_[2]};
}

std::filesystem::path ZarrChunks::file_of(const Triple& index) const {
    std::string name = array_.key_begin;
    for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
        std::int64_t number = selection_.index[axis] / array_.files[axis];
        for (std::size_t i = 0; i < 3; ++i) {
            if (selection_.axes[i] == static_cast<int>(axis)) number = index[i] / each_file_[i];
        }
        if (axis > 0) name += array_.separator;
        name += std::to_string(number);
    }
    return array_.folder / name;
}

// Returns the bytes between neighbours along an axis in a chunk.
std::size_t ZarrChunks::step_of(std::size_t axis) const {
    std::size_t step = bytes_;
    for (std::size_t i = array_.layout.size(); array_.layout[--i] != axis;)
        step *= static_cast<std::size_t>(array_.chunks[array_.layout[i]]);
    return step;
}

ByteBuffer ZarrChunks::decoded(std::int64_t chunk) const {
    const std::string name = file_of(index_of(chunk)).string();
    const Place& here = place(chunk);
    ByteBuffer samples(chunk_bytes());
    if (array_.store.state(name).state != here.state)
        fail("{}: the file was changed while the array was read", name);
    if (!has(chunk)) {
        fill(samples);
        return samples;
    }
    // No codec makes its data longer than this.
    if (here.bytes / 2 > samples.size() + 4096)
        fail("{}: found {} bytes, expected {} of a chunk at most", name, here.bytes,
             samples.size());
    const ByteBuffer stored =
        array_.shards ? array_.store.read(name, here.begin, here.bytes) : array_.store.read(name);
    if (!hashes_.empty() &&
        hash_of_chunk(stored.text()) != hashes_[static_cast<std::size_t>(chunk)])
        fail(
            "{}: is damaged: it has other bytes than were written; lamina index --bricks makes "
            "the copy again",
            name);
    if (samples.size() / most_chunk_expansion > stored.size()) {
        fail("{}: found {} bytes, which cannot hold the {} of a chunk", name, stored.size(),
             samples.size());
    }
    ByteBuffer halves(array_.is_half ? samples.size() / 2 : 0);
    ByteBuffer& decoded = array_.is_half ? halves : samples;
    decode_chunk(array_.codecs, stored.text(), decoded.span(), name);
    undo_filters(array_.filters, decoded.span());
    if (array_.swap)
        swap_bytes_alone(decoded.data(), array_.chunk_samples(), array_.stored_bytes());
    for (std::size_t i = 0; i < halves.size() / 2; ++i) {
        std::uint16_t half = 0;
        std::memcpy(&half, halves.data() + i * sizeof half, sizeof half);
        const float value = widened_half(half);
        std::memcpy(samples.data() + i * sizeof value, &value, sizeof value);
    }
    return samples;
}

// Fills a chunk with the fill value.
void ZarrChunks::fill(ByteBuffer& samples) const {
    for (std::size_t at = 0; at < samples.size(); at += bytes_)
        std::memcpy(samples.data() + at, array_.fill->data(), bytes_);
}

void ZarrChunks::copy(const ByteBuffer& samples, std::int64_t chunk, const SampleBox& box,
                      char* to) const {
    const char* from = samples.text().data();
    for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
        if (std::ranges::count(selection_.axes, static_cast<int>(axis)) > 0) continue;
        from +=
            static_cast<std::size_t>(selection_.index[axis] % array_.chunks[axis]) * step_of(axis);
    }
    const Triple index = index_of(chunk);
    Triple begin{}, count{}, into{};
    std::array<std::size_t, 3> step{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t first = box.first[2 - i], edge = index[i] * edge_[i];
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

ZarrSource::ZarrSource(ZarrChunks chunks, PackedValues values)
    : ChunkedSource(x_first(chunks.size()), x_first(chunks.edge()), bytes_of(chunks.array().type)),
      chunks_(std::move(chunks)),
      values_(std::move(values)),
      header_(FileState::of(
          chunks_.array().store.on_disk(chunks_.array().folder / chunks_.array().header))) {}

void ZarrSource::decode(std::int64_t chunk, const SampleBox& box, void* to) const {
    chunks_.copy(chunks_.decoded(chunk), chunk, box, static_cast<char*>(to));
    if (values_.can_be_missing()) values_.mark(box.count(), to, to);
}

bool ZarrSource::is_zero(std::int64_t chunk) const {
    const ZarrArray& array = chunks_.array();
    return !chunks_.has(chunk) && !values_.can_be_missing() && *array.fill == std::array<char, 8>{};
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
