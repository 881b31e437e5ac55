// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// The fields of a NIfTI-1 or NIfTI-2 header that place and scale the samples
// (https://nifti.nimh.nih.gov/nifti-1, nifti1.h; nifti2.h).
struct NiftiHeader {
    std::filesystem::path path;       // the header's
    std::filesystem::path data_path;  // the file of the samples: the same for magic "n+1"
    bool packed = false;              // both are gzip files
    bool big_endian = false;
    std::array<std::int64_t, 8> dim{};  // dim[0]: number of dimensions; others: their sizes
    std::array<double, 8> pixdim{};
    bool is_slice = false;  // of two axes, and dim says three; nifti1.h leaves pixdim[3] open
    std::int64_t datatype = 0;
    std::int64_t data_offset = 0;
    double slope = 0, intercept = 0;
    std::int64_t qform_code = 0, sform_code = 0;
    std::int64_t units = 0, intent = 0;  // xyzt_units, intent_code
    double first_time = 0;               // toffset
    std::array<double, 3> quaternion{}, offset{};
    std::array<std::array<double, 4>, 3> srow{};
};

constexpr std::size_t header1_bytes = 348, header2_bytes = 540;

// Reads numbers at byte offsets of a header of either byte order.
class HeaderBytes {
  public:
    HeaderBytes(std::string bytes, bool swap) : bytes_(std::move(bytes)), swap_(swap) {}

    template <typename T>
    T at(std::size_t offset) const {
        char word[sizeof(T)];
        std::memcpy(word, bytes_.data() + offset, sizeof(T));
        if (swap_) std::reverse(word, word + sizeof(T));
        T value;
        std::memcpy(&value, word, sizeof(T));
        return value;
    }

    template <typename T, typename To, std::size_t count>
    void fill(std::array<To, count>& values, std::size_t offset) const {
        for (std::size_t i = 0; i < count; ++i)
            values[i] = static_cast<To>(at<T>(offset + i * sizeof(T)));
    }

    std::string_view text(std::size_t offset, std::size_t count) const {
        return std::string_view(bytes_).substr(offset, count);
    }

  private:
    std::string bytes_;
    bool swap_;
};

// Reads the fields at the offsets of nifti1.h, struct nifti_1_header.
void read_fields_1(const HeaderBytes& bytes, NiftiHeader& header) {
    bytes.fill<std::int16_t>(header.dim, 40);
    header.intent = bytes.at<std::int16_t>(68);
    header.datatype = bytes.at<std::int16_t>(70);
    bytes.fill<float>(header.pixdim, 76);
    const auto offset = static_cast<double>(bytes.at<float>(108));
    header.data_offset = offset >= 0 && offset < 1e15 ? static_cast<std::int64_t>(offset) : -1;
    header.slope = static_cast<double>(bytes.at<float>(112));
    header.intercept = static_cast<double>(bytes.at<float>(116));
    header.units = bytes.at<std::uint8_t>(123);
    header.first_time = static_cast<double>(bytes.at<float>(136));
    header.qform_code = bytes.at<std::int16_t>(252);
    header.sform_code = bytes.at<std::int16_t>(254);
    bytes.fill<float>(header.quaternion, 256);
    bytes.fill<float>(header.offset, 268);
    for (std::size_t row = 0; row < 3; ++row) bytes.fill<float>(header.srow[row], 280 + 16 * row);
}

// Reads the fields at the offsets of nifti2.h, struct nifti_2_header.
void read_fields_2(const HeaderBytes& bytes, NiftiHeader& header) {
    header.datatype = bytes.at<std::int16_t>(12);
    bytes.fill<std::int64_t>(header.dim, 16);
    bytes.fill<double>(header.pixdim, 104);
    header.data_offset = bytes.at<std::int64_t>(168);
    header.slope = bytes.at<double>(176);
    header.intercept = bytes.at<double>(184);
    header.qform_code = bytes.at<std::int32_t>(344);
    header.sform_code = bytes.at<std::int32_t>(348);
    header.first_time = bytes.at<double>(216);
    header.units = bytes.at<std::int32_t>(500);
    header.intent = bytes.at<std::int32_t>(504);
    bytes.fill<double>(header.quaternion, 352);
    bytes.fill<double>(header.offset, 376);
    for (std::size_t row = 0; row < 3; ++row) bytes.fill<double>(header.srow[row], 400 + 32 * row);
}

