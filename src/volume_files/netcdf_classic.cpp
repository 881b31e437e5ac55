// SPDX-License-Identifier: Apache-2.0
// Classic NetCDF: CDF-1, CDF-2 (64-bit offsets) and CDF-5 (64-bit data), by "NetCDF Classic Format
// Specification" (docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html). All
// numbers are big-endian. A variable whose first dimension is the record dimension has its records
// among those of other variables.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "volume_files/array_axes.h"
#include "volume_files/packed_values.h"
#include "volume_files/stored_data.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

constexpr bool is_swapped = std::endian::native == std::endian::little;

constexpr std::uint64_t text_type = 2;
constexpr std::size_t most_axes = 8;

// Returns the type of a number in the header (nc_type), or nothing for text and others.
std::optional<ValueType> type_of_netcdf(std::uint64_t number) {
    constexpr ValueType types[] = {ValueType::int8,    ValueType::int8,  ValueType::int8,
                                   ValueType::int16,   ValueType::int32, ValueType::float32,
                                   ValueType::float64, ValueType::uint8, ValueType::uint16,
                                   ValueType::uint32,  ValueType::int64, ValueType::uint64};
    if (number == 0 || number == text_type || number >= std::size(types)) return {};
    return types[number];
}

using NetcdfAttributes = std::map<std::string, PackedAttribute>;

struct NetcdfVariable {
    std::string name;
    std::vector<std::size_t> dimensions;
    NetcdfAttributes attributes;
    std::optional<ValueType> type;  // none: text
    std::uint64_t begin = 0;        // byte of the first sample
};

struct NetcdfDimension {
    std::string name;
    std::int64_t size = 0;  // of the record dimension: the number of records
    bool is_record = false;
};

// The header of a file.
class NetcdfFile {
    static constexpr std::uint64_t most_values = 1 << 24;  // of an attribute

  public:
    explicit NetcdfFile(const std::filesystem::path& path) : name_(path.string()), file_(path) {
        const std::string magic = text(4);
        if (!magic.starts_with("CDF") || (magic[3] != 1 && magic[3] != 2 && magic[3] != 5)) {
            fail("{}: found the signature of neither classic NetCDF nor HDF5, expected one", name_);
        }
        version_ = magic[3];
        const std::uint64_t records = count();
        const bool is_open = records == (version_ == 5 ? ~std::uint64_t{0} : 0xFFFFFFFFU);
        read_dimensions();
        read_attributes();
        read_variables();
        for (const NetcdfVariable& one : variables) {
            if (is_record(one) &&
                __builtin_add_overflow(record_bytes, row_bytes(one, true), &record_bytes))
                fail("{}: found larger records than any file holds", name_);
        }
        const auto in_records = std::ranges::count_if(
            variables, [&](const NetcdfVariable& one) { return is_record(one); });
        for (const NetcdfVariable& one : variables)  // a single one is not padded
            if (in_records == 1 && is_record(one)) record_bytes = row_bytes(one, false);
        set_records(records, is_open);
    }

    std::vector<NetcdfDimension> dimensions;
    std::vector<NetcdfVariable> variables;
    std::uint64_t record_bytes = 0;  // of all variables that have records

    const std::string& name() const { return name_; }
    const RandomAccessFile& file() const { return file_; }

    bool is_record(const NetcdfVariable& variable) const {
        return !variable.dimensions.empty() && dimensions[variable.dimensions[0]].is_record;
    }

    // Returns the bytes of a variable, or of each of its records. Throws Error if no file has them.
    std::uint64_t row_bytes(const NetcdfVariable& variable, bool padded) const {
        std::uint64_t bytes = variable.type ? bytes_of(*variable.type) : 1;
        for (std::size_t i = is_record(variable) ? 1 : 0; i < variable.dimensions.size(); ++i) {
            if (__builtin_mul_overflow(
                    bytes, static_cast<std::uint64_t>(dimensions[variable.dimensions[i]].size),
                    &bytes) ||
                bytes > (std::uint64_t{1} << 62))
                fail("{}: {}: found more samples than any file holds", name_, variable.name);
        }
        return padded ? (bytes + 3) / 4 * 4 : bytes;
    }

    const NetcdfVariable* variable(const std::string& name) const {
        const auto found = std::ranges::find(variables, name, &NetcdfVariable::name);
        return found == variables.end() ? nullptr : &*found;
    }

