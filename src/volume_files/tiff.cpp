// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <tiffio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <glm/vec3.hpp>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Max bytes that one compressed byte expands to: zstd's longest run, 128 KiB, takes 4 bytes.
constexpr std::uint64_t most_expansion = 32768;
constexpr tmsize_t most_memory = tmsize_t{1} << 31;  // bytes that libtiff itself may take at once

struct TiffPage {
    std::int64_t width = 0, height = 0;
    std::int64_t samples = 1;  // of each pixel
    bool planar = false;       // each sample of a pixel in a plane of its own
    ValueType type = ValueType::uint8;

    bool operator==(const TiffPage&) const = default;
};

// Copies value number `sample` of every `samples` values, `count` times. `word`: a value's bytes.
void take_sample(const char* from, std::int64_t samples, std::int64_t sample, std::int64_t count,
                 std::size_t word, char* to) {
    const StoredAxis axes[] = {{samples, sample}, count};
    take_of_memory(from, axes, word, to);
}

// A TIFF file, read page by page through libtiff. All functions throw Error with libtiff's reason.
class TiffFile {
  public:
    explicit TiffFile(const Path& path) : name_(path.string()), tiff_(nullptr, &TIFFClose) {
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

    const std::string& name() const { return name_; }

    // Moves to the next page; returns false at the end. A file opens at its first page.
    bool next_page() {
        message_.clear();
        if (TIFFReadDirectory(tiff_.get()) == 0) {
            if (!message_.empty()) fail("{}: page {}: {}", name_, number_ + 2, message_);
            return false;
        }
        ++number_;
        return true;
    }

    // Returns the byte of the file at which the page's directory lies.
    std::uint64_t place() const { return TIFFCurrentDirOffset(tiff_.get()); }

    // Moves to a page. `place`: its place(), because a search by number reads all pages before it.
    void go_to_page(std::uint32_t number, std::uint64_t place) {
        number_ = number;
        message_.clear();
        if (this->place() != place && TIFFSetSubDirectory(tiff_.get(), place) == 0)
            fail_with_reason("cannot be read");
    }

    // Tells if the page is a smaller copy of another, or a mask.
    bool is_reduced() const {
        return (field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) &
                (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
    }

    TiffPage page() const {
        TiffPage page;
        page.width = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        page.height = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        page.samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
        page.planar =
            page.samples > 1 && field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) ==
                                    PLANARCONFIG_SEPARATE;
        if (page.width < 1 || page.height < 1 || page.samples < 1) {
            fail("{}: page {}: found {} x {} pixels of {} samples, expected 1 or more", name_,
                 number_ + 1, page.width, page.height, page.samples);
        }
        const auto bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
        const auto format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        const bool floats = format == SAMPLEFORMAT_IEEEFP, is_signed = format == SAMPLEFORMAT_INT;
        const bool numbers =
            floats || is_signed || format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
        const auto type = number_type(bits / 8, !floats, floats || is_signed);
        if (!numbers || bits % 8 != 0 || !type) {
            const char* const kind = floats                       ? "floats"
                                     : format > SAMPLEFORMAT_VOID ? "complex numbers"
                                                                  : "integers";
            fail(
                "{}: page {}: found samples that are {} of {} bits, expected integers of 8, 16, 32 "
                "or 64 bits, or floats of 32 or 64",
                name_, number_ + 1, kind, bits);
        }
        page.type = *type;
        return page;
    }

    std::string description() const {
        const char* text = nullptr;
        const bool found = TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) != 0;
        return found && text != nullptr ? text : "";
    }

    // Returns the most bytes of samples in the file, if all pages are packed like this one.
    std::uint64_t capacity() const {
        const bool packed =
            field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE;
        return file_bytes_ * (packed ? most_expansion : 1);
    }

    // Returns the pixels per unit of length, whatever unit, along an axis; 0: unknown.
    double resolution(int axis) const {
        float value = 0;
        TIFFGetField(tiff_.get(), axis == 0 ? TIFFTAG_XRESOLUTION : TIFFTAG_YRESOLUTION, &value);
        return static_cast<double>(value);
    }

