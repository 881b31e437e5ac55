// SPDX-License-Identifier: Apache-2.0
#include "choice/constant_border.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <utility>

#include "choice/choose.h"
#include "choice/field.h"
#include "choice/open_scene.h"
#include "choice/words.h"
#include "support/stored_volume.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr std::int64_t edge = 40;                        // samples of the scan along an axis
constexpr double air = 20, flesh = 100, bone = 200;      // values
constexpr double flesh_radius = 16, bone_radius = 8;     // samples
constexpr std::array<std::int64_t, 3> widths{1, 5, 20};  // of borders, in samples

// Widths of a border at the beginning and the end of each axis.
struct Widths {
    std::array<std::int64_t, 3> before{}, after{};

    static Widths all(std::int64_t width) { return {{width, width, width}, {width, width, width}}; }
};

// A scan of a ball with another one inside, with noise of this standard deviation. Around it is a
// border of one value, so that sample (0, 0, 0) of the scan has its place.
template <typename Sample>
Volume bordered(double value, const Widths& widths, double deviation = 4) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 1);
    std::vector<double> scan;
    for (std::int64_t i = 0; i < edge * edge * edge; ++i) {
        const glm::dvec3 at(i % edge, i / edge % edge, i / (edge * edge));
        const double distance = glm::length(at - glm::dvec3(double{edge - 1} / 2));
        const auto inside = [&](double radius) {
            return std::clamp((radius - distance) / 2 + .5, 0., 1.);
        };
        const double mean =
            air + (flesh - air) * inside(flesh_radius) + (bone - flesh) * inside(bone_radius);
        scan.push_back(std::round(mean + deviation * noise(random)));
    }
    Grid grid = test::grid_of({1, 1, 1}, Centering::node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = edge + widths.before[axis] + widths.after[axis];
        grid.origin[static_cast<int>(axis)] = -static_cast<double>(widths.before[axis]);
    }
    return test::volume_of<Sample>(grid, [&](double i, double j, double k) {
        const std::array<double, 3> at{i, j, k};
        std::int64_t place = 0;
        for (const std::size_t axis : {2, 1, 0}) {
            const auto inside = static_cast<std::int64_t>(at[axis]) - widths.before[axis];
            if (inside < 0 || inside >= edge) return value;
            place = place * edge + inside;
        }
        return scan[static_cast<std::size_t>(place)];
    });
}

Choices chosen_for(const Volume& volume, Scene scene = test::open_scene(),
                   const Adjustments& adjustments = {}) {
    const MinMaxBricks bricks = measure_bricks(volume);
    return choose(std::move(scene), VolumeField(volume, bricks), adjustments);
}

// Tells whether the clip leaves exactly the scan.
void expect_scan_is_left(const Clip& clip) {
    ASSERT_EQ(clip.planes.size(), 6u);
    for (const ClipPlane& plane : clip.planes) {
        const double along = plane.normal.x + plane.normal.y + plane.normal.z;  // 1 or -1
        EXPECT_EQ(glm::dot(plane.point, plane.normal) * along, along > 0 ? 0 : edge - 1);
    }
}

template <typename Sample>
void expect_picture_without_border(double value) {
    const Choices bare = chosen_for(bordered<Sample>(value, {}));
    ASSERT_TRUE(bare.scene.clip.keeps_all());
    for (const std::int64_t width : widths) {
        const Choices found = chosen_for(bordered<Sample>(value, Widths::all(width)));
        SCOPED_TRACE(fmt::format("{} samples of {}", width, value));
        EXPECT_EQ(found.scene.transfer_function, bare.scene.transfer_function);
        expect_scan_is_left(found.scene.clip);
    }
}

TEST(ConstantBorder, ChangesNoTransferFunctionAndIsCutAway) {
    expect_picture_without_border<std::int16_t>(3000);
    expect_picture_without_border<std::int16_t>(flesh);
    expect_picture_without_border<std::int16_t>(bone);
    expect_picture_without_border<std::uint8_t>(255);
    expect_picture_without_border<float>(flesh + .5);
}

TEST(ConstantBorder, IsFoundAroundAirOfOneValue) {
    for (const std::int64_t width : widths) {
        const Volume volume = bordered<std::uint8_t>(255, Widths::all(width), 0);
        const Choices found = chosen_for(volume);
        SCOPED_TRACE(width);
        expect_scan_is_left(found.scene.clip);
    }
}

