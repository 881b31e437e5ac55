// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "volume_files/byte_reader.h"
#include "volume_files/opened_file.h"
#include "volume_files/stored_data.h"

namespace lamina {

// Reads data that a header has told.
class StoredReader {
  public:
    // `data` is used as long as this. Throws Error where the files cannot hold them.
    explicit StoredReader(const StoredData& data);

    // Reads what is taken of the data, as read_stored() does.
    StoredSamples read() const;
    // The byte of each file with which its samples begin, of raw data.
    std::vector<std::int64_t> raw_offsets() const;
    // Opens all data of all files, whatever is taken of them; not of text. The reader is used no
    // longer than this.
    std::unique_ptr<ByteReader> open_all() const;
    // Warns of what there is more than the header says, once all is read.
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
    std::size_t bytes_, bytes_each_;
};

}  // namespace lamina
