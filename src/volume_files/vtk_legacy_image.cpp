// SPDX-License-Identifier: Apache-2.0
// Legacy VTK files with structured points or a rectilinear grid ("VTK File Formats", and
// vtkStructuredPointsReader.cxx, vtkRectilinearGridReader.cxx).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/vtk_tokens.h"
#include "volume_files/vtk_image.h"

namespace lamina {
namespace {

constexpr std::size_t dataset_bytes = 4096;  // of the beginning, which names the dataset

// An array and the place of its values in the file.
struct LegacyArray {
    VtkImageArray array;
    VtkArrayLine line;
    VtkTokens at;
};

// Returns values in their own type. Bits become bytes; colours as text, fractions, do, too.
VtkXmlValues legacy_values(const LegacyArray& array, std::int64_t count, const std::string& what) {
    VtkTokens tokens = array.at;
    VtkXmlValues values{array.line.type.value, {}};
    const std::string name = "'" + array.line.name + "'";
    const auto size = static_cast<std::size_t>(count);
    if (array.line.type.kind == VtkType::Kind::bit && tokens.is_binary()) {
        const char* const bits = tokens.take((count + 7) / 8, 1, what);
        values.bytes = ByteBuffer(size);
        for (std::size_t i = 0; i < size; ++i)
            values.bytes.data()[i] = static_cast<char>(bits[i / 8] >> (7 - i % 8) & 1);
    } else if (tokens.is_binary()) {
        const std::size_t word = bytes_of(values.type);
        const char* const bytes = tokens.take(count, word, what);
        values.bytes = ByteBuffer(size * word);
        std::memcpy(values.bytes.data(), bytes, size * word);
        if (std::endian::native == std::endian::little)
            swap_bytes(values.bytes.data(), count, word);
    } else {
        with_type(values.type, [&](auto zero) {
            using T = decltype(zero);
            std::vector<T> numbers;
            if (array.line.colours) {
                for (const double one : tokens.values<double>(ValueType::float64, count, name))
                    numbers.push_back(static_cast<T>(std::lround(255 * std::clamp(one, 0.0, 1.0))));
            } else {
                numbers = tokens.values<T>(values.type, count, name);
            }
            values.bytes = ByteBuffer(size * sizeof(T));
            std::memcpy(values.bytes.data(), numbers.data(), size * sizeof(T));
        });
    }
    return values;
}

class LegacyImage {
  public:
    LegacyImage(const std::string& file, std::string_view text) : tokens_(file, text) {
        const VtkHeader header = read_vtk_header(tokens_);
        if (header.dataset != "structured_points" && header.dataset != "rectilinear_grid")
            refuse_vtk_type(file, header.dataset);
        rectilinear_ = header.dataset == "rectilinear_grid";
        tokens_.set_binary(header.binary);
        for (std::string word = tokens_.keyword(); !word.empty(); word = tokens_.keyword())
            read_section(word);
        if (!has_size_) fail("{}: no DIMENSIONS in it", file);
        for (std::size_t axis = 0; axis < 3 && rectilinear_; ++axis) {
            const std::int64_t expected = part_.extent.last[axis] - part_.extent.first[axis] + 1;
            if (std::ssize(part_.coordinates[axis]) != expected)
                fail("{}: {}_COORDINATES: found {}, expected {}, as DIMENSIONS says", file,
                     "XYZ"[axis], part_.coordinates[axis].size(), expected);
        }
        for (const bool of_cells : {false, true})
            for (const LegacyArray& one : arrays_)
                if (one.array.of_cells == of_cells) part_.arrays.push_back(one.array);
        part_.values = [this](const VtkImageArray& array, std::int64_t tuples,
                              const std::string& what) {
            const auto found = std::ranges::find_if(arrays_, [&](const LegacyArray& one) {
                return one.array.name == array.name && one.array.of_cells == array.of_cells;
            });
            if (found->line.tuples != tuples) {
                fail("{}: found {} values, expected {}, one for each {}", what, found->line.tuples,
                     tuples, array.of_cells ? "cell" : "point");
            }
            return legacy_values(*found, tokens_.product(tuples, array.components, what), what);
        };
    }

