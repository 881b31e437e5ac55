// SPDX-License-Identifier: Apache-2.0
#include "volume_files/vtk_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina {
namespace {

using VtkSize = std::array<std::int64_t, 3>;

// Upper bound on the bytes that one byte decompresses to: LZMA, the densest, reaches some 7000.
constexpr std::size_t most_vtk_expansion = 32768;

// Largest deviations of coordinates from even steps: the last digit of float32, relative to the
// largest coordinate; or the sixth digit, which is the last of VTK's text, if it is below a
// hundredth of a step.
constexpr double float_digits = 1.2e-7, text_digits = 5e-6, share_of_step = 0.01;

VtkSize size_of(const VtkExtent& extent, bool of_cells) {
    VtkSize size{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t cells = extent.last[axis] - extent.first[axis];
        size[axis] = of_cells ? std::max<std::int64_t>(cells, 1) : cells + 1;
    }
    return size;
}

std::size_t place_on(const VtkSize& size, std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>(x + size[0] * (y + size[1] * z));
}

std::size_t count_on(const VtkSize& size) {
    return static_cast<std::size_t>(size[0] * size[1] * size[2]);
}

// Returns for each point if any (or all) of its cells are marked, or for each cell if any (or all)
// of its corners are. `marks`: of the lattice of cells or points, whose size is `from`.
std::vector<char> marks_of_neighbours(const std::vector<char>& marks, const VtkSize& from,
                                      const VtkSize& to, bool to_points, bool all) {
    std::vector<char> result;
    result.reserve(count_on(to));
    const auto near = [&](std::int64_t at, std::size_t axis) {
        const std::int64_t low = to_points ? at - 1 : at;
        return std::array{std::max<std::int64_t>(low, 0), std::min(low + 1, from[axis] - 1)};
    };
    for (std::int64_t z = 0; z < to[2]; ++z)
        for (std::int64_t y = 0; y < to[1]; ++y)
            for (std::int64_t x = 0; x < to[0]; ++x) {
                char any = 0, each = 1;
                for (const std::int64_t k : near(z, 2))
                    for (const std::int64_t j : near(y, 1))
                        for (const std::int64_t i : near(x, 0)) {
                            const char mark = marks[place_on(from, i, j, k)];
                            any |= mark;
                            each &= mark;
                        }
                result.push_back(all ? each : any);
            }
    return result;
}

bool is_ghost_array(const VtkImageArray& array) {
    return array.name == "vtkGhostType" || array.name == "vtkGhostLevels";
}

// Returns the step of even coordinates. Throws Error if they are uneven.
double even_step(const std::string& file, char axis, const std::vector<double>& places) {
    const std::size_t steps = places.size() - 1;
    if (steps == 0) return 1;
    const double step = (places.back() - places.front()) / static_cast<double>(steps);
    const double largest = std::max(std::abs(places.front()), std::abs(places.back()));
    const double most = std::max(float_digits * largest,
                                 std::min(text_digits * largest, share_of_step * std::abs(step)));
    double worst = 0;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double off = std::abs(places[i] - (places[0] + static_cast<double>(i) * step));
        worst = std::max(worst, off);
        if (off <= most) continue;
        fail(
            "{}: {} coordinates: found {}, {:.3g} from even steps of {:.6g}, expected even steps: "
            "ParaView's filter Resample To Image makes image data of the grid",
            file, axis, places[i], off, step);
    }
    if (worst > 1e-3 * std::abs(step)) {
        say("{}: {} coordinates: steps are taken as {:.6g} each, which moves samples "
            "by up to {:.2g}",
            file, axis, step, worst);
    }
    return step;
}

class VtkImage {
  public:
    VtkImage(const VtkImageHead& head, const VolumeRequest& request, const VolumeUse& use)
        : head_(head), request_(request), use_(use) {}

    void add(const VtkImagePart& part) {
        check_interrupt();
        if (done_.empty()) {
            choose_array(part);
            if (head_.geometry) grid_ = grid();
        }
        put(part, samples_of(part));
        for (const bool of_cells : {false, true}) add_ghosts(part, of_cells);
        if (!head_.geometry) set_coordinates(part);
        done_.push_back(part.extent);
    }

