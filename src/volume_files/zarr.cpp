// SPDX-License-Identifier: Apache-2.0
// Hierarchies of Zarr: which array or image of them is read.
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume/labels.h"
#include "volume_files/volume_formats.h"
#include "volume_files/zarr_image.h"

namespace lamina {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

// Folders of arrays that are not Zarr but look like it, and the file by which each is known.
struct OtherStore {
    const char* file;
    const char* word;  // in the file
    const char* name;  // and what to do, to end a message
};
constexpr const char *n5 = "N5, expected Zarr: zarr.N5Store reads it, zarr.save writes Zarr",
                     *neuroglancer =
                         "Neuroglancer precomputed, expected Zarr: tensorstore copies it to Zarr",
                     *tiledb = "TileDB, expected Zarr: tiledb reads it, zarr.save writes Zarr";
constexpr OtherStore other_stores[] = {{"attributes.json", "\"n5\"", n5},
                                       {"attributes.json", "\"blockSize\"", n5},
                                       {"info", "neuroglancer_multiscale_volume", neuroglancer},
                                       {"info", "\"num_channels\"", neuroglancer},
                                       {"__tiledb_group.tdb", "", tiledb},
                                       {"__schema", "", tiledb}};

// Returns the kind of a folder of arrays that is not Zarr; null for other folders.
const char* other_store(const Path& folder) {
    constexpr std::size_t most_bytes = 4096;
    std::error_code unreadable;
    for (const OtherStore& one : other_stores) {
        if (std::filesystem::exists(folder / one.file, unreadable) &&
            file_beginning(folder / one.file, most_bytes).find(one.word) != std::string::npos)
            return one.name;
    }
    return nullptr;
}

constexpr std::size_t most_of_list = 400;  // bytes of a list of names in a message

// Finds the arrays and images in a folder and its subfolders, of which links can make a number
// without end. Throws Error.
class ArraySearch {
  public:
    // `root`: names are relative to it.
    ArraySearch(const ZarrStore& store, Path root) : store_(store), root_(std::move(root)) {}

    void look_in(const Path& folder, int depth = 0) {
        check_interrupt();
        if (++folders_ > ZarrStore::most_folders || found_.size() >= most_arrays ||
            depth > most_depth) {
            is_cut_ = true;
            return;
        }
        std::error_code in_archive;
        const Path real = std::filesystem::canonical(folder, in_archive);
        // A link may lead back to a folder on the path to it.
        if (!real.empty() && std::ranges::find(above_, real) != above_.end()) return;
        const ZarrNode node = zarr_node(store_, folder);
        if (node.is_array || (depth > 0 && is_ome_image(node))) {
            if (depth > 0)
                found_.emplace_back(node.rank, folder.lexically_relative(root_).string());
            return;
        }
        above_.push_back(real);
        for (const Path& inner : store_.folders_in(folder)) look_in(inner, depth + 1);
        above_.pop_back();
    }

    // Returns the names of those with `least` axes or more.
    std::vector<std::string> names(std::size_t least) const {
        std::vector<std::string> names;
        for (const auto& [rank, name] : found_)
            if (rank >= least) names.push_back(name);
        return names;
    }

    void say_if_cut() const {
        if (!is_cut_) return;
        say("{}: found more than {} folders, {} arrays or {} levels: the rest is not listed",
            root_.string(), ZarrStore::most_folders, most_arrays, most_depth);
    }

  private:
    static constexpr int most_depth = 8;  // levels of folders
    static constexpr std::size_t most_arrays = 1000;

