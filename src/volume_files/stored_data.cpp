// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stored_data.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "base/client.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"

namespace lamina {
namespace {

using Axes = std::span<const StoredAxis>;
using Path = std::filesystem::path;

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_word = 128;

// Cuts a stream into words of bounded length.
class WordReader {
  public:
    explicit WordReader(std::FILE* stream) : stream_(stream), buffer_(buffer_bytes) {}

    // Returns the next word, cut off beyond longest_word, or an empty one at the end of the file.
    const std::string& next() {
        word_.clear();
        int c = get();
        while (is_separator(c)) c = get();
        for (; c != EOF && !is_separator(c); c = get()) {
            if (word_.size() < longest_word) word_ += static_cast<char>(c);
        }
        return word_;
    }

  private:
    static bool is_separator(int c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

    int get() {
        if (at_ == filled_) {
            check_interrupt();
            filled_ = std::fread(buffer_.data(), 1, buffer_.size(), stream_);
            at_ = 0;
            if (filled_ == 0) return EOF;
        }
        return static_cast<unsigned char>(buffer_[at_++]);
    }

    std::FILE* stream_;
    std::vector<char> buffer_;
    std::size_t at_ = 0;
    std::size_t filled_ = 0;
    std::string word_;
};

// Parses a number that is too near to 0 for its type. std::from_chars() reports it as out of range,
// like too large ones; for the latter this returns false.
template <typename T>
bool parse_small(const char* first, const char* end, T& sample) {
    long double wide = 0;  // has a wider range of exponents
    const bool fits = std::from_chars(first, end, wide).ec == std::errc{};
    if (!fits && std::string_view(first, end).find('-', 1) == std::string_view::npos) return false;
    if (std::abs(wide) > 1) return false;
    sample = static_cast<T>(wide);
    return true;
}

template <typename T>
bool parse(const std::string& word, T& sample) {
    const char* const first = word.data() + (word[0] == '+' ? 1 : 0);
    const char* const end = word.data() + word.size();
    if constexpr (std::is_floating_point_v<T>) {
        const auto [stop, error] = std::from_chars(first, end, sample);
        if (stop != end || error == std::errc::invalid_argument) return false;
        return error == std::errc{} || parse_small(first, end, sample);
    } else if (std::from_chars(first, end, sample).ptr == end) {
        return std::from_chars(first, end, sample).ec == std::errc{};
    } else {
        double number = 0;
        const auto [stop, error] = std::from_chars(first, end, number);
        if (error != std::errc{} || stop != end || number != std::floor(number)) return false;
        if (number < static_cast<double>(std::numeric_limits<T>::min()) ||
            number >= std::ldexp(1.0, std::numeric_limits<T>::digits))
            return false;
        sample = static_cast<T>(number);
        return true;
    }
}

// Reads `count` numbers, separated by blanks or commas, into `samples` of `type`. (teem 1.12 reads
// words of any length into a buffer of fixed length, and wraps numbers that do not fit their type.)
// Throws Error; `file` is for messages.
template <typename T>
void read_numbers(std::FILE* stream, const std::string& file, ValueType type, std::int64_t count,
                  T* samples) {
    WordReader reader(stream);
    for (std::int64_t i = 0; i < count; ++i) {
        const std::string& word = reader.next();
        if (word.empty()) fail("{}: found {} samples, expected {}", file, i, count);
        if (!parse(word, samples[i])) {
            fail("{}: sample {} of {}: found '{}', expected a {} of type {}, from {} to {}", file,
                 i + 1, count, word, std::is_floating_point_v<T> ? "number" : "whole number",
                 name_of(type), std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max());
        }
    }
    std::int64_t surplus = 0;
    while (!reader.next().empty()) ++surplus;
    if (surplus > 0) {
        say("{}: found {} numbers or other words more than the {} of the header: they "
            "are not used",
            file, surplus, count);
    }
}

// Arrays of up to this many bytes are read in full; what is taken is then copied in memory.
constexpr std::size_t scratch_bytes = std::size_t{1} << 22;

std::size_t product(Axes axes, std::size_t value_bytes) {
    for (const StoredAxis& axis : axes) value_bytes *= static_cast<std::size_t>(axis.size);
    return value_bytes;
}

std::string sizes_text(Axes axes) {
    std::vector<std::int64_t> sizes;
    for (const StoredAxis& axis : axes) sizes.push_back(axis.size);
    return fmt::format("{}", fmt::join(sizes, " x "));
}

bool takes_all(Axes axes) {
    return std::ranges::none_of(axes,
                                [](const StoredAxis& axis) { return axis.taken.has_value(); });
}

template <std::size_t bytes>
char* gather_values(const char* from, const StoredAxis& channels, std::int64_t count, char* to) {
    from += static_cast<std::size_t>(*channels.taken) * bytes;
    const std::size_t step = static_cast<std::size_t>(channels.size) * bytes;
    for (std::int64_t i = 0; i < count; ++i, from += step, to += bytes)
        std::memcpy(to, from, bytes);
    return to;
}

// Copies the taken channel (axes[0]) of each sample along axes[1]. Because the number of bytes is a
// template argument, each copy is one instruction.
char* gather_row(const char* from, Axes axes, std::size_t value_bytes, char* to) {
    switch (value_bytes) {
        case 1:
            return gather_values<1>(from, axes[0], axes[1].size, to);
        case 2:
            return gather_values<2>(from, axes[0], axes[1].size, to);
        case 4:
            return gather_values<4>(from, axes[0], axes[1].size, to);
        default:
            return gather_values<8>(from, axes[0], axes[1].size, to);
    }
}

// Reads an array in the order of the file and stores what its axes take (StoredAxis::taken):
//   1. An array that is taken as a whole is read straight to the result.
//   2. A small one (scratch_bytes) is read into memory, and what is taken is copied from there.
//   3. If one index of the last axis is taken, the bytes before and after it are skipped.
//   4. Otherwise, the last axis is cut into pieces that fit scratch_bytes.
class TakenReader {
  public:
    TakenReader(ByteReader& reader, std::size_t value_bytes, char* to)
        : reader_(reader), value_bytes_(value_bytes), to_(to) {}

