// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, Figures 2, 3, 4, 5 and 9: ramps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lamina/scene.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr int ramp_depths[] = {16, 64, 256};  // the paper's sample depths
constexpr int paper_period = 11;              // section 5.1

std::string depth_name(int samples) {
    return fmt::format("N={}", samples);
}

// Returns the paper's dithering, of colour as well as opacity (section 5).
Dither paper_dither() {
    return {.period = paper_period, .color = true};
}

std::string brief(const ErrorNorms& e) {
    return fmt::format("Linf {:.1f}, L1 {:.2f}, L2 {:.2f}", e.linf, e.mean, e.l2);
}

ErrorNorms error_of(const NamedCurve& named, const std::vector<NamedCurve>& curves) {
    return papers::error_of(named.curve, curves.front().curve);
}

// Returns the slope of the line through columns 0 .. 127, by least squares. If a ramp is right, it
// is the colour.
double slope_of_first_half(const Curve& curve) {
    constexpr int count = ramp_width / 2;
    constexpr double middle = 0.5 * (count - 1);
    double products = 0, squares = 0;
    for (int x = 0; x < count; ++x) {
        products += (x - middle) * curve[static_cast<std::size_t>(x)];
        squares += (x - middle) * (x - middle);
    }
    return products / squares;
}

}  // namespace

Json reproduce_figure2(const std::filesystem::path& folder) {
    std::vector<NamedCurve> curves{{"software", exact_ramp(1)}};
    for (const int samples : ramp_depths) {
        curves.push_back({depth_name(samples), composite_ramp({.samples = samples})});
    }
    Json values = write_ramp_figure(folder, "figure2", "Figure 2: the ramp in 8 bits", curves);
    const ErrorNorms e16 = error_of(curves[1], curves), e64 = error_of(curves[2], curves),
                     e256 = error_of(curves[3], curves);
    for (const NamedCurve& named : curves) values["levels"][named.name] = levels(named.curve);
    const Curve& c64 = curves[2].curve;
    const double plateau = c64[static_cast<std::size_t>(first_shown(c64))];
    const auto wide = std::count(c64.begin(), c64.end(), plateau);
    Findings findings;
    findings.add(
        "Notice how the image and curve show regular small jumps, and is fairly close to the "
        "baseline (software) image.",
        e16.l2 < e64.l2 && e16.linf <= 16,
        fmt::format("16 samples: {} levels of 256, {}, never more than one code lost a sample",
                    levels(curves[1].curve), brief(e16)));
    findings.add(
        "Figure 2(c) shows hardware compositing with a sample depth of 64. This is a fairly poor "
        "approximation of a linear ramp.",
        e64.l2 > 2 * e16.l2, brief(e64));
    findings.add("the first plateau corresponds to compositing a value of \"1\" 64 times",
                 plateau == 64,
                 fmt::format("the first plateau shows {} in {} columns", plateau, wide));
    findings.add(
        "Figure 2(d) shows hardware compositing with a sample depth of 256, and is an extremely "
        "poor approximation of the desired linear ramp.",
        e256.l2 > e64.l2,
        fmt::format("{} levels of 256, {}", levels(curves[3].curve), brief(e256)));
    values["caption"] =
        "Rays whose opacity rises from 0 at the left to 1 at the right: exact (software), and "
        "composited from N equal samples in 8 bits. The plot has what is shown over what is "
        "wanted.";
    return findings.result(values);
}

Json reproduce_figure3(const std::filesystem::path& folder) {
    std::vector<NamedCurve> curves{{"software", exact_ramp(0.5)}};
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        const char* const word = name_of(rounding);
        for (const int samples : ramp_depths) {
            RampSetting setting{.samples = samples, .color = 0.5};
            setting.emulation.over = rounding;
            curves.push_back(
                {fmt::format("{} {}", depth_name(samples), word), composite_ramp(setting)});
        }
    }
    Json values =
        write_ramp_figure(folder, "figure3", "Figure 3: weight rounding, colour 0.5", curves);
    for (const NamedCurve& named : curves) values["decreases"][named.name] = decreases(named.curve);
    const auto falls = [&](std::size_t i) { return decreases(curves[i].curve); };
    Findings findings;
    findings.add("The black line in figure 3 is software and linearly ramps from 0.0 to 0.5",
                 curves[0].curve[255] == 127.5 && falls(0) == 0, "so it is made");
    findings.add(
        "As sample depth increases, the lines no longer strictly increase, but also decrease",
        falls(1) > 0 && falls(2) > 0 && falls(3) > 0,
        fmt::format("with both products rounded, {}, {} and {} columns are lower than the one "
                    "before, at 16, 64 and 256 samples, by up to {}, {} and {}",
                    falls(1), falls(2), falls(3), largest_drop(curves[1].curve),
                    largest_drop(curves[2].curve), largest_drop(curves[3].curve)));
    values["caption"] =
        "Rays of colour .5 whose opacity rises from 0 at the left to 1 at the right: exact "
        "(software), and composited from N equal samples in 8 bits. separate: OVER rounds each of "
        "its two products; fused: it rounds their sum once.";
    return findings.result(
        values, nullptr,
        fmt::format("With one rounding of the sum ({} decreases) the curves never decrease: the "
                    "artifact is of the separate roundings, not of the weights.",
                    falls(4) + falls(5) + falls(6)));
}

