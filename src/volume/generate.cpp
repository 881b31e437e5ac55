// SPDX-License-Identifier: Apache-2.0
#include "volume/generate.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <type_traits>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume/gradient_noise.h"
#include "volume/nrrd_writer.h"
#include "volume/sample_source.h"

namespace lamina {

double portable_exp(double x) {
    // exp(x) = 2^n exp(r) with x = n ln 2 + r, |r| <= ln 2 / 2. ln 2 is the sum of two parts, so
    // that n times the high part is exact.
    constexpr double ln2_high = 0x1.62e42feep-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    const double n = std::floor(x / std::numbers::ln2 + 0.5);
    const double r = (x - n * ln2_high) - n * ln2_low;
    double series = 1;  // Taylor, by Horner; the term left out is below 0.35^15 / 15! = 1e-19
    for (int term = 14; term >= 1; --term) series = 1 + series * r / term;
    return std::ldexp(series, static_cast<int>(n));
}

double portable_cos_turns(double turns) {
    const double nearest = std::floor(turns + 0.5);
    double part = std::abs(turns - nearest);  // 0..1/2
    const bool second_quarter = part > 0.25;
    if (second_quarter) part = 0.5 - part;
    const double angle = 2 * std::numbers::pi * part;  // 0..pi/2
    double series = 1;  // Taylor, by Horner; the term left out is below (pi/2)^24 / 24! = 1e-19
    for (int term = 22; term >= 2; term -= 2)
        series = 1 - series * angle * angle / (term * (term - 1));
    return second_quarter ? -series : series;
}

namespace {

using GridSize = std::array<std::int64_t, 3>;

// A field on a grid, computed row by row.
class Generator {
  public:
    virtual ~Generator() = default;

    // Computes the samples (0, y, z), (1, y, z), ..., each in 0..1. Safe from any thread.
    virtual void row(std::int64_t y, std::int64_t z, double* values) const = 0;
};

// Returns the position of sample i of n in the unit box: 0 to 1, or 1/2 if there is only one.
double unit_position(std::int64_t i, std::int64_t n) {
    return n == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(n - 1);
}

// The value x / (size of x - 1): 0, 1, ..., 255 in 256 samples of uint8.
class Ramp final : public Generator {
  public:
    explicit Ramp(const GridSize& size) : size_x_(size[0]) {}

    void row(std::int64_t, std::int64_t, double* values) const override {
        const auto last = static_cast<double>(std::max<std::int64_t>(1, size_x_ - 1));
        for (std::int64_t x = 0; x < size_x_; ++x) values[x] = static_cast<double>(x) / last;
    }

  private:
    std::int64_t size_x_;
};

class Constant final : public Generator {
  public:
    explicit Constant(const GridSize& size) : size_x_(size[0]) {}

    void row(std::int64_t, std::int64_t, double* values) const override {
        std::fill_n(values, size_x_, 0.5);
    }

  private:
    std::int64_t size_x_;
};

// The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume
// rendering", Visualization 1994, eq. 5, with f_M = 6 and alpha = 0.25, over [-1,1]^3.
class MarschnerLobb final : public Generator {
  public:
    explicit MarschnerLobb(const GridSize& size)
        : size_(size), radial_(static_cast<std::size_t>(size[0] * size[1])) {
        for (std::int64_t y = 0; y < size[1]; ++y) {
            for (std::int64_t x = 0; x < size[0]; ++x) {
                radial_[static_cast<std::size_t>(y * size[0] + x)] =
                    radial(coordinate(x, 0), coordinate(y, 1));
            }
        }
    }

    void row(std::int64_t y, std::int64_t z, double* values) const override {
        const double sine = portable_cos_turns(coordinate(z, 2) / 4 - 0.25);  // sin(pi z / 2)
        const double* const radial = &radial_[static_cast<std::size_t>(y * size_[0])];
        for (std::int64_t x = 0; x < size_[0]; ++x) {
            values[x] = (1 - sine + alpha * (1 + radial[x])) / (2 * (1 + alpha));
        }
    }

