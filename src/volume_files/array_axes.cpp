// SPDX-License-Identifier: Apache-2.0
#include "volume_files/array_axes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "base/error.h"
#include "volume_files/numbered_files.h"
#include "volume_files/stored_data.h"

namespace lamina {
namespace {

enum class AxisRole { x, y, z, channel, time, unknown };
constexpr std::size_t role_count = 5;  // without unknown

// Words for axes, in lower case, separated by blanks: of CF's standard names, NetCDF programs,
// ilastik, MINC, WRF, NEMO and image programs.
constexpr std::string_view role_words[role_count] = {
    " x nx xc xt xdim xspace i ni lon nlon rlon longitude grid_longitude projection_x_coordinate "
    "easting west_east column columns col cols width ",
    " y ny yc yt ydim yspace j nj lat nlat rlat latitude grid_latitude projection_y_coordinate "
    "northing south_north row rows ",
    " z nz zc zt zdim zspace k nk lev nlev level levels plev plevel pressure pressure_level "
    "air_pressure isobaric hybrid sigma depth deptht depthu depthv depthw height altitude "
    "elevation "
    "bottom_top model_level_number height_above_ground depth_below_surface slice slices plane "
    "planes ",
    " c ch nc channel channels band bands component components rgb rgba color colour vector ",
    " t nt time times time_counter timestep tspace frame frames batch "};

// Returns a name in lower case, without what programs append to words for axes.
std::string stem_of(const std::string& name) {
    std::string word = lower_case(name);
    if (word.ends_with("_stag")) word.resize(word.size() - 5);  // WRF: between the cells
    while (word.size() > 1 &&
           (std::isdigit(static_cast<unsigned char>(word.back())) != 0 || word.back() == '_'))
        word.pop_back();  // programs number axes of one kind
    return word;
}

AxisRole role_of_word(const std::string& name) {
    const std::string word = stem_of(name);
    if (word.empty() || word.find(' ') != word.npos) return AxisRole::unknown;
    const std::string whole = " " + word + " ";
    for (std::size_t role = 0; role < role_count; ++role)
        if (role_words[role].find(whole) != std::string_view::npos)
            return static_cast<AxisRole>(role);
    return AxisRole::unknown;
}

// Returns the role that attributes give an axis.
AxisRole role_of_attributes(const ArrayAxis& axis) {
    for (const std::string& kind : axis.kinds)
        if (const AxisRole role = role_of_word(kind); role != AxisRole::unknown) return role;
    if (axis.unit.find(" since ") != axis.unit.npos) return AxisRole::time;
    for (const char* const word : {"degrees_", "degree_"}) {
        if (axis.unit.starts_with(word))
            return axis.unit.ends_with("N") || axis.unit.ends_with("north") ? AxisRole::y
                                                                            : AxisRole::x;
    }
    return AxisRole::unknown;
}

// Returns the role of an axis's name among `axes`. If they share a word and numbers tell them
// apart, x1, x2 and x3 are x, y and z, and others are unknown.
AxisRole role_of_name(const std::string& name, const std::vector<ArrayAxis>& axes) {
    const auto is_numbered = [](const std::string& word) {
        return !word.empty() && std::isdigit(static_cast<unsigned char>(word.back())) != 0;
    };
    const std::string stem = stem_of(name);
    bool is_shared = false, are_directions = stem == "x";
    for (const ArrayAxis& axis : axes) {
        if (stem_of(axis.name) != stem) continue;
        is_shared |= axis.name != name;
        are_directions &= axis.name.size() == 2 && axis.name[1] >= '1' && axis.name[1] <= '3';
    }
    if (!is_shared || !is_numbered(name)) return role_of_word(name);
    return are_directions ? static_cast<AxisRole>(name[1] - '1') : AxisRole::unknown;
}

// Gives axes their roles by attributes, else by names. "height" is along y in images, beside
// "width" or a name for z, and along z elsewhere.
std::vector<AxisRole> roles_of(const std::vector<ArrayAxis>& axes) {
    std::vector<AxisRole> roles;
    std::vector<std::size_t> heights;
    bool is_image = false, has_y = false;
    for (const ArrayAxis& axis : axes) {
        AxisRole role = role_of_attributes(axis);
        const std::string stem = stem_of(axis.name);
        if (role == AxisRole::unknown) {
            role = role_of_name(axis.name, axes);
            if (role == AxisRole::z && stem == "height") heights.push_back(roles.size());
        }
        is_image |= stem == "width" || (role == AxisRole::z && stem != "height");
        has_y |= role == AxisRole::y;
        roles.push_back(role);
    }
    if (is_image && !has_y)
        for (const std::size_t height : heights) roles[height] = AxisRole::y;
    return roles;
}

// Equally spaced coordinates: their distance, the first one, and by how much of the distance
// coordinates differ from these at most.
struct RegularAxis {
    double step, first, deviation;
};

// Rounding of coordinates to float32, by up to 6e-8 of a coordinate, stays below this share of
// their distance up to some 16,000 steps from 0.
constexpr double unsaid_deviation = 1e-3;
constexpr double largest_deviation = 0.05;  // Gaussian latitudes, and stages that are not exact

// Returns nothing unless the coordinates are equally spaced.
std::optional<RegularAxis> regular(const std::vector<double>& coordinates) {
    const std::size_t count = coordinates.size();
    if (count < 2) return {};
    RegularAxis axis{};
    axis.first = coordinates.front();
    axis.step = (coordinates.back() - axis.first) / static_cast<double>(count - 1);
    if (!std::isfinite(axis.step) || axis.step == 0) return {};
    for (std::size_t i = 0; i < count; ++i) {
        const double expected = axis.first + axis.step * static_cast<double>(i);
        const double deviation = std::abs((coordinates[i] - expected) / axis.step);
        if (!(deviation <= largest_deviation)) return {};
        axis.deviation = std::max(axis.deviation, deviation);
    }
    return axis;
}

// Gives each axis of an array its role, and takes one index on those that are not in space.
class RoleFinder {
  public:
    RoleFinder(const DescribedArray& array, const VolumeRequest& request)
        : array_(array), request_(request) {
        place.index.assign(array.axes.size(), 0);
        const std::vector<AxisRole> roles = roles_of(array.axes);
        for (std::size_t i = 0; i < array.axes.size(); ++i) {
            const AxisRole role = roles[i];
            if (role == AxisRole::unknown || axis_of(role) >= 0)
                unknown_.push_back(static_cast<int>(i));
            else
                axis_of(role) = static_cast<int>(i);
        }
        is_named =
            std::ranges::all_of(std::span(axes_).first(3), [](int axis) { return axis >= 0; });
        take_by_order();
        take("channel", axis_of(AxisRole::channel), request.channel);
        take("time", axis_of(AxisRole::time), request.time);
        say_taken(array.name, taken_);
        std::copy_n(axes_.begin(), 3, place.axes.begin());
    }

