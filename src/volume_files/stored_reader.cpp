// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stored_reader.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "volume_files/bzip2_reader.h"
#include "volume_files/file_reader.h"
#include "volume_files/file_sequence.h"
#include "volume_files/gzip_reader.h"
#include "volume_files/memory_reader.h"
#include "volume_files/opened_file.h"
#include "volume_files/text_samples.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// One byte gives at most so many bytes. bzip2 codes a block of 900,000 bytes, each 5 of them a run
// of 259, in no less than 40 bytes.
constexpr std::uint64_t bzip2_expansion = 900000 / 5 * 259 / 40;

const char* name_of(DataEncoding encoding) {
    switch (encoding) {
        case DataEncoding::raw:
            return "raw";
        case DataEncoding::gzip:
            return "gzip";
        case DataEncoding::bzip2:
            return "bzip2";
        case DataEncoding::ascii:
            return "ascii";
    }
    return "";
}

// Whether the encoding's byte skip counts bytes of the file, not of what is decoded.
bool skips_stored(const StoredData& data) {
    return data.encoding == DataEncoding::raw || data.encoding == DataEncoding::ascii;
}

std::string named_size(const StoredData& data) {
    std::vector<std::int64_t> sizes;
    for (const StoredAxis& axis : data.axes) sizes.push_back(axis.size);
    const std::size_t files = data.files.size();
    return fmt::format("{} {} samples{}", fmt::join(sizes, " x "), name_of(data.type),
                       files > 1 ? fmt::format(" in {} files", files) : "");
}

}  // namespace

StoredReader::StoredReader(const StoredData& data)
    : data_(data),
      name_(data.path.string()),
      bytes_(stored_bytes(name_, data.axes, bytes_of(data.type))),
      bytes_each_(bytes_ / data.files.size()) {
    if (data.byte_skip < 0 && data.encoding != DataEncoding::raw) {
        fail("{}: byte skip: found {}, which goes with encoding raw only", name_, data.byte_skip);
    }
    for (const Path& path : data.files) check_capacity(path);
}

StoredSamples StoredReader::read() const {
    StoredSamples samples{name_, data_.type, nullptr, data_.scale, data_.shift};
    if (data_.encoding == DataEncoding::ascii) {
        samples.bytes = taken(text_samples());
    } else {
        samples.bytes = filled_memory(taken_bytes(name_, data_.axes, bytes_of(data_.type)));
        const std::unique_ptr<ByteReader> reader = open_all();
        read_taken(*reader, data_.axes, bytes_of(data_.type), samples.bytes.get());
        warn_of_surplus(*reader);
    }
    if (data_.swap_bytes) {
        swap_bytes(samples.bytes.get(),
                   static_cast<std::int64_t>(taken_bytes(name_, data_.axes, 1)),
                   bytes_of(data_.type));
    }
    return samples;
}

std::vector<std::int64_t> StoredReader::raw_offsets() const {
    std::vector<std::int64_t> offsets;
    for (const Path& path : data_.files) {
        const OpenedFile file = open(path);
        skip_bytes(file.get());
        offsets.push_back(ftello(file.get()));
    }
    return offsets;
}

OpenedFile StoredReader::open(const Path& path) const {
    OpenedFile file = open_to_read(path, data_.offset);
    for (std::int64_t line = 0; line < data_.line_skip; ++line) {
        int c = std::fgetc(file.get());
        while (c != EOF && c != '\n') c = std::fgetc(file.get());
        if (c == EOF) {
            fail("{}: line skip: found {} lines of data, expected {}", name_, line,
                 data_.line_skip);
        }
    }
    return file;
}

// The most bytes of samples that `stored` bytes can give.
std::uint64_t StoredReader::capacity(std::uint64_t stored) const {
    switch (data_.encoding) {
        case DataEncoding::raw:
            return stored;
        case DataEncoding::gzip:
            return stored * GzipReader::most_expansion;
        case DataEncoding::bzip2:
            return stored * bzip2_expansion;
        case DataEncoding::ascii:
            return (stored + 1) / 2 * bytes_of(data_.type);
    }
    return 0;
}

