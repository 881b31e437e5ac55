// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff_file.h"

#include <algorithm>
#include <cstdarg>
#include <cstring>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_data.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// Most bytes that one byte gives with any compression of libtiff: zstd's longest run, 128 KiB,
// takes 4 bytes.
constexpr std::uint64_t most_expansion = 32768;
constexpr tmsize_t most_memory = tmsize_t{1} << 31;  // bytes that libtiff itself may take at once

std::optional<ValueType> type_of(std::uint16_t bits, std::uint16_t format) {
    const bool is_float = format == SAMPLEFORMAT_IEEEFP, is_signed = format == SAMPLEFORMAT_INT;
    if (!is_float && !is_signed && format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID)
        return {};
    switch (bits) {
        case 8:
            if (is_float) return {};
            return is_signed ? ValueType::int8 : ValueType::uint8;
        case 16:
            if (is_float) return {};
            return is_signed ? ValueType::int16 : ValueType::uint16;
        case 32:
            if (is_float) return ValueType::float32;
            return is_signed ? ValueType::int32 : ValueType::uint32;
        case 64:
            if (is_float) return ValueType::float64;
            return is_signed ? ValueType::int64 : ValueType::uint64;
        default:
            return {};
    }
}

}  // namespace

int TiffFile::keep_message(TIFF*, void* file, const char*, const char* format, va_list arguments) {
    TiffFile& self = *static_cast<TiffFile*>(file);
    char text[1000];
    if (!self.message_.empty() || std::vsnprintf(text, sizeof text, format, arguments) <= 0)
        return 1;
    self.message_ = one_line(text);
    // Some of them begin with the file's name, as lamina's do.
    const std::string name = self.name_ + ": ";
    if (self.message_.starts_with(name)) self.message_.erase(0, name.size());
    return 1;  // nobody else need hear of it
}

TiffFile::TiffFile(const std::filesystem::path& path)
    : name_(path.string()), tiff_(nullptr, &TIFFClose) {
    expect_regular_file(path);
    file_bytes_ = std::filesystem::file_size(path);
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
        TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &keep_message, this);
    TIFFOpenOptionsSetWarningHandlerExtR(
        options.get(), [](TIFF*, void*, const char*, const char*, va_list) { return 1; }, this);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), most_memory);
    // m: not mapped, because a file that another process shortens would end this one.
    tiff_.reset(TIFFOpenExt(path.c_str(), "rm", options.get()));
    if (!tiff_) fail_with_reason("cannot be read as TIFF");
}

void TiffFile::fail_with_reason(const char* doing) const {
    fail("{}: page {}: {}: {}", name_, number_ + 1, doing,
         message_.empty() ? "libtiff gives no reason" : message_);
}

bool TiffFile::next_page() {
    message_.clear();
    if (TIFFReadDirectory(tiff_.get()) == 0) {
        if (!message_.empty()) fail("{}: page {}: {}", name_, number_ + 2, message_);
        return false;
    }
    ++number_;
    return true;
}

std::uint64_t TiffFile::place() const {
    return TIFFCurrentDirOffset(tiff_.get());
}

void TiffFile::go_to_page(std::uint32_t number, std::uint64_t place) {
    number_ = number;
    message_.clear();
    if (this->place() != place && TIFFSetSubDirectory(tiff_.get(), place) == 0)
        fail_with_reason("cannot be read");
}

template <typename T>
T TiffFile::field(ttag_t tag, T otherwise) const {
    T value = otherwise;
    return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) != 0 ? value : otherwise;
}

bool TiffFile::is_reduced() const {
    return (field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) &
            (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
}

TiffPage TiffFile::page() const {
    TiffPage page;
    page.width = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    page.height = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    page.samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    page.planar =
        page.samples > 1 &&
        field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
    const auto bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    const auto format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const auto type = type_of(bits, format);
    if (page.width < 1 || page.height < 1 || page.samples < 1) {
        fail("{}: page {}: found {} x {} pixels of {} samples, expected 1 or more", name_,
             number_ + 1, page.width, page.height, page.samples);
    }
    if (!type) {
        const char* const kind = format == SAMPLEFORMAT_IEEEFP ? "floats"
                                 : format > SAMPLEFORMAT_VOID  ? "complex numbers"
                                                               : "integers";
        fail(
            "{}: page {}: found samples that are {} of {} bits, expected integers of 8, 16, 32 or "
            "64 bits, or floats of 32 or 64",
            name_, number_ + 1, kind, bits);
    }
    page.type = *type;
    return page;
}

std::string TiffFile::description() const {
    const char* text = nullptr;
    const bool found = TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) != 0;
    return found && text != nullptr ? text : "";
}

double TiffFile::resolution(int axis) const {
    float value = 0;
    TIFFGetField(tiff_.get(), axis == 0 ? TIFFTAG_XRESOLUTION : TIFFTAG_YRESOLUTION, &value);
    return static_cast<double>(value);
}

