// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/ranges.h>
#include <teem/nrrd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/input_file.h"
#include "image/coded_image.h"
#include "volume/labels.h"
#include "volume/nrrd_writer.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

bool has_direction(const Nrrd& nrrd, unsigned axis) {
    return nrrd.spaceDim > 0 && !std::isnan(nrrd.axis[axis].spaceDirection[0]);
}

// Tells if an axis is time: by its kind, or because its direction is the fourth axis of a space
// that has time, too (left-posterior-superior-time, as ITK writes it).
bool is_time(const Nrrd& nrrd, unsigned axis) {
    if (nrrd.axis[axis].kind == nrrdKindTime) return true;
    const double* const direction = nrrd.axis[axis].spaceDirection;
    return nrrd.spaceDim == 4 && direction[3] != 0 &&
           std::all_of(direction, direction + 3, [](double part) { return part == 0; });
}

// Tells if the header says that an axis does not lie in space.
bool is_apart(const Nrrd& nrrd, unsigned axis) {
    if (is_time(nrrd, axis)) return true;
    const int kind = nrrd.axis[axis].kind;
    if (kind != nrrdKindUnknown && kind != nrrdKindDomain) return !nrrdKindIsDomain(kind);
    for (unsigned other = 0; other < nrrd.dim; ++other)
        if (has_direction(nrrd, other)) return !has_direction(nrrd, axis);
    const auto is_spaced = [&](unsigned i) { return !std::isnan(nrrd.axis[i].spacing); };
    for (unsigned other = 0; other < nrrd.dim && kind == nrrdKindUnknown; ++other)
        if (is_spaced(other)) return !is_spaced(axis) && std::isnan(nrrd.axis[axis].min);
    return false;
}

// Returns the three axes that span the volume. If the file has more, leaves out those that do not
// lie in space, and then axes of one sample, beginning with those without a direction in space.
std::vector<unsigned> volume_axes(const std::string& file, const Nrrd& nrrd) {
    std::vector<unsigned> axes(nrrd.dim);
    std::vector<std::size_t> sizes(nrrd.dim);
    for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
        axes[axis] = axis;
        sizes[axis] = nrrd.axis[axis].size;
    }
    if (nrrd.dim > 3) std::erase_if(axes, [&](unsigned axis) { return is_apart(nrrd, axis); });
    for (const bool keep_directed : {true, false}) {
        for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 3;) {
            const bool keep = keep_directed && has_direction(nrrd, axes[i]);
            if (nrrd.axis[axes[i]].size == 1 && !keep)
                axes.erase(axes.begin() + static_cast<long>(i));
        }
    }
    if (axes.size() != 3) {
        fail(
            "{}: dimension: found {} axes (sizes {}), {} of them in space by kinds, directions "
            "and spacings, expected 3: \"kinds\" says which of more are others (time, list)",
            file, nrrd.dim, fmt::join(sizes, " "), axes.size());
    }
    for (const unsigned axis : axes) {
        const int kind = nrrd.axis[axis].kind;
        if (kind != nrrdKindUnknown && !nrrdKindIsDomain(kind)) {
            fail("{}: kinds: axis {} is '{}', expected three spatial axes, one scalar a sample",
                 file, axis, airEnumStr(nrrdKind, kind));
        }
    }
    return axes;
}

Centering centering_of(const NrrdAxisInfo& axis) {
    return axis.center == nrrdCenterCell ? Centering::cell : Centering::node;
}

// Returns the given spacing of an axis, else the one that min and max imply, else NaN.
double known_spacing_of(const NrrdAxisInfo& axis) {
    if (!std::isnan(axis.spacing)) return axis.spacing;
    const bool cell = centering_of(axis) == Centering::cell;
    const double intervals = static_cast<double>(axis.size) - (cell ? 0 : 1);
    if (intervals == 0) return 1;
    return (axis.max - axis.min) / intervals;
}

// Returns the known spacing, or 1 if the file gives none.
double spacing_of(const NrrdAxisInfo& axis) {
    const double known = known_spacing_of(axis);
    return std::isnan(known) ? 1 : known;
}