// Returns up to `count` of the file's first bytes, decompressed if it is packed.
std::string first_bytes(const Path& path, bool packed, std::size_t count) {
    if (!packed) return file_beginning(path, count);
    std::string bytes(count, '\0');
    gzip_reader(open_to_read(path), path.string())->read(bytes.data(), count);
    return bytes;
}

// Returns the other file of a pair: "a.img" for "a.hdr", "a.img.gz" for "a.hdr.gz".
Path image_path(const Path& header) {
    std::string name = header.filename().string();
    const std::size_t at = name.rfind(".hdr");
    if (at == std::string::npos) {
        fail("{}: found the header of a pair of files, expected a name that ends in .hdr",
             header.string());
    }
    name.replace(at, 4, ".img");
    return header.parent_path() / name;
}

bool is_gzip(const Path& path) {
    return file_beginning(path, 2) == "\x1f\x8b";
}

// Returns the header in `bytes`, nothing if its magic is wrong. `second`: NIfTI-2. Throws Error.
std::optional<NiftiHeader> header_of(const Path& path, const HeaderBytes& bytes, bool second,
                                     bool big_endian) {
    const std::string_view magic = second ? bytes.text(4, 4) : bytes.text(344, 4);
    const char version = second ? '2' : '1';
    const std::string single = std::string("n+") + version + '\0';
    const std::string pair = std::string("ni") + version + '\0';
    if (magic != single && magic != pair) return {};
    NiftiHeader header;
    header.path = path;
    header.packed = is_gzip(path);
    header.big_endian = big_endian;
    if (second)
        read_fields_2(bytes, header);
    else
        read_fields_1(bytes, header);
    if (header.dim[0] == 2) {
        header.is_slice = true;
        header.dim[0] = 3;
        header.dim[3] = 1;
    }
    header.data_path = magic == single ? path : image_path(path);
    const auto least = static_cast<std::int64_t>(second ? header2_bytes : header1_bytes);
    if (header.data_offset < (magic == single ? least : 0)) {
        fail("{}: vox_offset: found {}, expected at least {}, the header's length", path.string(),
             header.data_offset, least);
    }
    return header;
}

// Returns the columns of a quaternion's rotation; no real part is stored (nifti1.h, "Method 2").
std::array<glm::dvec3, 3> rotation_of(const std::array<double, 3>& quaternion) {
    double b = quaternion[0], c = quaternion[1], d = quaternion[2];
    double a = 1 - (b * b + c * c + d * d);
    if (a < 1e-7) {  // a half turn, rounded to float32
        const double length = std::sqrt(b * b + c * c + d * d);
        b /= length;
        c /= length;
        d /= length;
        a = 0;
    } else {
        a = std::sqrt(a);
    }
    return {glm::dvec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)),
            glm::dvec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)),
            glm::dvec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b)};
}

// Returns |pixdim[i]|, 1 if it is 0, as nibabel does; a warning says it, because nifti1.h expects
// numbers above 0.
double voxel_length(const NiftiHeader& header, std::size_t i) {
    const double found = header.pixdim[i];
    const double length = found == 0 ? 1 : std::abs(found);
    if (!(found > 0) && length > 0) {
        say("{}: pixdim[{}]: found {}, expected a number above 0: {} is taken",
            header.path.string(), i, found, length);
    }
    return length;
}

// Returns the lengths of a voxel; a slice is as thick as its shorter side.
std::array<double, 3> voxel_lengths(const NiftiHeader& header) {
    const double x = voxel_length(header, 1), y = voxel_length(header, 2);
    return {x, y, header.is_slice ? std::min(x, y) : voxel_length(header, 3)};
}

