// SPDX-License-Identifier: Apache-2.0
// The targets node_ele, pvd, vtk and vtu: meshes are read, sorted in visibility order and planned.
#include <algorithm>
#include <set>

#include "input_parts.h"
#include "mesh/tet_mesh.h"
#include "mesh_files/mesh_file.h"
#include "plan_check.h"
#include "runs.h"
#include "scratch_folder.h"
#include "violation.h"
#include "visibility/visibility_order.h"

namespace lamina::fuzz {
namespace {

// Largest number of tets of a mesh that is sorted and planned.
constexpr std::size_t most_drawn = 200;

void check_sizes(const MeshData& data) {
    for (const MeshScalar& scalar : data.point_scalars)
        require(scalar.values.size() == data.points.size(), "a point scalar's size");
    for (const MeshScalar& scalar : data.cell_scalars)
        require(scalar.values.size() == data.tets.size(), "a cell scalar's size");
    for (const Tet& tet : data.tets) {
        for (const std::int32_t corner : tet) {
            require(corner >= 0 && static_cast<std::size_t>(corner) < data.points.size(),
                    "a corner is no point");
        }
    }
}

void check_orders(const TetMesh& mesh, const glm::dvec3& outside) {
    const glm::dvec3 inside = mesh.points()[static_cast<std::size_t>(mesh.tets()[0][0])];
    const TetOverlaps overlaps = find_overlaps(mesh, 50'000);
    for (const OrderMethod method :
         {OrderMethod::mpvo, OrderMethod::exact, OrderMethod::centroid, OrderMethod::none}) {
        VisibilityOrder order(mesh, method, overlaps.pairs);
        for (const Eye& eye : {Eye{outside, false}, Eye{inside, false}, Eye{{0, 0, 1}, true}}) {
            const auto sorted = order.sort(eye);
            const std::set<std::int32_t> tets(sorted.begin(), sorted.end());
            require(sorted.size() == mesh.tets().size() && tets.size() == sorted.size(),
                    "an order leaves out tets");
            require(
                tets.empty() || (*tets.begin() == 0 && *tets.rbegin() == std::ssize(sorted) - 1),
                "an order has other tets");
        }
    }
}

void check_mesh(MeshData data) {
    check_sizes(data);
    if (data.tets.size() > most_drawn) return;
    MeshScalar scalar{"none", std::vector<double>(data.points.size(), 0.5)};
    if (!data.point_scalars.empty()) scalar = data.point_scalars.front();
    SceneMesh mesh{TetMesh(std::move(data), "mesh"), std::move(scalar), false, {}};
    if (mesh.mesh.tets().empty()) return;
    const TetMesh::Bounds& bounds = mesh.mesh.bounds();
    const ScalarRange range = measure_range(mesh.scalar.values);
    if (range.range.empty()) return;
    Scene scene =
        scene_around({bounds.min, bounds.max}, range.range.lo, range.range.hi, Method::project);
    scene.nan = NanPolicy::transparent;
    check_orders(mesh.mesh, scene.camera->eye);
    check_project_plans(scene, mesh);
}

void run_mesh(const char* name, std::string_view input) {
    const auto file = scratch_file(name, input);
    may_fail([&] { check_mesh(read_mesh(file)); });
}

}  // namespace

void run_node_ele(std::string_view input) {
    const InputParts parts = parts_of(input);
    scratch_file("mesh.ele", parts.second);
    run_mesh("mesh.node", parts.first);
}

void run_pvd(std::string_view input) {
    const InputParts parts = parts_of(input);
    if (!names_stay_in_folder(parts.first)) return;
    scratch_file("mesh.vtu", parts.second);
    run_mesh("mesh.pvd", parts.first);
}

void run_vtk(std::string_view input) {
    run_mesh("mesh.vtk", input);
}

void run_vtu(std::string_view input) {
    run_mesh("mesh.vtu", input);
}

}  // namespace lamina::fuzz
