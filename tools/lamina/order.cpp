// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/process.h"
#include "base/profile.h"
#include "lamina/scene.h"
#include "mesh/mesh_shape.h"
#include "mesh_files/mesh_file.h"
#include "reference/order_pixels.h"
#include "render/pipeline.h"
#include "scene/scene.h"
#include "scene_files/scene_reader.h"
#include "shared_options.h"
#include "verbs.h"
#include "visibility/visibility_order.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array methods{OrderMethod::mpvo, OrderMethod::exact, OrderMethod::centroid,
                             OrderMethod::none};
constexpr int timed_sorts = 3;  // for each view, after a sort that is not timed
constexpr int most_eyes = 10'000;

struct OrderOptions {
    std::string input;
    int eyes = 6;
    std::string size = "128x128";
    bool json = false, quiet = false;
};

struct Input {
    TetMesh mesh;
    std::optional<Camera> camera;  // the scene's own, if it has one
};

Input load(const std::string& file) {
    const FileKind kind = kind_of_file(file);
    if (kind == FileKind::mesh) return {TetMesh(read_mesh(file), file), {}};
    if (kind == FileKind::volume) {
        std::error_code unknown;
        if (!std::filesystem::exists(file, unknown)) fail("{}: no such file", file);
        fail(
            "{}: is a volume, expected a mesh (.vtu, .pvtu, .pvd, .vtk, .node, .ele) or a scene "
            "(JSON)",
            file);
    }
    Scene scene = load_scene(file);
    if (!scene.has_mesh()) fail("{}: has no \"mesh\", whose tets could be put in order", file);
    scene.method = Method::project;
    Pipeline pipeline(scene);
    return {pipeline.data().mesh(pipeline.scene())->mesh, *pipeline.scene().camera};
}

// Returns a number of Halton's sequence: the digits of `index` in base `base`, mirrored at the
// point.
double radical_inverse(int index, int base) {
    double value = 0, digit = 1;
    for (; index > 0; index /= base) value += (index % base) * (digit /= base);
    return value;
}

// Returns the camera of a view. Views alternate: perspective from outside the mesh, orthographic
// from there, and perspective from inside its box.
Camera camera_of(int index, const TetMesh& mesh) {
    const glm::dvec3 extent = mesh.bounds().max - mesh.bounds().min;
    const double diagonal = glm::length(extent);
    const double u = radical_inverse(index + 1, 2), v = radical_inverse(index + 1, 3),
                 w = radical_inverse(index + 1, 5);
    const double height = 2 * u - 1, turn = 2 * std::numbers::pi * v;
    const double ring = std::sqrt(1 - height * height);
    const glm::dvec3 outwards(ring * std::cos(turn), ring * std::sin(turn), height);
    Camera camera;
    camera.up = {-std::sin(turn), std::cos(turn), 0};  // perpendicular to `outwards`
    camera.center = 0.5 * mesh.bounds().min + 0.5 * mesh.bounds().max;
    camera.eye = camera.center + 1.4 * diagonal * outwards;
    camera.height = diagonal;
    if (index % 3 == 1) camera.projection = Projection::orthographic;
    if (index % 3 == 2) {
        camera.fov_y = 90;
        camera.eye = mesh.bounds().min + extent * glm::dvec3(u, v, w);
        camera.center = camera.eye + diagonal * outwards;
    }
    return camera;
}

// Results of one order method over all views.
struct Outcome {
    std::vector<double> ms;       // of each timed sort
    std::int64_t violations = 0;  // shared faces whose tets are drawn in the wrong order
    OrderPixels pixels;
    std::int64_t cycles = 0, cyclic_tets = 0;  // largest numbers in one view

    double wrong_share() const {
        return pixels.covered > 0
                   ? static_cast<double>(pixels.wrong) / static_cast<double>(pixels.covered)
                   : 0;
    }
    void add(const OrderPixels& found) {
        pixels.covered += found.covered;
        pixels.wrong += found.wrong;
        pixels.outside_cycles += found.outside_cycles;
        pixels.overlapping += found.overlapping;
    }
};

void time_sort(VisibilityOrder& order, const TetMesh& mesh, const Eye& eye, Outcome& outcome) {
    order.sort(eye);
    for (int i = 0; i < timed_sorts; ++i) {
        const Stopwatch watch;
        order.sort(eye);
        outcome.ms.push_back(watch.milliseconds());
    }
    outcome.violations += face_violations(mesh, eye, order.order());
    outcome.cycles = std::max(outcome.cycles, order.report().cycles);
    outcome.cyclic_tets = std::max(outcome.cyclic_tets, order.report().cyclic_tets);
}

