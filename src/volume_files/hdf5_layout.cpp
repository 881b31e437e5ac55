// SPDX-License-Identifier: Apache-2.0
// Imaris: "Imaris 5.5 File Format" (imaris.oxinst.com). BigDataViewer: imagej.net/plugins/bdv.
// VTKHDF: docs.vtk.org, "VTKHDF format specification". ITK: itkHDF5ImageIO.cxx.
#include "volume_files/hdf5_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "volume_files/numbered_files.h"
#include "volume_files/stored_data.h"

namespace lamina {
namespace {

constexpr std::int64_t most_parts = 100'000;  // levels, times or channels

// Returns how many numbers from 0 on are names in the file. `path` makes the name.
template <typename Path>
std::int64_t count_of(const Hdf5Files& files, const Path& path) {
    std::int64_t count = 0;
    while (count < most_parts && files.has(path(count))) ++count;
    return count;
}

Hdf5Handle group_of(const Hdf5Files& files, const std::string& path) {
    Hdf5Handle group = files.group(path);
    if (!group.valid()) {
        fail("{}:{}: found no such group in the file itself, expected one: links are not followed",
             files.name(), path);
    }
    return group;
}

// Returns `count` numbers of an attribute of a group. Throws Error.
std::vector<double> expected_numbers(const Hdf5Files& files, const std::string& group,
                                     const char* key, std::size_t count) {
    std::vector<double> numbers = numbers_of(group_of(files, group).id(), key);
    if (numbers.size() != count ||
        !std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
        fail("{}:{}: {}: found {} numbers, expected {}, all finite", files.name(), group, key,
             numbers.size(), count);
    return numbers;
}

std::int64_t take(const Hdf5Files& files, const char* what,
                  const std::optional<std::int64_t>& wanted, std::int64_t count) {
    if (count == 0) fail("{}: found no {} 0, expected one", files.name(), what);
    return taken_of(files.name(), what, wanted, count);
}

// Files of Imaris have an array for each level, time and channel, whose last chunks are padded.
class ImarisReader {
  public:
    explicit ImarisReader(const Hdf5Files& files) : files_(files) {}

    Hdf5Layout read(const std::string& array, const VolumeRequest& request,
                    VolumeContents& contents) const {
        if (!array.empty() && array.starts_with("/DataSet/")) {
            fail("{}: array: found \"{}\", expected none: level, time and channel choose it",
                 files_.name(), one_line(array));
        }
        if (!array.empty()) return Hdf5Layout(array, request);
        const auto levels = count_of(files_, [](std::int64_t i) { return channel(i, 0, 0); });
        const auto times = count_of(files_, [](std::int64_t i) { return channel(0, i, 0); });
        const auto channels = count_of(files_, [](std::int64_t i) { return channel(0, 0, i); });
        const std::string group = channel(take(files_, "level", request.level, levels),
                                          take(files_, "time", request.time, times),
                                          take(files_, "channel", request.channel, channels));
        for (std::int64_t i = 0; i < levels; ++i) contents.levels.push_back(size(channel(i, 0, 0)));
        for (std::int64_t i = 0; i < channels; ++i)
            contents.channels.push_back(text(fmt::format("/DataSetInfo/Channel {}", i), "Name"));
        for (std::int64_t i = 0; i < times; ++i)
            contents.times.push_back(
                text("/DataSetInfo/TimeInfo", fmt::format("TimePoint{}", i + 1)));
        Hdf5Layout layout(group + "/Data", {}, "zyx");
        layout.size = size(group);
        layout.grid = grid(layout.size);
        return layout;
    }

  private:
    static std::string channel(std::int64_t level, std::int64_t time, std::int64_t channel) {
        return fmt::format("/DataSet/ResolutionLevel {}/TimePoint {}/Channel {}", level, time,
                           channel);
    }
    double number(const std::string& group, const std::string& key) const {
        const std::string text = text_of(group_of(files_, group).id(), key);
        // text_of() has left out zero bytes at the end; blanks may fill it up, too.
        const auto value = number_in<double>(text.substr(0, text.find_last_not_of(' ') + 1));
        if (!value || !(std::abs(*value) < 1e12)) {
            fail("{}:{}: {}: found \"{}\", expected a number", files_.name(), group, key,
                 one_line(text));
        }
        return *value;
    }

    std::array<std::int64_t, 3> size(const std::string& group) const {
        std::array<std::int64_t, 3> size{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string key = fmt::format("ImageSize{}", "XYZ"[i]);
            const double found = number(group, key);
            if (found < 1 || found != std::floor(found)) {
                fail("{}:{}: {}: found {}, expected a whole number, 1 or more", files_.name(),
                     group, key, found);
            }
            size[i] = static_cast<std::int64_t>(found);
        }
        return size;
    }

    // The extents are those of the voxels, whose middles the samples are.
    Grid grid(const std::array<std::int64_t, 3>& size) const {
        Grid grid;
        for (int i = 0; i < 3; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double begin = number(image, fmt::format("ExtMin{}", i));
            const double end = number(image, fmt::format("ExtMax{}", i));
            grid.step[at] *= (end - begin) / static_cast<double>(size[at]);
            grid.origin[i] = begin + grid.step[at][i] / 2;
            grid.centering[at] = Centering::cell;
        }
        grid.unit = unit_word(text_of(group_of(files_, image).id(), "Unit"));
        return grid;
    }

    std::string text(const std::string& group, const std::string& key) const {
        return files_.has(group) ? one_line(text_of(group_of(files_, group).id(), key)) : "";
    }

    static constexpr const char* image = "/DataSetInfo/Image";
    const Hdf5Files& files_;
};

// Returns the path of an array of BigDataViewer.
std::string cells_of(std::int64_t time, std::int64_t setup, std::int64_t level) {
    return fmt::format("/t{:05}/s{:02}/{}/cells", time, setup, level);
}

// Returns the request with time, setup and level of the path of an array of BigDataViewer, or
// nothing if the path is of another array. Throws Error if the request says other ones.
std::optional<VolumeRequest> request_of_cells(const Hdf5Files& files, const std::string& array,
                                              VolumeRequest request) {
    unsigned time = 0, setup = 0, level = 0;
    const int found = std::sscanf(array.c_str(), "/t%9u/s%9u/%9u/cells", &time, &setup, &level);
    if (found != 3 || array != cells_of(time, setup, level)) return {};
    const auto set = [&](const char* key, std::optional<std::int64_t>& to, unsigned number) {
        if (to && *to != number) {
            fail("{}: {}: found {}, expected {} or none: array {} says it", files.name(), key, *to,
                 number, array);
        }
        to = number;
    };
    set("time", request.time, time);
    set("channel", request.channel, setup);
    set("level", request.level, level);
    return request;
}

// Files of BigDataViewer have an array for each time, setup (which counts as a channel) and level.
Hdf5Layout big_data_viewer(Hdf5Files& files, const VolumeRequest& request,
                           VolumeContents& contents) {
    const auto path = cells_of;
    const auto times = count_of(files, [&](std::int64_t i) { return path(i, 0, 0); });
    const auto setups = count_of(files, [&](std::int64_t i) { return path(0, i, 0); });
    const std::int64_t time = take(files, "time", request.time, times);
    const std::int64_t setup = take(files, "channel", request.channel, setups);
    const auto levels = count_of(files, [&](std::int64_t i) { return path(time, setup, i); });
    const auto level = static_cast<std::size_t>(take(files, "level", request.level, levels));
    contents.times.resize(static_cast<std::size_t>(times));
    contents.channels.resize(static_cast<std::size_t>(setups));
    Hdf5Layout layout(path(time, setup, static_cast<std::int64_t>(level)), {}, "zyx");
    layout.is_unsigned = true;  // bdv-core writes uint16 as int16

    const std::string name = fmt::format("/s{:02}/resolutions", setup);
    const std::vector<double> factors = files.numbers(name);
    if (factors.size() != 3 * static_cast<std::size_t>(levels)) {
        fail("{}:{}: found {} numbers, expected {}, three a level", files.name(), name,
             factors.size(), 3 * levels);
    }
    layout.grid.emplace();
    for (int i = 0; i < 3; ++i) {
        const double factor = factors[3 * level + static_cast<std::size_t>(i)];
        layout.grid->step[static_cast<std::size_t>(i)] *= factor;
        layout.grid->origin[i] = (factor - 1) / 2;  // the middle of the voxels that one stands for
    }
    say("{}: BigDataViewer keeps the sizes of voxels in its .xml, which is not read: "
        "they are taken as 1, \"spacing\" in the volume gives others",
        files.name());
    return layout;
}

// Returns the names in a group; none if there is no such group. Throws Error if a link stands for
// the group, because libhdf5 would open any file to which it leads.
std::vector<std::string> names_in(const Hdf5Files& files, const std::string& group) {
    std::vector<std::string> names;
    if (!files.has(group)) return names;
    const Hdf5Handle opened = group_of(files, group);
    H5Literate(
        opened.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
            auto& list = *static_cast<std::vector<std::string>*>(data);
            list.emplace_back(name);
            return list.size() < 1000 ? 0 : 1;
        },
        &names);
    return names;
}

// Images of VTKHDF: arrays of points and of cells, with time before the other axes and components
// behind them.
class VtkHdfReader {
  public:
    explicit VtkHdfReader(Hdf5Files& files) : files_(files) {}

