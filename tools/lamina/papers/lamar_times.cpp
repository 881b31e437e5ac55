// SPDX-License-Identifier: Apache-2.0
// Times of the techniques of LaMar 2004, which the paper does not report, and of ours.
#include "papers/figure_files.h"
#include "papers/lamar.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <span>

#include "compositing/codes.h"
#include "executors/gl_compositing.h"
#include "gl/framebuffer.h"
#include "papers/paper_item.h"
#include "render/pipeline.h"
#include "study/report_files.h"
#include "study/study_frames.h"
#include "volume/generate.h"

namespace lamina::papers {
namespace {

constexpr int entries = 256;
constexpr std::size_t row_bytes = 4 * entries;

// Returns palettes of white. Entry i has an opacity of .004 i codes, which dithering shows as code
// 0 or 1.
std::vector<std::uint8_t> dithered_palettes(int period) {
    const std::vector<std::uint32_t> ranks = dither_ranks(period, 1);
    std::vector<std::uint8_t> palettes;
    for (const std::uint32_t rank : ranks) {
        for (int entry = 0; entry < entries; ++entry) {
            const std::uint32_t code = dither_code(0.004 * entry, rank, period, 1, 255);
            palettes.insert(palettes.end(), 4, static_cast<std::uint8_t>(code));
        }
    }
    return palettes;
}

gl::Texture random_indices(int pixels) {
    SplitMix64 random(1);
    std::vector<std::uint8_t> indices(static_cast<std::size_t>(pixels) *
                                      static_cast<std::size_t>(pixels));
    for (std::uint8_t& index : indices) index = static_cast<std::uint8_t>(random.next() >> 56);
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::r8, pixels, pixels);
    texture.upload({0, 0, 0, pixels, pixels, 1}, std::span<const std::uint8_t>(indices));
    return texture;
}

gl::Defines defines_of(PaletteSlices::Source source, int period) {
    gl::Defines defines;
    if (source == PaletteSlices::Source::lookup) defines.set("PALETTES", period);
    return defines;
}

using Json = nlohmann::ordered_json;

constexpr int timed_pixels = 512, slices = 1024, rounds = 3;
constexpr int palette_period = 16;
// Side of the volume's square as a share of the picture's: it covers a quarter of the picture,
// while the nodes of a tree are composited over all of it.
constexpr double volume_in_picture = 0.5;
constexpr double nearly_nothing = 64;  // factor of the camera's height at which the volume is a dot

// Returns a scene like mixing_scene(), with optical depth 1.45 through the heavy liquid, but with
// two points only.
Scene timed_scene(bool white) {
    Scene scene;
    const auto color = [&](const glm::dvec3& c) { return white ? glm::dvec3(1) : c; };
    scene.transfer_function =
        TransferFunction::linear({{0, {color({0, 1, 0}), .02}}, {255, {color({1, 0, 0}), 1.45}}});
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {0.5, 0.5, 2};
    scene.camera->center = glm::dvec3(0.5);
    scene.camera->height = 1 / volume_in_picture;
    scene.width = scene.height = timed_pixels;
    scene.slice.classification = Classification::post;
    scene.slice.samples = slices;
    return scene;
}

// A technique to be timed. `blend` makes float32 blend in the frame buffer instead of in registers.
struct Technique {
    std::string name;
    Target target = Target::fixed8;
    bool white = false;
    std::vector<int> factors{};
    NodeArithmetic nodes = NodeArithmetic::shader;
    bool dither = false;
    bool blend = false;
};

std::vector<Technique> timed_techniques() {
    const std::vector<int> binary(10, 2), quaternary(5, 4), two{32, 32};
    const auto fixed = NodeArithmetic::fixed;
    return {{"straight fixed8"},
            {"straight float16", Target::float16},
            {.name = "straight float32, blended", .target = Target::float32, .blend = true},
            {"straight float32, in registers", Target::float32},
            {"emulated 8 bits, in registers", Target::emulated},
            {.name = "emulated 8 bits, dithered", .target = Target::emulated, .dither = true},
            {.name = "fixed8, dithered", .dither = true},
            {.name = "shader tree 2^10", .factors = binary},
            {.name = "shader tree 4^5", .factors = quaternary},
            {.name = "shader tree 32x32", .factors = two},
            {.name = "shader tree 1024", .factors = {slices}},
            {.name = "straight fixed8, white", .white = true},
            {.name = "fixed tree 32x32, white", .white = true, .factors = two, .nodes = fixed},
            {.name = "fixed tree 2^10, white", .white = true, .factors = binary, .nodes = fixed}};
}

Scene scene_of(const Technique& technique) {
    Scene scene = timed_scene(technique.white);
    scene.target = technique.target;
    if (technique.dither) scene.slice.dither = DitherSettings{.period = palette_period};
    if (!technique.factors.empty()) {
        scene.slice.tree = TreeSettings{.factors = technique.factors, .nodes = technique.nodes};
    }
    return scene;
}

// Returns a timed frame. The frame with a tiny volume has a renderer of its own, because a change
// of the camera would count in the times.
study::TimedFrame frame_of(const std::string& name, const std::shared_ptr<const VolumeData>& volume,
                           const Scene& scene, const PipelineOptions& how) {
    const auto frames = std::make_shared<Pipeline>(scene, SceneData(volume), how);
    Scene far = scene;
    far.camera->height *= nearly_nothing;
    const auto far_frames = std::make_shared<Pipeline>(far, SceneData(volume), how);
    frames->set_up();
    far_frames->set_up();
    return {name, [far_frames] { far_frames->draw_frame(); }, [frames] { frames->draw_frame(); }};
}

Json time_techniques(const std::shared_ptr<const VolumeData>& volume, const LamarStage& stage) {
    std::vector<study::TimedFrame> frames;
    for (const Technique& technique : timed_techniques()) {
        OmissionSwitch omissions;
        if (technique.blend) omissions.kept = {"blending"};
        frames.push_back(frame_of(technique.name, volume, scene_of(technique),
                                  {.capabilities = stage.capabilities(),
                                   .omissions = omissions,
                                   .tables = stage.tables()}));
    }
    return time_rows(frames, study::time_interleaved("times: techniques", frames, rounds));
}

// Measures the cost of a palette for every slice, which section 5 leaves open.
Json time_palettes(bool& same_picture) {
    using Source = PaletteSlices::Source;
    std::vector<study::TimedFrame> frames;
    std::array<Image, 2> images;
    const auto add = [&](const char* name, Source source, Image& image) {
        const auto all =
            std::make_shared<PaletteSlices>(source, timed_pixels, slices, palette_period);
        const auto few = std::make_shared<PaletteSlices>(source, timed_pixels, 1, palette_period);
        frames.push_back({name, [few] { few->draw(); }, [all, &image] { image = all->draw(); }});
    };
    add("one dependent lookup", Source::lookup, images[0]);
    add("an upload a slice", Source::upload, images[1]);
    const std::vector<study::FrameTimes> times =
        study::time_interleaved("times: palettes", frames, rounds);
    same_picture = images[0].rgba == images[1].rgba;
    return time_rows(frames, times);
}

}  // namespace

