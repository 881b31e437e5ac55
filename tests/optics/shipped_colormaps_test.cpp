// SPDX-License-Identifier: Apache-2.0
#include "optics/colormap.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

glm::dvec3 mapped_color(const Colormap& colormap, double value) {
    return TransferFunction::linear(combine(colormap, {{0, 1}})).at(value).color;
}

// Entries 0, 15, .. 255 of the 256 of an original map (matplotlib 3.6).
struct Original {
    const char* name;
    std::array<glm::dvec3, 18> entries;
};
const Original originals[] = {
    {"viridis",
     {{{0.267004, 0.004874, 0.329415},
       {0.281924, 0.089666, 0.412415},
       {0.280255, 0.165693, 0.476498},
       {0.263663, 0.237631, 0.518762},
       {0.237441, 0.305202, 0.541921},
       {0.208623, 0.367752, 0.552675},
       {0.182256, 0.426184, 0.557120},
       {0.159194, 0.482237, 0.558073},
       {0.137770, 0.537492, 0.554906},
       {0.121148, 0.592739, 0.544641},
       {0.128087, 0.647749, 0.523491},
       {0.180653, 0.701402, 0.488189},
       {0.274149, 0.751988, 0.436601},
       {0.395174, 0.797475, 0.367757},
       {0.535621, 0.835785, 0.281908},
       {0.688944, 0.865448, 0.182725},
       {0.845561, 0.887322, 0.099702},
       {0.993248, 0.906157, 0.143936}}}},
    {"inferno",
     {{{0.001462, 0.000466, 0.013866},
       {0.037668, 0.025921, 0.132232},
       {0.116656, 0.047574, 0.272321},
       {0.217949, 0.036615, 0.383522},
       {0.316282, 0.053490, 0.425116},
       {0.410113, 0.087896, 0.433098},
       {0.503493, 0.121575, 0.423356},
       {0.596940, 0.154848, 0.398125},
       {0.688653, 0.192239, 0.357603},
       {0.775059, 0.239667, 0.303526},
       {0.851384, 0.302260, 0.239636},
       {0.912966, 0.381636, 0.169755},
       {0.956852, 0.475356, 0.094695},
       {0.981895, 0.579392, 0.026250},
       {0.987464, 0.690366, 0.079990},
       {0.973088, 0.805409, 0.216877},
       {0.947594, 0.917399, 0.410665},
       {0.988362, 0.998364, 0.644924}}}},
    {"cividis",
     {{{0.000000, 0.135112, 0.304751},
       {0.000000, 0.176082, 0.407577},
       {0.087465, 0.214879, 0.437342},
       {0.180503, 0.256180, 0.427299},
       {0.247605, 0.296986, 0.422917},
       {0.305886, 0.337681, 0.424512},
       {0.359916, 0.378641, 0.431501},
       {0.411607, 0.420145, 0.443577},
       {0.461616, 0.462405, 0.461969},
       {0.514226, 0.505546, 0.472640},
       {0.570607, 0.549695, 0.469593},
       {0.628576, 0.595104, 0.459641},
       {0.687957, 0.641966, 0.442886},
       {0.748772, 0.690470, 0.418448},
       {0.811054, 0.740801, 0.385198},
       {0.875057, 0.793125, 0.339685},
       {0.941147, 0.847530, 0.275815},
       {0.995737, 0.909344, 0.217772}}}},
};

// The shipped maps have 33 of the 256 points, in four digits, chosen so that straight lines between
// them are within .42 codes of all 256.
TEST(ShippedColormaps, AreWithinHalfACodeOfTheirOriginals) {
    for (const Original& original : originals) {
        const Colormap map = load_colormap(original.name, ImageColorSpace::display);
        EXPECT_FALSE(map.own_range);
        EXPECT_TRUE(map.opacities.empty());
        EXPECT_EQ(map.colors.size(), 33u);  // display values are straight between points of RGB
        for (std::size_t i = 0; i < original.entries.size(); ++i) {
            const glm::dvec3 found = mapped_color(map, static_cast<double>(i) * 15 / 255);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(255 * found[c], 255 * original.entries[i][c], .42)
                    << original.name << " " << 15 * i;
        }
    }
}

