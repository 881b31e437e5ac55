// SPDX-License-Identifier: Apache-2.0
// Attributes and dimension scales of HDF5 describe an array's axes: HDF5's "Dimension Scale" and
// "Image and Palette" specifications, vigra's axistags, xarray's and N5's attributes.
#include <fmt/ranges.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/json_text.h"
#include "volume_files/hdf5_layout.h"

namespace lamina {
namespace {

constexpr std::int64_t most_coordinates = 1 << 20;

// Reads the attributes and the coordinates of an axis from a data set of them. `array`: for
// messages.
void read_coordinates(hid_t set, const std::string& array, ArrayAxis& axis) {
    add_attributes(axis, [&](const char* key) { return text_of(set, key); });
    const bool is_bare = text_of(set, "NAME").starts_with("This is a netCDF dimension but not");
    const auto type = type_in(set);
    if (axis.size > most_coordinates || is_bare || !type) return;
    const std::string name = fmt::format("{}: its coordinates {}", array, one_line(axis.name));
    axis.coordinates = values_in(set, name, *type, false)
                           .meant(numbers_in(set, static_cast<std::size_t>(axis.size)));
}

// The data set with an axis's coordinates, of which libhdf5 has found an id: it may store them in
// other files.
struct FoundScale {
    Hdf5Handle set{-1, H5Dclose};
    std::string path;
};

// Notes the first dimension scale of an axis. H5DSiterate_scales() calls this for each.
herr_t note_scale(hid_t /*set*/, unsigned /*axis*/, hid_t scale, void* data) {
    auto& found = *static_cast<FoundScale*>(data);
    H5Iinc_ref(scale);
    found.set = Hdf5Handle(scale, H5Dclose);
    char path[4096] = {};
    if (H5Iget_name(scale, path, sizeof path) > 0) found.path = path;
    return 1;  // no further one
}

// Cuts a text into words of letters, digits, '_' and '.'; a single word of `count` letters is cut
// into these.
std::vector<std::string> words_in(const std::string& text, std::size_t count) {
    std::vector<std::string> words(1);
    for (const char letter : text) {
        if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '.')
            words.back() += letter;
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    if (words.size() == 1 && count > 1 && words[0].size() == count) {
        const std::string letters = words[0];
        words.clear();
        for (const char letter : letters) words.emplace_back(1, letter);
    }
    return words;
}

// Describes the axes of one array.
class AxisReader {
  public:
    AxisReader(Hdf5Files& files, const Hdf5Array& array, const std::string& path)
        : files_(files), array_(array) {
        described.name = array.name();
        for (const std::int64_t size : array.shape())
            described.axes.push_back({size, "", {}, "", {}});
        constexpr std::size_t most_parents = 16;
        std::size_t end = path.rfind('/');
        for (; end != path.npos && end > 0 && parents_.size() < most_parents;
             end = path.rfind('/', end - 1))
            parents_.push_back(path.substr(0, end));
        parents_.emplace_back("/");
    }

    DescribedArray described;

    void name_axes(const std::vector<std::string>& names) {
        if (names.size() != described.axes.size()) return;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (described.axes[i].name.empty() && names[i] != ".")
                described.axes[i].name = names[i];
    }