  private:
    static constexpr double frequency = 6;
    static constexpr double alpha = 0.25;

    double coordinate(std::int64_t i, std::size_t axis) const {
        return 2 * unit_position(i, size_[axis]) - 1;
    }

    // rho_r(r) = cos(2 pi f_M cos(pi r / 2))
    static double radial(double x, double y) {
        return portable_cos_turns(frequency * portable_cos_turns(std::sqrt(x * x + y * y) / 4));
    }

    GridSize size_;
    std::vector<double> radial_;  // rho_r at (x, y), which every slice needs
};

struct Blob {
    glm::dvec3 center;
    double width;  // standard deviation
    double weight;

    double at(const glm::dvec3& p) const {
        return weight * portable_exp(-glm::dot(p - center, p - center) / (2 * width * width));
    }
};

// Positions are in the unit box. The narrowest blob is 5 samples wide in 128^3.
const Blob blobs[] = {{{0.50, 0.50, 0.50}, 0.17, 1.00}, {{0.24, 0.30, 0.66}, 0.07, 0.60},
                      {{0.74, 0.26, 0.38}, 0.05, 0.65}, {{0.70, 0.76, 0.72}, 0.09, 0.55},
                      {{0.30, 0.74, 0.28}, 0.04, 0.70}, {{0.52, 0.28, 0.82}, 0.06, 0.60}};

// Returns the maximum of all blobs' sum: the highest peak of mean shift from every blob's centre.
double highest_peak() {
    double highest = 0;
    for (const Blob& start : blobs) {
        glm::dvec3 p = start.center;
        for (int step = 0; step < 100; ++step) {
            glm::dvec3 weighted{0};
            double total = 0;
            for (const Blob& blob : blobs) {
                const double weight = blob.at(p) / (blob.width * blob.width);
                weighted += weight * blob.center;
                total += weight;
            }
            p = weighted / total;
        }
        double sum = 0;
        for (const Blob& blob : blobs) sum += blob.at(p);
        highest = std::max(highest, sum);
    }
    return highest;
}

// A smooth sum of Gaussians of several widths, divided by its maximum.
class Gaussians final : public Generator {
  public:
    explicit Gaussians(const GridSize& size) : size_(size) {
        const double peak = highest_peak();
        for (const Blob& blob : blobs) {
            Factors factors;
            for (int axis = 0; axis < 3; ++axis) {
                const std::int64_t n = size[static_cast<std::size_t>(axis)];
                for (std::int64_t i = 0; i < n; ++i) {
                    const double distance = unit_position(i, n) - blob.center[axis];
                    factors[static_cast<std::size_t>(axis)].push_back(
                        portable_exp(-distance * distance / (2 * blob.width * blob.width)));
                }
            }
            for (double& factor : factors[2]) factor *= blob.weight / peak;
            factors_.push_back(std::move(factors));
        }
    }

    void row(std::int64_t y, std::int64_t z, double* values) const override {
        std::fill_n(values, size_[0], 0.0);
        for (const Factors& factors : factors_) {
            const double scale =
                factors[1][static_cast<std::size_t>(y)] * factors[2][static_cast<std::size_t>(z)];
            for (std::int64_t x = 0; x < size_[0]; ++x) {
                values[x] += scale * factors[0][static_cast<std::size_t>(x)];
            }
        }
    }

  private:
    // The factors of a Gaussian: one for each axis, at each sample along that axis.
    using Factors = std::array<std::vector<double>, 3>;

    GridSize size_;
    std::vector<Factors> factors_;
};

// A sheet around the plane dot(normal, p) = offset in the unit box, two samples thick along `axis`.
struct Sheet {
    glm::dvec3 normal;
    double offset;
    int axis;
};

const Sheet oblique_sheets[] = {
    {{0.20, 0.10, 1.00}, 0.86, 2}, {{-0.30, 0.25, 1.00}, 0.34, 2}, {{1.00, 0.35, 0.45}, 0.95, 0}};

// Thin dense sheets, as in LaMar's tests: 1 inside, 0 outside. Two are perpendicular to z, one and
// two samples thick. Three are oblique: two are two samples thick along z, one along x.
class Sheets final : public Generator {
  public:
    explicit Sheets(const GridSize& size)
        : size_(size), single_z_(size[2] / 4), double_z_(size[2] * 3 / 5) {}

