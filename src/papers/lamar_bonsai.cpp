// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, Figure 1: the bonsai.
#include <fmt/format.h>

#include <cstdlib>

#include "papers/findings.h"
#include "papers/lamar.h"
#include "papers/lamar_stage.h"
#include "papers/panels.h"
#include "study/text_file.h"
#include "volume_files/volume_file.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* says =
    "our technique is capable of capturing most of the important image features";

std::filesystem::path bonsai_file() {
    const char* const data = std::getenv("LAMINA_DATA");
    return data == nullptr ? std::filesystem::path() : std::filesystem::path(data) / "bonsai.nrrd";
}

Json skipped() {
    return {{"values", nullptr},
            {"paper", {{"says", {says}}}},
            {"agrees", nullptr},
            {"note", "skipped: set LAMINA_DATA to a folder that holds bonsai.nrrd"},
            {"checks", Json::array()}};
}

// Lengths are in voxels. Leaves are thin and wood is denser.
Scene bonsai_scene() {
    Scene scene;
    const auto knot = [](double value, const glm::dvec3& color, double extinction) {
        return TransferKnot{value, {color, extinction}};
    };
    scene.transfer_function = TransferFunction::linear(
        {knot(28, {.05, .25, .02}, 0), knot(52, {.1, .5, .05}, .006), knot(90, {.55, .4, .08}, .01),
         knot(140, {.5, .22, .08}, .03), knot(255, {1, .85, .6}, .1)});
    scene.camera.eye = {500, 230, 490};
    scene.camera.center = {127.5, 115, 127.5};
    scene.camera.fov_y = 35;
    scene.width = 320;
    scene.height = 240;
    scene.slice.classification = Classification::post;
    scene.slice.samples = 512;
    return scene;
}

}  // namespace

Json draw_figure1(const std::filesystem::path& folder, LamarStage& stage) {
    const std::filesystem::path file = bonsai_file();
    if (!std::filesystem::exists(file)) return skipped();
    const auto bonsai = std::make_shared<const VolumeData>(read_volume(file));
    const Scene scene = bonsai_scene();
    const Image exact = SceneRenderer(scene, bonsai, stage.capabilities()).draw_picture();
    Panels panels;
    panels.add("", "software", exact);
    Json rows = Json::array();
    std::vector<ErrorNorms> errors;
    const auto add = [&](const char* name, const Scene& approximate) {
        const Image picture =
            SceneRenderer(approximate, bonsai, stage.capabilities()).draw_picture();
        panels.add("", name, picture);
        const ErrorNorms e = image_error(picture, exact).all;
        errors.push_back(e);
        rows.push_back({{"picture", name}, {"linf", e.linf}, {"l1", e.l1}, {"l2", e.l2}});
    };
    Scene hardware = with_paper_hardware(scene);
    add("hardware", hardware);
    hardware.slice.dither = DitherSettings{.period = 11, .color = true};
    add("hardware with dithering", hardware);
    Scene tree = scene;
    tree.target = Target::fixed8;
    tree.slice.tree = TreeSettings{.factors = {16, 32}};
    add("8-bit tree 16x32 of shader nodes", tree);
    study::write_text(folder / "figure1.csv", study::csv_of_rows(rows));
    Findings findings;
    findings.add(says, errors[1].l2 < errors[0].l2 && errors[1].linf < errors[0].linf,
                 fmt::format("dithering is nearer to software than naive hardware is: it takes L2 "
                             "from {:.2f} to {:.2f} and Linf from {:.1f} to {:.1f}; a tree of "
                             "shader nodes has L2 {:.3f} and Linf {:.2f}",
                             errors[0].l2, errors[1].l2, errors[0].linf, errors[1].linf,
                             errors[2].l2, errors[2].linf));
    return findings.result(
        {{"files", {"figure1.csv"}}, {"samples", 512}, {"rows", rows}, {"panels", panels.json()}},
        nullptr, "Transfer function and view are ours; colour is dithered too, period 11.");
}

}  // namespace lamina::papers