    Volume finish() {
        const std::int64_t missing = std::ranges::count(found_, false);
        if (missing > 0) {
            fail("{}: its pieces have {} of {} samples", head_.file, std::ssize(found_) - missing,
                 found_.size());
        }
        if (!head_.geometry) grid_ = grid();
        return without_hidden(drawn_volume(grid_, all_, use_.lookup)).measuring({array_.name, ""});
    }

  private:
    // Chooses the request's array, else the one that the file calls its scalars, else the first.
    void choose_array(const VtkImagePart& part) {
        std::vector<const VtkImageArray*> offered;
        for (const VtkImageArray& array : part.arrays) {
            // VTK's own: vtkGhostType, vtkValidPointMask, vtkOriginalPointIds, ...
            const bool about_samples = array.name.starts_with("vtk");
            if (!about_samples || array.name == request_.array) offered.push_back(&array);
        }
        if (offered.empty())
            fail("{}: no array of numbers in PointData and CellData (bits and text are not read)",
                 head_.file);
        const std::string& name = request_.array.empty() ? part.scalars : request_.array;
        auto found = std::ranges::find(offered, name, &VtkImageArray::name);
        if (found == offered.end() && !request_.array.empty()) {
            std::string list;
            for (const VtkImageArray* one : offered)
                list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", one_line(one->name));
            fail("{}: array: found \"{}\", expected one of {}", head_.file, one_line(name), list);
        }
        if (found == offered.end()) found = offered.begin();
        array_ = **found;
        if (request_.array.empty() && offered.size() > 1) {
            say("{}: array \"{}\" of {} is taken: {}", head_.file, one_line(array_.name),
                offered.size(), names_another("array", "NAME"));
        }
        if (use_.contents == nullptr) return;
        for (const VtkImageArray* one : offered) use_.contents->arrays.push_back(one->name);
        if (array_.components == 1) return;
        use_.contents->channels = array_.component_names;
        use_.contents->channels.resize(static_cast<std::size_t>(array_.components));
    }

    // Returns the samples of one component.
    StoredSamples samples_of(const VtkImagePart& part) const {
        const std::string what = fmt::format("{}: '{}'", head_.file, one_line(array_.name));
        const auto array = std::ranges::find_if(part.arrays, [&](const VtkImageArray& one) {
            return one.name == array_.name && one.of_cells == array_.of_cells;
        });
        if (array == part.arrays.end()) fail("{}: not in every piece", what);
        const VtkSize size = size_of(part.extent, array_.of_cells);
        std::vector<StoredAxis> axes{size[0], size[1], size[2]};
        const auto count = static_cast<std::int64_t>(stored_bytes(what, axes, 1));
        const auto values = std::make_shared<VtkXmlValues>(part.values(*array, count, what));
        StoredSamples samples{what, values->type, nullptr};
        const StoredAxis channel = taken_axis(what, "channel", request_.channel, array->components);
        if (channel.size == 1) {
            samples.bytes = std::shared_ptr<void>(values, values->bytes.data());
            return samples;
        }
        axes.insert(axes.begin(), channel);
        if (done_.empty()) say_taken(what, axes);
        // VTK takes three or four bytes a sample for colours (vtkScalarsToColors::MapScalars).
        if (use_.contents != nullptr && values->type == ValueType::uint8)
            use_.contents->is_colour = channel.size == 3 || channel.size == 4;
        const std::size_t word = bytes_of(values->type);
        samples.bytes = filled_memory(stored_bytes(what, axes, word, true));
        take_of_memory(values->bytes.text().data(), axes, word,
                       static_cast<char*>(samples.bytes.get()));
        return samples;
    }

    // Calls put(place in the whole image, place in the part, samples) for the rows of a part that
    // lie in the whole image.
    template <typename Put>
    void for_rows(const VtkExtent& extent, bool of_cells, const Put& put) const {
        const VtkSize size = size_of(head_.whole, of_cells), mine = size_of(extent, of_cells);
        VtkSize from{}, to{}, shift{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            shift[axis] = extent.first[axis] - head_.whole.first[axis];
            from[axis] = std::max<std::int64_t>(0, -shift[axis]);
            to[axis] = std::min(mine[axis], size[axis] - shift[axis]);
        }
        if (from[0] >= to[0]) return;
        for (std::int64_t z = from[2]; z < to[2]; ++z)
            for (std::int64_t y = from[1]; y < to[1]; ++y)
                put(place_on(size, from[0] + shift[0], y + shift[1], z + shift[2]),
                    place_on(mine, from[0], y, z), static_cast<std::size_t>(to[0] - from[0]));
    }