    // Reads vigra's tags: {"axes": [{"key": "z", "resolution": 0, ...}, ...]}.
    void read_axistags() {
        const std::string text = text_of(array_.id(), "axistags");
        if (text.empty()) return;
        std::vector<std::string> names;
        std::vector<double> steps;
        try {
            const nlohmann::json tags = parse_json(text);
            for (const nlohmann::json& axis : tags.at("axes")) {
                names.push_back(axis.at("key").get<std::string>());
                steps.push_back(axis.value("resolution", 0.0));
            }
        } catch (const std::exception&) {
            names.clear();
        }
        if (names.size() != described.axes.size()) {
            fail("{}: axistags: found {}, expected a list \"axes\" with {} times a \"key\"",
                 array_.name(), shortened(one_line(text)), described.axes.size());
        }
        name_axes(names);
        std::vector<std::string> unknown;  // a resolution of 0, by vigra's AxisInfo
        bool is_any_known = false;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i].find_first_of("xyz") == std::string::npos) continue;
            is_any_known |= steps[i] > 0;
            if (steps[i] > 0) continue;
            unknown.push_back(fmt::format("{} of {}", steps[i], one_line(names[i])));
            steps[i] = 1;
        }
        if (!is_any_known) return;
        described.steps = steps;
        if (!unknown.empty()) {
            say("{}: axistags: the resolution {} is unknown: 1 is taken", array_.name(),
                fmt::join(unknown, ", "));
        }
    }

    void read_names() {
        read_attribute(array_.id());
        for (const std::string& parent : parents_) read_attribute(files_.group(parent).id());
    }

    void read_labels_and_scales() {
        name_axes(texts_of(array_.id(), "DIMENSION_LABELS"));
        for (std::size_t i = 0; i < described.axes.size(); ++i) {
            ArrayAxis& axis = described.axes[i];
            const auto number = static_cast<unsigned>(i);
            FoundScale scale;
            if (H5DSget_num_scales(array_.id(), number) > 0)
                H5DSiterate_scales(array_.id(), number, nullptr, note_scale, &scale);
            if (!scale.set.valid()) continue;
            if (axis.name.empty()) axis.name = scale.path.substr(scale.path.rfind('/') + 1);
            // open_beside() throws Error unless all files that it stores samples in are allowed.
            if (stores_elsewhere(scale.set.id())) scale.set = files_.open_beside(scale.path);
            if (scale.set.valid()) read_coordinates(scale.set.id(), array_.name(), axis);
        }
        described.coordinates = text_of(array_.id(), "coordinates");
    }

    // Reads coordinates from data sets beside the array, with the names of axes (NeXus, xarray), or
    // called dim1, dim2 and so on (EMD of electron microscopes, emdatasets.com).
    void read_coordinates_beside() {
        const bool is_emd = H5Aexists(files_.group(parents_[0]).id(), "emd_group_type") > 0;
        for (std::size_t i = 0; i < described.axes.size(); ++i) {
            ArrayAxis& axis = described.axes[i];
            const std::string name = is_emd ? fmt::format("dim{}", i + 1) : axis.name;
            if (name.empty() || !axis.coordinates.empty()) continue;
            const std::string path =
                fmt::format("{}/{}", parents_[0] == "/" ? "" : parents_[0], name);
            if (name.find('/') != name.npos || !files_.has(path)) continue;
            const Hdf5Handle set = files_.open_beside(path);
            if (!set.valid()) continue;
            if (is_emd) axis.name = text_of(set.id(), "name");
            read_coordinates(set.id(), array_.name(), axis);
        }
    }

    // Reads what HDF5's image specification says of colours (attributes CLASS and INTERLACE_MODE).
    void read_image(VolumeContents& contents) {
        if (text_of(array_.id(), "CLASS") != "IMAGE") return;
        const std::string kind = text_of(array_.id(), "IMAGE_SUBCLASS");
        if (kind == "IMAGE_INDEXED" || H5Aexists(array_.id(), "PALETTE") > 0)
            say("{}: its colours (PALETTE) are not used: the values are indices of them",
                array_.name());
        if (kind != "IMAGE_TRUECOLOR" || described.axes.size() != 3) return;
        const std::string order = text_of(array_.id(), "INTERLACE_MODE");
        for (ArrayAxis& axis : described.axes) axis.name.clear();
        name_axes(words_in(order == "INTERLACE_PLANE"  ? "cyx"
                           : order == "INTERLACE_LINE" ? "ycx"
                                                       : "yxc",
                           3));
        contents.is_colour = true;
    }

    // Reads distances and places along x, y and z that programs keep beside an array [z, y, x]:
    // Chimera in attributes of its group, DREAM.3D, whose origin is a corner, in data sets.
    void read_geometry() {
        std::vector<double> steps, firsts;
        const std::string geometry =
            fmt::format("{}/_SIMPL_GEOMETRY", parents_.size() > 1 ? parents_[1] : "");
        if (parents_[0].starts_with("/Chimera/")) {
            const Hdf5Handle group = files_.group(parents_[0]);
            steps = numbers_of(group.id(), "step");
            firsts = numbers_of(group.id(), "origin");
            const auto differ = [&](const char* key, double usual) {
                return std::ranges::any_of(numbers_of(group.id(), key),
                                           [&](double number) { return number != usual; });
            };
            if (differ("rotation_angle", 0) || differ("cell_angles", 90))
                say("{}: rotation_angle and cell_angles are not used: the grid is drawn as if it "
                    "were neither turned nor oblique",
                    array_.name());
        } else if (files_.has(geometry)) {
            steps = files_.numbers(geometry + "/SPACING", 3);
            firsts = files_.numbers(geometry + "/ORIGIN", 3);
            for (std::size_t i = 0; i < std::min(steps.size(), firsts.size()); ++i)
                firsts[i] += steps[i] / 2;
        }
        if (steps.size() != 3 || firsts.size() != 3) return;
        name_axes(words_in(described.axes.size() == 3 ? "zyx" : "zyxc", described.axes.size()));
        described.steps.assign(steps.rbegin(), steps.rend());
        described.firsts.assign(firsts.rbegin(), firsts.rend());
    }

    // Names the axes of images of Thermo Fisher's Velox (.emd), whose frames come last.
    void read_velox() {
        if (!parents_[0].starts_with("/Data/Image/") || !files_.has(parents_[0] + "/Metadata"))
            return;
        name_axes({"y", "x", "t"});
        say("{}: Velox keeps the sizes of pixels in Metadata, which is not read: they are taken as "
            "1, \"spacing\" in the volume gives others",
            array_.name());
    }

    // Says how the axes of a matrix lie, which MATLAB and Octave write with the first one fastest.
    void say_if_transposed() const {
        const bool is_matlab = H5Aexists(array_.id(), "MATLAB_class") > 0;
        const Hdf5Handle group = files_.group(parents_[0]);
        if (!is_matlab && H5Aexists(group.id(), "OCTAVE_NEW_FORMAT") <= 0) return;
        say("{}: {} has written it: its first axis (rows) is taken for x, its second "
            "(columns) for y",
            array_.name(), is_matlab ? "MATLAB" : "Octave");
    }

    // Reads distances and places from attributes of the array or, if it has none, of its groups.
    void read_lengths() {
        read_lengths(array_.id(), true);
        for (const std::string& parent : parents_) read_lengths(files_.group(parent).id(), false);
    }

    // Reads what openPMD adds (standard 1.1, "Mesh Based Records"): the place of values in their
    // cells, and the SI values of one unit.
    void read_openpmd() {
        if (H5Aexists(files_.group("/").id(), "openPMD") <= 0) return;
        const std::vector<double> position = numbers_of(array_.id(), "position");
        const std::size_t count = described.axes.size();
        if (position.size() == count && described.steps.size() == count) {
            described.firsts.resize(count);
            for (std::size_t i = 0; i < count; ++i)
                described.firsts[i] += position[i] * described.steps[i];
        }
        const std::vector<double> value = numbers_of(array_.id(), "unitSI");
        if (value.size() == 1 && value[0] != 1) {
            say("{}: unitSI {}: values are as they are stored, not in SI units", array_.name(),
                value[0]);
        }
    }

  private:
    void read_lengths(hid_t object, bool is_own) {
        add_lengths(described,
                    {[&](const std::string& key) { return numbers_of(object, key); },
                     [&](const std::string& key) { return text_of(object, key); }, is_own});
    }

    // Reads names of axes from one attribute of an object, if there is one.
    void read_attribute(hid_t object) {
        for (const char* const key : axis_name_keys) {
            const std::vector<std::string> texts = texts_of(object, key);
            const std::size_t count = described.axes.size();
            name_axes(texts.size() == 1 ? words_in(texts[0], count) : texts);
        }
    }

    Hdf5Files& files_;
    const Hdf5Array& array_;
    std::vector<std::string> parents_;  // groups, from the array's up to the root
};

}  // namespace

PackedValues values_in(hid_t set, const std::string& name, ValueType type, bool has_defaults) {
    const auto attribute = [set](const char* key) {
        PackedAttribute found{numbers_of(set, key), type_of(set, key), text_of(set, key)};
        if (found.numbers.empty() && found.text.empty() && H5Aexists(set, key) > 0)
            found.text = "neither text nor up to 64 numbers";
        return found;
    };
    return PackedValues(name, type, has_defaults, attribute);
}

DescribedArray describe_hdf5(Hdf5Files& files, const Hdf5Array& array, const Hdf5Layout& layout,
                             VolumeContents& contents) {
    AxisReader reader(files, array, layout.array);
    if (!layout.labels.empty()) {
        reader.name_axes(words_in(layout.labels, array.shape().size()));
        return reader.described;
    }
    reader.say_if_transposed();
    reader.read_axistags();
    reader.read_image(contents);
    reader.read_labels_and_scales();
    reader.read_names();
    reader.read_coordinates_beside();
    reader.read_geometry();
    reader.read_velox();
    reader.read_lengths();
    reader.read_openpmd();
    return reader.described;
}

}  // namespace lamina
