// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, Figure 1: the bonsai.
#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "papers/figure_files.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "study/report_files.h"
#include "volume_files/volume_file.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* figure1_says =
    "Figure 1 compares our technique to software and naive hardware solutions, and shows that our "
    "technique is capable of capturing most of the important image features.";
constexpr int bonsai_slabs = 512, few_bonsai_slabs = 64, bonsai_period = 11;

std::filesystem::path bonsai_file() {
    const char* const data = std::getenv("LAMINA_DATA");
    return data == nullptr ? std::filesystem::path() : std::filesystem::path(data) / "bonsai.nrrd";
}

Json skipped() {
    Findings findings;
    findings.add_untestable(figure1_says, false, "nothing is drawn without bonsai.nrrd");
    Json result = findings.result(nullptr);
    for (const char* const key : {"remark", "note"})
        result[key] = "skipped: set LAMINA_DATA to a folder that holds bonsai.nrrd";
    return result;
}

// Returns the scene; lengths are in voxels. Leaves are thin, and wood is denser.
Scene bonsai_scene() {
    Scene scene;
    const auto knot = [](double value, const glm::dvec3& color, double extinction) {
        return TransferKnot{value, {color, extinction}};
    };
    scene.transfer_function = TransferFunction::linear(
        {knot(28, {.05, .25, .02}, 0), knot(52, {.1, .5, .05}, .006), knot(90, {.55, .4, .08}, .01),
         knot(140, {.5, .22, .08}, .03), knot(255, {1, .85, .6}, .1)});
    scene.camera->eye = {500, 230, 490};
    scene.camera->center = {127.5, 115, 127.5};
    scene.camera->fov_y = 35;
    scene.width = 320;
    scene.height = 240;
    scene.slice.classification = Classification::post;
    scene.slice.samples = bonsai_slabs;
    return scene;
}

// Tells how much a picture shows of the leaves: the pixels that are green in the exact picture.
struct Leaves {
    double light[3] = {};  // sum of each channel, over that of the exact picture
    double kept = 0;       // share of the pixels with at least half of their exact green
    double black = 0;      // share of the pixels that show nothing
};

Leaves leaves_of(const Image& image, const Image& exact) {
    constexpr float faintest = 2.0f / 255;  // least green of a leaf
    double sums[3] = {}, exact_sums[3] = {};
    int count = 0, kept = 0, black = 0;
    for (std::size_t i = 0; i < exact.rgba.size(); i += 4) {
        const float *const wanted = &exact.rgba[i], *const shown = &image.rgba[i];
        if (wanted[1] < faintest || wanted[1] <= wanted[0] || wanted[1] <= wanted[2]) continue;
        ++count;
        kept += shown[1] >= wanted[1] / 2;
        black += shown[0] == 0 && shown[1] == 0 && shown[2] == 0;
        for (int channel = 0; channel < 3; ++channel) {
            sums[channel] += shown[channel];
            exact_sums[channel] += wanted[channel];
        }
    }
    Leaves leaves;
    if (count == 0) return leaves;
    leaves.kept = static_cast<double>(kept) / count;
    leaves.black = static_cast<double>(black) / count;
    for (int channel = 0; channel < 3; ++channel)
        leaves.light[channel] = sums[channel] / exact_sums[channel];
    return leaves;
}

Scene dithered_by_paper(const Scene& scene) {
    Scene hardware = with_paper_hardware(scene);
    hardware.slice.dither = DitherSettings{.period = bonsai_period, .color = true};
    return hardware;
}

// Draws variants of the picture and compares each with the exact one.
class Bonsai {
  public:
    Bonsai(std::shared_ptr<const VolumeData> volume, const LamarStage& stage)
        : volume_(std::move(volume)), stage_(stage) {}

    void set_exact(const char* name, const Scene& scene) {
        exact_ = draw(scene);
        panels_.add("", name, exact_);
    }
    Leaves add(const char* name, const Scene& scene) {
        const Image picture = draw(scene);
        panels_.add("", name, picture);
        const ErrorNorms e = image_error(picture, exact_).all;
        const Leaves leaves = leaves_of(picture, exact_);
        rows_.push_back({{"picture", name},
                         {"linf", e.linf},
                         {"l1", e.mean},
                         {"l2", e.l2},
                         {"leaves_kept", leaves.kept},
                         {"leaves_black", leaves.black},
                         {"leaves_red", leaves.light[0]},
                         {"leaves_green", leaves.light[1]},
                         {"leaves_blue", leaves.light[2]}});
        return leaves;
    }
    const Json& rows() const { return rows_; }
    const Json& panels() const { return panels_.json(); }