// Throws Error if an axis has no spacing. For files with the field `spacings`, which must give the
// spacing of each axis without mins and maxs.
void expect_spacings(const std::string& file, const Nrrd& nrrd, const std::vector<unsigned>& axes) {
    for (const unsigned axis : axes) {
        if (std::isnan(known_spacing_of(nrrd.axis[axis])))
            fail("{}: spacings: found nan for axis {}, expected a number above 0", file, axis);
    }
}

// Returns the position of the first sample along an axis without a direction. The min of an axis of
// cells is the border of the first cell (format, "axis mins").
double first_position_of(const NrrdAxisInfo& axis) {
    if (std::isnan(axis.min)) return 0;
    return centering_of(axis) == Centering::cell ? axis.min + spacing_of(axis) / 2 : axis.min;
}

WorldAxes axes_of(int space) {
    switch (space) {
        case nrrdSpaceLeftPosteriorSuperior:
        case nrrdSpaceScannerXYZ:  // LPS by definition
        case nrrdSpaceLeftPosteriorSuperiorTime:
        case nrrdSpaceScannerXYZTime:
            return WorldAxes::left_posterior_superior;
        case nrrdSpaceRightAnteriorSuperior:
        case nrrdSpaceRightAnteriorSuperiorTime:
            return WorldAxes::right_anterior_superior;
        case nrrdSpaceLeftAnteriorSuperior:
        case nrrdSpaceLeftAnteriorSuperiorTime:
            return WorldAxes::left_anterior_superior;
        default:
            return WorldAxes::unnamed;
    }
}

void set_steps_by_directions(const std::string& file, const Nrrd& nrrd,
                             const std::vector<unsigned>& axes, Grid& grid) {
    if (nrrd.spaceDim != 3 && nrrd.spaceDim != 4) {
        fail("{}: space: found {} dimensions, expected 3, or 4 with time", file, nrrd.spaceDim);
    }
    if (nrrd.space == nrrdSpace3DLeftHanded || nrrd.space == nrrdSpace3DLeftHandedTime)
        say("{}: space: 3D-left-handed axes are drawn as right-handed ones, which "
            "shows a mirror image",
            file);
    for (std::size_t i = 0; i < 3; ++i) {
        if (!has_direction(nrrd, axes[i])) {
            fail("{}: space directions: axis {} has none, expected three directions", file,
                 axes[i]);
        }
        const double* const direction = nrrd.axis[axes[i]].spaceDirection;
        if (nrrd.spaceDim == 4 && direction[3] != 0) {
            fail(
                "{}: space directions: axis {} runs through time, too: expected 0 as the last "
                "number of each axis in space",
                file, axes[i]);
        }
        grid.step[i] = {direction[0], direction[1], direction[2]};
    }
}

void set_steps_by_spacings(const Nrrd& nrrd, const std::vector<unsigned>& axes, Grid& grid) {
    for (int i = 0; i < 3; ++i) {
        const NrrdAxisInfo& axis = nrrd.axis[axes[static_cast<std::size_t>(i)]];
        grid.step[i] = glm::dvec3{0};
        grid.step[i][i] = spacing_of(axis);
        grid.origin[i] = first_position_of(axis);
    }
}

// Returns the units of the three axes of space: `space units` if the data's axes have directions,
// else `units`; none if an axis has none.
std::array<std::string, 3> nrrd_units(const Nrrd& nrrd, const std::vector<unsigned>& axes,
                                      bool directed) {
    std::array<std::string, 3> units;
    for (std::size_t i = 0; i < 3; ++i) {
        const char* const found = directed ? nrrd.spaceUnits[i] : nrrd.axis[axes[i]].units;
        if (found != nullptr) units[i] = unit_word(found);
    }
    const bool all = std::ranges::none_of(units, [](const auto& unit) { return unit.empty(); });
    return all ? units : std::array<std::string, 3>();
}