    Hdf5Layout read(const std::string& wanted, const VolumeRequest& request,
                    VolumeContents& contents) {
        const std::string type = text_of(group_of(files_, root).id(), "Type");
        if (type != "ImageData") {
            fail(
                "{}: found VTKHDF of type \"{}\", expected ImageData: ParaView can save it as "
                ".vtu, "
                "or resample it to an image",
                files_.name(), one_line(type));
        }
        Hdf5Layout layout(array(wanted, contents), request);
        const bool of_cells = layout.array.starts_with("/VTKHDF/CellData/");
        place(layout, of_cells);
        const int rank = rank_of(files_.open_beside(layout.array).id());
        const bool is_temporal = files_.has("/VTKHDF/Steps") && rank >= 4;
        layout.labels = is_temporal ? "tzyxc" : "zyxc";
        if (rank < 3 || rank > static_cast<int>(layout.labels.size()))
            fail("{}:{}: found {} axes, expected those of an image", files_.name(), layout.array,
                 rank);
        layout.labels.resize(static_cast<std::size_t>(rank));
        if (files_.has("/VTKHDF/Steps")) take_step(layout, is_temporal, contents);
        return layout;
    }

  private:
    std::string array(const std::string& wanted, VolumeContents& contents) {
        std::string scalars;
        for (const char* const group : {"/VTKHDF/PointData", "/VTKHDF/CellData"}) {
            for (const std::string& name : names_in(files_, group)) {
                contents.arrays.push_back(fmt::format("{}/{}", group, name));
                if (wanted == name || wanted == contents.arrays.back())
                    return contents.arrays.back();
            }
            if (scalars.empty() && files_.has(group)) {
                const std::string active = text_of(group_of(files_, group).id(), "Scalars");
                if (!active.empty()) scalars = fmt::format("{}/{}", group, active);
            }
        }
        if (!wanted.empty() || contents.arrays.empty()) {
            fail("{}: array: found \"{}\", expected one of {}", files_.name(), one_line(wanted),
                 names_text(contents.arrays));
        }
        if (files_.has(scalars) && !scalars.empty()) return scalars;
        if (contents.arrays.size() > 1) {
            say("{}: array {} of {} is taken: {}", files_.name(), one_line(contents.arrays[0]),
                contents.arrays.size(), names_another("array", "NAME"));
        }
        return contents.arrays[0];
    }

