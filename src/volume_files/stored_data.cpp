// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stored_data.h"

#include <bit>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_reader.h"

namespace lamina {
namespace {

// The axes that the files do not hold are counted by them: one file for each of their steps. The
// last axis may be cut into equal pieces, too.
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

}  // namespace

void set_byte_order(StoredData& data, bool big_endian) {
    const bool native_big = std::endian::native == std::endian::big;
    data.swap_bytes =
        data.encoding != DataEncoding::ascii && bytes_of(data.type) > 1 && big_endian != native_big;
}

void set_data_files(StoredData& data, const std::vector<std::string>& names,
                    const std::optional<std::size_t>& axes_each, const char* field) {
    const std::string name = data.path.string();
    check_file_count(data, static_cast<std::int64_t>(names.size()), axes_each, field);
    for (const std::string& file : names) {
        data.files.push_back(data.path.parent_path() / file);
        expect_allowed(data.files.back());
        if (!std::filesystem::is_regular_file(data.files.back())) {
            const bool there = std::filesystem::exists(data.files.back());
            fail("{}: {} of {}: {}", data.files.back().string(), field, name,
                 there ? "not a regular file" : "no such file");
        }
    }
}

StoredSamples read_stored(const StoredData& data) {
    say_taken(data.path.string(), data.axes);
    return StoredReader(data).read();
}

std::vector<std::int64_t> raw_data_offsets(const StoredData& data) {
    return StoredReader(data).raw_offsets();
}

}  // namespace lamina