// Returns the grid of a parsed header (docs/scene.md, "What is drawn"). `has_spacings`: it has the
// field `spacings`. Throws Error unless there are three orthogonal, finite, spatial axes.
Grid nrrd_grid(const std::string& file, const Nrrd& nrrd, bool has_spacings) {
    const std::vector<unsigned> axes = volume_axes(file, nrrd);
    Grid grid;
    for (std::size_t i = 0; i < 3; ++i) {
        const NrrdAxisInfo& axis = nrrd.axis[axes[i]];
        grid.size[i] = static_cast<std::int64_t>(axis.size);
        grid.centering[i] = axis.size == 1 ? Centering::cell : centering_of(axis);
    }
    const bool directed = std::any_of(axes.begin(), axes.end(),
                                      [&](unsigned axis) { return has_direction(nrrd, axis); });
    if (directed) {
        set_steps_by_directions(file, nrrd, axes, grid);
    } else {
        if (has_spacings) expect_spacings(file, nrrd, axes);
        set_steps_by_spacings(nrrd, axes, grid);
    }
    if ((nrrd.spaceDim == 3 || nrrd.spaceDim == 4) && !std::isnan(nrrd.spaceOrigin[0])) {
        grid.origin = {nrrd.spaceOrigin[0], nrrd.spaceOrigin[1], nrrd.spaceOrigin[2]};
    }
    unite_units(file, grid, nrrd_units(nrrd, axes, directed));
    turn_to_lps(grid, axes_of(nrrd.space));
    check_grid(file, grid, {"space directions", "space origin"});
    return grid;
}

// Returns the axes of the data. Those that do not span the grid get the index that is read: the
// request's time on an axis of kind `time`, its channel on another. Throws Error.
std::vector<StoredAxis> nrrd_axes(const std::string& file, const Nrrd& nrrd,
                                  const VolumeRequest& request) {
    const std::vector<unsigned> spanning = volume_axes(file, nrrd);
    std::vector<StoredAxis> axes(nrrd.dim);
    int channels = 0, times = 0;
    for (unsigned i = 0; i < nrrd.dim; ++i) {
        axes[i].size = static_cast<std::int64_t>(nrrd.axis[i].size);
        if (axes[i].size == 1 || std::ranges::find(spanning, i) != spanning.end()) continue;
        const bool time = is_time(nrrd, i);
        if (++(time ? times : channels) > 1)
            fail("{}: dimension: found several axes of {}s, expected one", file,
                 time ? "time" : "channel");
        axes[i] = taken_axis(file, time ? "time" : "channel", time ? request.time : request.channel,
                             axes[i].size);
    }
    if (channels == 0) taken_axis(file, "channel", request.channel, 1);
    if (times == 0) taken_axis(file, "time", request.time, 1);
    return axes;
}

// The value of the field `data file` of a NRRD header: one file, a list ("LIST", then the names,
// one a line, up to the end of the header file), or a pattern ("slice%03d.raw MIN MAX STEP").
struct NrrdDataFiles {
    std::vector<std::string> names;
    // How many axes, counted from the fastest, one file holds, if the field says it.
    std::optional<std::size_t> axes_each;
};