    // Reads one sample of all pixels, row by row, in native byte order: width * height values.
    void read(const TiffPage& page, std::int64_t sample, char* to) {
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

  private:
    void read_strips(const TiffPage& page, std::int64_t sample, char* to) {
        const std::size_t word = bytes_of(page.type);
        const std::int64_t together = page.planar ? 1 : page.samples;  // samples beside each other
        const std::size_t row_bytes = static_cast<std::size_t>(page.width * together) * word;
        const std::int64_t rows = std::min<std::int64_t>(
            field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0xffffffff), page.height);
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

    void read_tiles(const TiffPage& page, std::int64_t sample, char* to) {
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
                if (got != static_cast<tmsize_t>(tile_bytes))
                    fail_with_reason("damaged or truncated");
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

    // Throws Error if the file is too small for the page, before a damaged one takes all memory.
    void check_capacity(const TiffPage& page) const {
        const StoredAxis axes[] = {page.width, page.height, page.samples};
        const std::size_t bytes = stored_bytes(name_, axes, bytes_of(page.type));
        if (bytes > capacity()) {
            fail("{}: page {} promises {} x {} pixels ({} bytes), the file holds {} bytes{}", name_,
                 number_ + 1, page.width, page.height, bytes, file_bytes_,
                 capacity() > file_bytes_ ? " of compressed data" : "");
        }
    }

    [[noreturn]] void fail_with_reason(const char* doing) const {
        fail("{}: page {}: {}: {}", name_, number_ + 1, doing,
             message_.empty() ? "libtiff gives no reason" : message_);
    }

    template <typename T>
    T field(ttag_t tag, T otherwise) const {
        T value = otherwise;
        return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) != 0 ? value : otherwise;
    }

    static int keep_message(TIFF*, void* file, const char*, const char* format, va_list arguments) {
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

    std::string name_;
    std::string message_;  // the first of libtiff since it was cleared
    std::uint64_t file_bytes_ = 0;
    std::uint32_t number_ = 0;  // the page's, from 0
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
};

// The meaning of a TIFF stack's pages, as ImageJ or OME wrote it into the first one's description.
struct TiffAxes {
    std::int64_t channels = 1, slices = 1, times = 1;
    // Number of pages from one channel, slice or time to the next.
    std::int64_t channel_step = 1, slice_step = 1, time_step = 1;
    glm::dvec3 spacing{1, 1, 1};
};

bool is_distance(double number) {
    return std::isfinite(number) && number > 1e-100 && number < 1e100;
}

// Reads ImageJ's lines "key=value". Pages run through channels first, then slices, then frames.
TiffAxes imagej_axes(const std::string& text, std::int64_t pages,
                     const std::array<double, 2>& resolution) {
    std::map<std::string, std::string> values;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t equals = line.find('=');
        if (equals != std::string::npos) values[line.substr(0, equals)] = line.substr(equals + 1);
    }
    const auto count = [&](const char* key) {
        const auto number = whole_number(values[key]);
        return number && *number > 0 && *number < (std::int64_t{1} << 32) ? *number : 1;
    };
    TiffAxes axes;
    axes.channels = count("channels");
    axes.slices = count("slices");
    axes.times = count("frames");
    if (axes.channels == 1 && axes.slices == 1 && axes.times == 1) axes.slices = pages;
    axes.slice_step = axes.channels;
    axes.time_step = axes.channels * axes.slices;
    for (int axis = 0; axis < 2; ++axis) {
        const double distance = 1 / resolution[static_cast<std::size_t>(axis)];
        if (is_distance(distance)) axes.spacing[axis] = distance;
    }
    const double distance = std::abs(std::strtod(values["spacing"].c_str(), nullptr));
    if (is_distance(distance)) axes.spacing.z = distance;
    return axes;
}

// Reads the first image of OME's XML. Pages are in its DimensionOrder, fastest first, as in XYZCT.
TiffAxes ome_axes(const std::string& file, const pugi::xml_node pixels, std::int64_t pages) {
    TiffAxes axes;
    axes.slices = pages;
    const std::string order = pixels.attribute("DimensionOrder").as_string("XYZCT");
    if (order.size() != 5 || !order.starts_with("XY")) {
        fail("{}: DimensionOrder: found '{}', expected X, Y and then C, Z and T in some order",
             file, one_line(order.substr(0, 20)));
    }
    std::int64_t step = 1;
    for (const char letter : order.substr(2)) {
        const std::string key = std::string("Size") + letter;
        const std::int64_t size = pixels.attribute(key.c_str()).as_llong(1);
        if (size < 1 || size > (std::int64_t{1} << 20))
            fail("{}: {}: found {}, expected a number above 0", file, one_line(key), size);
        (letter == 'C' ? axes.channels : letter == 'Z' ? axes.slices : axes.times) = size;
        (letter == 'C'   ? axes.channel_step
         : letter == 'Z' ? axes.slice_step
                         : axes.time_step) = step;
        step *= size;
    }
    const char* const keys[] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    for (int axis = 0; axis < 3; ++axis) {
        const double distance = pixels.attribute(keys[axis]).as_double(0);
        if (is_distance(distance)) axes.spacing[axis] = distance;
    }
    return axes;
}

// Reads a stack's description. `pages`: their number; `resolution`: pixels per unit along x and y,
// 0 if unknown. Pages that it does not mention are slices, 1 apart. Resolutions are trusted only
// with ImageJ's description: programs write 72 dots an inch into everything, and no distance
// between slices. Throws Error if the description has another number of pages.
TiffAxes tiff_axes(const std::string& file, const std::string& description, std::int64_t pages,
                   const std::array<double, 2>& resolution) {
    TiffAxes axes;
    axes.slices = pages;
    std::string writer = "ImageJ";
    if (description.starts_with("ImageJ=")) {
        axes = imagej_axes(description, pages, resolution);
    } else if (description.find("<OME") != std::string::npos) {
        writer = "OME";
        pugi::xml_document document;
        document.load_buffer(description.data(), description.size());
        const pugi::xml_node pixels = document.child("OME").child("Image").child("Pixels");
        if (pixels) axes = ome_axes(file, pixels, pages);
    }
    const std::int64_t expected = axes.channels * axes.slices * axes.times;
    if (expected != pages) {
        fail("{}: found {} pages, {}'s description has {} channels, {} slices and {} times", file,
             pages, writer, axes.channels, axes.slices, axes.times);
    }
    return axes;
}

constexpr std::size_t most_pages = 1'000'000;

bool has_tiff_mark(const Path& path) {
    using namespace std::string_view_literals;
    const std::string magic = file_beginning(path, 4);
    return magic == "II*\0"sv || magic == "MM\0*"sv || magic == "II+\0"sv || magic == "MM\0+"sv;
}

// The pages of a TIFF file, or of the TIFF files in a folder, as a volume.
class TiffStack {
  public:
    TiffStack(const Path& path, const VolumeRequest& request)
        : name_(path.string()), files_(files_of_tiff(path)) {
        if (files_.empty()) fail("{}: found no TIFF file in the folder", name_);
        list_pages();
        axes_ =
            tiff_axes(name_, description_, static_cast<std::int64_t>(places_.size()), resolution_);
        if (axes_.channels > 1 && page_.samples > 1) {
            fail("{}: found pages for {} channels and {} samples a pixel, expected one of both",
                 name_, axes_.channels, page_.samples);
        }
        channel_ =
            taken_axis(name_, "channel", request.channel, std::max(axes_.channels, page_.samples));
        time_ = taken_axis(name_, "time", request.time, axes_.times);
        const StoredAxis taken[] = {channel_, time_};
        say_taken(name_, taken);
    }

