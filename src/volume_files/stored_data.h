// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/value_type.h"
#include "volume_files/byte_readers.h"
#include "volume_files/stored_samples.h"

namespace lamina {

// An axis of an array in a file.
struct StoredAxis {
    StoredAxis(std::int64_t a_size = 1, std::optional<std::int64_t> a_taken = {},
               const char* its_name = "", bool is_given = false)
        : size(a_size), taken(a_taken), what(its_name), given(is_given) {}

    std::int64_t size;
    std::optional<std::int64_t> taken;  // the only index that is read; empty: all are
    const char* what;                   // "channel" or "time", if `taken` is set
    bool given;                         // the request names `taken`
    bool unnamed = false;               // the file does not say what the axis is
};

// Makes an axis of `count` channels or times (`what`: "channel" or "time", the request's key, too),
// of which one is taken: `wanted`, else the first. Throws Error if there is no such index.
StoredAxis taken_axis(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count);

// Makes the axis of `count` that a file does not name: what the request chooses by, else channels
// if there are 2 to 4, else times.
StoredAxis unnamed_axis(const std::string& file, const std::optional<std::int64_t>& channel,
                        const std::optional<std::int64_t>& time, std::int64_t count);

// Returns the end of a message on a part of a file that is taken: "array" in the volume names
// another, and how the command line says that. `value`: an example of a name.
std::string names_another(std::string_view key, std::string_view value);

// Warns of each axis of which index 0 is taken only because the request names none, and of
// each that the file does not name.
void say_taken(const std::string& file, std::span<const StoredAxis> axes);

// Returns the number of bytes of an array, or, if `taken_only`, of what is taken of it. Throws
// Error if these are more than any file holds (2^62). `file`: for messages.
std::size_t stored_bytes(const std::string& file, std::span<const StoredAxis> axes,
                         std::size_t value_bytes, bool taken_only = false);

// Reads an array and stores what is taken of it to `to`, in its order. `axes`: the fastest first.
void read_taken(ByteReader& reader, std::span<const StoredAxis> axes, std::size_t value_bytes,
                void* to);

// Copies what is taken of an array in memory, in its order; returns the end of the copy.
char* take_of_memory(const char* from, std::span<const StoredAxis> axes, std::size_t value_bytes,
                     char* to);

// Returns the index that taken_axis() takes, and warns as say_taken() does.
std::int64_t taken_of(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count);

enum class DataEncoding { raw, ascii, hex, gzip, bzip2 };  // gzip stands for zlib, too

// Describes where the samples of a volume lie, as a header says.
struct StoredData {
    std::filesystem::path path;         // the file that the user named
    const char* teller = "the header";  // names the source of this description in messages
    ValueType type = ValueType::uint8;
    std::vector<StoredAxis> axes;  // the data's, fastest first; `taken` selects the volume
    DataEncoding encoding = DataEncoding::raw;
    bool swap_bytes = false;  // the samples are not in this machine's byte order
    // At least one: `path` itself if the header is attached. All hold the same number of samples.
    std::vector<std::filesystem::path> files;
    std::int64_t offset = 0;     // bytes to skip first in each
    std::int64_t line_skip = 0;  // lines to skip next
    // Bytes to skip last, after decompression; -1 - n: raw data end n bytes before the file's end.
    std::int64_t byte_skip = 0;
    double scale = 1, shift = 0;  // StoredSamples::scale and offset

    bool is_scaled() const { return scale != 1 || shift != 0; }
};

// Sets swap_bytes. Type and encoding must be set before.
void set_byte_order(StoredData& data, bool big_endian);

// Throws Error unless a file that another one names may be opened, and is a regular file. `what`:
// for messages, such as "data file of a.nhdr".
void expect_named_file(const std::filesystem::path& file, const std::string& what);

// Sets `files`, which a header in `path` names relative to itself. Axes must be set before. Each
// file holds the first `axes_each` axes; if these are all axes, an equal share of the last. If
// `axes_each` is empty, a single file holds all axes, and each of several all but the last. Throws
// Error if the number of files does not fit, or if one is no regular file. `field`: for messages.
void set_data_files(StoredData& data, const std::vector<std::string>& names,
                    const std::optional<std::size_t>& axes_each, const char* field);

// Places raw data at byte `begin` of their only file, which may have other bytes behind them. Axes,
// type and file must be set before.
void place_raw(StoredData& data, std::uint64_t begin);

// Reads what is taken of the data. Takes memory only after it has checked that the files can hold
// what the header promises; a warning counts surplus bytes. Throws Error.
StoredSamples read_stored(const StoredData& data);

// Reads the data that a StoredData describes.
class StoredReader {
  public:
    // `data` must outlive the reader. Throws Error if the files cannot hold them.
    explicit StoredReader(const StoredData& data);

    // Reads what is taken of the data, as read_stored() does.
    StoredSamples read() const;
    // Returns the byte of each file with which its samples begin; for raw data only.
    std::vector<std::int64_t> raw_offsets() const;
    // Returns a reader of all data, taken or not, except text. The StoredReader must outlive it.
    std::unique_ptr<ByteReader> open_all() const;
    // Warns of bytes beyond those that the header promises. Must be called when all data are read.
    void warn_of_surplus(ByteReader& reader) const;

  private:
    OpenedFile open(const std::filesystem::path& path) const;
    std::uint64_t capacity(std::uint64_t stored) const;
    void check_capacity(const std::filesystem::path& path) const;
    void skip_bytes(std::FILE* file) const;
    std::unique_ptr<ByteReader> open_binary(const std::filesystem::path& path) const;
    std::shared_ptr<void> text_samples() const;
    std::shared_ptr<void> taken(std::shared_ptr<void> all) const;

    const StoredData& data_;
    std::string name_;
    std::size_t bytes_, bytes_each_;  // of all data; of the data in each file
};

}  // namespace lamina