// Nothing shows between such a border and the air behind it.
TEST(ConstantBorder, BelowTheAirStaysUnseen) {
    const Choices bare = chosen_for(bordered<std::int16_t>(0, {}));
    for (const double value : {-10, 0}) {
        for (const std::int64_t width : widths) {
            const Scene found = chosen_for(bordered<std::int16_t>(value, Widths::all(width))).scene;
            EXPECT_TRUE(found.clip.keeps_all()) << value;
            EXPECT_EQ(found.transfer_function, bare.scene.transfer_function) << value;
        }
    }
    // Farther below, it is padding.
    const Scene far = chosen_for(bordered<std::int16_t>(-2000, Widths::all(5))).scene;
    EXPECT_TRUE(far.clip.keeps_all());
    EXPECT_TRUE(far.transfer_function->transparent(-2000, air));
    EXPECT_GT(far.transfer_function->at(bone).extinction, 0);
}

TEST(ConstantBorder, IsFoundOnOneSideAlone) {
    for (const std::size_t axis : {0, 1, 2}) {
        for (const bool after : {false, true}) {
            Widths plate;
            (after ? plate.after : plate.before)[axis] = 3;
            const Choices found = chosen_for(bordered<std::uint8_t>(230, plate));
            ASSERT_EQ(found.scene.clip.planes.size(), 1u);
            const ClipPlane& plane = found.scene.clip.planes[0];
            glm::dvec3 normal(0);
            normal[static_cast<int>(axis)] = after ? -1 : 1;
            EXPECT_EQ(plane.normal, normal);
            EXPECT_EQ(glm::dot(plane.point, normal), after ? 1 - edge : 0);
        }
    }
}

TEST(ConstantBorder, IsTheSameOfAVolumeInItsFiles) {
    const Volume volume = bordered<std::int16_t>(bone, {{2, 0, 3}, {0, 4, 1}});
    const auto here = find_constant_border(volume, {0, 250});
    const auto there = find_constant_border(test::stored(volume), {0, 250});
    ASSERT_TRUE(here && there);
    EXPECT_EQ(here->inside.first, (std::array<std::int64_t, 3>{2, 0, 3}));
    EXPECT_EQ(here->inside.size, (std::array<std::int64_t, 3>{edge, edge, edge}));
    EXPECT_EQ(there->inside.first, here->inside.first);
    EXPECT_EQ(there->inside.size, here->inside.size);
    for (std::size_t i = 0; i < here->layers.size(); ++i)
        EXPECT_EQ(there->layers[i].behind, here->layers[i].behind);
}

TEST(ConstantBorder, IsSaidAndKeptIfAsked) {
    const Volume volume = bordered<std::uint8_t>(255, Widths::all(2));
    const auto said = [](const Choices& choices) {
        return std::ranges::any_of(choices.reasons, [](const std::string& reason) {
            return reason.find("border of 255, up to 2 samples wide, is cut away") !=
                   std::string::npos;
        });
    };
    EXPECT_TRUE(said(chosen_for(volume)));
    Words words;
    words.crop = ":,:,:";
    const Choices kept =
        chosen_for(volume, test::open_scene(), adjustments_of(words, ImageColorSpace::linear));
    EXPECT_FALSE(said(kept));
    EXPECT_TRUE(kept.scene.clip.keeps_all());
    // A clip and a transfer function that the scene itself has stay.
    Scene given = test::open_scene();
    given.transfer_function = TransferFunction::linear({{0, {}}, {255, {glm::dvec3(1), 1}}});
    EXPECT_TRUE(chosen_for(volume, given).scene.clip.keeps_all());
    Scene boxed = test::open_scene();
    boxed.clip.box = ClipBox{glm::dvec3(-2), glm::dvec3(30)};
    EXPECT_TRUE(chosen_for(volume, boxed).scene.clip.planes.empty());
}

TEST(ConstantBorder, IsNotCountedAsAskedFor) {
    const Volume volume = bordered<std::uint8_t>(255, Widths::all(2));
    Words words;
    words.clip = {"x:3:"};
    const Adjustments adjustments = adjustments_of(words, ImageColorSpace::linear);
    Scene scene = test::open_scene();
    adjust_scene(scene, adjustments);
    const Choices found = chosen_for(volume, scene, adjustments);
    EXPECT_EQ(found.scene.clip.planes.size(), 7u);
    EXPECT_EQ(std::ranges::count(found.reasons, "clip: 1 plane, as asked"), 1);
}

