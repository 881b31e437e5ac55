// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/parallel.h"
#include "base/warning.h"
#include "volume/bzip2_reader.h"
#include "volume/file_length.h"
#include "volume/gzip_reader.h"
#include "volume/nrrd_text.h"

namespace lamina {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// One byte gives at most so many bytes. Deflate codes 258 bytes in 2 bits (zlib, "Technical
// details": 1032:1). bzip2 codes a block of 900,000 bytes, each 5 of them a run of 259, in no less
// than 40 bytes.
constexpr std::uint64_t gzip_expansion = 1032;
constexpr std::uint64_t bzip2_expansion = 900000 / 5 * 259 / 40;

std::string named_size(const NrrdHeader& header) {
    const auto& size = header.grid.size;
    return fmt::format("{} x {} x {} {} samples", size[0], size[1], size[2], name_of(header.type));
}

std::uint64_t byte_count(const NrrdHeader& header) {
    std::uint64_t bytes = bytes_of(header.type);
    bool overflow = false;
    for (const std::int64_t size : header.grid.size) {
        overflow |= __builtin_mul_overflow(bytes, static_cast<std::uint64_t>(size), &bytes);
    }
    if (overflow || bytes > (std::uint64_t{1} << 62)) {
        fail("{}: the header promises {}, more than any file holds", header.path.string(),
             named_size(header));
    }
    return bytes;
}

File open_data(const NrrdHeader& header) {
    File file(std::fopen(header.data_path.c_str(), "rb"), &std::fclose);
    if (!file) fail("{}: cannot read: {}", header.data_path.string(), std::strerror(errno));
    if (fseeko(file.get(), header.data_offset, SEEK_SET) != 0) {
        fail("{}: cannot read: {}", header.data_path.string(), std::strerror(errno));
    }
    for (std::int64_t line = 0; line < header.line_skip; ++line) {
        int c = std::fgetc(file.get());
        while (c != EOF && c != '\n') c = std::fgetc(file.get());
        if (c == EOF) {
            fail("{}: line skip: found {} lines of data, expected {}", header.path.string(), line,
                 header.line_skip);
        }
    }
    return file;
}

// Returns the most bytes of samples that `stored` bytes can give.
std::uint64_t capacity(const NrrdHeader& header, std::uint64_t stored) {
    switch (header.encoding) {
        case NrrdEncoding::raw:
            return stored;
        case NrrdEncoding::gzip:
            return stored * gzip_expansion;
        case NrrdEncoding::bzip2:
            return stored * bzip2_expansion;
        case NrrdEncoding::ascii:
            return (stored + 1) / 2 * bytes_of(header.type);
    }
    return 0;
}

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

void check_capacity(const NrrdHeader& header, std::uint64_t stored, std::uint64_t needed) {
    const std::uint64_t skipped =
        header.byte_skip > 0 ? static_cast<std::uint64_t>(header.byte_skip) : 0;
    const bool skips_stored =
        header.encoding == NrrdEncoding::raw || header.encoding == NrrdEncoding::ascii;
    const std::uint64_t usable = skips_stored ? stored - std::min(stored, skipped) : stored;
    const std::uint64_t most = capacity(header, usable);
    if (needed <= most) return;
    fail(
        "{}: the header promises {} ({} bytes), {} holds {} bytes of {} data, enough for at most "
        "{} bytes",
        header.path.string(), named_size(header), needed,
        header.data_path == header.path ? "the file" : header.data_path.string(), usable,
        name_of(header.encoding), most);
}

void warn_of_surplus(const NrrdHeader& header, const std::string& surplus) {
    warn(fmt::format("{}: found {} than the {} of the header: they are not used",
                     header.data_path.string(), surplus, named_size(header)));
}

void read_raw(const NrrdHeader& header, std::FILE* file, unsigned char* samples,
              std::uint64_t count) {
    constexpr std::uint64_t step = std::uint64_t{1} << 26;
    for (std::uint64_t done = 0; done < count;) {
        check_interrupt();
        const std::size_t wanted = std::min(count - done, step);
        const std::size_t got = std::fread(samples + done, 1, wanted, file);
        done += got;
        if (got == wanted) continue;
        fail("{}: found {} bytes of data, expected {}", header.data_path.string(), done, count);
    }
    // Where data are counted from the end of the file, the header says how many bytes follow them.
    const std::uint64_t surplus = header.byte_skip < 0 ? 0 : bytes_left(file);
    if (surplus > 0) warn_of_surplus(header, fmt::format("{} bytes more", surplus));
}

void read_packed(const NrrdHeader& header, PackedReader& reader, unsigned char* samples,
                 std::uint64_t count) {
    reader.skip(static_cast<std::size_t>(header.byte_skip));
    reader.read(samples, count);
    const PackedReader::Surplus surplus = reader.finish();
    if (surplus.unpacked > 0) {
        const char* const at_least =
            surplus.unpacked >= PackedReader::most_unpacked ? "at least " : "";
        warn_of_surplus(header, fmt::format("{}{} bytes of {} data more", at_least,
                                            surplus.unpacked, name_of(header.encoding)));
    }
    if (surplus.behind > 0) {
        warn_of_surplus(header, fmt::format("{} bytes behind its {} data, more", surplus.behind,
                                            name_of(header.encoding)));
    }
}

// Moves from the start of the data to the first sample, for encodings whose byte skip counts bytes
// of the file.
void skip_bytes(const NrrdHeader& header, std::FILE* file, std::uint64_t count) {
    if (header.byte_skip >= 0) {
        fseeko(file, header.byte_skip, SEEK_CUR);
        return;
    }
    off_t from_end = 0;
    if (__builtin_sub_overflow(static_cast<off_t>(count), header.byte_skip + 1, &from_end) ||
        fseeko(file, -from_end, SEEK_END) != 0 || ftello(file) < header.data_offset) {
        fail("{}: byte skip {}: the file is too short for it", header.path.string(),
             header.byte_skip);
    }
}

template <typename Word, typename Swap>
void swap_words(void* samples, std::int64_t count, Swap swap) {
    constexpr std::int64_t chunk = 1 << 20;
    auto* const words = static_cast<Word*>(samples);
    parallel_for((count + chunk - 1) / chunk, 1, [&](std::int64_t i) {
        Word* const end = words + std::min(count, (i + 1) * chunk);
        for (Word* word = words + i * chunk; word != end; ++word) *word = swap(*word);
    });
}

void swap_bytes(const NrrdHeader& header, void* samples) {
    const std::int64_t count = header.grid.sample_count();
    if (bytes_of(header.type) == 2) {
        swap_words<std::uint16_t>(samples, count,
                                  [](std::uint16_t w) { return __builtin_bswap16(w); });
    } else {
        swap_words<std::uint32_t>(samples, count,
                                  [](std::uint32_t w) { return __builtin_bswap32(w); });
    }
}

}  // namespace

