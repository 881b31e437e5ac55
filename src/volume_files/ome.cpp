// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>

#include "base/client.h"
#include "base/error.h"
#include "volume_files/tiff_description.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

using Node = pugi::xml_node;

std::string ome_text(Node node, const char* attribute) {
    return one_line(node.attribute(attribute).value());
}

// Returns the XML with names of elements as they are without a namespace's prefix ("ns0:OME").
std::string without_prefix(const std::string& xml) {
    const std::size_t colon = xml.find(":OME");
    const std::size_t first = colon == xml.npos ? xml.npos : xml.rfind('<', colon);
    if (first == xml.npos || xml.find_first_of(" >\"\n", first) < colon) return xml;
    const std::string_view prefix = std::string_view(xml).substr(first + 1, colon - first);
    std::string plain;
    for (std::size_t at = 0; at < xml.size(); ++at) {
        plain += xml[at];
        const std::size_t name = at + (xml.compare(at, 2, "</") == 0 ? 2 : 1);
        if (xml[at] != '<' || xml.compare(name, prefix.size(), prefix) != 0) continue;
        if (name == at + 2) plain += '/';
        at = name + prefix.size() - 1;
    }
    return plain;
}

// Reads the XML of an OME-TIFF.
class OmeReader {
  public:
    OmeReader(const TiffBeginning& first, const std::string& own, const OmePagesOf& pages_of)
        : file_(first.file), samples_(first.samples), own_(own), pages_of_(pages_of) {
        const auto result = document_.load_string(without_prefix(first.description).c_str());
        if (!result) fail("{}: damaged OME-XML: {}", file_, result.description());
        root_ = document_.child("OME");
    }

    TiffDescription read(const std::string& image) {
        found_.writer = "OME";
        found_.files = {own_};
        numbers_ = {{own_, 0}};
        pixels_ = chosen_image(image).child("Pixels");
        if (!pixels_) fail("{}: found OME-XML without Pixels", file_);
        found_.type = ome_text(pixels_, "Type");
        found_.size = {pixels_.attribute("SizeX").as_llong(),
                       pixels_.attribute("SizeY").as_llong()};
        read_axes();
        read_distances();
        name_channels_and_times();
        map_pages();
        return found_;
    }

  private:
    std::int64_t count(Node node, const char* key, std::int64_t otherwise, std::int64_t least,
                       std::int64_t most) const {
        const std::int64_t found = node.attribute(key).as_llong(otherwise);
        if (found >= least && found <= most) return found;
        fail("{}: {}: found {}, expected a number from {} to {}", file_, key, found, least, most);
    }

    // Returns the file with the planes of a TiffData. A file that was renamed is known by its UUID.
    std::string file_of(Node tiff_data) const {
        const Node uuid = tiff_data.child("UUID");
        const std::string_view root = root_.attribute("UUID").value();
        const bool is_own =
            !uuid.attribute("FileName") || (!root.empty() && root == uuid.child_value());
        return is_own ? own_ : uuid.attribute("FileName").value();
    }

    // Returns the image of a name or ID, else the first that has a plane in the own file.
    Node chosen_image(const std::string& wanted) {
        Node chosen;
        for (const Node image : root_.children("Image")) {
            found_.images.push_back(ome_text(image, image.attribute("Name") ? "Name" : "ID"));
            const auto parts = image.child("Pixels").children("TiffData");
            const bool is_here =
                parts.empty() || std::any_of(parts.begin(), parts.end(),
                                             [&](Node part) { return file_of(part) == own_; });
            const bool fits = wanted.empty() ? is_here
                                             : ome_text(image, "Name") == wanted ||
                                                   ome_text(image, "ID") == wanted;
            if (fits && !chosen) chosen = image;
        }
        if (!chosen && wanted.empty()) chosen = root_.child("Image");
        if (!chosen && !found_.images.empty()) {
            fail("{}: array: found \"{}\", expected one of \"{}\"", file_, one_line(wanted),
                 fmt::join(found_.images, "\", \""));
        }
        if (wanted.empty() && found_.images.size() > 1) {
            say("{}: image \"{}\" of {} is taken: {}", file_, ome_text(chosen, "Name"),
                found_.images.size(), names_another("array", "NAME"));
        }
        return chosen;
    }

    // Reads the sizes in DimensionOrder, fastest first, as in XYZCT. The samples of a pixel are
    // channels, which come before all others.
    void read_axes() {
        constexpr std::int64_t most = std::int64_t{1} << 20;
        const std::string order = pixels_.attribute("DimensionOrder").as_string("XYZCT");
        std::string sorted = order;
        std::ranges::sort(sorted);
        if (sorted != "CTXYZ" || !order.starts_with("XY")) {
            fail("{}: DimensionOrder: found '{}', expected X, Y and then C, Z and T in some order",
                 file_, shortened(one_line(order)));
        }
        if (samples_ > 1) found_.axes.push_back({'C', samples_});
        for (const char letter : order.substr(2)) {
            const std::string key = std::string("Size") + letter;
            std::int64_t size = count(pixels_, key.c_str(), 1, 1, most);
            if (letter == 'C' && samples_ > 1) {
                if (size != samples_) fail_as_mixed(file_, size, samples_);
                size = 1;
            } else {
                found_.axes.push_back({letter, size});
            }
            steps_[letter] = pages_;
            sizes_[letter] = size;
            pages_ *= size;
        }
    }

