// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/difference.h"
#include "papers/kraus.h"
#include "render/pipeline.h"

namespace lamina::papers {

// One of several ways to draw the same picture.
struct Variant {
    std::string name;
    Scene scene;
};

struct VariantErrors {
    std::string name;
    ErrorNorms all;      // errors of R, G, B and A against the tracer
    ErrorNorms opacity;  // errors of A
};

// Draws all variants and keeps only their errors.
std::vector<VariantErrors> variant_errors(const std::string& label, KrausSubject& subject,
                                          const std::vector<Variant>& variants,
                                          const Capabilities& capabilities);

VariantErrors errors_of(const std::string& variant, const Difference& difference);

// A row for csv_of_rows: {mesh, tets, picture, linf, l1, l2, opacity_l1, opacity_l2}.
nlohmann::ordered_json error_row(const KrausSubject& subject, const VariantErrors& errors);

// The result of write_compared_pictures().
struct ComparedPictures {
    std::vector<VariantErrors> errors;  // one for each variant
    nlohmann::ordered_json values;      // files, mesh, pixels, inset, scale, rows, panels
};

// The files that write_compared_pictures() writes: NAME.csv.
std::vector<std::string> compared_picture_files(const std::string& name);

// Writes NAME.csv with the errors, and makes panels in the manner of the paper's figures: the
// variants' pictures and the exact picture; of each its inset, magnified and with more contrast:
// each about its own mean, all with one gain, which follows the exact picture; and the signed
// differences from the exact picture (image/difference_picture.h). The inset lies where the first
// variant's error varies most in that contrast. All scenes must have one camera, size and transfer
// function.
ComparedPictures write_compared_pictures(const std::filesystem::path& folder,
                                         const std::string& name, KrausSubject& subject,
                                         const std::vector<Variant>& variants,
                                         const Capabilities& capabilities);

}  // namespace lamina::papers
