// SPDX-License-Identifier: Apache-2.0
#include "study/error_budget.h"

#include <algorithm>
#include <cmath>

namespace lamina::study {
namespace {

double product(const Difference& a, const Difference& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.e.size(); ++i) sum += a.e[i] * b.e[i];
    return sum;
}

double sign_of(const ErrorBudget::Part& part) {
    return part.key == "slicing" ? -1 : 1;
}

void subtract(const Difference& other, Difference& from) {
    for (std::size_t i = 0; i < from.e.size(); ++i) from.e[i] -= other.e[i];
}

std::vector<ErrorBudget::Part> parts_of(const FourPictures& pictures) {
    Difference mesh = difference(pictures.traced_mesh, pictures.traced_volume);
    std::vector<ErrorBudget::Part> parts{
        {"mesh", "mesh discretisation", mesh, {}, 0},
        {"slicing", "slicing method", difference(pictures.sliced, pictures.traced_volume), {}, 0},
        {"projection", "PT method", difference(pictures.projected, pictures.traced_mesh), {}, 0}};
    if (pictures.unlit_mesh.rgba.empty()) return parts;
    const Difference unlit = difference(pictures.unlit_mesh, pictures.unlit_volume);
    subtract(unlit, mesh);
    parts[0].e = unlit;
    parts.push_back({"gradients", "gradients", mesh, {}, 0});
    return parts;
}

}  // namespace

const ErrorBudget::Part& ErrorBudget::dominant() const {
    return *std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.error.all.l2 < b.error.all.l2;
    });
}

ErrorBudget error_budget(const FourPictures& pictures) {
    ErrorBudget budget;
    budget.parts = parts_of(pictures);
    budget.raw = difference(pictures.projected, pictures.sliced);
    budget.raw_error = measure(budget.raw);
    const double whole = product(budget.raw, budget.raw);
    for (ErrorBudget::Part& part : budget.parts) {
        part.error = measure(part.e);
        part.share = whole > 0 ? sign_of(part) * product(part.e, budget.raw) / whole : 0;
    }
    for (std::size_t i = 0; i < budget.raw.e.size(); ++i) {
        double sum = 0;
        for (const ErrorBudget::Part& part : budget.parts) sum += sign_of(part) * part.e.e[i];
        budget.residual = std::max(budget.residual, std::abs(budget.raw.e[i] - sum));
    }
    return budget;
}

}  // namespace lamina::study