    void read(Axes axes) {
        check_interrupt();
        const std::size_t bytes = product(axes, value_bytes_);
        if (takes_all(axes)) {
            reader_.read(to_, bytes);
            to_ += bytes;
            return;
        }
        const Axes inner = axes.first(axes.size() - 1);
        const StoredAxis& outer = axes.back();
        const std::size_t inner_bytes = product(inner, value_bytes_);
        if (bytes <= scratch_bytes) {
            scratch_.resize(bytes);
            reader_.read(scratch_.data(), bytes);
            to_ = take_of_memory(scratch_.data(), axes, value_bytes_, to_);
        } else if (outer.taken) {
            reader_.skip(static_cast<std::size_t>(*outer.taken) * inner_bytes);
            read(inner);
            reader_.skip(static_cast<std::size_t>(outer.size - *outer.taken - 1) * inner_bytes);
        } else {
            read_pieces(axes, inner_bytes);
        }
    }

  private:
    void read_pieces(Axes axes, std::size_t inner_bytes) {
        std::vector<StoredAxis> piece(axes.begin(), axes.end());
        const auto most = static_cast<std::int64_t>(
            std::max<std::size_t>(1, scratch_bytes / std::max<std::size_t>(1, inner_bytes)));
        for (std::int64_t done = 0; done < axes.back().size; done += piece.back().size) {
            piece.back().size = std::min(most, axes.back().size - done);
            read(piece.back().size == 1 ? axes.first(axes.size() - 1) : Axes(piece));
        }
    }

