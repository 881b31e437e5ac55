// SPDX-License-Identifier: Apache-2.0
// LaMar's ramp (2004, section 4) in the emulated target, pixel by pixel, against a simulation in
// integers that shares no code with the renderer.
#include <cmath>
#include <numeric>

#include "compositing/tree_shape.h"
#include "ramp_scene.h"
#include "volume/generate.h"

namespace lamina {
namespace {

constexpr int width = ramp_width, height = ramp_height, largest = 255;

struct RampCase {
    int samples;
    AlphaRounding alpha;
    OverRounding over;
    int period;                // 0: no dithering
    std::vector<int> factors;  // none: straight
};

// Returns the ranks of dithering, written anew from docs/numerics.md, section 2.
std::vector<int> permutation(int period, std::uint64_t seed) {
    std::vector<int> perm(static_cast<std::size_t>(period));
    std::iota(perm.begin(), perm.end(), 0);
    for (int i = period - 1; i > 0; --i) {
        seed += 0x9e3779b97f4a7c15u;
        std::uint64_t z = seed;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        z = z ^ (z >> 31);
        std::swap(perm[static_cast<std::size_t>(i)], perm[z % static_cast<std::uint64_t>(i + 1)]);
    }
    return perm;
}

// Computes the code of a pixel whose value is 0 .. 255.
class Simulation {
  public:
    explicit Simulation(const RampCase& wanted)
        : case_(wanted), perm_(permutation(std::max(wanted.period, 1), 1)) {}

    int pixel(int value) {
        unit_opacity_ = value / 255.0;
        if (!case_.factors.empty()) return node(0, 0, case_.samples);
        int background = 0;
        for (int z = case_.samples - 1; z >= 0; --z)
            background = over(sample(1.0 / case_.samples, z), background);
        return background;
    }

  private:
    static double scaled(double unit_opacity, double exponent) {
        const double y =
            255 * (unit_opacity < 1 ? -std::expm1(exponent * std::log1p(-unit_opacity)) : 1.0);
        return std::abs(y - std::round(y)) < 1e-9 ? std::round(y) : y;
    }
    int rounded(double y) const {
        return static_cast<int>(case_.alpha == AlphaRounding::truncate ? std::floor(y)
                                                                       : std::floor(y + .5));
    }
    int sample(double exponent, int z) const {
        const double y = scaled(unit_opacity_, exponent);
        if (case_.period == 0) return rounded(y);
        const double floor = std::floor(y);
        const int up = static_cast<int>(std::floor(case_.period * (y - floor)));
        return static_cast<int>(floor) +
               (perm_[static_cast<std::size_t>(z % case_.period)] < up ? 1 : 0);
    }
    int over(int code, int background) const {
        const auto round = [](int x) { return (2 * x + largest) / (2 * largest); };
        return case_.over == OverRounding::fused
                   ? round(largest * code + background * (largest - code))
                   : round(largest * code) + round(background * (largest - code));
    }
    int node(std::size_t level, int first, int n) const {
        const bool leaf = level + 1 == case_.factors.size();
        const int k = case_.factors[level];
        int background = 0;
        for (int i = k - 1; i >= 0; --i) {
            const int from = i * n / k, samples = (i + 1) * n / k - from;
            if (samples == 0) continue;
            const double exponent = static_cast<double>(samples) / n;
            const int code =
                leaf ? sample(exponent, first + from)
                     : rounded(scaled(node(level + 1, first + from, samples) / 255.0, exponent));
            background = over(code, background);
        }
        return background;
    }

    const RampCase& case_;
    std::vector<int> perm_;
    double unit_opacity_ = 0;
};

class RampTest : public SlicingTest {
  protected:
    Volume volume_ = generate({"ramp", {}, SampleType::uint8});

    void compare(const RampCase& wanted) {
        Scene scene = ramp_scene({1, 1, 1});
        scene.slice.samples = wanted.samples;
        scene.emulate.alpha = wanted.alpha;
        scene.emulate.over = wanted.over;
        if (wanted.period > 0) scene.slice.dither = DitherSettings{.period = wanted.period};
        if (!wanted.factors.empty()) {
            scene.slice.tree =
                TreeSettings{.factors = wanted.factors, .nodes = NodeArithmetic::fixed};
        }
        const Image image = render(volume_, scene, capabilities());
        Simulation simulation(wanted);
        for (int x = 0; x < width; ++x) {
            const float expected = static_cast<float>(simulation.pixel(x) / 255.0);
            for (int y = 0; y < height; ++y) {
                for (int channel = 0; channel < 4; ++channel) {
                    ASSERT_EQ(image.pixel(x, y)[channel], expected)
                        << x << " " << y << ": N " << wanted.samples << ", alpha "
                        << name_of(wanted.alpha) << ", over " << name_of(wanted.over) << ", period "
                        << wanted.period << ", tree " << to_text(wanted.factors);
                }
            }
        }
    }
};

const std::vector<std::vector<int>> ramp_trees{
    {}, {256}, {64, 4}, {4, 64}, {16, 16}, {4, 4, 4, 4}, {2, 2, 2, 2, 2, 2, 2, 2}};

TEST_F(RampTest, EveryCombinationMatchesTheIntegerSimulation) {
    for (const int samples : {16, 64, 256}) {
        for (const AlphaRounding alpha : {AlphaRounding::truncate, AlphaRounding::nearest}) {
            for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
                for (const int period : {0, 4, 11, 64, 256}) {
                    for (const std::vector<int>& factors : ramp_trees) {
                        compare({samples, alpha, over, period, factors});
                        if (HasFatalFailure()) return;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace lamina
