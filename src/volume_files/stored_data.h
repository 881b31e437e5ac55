// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/value_type.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"

namespace lamina {

enum class DataEncoding { raw, ascii, gzip, bzip2 };  // gzip: or zlib

// Where the samples of a volume lie, as a header says.
struct StoredData {
    std::filesystem::path path;         // the file that the user named
    const char* teller = "the header";  // what says all this, for messages
    ValueType type = ValueType::uint8;
    std::vector<StoredAxis> axes;  // of the data, and what of them makes the volume's samples
    DataEncoding encoding = DataEncoding::raw;
    bool swap_bytes = false;  // the samples are not in this machine's byte order
    // At least one, `path` itself where the header is attached. All hold the same number of
    // samples.
    std::vector<std::filesystem::path> files;
    std::int64_t offset = 0;     // bytes to skip first in each
    std::int64_t line_skip = 0;  // lines to skip next
    // Bytes to skip last, of the decompressed stream. -1 - n means raw data that end n bytes before
    // the end of the file.
    std::int64_t byte_skip = 0;
    double scale = 1, shift = 0;  // what samples mean (StoredSamples)

    bool is_scaled() const { return scale != 1 || shift != 0; }
};

// Sets swap_bytes.
void set_byte_order(StoredData& data, bool big_endian);

// Sets `files`, which a header in `path` names relative to itself, once axes are known: each holds
// the first `axes_each` axes (all but the last where it is empty; all axes where there is one
// file), or an equal part of the last axis. Throws Error where their number does not fit, or one is
// no regular file. `field`: for messages.
void set_data_files(StoredData& data, const std::vector<std::string>& names,
                    const std::optional<std::size_t>& axes_each, const char* field);

// Reads what is taken of the data. It takes memory only after it has checked that the files can
// hold what the header promises; a warning counts what they hold more. Throws Error.
StoredSamples read_stored(const StoredData& data);

// Of raw data: the byte of each file with which its samples begin. Checks as read_stored() does.
std::vector<std::int64_t> raw_data_offsets(const StoredData& data);

}  // namespace lamina