void place_by_sform(const NiftiHeader& header, Grid& grid) {
    for (int row = 0; row < 3; ++row) {
        const auto& values = header.srow[static_cast<std::size_t>(row)];
        for (std::size_t axis = 0; axis < 3; ++axis) grid.step[axis][row] = values[axis];
        grid.origin[row] = values[3];
    }
    if (header.is_slice) grid.step[2] = slice_step(grid.step[0], grid.step[1]);
}

void place_by_qform(const NiftiHeader& header, Grid& grid) {
    double squares = 0;
    for (const double part : header.quaternion) squares += part * part;
    constexpr double most = 1.001;  // rounding of three float32 gives less than 1.000001
    if (!(squares <= most)) {
        fail("{}: quatern_b, _c, _d: found squares that add up to {}, expected at most 1",
             header.path.string(), squares);
    }
    const auto columns = rotation_of(header.quaternion);
    const double handedness = header.pixdim[0] < 0 ? -1 : 1;
    const auto lengths = voxel_lengths(header);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.step[axis] = lengths[axis] * (axis == 2 ? handedness : 1) * columns[axis];
        grid.origin[static_cast<int>(axis)] = header.offset[axis];
    }
}

// Returns nothing if the file holds no NIfTI header. Throws Error if it cannot be read.
std::optional<NiftiHeader> read_nifti_header(const Path& path) {
    const bool packed = is_gzip(path);
    const std::string start = first_bytes(path, packed, 4);
    if (start.size() < 4) return {};
    for (const bool swap : {false, true}) {
        const auto length = HeaderBytes(start, swap).at<std::int32_t>(0);
        const bool second = length == header2_bytes;
        if (length != header1_bytes && !second) continue;
        const std::string bytes = first_bytes(path, packed, second ? header2_bytes : header1_bytes);
        if (bytes.size() < static_cast<std::size_t>(length)) {
            fail("{}: truncated NIfTI header: found {} bytes, expected {}", path.string(),
                 bytes.size(), length);
        }
        const bool big = (std::endian::native == std::endian::big) != swap;
        return header_of(path, HeaderBytes(bytes, swap), second, big);
    }
    return {};
}

// Places the grid by the sform. Returns false, and warns, if that is bad and there is a qform.
bool is_placed_by_sform(const NiftiHeader& header, Grid& grid) {
    if (header.sform_code <= 0) return false;
    try {
        Grid placed = grid;
        place_by_sform(header, placed);
        check_grid(header.path.string(), placed, {"sform (srow_x, srow_y, srow_z)", "srow"});
        grid = placed;
        return true;
    } catch (const Error& error) {
        if (header.qform_code <= 0) throw;
        say("{}: the qform is taken", error.what());
        return false;
    }
}

// Returns the grid of the first three axes: placed by sform, else by qform, and turned to LPS; else
// samples lie pixdim apart from the origin on, in unnamed world axes. Throws Error.
Grid nifti_grid(const NiftiHeader& header) {
    Grid grid = plain_grid({header.dim[1], header.dim[2], header.dim[3]});
    constexpr const char* lengths[] = {"", "m", "mm", "um"};  // nifti1.h, NIFTI_UNITS_*
    if (const auto unit = static_cast<std::size_t>(header.units & 7); unit < std::size(lengths))
        grid.unit = lengths[unit];
    const bool by_sform = is_placed_by_sform(header, grid);
    if (!by_sform && header.qform_code > 0) {
        place_by_qform(header, grid);
        check_grid(header.path.string(), grid, {"qform", "qoffset"});
    }
    if (by_sform || header.qform_code > 0) {
        turn_to_lps(grid, WorldAxes::right_anterior_superior);
    } else {
        const auto spacing = voxel_lengths(header);
        for (std::size_t axis = 0; axis < 3; ++axis) grid.step[axis] *= spacing[axis];
        check_grid(header.path.string(), grid, {"pixdim", "pixdim"});
    }
    return grid;
}

struct NiftiType {
    std::int64_t code;  // nifti1.h, NIFTI_TYPE_*
    ValueType type;
    std::int64_t colors;  // samples of a voxel
};

