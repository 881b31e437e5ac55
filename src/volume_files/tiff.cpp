// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <algorithm>
#include <bit>
#include <glm/vec3.hpp>
#include <map>
#include <set>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "volume_files/isolated_process.h"
#include "volume_files/numbered_files.h"
#include "volume_files/tiff_description.h"
#include "volume_files/tiff_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t most_pages = 1'000'000;

bool has_tiff_mark(const Path& path) {
    using namespace std::string_view_literals;
    const std::string magic = file_beginning(path, 4);
    return magic == "II*\0"sv || magic == "MM\0*"sv || magic == "II+\0"sv || magic == "MM\0+"sv;
}

// Returns OME's XML for a file's description, which may leave it to another file.
std::string ome_xml(const Path& file, const std::string& description) {
    const std::string metadata = files_of_ome(description).metadata;
    if (metadata.empty()) return description;
    const Path path = file.parent_path() / metadata;
    expect_named_file(path, fmt::format("metadata file of {}", file.string()));
    return has_tiff_mark(path) ? TiffFile(path).beginning().description : read_file_bytes(path);
}

// The pages of a TIFF file, of the TIFF files in a folder, or of an OME data set, as a volume.
class TiffStack {
  public:
    TiffStack(const Path& path, const VolumeRequest& request)
        : path_(path), name_(path.string()), files_(known_files_in(path, has_tiff_mark)) {
        if (files_.empty()) fail("{}: found no TIFF file in the folder", name_);
        const TiffBeginning first = beginning();
        is_colour_ = first.is_colour;
        if (is_ome(first.description)) {
            take_ome(first, request.array);
        } else {
            if (!request.array.empty())
                fail("{}: array: expected no such key: the file is no OME-TIFF", name_);
            take_pages(first);
        }
        open(0).go_to(page_);
        file_->check_tags(!found_.unit.empty() || found_.spacing != glm::dvec3(1));
        if (is_colour_) say("{}: its pixels are colours, which are read as channels", name_);
        take_axes(request);
        list_planes();
    }

    Volume volume(const VolumeUse& use) {
        if (use.contents != nullptr) *use.contents = contents();
        const std::size_t bytes = stored_bytes(name_, sizes(), bytes_of(type_));
        StoredSamples samples{name_, type_, nullptr, found_.scale, found_.shift};
        if (const std::optional<StoredData> data = is_behind_ ? data_behind() : data_in_a_row()) {
            if (!is_behind_) say_taken(name_, taken_);  // else reading the data says it
            if (!page_.is_half()) return open_stored(grid(), *data, use);
            expect_room(name_, 2 * bytes, use, "its samples are floats of 16 bits");
            samples = read_stored(*data);
        } else {
            expect_room(name_, bytes, use, "its pages are packed, or do not lie in a row");
            say_taken(name_, taken_);
            samples.bytes = are_raw() ? read_as_they_are(bytes) : decoded(bytes);
        }
        const Grid there = grid();
        return drawn_volume(
            there, page_.is_half() ? widened_halves(samples, there.sample_count()) : samples,
            use.lookup);
    }

  private:
    using Page = TiffDescription::Page;
    // An image of a page, and its sample.
    struct Plane {
        std::size_t file;
        TiffPage page;
        std::int64_t sample, image;
    };

    TiffFile& open(std::size_t number) {
        if (!file_ || opened_ != number) {
            if (found_.writer == "OME")
                expect_named_file(files_[number],
                                  fmt::format("file of the OME data set of {}", name_));
            file_ = std::make_unique<TiffFile>(files_[number]);
            opened_ = number;
        }
        return *file_;
    }

    // Lists the pages of a file when they are needed.
    const std::vector<TiffPage>& pages_of(std::size_t number) {
        const auto [known, is_new] = pages_of_.try_emplace(number);
        std::vector<TiffPage>& pages = known->second;
        if (!is_new) return pages;
        TiffFile& file = open(number);
        file.go_to_first();
        std::uint64_t most = 0;
        do {
            check_interrupt();
            if (++listed_ > most_pages) fail("{}: found more than {} pages", name_, most_pages);
            most = std::max(most, file.capacity());
            pages.push_back(file.page());
        } while (file.next_page());
        capacity_ += most;
        return pages;
    }