// Rejects the sizes of a damaged page, which would take all memory.
void TiffFile::check_capacity(const TiffPage& page) const {
    const StoredAxis axes[] = {page.width, page.height, page.samples};
    const std::size_t bytes = stored_bytes(name_, axes, bytes_of(page.type));
    if (bytes > capacity()) {
        fail("{}: page {} promises {} x {} pixels ({} bytes), the file holds {} bytes{}", name_,
             number_ + 1, page.width, page.height, bytes, file_bytes_,
             capacity() > file_bytes_ ? " of compressed data" : "");
    }
}

std::uint64_t TiffFile::capacity() const {
    const bool packed =
        field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE;
    return file_bytes_ * (packed ? most_expansion : 1);
}

void TiffFile::read(const TiffPage& page, std::int64_t sample, char* to) {
    check_interrupt();
    check_capacity(page);
    message_.clear();
    if (field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_YCBCR)
        TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (TIFFIsTiled(tiff_.get()) != 0)
        read_tiles(page, sample, to);
    else
        read_strips(page, sample, to);
}

namespace {

// Copies one of every `samples` values.
void take_sample(const char* from, std::int64_t samples, std::int64_t sample, std::int64_t count,
                 std::size_t word, char* to) {
    const StoredAxis axes[] = {{samples, sample}, count};
    take_of_memory(from, axes, word, to);
}

}  // namespace

void TiffFile::read_strips(const TiffPage& page, std::int64_t sample, char* to) {
    const std::size_t word = bytes_of(page.type);
    const std::int64_t together = page.planar ? 1 : page.samples;  // samples beside each other
    const std::size_t row_bytes = static_cast<std::size_t>(page.width * together) * word;
    const std::int64_t rows =
        std::min<std::int64_t>(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0xffffffff), page.height);
    if (rows < 1 || TIFFScanlineSize64(tiff_.get()) != row_bytes)
        fail("{}: page {}: its strips do not hold whole rows", name_, number_ + 1);
    const std::int64_t strips = (page.height + rows - 1) / rows;
    std::vector<char> strip(together > 1 ? row_bytes * static_cast<std::size_t>(rows) : 0);
    for (std::int64_t i = 0; i < strips; ++i) {
        check_interrupt();
        const std::int64_t height = std::min(rows, page.height - i * rows);
        const std::size_t bytes = row_bytes * static_cast<std::size_t>(height);
        char* const into = together > 1 ? strip.data() : to;
        const auto number = static_cast<std::uint32_t>(i + (page.planar ? sample * strips : 0));
        const tmsize_t got =
            TIFFReadEncodedStrip(tiff_.get(), number, into, static_cast<tmsize_t>(bytes));
        if (got != static_cast<tmsize_t>(bytes)) fail_with_reason("damaged or truncated");
        const std::int64_t pixels = page.width * height;
        if (together > 1) take_sample(strip.data(), together, sample, pixels, word, to);
        to += static_cast<std::size_t>(pixels) * word;
    }
}

void TiffFile::read_tiles(const TiffPage& page, std::int64_t sample, char* to) {
    const std::size_t word = bytes_of(page.type);
    const std::int64_t together = page.planar ? 1 : page.samples;
    const std::int64_t width = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
    const std::int64_t height = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    const StoredAxis axes[] = {width, height, together};
    const std::size_t tile_bytes = stored_bytes(name_, axes, word);
    if (width < 1 || height < 1 || TIFFTileSize64(tiff_.get()) != tile_bytes ||
        tile_bytes / most_expansion > file_bytes_) {
        fail("{}: page {}: found tiles of {} x {} pixels, more than the file can hold", name_,
             number_ + 1, width, height);
    }
    std::vector<char> tile(tile_bytes), plane(together > 1 ? tile_bytes : 0);
    for (std::int64_t y = 0; y < page.height; y += height) {
        for (std::int64_t x = 0; x < page.width; x += width) {
            check_interrupt();
            const auto number = TIFFComputeTile(
                tiff_.get(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0,
                static_cast<std::uint16_t>(page.planar ? sample : 0));
            const tmsize_t got = TIFFReadEncodedTile(tiff_.get(), number, tile.data(),
                                                     static_cast<tmsize_t>(tile_bytes));
            if (got != static_cast<tmsize_t>(tile_bytes)) fail_with_reason("damaged or truncated");
            const char* from = tile.data();
            if (together > 1) {
                take_sample(from, together, sample, width * height, word, plane.data());
                from = plane.data();
            }
            const std::size_t shown =
                static_cast<std::size_t>(std::min(width, page.width - x)) * word;
            for (std::int64_t row = 0; row < std::min(height, page.height - y); ++row) {
                std::memcpy(to + static_cast<std::size_t>((y + row) * page.width + x) * word,
                            from + static_cast<std::size_t>(row * width) * word, shown);
            }
        }
    }
}

}  // namespace lamina
