// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nrrd_data.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "base/error.h"
#include "base/warning.h"
#include "volume_files/bzip2_reader.h"
#include "volume_files/file_reader.h"
#include "volume_files/file_sequence.h"
#include "volume_files/gzip_reader.h"
#include "volume_files/memory_reader.h"
#include "volume_files/nrrd_text.h"
#include "volume_files/opened_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// One byte gives at most so many bytes. bzip2 codes a block of 900,000 bytes, each 5 of them a run
// of 259, in no less than 40 bytes.
constexpr std::uint64_t bzip2_expansion = 900000 / 5 * 259 / 40;

const char* name_of(NrrdEncoding encoding) {
    switch (encoding) {
        case NrrdEncoding::raw:
            return "raw";
        case NrrdEncoding::gzip:
            return "gzip";
        case NrrdEncoding::bzip2:
            return "bzip2";
        case NrrdEncoding::ascii:
            return "ascii";
    }
    return "";
}

// Whether the encoding's byte skip counts bytes of the file, not of what is decoded.
bool skips_stored(const NrrdHeader& header) {
    return header.encoding == NrrdEncoding::raw || header.encoding == NrrdEncoding::ascii;
}

std::string named_size(const NrrdHeader& header) {
    std::vector<std::int64_t> sizes;
    for (const StoredAxis& axis : header.axes) sizes.push_back(axis.size);
    const std::size_t files = header.data_paths.size();
    return fmt::format("{} {} samples{}", fmt::join(sizes, " x "), name_of(header.type),
                       files > 1 ? fmt::format(" in {} files", files) : "");
}

class NrrdData {
  public:
    explicit NrrdData(const NrrdHeader& header)
        : header_(header),
          name_(header.path.string()),
          bytes_(stored_bytes(name_, header.axes, bytes_of(header.type))),
          bytes_each_(bytes_ / header.data_paths.size()) {
        if (header.byte_skip < 0 && header.encoding != NrrdEncoding::raw) {
            fail("{}: byte skip: found {}, which goes with encoding raw only", name_,
                 header.byte_skip);
        }
        for (const Path& path : header.data_paths) check_capacity(path);
    }

    StoredSamples read() {
        StoredSamples samples{name_, header_.type, nullptr};
        if (header_.encoding == NrrdEncoding::ascii) {
            samples.bytes = taken(text_samples());
        } else {
            samples.bytes = sample_memory(taken_bytes(name_, header_.axes, bytes_of(header_.type)));
            const std::unique_ptr<ByteReader> reader = open_all();
            read_taken(*reader, header_.axes, bytes_of(header_.type), samples.bytes.get());
            warn_of_surplus(*reader);
        }
        if (header_.swap_bytes) {
            swap_bytes(samples.bytes.get(), header_.grid.sample_count(), bytes_of(header_.type));
        }
        return samples;
    }

  private:
    OpenedFile open(const Path& path) const {
        OpenedFile file = open_to_read(path, header_.data_offset);
        for (std::int64_t line = 0; line < header_.line_skip; ++line) {
            int c = std::fgetc(file.get());
            while (c != EOF && c != '\n') c = std::fgetc(file.get());
            if (c == EOF) {
                fail("{}: line skip: found {} lines of data, expected {}", name_, line,
                     header_.line_skip);
            }
        }
        return file;
    }

    // The most bytes of samples that `stored` bytes can give.
    std::uint64_t capacity(std::uint64_t stored) const {
        switch (header_.encoding) {
            case NrrdEncoding::raw:
                return stored;
            case NrrdEncoding::gzip:
                return stored * GzipReader::most_expansion;
            case NrrdEncoding::bzip2:
                return stored * bzip2_expansion;
            case NrrdEncoding::ascii:
                return (stored + 1) / 2 * bytes_of(header_.type);
        }
        return 0;
    }