// Layers of one value each are the data of a field that varies along one axis alone.
TEST(ConstantBorder, IsNoLayerOfARamp) {
    for (const std::size_t axis : {0, 1, 2}) {
        for (const std::int64_t length : {2, 4, 5, 60}) {
            for (const double thickness : {1., 5.}) {  // samples of a layer
                Grid grid = test::grid_of({9, 9, 9}, Centering::node);
                grid.size[axis] = length;
                const Volume volume =
                    test::volume_of<float>(grid, [&](double i, double j, double k) {
                        return std::floor(std::array{i, j, k}[axis] / thickness);
                    });
                SCOPED_TRACE(fmt::format("axis {}, {} layers of {}", axis, length, thickness));
                EXPECT_FALSE(find_constant_border(volume, measure_bricks(volume).whole));
                EXPECT_FALSE(find_constant_border(test::stored(volume), {0, 60}));
                EXPECT_TRUE(chosen_for(volume).scene.clip.keeps_all());
            }
        }
    }
}

// Marks burnt into a border, of up to a thousandth of a layer, are cut away with it and are no
// values of the data; more than that is no border.
TEST(ConstantBorder, MayHaveAFewOddSamples) {
    const Choices bare = chosen_for(bordered<std::int16_t>(3000, {}));
    const Volume clean = bordered<std::int16_t>(3000, Widths::all(5));
    const auto& size = clean.grid().size;
    static_assert(edge * edge >= 1000);  // one sample of the smallest layer may be odd
    const auto* const samples = static_cast<const std::int16_t*>(clean.data());
    const auto marked = [&](std::int64_t marks) {
        return test::volume_of<std::int16_t>(clean.grid(), [&](double i, double j, double k) {
            if (i == 0 && j == 0 && k == 0) return -4000.;
            if (i == 2 && k == 30 && j >= 20 && j < 20 + static_cast<double>(marks)) return 9000.;
            const double row = k * static_cast<double>(size[1]) + j;
            const double place = row * static_cast<double>(size[0]) + i;
            return double(samples[static_cast<std::size_t>(place)]);
        });
    };
    const Volume few = marked(1), many = marked(25);
    const Choices found = chosen_for(few);
    expect_scan_is_left(found.scene.clip);
    EXPECT_EQ(found.scene.transfer_function, bare.scene.transfer_function);
    const auto here = find_constant_border(few, {-4000, 9000});
    const auto there = find_constant_border(test::stored(few), {-4000, 9000});
    ASSERT_TRUE(here && there);
    EXPECT_EQ(here->inside.size, there->inside.size);
    std::size_t odd = 0;
    for (std::size_t i = 0; i < here->layers.size(); ++i) {
        ASSERT_EQ(here->layers[i].odd.size(), there->layers[i].odd.size());
        for (std::size_t k = 0; k < here->layers[i].odd.size(); ++k) {
            EXPECT_EQ(here->layers[i].odd[k].index, there->layers[i].odd[k].index);
            EXPECT_EQ(here->layers[i].odd[k].value, there->layers[i].odd[k].value);
        }
        odd += here->layers[i].odd.size();
    }
    EXPECT_EQ(odd, 2u);
    const auto others = find_constant_border(many, {-4000, 9000});
    ASSERT_TRUE(others);
    EXPECT_EQ(others->inside.first, (std::array<std::int64_t, 3>{0, 5, 5}));
}

// Layers of more samples than are read at once.
TEST(ConstantBorder, IsFoundInFilesWithoutReadingThemWhole) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({2048, 1024, 4}, Centering::node),
        [](double i, double j, double k) { return k == 0 ? 255 : static_cast<int>(i + j) % 100; });
    auto source = std::make_unique<test::SourceInMemory>(volume);
    std::int64_t largest = 0;
    source->before_read = [&](const SampleBox& box) { largest = std::max(largest, box.count()); };
    const Volume in_files(
        volume.grid(), volume.type(),
        std::make_shared<const VolumeStore>(volume.grid(), volume.type(), std::move(source)));
    const auto here = find_constant_border(volume, {0, 255});
    const auto there = find_constant_border(in_files, {0, 255});
    ASSERT_TRUE(here && there);
    ASSERT_EQ(here->layers.size(), 1u);
    ASSERT_EQ(there->layers.size(), 1u);
    EXPECT_EQ(there->inside.size, (std::array<std::int64_t, 3>{2048, 1024, 3}));
    EXPECT_EQ(there->layers[0].behind, here->layers[0].behind);
    EXPECT_NEAR(there->layers[0].behind, 50, 1);  // the median of 0 .. 99, each as often
    EXPECT_LE(largest, most_read);
}

