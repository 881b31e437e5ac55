// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_volume.h"

#include <hdf5_hl.h>

#include <cstring>
#include <filesystem>
#include <type_traits>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_data.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

// Returns a type of as many bytes without a sign.
ValueType without_sign(ValueType type) {
    return number_type(bytes_of(type), true, false).value_or(type);
}

// Tells if NetCDF has written a file, and filled samples of an array that nobody has written. It
// gives every dimension a scale; newer versions write _NCProperties, too.
bool has_fill_of_netcdf(hid_t file, const Hdf5Array& array) {
    const Hdf5Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
    const Hdf5Handle properties(H5Dget_create_plist(array.id()), H5Pclose);
    H5D_fill_time_t when = H5D_FILL_TIME_IFSET;
    H5Pget_fill_time(properties.id(), &when);
    bool has_scales = true;
    for (std::size_t axis = 0; axis < array.shape().size(); ++axis)
        has_scales &= H5DSget_num_scales(array.id(), static_cast<unsigned>(axis)) > 0;
    return when != H5D_FILL_TIME_NEVER && (has_scales || H5Aexists(root.id(), "_NCProperties") > 0);
}

// Writes fields one after another: plain ones as they lie in memory, texts and lists with their
// length before them.
struct HeadWriter {
    std::string bytes;

    template <typename Field>
    void operator()(const Field& field) {
        if constexpr (std::is_trivially_copyable_v<Field>) {
            bytes.append(reinterpret_cast<const char*>(&field), sizeof field);
        } else {
            (*this)(field.size());
            for (const auto& one : field) (*this)(one);
        }
    }
};

// Reads what a HeadWriter has written.
struct HeadReader {
    std::string_view left;

    template <typename Field>
    void operator()(Field& field) {
        std::size_t count = sizeof field;
        if constexpr (!std::is_trivially_copyable_v<Field>) (*this)(count);
        if (count > left.size()) fail("libhdf5's process sent too few bytes");
        if constexpr (std::is_trivially_copyable_v<Field>) {
            std::memcpy(&field, left.data(), sizeof field);
            left.remove_prefix(sizeof field);
        } else {
            field.resize(count);
            for (auto& one : field) (*this)(one);
        }
    }
};

template <typename Fields, typename Head>
void for_all_fields(Fields& fields, Head& head) {
    const auto all = [&](auto&... each) { (fields(each), ...); };
    auto& grid = head.place.grid;
    auto& contents = head.contents;
    all(grid.size, grid.centering, grid.origin, grid.step, grid.axes, grid.unit);
    all(head.place.axes, head.place.index, head.shape, head.type, head.scale, head.offset);
    all(head.chunk, head.raw, head.files, head.quantity.name, head.quantity.unit);
    all(contents.arrays, contents.channels, contents.times, contents.levels, contents.is_colour);
}

}  // namespace

std::string Hdf5Head::bytes() const {
    HeadWriter writer;
    for_all_fields(writer, *this);
    return writer.bytes;
}

Hdf5Head Hdf5Head::of(std::string_view bytes) {
    Hdf5Head head;
    HeadReader reader{bytes};
    for_all_fields(reader, head);
    return head;
}

Hdf5Volume::Hdf5Volume(const std::string& file, const std::string& array,
                       const VolumeRequest& request)
    : files_(file),
      layout_(hdf5_layout(files_, array, request, contents_)),
      array_(files_.open_set(layout_.array), file + ":" + one_line(layout_.array)) {
    head_.files = files_.paths();
    head_.shape = array_.shape();
    const hid_t id = array_.id();
    values_ = values_in(id, array_.name(),
                        layout_.is_unsigned ? without_sign(array_.type()) : array_.type(),
                        has_fill_of_netcdf(files_.file(), array_));
    head_.type = values_.type();
    head_.scale = values_.scale();
    head_.offset = values_.offset();
    place();
    find_chunks();

    std::vector<StoredAxis> axes;
    for (const std::int64_t size : head_.place.grid.size) axes.emplace_back(size);
    std::uint64_t file_bytes = 0;
    for (const std::string& path : head_.files) file_bytes += std::filesystem::file_size(path);
    array_.expect_readable(stored_bytes(array_.name(), axes, bytes_of(array_.type())), file_bytes);
    head_.contents = contents_;
    head_.quantity = {layout_.array.substr(layout_.array.rfind('/') + 1),
                      unit_word(text_of(id, "units"))};
}

// Places the volume in the array and in the world.
void Hdf5Volume::place() {
    DescribedArray described = describe_hdf5(files_, array_, layout_, contents_);
    head_.place = place_array(described, layout_.request, contents_);
    Grid& grid = head_.place.grid;
    if (layout_.grid) {
        for (std::size_t i = 0; i < 3; ++i) {
            grid.step[i] = layout_.grid->step[i];
            if (layout_.grid->centering[i] == Centering::cell) grid.centering[i] = Centering::cell;
        }
        grid.origin = layout_.grid->origin;
        grid.axes = layout_.grid->axes;
        grid.unit = layout_.grid->unit;
        check_grid(array_.name(), grid, {"directions", "origin"});
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (layout_.size[i] == 0) continue;
        if (layout_.size[i] > grid.size[i]) {
            fail("{}: axis {}: found {} samples, expected {} or more", array_.name(), "xyz"[i],
                 grid.size[i], layout_.size[i]);
        }
        grid.size[i] = layout_.size[i];  // the rest of the last chunk is padding
    }
}

// Finds out how the samples are stored.
void Hdf5Volume::find_chunks() {
    const std::vector<std::int64_t> chunk = array_.chunk();
    const std::array<int, 3>& axes = head_.place.axes;
    for (std::size_t i = 0; i < 3 && !chunk.empty(); ++i)
        head_.chunk[i] = axes[i] < 0 ? 1 : chunk[static_cast<std::size_t>(axes[i])];
    chunk_bytes_ = chunk.empty() ? 0 : bytes_of(array_.type());
    for (const std::int64_t edge : chunk) chunk_bytes_ *= static_cast<std::size_t>(edge);
    const bool as_stored = head_.place.is_in_order() && axes[0] >= 0 && axes[1] >= 0 &&
                           !values_.can_be_missing() && head_.files.size() == 1;
    if (!as_stored) return;
    if (const auto raw = array_.raw_place()) head_.raw = *raw;
}

void Hdf5Volume::read(const SampleBox& box, bool is_all, void* to) const {
    std::vector<std::int64_t> begin = head_.place.index, count(begin.size(), 1);
    const std::array<int, 3>& axes = head_.place.axes;
    for (std::size_t i = 0; i < 3; ++i) {
        if (axes[i] < 0) continue;
        begin[static_cast<std::size_t>(axes[i])] = box.first[i];
        count[static_cast<std::size_t>(axes[i])] = box.size[i];
    }
    const bool in_order = head_.place.is_in_order(), marks = values_.can_be_missing();
    const std::size_t bytes = static_cast<std::size_t>(box.count()) * bytes_of(array_.type());
    ByteBuffer stored(in_order && !marks ? 0 : bytes), ordered(in_order || !marks ? 0 : bytes);
    array_.read(begin, count, in_order && !marks ? to : stored.data());
    if (!in_order)
        copy_in_order(array_.type(), axes, count, std::vector<std::int64_t>(count.size()),
                      stored.data(), marks ? ordered.data() : to);
    if (!marks) return;
    const std::int64_t missing =
        values_.mark(box.count(), in_order ? stored.data() : ordered.data(), to);
    if (is_all) values_.say_missing(missing);
}

}  // namespace lamina
