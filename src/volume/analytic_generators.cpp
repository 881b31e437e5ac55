// SPDX-License-Identifier: Apache-2.0
#include "volume/analytic_generators.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "volume/portable_math.h"

namespace lamina {
namespace {

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

// The maximum of the sum is the highest of the peaks that mean shift finds from every blob's
// centre.
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
    using Factors =
        std::array<std::vector<double>, 3>;  // a Gaussian is a product of three, one an axis

    GridSize size_;
    std::vector<Factors> factors_;
};

// The plane where dot(normal, p) = offset, p in the unit box, as thick as two samples along `axis`.
struct Sheet {
    glm::dvec3 normal;
    double offset;
    int axis;
};

const Sheet oblique_sheets[] = {
    {{0.20, 0.10, 1.00}, 0.86, 2}, {{-0.30, 0.25, 1.00}, 0.34, 2}, {{1.00, 0.35, 0.45}, 0.95, 0}};

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

}  // namespace

std::unique_ptr<Generator> make_ramp(const GridSize& size) {
    return std::make_unique<Ramp>(size);
}

std::unique_ptr<Generator> make_constant(const GridSize& size) {
    return std::make_unique<Constant>(size);
}

std::unique_ptr<Generator> make_marschner_lobb(const GridSize& size) {
    return std::make_unique<MarschnerLobb>(size);
}

std::unique_ptr<Generator> make_gaussians(const GridSize& size) {
    return std::make_unique<Gaussians>(size);
}

std::unique_ptr<Generator> make_sheets(const GridSize& size) {
    return std::make_unique<Sheets>(size);
}

}  // namespace lamina
