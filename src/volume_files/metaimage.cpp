// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t header_limit = std::size_t{1} << 20;  // bytes of the file that are searched

// The header of a MetaImage: lines "Key = value" up to ElementDataFile. Throws Error.
class MetaImageFields {
  public:
    explicit MetaImageFields(const std::filesystem::path& path) : file_(path.string()) {
        expect_regular_file(path);
        std::istringstream stream(file_beginning(path, header_limit));
        int number = 0;
        for (std::string line; !has("ElementDataFile") && std::getline(stream, line);) {
            ++number;
            if (without_blanks(line).empty()) continue;
            const std::size_t equals = line.find('=');
            if (equals == std::string::npos || line.size() > 4096) {
                fail("{}: line {}: found '{}', expected 'Key = value'", file_, number,
                     one_line(line.substr(0, 40)));
            }
            const std::string key = without_blanks(line.substr(0, equals));
            if (!fields_.emplace(key, without_blanks(line.substr(equals + 1))).second)
                fail("{}: line {}: second '{}'", file_, number, one_line(key.substr(0, 40)));
            if (key == "ObjectType" && text(key) != "Image") reject(key, "Image");
        }
        if (!has("ElementDataFile"))
            fail("{}: no ElementDataFile in the header, expected one", file_);
        length_ = stream.eof() ? -1 : static_cast<std::int64_t>(stream.tellg());
        if (!text("ElementDataFile").starts_with("LIST")) return;
        for (std::string line; std::getline(stream, line);)
            if (!without_blanks(line).empty()) listed_.push_back(without_blanks(line));
    }

    const std::string& file() const { return file_; }
    // Returns the bytes up to the end of ElementDataFile's line; -1 if the file ends there.
    std::int64_t length() const { return length_; }
    const std::vector<std::string>& listed() const { return listed_; }  // after LIST

    bool has(const std::string& key) const { return fields_.contains(key); }

    std::string text(const std::string& key, const std::string& otherwise = "") const {
        const auto found = fields_.find(key);
        return found == fields_.end() ? otherwise : found->second;
    }

    bool flag(const std::string& key, bool otherwise) const {
        const std::string word = text(key);
        if (word.empty() && !has(key)) return otherwise;
        const char letter = word.empty() ? ' ' : word[0];
        if (letter == 'T' || letter == 't' || letter == '1') return true;
        if (letter == 'F' || letter == 'f' || letter == '0') return false;
        reject(key, "True or False");
    }

    std::int64_t whole(const std::string& key, std::int64_t least, std::int64_t most) const {
        return wholes(key, 1, least, most)[0];
    }

    std::vector<std::int64_t> wholes(const std::string& key, std::size_t count, std::int64_t least,
                                     std::int64_t most) const {
        std::vector<std::int64_t> result;
        for (const std::string& word : words_of(text(key))) {
            const auto number = whole_number(word);
            if (!number || *number < least || *number > most) break;
            result.push_back(*number);
        }
        if (result.size() != count || words_of(text(key)).size() != count)
            reject(key, fmt::format("{} whole numbers from {} to {}", count, least, most));
        return result;
    }

    // Returns the `count` finite numbers of a field. Throws Error if it has others.
    std::vector<double> numbers(const std::string& key, std::size_t count) const {
        std::vector<double> result;
        const std::vector<std::string> words = words_of(text(key));
        for (const std::string& word : words) {
            char* end = nullptr;
            const double number = std::strtod(word.c_str(), &end);
            if (*end != '\0' || !std::isfinite(number)) break;
            result.push_back(number);
        }
        if (result.size() != count || words.size() != count)
            reject(key, fmt::format("{} finite numbers", count));
        return result;
    }

    [[noreturn]] void reject(const std::string& key, const std::string& expected) const {
        if (!has(key)) fail("{}: {}: found nothing, expected {}", file_, key, expected);
        fail("{}: {}: found '{}', expected {}", file_, key, one_line(text(key).substr(0, 80)),
             expected);
    }

  private:
    std::string file_;
    std::map<std::string, std::string> fields_;
    std::int64_t length_ = 0;
    std::vector<std::string> listed_;
};

constexpr std::int64_t largest_size = std::int64_t{1} << 40;  // of axes, of HeaderSize

struct ElementType {
    const char* word;
    ValueType type;
};

// MetaIO's LONG has 32 bits on every machine.
constexpr ElementType element_types[] = {
    {"MET_CHAR", ValueType::int8},       {"MET_UCHAR", ValueType::uint8},
    {"MET_SHORT", ValueType::int16},     {"MET_USHORT", ValueType::uint16},
    {"MET_INT", ValueType::int32},       {"MET_UINT", ValueType::uint32},
    {"MET_LONG", ValueType::int32},      {"MET_ULONG", ValueType::uint32},
    {"MET_LONG_LONG", ValueType::int64}, {"MET_ULONG_LONG", ValueType::uint64},
    {"MET_FLOAT", ValueType::float32},   {"MET_DOUBLE", ValueType::float64}};

