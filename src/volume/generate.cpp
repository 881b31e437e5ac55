// SPDX-License-Identifier: Apache-2.0
#include "volume/generate.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "volume/generators.h"
#include "volume/nrrd_writer.h"

namespace lamina {
namespace {

// Bytes that generate_nrrd() holds at a time.
constexpr std::int64_t slab_bytes = std::int64_t{1} << 25;

struct Entry {
    const char* name;
    std::unique_ptr<Generator> (*make)(const GridSize& size);
    GridSize default_size;
};

constexpr GridSize cube{128, 128, 128};
const Entry entries[] = {{"ramp", make_ramp, {256, 4, 1}},
                         {"constant", make_constant, cube},
                         {"marschner-lobb", make_marschner_lobb, cube},
                         {"gaussians", make_gaussians, cube},
                         {"sheets", make_sheets, cube},
                         {"mixing", make_mixing, cube}};

const Entry& entry_of(const std::string& name) {
    for (const Entry& entry : entries) {
        if (name == entry.name) return entry;
    }
    fail("unknown generator '{}': expected one of {}", shortened(name),
         fmt::join(generator_names(), ", "));
}

// Rounds values to the nearest codes of an integer type, whose whole range stands for 0..1.
template <typename T>
void quantize(const double* values, std::int64_t count, T* samples) {
    for (std::int64_t i = 0; i < count; ++i) {
        if constexpr (std::is_floating_point_v<T>) {
            samples[i] = static_cast<T>(values[i]);
        } else {
            samples[i] =
                static_cast<T>(std::floor(values[i] * std::numeric_limits<T>::max() + 0.5));
        }
    }
}

// Fills `samples`, which has room for just these, with the slices [begin, end).
template <typename T>
void fill_slices(const Generator& generator, const GridSize& size, std::int64_t begin,
                 std::int64_t end, T* samples, Progress& progress) {
    constexpr std::int64_t rows_per_task = 8;
    parallel_for((end - begin) * size[1], rows_per_task, [&](std::int64_t row) {
        std::vector<double> values(static_cast<std::size_t>(size[0]));
        generator.row(row % size[1], begin + row / size[1], values.data());
        quantize(values.data(), size[0], samples + row * size[0]);
        if (row % size[1] == 0) progress.advance();
    });
}

void fill_slices(const Generator& generator, const Grid& grid, SampleType type, std::int64_t begin,
                 std::int64_t end, void* samples, Progress& progress) {
    const auto fill = [&](auto* typed) {
        fill_slices(generator, grid.size, begin, end, typed, progress);
    };
    switch (type) {
        case SampleType::uint8:
            return fill(static_cast<std::uint8_t*>(samples));
        case SampleType::uint16:
            return fill(static_cast<std::uint16_t*>(samples));
        case SampleType::float32:
            return fill(static_cast<float*>(samples));
        case SampleType::int16:
            break;  // generated_grid() rejects it
    }
    unreachable_enum();
}

}  // namespace

const std::vector<std::string>& generator_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Entry& entry : entries) list.emplace_back(entry.name);
        return list;
    }();
    return names;
}

Grid generated_grid(const GeneratorRequest& request) {
    const Entry& entry = entry_of(request.name);
    if (request.type == SampleType::int16) {
        fail("type of a generated volume: found 'int16', expected uint8, uint16 or float");
    }
    Grid grid;
    grid.size = request.size.value_or(entry.default_size);
    for (const std::int64_t size : grid.size) {
        if (size < 1 || size > largest_generated_axis) {
            fail("size of a generated volume: found {}, expected 1 to {} samples along each axis",
                 fmt::join(grid.size, ","), largest_generated_axis);
        }
    }
    grid.centering.fill(Centering::cell);
    if (request.name == "ramp") return grid;  // voxels of edge 1
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t size = grid.size[static_cast<std::size_t>(axis)];
        if (size == 1) {
            grid.origin[axis] = 0.5;
            continue;
        }
        grid.centering[static_cast<std::size_t>(axis)] = Centering::node;
        grid.step[static_cast<std::size_t>(axis)][axis] = 1 / static_cast<double>(size - 1);
    }
    return grid;
}

Volume generate(const GeneratorRequest& request) {
    const Grid grid = generated_grid(request);
    const auto generator = entry_of(request.name).make(grid.size);
    const std::size_t bytes =
        static_cast<std::size_t>(grid.sample_count()) * bytes_of(request.type);
    const std::shared_ptr<void> samples = filled_memory(bytes);
    Progress progress("generating " + request.name, grid.size[2]);
    fill_slices(*generator, grid, request.type, 0, grid.size[2], samples.get(), progress);
    return Volume(grid, request.type, samples);
}

void generate_nrrd(AtomicFile& file, const GeneratorRequest& request) {
    const Grid grid = generated_grid(request);
    const auto generator = entry_of(request.name).make(grid.size);
    const std::int64_t slice_bytes =
        grid.size[0] * grid.size[1] * static_cast<std::int64_t>(bytes_of(request.type));
    const std::int64_t slices = std::clamp<std::int64_t>(slab_bytes / slice_bytes, 1, grid.size[2]);
    std::vector<std::max_align_t> slab(
        static_cast<std::size_t>(slices * slice_bytes) / sizeof(std::max_align_t) + 1);
    Progress progress("generating " + request.name, grid.size[2]);
    write_nrrd_header(file, grid, request.type);
    for (std::int64_t begin = 0; begin < grid.size[2]; begin += slices) {
        const std::int64_t end = std::min(grid.size[2], begin + slices);
        fill_slices(*generator, grid, request.type, begin, end, slab.data(), progress);
        file.write(slab.data(), static_cast<std::size_t>((end - begin) * slice_bytes));
    }
}

}  // namespace lamina
