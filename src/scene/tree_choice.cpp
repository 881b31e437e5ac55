// SPDX-License-Identifier: Apache-2.0
#include "scene/tree_choice.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lamina {
namespace {

constexpr double full_scale = 255;

// The largest error of storing one value in [0, 1]. Halves: llvmpipe truncates them, by up to one
// unit in the last place just below 1.
double storage_error(const TreeQuestion& question) {
    switch (question.target) {
        case Target::float32:
            return 0x1p-24;
        case Target::float16:
            return 0x1p-11;
        case Target::fixed16:
            return 0.5 / 65535;
        case Target::fixed8:
            return 0.5 / 255;
        default:
            return 0.5 / largest_code(question.emulation.bits);
    }
}

// How far a slab's opacity may be from its value, in storage errors: half a code where it is
// rounded to nearest, else up to a code.
double opacity_roundings(const TreeQuestion& question) {
    if (question.dither) return 2.0 * question.dither->increment;
    const bool whole_code =
        question.target == Target::emulated && question.emulation.alpha != AlphaRounding::nearest;
    return whole_code ? 2 : 1;
}

// Storage errors per slab: of its opacity, its colour and what it leaves of the rest. Front to
// back, the opacity that is there is rounded, too, and hides what comes behind.
double roundings_per_slab(const TreeQuestion& question) {
    return 2 + opacity_roundings(question) + (question.order == Order::front_to_back ? 1 : 0);
}

// Storage errors of colours before they are weighted by opacity: these weights' sum is at most 1.
double color_roundings(const TreeQuestion& question) {
    if (question.dither && question.dither->color) return 2.0 * question.dither->increment;
    return question.target == Target::emulated ? 1 : 0;
}

// Registers of a leaf: transmittance, colour and optical depth are rounded once a slab each.
constexpr double leaf_roundings = 3 * 0x1p-24;

// Fixed-point targets hold colours up to 1; the others round in proportion to what they hold.
double scaled_for_color(const TreeQuestion& question, double bound) {
    const double largest = std::max(question.largest_color, 1.0);
    const bool clamps = question.target != Target::float32 && question.target != Target::float16;
    return full_scale * std::min(clamps ? bound + (largest - 1) : bound * largest, largest);
}

}  // namespace

double straight_error_bound(const TreeQuestion& question) {
    const double roundings =
        question.visible_slabs * roundings_per_slab(question) + color_roundings(question);
    return scaled_for_color(question, roundings * storage_error(question));
}

double one_level_error_bound(const TreeQuestion& question) {
    return scaled_for_color(question,
                            storage_error(question) + question.visible_slabs * leaf_roundings);
}

TreeChoice choose_tree(const TreeQuestion& question) {
    const double straight = straight_error_bound(question);
    if (question.target == Target::emulated) {
        if (straight <= question.max_error) {
            return {{}, straight, "an emulated buffer has no nodes computed in a shader"};
        }
        fail(
            "render.max_error: found {:.4g}, the emulated target of {} bits keeps {:.4g} over {} "
            "slabs: take more bits, fewer samples, or another target",
            question.max_error, question.emulation.bits, straight, question.visible_slabs);
    }
    // One node that marches all slabs reads and writes each pixel once; blending does so once a
    // slab, and is measured to be slower for every number of slabs but one (docs/precision.md).
    const double one_level = one_level_error_bound(question);
    if ((question.slabs > 1 || straight > question.max_error) && one_level <= question.max_error) {
        return {TreePlan{.factors = {question.slabs}}, one_level,
                fmt::format("one node of {} slabs, in float, takes less time than blending, whose "
                            "bound is {:.3g}",
                            question.slabs, straight)};
    }
    if (straight <= question.max_error) {
        return {{}, straight, fmt::format("{} visible slabs round little", question.visible_slabs)};
    }
    if (question.largest_color > 1 &&
        one_level - full_scale * (question.largest_color - 1) <= question.max_error) {
        fail(
            "render.max_error: found {:.4g}, not to be kept with colours up to {:.4g}, which the "
            "target {} clamps to 1: take float16 or float32, or colours up to 1",
            question.max_error, question.largest_color, name_of(question.target));
    }
    fail(
        "render.max_error: found {:.4g}, the best that the target {} can keep is {:.4g} over {} "
        "visible slabs: take a larger max_error, or a target of more bits",
        question.max_error, name_of(question.target), std::min(one_level, straight),
        question.visible_slabs);
}

}  // namespace lamina