// For each view, times the sorts of every method, and tells on the ray of each pixel whether the
// tets on it are drawn in the right order (judge_pixels()).
std::vector<Outcome> measure_orders(const Input& input, int eyes, const std::pair<int, int>& size) {
    const FaceTree open_faces(input.mesh, input.mesh.open_faces());
    std::vector<std::unique_ptr<VisibilityOrder>> orders;
    std::vector<const VisibilityOrder*> judged;
    for (const OrderMethod method : methods) {
        orders.push_back(std::make_unique<VisibilityOrder>(input.mesh, method));
        judged.push_back(orders.back().get());
    }
    std::vector<Outcome> outcomes(methods.size());
    Progress progress("ordering", std::int64_t{eyes} * size.second);
    for (int index = 0; index < eyes; ++index) {
        const bool own = index == 0 && input.camera;
        const View view(own ? *input.camera : camera_of(index, input.mesh), size.first,
                        size.second);
        for (std::size_t i = 0; i < orders.size(); ++i)
            time_sort(*orders[i], input.mesh, eye_of(view), outcomes[i]);
        const std::vector<OrderPixels> found =
            judge_pixels(input.mesh, open_faces, view, judged, [&] { progress.advance(); });
        for (std::size_t i = 0; i < found.size(); ++i) outcomes[i].add(found[i]);
    }
    return outcomes;
}

Json as_json(const Outcome& outcome, OrderMethod method, std::size_t tets) {
    Json json{{"order", name_of(method)},
              {"ms", median(outcome.ms)},
              {"tets_per_second", nullptr},
              {"face_violations", outcome.violations},
              {"covered_pixels", outcome.pixels.covered},
              {"wrong_pixels", outcome.pixels.wrong},
              {"wrong_outside_cycles", outcome.pixels.outside_cycles},
              {"wrong_where_mesh_overlaps", outcome.pixels.overlapping},
              {"cycles", outcome.cycles},
              {"cyclic_tets", outcome.cyclic_tets}};
    if (method != OrderMethod::none)
        json["tets_per_second"] = 1e3 * static_cast<double>(tets) / median(outcome.ms);
    return json;
}

void print_json(const Input& input, const std::vector<Outcome>& outcomes, int eyes) {
    Json orders = Json::array();
    for (std::size_t i = 0; i < methods.size(); ++i)
        orders.push_back(as_json(outcomes[i], methods[i], input.mesh.tets().size()));
    const Json root{{"tets", input.mesh.tets().size()},
                    {"convex", convex(input.mesh)},
                    {"eyes", eyes},
                    {"orders", orders}};
    print_result("{}\n", json_text(root, 2));
}

void print_table(const Input& input, const std::vector<Outcome>& outcomes, int eyes) {
    const std::size_t tets = input.mesh.tets().size();
    print_result("{} tets, {}; {} views\n", tets, convex(input.mesh) ? "convex" : "not convex",
                 eyes);
    print_result("{:<10}{:>9}{:>15}{:>14}{:>14}{:>16}{:>8}{:>13}\n", "order", "ms",
                 "million tets/s", "wrong faces", "wrong pixels", "outside cycles", "cycles",
                 "cyclic tets");
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const Outcome& outcome = outcomes[i];
        const std::string speed =
            methods[i] == OrderMethod::none
                ? "-"
                : fmt::format("{:.3g}", 1e-3 * static_cast<double>(tets) / median(outcome.ms));
        print_result("{:<10}{:>9.3g}{:>15}{:>14}{:>12.3g} %{:>16}{:>8}{:>13}\n",
                     name_of(methods[i]), median(outcome.ms), speed, outcome.violations,
                     100 * outcome.wrong_share(), outcome.pixels.outside_cycles, outcome.cycles,
                     outcome.cyclic_tets);
    }
    print_result(
        "ms: median of a sort. Wrong faces: the tet behind is drawn later, in all views. Wrong "
        "pixels:\nof {} that show the mesh, two tets on the ray are drawn in the wrong order; "
        "outside cycles: not\nwithin one cycle. Cycles: sets of tets that hide one another in a "
        "ring, the most in one view.\n",
        outcomes[0].pixels.covered);
    if (outcomes[1].pixels.overlapping > 0) {
        print_result(
            "{} of the pixels that are wrong with exact lie where parts of the mesh overlap.\n",
            outcomes[1].pixels.overlapping);
    }
}

void run(const OrderOptions& options) {
    Progress::set_quiet(options.quiet);
    if (options.eyes < 1 || options.eyes > most_eyes) {
        throw UsageError(
            fmt::format("--eyes {}: expected a number from 1 to {}", options.eyes, most_eyes));
    }
    const auto size = pixels_of("--size", options.size);
    const Input input = load(options.input);
    const std::vector<Outcome> outcomes = measure_orders(input, options.eyes, size);
    (options.json ? print_json : print_table)(input, outcomes, options.eyes);
}

}  // namespace

void add_order(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand(
        "order", "How fast and how right a mesh's tets are put in order for drawing");
    const auto options = std::make_shared<OrderOptions>();
    verb->add_option("INPUT", options->input,
                     "Mesh (.vtu, .pvtu, .pvd, .vtk, .node, .ele), or scene (.json), whose camera "
                     "is the first")
        ->required();
    verb->add_option(
            "--eyes", options->eyes,
            "Number of views: around the mesh, without perspective, and inside it, in turn")
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--size", options->size, "Pixels of a view that are judged")
        ->type_name("WxH")
        ->capture_default_str();
    verb->add_flag("--json", options->json, "Print JSON instead of a table");
    add_only_below_option(*verb);
    verb->add_flag("--quiet", options->quiet, "No progress");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