    const ZarrStore& store_;
    Path root_;
    std::vector<Path> above_;  // folders on the path, without links; "" in archives
    std::vector<std::pair<std::size_t, std::string>> found_;  // number of axes, path in the root
    std::size_t folders_ = 0;
    bool is_cut_ = false;
};

// Returns the arrays and images of a group that can be volumes: those of three axes or more, or, if
// there are none, of two. A group that is an image has those of its labels.
std::vector<std::string> volumes_in(const ZarrStore& store, const Path& root) {
    ArraySearch search(store, root);
    const Path labels = root / "labels";
    if (!is_ome_image(zarr_node(store, root)))
        search.look_in(root);
    else if (store.has_header(labels))
        search.look_in(labels);
    search.say_if_cut();
    const std::vector<std::string> names = search.names(3);
    return names.empty() ? search.names(2) : names;
}

// Names a plate or well (OME-Zarr, "plate" and "well" metadata) for messages; "" for other groups.
const char* plate_of(const ZarrNode& node) {
    const Json& attributes = ome_attributes(node);
    if (attributes.contains("plate")) return "it is a plate, of whose fields one is an image: ";
    return attributes.contains("well") ? "it is a well, of whose fields one is an image: " : "";
}

// Returns the image of which an array is a level, or else the array alone.
ZarrImage image_of(const ZarrStore& store, const Path& array) {
    const Path above = array.parent_path();
    std::optional<std::int64_t> level;
    ZarrNode node;
    if (!above.empty() && store.has_header(above)) {
        try {
            node = zarr_node(store, above);
            level = level_of(node, array);
        } catch (const Error& problem) {
            // A client that may read the array may be kept from what lies above it.
            if (!is_restricted()) say("{}: {}", array.string(), problem.what());
        }
    }
    if (level) return read_ome_image(node, level);
    ZarrImage alone;
    alone.folder = array;
    return alone;
}

// Returns the array or image that the request takes of a folder; `axes` is empty for an array. Sets
// `arrays` to those of the folder if it must look for them.
ZarrImage image_in(const ZarrStore& store, const Path& root, const VolumeRequest& request,
                   std::vector<std::string>& arrays) {
    const Path folder = request.array.empty() ? root : root / request.array;
    const ZarrNode node = zarr_node(store, folder);
    if (node.is_array) {
        if (request.level) taken_of(folder.string(), "level", request.level, 1);
        return image_of(store, folder);
    }
    if (is_ome_image(node)) return read_ome_image(node, request.level);
    if (!request.array.empty())
        fail("{}: array: found \"{}\", expected an array of it", root.string(), request.array);
    arrays = volumes_in(store, root);
    if (arrays.empty()) fail("{}: found no array in it", root.string());
    if (arrays.size() > 1) {
        fail("{}: {}found the arrays {}, expected one, as in {}", root.string(), plate_of(node),
             shortened(one_line(fmt::format("{}", fmt::join(arrays, ", "))), most_of_list),
             (root / arrays.front()).string());
    }
    VolumeRequest inner = request;
    inner.array = arrays.front();
    return image_in(store, root, inner, arrays);
}

// Fills in the arrays, if they are not there yet, and the levels with their sizes along the axes
// that are selected.
void list_contents(const ZarrStore& store, const Path& root, const ZarrImage& image,
                   const ArrayPlace& placed, VolumeContents& contents) {
    constexpr std::size_t most_levels = 100;
    if (contents.arrays.empty()) contents.arrays = volumes_in(store, root);
    if (!contents.arrays.empty() && is_ome_image(zarr_node(store, root)))
        contents.arrays.insert(contents.arrays.begin(), "");  // the image itself
    for (const Path& level : image.levels) {
        const ZarrArray array = read_zarr_array(store, level);
        auto& size = contents.levels.emplace_back(std::array<std::int64_t, 3>{1, 1, 1});
        for (std::size_t i = 0; i < 3; ++i) {
            const auto axis = static_cast<std::size_t>(placed.axes[i]);
            if (placed.axes[i] >= 0 && axis < array.shape.size()) size[i] = array.shape[axis];
        }
        if (contents.levels.size() == most_levels) break;
    }
}

// Gives channels the names that the image has for them.
void name_channels(const ZarrImage& image, std::vector<std::string>& channels) {
    if (!image.channels.empty() && image.channels.size() != channels.size()) {
        say("{}: omero: found {} channels, expected {}, as the array has", image.folder.string(),
            image.channels.size(), channels.size());
    }
    for (std::size_t i = 0; i < std::min(channels.size(), image.channels.size()); ++i)
        channels[i] = one_line(image.channels[i]);
}

Volume volume_of(ZarrChunks chunks, const Grid& grid, const VolumeUse& use) {
    const std::string name = chunks.array().folder.string();
    const ValueType stored = chunks.array().type;
    const PackedValues values = zarr_values(chunks.array());
    const bool is_scaled = values.scale() != 1 || values.offset() != 0;
    const bool becomes_float = values.can_be_missing() && values.type() != stored;
    const auto drawn = drawn_type(values.type());
    if (!drawn || is_scaled || becomes_float) {
        expect_room(name, chunks.selected_bytes(), use,
                    is_scaled       ? "its samples are scaled"
                    : becomes_float ? "its missing samples become NaN"
                                    : fmt::format("its samples are of type {}", name_of(stored)));
    } else if (stays_in_files(grid, *drawn, use)) {
        return stored_volume(grid, *drawn, std::make_unique<ZarrSource>(std::move(chunks), values));
    }
    std::shared_ptr<void> samples = zarr_samples(chunks);
    if (values.can_be_missing()) {
        const std::shared_ptr<void> marked =
            filled_memory(static_cast<std::size_t>(grid.sample_count()) * bytes_of(values.type()));
        values.say_missing(values.mark(grid.sample_count(), samples.get(), marked.get()));
        samples = marked;
    }
    return drawn_volume(grid, {name, values.type(), samples, values.scale(), values.offset()},
                        use.lookup);
}

// Leaves an image that does not name its axes those that its array has, and says so.
void fit_axes(ZarrImage& image, const ZarrArray& array) {
    const std::size_t rank = array.shape.size();
    if (image.has_own_axes || rank >= image.axes.size()) return;
    const auto surplus = static_cast<std::ptrdiff_t>(image.axes.size() - rank);
    image.axes.erase(image.axes.begin(), image.axes.begin() + surplus);
    image.steps.erase(image.steps.begin(), image.steps.begin() + surplus);
    image.firsts.erase(image.firsts.begin(), image.firsts.begin() + surplus);
    say("{}: the image does not name its {} axes: the last of t, c, z, y, x are taken",
        array.folder.string(), rank);
}

}  // namespace