void StoredReader::check_capacity(const Path& path) const {
    const std::uint64_t stored = bytes_left(open(path).get());
    const auto skipped = static_cast<std::uint64_t>(std::max<std::int64_t>(data_.byte_skip, 0));
    const std::uint64_t usable = skips_stored(data_) ? stored - std::min(stored, skipped) : stored;
    const std::uint64_t most = capacity(usable);
    if (bytes_each_ <= most) return;
    fail(
        "{}: {} promises {} ({} bytes), {} holds {} bytes of {} data, enough for at most {} "
        "bytes",
        name_, data_.teller, named_size(data_), bytes_each_,
        path == data_.path ? "the file" : path.string(), usable, name_of(data_.encoding), most);
}

// Moves from the start of the data to the first sample, for encodings whose byte skip counts
// bytes of the file.
void StoredReader::skip_bytes(std::FILE* file) const {
    if (data_.byte_skip >= 0) {
        fseeko(file, data_.byte_skip, SEEK_CUR);
        return;
    }
    off_t from_end = 0;
    if (__builtin_sub_overflow(static_cast<off_t>(bytes_each_), data_.byte_skip + 1, &from_end) ||
        fseeko(file, -from_end, SEEK_END) != 0 || ftello(file) < data_.offset) {
        fail("{}: byte skip {}: the file is too short for it", name_, data_.byte_skip);
    }
}

std::unique_ptr<ByteReader> StoredReader::open_binary(const Path& path) const {
    OpenedFile file = open(path);
    if (data_.encoding == DataEncoding::raw) {
        skip_bytes(file.get());
        // Where data are counted from the end of the file, the header says how many bytes
        // follow them.
        return std::make_unique<FileReader>(std::move(file), path.string(), data_.byte_skip >= 0);
    }
    std::unique_ptr<ByteReader> reader;
    if (data_.encoding == DataEncoding::gzip)
        reader = std::make_unique<GzipReader>(std::move(file), path.string());
    else
        reader = std::make_unique<Bzip2Reader>(std::move(file), path.string());
    reader->skip(static_cast<std::size_t>(data_.byte_skip));
    return reader;
}

std::unique_ptr<ByteReader> StoredReader::open_all() const {
    if (data_.files.size() == 1) return open_binary(data_.files[0]);
    return std::make_unique<FileSequence>(data_.files, bytes_each_,
                                          [this](const Path& path) { return open_binary(path); });
}

// All samples of the files, whatever is taken of them.
std::shared_ptr<void> StoredReader::text_samples() const {
    std::shared_ptr<void> all = filled_memory(bytes_);
    auto* to = static_cast<char*>(all.get());
    for (const Path& path : data_.files) {
        const OpenedFile file = open(path);
        skip_bytes(file.get());
        read_text_samples(file.get(), path.string(), data_.type,
                          static_cast<std::int64_t>(bytes_each_ / bytes_of(data_.type)), to);
        to += bytes_each_;
    }
    return all;
}

std::shared_ptr<void> StoredReader::taken(std::shared_ptr<void> all) const {
    const std::size_t bytes = taken_bytes(name_, data_.axes, bytes_of(data_.type));
    if (bytes == bytes_) return all;
    std::shared_ptr<void> some = filled_memory(bytes);
    MemoryReader reader({static_cast<const char*>(all.get()), bytes_}, name_);
    read_taken(reader, data_.axes, bytes_of(data_.type), some.get());
    return some;
}

void StoredReader::warn_of_surplus(ByteReader& reader) const {
    const Path& path = data_.files.size() == 1 ? data_.files[0] : data_.path;
    for (const std::string& surplus : reader.surplus()) {
        warn(fmt::format("{}: found {} than the {} of {}: they are not used", path.string(),
                         surplus, named_size(data_), data_.teller));
    }
}

}  // namespace lamina