    void put(const VtkImagePart& part, const StoredSamples& samples) {
        if (!all_.bytes && part.extent == head_.whole) {
            all_ = samples;
            return;
        }
        const std::size_t word = bytes_of(samples.type);
        if (!all_.bytes) {
            const VtkSize size = size_of(head_.whole, array_.of_cells);
            const StoredAxis axes[] = {size[0], size[1], size[2]};
            if (stored_bytes(head_.file, axes, 1) / most_vtk_expansion > head_.bytes) {
                fail("{}: WholeExtent: found {} x {} x {} samples, more than {} bytes can hold",
                     head_.file, size[0], size[1], size[2], head_.bytes);
            }
            all_ = {samples.file, samples.type,
                    filled_memory(stored_bytes(head_.file, axes, word))};
            found_.resize(count_on(size));
        }
        if (samples.type != all_.type) {
            fail("{}: found {} and {} in its pieces, expected one type", samples.file,
                 name_of(all_.type), name_of(samples.type));
        }
        for_rows(part.extent, array_.of_cells,
                 [&](std::size_t to, std::size_t from, std::size_t count) {
                     std::memcpy(static_cast<char*>(all_.bytes.get()) + to * word,
                                 static_cast<const char*>(samples.bytes.get()) + from * word,
                                 count * word);
                     if (!found_.empty())
                         std::fill_n(found_.begin() + static_cast<std::ptrdiff_t>(to), count, true);
                 });
    }

    // Returns which points or cells the ghost arrays of a part hide; empty if it has none.
    std::vector<char> ghosts_of(const VtkImagePart& part, bool of_cells) const {
        std::vector<char> ghosts;
        for (const VtkImageArray& array : part.arrays) {
            if (!is_ghost_array(array) || array.of_cells != of_cells) continue;
            const bool levels = array.name == "vtkGhostLevels";  // above 0: another piece's
            if (levels && !of_cells) continue;
            ghosts.resize(count_on(size_of(part.extent, of_cells)));
            const std::string what = fmt::format("{}: '{}'", head_.file, array.name);
            const VtkXmlValues values = part.values(array, std::ssize(ghosts), what);
            if (values.type != ValueType::uint8 || array.components != 1)
                fail("{}: found {}, expected uint8, one a point or cell", what,
                     name_of(values.type));
            const int hiding = levels ? 255 : of_cells ? vtk_hidden_cell : vtk_hidden_point;
            for (std::size_t i = 0; i < ghosts.size(); ++i)
                ghosts[i] |= (static_cast<unsigned char>(values.bytes.text()[i]) & hiding) != 0;
        }
        return ghosts;
    }