    void place(Hdf5Layout& layout, bool of_cells) const {
        const auto extent = expected_numbers(files_, root, "WholeExtent", 6);
        const auto origin = expected_numbers(files_, root, "Origin", 3);
        const auto spacing = expected_numbers(files_, root, "Spacing", 3);
        std::vector<double> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
        if (H5Aexists(group_of(files_, root).id(), "Direction") > 0)
            direction = expected_numbers(files_, root, "Direction", 9);
        Grid& grid = layout.grid.emplace();
        grid.origin = {origin[0], origin[1], origin[2]};
        for (std::size_t i = 0; i < 3; ++i) {
            grid.step[i] =
                spacing[i] * glm::dvec3(direction[i], direction[i + 3], direction[i + 6]);
            const double length = extent[2 * i + 1] - extent[2 * i] + (of_cells ? 0 : 1);
            // An image that is flat along an axis has one layer of cells there.
            layout.size[i] = static_cast<std::int64_t>(std::clamp(length, 1.0, 1e12));
            const bool is_flat = of_cells && length < 1;
            grid.origin += grid.step[i] * (extent[2 * i] + (of_cells && !is_flat ? 0.5 : 0));
            grid.centering[i] = of_cells || layout.size[i] == 1 ? Centering::cell : Centering::node;
        }
    }

