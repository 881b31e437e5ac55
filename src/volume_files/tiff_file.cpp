// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <new>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_data.h"

namespace lamina {
namespace {

// Max bytes that one compressed byte expands to: zstd's longest run, 128 KiB, takes 4 bytes.
constexpr std::uint64_t most_expansion = 32768;
constexpr tmsize_t most_memory = tmsize_t{1} << 31;  // bytes that libtiff itself may take at once

// Stores numbers of `bits` bits, the highest first, in values of `Value`. Each row of them begins
// with a byte.
template <typename Value>
void unpack_bits(const char* from, unsigned bits, std::int64_t rows, std::int64_t count,
                 Value* to) {
    for (std::int64_t row = 0; row < rows; ++row) {
        std::uint64_t window = 0;  // the bits that are read and not yet stored
        unsigned held = 0;         // how many
        for (std::int64_t i = 0; i < count; ++i) {
            for (; held < bits; held += 8)
                window = window << 8 | static_cast<unsigned char>(*from++);
            held -= bits;
            *to++ = static_cast<Value>(window >> held & ((std::uint64_t{1} << bits) - 1));
        }
    }
}

// Returns the samples of rows in whole bytes. `type`: the one that they get.
std::vector<char> unpacked(const std::vector<char>& from, unsigned bits, std::int64_t rows,
                           std::int64_t count, ValueType type) {
    std::vector<char> values(static_cast<std::size_t>(rows * count) * bytes_of(type));
    with_type(type, [&](auto zero) {
        if constexpr (std::is_unsigned_v<decltype(zero)>)
            unpack_bits(from.data(), bits, rows, count,
                        reinterpret_cast<decltype(zero)*>(values.data()));
    });
    return values;
}

// Returns the bytes of a row of samples in the file.
std::size_t stored_row(const TiffPage& page, std::int64_t samples) {
    return (static_cast<std::size_t>(samples) * page.bits + 7) / 8;
}

// Copies value number `sample` of every `samples` values, `count` times. `word`: a value's bytes.
void take_sample(const char* from, std::int64_t samples, std::int64_t sample, std::int64_t count,
                 std::size_t word, char* to) {
    const StoredAxis axes[] = {{samples, sample}, count};
    take_of_memory(from, axes, word, to);
}

}  // namespace

bool TiffPage::is_like(const TiffPage& other) const {
    return width == other.width && height == other.height && depth == other.depth &&
           samples == other.samples && planar == other.planar && bits == other.bits &&
           format == other.format;
}

std::string TiffPage::type_text() const {
    const auto type = known_type();
    return is_half() ? "half" : type ? name_of(*type) : fmt::format("{}-bit", bits);
}

std::optional<ValueType> TiffPage::known_type() const {
    const bool floats = format == SAMPLEFORMAT_IEEEFP, is_signed = format == SAMPLEFORMAT_INT;
    if (format > SAMPLEFORMAT_VOID || (is_bitwise() && (bits > 31 || floats || is_signed)))
        return {};
    if (is_half()) return ValueType::uint16;
    const unsigned bytes = is_bitwise() ? std::bit_ceil((bits + 7U) / 8) : bits / 8U;
    return number_type(bytes, !floats, floats || is_signed);
}

ValueType TiffPage::type(const std::string& file) const {
    if (const auto type = known_type()) return *type;
    const char* const kind = format == SAMPLEFORMAT_IEEEFP ? "floats"
                             : format > SAMPLEFORMAT_VOID  ? "complex numbers"
                                                           : "integers";
    fail(
        "{}: page {}: found samples that are {}{} of {} bits, expected integers of 8, 16, 32 or 64 "
        "bits, unsigned ones of 1 to 31 bits but 24, or floats of 16, 32 or 64",
        file, number + 1, format == SAMPLEFORMAT_INT ? "signed " : "", kind, bits);
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

// Moves to the next page; returns false at the end. A file opens at its first page.
bool TiffFile::next_page() {
    message_.clear();
    const std::uint64_t place = TIFFCurrentDirOffset(tiff_.get());
    if (TIFFReadDirectory(tiff_.get()) == 0) {
        if (!message_.empty()) fail("{}: page {}: {}", name_, number_ + 2, message_);
        check_last_link(place);
        return false;
    }
    ++number_;
    return true;
}

void TiffFile::check_last_link(std::uint64_t place) const {
    const RandomAccessFile file(name_);
    char mark[4] = {}, bytes[8] = {};
    file.read(0, mark, sizeof mark);
    const bool is_big = mark[2] == '+' || mark[3] == '+';
    const std::size_t count_bytes = is_big ? 8 : 2, entry_bytes = is_big ? 20 : 12;
    file.read(place, bytes, count_bytes);
    const bool swap =
        (TIFFIsBigEndian(tiff_.get()) != 0) == (std::endian::native == std::endian::little);
    const std::uint64_t entries =
        is_big ? values_from_bytes<std::uint64_t>(ValueType::uint64, bytes, 1, swap)[0]
               : values_from_bytes<std::uint64_t>(ValueType::uint16, bytes, 1, swap)[0];
    if (place + count_bytes + entries * entry_bytes + (is_big ? 8 : 4) > file_bytes_) {
        fail("{}: page {}: the file ends before the place of the next page: it is truncated", name_,
             number_ + 1);
    }
}

void TiffFile::go_to_first() {
    number_ = 0;
    message_.clear();
    if (TIFFSetDirectory(tiff_.get(), 0) == 0) fail_with_reason("cannot be read");
}

void TiffFile::go_to(const TiffPage& page) {
    number_ = page.number;
    message_.clear();
    if (TIFFCurrentDirOffset(tiff_.get()) != page.place &&
        TIFFSetSubDirectory(tiff_.get(), page.place) == 0)
        fail_with_reason("cannot be read");
}

TiffPage TiffFile::page() const {
    TiffPage page;
    page.number = number_;
    page.place = TIFFCurrentDirOffset(tiff_.get());
    page.width = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    page.height = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    page.depth = field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1);
    page.samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    page.planar =
        page.samples > 1 &&
        field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
    page.is_reduced = (field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) &
                       (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
    page.bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    page.format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    if (page.width < 1 || page.height < 1 || page.samples < 1 || page.depth < 1) {
        fail("{}: page {}: found {} x {} pixels of {} samples, expected 1 or more", name_,
             number_ + 1, page.width, page.height, page.samples);
    }
    page.raw = raw_samples(page);
    page.is_big_endian = TIFFIsBigEndian(tiff_.get()) != 0;
    return page;
}

std::string TiffFile::description() const {
    const char* text = nullptr;
    const bool found = TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) != 0;
    return found && text != nullptr ? text : "";
}

std::uint64_t TiffFile::capacity() const {
    const bool is_bitwise = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1) % 8 != 0;
    return file_bytes_ * (is_packed() ? most_expansion : 1) * (is_bitwise ? 8 : 1);
}

