// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <sstream>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "mesh_files/vtk_xml.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Upper bound on the bytes that one byte decompresses to: LZMA, the densest, reaches some 7000.
constexpr std::size_t most_vti_expansion = 32768;
constexpr std::size_t most_pieces = 4096;  // each is compared with all others

// A box of points: the first and the last one along each axis.
struct Extent {
    std::array<std::int64_t, 3> first{}, last{};

    bool operator==(const Extent&) const = default;
};

// A VTK XML image file, whose pieces are joined into one volume.
class ImageFile {
  public:
    ImageFile(const Path& path, const VolumeRequest& request)
        : file_(path, "ImageData"),
          request_(request),
          whole_(extent_of(file_.grid(), "WholeExtent")),
          pieces_(file_.grid().children("Piece").begin(), file_.grid().children("Piece").end()) {
        if (pieces_.empty()) fail("{}: no <Piece> in it", file_.name());
        if (pieces_.size() > most_pieces) {
            fail("{}: found {} pieces, expected at most {}", file_.name(), pieces_.size(),
                 most_pieces);
        }
        choose_array();
    }

    Grid grid() const {
        Grid grid = plain_grid(size_of(whole_));
        const auto origin = numbers_of<3>("Origin", {0, 0, 0});
        const auto spacing = numbers_of<3>("Spacing", {1, 1, 1});
        const auto direction = numbers_of<9>("Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
        grid.origin = {origin[0], origin[1], origin[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const glm::dvec3 column{direction[axis], direction[axis + 3], direction[axis + 6]};
            grid.step[axis] = spacing[axis] * column;
            // On an axis with a single point, the cells lie at that point.
            const bool between = of_cells_ && whole_.first[axis] != whole_.last[axis];
            if (of_cells_) grid.centering[axis] = Centering::cell;
            grid.origin +=
                (static_cast<double>(whole_.first[axis]) + (between ? 0.5 : 0.0)) * grid.step[axis];
        }
        check_grid(file_.name(), grid, {"Direction", "Origin"});
        return grid;
    }

    StoredSamples samples() const {
        if (pieces_.size() == 1 && extent_of(pieces_[0], "Extent") == whole_)
            return piece_samples(pieces_[0], whole_);
        return joined_samples();
    }

  private:
    using Node = pugi::xml_node;

    Extent extent_of(Node node, const char* attribute) const {
        std::istringstream stream(node.attribute(attribute).value());
        Extent extent;
        constexpr std::int64_t largest = std::int64_t{1} << 40;
        bool good = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t &first = extent.first[axis], &last = extent.last[axis];
            good &= static_cast<bool>(stream >> first >> last) && first >= -largest &&
                    last <= largest && first <= last;
        }
        std::string more;
        if (!good || stream >> more) {
            fail("{}: {}: found '{}', expected first and last point along x, y and z", file_.name(),
                 attribute, one_line(node.attribute(attribute).value()).substr(0, 80));
        }
        return extent;
    }

    template <std::size_t count>
    std::array<double, count> numbers_of(const char* attribute,
                                         std::array<double, count> numbers) const {
        const pugi::xml_attribute found = file_.grid().attribute(attribute);
        if (!found) return numbers;
        std::istringstream stream(found.value());
        std::string more;
        bool good = true;
        for (double& number : numbers) good &= static_cast<bool>(stream >> number);
        if (!good || stream >> more) {
            fail("{}: {}: found '{}', expected {} numbers", file_.name(), attribute,
                 one_line(found.value()).substr(0, 80), count);
        }
        return numbers;
    }

    std::array<std::int64_t, 3> size_of(const Extent& extent) const {
        std::array<std::int64_t, 3> size{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t cells = extent.last[axis] - extent.first[axis];
            size[axis] = of_cells_ ? std::max<std::int64_t>(cells, 1) : cells + 1;
        }
        return size;
    }

    // Chooses the array by the first piece, and finds out if it belongs to points or to cells.
    void choose_array() {
        std::vector<std::string> names;
        std::string preferred;
        for (const char* const section : {"PointData", "CellData"}) {
            const Node data = pieces_[0].child(section);
            if (preferred.empty()) preferred = data.attribute("Scalars").value();
            for (const Node array : data.children("DataArray")) {
                const std::string_view type = array.attribute("type").value();
                if (type != "String" && type != "Bit")
                    names.emplace_back(array.attribute("Name").value());
            }
        }
        if (names.empty()) fail("{}: no array of numbers in PointData and CellData", file_.name());
        array_ = request_.array;
        if (array_.empty()) {
            array_ = std::ranges::find(names, preferred) != names.end() ? preferred : names[0];
            if (names.size() > 1) {
                warn(
                    fmt::format("{}: array \"{}\" of {} is taken: \"array\" in the volume names "
                                "another",
                                file_.name(), one_line(array_), names.size()));
            }
        } else if (std::ranges::find(names, array_) == names.end()) {
            std::string list;
            for (const std::string& name : names)
                list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", one_line(name));
            fail("{}: array: found \"{}\", expected one of {}", file_.name(), one_line(array_),
                 list);
        }
        of_cells_ = !find_array(pieces_[0], "PointData");
    }

    Node find_array(Node piece, const char* section) const {
        for (const Node array : piece.child(section).children("DataArray"))
            if (array.attribute("Name").value() == array_) return array;
        return {};
    }

    StoredSamples piece_samples(Node piece, const Extent& extent) const {
        const std::string what = fmt::format("{}: '{}'", file_.name(), one_line(array_));
        const Node array = find_array(piece, of_cells_ ? "CellData" : "PointData");
        if (!array) fail("{}: not in every piece", what);
        const std::array<std::int64_t, 3> size = size_of(extent);
        std::vector<StoredAxis> axes{size[0], size[1], size[2]};
        const auto count = static_cast<std::int64_t>(stored_bytes(what, axes, 1));
        const std::int64_t components = file_.components_of(array, what);
        auto values =
            std::make_shared<VtkXmlValues>(file_.stored_values(array, count, components, what));
        StoredSamples samples{what, values->type, nullptr};
        const StoredAxis channel = taken_axis(what, "channel", request_.channel, components);
        if (components == 1) {
            samples.bytes = std::shared_ptr<void>(values, values->bytes.data());
            return samples;
        }
        axes.insert(axes.begin(), channel);
        if (piece == pieces_[0]) say_taken(what, axes);
        const std::size_t word = bytes_of(values->type);
        samples.bytes = filled_memory(stored_bytes(what, axes, word, true));
        take_of_memory(values->bytes.text().data(), axes, word,
                       static_cast<char*>(samples.bytes.get()));
        return samples;
    }

    // Throws Error if the file cannot hold the image, before its memory is taken.
    void check_capacity() const {
        const std::array<std::int64_t, 3> size = size_of(whole_);
        const StoredAxis axes[] = {size[0], size[1], size[2]};
        const std::size_t samples = stored_bytes(file_.name(), axes, 1);
        if (samples / most_vti_expansion <= file_.byte_count()) return;
        fail("{}: WholeExtent: found {} x {} x {} samples, more than the file's {} bytes can hold",
             file_.name(), size[0], size[1], size[2], file_.byte_count());
    }

    StoredSamples joined_samples() const {
        const std::array<std::int64_t, 3> size = size_of(whole_);
        check_capacity();
        check_pieces();
        StoredSamples all;
        for (const Node piece : pieces_) {
            const Extent extent = extent_of(piece, "Extent");
            const StoredSamples part = piece_samples(piece, extent);
            const std::size_t word = bytes_of(part.type);
            if (!all.bytes) {
                const StoredAxis axes[] = {size[0], size[1], size[2]};
                all = {part.file, part.type, filled_memory(stored_bytes(part.file, axes, word))};
            }
            if (part.type != all.type) {
                fail("{}: found {} and {} in its pieces, expected one type", part.file,
                     name_of(all.type), name_of(part.type));
            }
            put_piece(part, extent, size, word, all);
        }
        return all;
    }

    // Throws Error unless the pieces fill the whole image. They may share points but no cells: so
    // none may overlap another or lie outside, and their cells must add up to the whole's.
    void check_pieces() const {
        double covered = 0, expected = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
            expected *= static_cast<double>(
                std::max<std::int64_t>(whole_.last[axis] - whole_.first[axis], 1));
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const Extent extent = extent_of(pieces_[i], "Extent");
            double cells = 1;
            bool inside = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const bool flat = whole_.first[axis] == whole_.last[axis];
                inside &= extent.first[axis] >= whole_.first[axis] &&
                          extent.last[axis] <= whole_.last[axis] &&
                          (flat || extent.first[axis] < extent.last[axis]);
                cells *= static_cast<double>(
                    std::max<std::int64_t>(extent.last[axis] - extent.first[axis], 1));
            }
            if (!inside)
                fail("{}: Piece {}: its Extent is none within the WholeExtent", file_.name(),
                     i + 1);
            covered += cells;
            for (std::size_t other = 0; other < i; ++other) expect_apart(extent, other, i);
        }
        if (covered != expected) {
            fail("{}: its pieces cover {} of {} cells", file_.name(), covered, expected);
        }
    }

    void expect_apart(const Extent& extent, std::size_t other, std::size_t number) const {
        const Extent before = extent_of(pieces_[other], "Extent");
        bool overlap = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool flat = whole_.first[axis] == whole_.last[axis];
            overlap &= flat || (extent.first[axis] < before.last[axis] &&
                                before.first[axis] < extent.last[axis]);
        }
        if (overlap) fail("{}: pieces {} and {} overlap", file_.name(), other + 1, number + 1);
    }

    void put_piece(const StoredSamples& part, const Extent& extent,
                   const std::array<std::int64_t, 3>& size, std::size_t word,
                   StoredSamples& all) const {
        const std::array<std::int64_t, 3> mine = size_of(extent);
        const std::size_t row = static_cast<std::size_t>(mine[0]) * word;
        const auto* from = static_cast<const char*>(part.bytes.get());
        auto* const to = static_cast<char*>(all.bytes.get());
        for (std::int64_t z = 0; z < mine[2]; ++z) {
            for (std::int64_t y = 0; y < mine[1]; ++y, from += row) {
                const std::int64_t place =
                    extent.first[0] - whole_.first[0] +
                    size[0] * (extent.first[1] - whole_.first[1] + y +
                               size[1] * (extent.first[2] - whole_.first[2] + z));
                std::memcpy(to + static_cast<std::size_t>(place) * word, from, row);
            }
        }
    }

    VtkXmlFile file_;
    const VolumeRequest& request_;
    Extent whole_;
    std::vector<Node> pieces_;
    std::string array_;
    bool of_cells_ = false;  // the array belongs to cells
};

}  // namespace

bool is_vti(const Path& path) {
    const std::string beginning = file_beginning(path, 4096);
    const std::size_t tag = beginning.find("<VTKFile");
    if (tag == std::string::npos ||
        beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf") != beginning.find('<'))
        return false;
    const std::string element = beginning.substr(tag, beginning.find('>', tag) - tag);
    return element.find("ImageData\"") != std::string::npos ||
           element.find("ImageData'") != std::string::npos;
}

Volume open_vti(const Path& path, const VolumeRequest& request, const VolumeUse& /*use*/) {
    const ImageFile image(path, request);
    const Grid grid = image.grid();
    return drawn_volume(grid, image.samples());
}

}  // namespace lamina
