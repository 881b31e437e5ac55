// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "volume_files/numbered_files.h"
#include "volume_files/stored_data.h"
#include "volume_files/stored_samples.h"
#include "volume_files/tiff_file.h"
#include "volume_files/volume_grid.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// The meaning of the pages of a TIFF stack, as ImageJ or OME wrote it into the first page's
// description.
struct TiffAxes {
    std::int64_t channels = 1, slices = 1, times = 1;
    // Pages from one step to the next along each of these.
    std::int64_t channel_step = 1, slice_step = 1, time_step = 1;
    glm::dvec3 spacing{1, 1, 1};
};

bool is_distance(double number) {
    return std::isfinite(number) && number > 1e-100 && number < 1e100;
}

// ImageJ's lines "key=value"; its pages are channels, then slices, then frames.
class ImageJText {
  public:
    explicit ImageJText(const std::string& text) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            const std::size_t equals = line.find('=');
            if (equals != std::string::npos)
                values_[line.substr(0, equals)] = line.substr(equals + 1);
        }
    }

    std::int64_t count(const char* key) const {
        const auto found = values_.find(key);
        const auto number = found == values_.end() ? std::nullopt : whole_number(found->second);
        return number && *number > 0 && *number < (std::int64_t{1} << 32) ? *number : 1;
    }

    double number(const char* key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
    }

  private:
    std::map<std::string, std::string> values_;
};

TiffAxes imagej_axes(const std::string& text, std::int64_t pages,
                     const std::array<double, 2>& resolution) {
    const ImageJText values(text);
    TiffAxes axes;
    axes.channels = values.count("channels");
    axes.slices = values.count("slices");
    axes.times = values.count("frames");
    if (axes.channels == 1 && axes.slices == 1 && axes.times == 1) axes.slices = pages;
    axes.slice_step = axes.channels;
    axes.time_step = axes.channels * axes.slices;
    for (int axis = 0; axis < 2; ++axis) {
        const double distance = 1 / resolution[static_cast<std::size_t>(axis)];
        if (is_distance(distance)) axes.spacing[axis] = distance;
    }
    const double distance = std::abs(values.number("spacing"));
    if (is_distance(distance)) axes.spacing.z = distance;
    return axes;
}

// The first image of OME's XML; pages run through its DimensionOrder, such as XYZCT.
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

// Reads a description. `pages`: their number; `resolution`: pixels a unit along x and y, 0 if
// unknown. Pages that the description does not mention are slices, one apart. Resolutions without
// ImageJ's description are not trusted: programs write 72 dots an inch into everything, and have no
// distance between slices. Throws Error if the description has another number of pages.
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

std::vector<Path> tiffs_of(const Path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<Path> files = files_in_folder(path);
    std::erase_if(files, [](const Path& file) { return !has_tiff_mark(file); });
    return files;
}

class TiffStack {
  public:
    TiffStack(const Path& path, const VolumeRequest& request)
        : name_(path.string()), files_(tiffs_of(path)) {
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

    // Checks that the files can hold all pages, before memory is taken.
    void check_capacity(std::size_t word) const {
        const StoredAxis sizes[] = {page_.width, page_.height, page_.samples, std::ssize(places_)};
        const std::size_t bytes = stored_bytes(name_, sizes, word);
        if (bytes <= capacity_) return;
        fail(
            "{}: pages: found {} of {} x {} pixels of {} samples ({} bytes), more than the files "
            "can "
            "hold",
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
                "on "
                "the first page",
                file.name(), place.page + 1, page.width, page.height, page.samples,
                name_of(page.type), page_.width, page_.height, page_.samples, name_of(page_.type));
        }
        places_.push_back(place);
    }

    std::string name_;
    std::vector<Path> files_;
    std::vector<Place> places_;
    TiffPage page_;  // alike at every place
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
    return tiffs_of(path);
}

}  // namespace lamina