void TiffFile::read(const TiffPage& page, std::int64_t sample, std::int64_t image, char* to) {
    check_interrupt();
    check_capacity(page);
    message_.clear();
    if (field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_YCBCR)
        TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (is_tiled()) return read_tiles(page, sample, image, to);
    if (page.depth > 1)
        fail("{}: page {}: found {} images in strips, of which libtiff reads the first alone",
             name_, number_ + 1, page.depth);
    read_strips(page, sample, to);
}

// Returns TiffPage::raw. Strips must follow each other without gaps: then their places need no
// list.
std::optional<std::uint64_t> TiffFile::raw_samples(const TiffPage& page) const {
    TIFF* const tiff = tiff_.get();
    const bool as_read =
        !is_packed() && !is_tiled() && !page.is_bitwise() && page.bits <= 64 &&
        field<std::uint16_t>(TIFFTAG_FILLORDER, FILLORDER_MSB2LSB) == FILLORDER_MSB2LSB &&
        field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) != PHOTOMETRIC_YCBCR;
    if (!as_read) return {};
    const std::size_t row_bytes = stored_row(page, page.width * (page.planar ? 1 : page.samples));
    const std::int64_t rows = rows_of_strips(page);
    const std::uint64_t begin = TIFFGetStrileOffset(tiff, 0);
    if (rows < 1 || TIFFScanlineSize64(tiff) != row_bytes || row_bytes > file_bytes_ ||
        begin > file_bytes_)
        return {};
    std::uint64_t at = begin;
    std::uint32_t strip = 0;
    for (std::int64_t plane = 0; plane < (page.planar ? page.samples : 1); ++plane) {
        for (std::int64_t row = 0; row < page.height; row += rows, ++strip) {
            constexpr std::uint32_t often = 4096;  // strips, some 100 us
            if (strip % often == 0) check_interrupt();
            const std::uint64_t there = TIFFGetStrileByteCount(tiff, strip);
            const auto bytes =
                static_cast<std::uint64_t>(std::min(rows, page.height - row)) * row_bytes;
            if (TIFFGetStrileOffset(tiff, strip) != at || there < bytes || file_bytes_ - at < bytes)
                return {};
            at += bytes;
        }
    }
    return begin;
}