// A box keeps what it says. The border does not count unless the box has some of it.
TEST(ConstantBorder, CountsOnlyInABoxThatHasSomeOfIt) {
    const Volume volume = bordered<std::uint8_t>(255, Widths::all(5));
    const Choices bare = chosen_for(volume);
    Scene cropped = test::open_scene(), outside = cropped;
    cropped.clip.box = ClipBox{glm::dvec3(0), glm::dvec3(edge - 1)};
    outside.clip.box = ClipBox{glm::dvec3(-.5), glm::dvec3(edge - 1)};
    // Extinctions follow from what the clip keeps, which is the same.
    EXPECT_EQ(chosen_for(volume, cropped).scene.transfer_function, bare.scene.transfer_function);
    EXPECT_NE(chosen_for(volume, outside).scene.transfer_function, bare.scene.transfer_function);
}

// The wanted opacity decides what would show, not the function that it replaces.
TEST(ConstantBorder, IsCutAwayIfTheWantedOpacityShowsIt) {
    // A dark and a bright ball in flesh, which is transparent unless an opacity is wanted.
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 4);
    const Volume volume = test::volume_of<std::int16_t>(
        test::grid_of({42, 42, 42}, Centering::node), [&](double i, double j, double k) {
            const glm::dvec3 at(i, j, k);
            if (k >= edge) return 104.;
            const auto inside = [&](double middle) {
                return std::clamp((9 - glm::length(at - middle)) / 2 + .5, 0., 1.);
            };
            return std::round(flesh + (air - flesh) * inside(12) + (bone - flesh) * inside(28) +
                              noise(random));
        });
    const auto planes_with = [&](const char* opacity) {
        Words words;
        words.opacity = opacity;
        const Adjustments adjustments = adjustments_of(words, ImageColorSpace::linear);
        return chosen_for(volume, test::open_scene(), adjustments).scene.clip.planes.size();
    };
    EXPECT_EQ(planes_with(""), 0u);
    EXPECT_EQ(planes_with("linear"), 1u);
}

// The empty space around a thing is the lowest value, or that of what lies behind it.
TEST(ConstantBorder, IsNotTheAirAroundAThing) {
    const auto border_around = [](double value, const auto& is_inside) {
        const Volume volume = test::volume_of<std::int16_t>(
            test::grid_of({30, 30, 30}, Centering::node), [&](double i, double j, double k) {
                const glm::dvec3 from_middle = glm::dvec3(i, j, k) - 14.5;
                return is_inside(from_middle) ? 200 + static_cast<int>(i) % 3 : value;
            });
        return find_constant_border(volume, measure_bricks(volume).whole).has_value();
    };
    const auto ball = [](const glm::dvec3& at) { return glm::length(at) < 9; };
    const auto box = [](const glm::dvec3& at) {
        return std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < 9;
    };
    EXPECT_FALSE(border_around(0, box));
    EXPECT_FALSE(border_around(700, ball));
    EXPECT_TRUE(border_around(700, box));
}

// A crop along x that ends inside the border leaves the border along y and z.
TEST(ConstantBorder, IsNamedIfACropLeavesIt) {
    const Volume volume = bordered<std::int16_t>(3000, Widths::all(5));
    Adjustments crop;
    crop.own_crop = true;
    const auto reasons_of = [&](int axes) {
        Scene scene = test::open_scene();
        for (int axis = 0; axis < axes; ++axis) {
            glm::dvec3 last(0), along(0);
            last[axis] = edge - 1;
            along[axis] = 1;
            scene.clip.planes.push_back({glm::dvec3(0), along});
            scene.clip.planes.push_back({last, -along});
        }
        return chosen_text(chosen_for(volume, scene, crop).reasons);
    };
    const std::string said = "clip: a border of 3000, up to 5 samples wide, is kept";
    EXPECT_NE(reasons_of(0).find(said), std::string::npos);
    EXPECT_NE(reasons_of(1).find(said), std::string::npos);
    EXPECT_EQ(reasons_of(3).find("border"), std::string::npos);
}

}  // namespace
}  // namespace lamina