    // The part refers to this object.
    const VtkImagePart& part() const { return part_; }
    std::optional<VtkGeometry> geometry() const {
        return rectilinear_ ? std::nullopt : std::optional(geometry_);
    }

  private:
    void read_section(const std::string& word) {
        const auto take = [&](const VtkArrayLine& line) { read_array(line); };
        if (word == "dimensions") {
            has_size_ = true;
            for (std::int64_t& last : part_.extent.last) {
                last = tokens_.count("DIMENSIONS") - 1;
                if (last < 0 || last > std::int64_t{1} << 40)
                    fail("{}: DIMENSIONS: expected numbers from 1 to 2^40", tokens_.where());
            }
        } else if (word == "spacing" || word == "aspect_ratio") {
            for (double& number : geometry_.spacing) number = tokens_.number("SPACING");
        } else if (word == "origin") {
            for (double& number : geometry_.origin) number = tokens_.number("ORIGIN");
        } else if (word.size() == 13 && word.ends_with("_coordinates") && word[0] >= 'x' &&
                   word[0] <= 'z') {
            const std::int64_t count = tokens_.count("COORDINATES");
            const VtkType type = tokens_.type();
            if (type.kind != VtkType::Kind::number)
                fail("{}: COORDINATES: expected a type of numbers", tokens_.where());
            part_.coordinates[static_cast<std::size_t>(word[0] - 'x')] =
                tokens_.values<double>(type.value, count, "COORDINATES");
        } else if (word == "point_data" || word == "cell_data") {
            of_cells_ = word == "cell_data";
            tuples_ = tokens_.count(of_cells_ ? "CELL_DATA" : "POINT_DATA");
            in_data_ = true;
        } else if (word == "field") {
            read_vtk_field(tokens_, take);
        } else if (word == "metadata") {
            tokens_.skip_metadata();
        } else if (!in_data_ || !read_vtk_attribute(tokens_, word, tuples_, take)) {
            fail("{}: found '{}', expected a keyword (DIMENSIONS, POINT_DATA, SCALARS, ...)",
                 tokens_.where(), printable(word));
        }
    }

    void read_array(const VtkArrayLine& line) {
        const std::string what = "'" + line.name + "'";
        const std::int64_t count = tokens_.product(line.components, line.tuples, what);
        constexpr std::int64_t most_components = 65536;
        const bool usable = line.components > 0 && line.components <= most_components &&
                            line.type.kind != VtkType::Kind::string;
        if (in_data_ && usable)
            arrays_.push_back({{line.name, of_cells_, line.components, {}}, line, tokens_});
        tokens_.skip_values(line.type, count, what);
    }

    VtkTokens tokens_;
    VtkImagePart part_;
    VtkGeometry geometry_;
    std::vector<LegacyArray> arrays_;
    bool rectilinear_ = false, has_size_ = false;
    bool in_data_ = false, of_cells_ = false;
    std::int64_t tuples_ = 0;  // values of each array, by POINT_DATA or CELL_DATA
};

}  // namespace

bool is_legacy_vtk_image(const std::filesystem::path& path) {
    const std::string beginning = file_beginning(path, dataset_bytes);
    if (!beginning.starts_with("# vtk DataFile Version")) return false;
    try {
        VtkTokens tokens("", beginning);
        return read_vtk_header(tokens).dataset != "unstructured_grid";
    } catch (const Error&) {
        return false;  // read_mesh() reports it
    }
}

Volume open_legacy_vtk_image(const std::filesystem::path& path, const VolumeRequest& request,
                             const VolumeUse& use) {
    const ByteBuffer bytes = read_large_file(path);
    const LegacyImage legacy(path.string(), bytes.text());
    const VtkImageHead head{path.string(), bytes.size(), legacy.part().extent, legacy.geometry()};
    return joined_vtk_image(
        head, [&](const auto& add) { add(legacy.part()); }, request, use);
}

}  // namespace lamina