constexpr NiftiType types[] = {
    {2, ValueType::uint8, 1},    {4, ValueType::int16, 1},     {8, ValueType::int32, 1},
    {16, ValueType::float32, 1}, {64, ValueType::float64, 1},  {128, ValueType::uint8, 3},
    {256, ValueType::int8, 1},   {512, ValueType::uint16, 1},  {768, ValueType::uint32, 1},
    {1024, ValueType::int64, 1}, {1280, ValueType::uint64, 1}, {2304, ValueType::uint8, 4}};

// Types that are not drawn.
constexpr struct {
    std::int64_t code;
    const char* name;
} other_types[] = {{1, "bits"},
                   {32, "complex numbers"},
                   {1536, "floats of 128 bits"},
                   {1792, "complex numbers"},
                   {2048, "complex numbers"}};

constexpr std::int64_t label_intent = 1002;  // nifti1.h, NIFTI_INTENT_LABEL

// Returns the header of a pair if the path is its other file, "a.img".
Path header_path(const Path& path) {
    std::string name = path.filename().string();
    const std::size_t at = name.rfind(".img");
    if (at == std::string::npos || (at + 4 != name.size() && name.substr(at + 4) != ".gz"))
        return path;
    return path.parent_path() / name.replace(at, 4, ".hdr");
}

NiftiHeader expected_header(const Path& path) {
    const Path file = header_path(path);
    if (file != path) expect_named_file(file, "header of " + path.string());
    const auto header = read_nifti_header(file);
    if (!header) {
        std::string start = file_beginning(file, 4);
        start.resize(4);
        for (const bool swap : {false, true}) {
            if (HeaderBytes(start, swap).at<std::int32_t>(0) != header1_bytes) continue;
            fail(
                "{}: found an ANALYZE 7.5 header, which does not say where left is, expected "
                "NIfTI: nibabel or FSL's fslchfiletype converts it",
                file.string());
        }
        fail("{}: no NIfTI header: expected 348 or 540 in its first 4 bytes, and its magic",
             file.string());
    }
    return *header;
}

NiftiType type_of(const NiftiHeader& header) {
    const auto* const found = std::ranges::find(types, header.datatype, &NiftiType::code);
    if (found == std::end(types)) {
        const auto other =
            std::ranges::find(other_types, header.datatype, [](auto& one) { return one.code; });
        fail(
            "{}: datatype: found {}{}, expected integers or floats of up to 64 bits, RGB or RGBA: "
            "nibabel converts it",
            header.path.string(), header.datatype,
            other == std::end(other_types) ? "" : fmt::format(" ({})", other->name));
    }
    return *found;
}

void check_dimensions(const NiftiHeader& header) {
    const std::string file = header.path.string();
    // nifti1.h leaves 3000 to 3099 to CIFTI (CIFTI-2, section 3).
    if (header.intent >= 3000 && header.intent < 3100) {
        fail(
            "{}: intent_code: found {}, a CIFTI file of surfaces and voxels, expected a volume: "
            "Connectome Workbench's wb_command -cifti-separate writes one",
            file, header.intent);
    }
    if (header.dim[0] < 3 || header.dim[0] > 7)
        fail("{}: dim[0]: found {}, expected 2 axes to 7", file, header.dim[0]);
    for (std::size_t i = 1; i <= static_cast<std::size_t>(header.dim[0]); ++i) {
        if (i > 5 && header.dim[i] != 1) {
            fail(
                "{}: dim[{}]: found {}, expected 1: axes beyond x, y, z, time and vector are not "
                "read",
                file, i, header.dim[i]);
        }
        constexpr std::int64_t most = std::int64_t{1} << 40;
        if (header.dim[i] < 1 || header.dim[i] > most)
            fail("{}: dim[{}]: found {}, expected a number from 1 to {}", file, i, header.dim[i],
                 most);
    }
}