  private:
    Image draw(const Scene& scene) const {
        return plain_picture(scene, SceneData(volume_), stage_.capabilities(), stage_.tables());
    }

    std::shared_ptr<const VolumeData> volume_;
    const LamarStage& stage_;
    Image exact_;
    Panels panels_;
    Json rows_ = Json::array();
};

}  // namespace

// Counts the leaves as kept if more than half of their pixels have at least half of their green.
//
// With dithering fewer than half have it, because of the method and not of its implementation: the
// opacity of a leaf in one of 512 slabs is a code of 1 or 2, and OVER rounds its product with each
// channel of the colour to a whole code. At code 2 a leaf's .2, 1 and .1 codes of red, green and
// blue become 0, 1 and 0, and a twig's 1.1, .8 and .2 become 1, 1 and 0, which is olive. Dithering
// changes opacity and colour before they are multiplied, so it cannot restore what the product
// loses.
Json draw_figure1(const std::filesystem::path& folder, LamarStage& stage) {
    const std::filesystem::path file = bonsai_file();
    if (!std::filesystem::exists(file)) return skipped();
    Bonsai bonsai(std::make_shared<const VolumeData>(read_volume(file)), stage);
    const Scene scene = bonsai_scene();
    bonsai.set_exact("software", scene);
    bonsai.add("hardware", with_paper_hardware(scene));
    const Leaves many = bonsai.add("hardware with dithering", dithered_by_paper(scene));
    Scene tree = scene;
    tree.target = Target::fixed8;
    tree.slice.tree = TreeSettings{.factors = {16, 32}};
    const Leaves in_tree = bonsai.add("8-bit tree 16x32 of shader nodes", tree);
    Scene coarse = scene;
    coarse.slice.samples = few_bonsai_slabs;
    bonsai.set_exact("software, 64 slabs", coarse);
    const Leaves few = bonsai.add("hardware with dithering, 64 slabs", dithered_by_paper(coarse));
    study::write_text(folder / "figure1.csv", csv_of_rows(bonsai.rows()));
    Findings findings;
    findings.add(
        figure1_says, many.kept > 0.5,
        fmt::format(
            "with {} slabs {:.0f} % of the leaves' pixels keep at least half of their green "
            "and {:.0f} % are black; of their light {:.0f} % of the red, {:.0f} % of the "
            "green and {:.0f} % of the blue are left, so leaves turn olive. L2 falls from "
            "{:.2f} without dithering to {:.2f}. With {} slabs, whose opacities are larger "
            "codes, {:.0f} % keep their green",
            bonsai_slabs, 100 * many.kept, 100 * many.black, 100 * many.light[0],
            100 * many.light[1], 100 * many.light[2], bonsai.rows()[0]["l2"].get<double>(),
            bonsai.rows()[1]["l2"].get<double>(), few_bonsai_slabs, 100 * few.kept));
    findings.add_own("An 8-bit tree of shader nodes keeps the leaves", in_tree.kept > 0.99,
                     fmt::format("{:.1f} % of their pixels keep their green, L2 {:.3f}",
                                 100 * in_tree.kept, bonsai.rows()[2]["l2"].get<double>()));
    return findings.result(
        {{"files", {"figure1.csv"}},
         {"samples", bonsai_slabs},
         {"rows", bonsai.rows()},
         {"panels", bonsai.panels()},
         {"caption",
          "The bonsai through 512 slabs: exact (software), composited in 8 bits (hardware), "
          "dithered along depth as well, and in a tree; then exact and dithered through 64 slabs. "
          "leaves_...: shares of the pixels that are green in the exact picture, and of their "
          "light."}},
        nullptr,
        "OVER rounds the product of opacity and colour, which dithering cannot mend. Transfer "
        "function, view and number of slabs are ours; colour is dithered too, period 11.");
}

}  // namespace lamina::papers