std::shared_ptr<const void> read_nrrd_samples(const NrrdHeader& header) {
    const std::uint64_t count = byte_count(header);
    const File file = open_data(header);
    check_capacity(header, bytes_left(file.get()), count);
    const bool skips_stored =
        header.encoding == NrrdEncoding::raw || header.encoding == NrrdEncoding::ascii;
    if (header.byte_skip < 0 && header.encoding != NrrdEncoding::raw) {
        fail("{}: byte skip: found {}, which goes with encoding raw only", header.path.string(),
             header.byte_skip);
    }
    if (skips_stored) skip_bytes(header, file.get(), count);

    // malloc() does not zero the memory as a vector would: gigabytes are filled right afterwards.
    const std::shared_ptr<void> samples(std::malloc(count), &std::free);
    if (!samples) throw std::bad_alloc();
    auto* const bytes = static_cast<unsigned char*>(samples.get());
    switch (header.encoding) {
        case NrrdEncoding::raw:
            read_raw(header, file.get(), bytes, count);
            break;
        case NrrdEncoding::gzip: {
            GzipReader reader(file.get(), header.data_path.string());
            read_packed(header, reader, bytes, count);
            break;
        }
        case NrrdEncoding::bzip2: {
            Bzip2Reader reader(file.get(), header.data_path.string());
            read_packed(header, reader, bytes, count);
            break;
        }
        case NrrdEncoding::ascii:
            read_text_samples(file.get(), header.data_path.string(), header.type,
                              header.grid.sample_count(), bytes);
            break;
    }
    if (header.swap_bytes) swap_bytes(header, samples.get());
    return samples;
}

}  // namespace lamina