TiffBeginning TiffFile::beginning() const {
    const TiffPage first = page();
    const auto photometric = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TiffBeginning found;
    found.file = name_;
    found.description = description();
    found.size = {first.width, first.height};
    found.samples = first.samples;
    found.is_contiguous = !first.planar;
    found.is_colour =
        first.samples > 2 && (photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR);
    found.depth = first.depth;
    found.resolution = {resolution(TIFFTAG_XRESOLUTION), resolution(TIFFTAG_YRESOLUTION)};
    found.resolution_unit = field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    return found;
}

// Throws Error if libtiff does not decode the first page's samples, with the name of their
// compression.
void TiffFile::check_compression() const {
    static constexpr struct {
        int number;
        const char* name;
    } known[] = {{6, "JPEG of old style"},
                 {34712, "JPEG 2000"},
                 {33003, "JPEG 2000 (Aperio)"},
                 {33005, "JPEG 2000 (Aperio)"},
                 {34887, "LERC"},
                 {22610, "JPEG XR"},
                 {50002, "JPEG XL"},
                 {52546, "JPEG XL"},
                 {50001, "WebP"},
                 {50000, "zstd"},
                 {34925, "LZMA"},
                 {34713, "Nikon NEF"},
                 {34892, "lossy JPEG of DNG"},
                 {34933, "PNG"}};
    const auto number = field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (TIFFIsCODECConfigured(number) != 0) return;
    const auto found = std::ranges::find_if(known, [&](auto& one) { return one.number == number; });
    fail(
        "{}: found samples compressed as {} (compression {}), which this libtiff does not decode: "
        "Fiji or tifffile saves them uncompressed",
        name_, found == std::end(known) ? "unknown" : found->name, number);
}

void TiffFile::check_tags(bool described) const {
    check_compression();
    const auto photometric = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    const auto orientation = field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (photometric == PHOTOMETRIC_MINISWHITE)
        say("{}: it says that 0 is white: values are as they are stored", name_);
    if (photometric == PHOTOMETRIC_PALETTE)
        say("{}: its values are indices of a palette, whose colours are not used", name_);
    if (photometric >= PHOTOMETRIC_SEPARATED && photometric != PHOTOMETRIC_YCBCR)
        say("{}: its PhotometricInterpretation is {}, no grey and not RGB: values are as they are "
            "stored",
            name_, photometric);
    if (orientation != ORIENTATION_TOPLEFT)
        say("{}: its Orientation {} says that the first pixel is not at the top left: pixels are "
            "in "
            "the order in which they are stored",
            name_, orientation);
    std::uint16_t copies = 0;
    std::uint64_t* places = nullptr;
    if (TIFFGetField(tiff_.get(), TIFFTAG_SUBIFD, &copies, &places) != 0 && copies > 0)
        say("{}: {} smaller copies of its first page (SubIFDs) are not used", name_, copies);
    std::uint32_t count = 0;
    const char* no_data = nullptr;
    if (TIFFGetField(tiff_.get(), 42113, &count, &no_data) != 0 && no_data != nullptr) {
        const std::string text(no_data, std::find(no_data, no_data + count, '\0'));
        say("{}: it says that {} is no data (GDAL_NODATA): values are as they are stored", name_,
            shortened(one_line(text)));
    }
    check_makers(described);
    if (described) return;
    // Most programs write a whole number of dots an inch, up to 4800, whatever the picture is.
    const double x = resolution(TIFFTAG_XRESOLUTION), y = resolution(TIFFTAG_YRESOLUTION);
    const auto unit = field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    const double inch = unit == RESUNIT_CENTIMETER ? 2.54 * x : x;
    const bool is_dots = x == y && std::abs(inch - std::round(inch)) < .02 && inch <= 4800;
    static constexpr const char* units[] = {"", "a unit", "an inch", "a centimetre"};
    if (x > 0 && y > 0 && !is_dots)
        say("{}: its resolution, {:g} x {:g} pixels {}, is not used: \"spacing\" in the volume "
            "sets "
            "distances",
            name_, x, y, units[std::min<int>(unit, 3)]);
}