    void row(std::int64_t y, std::int64_t z, double* values) const override {
        const bool flat = z == single_z_ || z == double_z_ || z == double_z_ + 1;
        std::fill_n(values, size_[0], flat ? 1.0 : 0.0);
        for (const Sheet& sheet : oblique_sheets) {
            const auto axis = static_cast<std::size_t>(sheet.axis);
            const auto intervals = static_cast<double>(size_[axis] - 1);
            for (std::int64_t x = 0; x < size_[0]; ++x) {
                const glm::dvec3 p{unit_position(x, size_[0]), unit_position(y, size_[1]),
                                   unit_position(z, size_[2])};
                const double beyond =
                    (glm::dot(sheet.normal, p) - sheet.offset) / sheet.normal[sheet.axis];
                const double samples_beyond = beyond * intervals;
                if (samples_beyond > -1 && samples_beyond <= 1) values[x] = 1;
            }
        }
    }

  private:
    GridSize size_;
    std::int64_t single_z_;
    std::int64_t double_z_;
};

// The mixing layer, with lengths in units of the box: pure light fluid lies before layer_begin,
// pure heavy fluid behind layer_end. The numbers only shape the picture.
constexpr double layer_begin = 0.08;
constexpr double layer_end = 0.92;
constexpr double layer_margin = 0.20;     // over which stirring fades in and out
constexpr double interface_reach = 0.34;  // reach of spikes and bubbles
constexpr double interface_width = 0.08;  // over which the fluids blend
constexpr double stirring = 0.22;         // displacement by eddies of amplitude 1
constexpr double entrainment = 0.7;       // strength of eddies of one fluid in the other

constexpr int interface_octaves = 3;
constexpr double interface_frequency = 6;  // lattice cells a box, first octave
constexpr double stirring_frequency = 6;   // lattice cells a box, first octave
constexpr double persistence = 0.70;       // amplitude of an octave, divided by the one before
constexpr double samples_per_finest_cell = 4;

// A field like a turbulent mixing layer after a Richtmyer-Meshkov instability: light fluid (0) at
// small x, heavy fluid (1) at large x. Each row is made in three steps:
//   1. Noise moves the interface at (y, z) along x: into narrow spikes of heavy fluid and broad
//      bubbles of light fluid.
//   2. Eddies (noise in octaves; finer grids have finer ones) shift the distance from the
//      interface. A smooth step of that distance blends the fluids.
//   3. Near the interface, the finer eddies are added to the value, too.
class Mixing final : public Generator {
  public:
    explicit Mixing(const GridSize& size) : size_(size) {
        const auto longest = static_cast<double>(*std::max_element(size.begin(), size.end()));
        for (double frequency = stirring_frequency;
             frequency == stirring_frequency || frequency * samples_per_finest_cell <= longest;
             frequency *= 2) {
            frequencies_.push_back(frequency);
        }
        for (std::int64_t x = 0; x < size[0]; ++x) {
            const double position = unit_position(x, size[0]);
            position_.push_back(position);
            strength_.push_back(smooth_step((position - layer_begin) / layer_margin) *
                                smooth_step((layer_end - position) / layer_margin));
        }
    }

    void row(std::int64_t y, std::int64_t z, double* values) const override {
        const double py = unit_position(y, size_[1]);
        const double pz = unit_position(z, size_[2]);
        std::vector<double> coarse(strength_.size());
        std::vector<double> fine(strength_.size());
        add_eddies(py, pz, coarse.data(), fine.data());
        const double interface = interface_position(py, pz);
        for (std::size_t x = 0; x < position_.size(); ++x) {
            const double stirred =
                position_[x] - interface + stirring * strength_[x] * (coarse[x] + fine[x]);
            const double heavy = smooth_step(0.5 + stirred / (2 * interface_width));
            // Eddies of one fluid in the other appear near the interface.
            const double nearness = smooth_step(1 - std::abs(stirred) / (4 * interface_width));
            values[x] =
                std::clamp(heavy + entrainment * nearness * strength_[x] * fine[x], 0.0, 1.0);
        }
    }

