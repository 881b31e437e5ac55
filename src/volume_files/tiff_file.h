// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/value_type.h"

namespace lamina {

// The form of a page of a TIFF file.
struct TiffPage {
    std::int64_t width = 0, height = 0;
    std::int64_t samples = 1;  // a pixel's
    bool planar = false;       // each of these in a plane of its own
    ValueType type = ValueType::uint8;

    bool operator==(const TiffPage&) const = default;
};

// A TIFF file, read page by page through libtiff. All functions throw Error with libtiff's reason.
class TiffFile {
  public:
    explicit TiffFile(const std::filesystem::path& path);

    const std::string& name() const { return name_; }
    // Moves to the next page; returns false at the end. A file opens at its first page.
    bool next_page();
    // Moves to a page. `place`: the value that place() had there; finding a page by its number
    // alone reads all before it.
    void go_to_page(std::uint32_t number, std::uint64_t place);
    std::uint64_t place() const;  // the page's, in bytes of the file

    bool is_reduced() const;  // a smaller copy of another page, or a mask
    TiffPage page() const;
    std::string description() const;  // the page's; empty: none
    // Returns the most bytes of samples that the file can hold, if all pages are packed as this one
    // is.
    std::uint64_t capacity() const;
    // Returns pixels a unit along x and y, whichever unit that is; 0: unknown.
    double resolution(int axis) const;

    // Reads one of the samples of all pixels of the page, row by row, in native byte order, into
    // width * height values.
    void read(const TiffPage& page, std::int64_t sample, char* to);

  private:
    void read_strips(const TiffPage& page, std::int64_t sample, char* to);
    void read_tiles(const TiffPage& page, std::int64_t sample, char* to);
    void check_capacity(const TiffPage& page) const;
    [[noreturn]] void fail_with_reason(const char* doing) const;
    template <typename T>
    T field(ttag_t tag, T otherwise) const;

    static int keep_message(TIFF* tiff, void* file, const char* module, const char* format,
                            va_list arguments);

    std::string name_;
    std::string message_;  // libtiff's first since the last call
    std::uint64_t file_bytes_ = 0;
    std::uint32_t number_ = 0;  // the page's, from 0
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
};

}  // namespace lamina
