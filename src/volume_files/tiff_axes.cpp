// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff_axes.h"

#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "volume_files/whole_number.h"

namespace lamina {
namespace {

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

}  // namespace

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

}  // namespace lamina