    std::vector<double> coordinates(const NetcdfVariable& variable) const {
        constexpr std::int64_t most_along_axis = 1 << 20;
        const std::int64_t size = dimensions[variable.dimensions[0]].size;
        if (!variable.type || size > most_along_axis) return {};
        const std::size_t bytes = bytes_of(*variable.type);
        const std::uint64_t step = is_record(variable) ? record_bytes : bytes;
        const auto count = static_cast<std::size_t>(size);
        std::string values(count * bytes, '\0');
        const std::size_t together = is_record(variable) ? 1 : count;  // that lie side by side
        for (std::size_t i = 0; i < count; i += together)
            file_.read(variable.begin + i * step, values.data() + i * bytes, together * bytes);
        return values_from_bytes<double>(*variable.type, values.data(), count, is_swapped);
    }

  private:
    // Returns the next `count` bytes of the header.
    std::string text(std::uint64_t bytes) {
        constexpr std::uint64_t at_once = 1 << 16;
        if (bytes > file_.size() - at_) {
            fail("{}: truncated: the header promises {} bytes at byte {}, the file has {}", name_,
                 bytes, at_, file_.size());
        }
        if (at_ + bytes > buffer_begin_ + buffer_.size()) {
            buffer_.resize(std::min(std::max(bytes, at_once), file_.size() - at_));
            file_.read(at_, buffer_.data(), buffer_.size());
            buffer_begin_ = at_;
        }
        at_ += bytes;
        return buffer_.substr(at_ - bytes - buffer_begin_, bytes);
    }
    std::uint64_t number(std::size_t bytes) { return number_of_bytes(text(bytes), true); }
    // A count, or an index (NON_NEG in the specification).
    std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }
    std::string padded_text(std::uint64_t bytes) {
        std::string found = text(bytes);
        text((4 - bytes % 4) % 4);
        return found;
    }
    std::optional<ValueType> read_type(const std::string& key) {
        const std::uint64_t found = number(4);
        const auto type = type_of_netcdf(found);
        if (!type && found != text_type)
            fail("{}: {}: damaged header: found the type {}, expected 1 to 11", name_, key, found);
        return type;
    }
    std::string read_name() { return one_line(padded_text(count())); }

    // Returns the length of a list with this tag.
    std::uint64_t list(std::uint64_t tag, const char* what) {
        const std::uint64_t found = number(4), length = count();
        if (found != tag && (found != 0 || length != 0))
            fail("{}: damaged header: found no list of {} at byte {}", name_, what, at_);
        return length;
    }

    void read_dimensions() {
        for (std::uint64_t left = list(10, "dimensions"); left > 0; --left) {
            NetcdfDimension dimension{read_name(), 0};
            const std::uint64_t size = count();
            if (size > (std::uint64_t{1} << 40))
                fail("{}: dimension {}: found {} samples", name_, dimension.name, size);
            dimension.size = static_cast<std::int64_t>(size);
            dimension.is_record = size == 0;
            dimensions.push_back(dimension);
        }
    }

    NetcdfAttributes read_attributes() {
        NetcdfAttributes attributes;
        for (std::uint64_t left = list(12, "attributes"); left > 0; --left) {
            const std::string key = read_name();
            const auto type = read_type(key);
            const std::uint64_t bytes = type ? bytes_of(*type) : 1, length = count();
            if (length > std::min(most_values, file_.size() / bytes)) {
                fail("{}: attribute {}: found {} values, expected fewer", name_, key, length);
            }
            const std::string values = padded_text(length * bytes);
            PackedAttribute& entry = attributes[key];
            entry.type = type;
            if (type)
                entry.numbers = values_from_bytes<double>(*type, values.data(), length, is_swapped);
            else
                entry.text = values.c_str();
        }
        return attributes;
    }

    void read_variables() {
        for (std::uint64_t left = list(11, "variables"); left > 0; --left) {
            NetcdfVariable variable;
            variable.name = read_name();
            for (std::uint64_t more = count(); more > 0; --more) {
                const std::uint64_t dimension = count();
                if (dimension >= dimensions.size() ||
                    (dimensions[dimension].is_record && !variable.dimensions.empty())) {
                    fail("{}: {}: damaged: found dimension {} of {}", name_, variable.name,
                         dimension, dimensions.size());
                }
                variable.dimensions.push_back(dimension);
            }
            variable.attributes = read_attributes();
            variable.type = read_type(variable.name);
            count();  // vsize, which the dimensions give, too
            variable.begin = number(version_ == 1 ? 4 : 8);
            variables.push_back(std::move(variable));
        }
    }

    // Sets the number of records; if it `is_open`, the file has as many as fit.
    void set_records(std::uint64_t records, bool is_open) {
        std::uint64_t begin = file_.size();
        for (const NetcdfVariable& one : variables)
            if (is_record(one)) begin = std::min(begin, one.begin);
        const std::uint64_t most =
            record_bytes == 0 ? 0 : (file_.size() - begin + 3) / record_bytes;
        if (!is_open && records > most && record_bytes != 0) {
            fail("{}: truncated: the header promises {} records, the file has {}", name_, records,
                 most);
        }
        for (NetcdfDimension& dimension : dimensions)
            if (dimension.is_record)
                dimension.size =
                    static_cast<std::int64_t>(is_open ? most : std::min(records, most));
    }

    std::string name_;
    RandomAccessFile file_;
    int version_ = 1;
    std::string buffer_;
    std::uint64_t at_ = 0, buffer_begin_ = 0;
};