class MetaImage {
  public:
    explicit MetaImage(const Path& path)
        : path_(path),
          fields_(path),
          dimensions_(static_cast<std::size_t>(fields_.whole("NDims", 2, 4))),
          sizes_(fields_.wholes("DimSize", dimensions_, 1, largest_size)) {
        if (fields_.text("HeaderSizePerSlice", "0") != "0")
            fields_.reject("HeaderSizePerSlice", "0");
        if (sizes_.size() == 2) sizes_.push_back(1);  // one slice
    }

    void say_what_is_not_used() const {
        const std::vector<double> zeros(dimensions_, 0);
        if (numbers_of({"CenterOfRotation"}, zeros) == zeros) return;
        say("{}: CenterOfRotation: found {}, which is not used: as in ITK, Offset is "
            "the place of the first sample",
            fields_.file(), one_line(fields_.text("CenterOfRotation").substr(0, 80)));
    }

    // ITK and VTK write colours so, and vectors as other types.
    bool is_colour() const {
        const std::int64_t channels = channel_count();
        return (channels == 3 || channels == 4) && type() == ValueType::uint8;
    }

    Grid grid() const {
        Grid grid = plain_grid({sizes_[0], sizes_[1], sizes_[2]});
        const std::vector<double> zeros(dimensions_, 0), ones(dimensions_, 1);
        std::vector<double> unit(dimensions_ * dimensions_, 0);
        for (std::size_t axis = 0; axis < dimensions_; ++axis) unit[axis * (dimensions_ + 1)] = 1;
        // ElementSize, the voxel's size, counts if there is no spacing.
        const auto spacing = numbers_of({"ElementSpacing", "ElementSize"}, ones);
        const auto rows = numbers_of({"TransformMatrix", "Rotation", "Orientation"}, unit);
        const auto origin = numbers_of({"Offset", "Position", "Origin"}, zeros);
        for (std::size_t axis = 0; axis < std::min<std::size_t>(dimensions_, 3); ++axis) {
            if (!(spacing[axis] > 0)) fields_.reject("ElementSpacing", "numbers above 0");
            const double* const row = &rows[axis * dimensions_];
            grid.step[axis] =
                spacing[axis] * glm::dvec3(row[0], row[1], dimensions_ > 2 ? row[2] : 0);
            grid.origin[static_cast<int>(axis)] = origin[axis];
        }
        if (dimensions_ == 2) grid.step[2] = slice_step(grid.step[0], grid.step[1]);
        const std::string orientation = fields_.text("AnatomicalOrientation");
        if (orientation.find_first_of("RLAPIS") != std::string::npos)
            grid.axes = WorldAxes::left_posterior_superior;
        if (const std::string word = fields_.text("DistanceUnits"); word != "?")
            grid.unit = unit_word(word);
        check_grid(fields_.file(), grid, {"TransformMatrix", "Offset"});
        return grid;
    }

    StoredData data(const VolumeRequest& request) const {
        StoredData data;
        data.path = path_;
        data.type = type();
        const std::int64_t channels = channel_count();
        data.axes = axes(channels, request);
        if (!fields_.flag("BinaryData", true))
            data.encoding = DataEncoding::ascii;
        else if (fields_.flag("CompressedData", false))
            data.encoding = DataEncoding::gzip;
        const bool big_endian = fields_.flag("BinaryDataByteOrderMSB", false);
        set_byte_order(data, fields_.flag("ElementByteOrderMSB", big_endian));
        data.scale = numbers_of({"ElementToIntensityFunctionSlope"}, {1})[0];
        data.shift = numbers_of({"ElementToIntensityFunctionOffset"}, {0})[0];
        if (data.scale == 0) fields_.reject("ElementToIntensityFunctionSlope", "a number but 0");
        place(data, channels > 1);
        return data;
    }

  private:
    std::int64_t channel_count() const {
        constexpr const char* key = "ElementNumberOfChannels";
        return fields_.has(key) ? fields_.whole(key, 1, 65536) : 1;
    }

    ValueType type() const {
        std::string word = fields_.text("ElementType");
        if (word.ends_with("_ARRAY")) word.resize(word.size() - 6);
        const auto* const found = std::ranges::find(element_types, word, &ElementType::word);
        if (found == std::end(element_types))
            fields_.reject("ElementType", "a type of numbers, such as MET_UCHAR or MET_FLOAT");
        return found->type;
    }

