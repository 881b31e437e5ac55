// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/value_type.h"
#include "volume_files/tiff_description.h"

namespace lamina {

struct TiffPage {
    std::uint32_t number = 0;  // in its file, from 0
    std::uint64_t place = 0;   // byte of the file at which its directory lies
    std::int64_t width = 0, height = 0;
    std::int64_t depth = 1;    // images, one behind the other (SGI's tag ImageDepth)
    std::int64_t samples = 1;  // of each pixel
    bool planar = false;       // each sample of a pixel in a plane of its own
    bool is_reduced = false;   // a smaller copy of another page, or a mask
    std::uint16_t bits = 1, format = SAMPLEFORMAT_UINT;  // of a sample
    // Byte of the file at which its samples begin if they lie there as they are, in one piece.
    std::optional<std::uint64_t> raw;
    bool is_big_endian = false;

    // Tells if samples are not whole bytes, but beside each other in the bits of a row.
    bool is_bitwise() const { return bits % 8 != 0; }
    bool is_half() const { return format == SAMPLEFORMAT_IEEEFP && bits == 16; }
    bool is_like(const TiffPage& other) const;  // in size and type
    std::string type_text() const;
    // Returns the type of samples as they are read, that of halves (binary16) as uint16. Throws
    // Error if lamina reads no such samples.
    ValueType type(const std::string& file) const;

  private:
    std::optional<ValueType> known_type() const;
};

// A TIFF file, read page by page through libtiff. All functions throw Error with libtiff's reason.
class TiffFile {
  public:
    explicit TiffFile(const std::filesystem::path& path);

    const std::string& name() const { return name_; }

    // A file opens at its first page.
    void go_to_first();
    bool next_page();  // returns false at the end
    // Moves to a page by its place: a search by number reads all pages before it.
    void go_to(const TiffPage& page);

    TiffPage page() const;
    // Returns what the page says about the stack, but for the number of pages.
    TiffBeginning beginning() const;
    // Warns of what the page says that is not used, and throws Error for files whose pages mean
    // something else. `described`: a description gives distances.
    void check_tags(bool described) const;

    bool is_tiled() const { return TIFFIsTiled(tiff_.get()) != 0; }
    // Returns the most bytes of samples in the file, if all pages are packed like this one.
    std::uint64_t capacity() const;
    // Reads one sample of all pixels of one of the page's images, row by row, in native byte order:
    // width * height values.
    void read(const TiffPage& page, std::int64_t sample, std::int64_t image, char* to);

  private:
    bool is_packed() const;
    std::int64_t rows_of_strips(const TiffPage& page) const;
    std::optional<std::uint64_t> raw_samples(const TiffPage& page) const;
    void check_compression() const;
    // Throws Error if the file ends before the last page says whether another follows: libtiff
    // takes that for the end of the pages. `place`: byte of the file at which its directory lies.
    void check_last_link(std::uint64_t place) const;
    double resolution(ttag_t tag) const;  // pixels per unit of length; 0: unknown
    std::string description() const;
    void check_makers(bool described) const;
    void check_capacity(const TiffPage& page) const;
    void read_strips(const TiffPage& page, std::int64_t sample, char* to);
    void read_tiles(const TiffPage& page, std::int64_t sample, std::int64_t image, char* to);
    [[noreturn]] void fail_with_reason(const char* doing) const;
    static int keep_message(TIFF* tiff, void* file, const char* module, const char* format,
                            va_list arguments);

    template <typename T>
    T field(ttag_t tag, T otherwise) const {
        T value = otherwise;
        return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) != 0 ? value : otherwise;
    }

    std::string name_;
    std::string message_;  // the first of libtiff since it was cleared
    std::uint64_t file_bytes_ = 0;
    std::uint32_t number_ = 0;  // the page's, from 0
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
};

}  // namespace lamina
