// SPDX-License-Identifier: Apache-2.0
// Clipped volumes: segments end exactly at the planes, for any number of slabs.
#include "support/clips.h"

#include <cmath>
#include <span>

#include "cpu_fixture.h"
#include "scene/camera.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

struct ClipPose {
    Projection projection;
    glm::dvec3 eye;
};

// The eye of the last pose is in a part of the box that some clips cut away.
const ClipPose clip_poses[] = {{Projection::orthographic, {1.7, -1.2, 1.4}},
                               {Projection::perspective, {1.21, -.17, 1.19}},
                               {Projection::perspective, {.31, .42, .63}}};

Scene posed(const ClipPose& pose, const TransferFunction& transfer_function) {
    Scene scene = unit_box_scene(transfer_function, pose.projection, 61, 47);
    scene.camera->eye = pose.eye;
    scene.camera->center = {.52, .47, .51};
    scene.camera->up = {0, 1, .02};
    scene.camera->fov_y = 60;
    return scene;
}

Volume constant() {
    return generate({"constant", std::array<std::int64_t, 3>{9, 12, 7}, SampleType::uint8});
}

using Draw = std::function<Image(const Volume&, const Scene&, const OmissionSwitch&)>;

void expect_clipped_chords(const Draw& draw) {
    const Volume volume = constant();
    for (const ClipPose& pose : clip_poses) {
        for (const test::NamedClip& named : test::clips_of_unit_box()) {
            for (const double depth : {1e-4, 3.}) {
                const double extinction = depth / std::sqrt(3.0);
                Scene scene =
                    posed(pose, TransferFunction::linear({knot(0, {1, 1, 1}, extinction)}));
                scene.clip = named.clip;
                const View view(*scene.camera, scene.width, scene.height);
                for (const int samples : {1, 7, 256}) {
                    scene.slice.samples = samples;
                    const Image image = draw(volume, scene, {});
                    double worst = 0;
                    for (int row = 0; row < view.height; ++row) {
                        for (int column = 0; column < view.width; ++column) {
                            const double length = test::kept_length(
                                named.clip, view.ray(column, row), {0, 0, 0}, {1, 1, 1});
                            worst = std::max(worst, std::abs(image.pixel(column, row)[3] +
                                                             std::expm1(-extinction * length)));
                        }
                    }
                    EXPECT_LE(worst, chord_bound(depth))
                        << named.name << ", depth " << depth << ", " << samples << " slabs";
                }
                scene.slice.samples = 7;
                EXPECT_LE(linf(draw(volume, scene, {}), draw(volume, scene, leave_nothing_out())),
                          255 * 2 * chord_bound(depth))
                    << named.name;
            }
        }
    }
}

TEST(ClippedCpuPictures, HomogeneousBoxHasTheExactChordsOpacity) {
    expect_clipped_chords(
        [](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render_tiles(volume, scene, omissions);
        });
}

TEST_F(SlicingTest, ClippedHomogeneousBoxHasTheExactChordsOpacity) {
    expect_clipped_chords(
        [&](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render(volume, scene, capabilities(), omissions);
        });
}

// Returns the largest error of a length inside the unit box and a clip if rays are float32. The
// distance to a plane is off by 16 roundings of coordinates, which are up to 3; a ray that grazes
// the plane meets it so much farther away.
double float_error_of_length(const Clip& clip, const View::Ray& ray) {
    constexpr double off = 16 * 0x1p-24 * 3;
    std::vector<HalfSpace> faces = half_spaces({{}, ClipBox{{0, 0, 0}, {1, 1, 1}}});
    for (const HalfSpace& half : half_spaces(clip)) faces.push_back(half);
    double error = 0;
    for (const HalfSpace& half : faces) {
        const glm::dvec3 normal = glm::normalize(half.normal);
        error += off / std::abs(glm::dot(normal, glm::normalize(ray.direction)));
    }
    return error;
}

TEST_F(SlicingTest, FloatRaysEndAtClipPlanes) {
    const Volume volume = constant();
    Capabilities gpu = capabilities();
    gpu.software = false;
    for (const ClipPose& pose : clip_poses) {
        for (const test::NamedClip& named : test::clips_of_unit_box()) {
            Scene scene = posed(pose, TransferFunction::linear({knot(0, {1, 1, 1}, 2)}));
            scene.clip = named.clip;
            scene.slice.samples = 7;
            const Facts facts = measure(scene, volume, measure_bricks(volume));
            ASSERT_FALSE(make_plan(scene, facts, gpu, {}).slice.precise_rays);
            const View view(*scene.camera, scene.width, scene.height);
            const Image image = render(volume, scene, gpu);
            for (int row = 0; row < view.height; ++row) {
                for (int column = 0; column < view.width; ++column) {
                    const View::Ray ray = view.ray(column, row);
                    const double length = test::kept_length(named.clip, ray, {0, 0, 0}, {1, 1, 1});
                    // In addition to the lengths' errors there are those of sums of eight opacities
                    // in float32.
                    ASSERT_NEAR(image.pixel(column, row)[3], -std::expm1(-2 * length),
                                2 * float_error_of_length(named.clip, ray) + 16 * 0x1p-24)
                        << named.name;
                }
            }
        }
    }
}

