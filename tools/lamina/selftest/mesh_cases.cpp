// SPDX-License-Identifier: Apache-2.0
// Meshes that are hard for a renderer: needles, slivers, hubs, and invalid meshes.
#include <cmath>
#include <numbers>

#include "compositing/codes.h"
#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

constexpr const char* mesh_group = "meshes";

const std::vector<DrawingWay>& mesh_ways() {
    static const std::vector<DrawingWay> all{traces()[1], way_named("project float32"),
                                             way_named("project analytic float32")};
    return all;
}

SelftestScene box_scene(const std::string& name, const std::string& about,
                        const std::function<MeshData(const LayeredBox&)>& mesh) {
    SelftestScene scene = plain_scene(name, about);
    scene.scene.transfer_function =
        optics_of({{0, {{.1, .3, 1}, .2}}, {.5, {{.3, 1, .3}, 4}}, {1, {{1, .5, .1}, .5}}});
    scene.mesh = mesh;
    return scene;
}

std::vector<SelftestScene> box_scenes() {
    std::vector<SelftestScene> scenes;
    const auto split = [](int splits, double least, std::uint32_t seed) {
        return [=](const LayeredBox& box) { return split_tets(box, splits, least, seed); };
    };
    scenes.push_back(box_scene("kuhn_8", "384 tets in a box",
                               [](const LayeredBox& box) { return kuhn_tets(box, 8); }));
    scenes.push_back(box_scene("irregular", "A box split 500 times", split(500, 1, 3)));
    scenes.push_back(box_scene("needles_1e-3", "Points 1e-3 of the way from faces, edges, corners",
                               split(150, 1e-3, 5)));
    scenes.push_back(box_scene("needles_1e-6",
                               "Edge ratios beyond 1e6, dihedral angles down to 1e-4 degrees",
                               split(40, 1e-6, 7)));
    scenes.push_back(box_scene("hub", "30,000 tets that share one point",
                               [](const LayeredBox& box) { return fan_tets(box, 50); }));
    SelftestScene large = box_scene("hub_1e6", "1,002,252 tets that share one point",
                                    [](const LayeredBox& box) { return fan_tets(box, 289); });
    large.scene.width = 8;
    large.scene.height = 6;
    scenes.push_back(large);
    return scenes;
}

// Makes tets that share no points, each with a scalar of its own.
MeshData tets_of(const std::vector<std::array<glm::dvec3, 4>>& corners) {
    MeshData mesh;
    MeshScalar scalar{"scalar", {}};
    double value = 0;
    for (const auto& tet : corners) {
        const auto first = static_cast<std::int32_t>(mesh.points.size());
        mesh.points.insert(mesh.points.end(), tet.begin(), tet.end());
        scalar.values.insert(scalar.values.end(), 4, value);
        mesh.tets.push_back({first, first + 1, first + 2, first + 3});
        value = std::fmod(value + .3125, 1);
    }
    mesh.point_scalars.push_back(scalar);
    return mesh;
}

// Makes three long tets around a triangle, each of which overlaps the next in depth: a cycle.
MeshData sticks() {
    std::vector<std::array<glm::dvec3, 4>> corners;
    for (int i = 0; i < 3; ++i) {
        const double turn = 2 * std::numbers::pi / 3 * i;
        const glm::dvec3 along(std::cos(turn), std::sin(turn), 0);
        const glm::dvec3 across(-along.y * .5, along.x * .5, 0);
        const glm::dvec3 low = -along + across - glm::dvec3(0, 0, .5);
        const glm::dvec3 high = along + across + glm::dvec3(0, 0, .5);
        corners.push_back({low - .25 * across, low + .25 * across, high - glm::dvec3(0, 0, .05),
                           high + glm::dvec3(0, 0, .05)});
    }
    return tets_of(corners);
}

MeshData edge_fan(int count) {
    MeshData mesh;
    MeshScalar scalar{"scalar", {0, 1}};
    mesh.points = {{0, 0, -1}, {0, 0, 1}};
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        mesh.points.push_back({std::cos(angle), std::sin(angle), .1 * std::sin(3 * angle)});
        scalar.values.push_back(.5 + .5 * std::sin(2 * angle));
        mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % count});
    }
    mesh.point_scalars.push_back(scalar);
    return mesh;
}