  private:
    // Adds the noise of the coarser and of the finer half of the octaves.
    void add_eddies(double py, double pz, double* coarse, double* fine) const {
        const auto begin =
            std::find_if(strength_.begin(), strength_.end(), [](double s) { return s > 0; });
        const auto end = std::find(begin, strength_.end(), 0.0);
        const auto first = static_cast<std::size_t>(begin - strength_.begin());
        if (begin == end) return;
        double amplitude = 1;
        for (std::size_t octave = 0; octave < frequencies_.size(); ++octave) {
            const double frequency = frequencies_[octave];
            const double start = position_[first] * frequency;
            const double step =
                frequency / static_cast<double>(std::max<std::int64_t>(1, size_[0] - 1));
            GradientNoise(stirring_seed + octave)
                .add_row(start, step, py * frequency, pz * frequency, amplitude,
                         static_cast<int>(end - begin),
                         (octave < frequencies_.size() / 2 ? coarse : fine) + first);
            amplitude *= persistence;
        }
    }

    double interface_position(double py, double pz) const {
        double height = 0;
        double amplitude = 2;
        double frequency = interface_frequency;
        for (std::uint64_t octave = 0; octave < interface_octaves; ++octave) {
            height +=
                amplitude *
                GradientNoise(interface_seed + octave).at(0.5, py * frequency, pz * frequency);
            amplitude *= 0.5;
            frequency *= 2;
        }
        height = std::clamp(height, -1.0, 1.0);
        // Spikes (towards small x) are narrow and reach to -1. Bubbles are broad, flat at the tip,
        // and reach to 0.8 * 0.8 = 0.64.
        const double shape = height < 0 ? -height * height * (1.5 + 0.5 * height)
                                        : 0.8 * height * (2 - height) * 0.8;
        return 0.5 + interface_reach * shape;
    }

    static constexpr std::uint64_t interface_seed = 0x5eed0000;
    static constexpr std::uint64_t stirring_seed = 0x5eed1000;

    GridSize size_;
    std::vector<double> frequencies_;  // frequencies of stirring, in cells a box
    std::vector<double> position_;     // positions of the samples along x
    std::vector<double> strength_;     // strength of stirring at every x; 0 outside the layer
};

// Bytes that generate_nrrd() holds at a time.
constexpr std::int64_t slab_bytes = std::int64_t{1} << 25;

struct Entry {
    const char* name;
    std::unique_ptr<Generator> (*make)(const GridSize& size);
    GridSize default_size;
};

constexpr GridSize cube{128, 128, 128};
template <typename Made>
std::unique_ptr<Generator> make(const GridSize& size) {
    return std::make_unique<Made>(size);
}

const Entry entries[] = {{"ramp", make<Ramp>, {256, 4, 1}},
                         {"constant", make<Constant>, cube},
                         {"marschner-lobb", make<MarschnerLobb>, cube},
                         {"gaussians", make<Gaussians>, cube},
                         {"sheets", make<Sheets>, cube},
                         {"mixing", make<Mixing>, cube}};

const Entry& entry_of(const std::string& name) {
    for (const Entry& entry : entries) {
        if (name == entry.name) return entry;
    }
    fail("unknown generator '{}': expected one of {}", shortened(name),
         fmt::join(generator_names(), ", "));
}

// Converts values in 0..1 to samples: for integer types, to the nearest of 0 .. maximum.
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

// Computes the slices begin .. end - 1 into `samples`, which holds only these.
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
    with_sample_type(type, [&](auto zero) {
        fill_slices(generator, grid.size, begin, end, static_cast<decltype(zero)*>(samples),
                    progress);
    });
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
    grid.lookup = request.lookup;
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
