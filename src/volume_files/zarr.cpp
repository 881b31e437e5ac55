// SPDX-License-Identifier: Apache-2.0
// OME-Zarr: ngff.openmicroscopy.org/0.4, "multiscales" metadata.
#include "volume_files/volume_formats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume_files/zarr_chunks.h"

namespace lamina {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

// One array of an image, and the meaning of its axes.
struct ZarrImage {
    std::filesystem::path folder;            // the array's
    std::vector<std::string> axes;           // "t", "c", "z", "y" or "x", in the array's order
    std::vector<double> scale, translation;  // from indices to the world, along each axis
};

constexpr std::size_t most_image_axes = 5;

// Reads an image's metadata, "multiscales", from an OME-Zarr folder's attributes. Throws Error.
class OmeReader {
  public:
    OmeReader(const std::filesystem::path& folder, const Json& attributes)
        : folder_(folder),
          name_((folder / ".zattrs").string()),
          image_(attributes["multiscales"][0]) {}

    ZarrImage read(const std::optional<std::int64_t>& wanted) {
        const Json& datasets = list_in(image_, "datasets");
        const auto level = static_cast<std::size_t>(taken_of(
            folder_.string(), "level", wanted, static_cast<std::int64_t>(datasets.size())));
        const Json& dataset = datasets[level];
        const Json* const path = member_of(dataset, "path");
        if (path == nullptr || !path->is_string())
            fail("{}: datasets: found {}, expected a \"path\"", name_, json_excerpt(dataset));
        ZarrImage image{folder_ / path->get<std::string>(), read_axes(), {}, {}};
        image.scale.assign(image.axes.size(), 1);
        image.translation.assign(image.axes.size(), 0);
        transform(dataset, image);
        transform(image_, image);
        return image;
    }

  private:
    const Json& list_in(const Json& object, const char* key) const {
        const Json* const found = member_of(object, key);
        if (found == nullptr || !found->is_array() || found->empty())
            fail("{}: multiscales: found no list \"{}\", expected one", name_, key);
        return *found;
    }

    // Returns the names of the axes. Version 0.3 of the format has only names; earlier ones have
    // none, and the axes are always t, c, z, y, x.
    std::vector<std::string> read_axes() const {
        if (!image_.contains("axes")) return {"t", "c", "z", "y", "x"};
        std::vector<std::string> axes;
        std::string unit;
        for (const Json& axis : list_in(image_, "axes")) {
            const Json* const named = member_of(axis, "name");
            const Json& name = named != nullptr ? *named : axis;
            const std::string word = name.is_string() ? name.get<std::string>() : "";
            if (word.size() != 1 || std::string("tczyx").find(word) == std::string::npos) {
                fail("{}: axes: found {}, expected \"t\", \"c\", \"z\", \"y\" or \"x\"", name_,
                     json_excerpt(name));
            }
            axes.push_back(word);
            if (word != "t" && word != "c") expect_unit(axis, unit);
        }
        if (axes.size() > most_image_axes)
            fail("{}: axes: found {}, expected at most {}", name_, axes.size(), most_image_axes);
        return axes;
    }

    // Throws Error if an axis has another unit than the axes before it; `unit` is theirs.
    void expect_unit(const Json& axis, std::string& unit) const {
        const Json* const found = member_of(axis, "unit");
        if (found == nullptr || !found->is_string()) return;
        const auto here = found->get<std::string>();
        if (!unit.empty() && here != unit) {
            fail("{}: axes: found the units \"{}\" and \"{}\", expected one for all", name_,
                 one_line(unit), one_line(here));
        }
        unit = here;
    }

    std::vector<double> numbers_in(const Json& step, const char* key, std::size_t count) const {
        std::vector<double> numbers;
        const Json& list = step.contains(key) ? step[key] : step;
        bool good = list.is_array() && list.size() == count;
        for (std::size_t i = 0; good && i < count; ++i) {
            good = list[i].is_number();
            if (good) numbers.push_back(list[i].get<double>());
        }
        if (!good) {
            fail("{}: coordinateTransformations: found {}, expected a \"{}\" of {} numbers", name_,
                 json_excerpt(step), key, count);
        }
        return numbers;
    }