    // Reads the first page that is no smaller copy.
    TiffBeginning beginning() {
        TiffBeginning first;
        const std::vector<TiffPage>& pages = pages_of(0);
        const auto full = std::ranges::find_if(pages, [](auto& page) { return !page.is_reduced; });
        if (full == pages.end()) fail("{}: found no page that is not a smaller copy", name_);
        page_ = *full;
        open(0).go_to(page_);
        first = open(0).beginning();
        first.pages = std::ranges::count_if(pages, [](auto& page) { return !page.is_reduced; });
        return first;
    }

    void take_ome(TiffBeginning first, const std::string& image) {
        const Path folder = files_[0].parent_path();
        first.description = ome_xml(files_[0], first.description);
        const std::string own = files_[0].filename().string();
        std::size_t counted = 0;  // pages of all other files
        found_ = ome_description(first, own, image, [&](const std::string& name) {
            if (name == own) return std::ssize(pages_of(0));
            expect_allowed(folder / name);
            TiffFile file(folder / name);
            std::int64_t count = 1;
            for (; file.next_page(); ++count) {
                check_interrupt();
                if (++counted > most_pages)
                    fail("{}: found more than {} pages in its files", name_, most_pages);
            }
            return count;
        });
        const std::vector<Path> there = std::move(files_);
        std::vector<std::string> missing;
        files_.clear();
        for (const std::string& file : found_.files) {
            files_.push_back(folder / file);
            std::error_code unknown;
            if (!std::filesystem::exists(files_.back(), unknown))
                missing.push_back(files_.back().string());
        }
        if (!missing.empty())
            say("{}: no such file: {} of the {} files that {} names, which have some of the "
                "planes, "
                "are missing",
                missing[0], missing.size(), files_.size(), name_);
        const std::set<Path> known(files_.begin(), files_.end());
        for (const Path& file : there) {
            if (!known.contains(file))
                fail(
                    "{}: found several OME data sets, expected one: name one of the files, such as "
                    "{}",
                    name_, file.string());
        }
        if (!found_.type.empty() && found_.type != page_.type_text() && !page_.is_half())
            say("{}: Type is {}, the samples of pages are {}, which counts", name_,
                one_line(found_.type), page_.type_text());
    }