    void check_capacity(const Path& path) const {
        const std::uint64_t stored = bytes_left(open(path).get());
        const auto skipped =
            static_cast<std::uint64_t>(std::max<std::int64_t>(header_.byte_skip, 0));
        const std::uint64_t usable =
            skips_stored(header_) ? stored - std::min(stored, skipped) : stored;
        const std::uint64_t most = capacity(usable);
        if (bytes_each_ <= most) return;
        fail(
            "{}: the header promises {} ({} bytes), {} holds {} bytes of {} data, enough for at "
            "most {} bytes",
            name_, named_size(header_), bytes_each_,
            path == header_.path ? "the file" : path.string(), usable, name_of(header_.encoding),
            most);
    }

    // Moves from the start of the data to the first sample, for encodings whose byte skip counts
    // bytes of the file.
    void skip_bytes(std::FILE* file) const {
        if (header_.byte_skip >= 0) {
            fseeko(file, header_.byte_skip, SEEK_CUR);
            return;
        }
        off_t from_end = 0;
        if (__builtin_sub_overflow(static_cast<off_t>(bytes_each_), header_.byte_skip + 1,
                                   &from_end) ||
            fseeko(file, -from_end, SEEK_END) != 0 || ftello(file) < header_.data_offset) {
            fail("{}: byte skip {}: the file is too short for it", name_, header_.byte_skip);
        }
    }

    std::unique_ptr<ByteReader> open_binary(const Path& path) const {
        OpenedFile file = open(path);
        if (header_.encoding == NrrdEncoding::raw) {
            skip_bytes(file.get());
            // Where data are counted from the end of the file, the header says how many bytes
            // follow them.
            return std::make_unique<FileReader>(std::move(file), path.string(),
                                                header_.byte_skip >= 0);
        }
        std::unique_ptr<ByteReader> reader;
        if (header_.encoding == NrrdEncoding::gzip)
            reader = std::make_unique<GzipReader>(std::move(file), path.string());
        else
            reader = std::make_unique<Bzip2Reader>(std::move(file), path.string());
        reader->skip(static_cast<std::size_t>(header_.byte_skip));
        return reader;
    }

    std::unique_ptr<ByteReader> open_all() const {
        if (header_.data_paths.size() == 1) return open_binary(header_.data_paths[0]);
        return std::make_unique<FileSequence>(
            header_.data_paths, bytes_each_,
            [this](const Path& path) { return open_binary(path); });
    }

    // All samples of the files, whatever is taken of them.
    std::shared_ptr<void> text_samples() const {
        std::shared_ptr<void> all = sample_memory(bytes_);
        auto* to = static_cast<char*>(all.get());
        for (const Path& path : header_.data_paths) {
            const OpenedFile file = open(path);
            skip_bytes(file.get());
            read_text_samples(file.get(), path.string(), header_.type,
                              static_cast<std::int64_t>(bytes_each_ / bytes_of(header_.type)), to);
            to += bytes_each_;
        }
        return all;
    }

    std::shared_ptr<void> taken(std::shared_ptr<void> all) const {
        const std::size_t bytes = taken_bytes(name_, header_.axes, bytes_of(header_.type));
        if (bytes == bytes_) return all;
        std::shared_ptr<void> some = sample_memory(bytes);
        MemoryReader reader({static_cast<const char*>(all.get()), bytes_}, name_);
        read_taken(reader, header_.axes, bytes_of(header_.type), some.get());
        return some;
    }

    void warn_of_surplus(ByteReader& reader) const {
        const Path& path = header_.data_paths.size() == 1 ? header_.data_paths[0] : header_.path;
        for (const std::string& surplus : reader.surplus()) {
            warn(fmt::format("{}: found {} than the {} of the header: they are not used",
                             path.string(), surplus, named_size(header_)));
        }
    }

    const NrrdHeader& header_;
    std::string name_;
    std::size_t bytes_, bytes_each_;
};

}  // namespace

StoredSamples read_nrrd_samples(const NrrdHeader& header) {
    return NrrdData(header).read();
}

}  // namespace lamina
