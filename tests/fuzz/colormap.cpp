// SPDX-License-Identifier: Apache-2.0
#include "optics/colormap.h"

#include "runs.h"
#include "scratch_folder.h"
#include "violation.h"

namespace lamina::fuzz {
namespace {

// Throws Violation unless knots made of a colour map are in order and finite.
void check_knots(std::vector<TransferKnot> knots) {
    try {
        TransferFunction::linear(std::move(knots));
    } catch (const Error& error) {
        throw Violation(std::string("a colour map gives ") + error.what());
    }
}

}  // namespace

void run_colormap(std::string_view input) {
    const auto file = scratch_file("map.json", input);
    may_fail([&] {
        const Colormap colormap = read_paraview_colormap(file);
        const double first = colormap.colors.front().value;
        check_knots(combine(colormap, {{first, 1}, {1e300, 2}}));
        check_knots(combine(colormap, 0.5));
    });
}

}  // namespace lamina::fuzz