std::int64_t TiffFile::rows_of_strips(const TiffPage& page) const {
    return std::min<std::int64_t>(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0xffffffff),
                                  page.height);
}

bool TiffFile::is_packed() const {
    return field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE;
}

double TiffFile::resolution(ttag_t tag) const {
    float value = 0;
    TIFFGetField(tiff_.get(), tag, &value);
    return static_cast<double>(value);
}

// Looks for the private tags of microscopes, scanners and maps, which say what pages mean.
void TiffFile::check_makers(bool described) const {
    struct Maker {
        ttag_t tag;
        const char* name;
        const char* refused;  // why; null: pages are read
    };
    static constexpr Maker makers[] = {
        {33629, "MetaMorph (STK)", "its slices lie behind its page"},
        {65420, "Hamamatsu (NDPI)", "pages of slides are magnifications"},
        {34412, "Zeiss (LSM)", nullptr},
        {34361, "Olympus (FluoView)", nullptr},
        {65326, "Nikon (NIS-Elements)", nullptr},
        {51123, "Micro-Manager", nullptr},
        {34118, "Zeiss (SEM)", nullptr},
        {34682, "FEI", nullptr},
        {33550, "GeoTIFF (ModelPixelScale)", nullptr},
        {34264, "GeoTIFF (ModelTransformation)", nullptr}};
    for (const auto& [tag, maker, refused] : makers) {
        std::uint32_t count = 0;
        const void* values = nullptr;
        if (TIFFGetField(tiff_.get(), tag, &count, &values) == 0) continue;
        if (refused != nullptr)
            fail("{}: found a file of {}, which is not read: {}", name_, maker, refused);
        if (!described)
            say("{}: what {} says about distances and the meaning of pages (tag {}) is not used",
                name_, maker, tag);
    }
    if (description().starts_with("Aperio"))
        fail(
            "{}: found a file of Aperio (SVS), which is not read: pages of slides are "
            "magnifications",
            name_);
}

void TiffFile::read_strips(const TiffPage& page, std::int64_t sample, char* to) {
    const std::size_t word = bytes_of(page.type(name_));
    const std::int64_t together = page.planar ? 1 : page.samples;  // samples beside each other
    const std::size_t row_bytes = stored_row(page, page.width * together);
    const std::int64_t rows = rows_of_strips(page);
    if (rows < 1 || TIFFScanlineSize64(tiff_.get()) != row_bytes)
        fail("{}: page {}: its strips do not hold whole rows", name_, number_ + 1);
    const std::int64_t strips = (page.height + rows - 1) / rows;
    const bool is_direct = together == 1 && !page.is_bitwise();
    std::vector<char> strip(is_direct ? 0 : row_bytes * static_cast<std::size_t>(rows));
    for (std::int64_t i = 0; i < strips; ++i) {
        check_interrupt();
        const std::int64_t height = std::min(rows, page.height - i * rows);
        const std::size_t bytes = row_bytes * static_cast<std::size_t>(height);
        char* const into = is_direct ? to : strip.data();
        const auto number = static_cast<std::uint32_t>(i + (page.planar ? sample * strips : 0));
        const tmsize_t got =
            TIFFReadEncodedStrip(tiff_.get(), number, into, static_cast<tmsize_t>(bytes));
        if (got != static_cast<tmsize_t>(bytes)) fail_with_reason("damaged or truncated");
        const std::int64_t pixels = page.width * height;
        if (page.is_bitwise()) {
            const auto values =
                unpacked(strip, page.bits, height, page.width * together, page.type(name_));
            take_sample(values.data(), together, together > 1 ? sample : 0, pixels, word, to);
        } else if (together > 1) {
            take_sample(strip.data(), together, sample, pixels, word, to);
        }
        to += static_cast<std::size_t>(pixels) * word;
    }
}