PaletteSlices::PaletteSlices(Source source, int pixels, int slices, int period)
    : source_(source),
      slices_(slices),
      period_(period),
      palettes_(dithered_palettes(period)),
      indices_(random_indices(pixels)),
      palette_(gl::Texture::make_2d(gl::TextureFormat::rgba8, entries,
                                    source == Source::lookup ? period : 1)),
      target_(gl::Texture::make_2d(gl::TextureFormat::rgba8, pixels, pixels)),
      program_("gl/full_screen.vert", "study/palette.frag", defines_of(source, period)) {
    program_.set("indices", 0);
    program_.set("palette", 1);
    if (source == Source::lookup) {
        palette_.upload({0, 0, 0, entries, period, 1}, std::span<const std::uint8_t>(palettes_));
    }
}

Image PaletteSlices::draw() {
    target_.bind();
    target_.clear(glm::vec4(0));
    indices_.bind(0);
    palette_.bind(1);
    const CompositingState blending(CompositingPlan{}, false);
    const std::span<const std::uint8_t> palettes(palettes_);
    for (int slice = 0; slice < slices_; ++slice) {
        if (source_ == Source::upload) {
            const auto row = static_cast<std::size_t>(slice % period_);
            palette_.upload({0, 0, 0, entries, 1, 1}, palettes.subspan(row * row_bytes, row_bytes));
        }
        program_.set("slice", slice);
        gl::draw_full_screen(program_, no_attributes_);
    }
    return target_.read_back();
}

Json draw_times(const std::filesystem::path& folder, LamarStage& stage) {
    const auto volume = std::make_shared<const VolumeData>(
        generate({"mixing", std::array<std::int64_t, 3>{128, 128, 128}, SampleType::uint8}));
    Json values{{"files", {"times.csv", "times_palettes.csv"}},
                {"renderer", renderer_and_threads(stage.capabilities())},
                {"pixels", timed_pixels},
                {"covered_share", volume_in_picture * volume_in_picture},
                {"samples", slices},
                {"rounds", rounds}};
    values["techniques"] = time_techniques(volume, stage);
    bool same_picture = false;
    values["palettes"] = time_palettes(same_picture);
    study::write_text(folder / "times.csv", csv_of_rows(values["techniques"]));
    study::write_text(folder / "times_palettes.csv", csv_of_rows(values["palettes"]));
    Findings findings;
    findings.add(
        "However, one could use dependent texture lookups to implement this kind of dithering.",
        same_picture,
        same_picture ? "they give the codes that a palette uploaded for each slice gives"
                     : "they give other codes than a palette uploaded for each slice");
    const double upload = values["palettes"][1]["ratio"];
    return findings.result(
        values, nullptr,
        fmt::format("The paper gives no times. Here an upload a slice takes {:.2f} times as long "
                    "as a dependent lookup; ratios in `techniques` are to straight fixed8.",
                    upload));
}

}  // namespace lamina::papers