const NetcdfVariable& wanted_variable(const NetcdfFile& file, std::string wanted,
                                      VolumeContents& contents) {
    for (const NetcdfVariable& one : file.variables)
        if (one.dimensions.size() >= 3 && one.dimensions.size() <= most_axes && one.type)
            contents.arrays.push_back(one.name);
    if (wanted.starts_with('/')) wanted.erase(0, 1);
    if (wanted.empty()) wanted = only_array(contents.arrays, file.name());
    const NetcdfVariable* const found = file.variable(wanted);
    if (found == nullptr || !found->type || found->dimensions.size() < 2 ||
        found->dimensions.size() > most_axes) {
        fail(
            "{}: array: found no numbers of 2 to 8 dimensions named \"{}\", expected one of "
            "{}",
            file.name(), one_line(wanted), names_text(contents.arrays));
    }
    return *found;
}

PackedValues::Attribute attributes_of(const NetcdfVariable& variable) {
    return [&variable](const char* key) {
        const auto found = variable.attributes.find(key);
        return found == variable.attributes.end() ? PackedAttribute() : found->second;
    };
}

std::function<std::string(const char*)> texts_of(const NetcdfVariable& variable) {
    return [&variable](const char* key) { return attributes_of(variable)(key).text; };
}

PackedValues values_of(const NetcdfFile& file, const NetcdfVariable& variable) {
    return PackedValues(file.name() + ":/" + variable.name, *variable.type, true,
                        attributes_of(variable));
}

DescribedArray describe(const NetcdfFile& file, const NetcdfVariable& variable) {
    DescribedArray described;
    described.name = file.name() + ":/" + variable.name;
    file.row_bytes(variable, false);  // throws Error if the product of sizes is too large
    for (const std::size_t number : variable.dimensions) {
        ArrayAxis axis;
        axis.size = file.dimensions[number].size;
        axis.name = file.dimensions[number].name;
        if (axis.size < 1) fail("{}: dimension {}: found no samples", described.name, axis.name);
        const NetcdfVariable* const along = file.variable(axis.name);
        if (along != nullptr && along->dimensions == std::vector<std::size_t>{number}) {
            add_attributes(axis, texts_of(*along));
            axis.coordinates = file.coordinates(*along);
            if (!axis.coordinates.empty())
                axis.coordinates = values_of(file, *along).meant(std::move(axis.coordinates));
        }
        described.axes.push_back(std::move(axis));
    }
    described.coordinates = texts_of(variable)("coordinates");
    return described;
}

// Reads the samples that are taken of a variable, in the order of the volume. If z is the slowest
// of the dimensions of which more than one index is taken, it reads slice by slice.
class VariableReader {
  public:
    VariableReader(const NetcdfFile& file, const NetcdfVariable& variable, const ArrayPlace& place)
        : file_(file), variable_(variable), place_(place), index_(place.index) {
        for (const std::size_t number : variable.dimensions)
            counts_.push_back(file.dimensions[number].size);
        row_ = file.row_bytes(variable, false);
        step_ = file.record_bytes;
        if (!file.is_record(variable)) step_ = row_ /= static_cast<std::uint64_t>(counts_[0]);
        for (first_ = 0; first_ + 1 < counts_.size() && !is_in_space(first_);) {
            begin_ += static_cast<std::uint64_t>(index_[first_]) * step_;
            counts_[first_] = 1;
            index_[first_] = 0;
            step_ = row_ /= static_cast<std::uint64_t>(counts_[++first_]);
        }
        const auto rows = static_cast<std::uint64_t>(counts_[first_]);
        slices_ = place.axes[2] == static_cast<int>(first_) ? rows : 1;
        rows_ = rows / slices_;
        samples_ = static_cast<std::uint64_t>(place.grid.sample_count()) / slices_;
        counts_[first_] = static_cast<std::int64_t>(rows_);
        // Each of the three is less than 2^62.
        const std::uint64_t size = file.file().size(), end = begin_ + (rows - 1) * step_ + row_;
        if (variable.begin > size || end > size - variable.begin) {
            fail("{}: {}: truncated: the header promises {} bytes at byte {}, the file has {}",
                 file.name(), variable.name, end, variable.begin, size);
        }
        begin_ += variable.begin;
    }