    Grid grid() const {
        Grid grid = plain_grid({page_.width, page_.height, axes_.slices});
        for (int axis = 0; axis < 3; ++axis)
            grid.step[static_cast<std::size_t>(axis)] *= axes_.spacing[axis];
        check_grid(name_, grid, {"resolution", "resolution"});
        return grid;
    }

    StoredSamples read() {
        const StoredAxis sizes[] = {page_.width, page_.height, axes_.slices};
        const std::size_t word = bytes_of(page_.type);
        StoredSamples samples{name_, page_.type, nullptr};
        check_capacity(word);
        samples.bytes = filled_memory(stored_bytes(name_, sizes, word));
        auto* to = static_cast<char*>(samples.bytes.get());
        const bool by_page = axes_.channels > 1;
        const std::int64_t first =
            *time_.taken * axes_.time_step + (by_page ? *channel_.taken * axes_.channel_step : 0);
        for (std::int64_t slice = 0; slice < axes_.slices; ++slice) {
            const Place& place =
                places_[static_cast<std::size_t>(first + slice * axes_.slice_step)];
            open(place.file).go_to_page(place.page, place.offset);
            file_->read(page_, by_page ? 0 : *channel_.taken, to);
            to += static_cast<std::size_t>(page_.width * page_.height) * word;
        }
        return samples;
    }