Json reproduce_figure4(const std::filesystem::path& folder) {
    RampSetting setting{.samples = 64};
    std::vector<NamedCurve> curves{{"software", exact_ramp(1)},
                                   {"hardware", composite_ramp(setting)}};
    setting.dither = paper_dither();
    curves.push_back({"dithered, period 11", composite_ramp(setting)});
    Json values = write_ramp_figure(folder, "figure4", "Figure 4: 64 samples, dithered", curves);
    const ErrorNorms plain = error_of(curves[1], curves), dithered = error_of(curves[2], curves);
    Findings findings;
    findings.add(
        "The ramp dataset is shown in figure 4 shows that our dithering technique is able to "
        "recover most of the character of the software version",
        2 * dithered.l2 < plain.l2,
        fmt::format("without dithering {}; with it {}, {} levels", brief(plain), brief(dithered),
                    levels(curves[2].curve)));
    values["caption"] =
        "Rays whose opacity rises from 0 at the left to 1 at the right: exact (software), "
        "composited from 64 equal samples in 8 bits (hardware), and with samples dithered along "
        "depth.";
    return findings.result(values);
}

Json reproduce_figure5(const std::filesystem::path& folder) {
    std::vector<NamedCurve> curves{{"software", exact_ramp(0.5)}};
    for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
        const char* const word = rounding == OverRounding::separate ? "" : " fused";
        for (const int samples : ramp_depths) {
            RampSetting setting{.samples = samples, .color = 0.5, .dither = paper_dither()};
            setting.emulation.over = rounding;
            curves.push_back({depth_name(samples) + word, composite_ramp(setting)});
        }
    }
    Json values = write_ramp_figure(folder, "figure5",
                                    "Figure 5: colour 0.5, dithered with period 11", curves);
    const auto error = [&](std::size_t i) { return error_of(curves[i], curves); };
    const auto falls = [&](std::size_t i) { return decreases(curves[i].curve); };
    for (const NamedCurve& named : curves) {
        values["decreases"][named.name] = decreases(named.curve);
        values["slope_of_first_half"][named.name] = slope_of_first_half(named.curve);
    }
    const double slope = slope_of_first_half(curves[2].curve);
    Findings findings;
    findings.add("the curve for sample depth of 16 tracks the software slope fairly closely",
                 error(1).l2 < error(2).l2 && error(1).l2 < error(3).l2, brief(error(1)));
    findings.add(
        "the curve for a sample depth of 64 has some noticeable wiggles", falls(2) > 0,
        fmt::format("{} columns are lower than the one before, {}", falls(2), brief(error(2))));
    findings.add("and considerable over estimates the slope for the first half of the graph",
                 slope > 1.1 * 0.5,
                 fmt::format("the slope of columns 0 to 127 is {:.3f}, where 0.5 is right", slope));
    findings.add(
        "The curve for a sampling depth of 256 shows that dithering is simply not capable of "
        "recovering the ramp",
        error(3).l2 > 2 * error(1).l2, brief(error(3)));
    findings.add("The dip in the dithering curves are due to the \"weight-rounding\" artifact",
                 falls(4) + falls(5) + falls(6) < falls(1) + falls(2) + falls(3),
                 fmt::format("{}, {} and {} decreases with both products rounded, {}, {} and {} "
                             "with one rounding of the sum",
                             falls(1), falls(2), falls(3), falls(4), falls(5), falls(6)));
    values["caption"] =
        "Rays of colour .5 whose opacity rises from 0 at the left to 1 at the right: exact "
        "(software), and composited from N equal samples in 8 bits, dithered along depth with "
        "period 11. fused: OVER rounds the sum of its products once, else each of them.";
    return findings.result(values);
}

Json reproduce_figure9(const std::filesystem::path& folder) {
    const RampSetting setting{.samples = 256};
    std::vector<NamedCurve> curves{{"software", exact_ramp(1)}};
    for (const std::vector<int>& factors :
         {std::vector<int>{256}, {64, 4}, {4, 64}, {16, 16}, {4, 4, 4, 4}}) {
        curves.push_back({to_text(factors), composite_ramp_tree(setting, factors)});
    }
    Json values =
        write_ramp_figure(folder, "figure9", "Figure 9: exponent-factoring, 256 samples", curves);
    const auto error = [&](std::size_t i) { return error_of(curves[i], curves); };
    const ErrorNorms none = error(1), wide = error(2), narrow = error(3), square = error(4),
                     deep = error(5);
    Findings findings;
    findings.add("The error for the ramp dataset is considerably improved",
                 std::max({wide.l2, narrow.l2, square.l2, deep.l2}) < 0.5 * none.l2,
                 fmt::format("one level {}; 64x4 {}; 4x64 {}; 16x16 {}; 4x4x4x4 {}", brief(none),
                             brief(wide), brief(narrow), brief(square), brief(deep)));
    findings.add(
        "for the hierarchies of two levels (64×4 and 16×16), the error is much better when the two "
        "bifurcation factors are closer to each other.",
        square.l2 < wide.l2 && square.l2 < narrow.l2 && square.linf < wide.linf &&
            square.linf < narrow.linf,
        fmt::format("L2 {:.2f} and {:.2f} for 64x4 and 4x64, {:.2f} for 16x16", wide.l2, narrow.l2,
                    square.l2));
    findings.add(
        "as the tree height increases, the bifurcation factors decrease, and the error decreases",
        deep.l2 < square.l2 && deep.linf < square.linf,
        fmt::format("L2 {:.2f} for 16x16, {:.2f} for 4x4x4x4", square.l2, deep.l2));
    values["caption"] =
        "Rays whose opacity rises from 0 at the left to 1 at the right: exact (software), and 256 "
        "equal samples in 8 bits, composited one after the other (256) and in trees with these "
        "factors.";
    return findings.result(values, nullptr,
                           "Factors are named from the root to the leaves; the paper names two of "
                           "its three trees (64x4 and 16x16) and not their direction.");
}

}  // namespace lamina::papers