    // Returns the bytes that reading takes beside the samples.
    std::uint64_t scratch_bytes() const {
        return rows_ * row_ + samples_ * bytes_of(*variable_.type);
    }

    std::shared_ptr<void> read(const PackedValues& values) const {
        const std::size_t each = bytes_of(*variable_.type),
                          bytes = samples_ * bytes_of(values.type());
        std::shared_ptr<void> samples = filled_memory(slices_ * bytes);
        const std::shared_ptr<void> stored = filled_memory(rows_ * row_),
                                    ordered = filled_memory(samples_ * each);
        std::int64_t missing = 0;
        for (std::uint64_t i = 0; i < slices_; ++i) {
            check_interrupt();
            for (std::uint64_t row = 0; row < rows_; ++row)
                file_.file().read(begin_ + (i * rows_ + row) * step_,
                                  static_cast<char*>(stored.get()) + row * row_, row_);
            if (is_swapped)
                swap_bytes(stored.get(), static_cast<std::int64_t>(rows_ * row_ / each), each);
            char* const to = static_cast<char*>(samples.get()) + i * bytes;
            const bool marks = values.can_be_missing();
            copy_in_order(*variable_.type, place_.axes, counts_, index_, stored.get(),
                          marks ? ordered.get() : to);
            if (marks)
                missing += values.mark(static_cast<std::int64_t>(samples_), ordered.get(), to);
        }
        values.say_missing(missing);
        return samples;
    }

  private:
    bool is_in_space(std::size_t dimension) const {
        return std::ranges::find(place_.axes, static_cast<int>(dimension)) != place_.axes.end();
    }

    const NetcdfFile& file_;
    const NetcdfVariable& variable_;
    const ArrayPlace& place_;
    std::vector<std::int64_t> counts_, index_;
    std::size_t first_ = 0;  // the slowest dimension of which more than one index is taken
    // `row_`: bytes of one index of `first_`, which are `step_` apart.
    std::uint64_t begin_ = 0, row_ = 0, step_ = 0;
    std::uint64_t slices_ = 1, rows_ = 1, samples_ = 1;  // rows and samples of each slice
};

}  // namespace

bool is_netcdf_classic(const std::filesystem::path& path) {
    const std::string magic = file_beginning(array_path(path).file, 4);
    return magic.size() == 4 && magic.starts_with("CDF") &&
           (magic[3] == 1 || magic[3] == 2 || magic[3] == 5);
}

Volume open_netcdf_classic(const std::filesystem::path& path, const VolumeRequest& request,
                           const VolumeUse& use) {
    const ArrayPath named = array_path(path);
    const NetcdfFile file(named.file);
    if (file.variable("image-max") != nullptr) fail_as_minc(file.name());
    VolumeContents contents;
    const NetcdfVariable& variable =
        wanted_variable(file, named.array.empty() ? request.array : named.array, contents);
    const DescribedArray described = describe(file, variable);
    const ArrayPlace place = place_array(described, request, contents);
    if (use.contents != nullptr) *use.contents = contents;
    const PackedValues values = values_of(file, variable);
    const VariableReader reader(file, variable, place);
    const bool is_drawn = drawn_type(values.type()) && values.scale() == 1 && values.offset() == 0;
    const std::uint64_t each = bytes_of(values.type()) + (is_drawn ? 0 : sizeof(float));
    expect_room(
        path.string(),
        static_cast<std::uint64_t>(place.grid.sample_count()) * each + reader.scratch_bytes(), use,
        "classic NetCDF is read as a whole");
    return drawn_volume(
        place.grid,
        {path.string(), values.type(), reader.read(values), values.scale(), values.offset()},
        use.lookup);
}

std::vector<std::filesystem::path> files_of_netcdf_classic(const std::filesystem::path& path) {
    return {array_path(path).file};
}

}  // namespace lamina