  private:
    struct Place {
        std::size_t file;
        std::uint32_t page;
        std::uint64_t offset;  // the page's, in bytes of the file
    };

    // Throws Error unless the files can hold all pages, before memory is taken.
    void check_capacity(std::size_t word) const {
        const StoredAxis sizes[] = {page_.width, page_.height, page_.samples, std::ssize(places_)};
        const std::size_t bytes = stored_bytes(name_, sizes, word);
        if (bytes <= capacity_) return;
        fail(
            "{}: pages: found {} of {} x {} pixels of {} samples ({} bytes), more than the files "
            "can hold",
            name_, places_.size(), page_.width, page_.height, page_.samples, bytes);
    }

    TiffFile& open(std::size_t number) {
        if (!file_ || opened_ != number) {
            file_ = std::make_unique<TiffFile>(files_[number]);
            opened_ = number;
        }
        return *file_;
    }

    void list_pages() {
        std::int64_t reduced = 0;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            check_interrupt();
            TiffFile& file = open(i);
            std::uint32_t number = 0;
            std::uint64_t capacity = 0;
            do {
                capacity = std::max(capacity, file.capacity());
                if (file.is_reduced())
                    ++reduced;
                else
                    add_page(file, {i, number, file.place()});
                ++number;
            } while (file.next_page());
            capacity_ += capacity;
        }
        if (places_.empty()) fail("{}: found no page that is not a smaller copy", name_);
        if (reduced > 0)
            warn(fmt::format("{}: {} smaller copies of pages are not used", name_, reduced));
    }

    void add_page(const TiffFile& file, const Place& place) {
        if (places_.size() == most_pages) fail("{}: found more than {} pages", name_, most_pages);
        const TiffPage page = file.page();
        if (places_.empty()) {
            page_ = page;
            description_ = file.description();
            resolution_ = {file.resolution(0), file.resolution(1)};
        } else if (!(page == page_)) {
            fail(
                "{}: page {}: found {} x {} pixels of {} {} samples, expected {} x {} of {} {} as "
                "on the first page",
                file.name(), place.page + 1, page.width, page.height, page.samples,
                name_of(page.type), page_.width, page_.height, page_.samples, name_of(page_.type));
        }
        places_.push_back(place);
    }

    std::string name_;
    std::vector<Path> files_;
    std::vector<Place> places_;
    TiffPage page_;  // the same for all pages
    std::string description_;
    std::array<double, 2> resolution_{};
    std::uint64_t capacity_ = 0;  // bytes of samples that all files can hold
    TiffAxes axes_;
    StoredAxis channel_, time_;
    std::unique_ptr<TiffFile> file_;
    std::size_t opened_ = 0;
};

}  // namespace

bool is_tiff(const Path& path) {
    if (!std::filesystem::is_directory(path)) return has_tiff_mark(path);
    return std::ranges::any_of(files_in_folder(path), has_tiff_mark);
}

Volume open_tiff(const Path& path, const VolumeRequest& request, const VolumeUse& /*use*/) {
    TiffStack stack(path, request);
    return drawn_volume(stack.grid(), stack.read());
}

std::vector<Path> files_of_tiff(const Path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<Path> files = files_in_folder(path);
    std::erase_if(files, [](const Path& file) { return !has_tiff_mark(file); });
    return files;
}

}  // namespace lamina