void TiffFile::read_tiles(const TiffPage& page, std::int64_t sample, std::int64_t image, char* to) {
    const std::size_t word = bytes_of(page.type(name_));
    const std::int64_t together = page.planar ? 1 : page.samples;
    const std::int64_t width = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
    const std::int64_t height = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    const std::int64_t depth = field<std::uint32_t>(TIFFTAG_TILEDEPTH, 1);
    const StoredAxis axes[] = {width, height, depth, together};
    const std::size_t value_bytes = stored_bytes(name_, axes, word);
    const std::size_t tile_bytes = page.is_bitwise() ? stored_row(page, width * together) *
                                                           static_cast<std::size_t>(height * depth)
                                                     : value_bytes;
    // libtiff's tiles are one image deep; of deeper ones it reads the bytes as they are.
    const bool is_deep = depth > 1;
    if (is_deep && is_packed()) {
        fail("{}: page {}: found compressed tiles of {} images each, which libtiff does not decode",
             name_, number_ + 1, depth);
    }
    if (width < 1 || height < 1 || depth < 1 ||
        TIFFTileSize64(tiff_.get()) * static_cast<std::size_t>(depth) != tile_bytes ||
        tile_bytes / most_expansion > file_bytes_) {
        fail("{}: page {}: found tiles of {} x {} pixels, more than the file can hold", name_,
             number_ + 1, width, height);
    }
    std::vector<char> tile(tile_bytes), values, plane(together > 1 ? value_bytes : 0);
    for (std::int64_t y = 0; y < page.height; y += height) {
        for (std::int64_t x = 0; x < page.width; x += width) {
            check_interrupt();
            const auto number =
                TIFFComputeTile(tiff_.get(), static_cast<std::uint32_t>(x),
                                static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(image),
                                static_cast<std::uint16_t>(page.planar ? sample : 0));
            const auto read = is_deep ? TIFFReadRawTile : TIFFReadEncodedTile;
            const tmsize_t got =
                read(tiff_.get(), number, tile.data(), static_cast<tmsize_t>(tile_bytes));
            if (got != static_cast<tmsize_t>(tile_bytes)) fail_with_reason("damaged or truncated");
            if (is_deep && TIFFIsByteSwapped(tiff_.get()) != 0 && !page.is_bitwise()) {
                swap_bytes_alone(tile.data(), static_cast<std::int64_t>(tile_bytes / word), word);
            }
            const char* from = tile.data();
            if (page.is_bitwise()) {
                values =
                    unpacked(tile, page.bits, height * depth, width * together, page.type(name_));
                from = values.data();
            }
            if (together > 1) {
                take_sample(from, together, sample, width * height * depth, word, plane.data());
                from = plane.data();
            }
            from += static_cast<std::size_t>(image % depth * width * height) * word;
            const std::size_t shown =
                static_cast<std::size_t>(std::min(width, page.width - x)) * word;
            for (std::int64_t row = 0; row < std::min(height, page.height - y); ++row) {
                std::memcpy(to + static_cast<std::size_t>((y + row) * page.width + x) * word,
                            from + static_cast<std::size_t>(row * width) * word, shown);
            }
        }
    }
}

// Throws Error if the file is too small for the page, before a damaged one takes all memory.
void TiffFile::check_capacity(const TiffPage& page) const {
    const StoredAxis axes[] = {page.width, page.height, page.samples};
    const std::size_t bytes = stored_bytes(name_, axes, bytes_of(page.type(name_)));
    if (bytes > capacity()) {
        fail("{}: page {} promises {} x {} pixels ({} bytes), the file holds {} bytes{}", name_,
             number_ + 1, page.width, page.height, bytes, file_bytes_,
             capacity() > file_bytes_ ? " of compressed data" : "");
    }
}

void TiffFile::fail_with_reason(const char* doing) const {
    fail("{}: page {}: {}: {}", name_, number_ + 1, doing,
         message_.empty() ? "libtiff gives no reason" : message_);
}

int TiffFile::keep_message(TIFF*, void* file, const char*, const char* format, va_list arguments) {
    TiffFile& self = *static_cast<TiffFile*>(file);
    char text[1000];
    if (!self.message_.empty() || std::vsnprintf(text, sizeof text, format, arguments) <= 0)
        return 1;
    self.message_ = one_line(text);
    // Some messages begin with the file's name, as lamina's do.
    const std::string name = self.name_ + ": ";
    if (self.message_.starts_with(name)) self.message_.erase(0, name.size());
    return 1;  // handled: libtiff prints nothing
}

}  // namespace lamina