    int axis_of(AxisRole role) const { return axes_[static_cast<std::size_t>(role)]; }

    ArrayPlace place;
    bool is_named = false;  // x, y and z are known by names or attributes, not by their order

  private:
    int& axis_of(AxisRole role) { return axes_[static_cast<std::size_t>(role)]; }

    // Gives the axes without a known name roles by their order.
    void take_by_order() {
        // A last axis of one sample holds components, of which there is one.
        if (unknown_.size() > 3 && array_.axes[static_cast<std::size_t>(unknown_.back())].size == 1)
            unknown_.pop_back();
        std::vector<std::int64_t> sizes;
        for (const int axis : unknown_)
            sizes.push_back(array_.axes[static_cast<std::size_t>(axis)].size);
        const bool are_all = std::ranges::all_of(axes_, [](int axis) { return axis < 0; });
        if (are_all && ends_with_channels(array_.name, sizes, request_)) {
            axis_of(AxisRole::channel) = unknown_.back();
            unknown_.pop_back();
        }
        for (const AxisRole role : {AxisRole::x, AxisRole::y, AxisRole::z}) {
            if (axis_of(role) >= 0 || unknown_.empty()) continue;
            say_guess(unknown_.back(), fmt::format("{}", "xyz"[static_cast<int>(role)]));
            axis_of(role) = unknown_.back();
            unknown_.pop_back();
        }
        int &time = axis_of(AxisRole::time), &channel = axis_of(AxisRole::channel);
        std::erase_if(unknown_, [&](int axis) {
            return unknown_.size() > 2 && array_.axes[static_cast<std::size_t>(axis)].size == 1;
        });
        if (unknown_.size() == 2 && time < 0 && channel < 0) {
            time = unknown_[0];
            channel = unknown_[1];
            if (are_all) say_five_axes(array_.name);
        } else if (unknown_.size() == 1 && time < 0 && channel < 0) {
            const int axis = unknown_[0];
            taken_.push_back(unnamed_axis(array_.name, request_.channel, request_.time,
                                          array_.axes[static_cast<std::size_t>(axis)].size));
            (std::string_view(taken_[0].what) == "time" ? time : channel) = axis;
            place.index[static_cast<std::size_t>(axis)] = *taken_[0].taken;
            is_taken_ = axis;
        } else if (unknown_.size() == 1 && (time < 0 || channel < 0)) {
            say_guess(unknown_[0], time < 0 ? "time" : "channel");
            (time < 0 ? time : channel) = unknown_[0];
        } else if (!unknown_.empty()) {
            const ArrayAxis& axis = array_.axes[static_cast<std::size_t>(unknown_[0])];
            fail(
                "{}: axis {} (\"{}\", {} samples): found no meaning of it, expected z, y, x, "
                "channels and times",
                array_.name, unknown_[0], one_line(axis.name), axis.size);
        }
    }

