// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume_files/byte_reader.h"
#include "volume_files/opened_file.h"

namespace lamina {

// A file's bytes as they are, from where it stands.
class FileReader : public ByteReader {
  public:
    // `name`: for messages. `counts_surplus`: bytes behind what is read are unexpected.
    FileReader(OpenedFile file, std::string name, bool counts_surplus = true)
        : file_(std::move(file)), name_(std::move(name)), counts_surplus_(counts_surplus) {}

    void read(void* bytes, std::size_t count) override;
    void skip(std::size_t count) override;
    std::vector<std::string> surplus() override;

  private:
    OpenedFile file_;
    std::string name_;
    bool counts_surplus_;
};

}  // namespace lamina