    // Returns the axes of the data. Channels are the fastest; a single one is no axis.
    std::vector<StoredAxis> axes(std::int64_t channels, const VolumeRequest& request) const {
        std::vector<StoredAxis> axes;
        const StoredAxis channel = taken_axis(fields_.file(), "channel", request.channel, channels);
        if (channels > 1) axes.push_back(channel);
        for (std::size_t axis = 0; axis < 3; ++axis) axes.emplace_back(sizes_[axis]);
        const std::int64_t steps = dimensions_ == 4 ? sizes_[3] : 1;
        const StoredAxis time = taken_axis(fields_.file(), "time", request.time, steps);
        if (dimensions_ == 4) axes.push_back(time);
        return axes;
    }

    // Sets the files and the place of the samples in them.
    void place(StoredData& data, bool has_channels) const {
        const std::string value = fields_.text("ElementDataFile");
        std::int64_t skip = 0;
        if (fields_.has("HeaderSize")) skip = fields_.whole("HeaderSize", -1, largest_size);
        if (value == "LOCAL" || value == "Local" || value == "local") {
            data.files = {path_};
            data.offset = fields_.length();
            if (data.offset < 0) fields_.reject("ElementDataFile", "data behind it");
            return;
        }
        if (skip < 0)
            data.byte_skip = skip;  // -1: the data are the last bytes of the file
        else
            data.offset = skip;
        const std::vector<std::string> words = words_of(value);
        std::optional<std::size_t> each;  // axes that one file holds
        const auto set_each = [&](std::size_t word) {
            if (words.size() <= word) return;
            std::string_view digits = words[word];  // "2" or, as MetaIO has it, "2D"
            if (digits.ends_with('D')) digits.remove_suffix(1);
            const auto axes = whole_number(digits);
            if (!axes || *axes < 1 || *axes > static_cast<std::int64_t>(dimensions_))
                fields_.reject("ElementDataFile", "a number of axes in one file");
            each = static_cast<std::size_t>(*axes) + (has_channels ? 1 : 0);
        };
        if (!words.empty() && words[0] == "LIST") {
            set_each(1);
            if (fields_.listed().empty())
                fields_.reject("ElementDataFile", "the names of the files behind it, one a line");
            set_data_files(data, fields_.listed(), each, "ElementDataFile");
        } else if (value.find('%') != std::string::npos) {
            set_each(4);
            set_data_files(data, numbered(words), each, "ElementDataFile");
        } else {
            if (value.empty()) fields_.reject("ElementDataFile", "LOCAL or the name of a file");
            set_data_files(data, {value}, each, "ElementDataFile");
        }
    }

    // Returns the names of a numbered series of files. `words`: pattern, first, last and step.
    std::vector<std::string> numbered(const std::vector<std::string>& words) const {
        std::array<std::optional<std::int64_t>, 3> steps;
        for (std::size_t i = 0; i < 3 && words.size() > i + 1; ++i)
            steps[i] = whole_number(words[i + 1]);
        const auto pattern = file_pattern(words[0]);
        if (!pattern || !steps[0] || !steps[1] || !steps[2] || words.size() > 5) {
            fields_.reject(
                "ElementDataFile",
                "a name with one %d or %03d in it, and first, last and step of its number");
        }
        const auto names = names_of(*pattern, *steps[0], *steps[1], *steps[2]);
        if (!names)
            fields_.reject("ElementDataFile", fmt::format("at most {} files", most_pattern_files));
        return *names;
    }

    // Returns the numbers of the first of the keys that the header has, else `otherwise`.
    std::vector<double> numbers_of(std::initializer_list<const char*> keys,
                                   const std::vector<double>& otherwise) const {
        for (const char* const key : keys)
            if (fields_.has(key)) return fields_.numbers(key, otherwise.size());
        return otherwise;
    }

    Path path_;
    MetaImageFields fields_;
    std::size_t dimensions_;
    std::vector<std::int64_t> sizes_;
};

}  // namespace

bool is_metaimage(const Path& path) {
    const std::string beginning = file_beginning(path, 64);
    std::istringstream stream(beginning);
    std::string key, equals;
    stream >> key >> equals;
    if (!equals.starts_with("=") && key.find('=') == std::string::npos) return false;
    key = key.substr(0, key.find('='));
    return key == "ObjectType" || key == "NDims" || key == "Comment" || key == "ObjectSubType";
}

Volume open_metaimage(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    const MetaImage image(path);
    const Grid grid = image.grid();
    image.say_what_is_not_used();
    const Volume volume = open_stored(grid, image.data(request), use);
    if (use.contents != nullptr) use.contents->is_colour = image.is_colour();
    return volume;
}

std::vector<Path> files_of_metaimage(const Path& path) {
    std::vector<Path> files{path};
    for (const Path& file : MetaImage(path).data({}).files)
        if (file != path) files.push_back(file);
    return files;
}

}  // namespace lamina