    void say_guess(int number, const std::string& role) const {
        const ArrayAxis& axis = array_.axes[static_cast<std::size_t>(number)];
        if (axis.name.empty() || axis.size == 1) return;
        say("{}: the axis \"{}\" of {} is taken for {}, by its place among the axes", array_.name,
            one_line(axis.name), axis.size, role);
    }

    // Takes the index that is wanted on the axis of channels or times, if there is one.
    void take(const char* what, int axis, const std::optional<std::int64_t>& wanted) {
        if (axis == is_taken_ && axis >= 0) return;
        const auto number = static_cast<std::size_t>(axis);
        taken_.push_back(
            taken_axis(array_.name, what, wanted, axis < 0 ? 1 : array_.axes[number].size));
        if (axis >= 0) place.index[number] = *taken_.back().taken;
    }

    const DescribedArray& array_;
    const VolumeRequest& request_;
    std::array<int, role_count> axes_{-1, -1, -1, -1, -1};
    std::vector<int> unknown_;
    std::vector<StoredAxis> taken_;
    int is_taken_ = -1;  // the axis that unnamed_axis() has taken
};

// Returns the number for the axis `number` of the array, the `nth` of `count` in space. Three
// numbers are for z, y and x, of which a slice has the last two.
std::optional<double> number_for(const std::vector<double>& numbers, int number, std::size_t nth,
                                 std::size_t rank, std::size_t count) {
    if (numbers.size() == count) return numbers[nth];
    if (numbers.size() == rank) return numbers[static_cast<std::size_t>(number)];
    if (numbers.size() == 1) return numbers[0];
    if (numbers.size() == 3 && count == 2) return numbers[nth + 1];
    return {};
}

// Makes a slice of two axes as thick as three numbers say, else as slice_step() does. `axis`: the
// grid's axis that the array has not.
void set_thickness(const DescribedArray& array, std::size_t axis, Grid& grid) {
    glm::dvec3& step = grid.step[axis];
    step = array.steps.size() == 3 && array.axes.size() != 3
               ? step * std::abs(array.steps[0])
               : slice_step(grid.step[(axis + 1) % 3], grid.step[(axis + 2) % 3]);
}

// Places samples along one axis of the grid: its step and origin, in the unit that is returned.
std::string place_axis(const DescribedArray& array, Grid& grid, int i, int axis, std::size_t nth,
                       std::size_t count) {
    const ArrayAxis& found = array.axes[static_cast<std::size_t>(axis)];
    const std::size_t rank = array.axes.size();
    const auto at = static_cast<std::size_t>(i);
    grid.size[at] = found.size;
    grid.centering[at] = found.size > 1 ? Centering::node : Centering::cell;
    if (const auto placed = regular(found.coordinates)) {
        grid.step[at][i] = placed->step;
        grid.origin[i] = placed->first;
        const double deviation = placed->deviation;
        if (deviation > unsaid_deviation) {
            say("{}: the coordinates of {} are taken as equally spaced, which moves "
                "samples by up to {:.2g} of their distance",
                array.name, "xyz"[i], deviation);
        }
        return found.unit;
    }
    if (found.coordinates.size() > 1) {
        say("{}: the coordinates of {} are not equally spaced: its samples are taken 1 apart",
            array.name, "xyz"[i]);
        return {};
    }
    if (found.coordinates.size() == 1 && std::isfinite(found.coordinates[0]))
        grid.origin[i] = found.coordinates[0];
    const auto step = number_for(array.steps, axis, nth, rank, count);
    if (step) grid.step[at][i] = *step;
    if (array.firsts.size() > 1)
        grid.origin[i] = number_for(array.firsts, axis, nth, rank, count).value_or(0);
    return step && found.unit.empty() ? array.unit : found.unit;
}

// An attribute that says lengths, as a program spells it.
struct LengthKey {
    const char* key;
    const char* unit;  // "": an attribute beside it may say it
};
constexpr LengthKey step_keys[] = {
    {"element_size_um", "um"}, {"voxel_size_um", "um"}, {"voxel_size_nm", "nm"},
    {"voxel_size_mm", "mm"},   {"pixel_size_um", "um"}, {"resolution", ""},
    {"voxel_size", ""},        {"voxelSize", ""},       {"VoxelSize", ""},
    {"voxelsize", ""},         {"spacing", ""},         {"Spacing", ""},
    {"pixelSize", ""},         {"PixelSize", ""},       {"PixelSpacing", ""},
    {"pixel_spacing", ""},     {"voxel_spacing", ""},   {"pixel_size", ""},
    {"element_size", ""},      {"pixelResolution", ""}, {"gridSpacing", ""}};
constexpr LengthKey place_keys[] = {{"origin", ""}, {"Origin", ""},      {"offset", ""},
                                    {"Offset", ""}, {"translation", ""}, {"gridGlobalOffset", ""}};

// Returns the numbers of an attribute, if they fit the array's axes, and says how they are taken.
std::vector<double> usable_numbers(const DescribedArray& array, const ArrayAttributes& attributes,
                                   const char* key, bool are_steps) {
    std::vector<double> numbers = attributes.numbers(key);
    const std::size_t count = numbers.size();
    // A group's single number may mean anything.
    if (count == 0 || (count == 1 && !(are_steps && attributes.is_own))) return {};
    const bool good = std::ranges::all_of(numbers, [&](double number) {
        return std::isfinite(number) && (number != 0 || !are_steps);
    });
    if (!good || (count != 1 && count != 3 && count != array.axes.size())) {
        say("{}: {}: found {}, expected a number for each axis: it is not used", array.name, key,
            fmt::join(numbers, ", "));
        return {};
    }
    constexpr std::string_view defined[] = {"element_size_um", "gridSpacing", "gridGlobalOffset"};
    const bool differ =
        std::ranges::adjacent_find(numbers, std::ranges::not_equal_to()) != numbers.end();
    if (differ && std::ranges::find(defined, std::string_view(key)) == std::end(defined)) {
        say("{}: {} ({}) is taken in the order of the array's axes", array.name, key,
            fmt::join(numbers, ", "));
    }
    return numbers;
}

// Takes openPMD's lengths in the unit that its gridUnitSI is, or in metres.
void take_grid_unit(DescribedArray& array, const ArrayAttributes& attributes) {
    const std::vector<double> metres = attributes.numbers("gridUnitSI");
    if (metres.size() != 1 || !(metres[0] > 0)) return;
    array.unit = "m";
    for (const char* const unit : {"mm", "um", "nm"}) {
        if (metres_of(unit) != metres[0]) continue;
        array.unit = unit;
        return;
    }
    for (double& step : array.steps) step *= metres[0];
    for (double& first : array.firsts) first *= metres[0];
}

}  // namespace

bool ends_with_channels(const std::string& file, const std::vector<std::int64_t>& shape,
                        const VolumeRequest& request) {
    const auto is_few = [](std::int64_t size) { return size >= 2 && size <= 4; };
    const bool is_five = shape.size() == 5;
    if (!is_five && (shape.size() != 4 || request.time)) return false;
    // The axis that counts channels otherwise.
    const std::int64_t other = shape[is_five ? 1 : 0];
    if (is_few(other) || !is_few(shape.back())) return false;
    if (is_five) {
        say("{}: five axes without known names are taken for time, z, y, x and channel, because "
            "the last has {} and the second {}",
            file, shape.back(), other);
        return true;
    }
    say("{}: four axes without known names are taken for z, y, x and channel, because the "
        "last has {}: \"time\" in the volume takes the first for times",
        file, shape.back());
    return true;
}

void say_five_axes(const std::string& file) {
    say("{}: five axes without known names are taken for time, channel, z, y and x", file);
}

bool ArrayPlace::is_in_order() const {
    int before = static_cast<int>(index.size());
    for (const int axis : axes) {
        if (axis > before) return false;
        if (axis >= 0) before = axis;
    }
    return true;
}

void add_attributes(ArrayAxis& axis, const std::function<std::string(const char* key)>& text) {
    for (const char* const key : {"axis", "standard_name"}) axis.kinds.push_back(text(key));
    if (!text("positive").empty()) axis.kinds.emplace_back("z");
    if (axis.unit.empty()) axis.unit = text("units");
}

void add_lengths(DescribedArray& array, const ArrayAttributes& attributes) {
    const char* found = "";
    for (const auto& [key, unit] : step_keys) {
        if (!array.steps.empty()) break;
        array.steps = usable_numbers(array, attributes, key, true);
        if (array.steps.empty()) continue;
        found = key;
        array.unit = unit;
        for (const char* const word : {"_unit", "_units", "Unit", "Units"})
            if (array.unit.empty()) array.unit = attributes.text(std::string(key) + word);
    }
    for (const auto& [key, unit] : place_keys)
        if (array.firsts.empty()) array.firsts = usable_numbers(array, attributes, key, false);
    if (std::string_view(found) == "gridSpacing") take_grid_unit(array, attributes);
}

ArrayPlace place_array(const DescribedArray& array, const VolumeRequest& request,
                       VolumeContents& contents) {
    const RoleFinder roles(array, request);
    ArrayPlace place = roles.place;
    const auto count =
        static_cast<std::size_t>(std::ranges::count_if(place.axes, [](int at) { return at >= 0; }));
    std::array<std::string, 3> units;
    for (int i = 0; i < 3; ++i) {
        const int axis = place.axes[static_cast<std::size_t>(i)];
        if (axis < 0) {
            place.grid.centering[static_cast<std::size_t>(i)] = Centering::cell;
            continue;
        }
        const auto nth = static_cast<std::size_t>(std::ranges::count_if(
            place.axes, [&](int other) { return other >= 0 && other < axis; }));
        units[static_cast<std::size_t>(i)] =
            unit_word(place_axis(array, place.grid, i, axis, nth, count));
        if (i < 2 && !array.coordinates.empty() &&
            array.axes[static_cast<std::size_t>(axis)].coordinates.empty()) {
            say("{}: the coordinates \"{}\" are not along the axis {}: its samples are taken 1 "
                "apart",
                array.name, shortened(one_line(array.coordinates)), "xyz"[i]);
        }
    }
    unite_units(array.name, place.grid, units);
    if (const auto none = std::ranges::find(place.axes, -1); count == 2)
        set_thickness(array, static_cast<std::size_t>(none - place.axes.begin()), place.grid);
    if (roles.is_named) place.grid.axes = WorldAxes::named;
    check_grid(array.name, place.grid, {"coordinates", "coordinates"});

    constexpr std::int64_t most_listed = 10'000;  // a damaged header may promise any number
    if (const int axis = roles.axis_of(AxisRole::channel); axis >= 0 && contents.channels.empty())
        contents.channels.resize(static_cast<std::size_t>(
            std::min(most_listed, array.axes[static_cast<std::size_t>(axis)].size)));
    if (const int axis = roles.axis_of(AxisRole::time); axis >= 0 && contents.times.empty()) {
        const ArrayAxis& times = array.axes[static_cast<std::size_t>(axis)];
        contents.times.resize(static_cast<std::size_t>(std::min(most_listed, times.size)));
        for (std::size_t i = 0; i < std::min(contents.times.size(), times.coordinates.size()); ++i)
            contents.times[i] = one_line(fmt::format("{} {}", times.coordinates[i], times.unit));
    }
    return place;
}

void copy_in_order(ValueType type, const std::array<int, 3>& axes,
                   const std::vector<std::int64_t>& counts, const std::vector<std::int64_t>& index,
                   const void* from, void* to) {
    std::array<std::int64_t, 3> size{1, 1, 1}, step{0, 0, 0};
    std::int64_t first = 0, stride = 1;
    for (std::size_t axis = counts.size(); axis-- > 0; stride *= counts[axis]) {
        const auto at = std::ranges::find(axes, static_cast<int>(axis)) - axes.begin();
        if (at == 3) {
            first += index[axis] * stride;
        } else {
            size[static_cast<std::size_t>(at)] = counts[axis];
            step[static_cast<std::size_t>(at)] = stride;
        }
    }
    with_type(type, [&](auto zero) {
        using Value = decltype(zero);
        const auto* const values = static_cast<const Value*>(from) + first;
        auto* next = static_cast<Value*>(to);
        for (std::int64_t z = 0; z < size[2]; ++z)
            for (std::int64_t y = 0; y < size[1]; ++y)
                for (std::int64_t x = 0; x < size[0]; ++x)
                    *next++ = values[x * step[0] + y * step[1] + z * step[2]];
    });
}

std::string names_text(const std::vector<std::string>& arrays) {
    constexpr std::size_t most_shown = 200;  // bytes
    return shortened(one_line(fmt::format("{}", fmt::join(arrays, ", "))), most_shown);
}

std::string only_array(const std::vector<std::string>& arrays, const std::string& file) {
    if (arrays.empty())
        fail(
            "{}: found no array of three dimensions and more in it, expected one; {}:/NAME takes "
            "one of two",
            file, file);
    if (arrays.size() > 1) {
        const std::string first = names_text({arrays.front()});
        fail("{}: found the arrays {}, expected one, as in {}:{}{}", file, names_text(arrays), file,
             first.starts_with('/') ? "" : "/", first);
    }
    return arrays.front();
}

void fail_as_minc(const std::string& file) {
    fail(
        "{}: found MINC, whose slices have scales of their own, expected another format: mnc2nii "
        "makes NIfTI of it",
        file);
}

ArrayPath array_path(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::exists(path, unreadable)) return {path, ""};
    const std::string text = path.string();
    for (std::size_t at = text.find(":/"); at != std::string::npos; at = text.find(":/", at + 1)) {
        const std::filesystem::path file = text.substr(0, at);
        if (std::filesystem::is_regular_file(file, unreadable)) return {file, text.substr(at + 1)};
    }
    return {path, ""};
}

}  // namespace lamina