// Parses `data file`. `path`, `line`: for messages; `following`: the header after it. Throws Error.
NrrdDataFiles nrrd_data_files(const std::string& path, int line, const std::string& value,
                              const std::string& following) {
    const std::vector<std::string> words = words_of(value);
    const auto wrong = [&](const std::string& expected) {
        return Error(fmt::format("{}: line {}: data file: found '{}', expected {}", path, line,
                                 value.substr(0, 80), expected));
    };
    const auto number = [&](std::size_t word) {
        return word < words.size() ? whole_number(words[word]) : std::nullopt;
    };
    NrrdDataFiles files;
    const auto set_axes = [&](std::size_t word) {
        if (words.size() <= word) return;
        const auto axes = number(word);
        if (!axes || *axes < 1 || *axes > NRRD_DIM_MAX) throw wrong("a number of axes in one file");
        files.axes_each = static_cast<std::size_t>(*axes);
    };
    if (!words.empty() && words[0] == "LIST") {
        if (words.size() > 2) throw wrong("LIST, and the number of axes in one file");
        set_axes(1);
        std::istringstream lines(following);
        for (std::string name; std::getline(lines, name);) {
            if (!name.empty() && name.back() == '\r') name.pop_back();
            if (!name.empty()) files.names.push_back(name);
        }
        if (files.names.empty())
            fail("{}: line {}: data file: found no names after LIST, expected one a line", path,
                 line);
    } else if (value.find('%') != std::string::npos) {
        const auto from = number(1), to = number(2), step = number(3);
        const auto name = words.empty() ? std::nullopt : file_pattern(words[0]);
        if (!name || !from || !to || !step || words.size() > 5)
            throw wrong("a name with one %d or %03d in it, and first, last and step of its number");
        set_axes(4);
        const auto names = names_of(*name, *from, *to, *step);
        if (!names)
            throw wrong(fmt::format("a step from {} to {}, and at most {} files", *from, *to,
                                    most_pattern_files));
        files.names = *names;
    } else {
        if (value.empty() || value == "-" || value.starts_with("SKIPLIST"))
            fail("{}: data file: found '{}', expected a file name", path, value);
        files.names = {value};
    }
    return files;
}

constexpr std::size_t most_header_bytes = std::size_t{1} << 20;
// Most bytes of a line with a field: teem prints wrong lines into buffers of some 1000 bytes.
constexpr std::size_t line_limit = 512;

// A header, cut into the lines that teem interprets and what lamina reads itself.
struct HeaderText {
    std::string text;  // magic and fields, without `data file` and remarks
    std::optional<NrrdDataFiles> data_files;
    std::set<std::string> fields;  // names of all fields, lower case
    // Key/value pairs of 3D Slicer's segmentations ("Segment0_Name:=liver"), and lamina's own.
    std::map<std::string, std::string> keys;
    std::int64_t length = 0;  // bytes up to and including the empty line
    bool ended = false;       // the header ends with an empty line, not with the file
};