std::shared_ptr<void> zarr_samples(const ZarrChunks& chunks) {
    chunks.check_plausible_size();
    const std::size_t bytes = chunks.selected_bytes();
    const std::shared_ptr<void> memory = filled_memory(bytes);
    const auto& size = chunks.size();
    const SampleBox whole{{0, 0, 0}, {size[2], size[1], size[0]}};
    parallel_for(chunks.count(), 1, [&](std::int64_t chunk) {
        chunks.copy(chunks.decoded(chunk), chunk, whole, static_cast<char*>(memory.get()));
    });
    return memory;
}

ZarrNode zarr_node(const ZarrStore& store, const Path& folder) {
    ZarrNode node{.folder = folder};
    const bool is_new = store.has(folder, "zarr.json");
    if (!is_new) node.attributes = zarr_attributes(store, folder);
    node.is_array = store.has(folder, ".zarray");
    if (!is_new && !node.is_array) return node;
    const Path file = folder / (is_new ? "zarr.json" : ".zarray");
    const Json document = store.read_object(file);
    if (is_new) {
        const Json& kind = zarr_member(document, "node_type", file.string());
        node.is_array = kind == "array";
        if (!node.is_array && kind != "group") {
            fail("{}: node_type: found {}, expected \"array\" or \"group\"", file.string(),
                 json_excerpt(kind));
        }
        const Json* const attributes = member_of(document, "attributes");
        if (attributes != nullptr && attributes->is_object()) node.attributes = *attributes;
    }
    const Json* const shape = member_of(document, "shape");
    if (node.is_array && shape != nullptr && shape->is_array()) node.rank = shape->size();
    return node;
}

bool is_zarr(const Path& path) {
    std::error_code unreadable;
    try {
        if (std::filesystem::is_directory(path, unreadable))
            return ZarrStore().has_header(path) || other_store(path) != nullptr;
        if (archive_of(path).empty()) return false;
        const ZarrStore store(path);
        return store.has_header(store.root(path));
    } catch (const Error&) {
        return false;  // no archive, or a damaged one
    }
}

Volume open_zarr(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    if (const char* const other = ZarrStore().has_header(path) ? nullptr : other_store(path))
        fail("{}: found a folder of {}", path.string(), other);
    const ZarrStore store(path);
    const Path root = store.root(path.has_filename() ? path : path.parent_path());
    VolumeContents contents;
    ZarrImage image = image_in(store, root, request, contents.arrays);
    const ZarrArray array = read_zarr_array(store, image.folder);
    fit_axes(image, array);
    if (!image.axes.empty() && image.axes.size() != array.shape.size()) {
        fail("{}: shape: found {} axes, expected {}, as the image has", array.header_name(),
             array.shape.size(), image.axes.size());
    }
    ArrayPlace placed = place_array(describe_zarr(array, image), request, contents);
    if (placed.axes[0] < 0 || placed.axes[1] < 0)
        fail("{}: axes: found no \"y\" and \"x\", expected both", array.folder.string());
    if (use.contents != nullptr) {
        name_channels(image, contents.channels);
        list_contents(store, root, image, placed, contents);
        *use.contents = contents;
    }
    ZarrChunks chunks(array, {{placed.axes[2], placed.axes[1], placed.axes[0]}, placed.index});
    if (chunks.missing() > 0) {
        say("{}: {} of {} chunks are not there: they have the fill value {}", array.folder.string(),
            chunks.missing(), chunks.count(), array.fill_text);
    }
    if (image.is_labels)
        take_for_labels(array.folder.string(), "the OME-Zarr image", use, placed.grid);
    const Volume volume = volume_of(std::move(chunks), placed.grid, use);
    return image.labels.empty() ? volume : with_descriptions(volume, image.labels);
}

std::vector<Path> files_of_zarr(const Path& path) {
    if (const Path archive = archive_of(path); !archive.empty()) return {archive};
    std::vector<Path> files;
    const auto add = [&](const Path& folder) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            check_interrupt();
            std::error_code unreadable;  // a link to itself
            if (entry.is_regular_file(unreadable)) files.push_back(entry.path());
        }
    };
    add(path);
    // An image may name arrays elsewhere.
    if (const ZarrNode node = zarr_node({}, path); is_ome_image(node)) {
        for (const Path& level : read_ome_image(node, 0).levels) {
            const Path inner = level.lexically_relative(path);
            std::error_code absent;
            if ((inner.empty() || *inner.begin() == "..") &&
                std::filesystem::is_directory(level, absent))
                add(level);
        }
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace lamina
