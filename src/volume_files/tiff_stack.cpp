// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff_stack.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/memory.h"
#include "volume_files/folder_files.h"
#include "volume_files/grid_check.h"
#include "volume_files/plain_grid.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"
#include "volume_files/tiff_axes.h"
#include "volume_files/tiff_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t most_pages = 1'000'000;

bool is_tiff(const Path& path) {
    using namespace std::string_view_literals;
    const std::string magic = file_beginning(path, 4);
    return magic == "II*\0"sv || magic == "MM\0*"sv || magic == "II+\0"sv || magic == "MM\0+"sv;
}

std::vector<Path> tiffs_of(const Path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<Path> files = files_in_folder(path);
    std::erase_if(files, [](const Path& file) { return !is_tiff(file); });
    return files;
}

class TiffStack {
  public:
    TiffStack(const Path& path, const VolumeRequest& request)
        : name_(path.string()), files_(tiffs_of(path)) {
        if (files_.empty()) fail("{}: found no TIFF file in the folder", name_);
        list_pages();
        axes_ =
            tiff_axes(name_, description_, static_cast<std::int64_t>(places_.size()), resolution_);
        if (axes_.channels > 1 && page_.samples > 1) {
            fail("{}: found pages for {} channels and {} samples a pixel, expected one of both",
                 name_, axes_.channels, page_.samples);
        }
        channel_ =
            taken_axis(name_, "channel", request.channel, std::max(axes_.channels, page_.samples));
        time_ = taken_axis(name_, "time", request.time, axes_.times);
        const StoredAxis taken[] = {channel_, time_};
        say_taken(name_, taken);
    }

    Grid grid() const {
        Grid grid = plain_grid({page_.width, page_.height, axes_.slices});
        for (int axis = 0; axis < 3; ++axis)
            grid.step[static_cast<std::size_t>(axis)] *= axes_.spacing[axis];
        check_grid(name_, grid, {"resolution", "resolution"});
        return grid;
    }

    StoredSamples read() {
        const StoredAxis sizes[] = {page_.width, page_.height, axes_.slices};
        const std::size_t word = bytes_of(page_.type);
        StoredSamples samples{name_, page_.type, nullptr};
        check_capacity(word);
        samples.bytes = filled_memory(stored_bytes(name_, sizes, word));
        auto* to = static_cast<char*>(samples.bytes.get());
        const bool by_page = axes_.channels > 1;
        const std::int64_t first =
            *time_.taken * axes_.time_step + (by_page ? *channel_.taken * axes_.channel_step : 0);
        for (std::int64_t slice = 0; slice < axes_.slices; ++slice) {
            const Place& place =
                places_[static_cast<std::size_t>(first + slice * axes_.slice_step)];
            open(place.file).go_to_page(place.page, place.offset);
            file_->read(page_, by_page ? 0 : *channel_.taken, to);
            to += static_cast<std::size_t>(page_.width * page_.height) * word;
        }
        return samples;
    }

  private:
    struct Place {
        std::size_t file;
        std::uint32_t page;
        std::uint64_t offset;  // of the page in the file
    };

    // Before memory is taken for all pages.
    void check_capacity(std::size_t word) const {
        const StoredAxis sizes[] = {page_.width, page_.height, page_.samples, std::ssize(places_)};
        const std::size_t bytes = stored_bytes(name_, sizes, word);
        if (bytes <= capacity_) return;
        fail(
            "{}: pages: found {} of {} x {} pixels of {} samples ({} bytes), more than the files "
            "can "
            "hold",
            name_, places_.size(), page_.width, page_.height, page_.samples, bytes);
    }

    TiffFile& open(std::size_t number) {
        if (!file_ || opened_ != number) {
            file_ = std::make_unique<TiffFile>(files_[number]);
            opened_ = number;
        }
        return *file_;
    }

    void list_pages() {
        std::int64_t reduced = 0;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            check_interrupt();
            TiffFile& file = open(i);
            std::uint32_t number = 0;
            std::uint64_t capacity = 0;
            do {
                capacity = std::max(capacity, file.capacity());
                if (file.is_reduced())
                    ++reduced;
                else
                    add_page(file, {i, number, file.place()});
                ++number;
            } while (file.next_page());
            capacity_ += capacity;
        }
        if (places_.empty()) fail("{}: found no page that is not a smaller copy", name_);
        if (reduced > 0)
            warn(fmt::format("{}: {} smaller copies of pages are not used", name_, reduced));
    }

    void add_page(const TiffFile& file, const Place& place) {
        if (places_.size() == most_pages) fail("{}: found more than {} pages", name_, most_pages);
        const TiffPage page = file.page();
        if (places_.empty()) {
            page_ = page;
            description_ = file.description();
            resolution_ = {file.resolution(0), file.resolution(1)};
        } else if (!(page == page_)) {
            fail(
                "{}: page {}: found {} x {} pixels of {} {} samples, expected {} x {} of {} {} as "
                "on "
                "the first page",
                file.name(), place.page + 1, page.width, page.height, page.samples,
                name_of(page.type), page_.width, page_.height, page_.samples, name_of(page_.type));
        }
        places_.push_back(place);
    }

    std::string name_;
    std::vector<Path> files_;
    std::vector<Place> places_;
    TiffPage page_;  // of every place
    std::string description_;
    std::array<double, 2> resolution_{};
    std::uint64_t capacity_ = 0;  // of all files, in bytes of samples
    TiffAxes axes_;
    StoredAxis channel_, time_;
    std::unique_ptr<TiffFile> file_;
    std::size_t opened_ = 0;
};

}  // namespace

bool is_tiff_stack(const Path& path) {
    if (!std::filesystem::is_directory(path)) return is_tiff(path);
    return std::ranges::any_of(files_in_folder(path), is_tiff);
}

Volume read_tiff_stack(const Path& path, const VolumeRequest& request) {
    TiffStack stack(path, request);
    return drawn_volume(stack.grid(), stack.read());
}

std::vector<Path> files_of_tiff_stack(const Path& path) {
    return tiffs_of(path);
}

}  // namespace lamina