    // Applies the transformations of a dataset or an image, in the order of its list.
    void transform(const Json& of, ZarrImage& image) const {
        if (!of.contains("coordinateTransformations")) return;
        const std::size_t count = image.axes.size();
        for (const Json& step : list_in(of, "coordinateTransformations")) {
            const Json type = step.is_object() ? step.value("type", Json()) : Json();
            if (type == "scale") {
                const auto scale = numbers_in(step, "scale", count);
                for (std::size_t i = 0; i < count; ++i) {
                    image.scale[i] *= scale[i];
                    image.translation[i] *= scale[i];
                }
            } else if (type == "translation") {
                const auto shift = numbers_in(step, "translation", count);
                for (std::size_t i = 0; i < count; ++i) image.translation[i] += shift[i];
            } else if (type != "identity") {
                fail(
                    "{}: coordinateTransformations: found {}, expected the type \"scale\" or "
                    "\"translation\"",
                    name_, json_excerpt(step));
            }
        }
    }

    std::filesystem::path folder_;
    std::string name_;
    const Json& image_;
};

// Returns the attributes (.zattrs) of a folder; an empty object if there are none. Throws Error.
Json zarr_attributes(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / ".zattrs";
    if (!std::filesystem::exists(file)) return Json::object();
    expect_allowed(file);
    Json attributes = load_json(file);
    if (!attributes.is_object())
        fail("{}: found {}, expected an object", file.string(), json_excerpt(attributes));
    return attributes;
}

bool is_ome_zarr(const Json& attributes) {
    const Json* const found = member_of(attributes, "multiscales");
    return found != nullptr && found->is_array() && !found->empty() && found->front().is_object();
}

bool has_file(const Path& folder, const char* name) {
    std::error_code unreadable;
    return std::filesystem::exists(folder / name, unreadable);
}

// Adds the arrays and images in a folder and its subfolders to `found`, by their paths in `root`.
void find_arrays(const Path& root, const Path& folder, int depth, std::vector<std::string>& found) {
    constexpr int most_depth = 8;
    constexpr std::size_t most_entries = 1000;
    check_interrupt();
    if (found.size() >= most_entries || depth > most_depth) return;
    expect_allowed(folder);
    if (depth > 0 && (has_file(folder, ".zarray") || is_ome_zarr(zarr_attributes(folder)))) {
        found.push_back(folder.lexically_relative(root).string());
        return;
    }
    std::vector<Path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_directory() && folders.size() < most_entries) folders.push_back(entry.path());
    }
    std::ranges::sort(folders);
    for (const Path& inner : folders) find_arrays(root, inner, depth + 1, found);
}

// Returns the axes of an array without OME-Zarr's metadata: the last ones of t, c, z, y, x.
std::vector<std::string> plain_axes(const ZarrArray& array) {
    static const std::vector<std::string> all{"t", "c", "z", "y", "x"};
    if (array.shape.size() > all.size()) {
        fail("{}: shape: found {} axes, expected at most {}", (array.folder / ".zarray").string(),
             array.shape.size(), all.size());
    }
    return {all.end() - static_cast<std::ptrdiff_t>(array.shape.size()), all.end()};
}

// Returns the array or image that the request takes of a folder; `axes` is empty for an array.
ZarrImage image_in(const Path& path, const VolumeRequest& request) {
    const Path folder = request.array.empty() ? path : path / request.array;
    if (has_file(folder, ".zarray")) return {folder, {}, {}, {}};
    const nlohmann::json attributes = zarr_attributes(folder);
    if (is_ome_zarr(attributes)) return OmeReader(folder, attributes).read(request.level);
    if (has_file(folder, "zarr.json"))
        fail("{}: found Zarr version 3, expected version 2", folder.string());
    if (!request.array.empty())
        fail("{}: array: found \"{}\", expected an array of it", path.string(), request.array);
    std::vector<std::string> arrays;
    find_arrays(path, path, 0, arrays);
    if (arrays.empty()) fail("{}: found no array in it", path.string());
    if (arrays.size() > 1) {
        fail("{}: found the arrays {}, expected one, as in {}", path.string(),
             fmt::join(arrays, ", "), (path / arrays.front()).string());
    }
    VolumeRequest inner = request;
    inner.array = arrays.front();
    return image_in(path, inner);
}

struct PlacedArray {
    ZarrSelection selection;
    Grid grid;
};