// Moves a clip of the unit box into a grid's box.
Clip in_box_of(const Grid& grid, Clip clip) {
    const Grid::Bounds box = grid.bounds();
    const glm::dvec3 size = box.max - box.min;
    for (ClipPlane& plane : clip.planes) {
        plane.point = box.min + plane.point * size;
        plane.normal /= size;
    }
    if (clip.box)
        clip.box = ClipBox{box.min + clip.box->min * size, box.min + clip.box->max * size};
    return clip;
}

// Returns grids that are rotated, mirrored and anisotropic; with node and cell axes; and thin.
std::vector<Grid> grids() {
    Grid turned = test::grid_of({9, 14, 11}, Centering::cell);
    turned.origin = {3, -200, 40};
    const double c = std::cos(.3), s = std::sin(.3);
    turned.step = {glm::dvec3(c, s, 0) * .1, glm::dvec3(s, -c, 0) * .07, glm::dvec3(0, 0, -.13)};
    Grid node = test::grid_of({10, 8, 12}, Centering::node);
    Grid thin = test::grid_of({13, 1, 16}, Centering::cell);
    return {turned, node, thin};
}

Scene looking_at(const Grid& grid, Projection projection,
                 const TransferFunction& transfer_function) {
    const Grid::Bounds box = grid.bounds();
    const double diagonal = glm::length(box.max - box.min);
    Scene scene = unit_box_scene(transfer_function, projection, 60, 45);
    scene.camera->center = .5 * (box.min + box.max);
    scene.camera->eye =
        scene.camera->center + .9 * diagonal * glm::normalize(glm::dvec3(.7, .45, .8));
    scene.camera->height = .8 * diagonal;
    return scene;
}

Volume noisy(const Grid& grid) {
    return test::noise(grid, 11);
}

TransferFunction many_colors(const Grid& grid, double depth) {
    const double extinction = depth / box_diagonal(grid);
    return TransferFunction::linear({knot(60, {.1, .8, .4}, 0), knot(110, {1, .2, .3}, extinction),
                                     knot(125, {.2, .3, 1}, .1 * extinction),
                                     knot(200, {.9, .9, .1}, 2 * extinction)});
}

// Largest error, in 1/255, that exact segments promise (docs/precision.md).
constexpr double promised = .05;

void expect_exact_segments(const Draw& draw, const std::vector<Grid>& in,
                           const std::vector<test::NamedClip>& clips) {
    for (const Grid& grid : in) {
        const Volume volume = noisy(grid);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Scene scene = looking_at(grid, projection, many_colors(grid, 3));
            scene.slice.classification = Classification::exact;
            for (const test::NamedClip& named : clips) {
                scene.clip = in_box_of(grid, named.clip);
                const Image reference = trace(volume, scene, 1e-7);
                for (const int samples : {1, 40}) {
                    scene.slice.samples = samples;
                    EXPECT_LE(linf(draw(volume, scene, {}), reference), promised) << named.name;
                }
                // Five images of 8 bits: writing optical depths costs at most 1.445 Y / 2 with Y =
                // 1 + ln(5) / e (docs/numerics.md, section 4), and colours and root .5 each.
                scene.target = Target::fixed8;
                scene.slice.tree = TreeSettings{.factors = {5, 8}};
                EXPECT_LE(linf(draw(volume, scene, {}), reference),
                          1.445 * (1 + std::log(5) / std::exp(1)) / 2 + 1 + promised)
                    << named.name;
                scene.target = Target::float32;
                scene.slice.tree.reset();
            }
        }
    }
}

TEST(ClippedCpuPictures, ExactSegmentsMeetTheTracer) {
    expect_exact_segments(
        [](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render_tiles(volume, scene, omissions);
        },
        grids(), test::clips_of_unit_box());
}

// A single clip, because each number of planes is another program, which takes seconds to compile.
TEST_F(SlicingTest, ClippedExactSegmentsMeetTheTracer) {
    expect_exact_segments(
        [&](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render(volume, scene, capabilities(), omissions);
        },
        {grids()[0]}, {test::clips_of_unit_box()[0]});
}