std::vector<StoredAxis> axes_of(const NiftiHeader& header, std::int64_t colors,
                                const VolumeRequest& request) {
    const std::string file = header.path.string();
    const std::int64_t times = header.dim[0] > 3 ? header.dim[4] : 1;
    const std::int64_t vectors = header.dim[0] > 4 ? header.dim[5] : 1;
    if (colors > 1 && vectors > 1)
        fail("{}: dim[5]: found {} vectors of colours, expected 1", file, vectors);
    const StoredAxis channel =
        taken_axis(file, "channel", request.channel, std::max(colors, vectors));
    std::vector<StoredAxis> axes;
    if (colors > 1) axes.push_back(channel);
    for (std::size_t i = 1; i <= 3; ++i) axes.emplace_back(header.dim[i]);
    axes.push_back(taken_axis(file, "time", request.time, times));
    if (vectors > 1) axes.push_back(channel);
    return axes;
}

// Names the steps of the fourth axis in its unit, if the header says how far they are apart.
void name_nifti_times(const NiftiHeader& header, std::vector<std::string>& times) {
    constexpr const char* units[] = {"", "s", "ms", "us", "Hz", "ppm", "rad/s", ""};
    const std::string unit = units[header.units >> 3 & 7];  // NIFTI_UNITS_* / 8
    const double step = header.pixdim[4];
    for (std::size_t i = 0; i < times.size() && !unit.empty() && step > 0; ++i) {
        times[i] =
            fmt::format("{:.6g} {}", header.first_time + static_cast<double>(i) * step, unit);
    }
}

// Completes what open_stored() has listed.
void fill_nifti_contents(const NiftiHeader& header, std::int64_t colours,
                         VolumeContents& contents) {
    constexpr std::int64_t rgb_vector = 2003, rgba_vector = 2004;  // NIFTI_INTENT_*
    name_nifti_times(header, contents.times);
    contents.is_colour = colours > 1 || header.intent == rgb_vector || header.intent == rgba_vector;
}

// Sets scale and shift. A slope of 0 says that there is none (nifti1.h, "Data scaling"), and
// nibabel writes NaN for that.
void set_nifti_scale(const NiftiHeader& header, StoredData& data) {
    if (std::isnan(header.slope)) return;
    if (!std::isfinite(header.slope) || (header.slope != 0 && !std::isfinite(header.intercept))) {
        fail("{}: scl_slope, scl_inter: found {} and {}, expected finite numbers",
             header.path.string(), header.slope, header.intercept);
    }
    if (header.slope != 0) {
        data.scale = header.slope;
        data.shift = header.intercept;
    } else if (header.intercept != 0 && !std::isnan(header.intercept)) {
        say("{}: scl_inter: found {}, which scl_slope 0 says not to use", header.path.string(),
            header.intercept);
    }
}

}  // namespace

bool is_nifti(const Path& path) {
    try {
        return read_nifti_header(header_path(path)).has_value();
    } catch (const Error&) {
        return false;  // open_nifti() reports it for files with an extension of NIfTI
    }
}

Volume open_nifti(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    const NiftiHeader header = expected_header(path);
    check_dimensions(header);
    const NiftiType type = type_of(header);
    Grid grid = nifti_grid(header);
    if (header.intent == label_intent)
        take_for_labels(header.path.string(), "intent_code 1002", use, grid);
    expect_allowed(header.data_path);
    if (!std::filesystem::exists(header.data_path)) {
        fail("{}: data file of {}: no such file", header.data_path.string(), header.path.string());
    }
    StoredData data;
    data.path = header.path;
    data.type = type.type;
    data.axes = axes_of(header, type.colors, request);
    data.encoding = header.packed ? DataEncoding::gzip : DataEncoding::raw;
    set_byte_order(data, header.big_endian);
    data.files = {header.data_path};
    data.byte_skip = header.data_offset;
    if (type.colors == 1) set_nifti_scale(header, data);
    const Volume volume = open_stored(grid, data, use);
    if (use.contents != nullptr) fill_nifti_contents(header, type.colors, *use.contents);
    return volume;
}

std::vector<Path> files_of_nifti(const Path& path) {
    const NiftiHeader header = expected_header(path);
    if (header.path == header.data_path) return {header.path};
    return {header.path, header.data_path};
}

}  // namespace lamina