// Selects the samples of the volume by the meaning of the array's axes, and places them.
PlacedArray place(const ZarrArray& array, const ZarrImage& image, const VolumeRequest& request) {
    const std::string name = image.folder.string();
    PlacedArray placed;
    placed.selection.index.assign(array.shape.size(), 0);
    bool channels = false, times = false;
    for (std::size_t i = 0; i < array.shape.size(); ++i) {
        if (image.axes[i] == "t") {
            placed.selection.index[i] = taken_of(name, "time", request.time, array.shape[i]);
            times = true;
        } else if (image.axes[i] == "c") {
            placed.selection.index[i] = taken_of(name, "channel", request.channel, array.shape[i]);
            channels = true;
        } else {
            const auto axis = static_cast<std::size_t>('z' - image.axes[i][0]);  // z, y, x
            if (placed.selection.axes[axis] >= 0)
                fail("{}: axes: found two \"{}\", expected one", name, image.axes[i]);
            placed.selection.axes[axis] = static_cast<int>(i);
            const std::size_t in_grid = 2 - axis;
            placed.grid.size[in_grid] = array.shape[i];
            placed.grid.step[in_grid] *= image.scale[i];
            placed.grid.origin[static_cast<int>(in_grid)] = image.translation[i];
        }
    }
    if (!channels) taken_of(name, "channel", request.channel, 1);
    if (!times) taken_of(name, "time", request.time, 1);
    if (placed.selection.axes[1] < 0 || placed.selection.axes[2] < 0)
        fail("{}: axes: found no \"y\" and \"x\", expected both", name);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        placed.grid.centering[axis] =
            placed.grid.size[axis] > 1 ? Centering::node : Centering::cell;
    }
    check_grid(name, placed.grid, {"scale", "translation"});
    return placed;
}

// Reads all selected samples, in native byte order.
std::shared_ptr<void> samples_of(const ZarrChunks& chunks) {
    chunks.check_plausible_size();
    const std::size_t bytes = chunks.selected_bytes();
    const std::shared_ptr<void> memory = filled_memory(bytes);
    const auto& size = chunks.size();
    const SampleBox whole{{0, 0, 0}, {size[2], size[1], size[0]}};
    parallel_for(chunks.count(), 1, [&](std::int64_t chunk) {
        chunks.copy(chunks.decoded(chunk), chunk, whole, static_cast<char*>(memory.get()));
    });
    const ZarrArray& array = chunks.array();
    if (array.swap) swap_bytes(memory.get(), whole.count(), bytes_of(array.type));
    return memory;
}

}  // namespace

bool is_zarr(const Path& path) {
    std::error_code unreadable;
    if (!std::filesystem::is_directory(path, unreadable)) return false;
    return has_file(path, ".zarray") || has_file(path, ".zgroup") || has_file(path, ".zattrs") ||
           has_file(path, "zarr.json");
}

Volume open_zarr(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    ZarrImage image = image_in(path, request);
    const ZarrArray array = read_zarray(image.folder);
    if (image.axes.empty()) {
        if (request.level) taken_of(path.string(), "level", request.level, 1);
        image.axes = plain_axes(array);
        image.scale.assign(image.axes.size(), 1);
        image.translation.assign(image.axes.size(), 0);
    }
    if (image.axes.size() != array.shape.size()) {
        fail("{}: shape: found {} axes, expected {}, as the image has",
             (image.folder / ".zarray").string(), array.shape.size(), image.axes.size());
    }
    const PlacedArray placed = place(array, image, request);
    ZarrChunks chunks(array, placed.selection);
    if (chunks.missing() > 0) {
        warn(fmt::format("{}: {} of {} chunks are not there: they have the fill value {}",
                         array.folder.string(), chunks.missing(), chunks.count(), array.fill));
    }
    const auto type = drawn_type(array.type);
    if (!type)
        expect_room(path.string(), chunks.selected_bytes(), use,
                    fmt::format("its samples are of type {}", name_of(array.type)));
    else if (stays_in_files(placed.grid, *type, use))
        return stored_volume(placed.grid, *type, std::make_unique<ZarrSource>(std::move(chunks)));
    return drawn_volume(placed.grid, {image.folder.string(), array.type, samples_of(chunks)});
}

std::vector<Path> files_of_zarr(const Path& path) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
        check_interrupt();
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace lamina