TEST(ShippedColormaps, AreInLinearLightByDefault) {
    const Colormap linear = load_colormap("viridis");
    const Colormap display = load_colormap("viridis", ImageColorSpace::display);
    for (double x = 0; x <= 1; x += 1 / 64.0) {
        const glm::dvec3 expected = linear_from_srgb(mapped_color(display, x));
        // 5e-4 is twice the tolerance of SegmentSampler, which tests only three places of each
        // segment.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mapped_color(linear, x)[c], expected[c], 5e-4) << x;
    }
}

TEST(ShippedColormaps, GraysAndCoolWarmHaveTheirPublishedColors) {
    EXPECT_EQ(mapped_color(load_colormap("greys", ImageColorSpace::display), .25), glm::dvec3(.25));
    // Moreland 2009, table: the middle is (221, 221, 221), the ends (59, 76, 192) and (180, 4, 38).
    const Colormap map = load_colormap("cool-warm", ImageColorSpace::display);
    const glm::dvec3 rows[] = {{59, 76, 192}, {221, 221, 221}, {180, 4, 38}};
    for (int row = 0; row < 3; ++row) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(255 * mapped_color(map, row / 2.)[c], rows[row][c], 1) << row;
    }
}

TEST(ShippedColormaps, PresetsForCtKeepTheirUnitsAndHaveOpacities) {
    for (const char* const name : {"ct-bone", "ct-soft-tissue"}) {
        const Colormap map = load_colormap(name);
        EXPECT_TRUE(map.own_range) << name;
        const auto f = TransferFunction::linear(combine(map, 1));
        EXPECT_TRUE(f.transparent(-2000, -500)) << name;  // air
        EXPECT_GT(f.at(1500).extinction, f.at(40).extinction) << name;
    }
    const auto bone = TransferFunction::linear(combine(load_colormap("ct-bone"), 1));
    EXPECT_TRUE(bone.transparent(-2000, 100));  // fat, muscle, blood
    const auto angio = TransferFunction::linear(combine(load_colormap("ct-angio"), 1));
    EXPECT_TRUE(angio.transparent(-2000, 100));
    EXPECT_GT(angio.at(300).extinction, 0);  // blood with contrast medium
    const auto lung = TransferFunction::linear(combine(load_colormap("ct-lung"), 1));
    EXPECT_TRUE(lung.transparent(-2000, -1000));  // air
    EXPECT_TRUE(lung.transparent(-200, 3000));    // what surrounds the lungs
    EXPECT_GT(lung.at(-700).extinction, 0);
}

TEST(ShippedColormaps, NamesAreListedAndSuggested) {
    const std::vector<std::string> expected{"cividis", "cool-warm", "ct-angio",
                                            "ct-bone", "ct-lung",   "ct-soft-tissue",
                                            "greys",   "inferno",   "viridis"};
    EXPECT_EQ(colormap_names(), expected);
    for (const std::string& name : expected) EXPECT_TRUE(is_colormap_name(name));
    EXPECT_FALSE(is_colormap_name("jet"));
    expect_error([] { load_colormap("virdis"); }, {"virdis", "did you mean \"viridis\"?"});
    expect_error([] { load_colormap("maps/jet"); }, {"maps/jet", "expected one of cividis, cool"});
}

TEST(ShippedColormaps, APathLoadsAPresetFile) {
    const TemporaryFolder folder;
    std::ofstream(folder / "two.json") << R"({"RGBPoints": [5, 0, 0, 0, 7, 1, 1, 1]})";
    const Colormap map = load_colormap(folder / "two.json", ImageColorSpace::display);
    EXPECT_TRUE(map.own_range);
    EXPECT_EQ(mapped_color(map, 6), glm::dvec3(.5));
}

}  // namespace
}  // namespace lamina