// Makes small tets at random places, which may overlap.
MeshData islands(double size) {
    SplitMix64 bits(3);
    const auto uniform = [&] { return static_cast<double>(bits.next() >> 11) * 0x1p-52 - 1; };
    std::vector<std::array<glm::dvec3, 4>> corners;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 at(uniform(), uniform(), uniform());
        std::array<glm::dvec3, 4> tet;
        for (glm::dvec3& corner : tet)
            corner = .7 * at + size * glm::dvec3(uniform(), uniform(), uniform());
        corners.push_back(tet);
    }
    return tets_of(corners);
}

MeshData with_hole() {
    LayeredBox box;
    box.samples = {0, .25, .5, 1};
    box.corner = {-1, -1, -1};
    box.edges = {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
    MeshData mesh = kuhn_tets(box, 3);
    constexpr std::ptrdiff_t middle = 6 * 13;
    mesh.tets.erase(mesh.tets.begin() + middle, mesh.tets.begin() + middle + 6);
    return mesh;
}

// Makes tets on face 0 1 2, on one side of it or on both.
MeshData on_one_face(const std::vector<glm::dvec3>& tops) {
    MeshData mesh;
    mesh.points = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    MeshScalar scalar{"scalar", {0, 1, .5}};
    for (const glm::dvec3& top : tops) {
        mesh.tets.push_back({0, 1, 2, static_cast<std::int32_t>(mesh.points.size())});
        mesh.points.push_back(top);
        scalar.values.push_back(.75);
    }
    mesh.point_scalars.push_back(scalar);
    return mesh;
}

MeshScene one_color(const std::string& name, const std::string& about,
                    const std::function<MeshData()>& mesh) {
    MeshScene scene{name, about, plain_scene("", "").scene, mesh};
    scene.scene.transfer_function = optics_of({{0, {{.3, .6, .9}, .5}}, {1, {{.3, .6, .9}, 3}}});
    scene.scene.camera->eye = {1.3, -.7, 4};
    scene.scene.camera->center = {0, 0, 0};
    scene.scene.camera->fov_y = 38;
    return scene;
}

std::vector<MeshScene> mesh_scenes() {
    std::vector<MeshScene> scenes;
    scenes.push_back(
        one_color("edge_fan", "1000 tets that share one edge", [] { return edge_fan(1000); }));
    scenes.push_back(
        one_color("edge_fan_3", "Three tets about an edge", [] { return edge_fan(3); }));
    scenes.push_back(one_color("islands", "60 tets that do not touch, most of them",
                               [] { return islands(.15); }));
    scenes.push_back(
        one_color("cut_one_another", "60 tets that cut one another", [] { return islands(.8); }));
    scenes.push_back(one_color("hole", "A hole inside the mesh", with_hole));
    scenes.push_back(one_color("nonmanifold", "Three tets on one face", [] {
        return on_one_face({{0, 0, 1}, {.2, .1, -1}, {-.5, -.5, .8}});
    }));
    scenes.push_back(one_color("folded", "Two tets on the same side of their face", [] {
        return on_one_face({{0, 0, 1}, {.6, .2, .5}});
    }));
    scenes.push_back(one_color("touching_in_a_point", "Two tets that share one point", [] {
        MeshData mesh = on_one_face({{0, 0, 1}});
        mesh.points.insert(mesh.points.end(), {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}});
        mesh.point_scalars[0].values.insert(mesh.point_scalars[0].values.end(), {1, .5, 0});
        mesh.tets.push_back({3, 4, 5, 6});
        return mesh;
    }));
    scenes.push_back(one_color("flat", "Tets without volume among others", [] {
        MeshData mesh = on_one_face({{0, 0, 1}, {0, -1, 0}, {0, 0, -1}, {.25, .25, 0}});
        mesh.tets.push_back({0, 0, 1, 2});
        return mesh;
    }));
    MeshScene cyclic =
        one_color("cyclic", "Three tets, each before the next: no order is right", sticks);
    // The colours differ too little to be seen, but enough for the order to matter.
    cyclic.scene.transfer_function =
        optics_of({{0, {{.3, .6, .9}, .5}}, {1, {{.3, .6, .9 - 1e-9}, 3}}});
    cyclic.scene.camera->eye = {0, 0, 4};
    cyclic.cyclic = true;
    scenes.push_back(cyclic);
    return scenes;
}

}  // namespace

std::vector<SelftestCase> mesh_cases() {
    std::vector<SelftestCase> cases = cases_of(mesh_group, box_scenes(), mesh_ways());
    for (const MeshScene& scene : mesh_scenes()) {
        for (const DrawingWay& way : mesh_ways()) cases.push_back(case_of(mesh_group, scene, way));
    }
    return cases;
}

}  // namespace lamina::selftest
