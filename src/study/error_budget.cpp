// SPDX-License-Identifier: Apache-2.0
#include "study/error_budget.h"

#include <algorithm>
#include <cmath>

namespace lamina::study {
namespace {

constexpr std::array<double, 3> signs{1, -1, 1};

double product(const Difference& a, const Difference& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.e.size(); ++i) sum += a.e[i] * b.e[i];
    return sum;
}

}  // namespace

const ErrorBudget::Part& ErrorBudget::dominant() const {
    return *std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.error.all.l2 < b.error.all.l2;
    });
}

ErrorBudget error_budget(const FourPictures& pictures) {
    ErrorBudget budget;
    budget.parts[0] = {
        "mesh discretisation", difference(pictures.traced_mesh, pictures.traced_volume), {}, 0};
    budget.parts[1] = {
        "slicing method", difference(pictures.sliced, pictures.traced_volume), {}, 0};
    budget.parts[2] = {"PT method", difference(pictures.projected, pictures.traced_mesh), {}, 0};
    budget.raw = difference(pictures.projected, pictures.sliced);
    budget.raw_error = measure(budget.raw);
    const double whole = product(budget.raw, budget.raw);
    for (std::size_t i = 0; i < signs.size(); ++i) {
        ErrorBudget::Part& part = budget.parts[i];
        part.error = measure(part.e);
        part.share = whole > 0 ? signs[i] * product(part.e, budget.raw) / whole : 0;
    }
    for (std::size_t i = 0; i < budget.raw.e.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < signs.size(); ++j) sum += signs[j] * budget.parts[j].e.e[i];
        budget.residual = std::max(budget.residual, std::abs(budget.raw.e[i] - sum));
    }
    return budget;
}

}  // namespace lamina::study