    void read_distances() {
        bool is_known = false, is_missing = false, has_places = false;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string key = std::string("PhysicalSize") + "XYZ"[axis];
            const double size = pixels_.attribute(key.c_str()).as_double(0);
            const bool is_good = is_distance(size);
            is_known |= is_good;
            is_missing |= !is_good && (axis < 2 || sizes_['Z'] > 1);
            if (is_good || axis == 0)
                set_distance(found_, file_, axis, is_good ? size : 1,
                             pixels_.attribute((key + "Unit").c_str()).as_string("µm"));
        }
        if (!is_known) found_.unit.clear();
        if (is_known && is_missing)
            say("{}: PhysicalSizeX, Y or Z is missing or no distance: 1 is taken for it", file_);
        for (const Node plane : pixels_.children("Plane"))
            has_places |= plane.attribute("PositionX") || plane.attribute("PositionZ");
        if (has_places)
            say("{}: positions of planes are not used: the first sample lies at 0", file_);
    }

    void name_channels_and_times() {
        std::vector<std::string> channels, times;
        std::uint64_t samples = 0;  // wraps if a damaged file says too many
        for (const Node channel : pixels_.children("Channel")) {
            channels.push_back(ome_text(channel, "Name"));
            samples += channel.attribute("SamplesPerPixel").as_ullong(1);
        }
        const std::uint64_t size = pixels_.attribute("SizeC").as_ullong(1);
        if (samples > 0 && samples != size)
            say("{}: {} Channel elements have {} channels, SizeC is {}, which counts", file_,
                channels.size(), samples, size);
        const double increment = pixels_.attribute("TimeIncrement").as_double(0);
        const std::string unit = unit_word(pixels_.attribute("TimeIncrementUnit").as_string("s"));
        for (std::int64_t t = 0; increment > 0 && t < sizes_['T']; ++t)
            times.push_back(fmt::format("{:g} {}", static_cast<double>(t) * increment, unit));
        for (TiffAxis& axis : found_.axes)
            if (axis.letter != 'Z') axis.names = axis.letter == 'C' ? channels : times;
    }

    // Reads which page of which file holds which plane. Without TiffData, pages are in order.
    void map_pages() {
        constexpr std::int64_t most = 1'000'000;
        if (pages_ > most) fail("{}: found {} planes, expected up to {}", file_, pages_, most);
        found_.pages.resize(static_cast<std::size_t>(pages_));
        std::int64_t again = 0;
        const auto parts = pixels_.children("TiffData");
        for (const Node part : parts) again += map_part(part);
        if (parts.empty()) map_part(Node());
        if (again > 0)
            say("{}: TiffData has {} planes twice: what it says last counts", file_, again);
    }

    // Maps the planes of a TiffData; returns how many of them were mapped already.
    std::int64_t map_part(Node part) {
        constexpr std::int64_t most = 10'000'000;  // of all TiffData: ten times as many as planes
        check_interrupt();
        std::int64_t first = 0, again = 0;
        for (const auto& [letter, step] : steps_) {
            const std::string key = std::string("First") + letter;
            first += count(part, key.c_str(), 0, 0, sizes_[letter] - 1) * step;
        }
        const std::string file = file_of(part);
        const std::int64_t page = count(part, "IFD", 0, 0, pages_ + (1 << 20));
        const char* const key = part.attribute("PlaneCount") ? "PlaneCount" : "NumPlanes";
        std::int64_t planes = count(part, key, 1, 0, pages_ - first);
        if (!part.attribute(key) && !part.attribute("IFD"))
            planes = std::min(page_count_of(file), pages_ - first);
        mapped_ += planes;
        if (mapped_ > most) fail("{}: TiffData: found more than {} planes", file_, most);
        const auto [known, is_new] =
            numbers_.try_emplace(file, static_cast<std::int32_t>(found_.files.size()));
        if (is_new) found_.files.push_back(file);
        for (std::int64_t i = 0; i < planes; ++i) {
            TiffDescription::Page& to = found_.pages[static_cast<std::size_t>(first + i)];
            again += to.file >= 0;
            to = {known->second, static_cast<std::uint32_t>(page + i)};
        }
        return again;
    }

    // Counts the pages of a file once, however many TiffData name it.
    std::int64_t page_count_of(const std::string& file) {
        const auto [known, is_new] = page_counts_.try_emplace(file, 0);
        if (is_new) known->second = pages_of_(file);
        return known->second;
    }

    std::string file_;  // for messages
    std::int64_t samples_;
    std::string own_;
    const OmePagesOf& pages_of_;
    pugi::xml_document document_;
    Node root_, pixels_;
    TiffDescription found_;
    std::map<char, std::int64_t> steps_, sizes_;  // pages from one Z, C or T to the next; how many
    std::map<std::string, std::int64_t> page_counts_;  // of the files that were counted
    std::map<std::string, std::int32_t> numbers_;      // of files in found_.files
    std::int64_t pages_ = 1, mapped_ = 0;
};

}  // namespace

OmeFiles files_of_ome(const std::string& description) {
    OmeFiles files;
    pugi::xml_document document;
    document.load_string(without_prefix(description).c_str());
    const Node root = document.child("OME");
    files.metadata = root.child("BinaryOnly").attribute("MetadataFile").value();
    for (const Node image : root.children("Image"))
        for (const Node part : image.child("Pixels").children("TiffData"))
            files.planes.insert(part.child("UUID").attribute("FileName").value());
    files.planes.erase("");
    return files;
}

TiffDescription ome_description(const TiffBeginning& first, const std::string& own,
                                const std::string& image, const OmePagesOf& pages_of) {
    return OmeReader(first, own, pages_of).read(image);
}

}  // namespace lamina