    ByteReader& reader_;
    std::size_t value_bytes_;
    char* to_;
    std::vector<char> scratch_;
};

// Throws Error unless there is one file for each index on the axes that a single file does not
// hold, or, if a file holds all axes, each has an equal share of the last axis.
void check_file_count(const StoredData& data, std::int64_t found,
                      const std::optional<std::size_t>& axes_each, const char* field) {
    const std::size_t each = axes_each.value_or(data.axes.size() - 1);
    if (found == 1 && !axes_each) return;
    if (each == data.axes.size() && data.axes.back().size % found == 0) return;
    std::int64_t expected = 1;
    for (std::size_t i = each; i < data.axes.size(); ++i)
        if (__builtin_mul_overflow(expected, data.axes[i].size, &expected)) expected = 0;
    if (each >= data.axes.size() || found != expected) {
        fail("{}: {}: found {} files, expected {}, of {} axes each", data.path.string(), field,
             found,
             each >= data.axes.size() ? fmt::format("one or a divisor of {}", data.axes.back().size)
                                      : std::to_string(expected),
             each);
    }
}

const char* name_of(DataEncoding encoding) {
    static constexpr const char* words[] = {"raw", "ascii", "hex", "gzip", "bzip2"};
    return word_of(encoding, words);
}

// Tells if byte_skip counts bytes of the file; otherwise it counts those of the decompressed data.
bool skips_stored(const StoredData& data) {
    return data.encoding != DataEncoding::gzip && data.encoding != DataEncoding::bzip2;
}

std::string named_size(const StoredData& data) {
    const std::size_t files = data.files.size();
    return fmt::format("{} {} samples{}", sizes_text(data.axes), name_of(data.type),
                       files > 1 ? fmt::format(" in {} files", files) : "");
}

}  // namespace

std::size_t stored_bytes(const std::string& file, Axes axes, std::size_t value_bytes,
                         bool taken_only) {
    std::uint64_t bytes = value_bytes;
    bool overflow = false;
    for (const StoredAxis& axis : axes) {
        if (taken_only && axis.taken) continue;
        overflow |= __builtin_mul_overflow(bytes, static_cast<std::uint64_t>(axis.size), &bytes);
    }
    if (overflow || bytes > (std::uint64_t{1} << 62)) {
        fail("{}: the header promises {} samples of {} bytes, more than any file holds", file,
             sizes_text(axes), value_bytes);
    }
    return bytes;
}

void read_taken(ByteReader& reader, Axes axes, std::size_t value_bytes, void* to) {
    TakenReader(reader, value_bytes, static_cast<char*>(to)).read(axes);
}

char* take_of_memory(const char* from, Axes axes, std::size_t value_bytes, char* to) {
    if (takes_all(axes)) {
        const std::size_t bytes = product(axes, value_bytes);
        std::memcpy(to, from, bytes);
        return to + bytes;
    }
    if (axes.size() == 2 && axes[0].taken && !axes[1].taken)
        return gather_row(from, axes, value_bytes, to);
    const Axes inner = axes.first(axes.size() - 1);
    const StoredAxis& outer = axes.back();
    const std::size_t step = product(inner, value_bytes);
    const std::int64_t first = outer.taken.value_or(0);
    const std::int64_t end = outer.taken ? first + 1 : outer.size;
    for (std::int64_t i = first; i < end; ++i)
        to = take_of_memory(from + static_cast<std::size_t>(i) * step, inner, value_bytes, to);
    return to;
}

StoredAxis taken_axis(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count) {
    if (wanted && (*wanted < 0 || *wanted >= count)) {
        fail("{}: {}: found {}, expected a whole number from 0 to {}: the file has {}", file, what,
             *wanted, count - 1, count);
    }
    return {count, wanted.value_or(0), what, wanted.has_value()};
}

StoredAxis unnamed_axis(const std::string& file, const std::optional<std::int64_t>& channel,
                        const std::optional<std::int64_t>& time, std::int64_t count) {
    constexpr std::int64_t most_channels = 4;  // R, G, B, A, or as many dyes
    const bool channels = channel || (!time && count > 1 && count <= most_channels);
    StoredAxis axis = channels ? taken_axis(file, "channel", channel, count)
                               : taken_axis(file, "time", time, count);
    if (channels && time) taken_axis(file, "time", time, 1);
    axis.unnamed = true;
    return axis;
}

std::string names_another(std::string_view key, std::string_view value) {
    return fmt::format("\"{0}\" in the volume names another (--set volume.{0}={1})", key, value);
}

void say_taken(const std::string& file, Axes axes) {
    for (const StoredAxis& axis : axes) {
        if (!axis.taken || axis.given || axis.size == 1) continue;
        if (axis.unnamed) {
            const bool channels = std::string_view(axis.what) == "channel";
            say("{}: the axis of {} has no name and is taken for {}s, of which 0 is "
                "shown: {}, \"{}\" takes the axis for {}s",
                file, axis.size, axis.what, names_another(axis.what, "1"),
                channels ? "time" : "channel", channels ? "time" : "channel");
        } else {
            say("{}: {} 0 of {} is taken: {}", file, axis.what, axis.size,
                names_another(axis.what, "1"));
        }
    }
}

std::int64_t taken_of(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count) {
    const StoredAxis axis = taken_axis(file, what, wanted, count);
    say_taken(file, {&axis, 1});
    return *axis.taken;
}

void set_byte_order(StoredData& data, bool big_endian) {
    const bool native_big = std::endian::native == std::endian::big;
    data.swap_bytes =
        data.encoding != DataEncoding::ascii && bytes_of(data.type) > 1 && big_endian != native_big;
}

void expect_named_file(const Path& file, const std::string& what) {
    expect_allowed(file);
    if (const char* const reason = why_not_regular(file))
        fail("{}: {}: {}", file.string(), what, reason);
}

void set_data_files(StoredData& data, const std::vector<std::string>& names,
                    const std::optional<std::size_t>& axes_each, const char* field) {
    const std::string name = data.path.string();
    check_file_count(data, static_cast<std::int64_t>(names.size()), axes_each, field);
    for (const std::string& file : names) {
        data.files.push_back(data.path.parent_path() / file);
        expect_named_file(data.files.back(), fmt::format("{} of {}", field, name));
    }
}

void place_raw(StoredData& data, std::uint64_t begin) {
    const std::uint64_t end =
        begin + stored_bytes(data.path.string(), data.axes, bytes_of(data.type));
    const std::uint64_t size = std::filesystem::file_size(data.files[0]);
    // Counted from the file's end: what is behind is no surplus. A file that is too short is
    // refused when it is read.
    data.byte_skip =
        end > size ? static_cast<std::int64_t>(begin) : -1 - static_cast<std::int64_t>(size - end);
}

StoredSamples read_stored(const StoredData& data) {
    say_taken(data.path.string(), data.axes);
    return StoredReader(data).read();
}

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
        samples.bytes = filled_memory(stored_bytes(name_, data_.axes, bytes_of(data_.type), true));
        const std::unique_ptr<ByteReader> reader = open_all();
        read_taken(*reader, data_.axes, bytes_of(data_.type), samples.bytes.get());
        warn_of_surplus(*reader);
    }
    if (data_.swap_bytes) {
        swap_bytes(samples.bytes.get(),
                   static_cast<std::int64_t>(stored_bytes(name_, data_.axes, 1, true)),
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

// Returns the most bytes of samples that `stored` bytes of a file can hold.
std::uint64_t StoredReader::capacity(std::uint64_t stored) const {
    if (data_.encoding == DataEncoding::raw) return stored;
    if (data_.encoding == DataEncoding::ascii) return (stored + 1) / 2 * bytes_of(data_.type);
    if (data_.encoding == DataEncoding::hex) return stored / 2;
    return stored * (data_.encoding == DataEncoding::gzip ? gzip_expansion : bzip2_expansion);
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

// Moves from the start of the data to the first sample. Only if skips_stored().
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
        // Data placed from the end of the file have as many bytes behind them as the header says.
        return file_reader(std::move(file), path.string(), data_.byte_skip >= 0);
    }
    if (data_.encoding == DataEncoding::hex) {
        skip_bytes(file.get());
        return hex_reader(std::move(file), path.string());
    }
    const auto open_packed = data_.encoding == DataEncoding::gzip ? gzip_reader : bzip2_reader;
    std::unique_ptr<ByteReader> reader = open_packed(std::move(file), path.string());
    reader->skip(static_cast<std::size_t>(data_.byte_skip));
    return reader;
}

std::unique_ptr<ByteReader> StoredReader::open_all() const {
    if (data_.files.size() == 1) return open_binary(data_.files[0]);
    return sequence_reader(data_.files, bytes_each_,
                           [this](const Path& path) { return open_binary(path); });
}

// Reads all samples of text files, those that are not taken, too.
std::shared_ptr<void> StoredReader::text_samples() const {
    std::shared_ptr<void> all = filled_memory(bytes_);
    auto* to = static_cast<char*>(all.get());
    for (const Path& path : data_.files) {
        const OpenedFile file = open(path);
        skip_bytes(file.get());
        const auto count = static_cast<std::int64_t>(bytes_each_ / bytes_of(data_.type));
        with_type(data_.type, [&](auto zero) {
            read_numbers(file.get(), path.string(), data_.type, count,
                         reinterpret_cast<decltype(zero)*>(to));
        });
        to += bytes_each_;
    }
    return all;
}

std::shared_ptr<void> StoredReader::taken(std::shared_ptr<void> all) const {
    const std::size_t bytes = stored_bytes(name_, data_.axes, bytes_of(data_.type), true);
    if (bytes == bytes_) return all;
    std::shared_ptr<void> some = filled_memory(bytes);
    take_of_memory(static_cast<const char*>(all.get()), data_.axes, bytes_of(data_.type),
                   static_cast<char*>(some.get()));
    return some;
}

void StoredReader::warn_of_surplus(ByteReader& reader) const {
    const Path& path = data_.files.size() == 1 ? data_.files[0] : data_.path;
    for (const std::string& surplus : reader.surplus()) {
        say("{}: found {} than the {} of {}: they are not used", path.string(), surplus,
            named_size(data_), data_.teller);
    }
}

}  // namespace lamina