    // Takes a step in time: its values begin at an offset of the array's first axis.
    void take_step(Hdf5Layout& layout, bool is_temporal, VolumeContents& contents) {
        const auto count = static_cast<std::int64_t>(
            std::clamp(expected_numbers(files_, "/VTKHDF/Steps", "NSteps", 1)[0], 1.0, 1e6));
        const std::int64_t step = take(files_, "time", layout.request.time, count);
        contents.times.resize(static_cast<std::size_t>(count));
        const auto values = files_.numbers("/VTKHDF/Steps/Values", contents.times.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            contents.times[i] = fmt::format("{}", values[i]);
        layout.request.time.reset();
        if (!is_temporal) return;
        const std::size_t data = layout.array.find('/', 8), name = layout.array.rfind('/');
        const auto offsets =
            files_.numbers(fmt::format("/VTKHDF/Steps/{}Offsets{}",
                                       layout.array.substr(8, data - 8), layout.array.substr(name)),
                           contents.times.size());
        const double first =
            offsets.empty() ? static_cast<double>(step) : offsets[static_cast<std::size_t>(step)];
        const bool is_index = first >= 0 && first < 1e12;  // not if it is NaN
        layout.request.time = is_index ? static_cast<std::int64_t>(first) : -1;
    }

    static constexpr const char* root = "/VTKHDF";
    Hdf5Files& files_;
};

// An image that ITK wrote. The rows of its directions are the axes.
Hdf5Layout itk_image(Hdf5Files& files, const VolumeRequest& request) {
    const auto list = [&](const char* name, std::size_t count) {
        const std::string path = fmt::format("/ITKImage/0/{}", name);
        std::vector<double> numbers = files.numbers(path, count);
        if (numbers.empty())
            fail("{}:{}: found none, expected {} numbers", files.name(), path, count);
        return numbers;
    };
    Hdf5Layout layout("/ITKImage/0/VoxelData", request);
    const auto spacing = list("Spacing", 3), origin = list("Origin", 3),
               directions = list("Directions", 9);
    Grid& grid = layout.grid.emplace();
    for (std::size_t i = 0; i < 3; ++i)
        grid.step[i] = spacing[i] *
                       glm::dvec3(directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]);
    grid.origin = {origin[0], origin[1], origin[2]};
    grid.axes = WorldAxes::left_posterior_superior;  // as in all of ITK
    layout.labels = rank_of(files.open_beside(layout.array).id()) == 4 ? "zyxc" : "zyx";
    return layout;
}

// Returns the path of an array in one spelling: "/GROUP/ARRAY". Names without groups stay as they
// are, because programs name some arrays by their last part.
std::string one_spelling(const std::string& path) {
    if (path.find('/') == path.npos) return path;
    std::string spelled;
    for (const char letter : "/" + path)
        if (letter != '/' || !spelled.ends_with('/')) spelled += letter;
    return spelled;
}

// Returns the one of several arrays that its group calls its signal (NeXus, "NXdata"), and says so;
// empty if not exactly one is.
std::string signal_of(const Hdf5Files& files, const std::vector<std::string>& arrays) {
    if (arrays.size() < 2) return {};
    std::vector<std::string> signals;
    for (const std::string& array : arrays) {
        const std::size_t slash = array.rfind('/');
        const Hdf5Handle group = files.group(slash == 0 ? "/" : array.substr(0, slash));
        if (group.valid() && text_of(group.id(), "signal") == array.substr(slash + 1))
            signals.push_back(array);
    }
    if (signals.size() != 1) return {};
    say("{}: array {} of {} is taken, the signal of its group (NeXus): {}", files.name(),
        one_line(signals[0]), arrays.size(), names_another("array", "NAME"));
    return signals[0];
}

}  // namespace

Hdf5Layout hdf5_layout(Hdf5Files& files, const std::string& named, const VolumeRequest& request,
                       VolumeContents& contents) {
    const std::string array = one_spelling(named);
    if (files.has("/DataSet") && files.has("/DataSetInfo/Image"))
        return ImarisReader(files).read(array, request, contents);
    if (files.has("/VTKHDF") &&
        (array.empty() || !array.starts_with('/') || array.starts_with("/VTKHDF/")))
        return VtkHdfReader(files).read(array, request, contents);
    if (files.has("/s00/resolutions") && files.has("/t00000/s00")) {
        if (array.empty()) return big_data_viewer(files, request, contents);
        if (const auto of_path = request_of_cells(files, array, request))
            return big_data_viewer(files, *of_path, contents);
    }
    if (request.level) take(files, "level", request.level, 1);
    if ((array.empty() || array == "/ITKImage/0/VoxelData") && files.has("/ITKImage/0/VoxelData"))
        return itk_image(files, request);
    if ((array.empty() || array.starts_with("/minc-2.0/")) && files.has("/minc-2.0"))
        fail_as_minc(files.name());
    if (!array.empty()) return Hdf5Layout(array, request);
    contents.arrays = files.arrays();
    const std::string signal = signal_of(files, contents.arrays);
    return Hdf5Layout(signal.empty() ? only_array(contents.arrays, files.name()) : signal, request);
}

}  // namespace lamina
