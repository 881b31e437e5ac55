// SPDX-License-Identifier: Apache-2.0
#include "plan/tree_check.h"

#include "base/error.h"
#include "scene/coloring.h"

namespace lamina {
namespace {

// `otherwise`: what the scene may ask for instead of one colour.
void check_fixed_nodes(const Scene& scene, bool single_color, const char* tree,
                       const char* otherwise) {
    if (!is_fixed_point(*scene.target)) {
        fail(
            "{}: {}.nodes: found \"fixed\" with target \"{}\", expected target fixed8, fixed16 or "
            "emulated",
            scene.file.string(), tree, name_of(scene.target));
    }
    if (scene.lighting) {
        fail(
            "{}: {}.nodes: found \"fixed\" with lighting, which gives one colour many values, "
            "expected no lighting: these nodes know opacity alone (LaMar 2004, section 6){}",
            scene.file.string(), tree, otherwise);
    }
    if (!single_color) {
        fail(
            "{}: {}.nodes: found \"fixed\" with a transfer function of several colours, expected "
            "one colour (LaMar 2004, section 6){}",
            scene.file.string(), tree, otherwise);
    }
}

}  // namespace

void check_slice_tree(const Scene& scene, bool single_color) {
    if (given_tree(scene.slice.tree)->nodes == NodeArithmetic::fixed) {
        check_fixed_nodes(scene, single_color, "render.slice.tree", ", or \"nodes\": \"shader\"");
    } else if (scene.target == Target::emulated) {
        fail(
            "{}: render.slice.tree.nodes: found \"shader\" with target \"emulated\", expected "
            "\"fixed\": nodes computed in a shader write fixed8, fixed16, float16 or float32",
            scene.file.string());
    }
}

void check_project_tree(const Scene& scene, bool single_color) {
    const TreeSettings* const tree = given_tree(scene.project.tree);
    const ProjectSettings& project = scene.project;
    const std::string file = scene.file.string();
    if (tree == nullptr || tree->nodes == NodeArithmetic::shader) {
        fail(
            "{}: render.project.{}, expected an object with \"factors\" and \"nodes\": \"fixed\": "
            "nodes computed in a shader march slabs, and tets are drawn one by one",
            file, tree == nullptr ? "tree: found \"auto\"" : "tree.nodes: found \"shader\"");
    }
    check_fixed_nodes(scene, single_color, "render.project.tree", "");
    if (project.geometry == ProjectGeometry::triangles ||
        project.interpolation == Interpolation::linear || mixes_colors(project.coloring)) {
        fail(
            "{}: render.project.tree: found geometry \"{}\", interpolation \"{}\" and coloring "
            "\"{}\", expected silhouettes, perspective and preintegrated or analytic",
            file, name_of(project.geometry), name_of(project.interpolation),
            name_of(project.coloring));
    }
    if (project.table.is_given() && project.table->store == TableStore::opacity) {
        fail(
            "{}: render.project.table.store: found \"opacity\" with render.project.tree, expected "
            "\"mean_extinction\": leaves multiply optical depth",
            file);
    }
}

void check_leaves(const Scene& scene, const TreeShape& shape, int most,
                  const Capabilities& capabilities) {
    int leaf = shape.samples();
    for (int level = 0; level + 1 < shape.levels(); ++level)
        leaf = (leaf + shape.factor(level) - 1) / shape.factor(level);
    if (leaf <= most) return;
    if (scene.slice.tree && scene.slice.tree->is_automatic()) {
        fail(
            "{}: render.slice.tree: found \"auto\", which takes one node of all {} slabs, expected "
            "at most {} with {}, which ends longer loops: take fewer samples, factors, or "
            "--context "
            "cpu",
            scene.file.string(), leaf, most, capabilities.renderer);
    }
    fail(
        "{}: render.slice.tree.factors: found leaves of {} slabs, expected at most {} with {}, "
        "which ends longer loops: add a level, or use --context cpu",
        scene.file.string(), leaf, most, capabilities.renderer);
}

}  // namespace lamina