    void take_pages(const TiffBeginning& first) {
        warn_of_series(name_, "TIFF", files_);
        found_ = tiff_description(first);
        std::int64_t reduced = 0;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            for (const TiffPage& page : pages_of(i)) {
                reduced += page.is_reduced;
                if (!page.is_reduced) found_.pages.push_back({static_cast<int>(i), page.number});
            }
        }
        if (reduced > 0) say("{}: {} smaller copies of pages are not used", name_, reduced);
        if (files_.size() > 1) add_files(first.pages);
        fit_pages();
    }

    // Takes the files of a folder for slices or, if each has slices, for an axis without a name.
    void add_files(std::int64_t pages_each) {
        const auto z = std::ranges::find(found_.axes, 'Z', &TiffAxis::letter);
        std::vector<std::int64_t> pages(files_.size());
        for (const Page& page : found_.pages) ++pages[static_cast<std::size_t>(page.file)];
        const bool as_many =
            std::ranges::all_of(pages, [&](std::int64_t count) { return count == pages_each; });
        if (found_.writer.empty() && (z->size == 1 || !as_many)) {
            if (!as_many)
                say("{}: its files have different numbers of pages: all are taken for slices, one "
                    "file behind the other",
                    name_);
            z->size = page_.depth * std::ssize(found_.pages);
            return;
        }
        if (!as_many)
            fail("{}: found {} pages in {} files, expected {} in each, as in the first", name_,
                 found_.pages.size(), files_.size(), pages_each);
        const bool has_slices = z != found_.axes.end() && z->size > 1;
        // An axis of one channel would take the request that chooses a file.
        std::erase_if(found_.axes, [](const TiffAxis& axis) { return axis.size == 1; });
        found_.axes.push_back({has_slices ? '?' : 'Z', std::ssize(files_)});
    }

    // Throws Error unless there are as many planes as the description has, or one page in front of
    // them (ImageJ above 4 GB, tifffile's "truncated", images of a page in strips).
    void fit_pages() {
        std::vector<StoredAxis> axes;
        for (const TiffAxis& axis : found_.axes) axes.emplace_back(axis.size);
        const std::size_t planes = stored_bytes(name_, axes, 1);
        const auto each = static_cast<std::size_t>(page_.samples * page_.depth);
        const std::size_t pages = found_.pages.size();
        is_behind_ = pages == 1 && (planes > each || (page_.depth > 1 && !open(0).is_tiled()));
        if (is_behind_ || planes == pages * each) return;
        if (found_.writer == "tifffile" && planes < pages * each && planes % each == 0) {
            found_.pages.resize(planes / each);
            say("{}: found {} pages, of which tifffile's description has {}: the others "
                "are not used",
                name_, pages, found_.pages.size());
            return;
        }
        const auto size = [&](char letter) {
            const auto axis = std::ranges::find(found_.axes, letter, &TiffAxis::letter);
            return axis == found_.axes.end() ? 1 : axis->size;
        };
        fail("{}: found {} pages, {}'s description has {} channels, {} slices and {} times", name_,
             pages, found_.writer, size('C'), size('Z'), size('T'));
    }

    void take_axes(const VolumeRequest& request) {
        std::map<std::string_view, int> axes_of;
        for (const TiffAxis& axis : found_.axes) {
            if (axis.letter == 'Z') slices_ *= axis.size;
            taken_.push_back(axis.letter == 'Z' ? StoredAxis(axis.size)
                             : axis.letter == 'C'
                                 ? taken_axis(name_, "channel", request.channel, axis.size)
                             : axis.letter == 'T'
                                 ? taken_axis(name_, "time", request.time, axis.size)
                                 : unnamed_axis(name_, request.channel, request.time, axis.size));
            if (axis.size > 1 && ++axes_of[taken_.back().what] > 1)
                fail("{}: found two axes of {}s, expected one", name_,
                     axis.letter == 'Z' ? "slice" : taken_.back().what);
        }
        if (axes_of["channel"] == 0) taken_axis(name_, "channel", request.channel, 1);
        if (axes_of["time"] == 0) taken_axis(name_, "time", request.time, 1);
    }

    // Finds the plane of each slice. Planes are numbered as their axes run, in each page samples
    // before images.
    void list_planes() {
        type_ = page_.type(name_);
        if (is_behind_) return;
        // Pages may say any depth, and packed pixels any number of samples.
        constexpr std::int64_t most_slices = most_pages;
        if (slices_ > most_slices)
            fail("{}: found {} slices, expected up to {}", name_, slices_, most_slices);
        for (std::int64_t slice = 0; slice < slices_; ++slice) {
            std::int64_t number = 0, step = 1;
            for (const StoredAxis& axis : taken_) {
                number += step * axis.taken.value_or(axis.size == slices_ ? slice : 0);
                step *= axis.size;
            }
            const std::int64_t each = page_.samples * page_.depth;
            const Page& at = found_.pages[static_cast<std::size_t>(number / each)];
            if (at.file < 0)
                fail(
                    "{}: slice {} of channel {}, time {} has no page: TiffData does not mention it",
                    name_, slice, taken_index("channel"), taken_index("time"));
            const auto file = static_cast<std::size_t>(at.file);
            const std::vector<TiffPage>& pages = pages_of(file);
            if (at.number >= pages.size())
                fail("{}: IFD: found {}, expected up to {}: {} has {} pages", name_, at.number,
                     pages.size() - 1, files_[file].string(), pages.size());
            const TiffPage& page = pages[at.number];
            if (slice == 0 && found_.writer == "OME") {
                const bool fits = found_.size == std::array{page.width, page.height} &&
                                  page.samples == page_.samples && page.depth == page_.depth;
                if (!fits)
                    fail(
                        "{}: found pages of {} x {} pixels of {} samples, expected OME's SizeX and "
                        "SizeY, {} x {}, of {}",
                        name_, page.width, page.height, page.samples, found_.size[0],
                        found_.size[1], page_.samples);
                page_ = page;
                type_ = page.type(name_);
            }
            if (!page.is_like(page_))
                fail(
                    "{}: page {}: found {} x {} pixels of {} {} samples, expected {} x {} of {} {} "
                    "as on the first page",
                    files_[file].string(), page.number + 1, page.width, page.height, page.samples,
                    page.type_text(), page_.width, page_.height, page_.samples, page_.type_text());
            planes_.push_back(
                {file, page, number % page_.samples, number / page_.samples % page_.depth});
        }
        check_capacity();
    }

    std::int64_t taken_index(std::string_view what) const {
        const auto axis = std::ranges::find(taken_, what, &StoredAxis::what);
        return axis == taken_.end() ? 0 : axis->taken.value_or(0);
    }

    // Throws Error unless the files can hold all pages, before memory is taken.
    void check_capacity() const {
        std::int64_t pages = 0;
        for (std::size_t i = 0; i < planes_.size(); ++i)
            pages += i == 0 || planes_[i].file != planes_[i - 1].file ||
                     planes_[i].page.number != planes_[i - 1].page.number;
        const StoredAxis sizes[] = {page_.width, page_.height, page_.samples, page_.depth, pages};
        const std::size_t bytes = stored_bytes(name_, sizes, bytes_of(type_));
        if (bytes <= capacity_) return;
        fail(
            "{}: pages: found {} of {} x {} pixels of {} samples ({} bytes), more than the files "
            "can hold",
            name_, pages, page_.width, page_.height, page_.samples, bytes);
    }

    std::array<StoredAxis, 3> sizes() const { return {page_.width, page_.height, slices_}; }

    Grid grid() const {
        Grid grid = plain_grid({page_.width, page_.height, slices_});
        for (int axis = 0; axis < 3; ++axis)
            grid.step[static_cast<std::size_t>(axis)] *= found_.spacing[axis];
        if (slices_ == 1 && !found_.says_thickness)
            grid.step[2] = slice_step(grid.step[0], grid.step[1]);
        grid.origin = found_.origin;
        grid.unit = unit_word(found_.unit);
        if (found_.writer == "OME") grid.axes = WorldAxes::named;
        check_grid(name_, grid, {"resolution", "resolution"});
        return grid;
    }

    VolumeContents contents() const {
        VolumeContents contents;
        contents.arrays = found_.images;
        contents.is_colour = is_colour_;
        for (std::size_t i = 0; i < taken_.size(); ++i) {
            if (!taken_[i].taken || taken_[i].size == 1) continue;
            const bool is_channel = std::string_view(taken_[i].what) == "channel";
            std::vector<std::string>& names = is_channel ? contents.channels : contents.times;
            names = found_.axes[i].names;
            if (is_channel && is_colour_ && names.empty())
                names = {"red", "green", "blue", "alpha"};
            names.resize(static_cast<std::size_t>(taken_[i].size));
        }
        return contents;
    }

    // Tells if all planes lie in the files as they are. A page of several images says in strips
    // where the first is.
    bool are_raw() const {
        return page_.depth == 1 && std::ranges::all_of(planes_, [](const Plane& each) {
                   return each.page.raw.has_value();
               });
    }

    // Reads planes that lie in the files as they are, whose samples take `bytes` bytes.
    std::shared_ptr<void> read_as_they_are(std::size_t bytes) {
        std::shared_ptr<void> samples = filled_memory(bytes);
        auto* to = static_cast<char*>(samples.get());
        const std::size_t plane = bytes / planes_.size();
        const std::int64_t together = page_.planar ? 1 : page_.samples;
        ByteBuffer pixels(together > 1 ? plane * static_cast<std::size_t>(together) : 0);
        std::optional<RandomAccessFile> file;
        std::optional<std::size_t> opened;
        for (const Plane& each : planes_) {
            check_interrupt();
            if (opened != each.file) file.emplace(files_[each.file]);
            opened = each.file;
            if (together > 1) {
                const StoredAxis axes[] = {{together, each.sample}, page_.width * page_.height};
                file->read(*each.page.raw, pixels.data(), pixels.size());
                take_of_memory(pixels.data(), axes, bytes_of(type_), to);
            } else {
                file->read(*each.page.raw + static_cast<std::size_t>(each.sample) * plane, to,
                           plane);
            }
            if (each.page.is_big_endian != (std::endian::native == std::endian::big))
                swap_bytes(to, page_.width * page_.height, bytes_of(type_));
            to += plane;
        }
        return samples;
    }

    // Decodes the planes, whose samples take `bytes` bytes.
    std::shared_ptr<void> decoded(std::size_t bytes) {
        file_.reset();  // all processes would move its place
        const std::size_t plane = bytes / planes_.size();
        const auto each_pixel = static_cast<std::size_t>(page_.samples);
        // A tile may have all images of a page.
        const std::size_t largest = plane * each_pixel * static_cast<std::size_t>(page_.depth);
        return isolated_bytes(name_, "libtiff", bytes, bytes * each_pixel, largest, planes_.size(),
                              [&](std::size_t first, std::size_t end, char* to) {
                                  for (std::size_t i = first; i < end; ++i) {
                                      const Plane& each = planes_[i];
                                      open(each.file).go_to(each.page);
                                      file_->read(each.page, each.sample, each.image,
                                                  to + i * plane);
                                  }
                              });
    }

    // Describes planes that lie in a file one after another, as raw data do; else returns nothing.
    std::optional<StoredData> data_in_a_row() const {
        if (!are_raw() || (page_.samples > 1 && !page_.planar)) return {};
        const std::size_t plane = stored_bytes(name_, sizes(), bytes_of(type_)) / planes_.size();
        const auto place = [&](const Plane& each) {
            return *each.page.raw + static_cast<std::size_t>(each.sample) * plane;
        };
        const std::uint64_t begin = place(planes_[0]);
        for (std::size_t i = 0; i < planes_.size(); ++i)
            if (planes_[i].file != planes_[0].file || place(planes_[i]) != begin + i * plane)
                return {};
        StoredData data = raw_data(planes_[0].file, planes_[0].page);
        data.axes = {page_.width, page_.height, slices_};
        place_raw(data, begin);
        return data;
    }

    // Describes planes that lie behind the first page's header, one after another.
    StoredData data_behind() {
        if (!page_.raw)
            fail(
                "{}: found 1 page of several planes, whose samples are not in one piece and "
                "uncompressed, expected a page for each plane",
                name_);
        StoredData data = raw_data(0, page_);
        data.axes = taken_;
        const bool together = page_.samples > 1 && !page_.planar;
        const StoredAxis plane[] = {page_.width, page_.height};
        data.axes.insert(data.axes.begin() + together, std::begin(plane), std::end(plane));
        data.byte_skip = static_cast<std::int64_t>(*page_.raw);
        return data;
    }

    // Describes samples of a file that begin in a page, but for their axes and place.
    StoredData raw_data(std::size_t file, const TiffPage& page) const {
        StoredData data;
        data.path = path_;
        data.teller = "the description";
        data.type = type_;
        set_byte_order(data, page.is_big_endian);
        data.files = {files_[file]};
        data.scale = found_.scale;
        data.shift = found_.shift;
        return data;
    }

    Path path_;
    std::string name_;
    std::vector<Path> files_;
    std::map<std::size_t, std::vector<TiffPage>> pages_of_;  // by the file's number
    std::size_t listed_ = 0;
    std::uint64_t capacity_ = 0;  // bytes of samples that the listed files can hold
    TiffPage page_;               // which all that are used are like
    ValueType type_ = ValueType::uint8;
    TiffDescription found_;
    bool is_colour_ = false, is_behind_ = false;
    std::vector<StoredAxis> taken_;  // those of `found_`
    std::int64_t slices_ = 1;
    std::vector<Plane> planes_;  // of the slices
    std::unique_ptr<TiffFile> file_;
    std::size_t opened_ = 0;
};

}  // namespace

bool is_tiff(const Path& path) {
    if (!std::filesystem::is_directory(path)) return has_tiff_mark(path);
    return std::ranges::any_of(files_in_folder(path), has_tiff_mark);
}

Volume open_tiff(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    return TiffStack(path, request).volume(use);
}

std::vector<Path> files_of_tiff(const Path& path) {
    std::vector<Path> files = known_files_in(path, has_tiff_mark);
    if (files.empty()) return files;
    const std::string description = TiffFile(files[0]).beginning().description;
    if (!is_ome(description)) return files;
    const Path folder = files[0].parent_path();
    OmeFiles named = files_of_ome(ome_xml(files[0], description));
    named.planes.insert(files_of_ome(description).metadata);
    named.planes.erase("");
    for (const std::string& name : named.planes)
        if (std::ranges::find(files, folder / name) == files.end()) files.push_back(folder / name);
    return files;
}

}  // namespace lamina
