// SPDX-License-Identifier: Apache-2.0
#pragma once

// Meshes for the reproduction of Kraus 2004 that need neither data files nor TetGen, and
// comparisons of pictures of them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/difference.h"
#include "papers/kraus.h"
#include "render/pipeline.h"
#include "scene/scene.h"

namespace lamina::papers {

// Returns a mesh of cells[0] x cells[1] x cells[2] cubes that fill the unit cube, six tets each
// (Kuhn), with a field of a few smooth blobs from 0 to about 1.
SceneMesh make_box_mesh(const std::array<std::int32_t, 3>& cells);

// Returns a boundary layer, as around a body in a flow: Kuhn's tets in cells x cells columns over
// the unit square. Their thickness grows geometrically away from the body, so that the longest edge
// of the mesh is `ratio` times the shortest. The body is a plate with a bump of height `bump` in
// its middle. With the distance h from it the field falls as 1 / (1 + (h / d)^2), where d varies
// between .001 and .003, so most of the field lies in the thin cells.
SceneMesh make_graded_mesh(std::int32_t cells, std::int32_t layers, double ratio, double bump);

// A named setting with which one picture is drawn; variants are compared.
struct Variant {
    std::string name;
    Scene scene;
};

struct VariantErrors {
    std::string name;
    ErrorNorms all;      // errors of R, G, B and A against the tracer
    ErrorNorms opacity;  // errors of A
};

// Draws all variants and returns their errors only.
std::vector<VariantErrors> variant_errors(const std::string& label, KrausSubject& subject,
                                          const std::vector<Variant>& variants,
                                          const Capabilities& capabilities);

VariantErrors errors_of(const std::string& variant, const Difference& difference);

// Returns a row for csv_of_rows: {mesh, tets, picture, linf, l1, l2, opacity_l1, opacity_l2}.
nlohmann::ordered_json error_row(const KrausSubject& subject, const VariantErrors& errors);

struct ComparedPictures {
    std::vector<VariantErrors> errors;  // one for each variant
    nlohmann::ordered_json values;      // files, mesh, pixels, inset, scale, rows, panels
};

// Writes NAME.csv with the errors, and makes panels like the paper's figures: the variants'
// pictures and the exact one; an inset of each, magnified; and the signed differences from the
// exact picture (image/difference.h). All insets get the same gain of contrast, chosen for the
// exact picture, each about its own mean. The inset lies where the first variant's error varies
// most. All scenes must have the same camera, size and transfer function.
ComparedPictures write_compared_pictures(const std::filesystem::path& folder,
                                         const std::string& name, KrausSubject& subject,
                                         const std::vector<Variant>& variants,
                                         const Capabilities& capabilities);

}  // namespace lamina::papers