std::string read_beginning(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail("{}: cannot read: permission denied", path.string());
    std::error_code error;
    const std::uintmax_t length = std::filesystem::file_size(path, error);
    if (error) fail("{}: cannot read: {}", path.string(), error.message());
    std::string bytes(std::min<std::uintmax_t>(length, most_header_bytes), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

bool has_magic(const std::string& line) {
    return line == "NRRD00.01" ||
           (line.size() == 8 && line.starts_with("NRRD000") && line[7] >= '1' && line[7] <= '6');
}

struct Field {
    std::string name;  // lower case
    std::string value;
};

// Tells if a line says nothing about the samples: a comment, a key/value pair, or `content`. teem
// does not get such lines: it keeps them in lists and takes minutes for a megabyte of them.
bool is_remark(const std::string& line) {
    const auto colon = line.find(':');
    return line[0] == '#' || line.starts_with("content:") ||
           (colon != std::string::npos && line.substr(colon, 2) == ":=");
}

// Returns the field of a `name: value` line; nothing if the line is a comment or a key/value pair.
std::optional<Field> field_of(const std::string& line) {
    const auto colon = line.find(':');
    if (colon == std::string::npos || is_remark(line)) return {};
    return Field{lower_case(without_blanks(line.substr(0, colon))),
                 without_blanks(line.substr(colon + 1))};
}

[[noreturn]] void fail_at(const std::string& path, int line, const Field& field,
                          const std::string& expected) {
    fail("{}: line {}: {}: found '{}', expected {}", path, line, field.name,
         field.value.substr(0, 80), expected);
}

// Checks the sizes: teem would read "8.9" as 8, and -8 or 2^64 as a missing field.
void check_sizes(const std::string& path, int line, const Field& field) {
    std::uint64_t samples = 1;
    bool overflow = false;
    for (const std::string& word : words_of(field.value)) {
        const bool digits = word.find_first_not_of("0123456789") == std::string::npos;
        if (!digits || word.size() > 18 || std::stoull(word) == 0)
            fail_at(path, line, field, "whole numbers from 1 to 10^18");
        overflow |= __builtin_mul_overflow(samples, std::stoull(word), &samples);
    }
    if (overflow || samples > (std::uint64_t{1} << 62))
        fail_at(path, line, field, "at most 2^62 samples in all");
}

// Checks the spacings, because teem's messages name neither field nor number. NaN passes: the axis
// has no spacing, or its mins and maxs give it (volume_files/volume_formats.h).
void check_spacings(const std::string& path, int line, const Field& field) {
    for (const std::string& word : words_of(field.value)) {
        const char* const start = word.c_str();
        char* end = nullptr;
        const double spacing = std::strtod(start, &end);
        if (end == start || *end != '\0' || spacing <= 0 || std::isinf(spacing))
            fail_at(path, line, field, "finite numbers above 0");
    }
}

// Checks a field whose value is a single number, and passes others. teem would take the number
// modulo 2^32, ignore what follows it, and treat what it does not understand as missing.
void check_number(const std::string& path, int line, const Field& field) {
    struct Limits {
        std::set<std::string> names;
        std::int64_t least, most;
        const char* expected;
    };
    constexpr std::int64_t most = std::int64_t{1} << 62;
    static const std::array limits{
        Limits{{"dimension"}, 1, NRRD_DIM_MAX, "3"},
        Limits{{"line skip", "lineskip"}, 0, INT32_MAX, "a whole number from 0 to 2147483647"},
        Limits{{"byte skip", "byteskip"}, -most, most, "a whole number from -2^62 to 2^62"}};
    const auto limit = std::ranges::find_if(
        limits, [&](const Limits& one) { return one.names.contains(field.name); });
    if (limit == limits.end()) return;
    const auto number = whole_number(field.value);
    if (!number || *number < limit->least || *number > limit->most)
        fail_at(path, line, field, limit->expected);
}

// Splits the header in `bytes`. Throws Error if a line is wrong or the header does not end.
HeaderText split_header(const std::string& path, const std::string& bytes) {
    HeaderText header;
    std::size_t position = 0;
    for (int number = 1; position < bytes.size(); ++number) {
        const auto end = std::min(bytes.find('\n', position), bytes.size());
        std::string line = bytes.substr(position, end - position);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        position = std::min(end + 1, bytes.size());
        if (number == 1 && !has_magic(line))
            fail("{}: not a NRRD file (no NRRD magic at its start)", path);
        if (line.empty()) {
            header.ended = true;
            break;
        }
        const bool binary = std::any_of(line.begin(), line.end(),
                                        [](unsigned char c) { return c < ' ' && c != '\t'; });
        if (binary) fail("{}: line {} of the NRRD header holds binary bytes", path, number);
        const auto field = field_of(line);
        const bool has_key = line.starts_with("Segment") || line.starts_with(nrrd_lookup_key);
        if (const auto mark = line.find(":="); has_key && mark < line.size())
            header.keys.emplace(line.substr(0, mark), line.substr(mark + 2));
        if (field) {
            header.fields.insert(field->name);
            if (field->name == "sizes") check_sizes(path, number, *field);
            if (field->name == "spacings") check_spacings(path, number, *field);
            check_number(path, number, *field);
        }
        if (field && (field->name == "data file" || field->name == "datafile")) {
            if (header.data_files) fail("{}: line {}: second 'data file' field", path, number);
            header.data_files = nrrd_data_files(path, number, field->value, bytes.substr(position));
            if (field->value.starts_with("LIST")) break;  // the rest are names
        } else if (number == 1 || !is_remark(line)) {
            if (line.size() > line_limit) {
                fail("{}: line {}: found {} bytes, '{}...', expected at most {}", path, number,
                     line.size(), line.substr(0, 20), line_limit);
            }
            header.text += line + "\n";
        }
    }
    header.length = static_cast<std::int64_t>(position);
    if (!header.ended && position == most_header_bytes) {
        fail("{}: the NRRD header does not end within {} bytes", path, most_header_bytes);
    }
    if (header.text.empty()) fail("{}: not a NRRD file (it is empty)", path);
    if (!header.ended && !header.data_files) {
        fail("{}: the NRRD header ends without an empty line, and names no data file", path);
    }
    return header;
}

// Returns the innermost of teem's stacked messages ("[nrrd] function: message") on one line, after
// the one before it if that says "trouble parsing".
std::string teem_message() {
    const std::unique_ptr<char, decltype(&std::free)> stack(biffGetDone(NRRD), &std::free);
    std::vector<std::string> messages;
    const std::string text = stack ? stack.get() : "";
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        std::string line = text.substr(at, end - at);
        if (line.starts_with("[nrrd] ")) line.erase(0, 7);
        if (const auto colon = line.find(':'); colon != std::string::npos) line.erase(0, colon + 1);
        if (line = without_blanks(line); !line.empty()) messages.push_back(line);
        at = end + 1;
    }
    if (messages.empty()) return "teem gives no reason";
    const std::size_t last = messages.size() - 1;
    const bool outer = last > 0 && messages[last - 1].starts_with("trouble parsing");
    return one_line(outer ? messages[last - 1] + ": " + messages[last] : messages[last]);
}

ValueType type_of_nrrd(const std::string& path, int type) {
    static_assert(nrrdTypeDouble - nrrdTypeChar == std::size(value_types) - 1);  // teem's order
    if (type >= nrrdTypeChar && type <= nrrdTypeDouble) return value_types[type - nrrdTypeChar];
    fail("{}: type: found '{}', expected a type of numbers, such as uint8 or float", path,
         airEnumStr(nrrdType, type));
}

DataEncoding encoding_of(const std::string& path, const ::NrrdEncoding* encoding) {
    if (encoding == nrrdEncodingRaw) return DataEncoding::raw;
    if (encoding == nrrdEncodingAscii) return DataEncoding::ascii;
    if (encoding == nrrdEncodingHex) return DataEncoding::hex;
    if (encoding == nrrdEncodingGzip) return DataEncoding::gzip;
    if (encoding == nrrdEncodingBzip2) return DataEncoding::bzip2;
    fail("{}: encoding: found '{}', expected raw, gzip, bzip2, ascii or hex", path, encoding->name);
}

struct NrrdHeader {
    Grid grid;
    StoredData data;
    bool is_colour = false;
    double first_time = 0, time_step = NAN;  // of the axis of times; NaN: not known
    std::string time_unit;
    std::string sample_unit;
    bool is_field = false;        // says that its samples are no labels
    std::string labels_by{};      // what says that samples are labels, for a message; else empty
    std::vector<Label> labels{};  // of a segmentation
};

// Completes what open_stored() has listed.
void fill_nrrd_contents(const NrrdHeader& header, VolumeContents& contents) {
    contents.is_colour = header.is_colour;
    std::vector<std::string>& times = contents.times;
    for (std::size_t i = 0; i < times.size() && !std::isnan(header.time_step); ++i) {
        times[i] =
            fmt::format("{:.6g} {}", header.first_time + static_cast<double>(i) * header.time_step,
                        header.time_unit);
    }
}

// Returns "r g b", display values from 0 to 1, in linear light; nothing if it is none.
std::optional<glm::dvec3> segment_color(const std::string& text) {
    glm::dvec3 color;
    std::istringstream words(text);
    for (int channel = 0; channel < 3; ++channel) {
        double stored = -1;
        if (!(words >> stored) || !(stored >= 0 && stored <= 1)) return {};
        color[channel] = linear_from_srgb(stored);
    }
    return color;
}

// Returns the opacity of a segment, which lamina writes if it is not 1; nothing if it is none.
std::optional<double> segment_opacity(const std::string& text) {
    double opacity = -1;
    std::istringstream(text) >> opacity;
    return opacity >= 0 && opacity <= 1 ? std::optional(opacity) : std::nullopt;
}

// Returns the number of a label in canonical digits; nothing if it is none.
std::optional<std::string> label_number(const std::string& digits) {
    if (const auto number = whole_number(digits)) return std::to_string(*number);
    if (const auto number = number_in<std::uint64_t>(digits)) return std::to_string(*number);
    return {};
}

// Takes the labels of a segmentation of 3D Slicer in the layer (channel) that is read, and what
// they mean (https://slicer.readthedocs.io, "Segmentations", "Segmentation file format"); or
// lamina's own key, which a saved volume of labels has.
void take_label_keys(const std::map<std::string, std::string>& keys, const VolumeRequest& request,
                     NrrdHeader& header) {
    constexpr int most_named = 32;
    std::string names;
    int count = 0;
    const auto text = [&](const char* key) {
        const auto found = keys.find(fmt::format("Segment{}_{}", count, key));
        return found == keys.end() ? std::string() : one_line(found->second);
    };
    const auto shown = [](const std::string& value) {
        return value.empty() ? "?" : value.substr(0, 40);
    };
    for (; keys.contains(fmt::format("Segment{}_ID", count)); ++count) {
        const std::string layer = text("Layer").empty() ? "0" : text("Layer");
        const auto number = label_number(text("LabelValue"));
        if (number && layer == std::to_string(request.channel.value_or(0))) {
            header.labels.push_back({0, *number, text("Name"), segment_color(text("Color"))});
            if (const auto opacity = segment_opacity(text("Opacity")))
                header.labels.back().opacity = *opacity;
        }
        if (count >= most_named) continue;
        names += fmt::format("{}{} is \"{}\"", count == 0 ? "" : ", ", shown(text("LabelValue")),
                             shown(text("Name")));
        if (layer != "0") names += fmt::format(" (channel {})", shown(layer));
    }
    const auto own = keys.find(nrrd_lookup_key);
    if (count > 0) {
        header.labels_by =
            fmt::format("the list of segments ({}{})", names, count > most_named ? ", ..." : "");
    } else if (own != keys.end() && own->second == "nearest") {
        header.labels_by = fmt::format("its key {}", nrrd_lookup_key);
    }
    header.is_field = own != keys.end() && own->second == "linear";
}

// Makes two axes three, the last of one sample at a right angle to the others.
void add_third_axis(const std::string& file, Nrrd& nrrd) {
    NrrdAxisInfo& third = nrrd.axis[2];
    const bool is_first_shorter = spacing_of(nrrd.axis[0]) <= spacing_of(nrrd.axis[1]);
    const NrrdAxisInfo& shorter = nrrd.axis[is_first_shorter ? 0 : 1];
    nrrd.dim = 3;
    third.size = 1;
    third.units = airStrdup(shorter.units);
    third.spacing = spacing_of(shorter);
    if (!has_direction(nrrd, 0) && !has_direction(nrrd, 1)) return;
    third.spacing = NAN;
    for (const unsigned axis : {0U, 1U})
        if (!has_direction(nrrd, axis))
            fail("{}: space directions: axis {} has none, expected two directions", file, axis);
    if (nrrd.spaceDim == 2) {
        nrrd.spaceDim = 3;
        nrrd.axis[0].spaceDirection[2] = nrrd.axis[1].spaceDirection[2] = nrrd.spaceOrigin[2] = 0;
        nrrd.spaceUnits[2] = airStrdup(nrrd.spaceUnits[0]);
    }
    const auto direction = [&](unsigned axis) {
        const double* const of = nrrd.axis[axis].spaceDirection;
        return glm::dvec3(of[0], of[1], of[2]);
    };
    const glm::dvec3 across = slice_step(direction(0), direction(1));
    for (int i = 0; i < 3; ++i) third.spaceDirection[i] = across[i];
}

NrrdHeader read_nrrd_header(const std::filesystem::path& path, const VolumeRequest& request) {
    const std::string name = path.string();
    if (const char* const reason = why_not_regular(path)) fail("{}: {}", name, reason);
    const HeaderText text = split_header(name, read_beginning(path));

    const std::unique_ptr<Nrrd, decltype(&nrrdNuke)> nrrd(nrrdNew(), &nrrdNuke);
    const std::unique_ptr<NrrdIoState, decltype(&nrrdIoStateNix)> state(nrrdIoStateNew(),
                                                                        &nrrdIoStateNix);
    if (!nrrd || !state) throw std::bad_alloc();
    nrrdStateVerboseIO = 0;
    nrrdIoStateSet(state.get(), nrrdIoStateSkipData, 1);
    const bool bad = nrrdStringRead(nrrd.get(), text.text.c_str(), state.get()) != 0;
    const std::string reason = bad ? teem_message() : "";
    if (bad && reason.starts_with("trouble parsing")) fail("{}: bad NRRD header: {}", name, reason);
    for (const char* const field : {"type", "dimension", "sizes", "encoding"})
        if (!text.fields.contains(field))
            fail("{}: the NRRD header has no '{}' field", name, field);
    if (bad) fail("{}: bad NRRD header: {}", name, reason);

    if (nrrd->dim == 2) add_third_axis(name, *nrrd);
    NrrdHeader header;
    header.grid = nrrd_grid(name, *nrrd, text.fields.contains("spacings"));
    StoredData& data = header.data;
    data.path = path;
    data.type = type_of_nrrd(name, nrrd->type);
    data.axes = nrrd_axes(name, *nrrd, request);
    data.encoding = encoding_of(name, state->encoding);
    set_byte_order(data, state->endian == airEndianBig);
    if (text.data_files) {
        set_data_files(data, text.data_files->names, text.data_files->axes_each, "data file");
    } else {
        data.files = {path};
        data.offset = text.length;
    }
    for (unsigned i = 0; i < nrrd->dim; ++i) {
        const NrrdAxisInfo& axis = nrrd->axis[i];
        header.is_colour |= axis.kind == nrrdKindRGBColor || axis.kind == nrrdKindRGBAColor ||
                            axis.kind == nrrdKind3Color || axis.kind == nrrdKind4Color;
        if (!is_time(*nrrd, i)) continue;
        const bool is_directed = nrrd->spaceDim == 4 && has_direction(*nrrd, i);
        const double first = is_directed ? nrrd->spaceOrigin[3] : axis.min;
        header.first_time = std::isnan(first) ? 0 : first;
        header.time_step = is_directed ? axis.spaceDirection[3] : known_spacing_of(axis);
        const char* const unit = is_directed ? nrrd->spaceUnits[3] : axis.units;
        header.time_unit = unit == nullptr ? "" : unit_word(unit);
    }
    if (nrrd->sampleUnits != nullptr) header.sample_unit = unit_word(nrrd->sampleUnits);
    take_label_keys(text.keys, request, header);
    if (!std::isnan(nrrd->oldMin) || !std::isnan(nrrd->oldMax)) {
        say("{}: old min, old max: found {} and {}, the range before the samples were "
            "quantized: the samples are drawn as they are stored",
            name, nrrd->oldMin, nrrd->oldMax);
    }
    data.line_skip = state->lineSkip;
    data.byte_skip = state->byteSkip;
    return header;
}

}  // namespace

bool is_nrrd(const std::filesystem::path& path) {
    return file_beginning(path, 5).starts_with("NRRD0");
}

Volume open_nrrd(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use) {
    NrrdHeader header = read_nrrd_header(path, request);
    if (!header.labels_by.empty())
        take_for_labels(path.string(), header.labels_by, use, header.grid);
    VolumeUse told = use;
    if (!use.lookup && header.is_field) told.lookup = VolumeLookup::linear;
    Volume volume = open_stored(header.grid, header.data, told);
    if (!header.labels.empty()) volume = with_descriptions(volume, std::move(header.labels));
    if (use.contents != nullptr) fill_nrrd_contents(header, *use.contents);
    return volume.measuring({"", header.sample_unit});
}

std::vector<std::filesystem::path> files_of_nrrd(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files{path};
    for (const auto& data : read_nrrd_header(path, {}).data.files)
        if (data != path) files.push_back(data);
    return files;
}

}  // namespace lamina
