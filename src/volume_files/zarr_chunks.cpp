// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zarr_chunks.h"

#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"
#include "volume_files/stored_data.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// The file of hashes has one for each chunk, one for the array's two headers, and one for all
// these.
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

void ZarrChunks::expect_all() const {
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

void ZarrChunks::expect(std::vector<std::uint64_t> hashes) {
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
        // Whole numbers beyond the type are none that its samples could have.
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
