// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nifti_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/file_reader.h"
#include "volume_files/grid_check.h"
#include "volume_files/gzip_reader.h"
#include "volume_files/plain_grid.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t header1_bytes = 348, header2_bytes = 540;

// Numbers at byte offsets of a header of either byte order.
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

// Offsets are those of nifti1.h, struct nifti_1_header.
void read_fields_1(const HeaderBytes& bytes, NiftiHeader& header) {
    bytes.fill<std::int16_t>(header.dim, 40);
    header.datatype = bytes.at<std::int16_t>(70);
    bytes.fill<float>(header.pixdim, 76);
    const auto offset = static_cast<double>(bytes.at<float>(108));
    header.data_offset = offset >= 0 && offset < 1e15 ? static_cast<std::int64_t>(offset) : -1;
    header.slope = static_cast<double>(bytes.at<float>(112));
    header.intercept = static_cast<double>(bytes.at<float>(116));
    header.qform_code = bytes.at<std::int16_t>(252);
    header.sform_code = bytes.at<std::int16_t>(254);
    bytes.fill<float>(header.quaternion, 256);
    bytes.fill<float>(header.offset, 268);
    for (std::size_t row = 0; row < 3; ++row) bytes.fill<float>(header.srow[row], 280 + 16 * row);
}

// nifti2.h, struct nifti_2_header.
void read_fields_2(const HeaderBytes& bytes, NiftiHeader& header) {
    header.datatype = bytes.at<std::int16_t>(12);
    bytes.fill<std::int64_t>(header.dim, 16);
    bytes.fill<double>(header.pixdim, 104);
    header.data_offset = bytes.at<std::int64_t>(168);
    header.slope = bytes.at<double>(176);
    header.intercept = bytes.at<double>(184);
    header.qform_code = bytes.at<std::int32_t>(344);
    header.sform_code = bytes.at<std::int32_t>(348);
    bytes.fill<double>(header.quaternion, 352);
    bytes.fill<double>(header.offset, 376);
    for (std::size_t row = 0; row < 3; ++row) bytes.fill<double>(header.srow[row], 400 + 32 * row);
}

// Up to so many of the file's first bytes, decompressed where it is packed.
std::string first_bytes(const Path& path, bool packed, std::size_t count) {
    if (!packed) return file_beginning(path, count);
    std::string bytes(count, '\0');
    GzipReader(open_to_read(path), path.string()).read(bytes.data(), count);
    return bytes;
}

// "a.hdr" and "a.hdr.gz" go with "a.img" and "a.img.gz".
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
    header.data_path = magic == single ? path : image_path(path);
    const auto least = static_cast<std::int64_t>(second ? header2_bytes : header1_bytes);
    if (header.data_offset < (magic == single ? least : 0)) {
        fail("{}: vox_offset: found {}, expected at least {}, the header's length", path.string(),
             header.data_offset, least);
    }
    return header;
}

// The columns of the rotation of a quaternion whose real part is not stored (nifti1.h, "Method 2").
std::array<glm::dvec3, 3> rotation_of(const std::array<double, 3>& quaternion) {
    double b = quaternion[0], c = quaternion[1], d = quaternion[2];
    double a = 1 - (b * b + c * c + d * d);
    if (a < 1e-7) {  // a half turn, written in single precision
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

void place_by_sform(const NiftiHeader& header, Grid& grid) {
    for (int row = 0; row < 3; ++row) {
        const auto& values = header.srow[static_cast<std::size_t>(row)];
        for (std::size_t axis = 0; axis < 3; ++axis) grid.step[axis][row] = values[axis];
        grid.origin[row] = values[3];
    }
}

void place_by_qform(const NiftiHeader& header, Grid& grid) {
    const auto columns = rotation_of(header.quaternion);
    const double handedness = header.pixdim[0] < 0 ? -1 : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = header.pixdim[axis + 1] * (axis == 2 ? handedness : 1);
        grid.step[axis] = length * columns[axis];
        grid.origin[static_cast<int>(axis)] = header.offset[axis];
    }
}

}  // namespace

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

Grid nifti_grid(const NiftiHeader& header) {
    Grid grid = plain_grid({header.dim[1], header.dim[2], header.dim[3]});
    const std::string file = header.path.string();
    if (header.sform_code > 0) {
        place_by_sform(header, grid);
        check_grid(file, grid, {"sform (srow_x, srow_y, srow_z)", "srow"});
        turn_to_lps(grid, WorldAxes::right_anterior_superior);
    } else if (header.qform_code > 0) {
        place_by_qform(header, grid);
        check_grid(file, grid, {"qform", "qoffset"});
        turn_to_lps(grid, WorldAxes::right_anterior_superior);
    } else {
        for (std::size_t axis = 0; axis < 3; ++axis)
            grid.step[axis] *= std::abs(header.pixdim[axis + 1]);
        check_grid(file, grid, {"pixdim", "pixdim"});
    }
    return grid;
}

}  // namespace lamina