// Slabs are h = 1.7 / 800 thick. From cell to cell, the slope of extinction along a ray changes by
// at most 24 (extinction is 12 per unit of the scalar, whose slope changes by 2), so a segment
// there is off by 24 h^2 / 8 of optical depth. For 33 cells that is 4.5e-4, or .11 / 255; errors
// within cells and at the transfer function's points are smaller.
void expect_many_slabs_to_converge(const Draw& draw, std::span<const ClipPose> from) {
    const Volume volume = gaussians(12);
    for (const ClipPose& pose : from) {
        Scene scene = posed(pose, smooth_transfer_function());
        for (const test::NamedClip& named : test::clips_of_unit_box()) {
            scene.clip = named.clip;
            const Image reference = trace(volume, scene, 1e-6);
            for (const auto classification :
                 {Classification::post, Classification::preintegrated}) {
                scene.slice.classification = classification;
                scene.slice.samples = 800;
                EXPECT_LE(linf(draw(volume, scene, {}), reference), .11)
                    << named.name << ", " << name_of(classification);
            }
        }
    }
}

TEST(ClippedCpuPictures, ManySlabsMeetTheTracer) {
    expect_many_slabs_to_converge(
        [](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render_tiles(volume, scene, omissions);
        },
        clip_poses);
}

TEST_F(SlicingTest, ManyClippedSlabsMeetTheTracer) {
    expect_many_slabs_to_converge(
        [&](const Volume& volume, const Scene& scene, const OmissionSwitch& omissions) {
            return render(volume, scene, capabilities(), omissions);
        },
        std::span(clip_poses).subspan(1, 1));
}

// A wall hides the volume behind it, and a clip plane cuts the wall away: rays must end early only
// behind the plane.
TEST(ClippedCpuPictures, RaysEndEarlyBehindThePlane) {
    const Grid grid = test::grid_of({32, 32, 32}, Centering::node);
    const Volume volume = test::volume_of<std::uint8_t>(
        grid, [](double x, double y, double z) { return z < 8 ? 255 : 4 * x + 3 * y; });
    Scene scene = looking_at(grid, Projection::perspective, many_colors(grid, 200));
    scene.camera->eye = scene.camera->center + glm::dvec3(3, 5, -60);
    scene.clip.planes = {{{0, 0, 9.5}, {.1, 0, 1}}};
    for (const auto classification : {Classification::exact, Classification::post}) {
        scene.slice.classification = classification;
        scene.slice.samples = 2000;
        const Facts facts = measure(scene, volume, measure_bricks(volume));
        EXPECT_TRUE(make_plan(scene, facts, cpu_capabilities(), {}).slice.ends_early());
        // Post-classified slabs are .03 voxels thick. If the plane were off by one slab, the
        // optical depth would be off by .3, tens of 255; the error of second order is far smaller.
        EXPECT_LE(linf(render_tiles(volume, scene), trace(volume, scene, 1e-7)),
                  classification == Classification::exact ? promised : .5);
    }
}

TEST(ClippedCpuPictures, BricksBehindPlanesAreLeftOut) {
    const Grid grid = test::grid_of({33, 33, 33}, Centering::node);
    const Volume volume = noisy(grid);
    Scene scene = looking_at(grid, Projection::perspective, many_colors(grid, 3));
    scene.slice.classification = Classification::exact;
    scene.clip.box = ClipBox{{8, 12, 16}, {20, 24, 20}};
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_EQ(facts.occupied.min, glm::dvec3(8, 12, 16));
    EXPECT_EQ(facts.occupied.max, glm::dvec3(20, 24, 20));
    EXPECT_FALSE(facts.clipped_away);
    const auto drawn = cpu_renderer(volume, scene);
    drawn->draw(View(*scene.camera, scene.width, scene.height));
    scene.clip = {};
    const auto whole = cpu_renderer(volume, scene);
    whole->draw(View(*scene.camera, scene.width, scene.height));
    EXPECT_LT(10 * drawn->fragments(), whole->fragments());
}

TEST(ClippedCpuPictures, PlanesThatCutNothingAreLeftOut) {
    Scene scene = posed(clip_poses[1], smooth_transfer_function());
    const Volume volume = gaussians(12);
    scene.clip = test::clips_of_unit_box()[8].clip;  // keeps all of the box
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_EQ(facts.clip.size(), 7u);
    EXPECT_TRUE(make_plan(scene, facts, cpu_capabilities(), {}).slice.clip.empty());
    EXPECT_EQ(make_plan(scene, facts, cpu_capabilities(), leave_nothing_out()).slice.clip.size(),
              7u);
    const Image clipped = render_tiles(volume, scene);
    scene.clip = {};
    EXPECT_EQ(clipped.rgba, render_tiles(volume, scene).rgba);
}

TEST(ClippedCpuPictures, NothingIsDrawnIfNothingIsLeft) {
    Scene scene = posed(clip_poses[1], smooth_transfer_function());
    const Volume volume = gaussians(12);
    scene.clip.planes = {{{1.5, .5, .5}, {1, 0, 0}}};
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    EXPECT_TRUE(facts.clipped_away);
    const Plan plan = make_plan(scene, facts, cpu_capabilities(), {});
    EXPECT_TRUE(plan.slice.nothing_visible);
    EXPECT_EQ(plan.omitted.back().reason,
              "the clip cuts all away that the transfer function shows");
}

}  // namespace
}  // namespace lamina
