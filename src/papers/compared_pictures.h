// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "papers/kraus_subject.h"
#include "render/scene_renderer.h"

namespace lamina::papers {

// One way to draw what another picture shows, too.
struct Variant {
    std::string name;
    Scene scene;
};

struct VariantErrors {
    std::string name;
    ErrorNorms all;      // of R, G, B and A against the tracer
    ErrorNorms opacity;  // of A
};

// Draws them all; only their errors are kept.
std::vector<VariantErrors> variant_errors(const std::string& label, KrausSubject& subject,
                                          const std::vector<Variant>& variants,
                                          const Capabilities& capabilities);

VariantErrors errors_of(const std::string& variant, const Difference& difference);

// {mesh, tets, picture, linf, l1, l2, opacity_l1, opacity_l2}: a row for csv_of_rows.
nlohmann::ordered_json error_row(const KrausSubject& subject, const VariantErrors& errors);

// What write_compared_pictures() has to tell.
struct ComparedPictures {
    std::vector<VariantErrors> errors;  // as the variants
    nlohmann::ordered_json values;      // files, mesh, pixels, inset, scale, rows
};

// NAME.png and NAME.csv.
std::vector<std::string> compared_picture_files(const std::string& name);

// NAME.png, as the paper's figures: the variants' pictures side by side, the exact one last; below
// each its inset, magnified and contrast-enhanced (each about its own mean, all with one
// gain, which follows the exact one); and below that the signed difference from the exact one
// (image/false_color.h). The inset is taken where the first variant's error varies most, in that
// contrast. All scenes are of one camera, size and transfer function. And NAME.csv: their errors.
ComparedPictures write_compared_pictures(const std::filesystem::path& folder,
                                         const std::string& name, KrausSubject& subject,
                                         const std::vector<Variant>& variants,
                                         const Capabilities& capabilities);

}  // namespace lamina::papers