    // Hides what every part hides that has it: a cell may be the ghost of another part's.
    void add_ghosts(const VtkImagePart& part, bool of_cells) {
        std::vector<char>& all = hidden_[of_cells ? 1 : 0];
        const std::vector<char> mine = ghosts_of(part, of_cells);
        if (mine.empty() && all.empty()) return;
        if (all.empty()) {
            all.assign(count_on(size_of(head_.whole, of_cells)), 1);
            for (const VtkExtent& extent : done_) {
                for_rows(extent, of_cells, [&](std::size_t to, std::size_t, std::size_t count) {
                    std::memset(all.data() + to, 0, count);
                });
            }
        }
        for_rows(part.extent, of_cells, [&](std::size_t to, std::size_t from, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i)
                all[to + i] &= mine.empty() ? char{0} : mine[from + i];
        });
    }

    void set_coordinates(const VtkImagePart& part) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double>& all = coordinates_[axis];
            all.resize(static_cast<std::size_t>(size_of(head_.whole, false)[axis]));
            std::int64_t at = part.extent.first[axis] - head_.whole.first[axis];
            for (const double place : part.coordinates[axis]) {
                if (at >= 0 && at < std::ssize(all)) all[static_cast<std::size_t>(at)] = place;
                ++at;
            }
        }
    }

    Grid grid() const {
        const VtkExtent& whole = head_.whole;
        Grid grid = plain_grid(size_of(whole, array_.of_cells));
        VtkGeometry places = head_.geometry.value_or(VtkGeometry{});
        for (std::size_t axis = 0; axis < 3 && !head_.geometry; ++axis) {
            places.spacing[axis] = even_step(head_.file, "xyz"[axis], coordinates_[axis]);
            places.origin[axis] = coordinates_[axis][0] -
                                  static_cast<double>(whole.first[axis]) * places.spacing[axis];
        }
        grid.origin = {places.origin[0], places.origin[1], places.origin[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& turn = places.direction;
            grid.step[axis] =
                places.spacing[axis] * glm::dvec3(turn[axis], turn[axis + 3], turn[axis + 6]);
            // On an axis with a single point, the cells lie at that point.
            const bool between = array_.of_cells && whole.first[axis] != whole.last[axis];
            if (array_.of_cells) grid.centering[axis] = Centering::cell;
            grid.origin +=
                (static_cast<double>(whole.first[axis]) + (between ? 0.5 : 0.0)) * grid.step[axis];
        }
        check_grid(head_.file, grid, {"Direction", "Origin"});
        return grid;
    }

    // Returns which samples are hidden. Empty if no part has a ghost array. A cell with a hidden
    // corner is hidden. Points hide all cells that they touch, so they are marked if all of these
    // are hidden; a layer of hidden cells that is one cell thick then still has cells without such
    // a corner: all corners of these are marked.
    std::vector<char> hidden_samples() const {
        std::vector<char> points = hidden_[0], cells = hidden_[1];
        if (points.empty() && cells.empty()) return {};
        const VtkSize point_size = size_of(head_.whole, false);
        const VtkSize cell_size = size_of(head_.whole, true);
        points.resize(count_on(point_size));
        cells.resize(count_on(cell_size));
        const auto join = [](std::vector<char>& marks, const std::vector<char>& more) {
            for (std::size_t i = 0; i < marks.size(); ++i) marks[i] |= more[i];
        };
        const auto corners = [&] {
            return marks_of_neighbours(points, point_size, cell_size, false, false);
        };
        if (array_.of_cells) {
            join(cells, corners());
            return cells;
        }
        join(points, marks_of_neighbours(cells, cell_size, point_size, true, true));
        const std::vector<char> done = corners();
        for (std::size_t i = 0; i < cells.size(); ++i) cells[i] &= done[i] == 0;
        if (std::ranges::count(cells, 1) == 0) return points;
        join(points, marks_of_neighbours(cells, cell_size, point_size, true, false));
        say("{}: hidden cells in layers one cell thick hide the cells beside them, too",
            head_.file);
        return points;
    }

    Volume without_hidden(const Volume& volume) const {
        const std::vector<char> hidden = hidden_samples();
        const std::ptrdiff_t count = std::ranges::count(hidden, 1);
        if (count == 0) return volume;
        const std::shared_ptr<void> memory = filled_memory(hidden.size() * sizeof(float));
        auto* const to = static_cast<float*>(memory.get());
        volume.visit([&](const auto* from) {
            for (std::size_t i = 0; i < hidden.size(); ++i)
                to[i] = hidden[i] != 0 ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(from[i]);
        });
        say("{}: {} of {} samples are hidden by ghost arrays and become NaN, which "
            "\"nan\": \"transparent\" in a scene does not draw",
            head_.file, count, hidden.size());
        return Volume(volume.grid(), SampleType::float32, memory).labelled(volume.labels());
    }

    const VtkImageHead& head_;
    const VolumeRequest& request_;
    const VolumeUse& use_;
    VtkImageArray array_;
    Grid grid_;
    StoredSamples all_;
    std::vector<bool> found_;      // samples that a part has; empty if the first part has all
    std::vector<VtkExtent> done_;  // extents of the parts
    // Points and cells that all parts hide which have them; empty if no part has a ghost array.
    std::array<std::vector<char>, 2> hidden_;
    std::array<std::vector<double>, 3> coordinates_;
};

}  // namespace

Volume joined_vtk_image(
    const VtkImageHead& head,
    const std::function<void(const std::function<void(const VtkImagePart&)>& add)>& for_parts,
    const VolumeRequest& request, const VolumeUse& use) {
    VtkImage image(head, request, use);
    for_parts([&](const VtkImagePart& part) { image.add(part); });
    return image.finish();
}

}  // namespace lamina
