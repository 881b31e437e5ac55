// SPDX-License-Identifier: Apache-2.0
// Questions on dithering along depth that LaMar 2004, section 5, leaves open.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/client.h"
#include "compositing/codes.h"
#include "lamina/scene.h"
#include "papers/figure_files.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr int dither_depths[] = {64, 256, 1024, 4096};
constexpr int increments[] = {1, 2, 4, 8, 16};

// Returns the first column of the ramp in which the opacity of a sample is at least 1 / (255 P),
// the least that a pattern of period P shows.
int predicted_first_shown(int samples, int period) {
    for (int x = 1; x < ramp_width; ++x) {
        const double code = 255 * opacity_over(x / 255.0, 1.0 / samples);
        if (std::floor(period * code + code_noise) >= 1) return x;
    }
    return ramp_width;
}

Json measure_period(int samples, int period, double color, OverRounding over) {
    RampSetting setting{.samples = samples, .color = color};
    setting.emulation.over = over;
    setting.dither = Dither{.period = period};
    const Curve curve = composite_ramp(setting);
    Json row{{"samples", samples}, {"period", period}, {"color", color}, {"over", name_of(over)}};
    row.update(study::to_json(error_of(curve, exact_ramp(color))));
    row["first_column_shown"] = first_shown(curve);
    row["first_column_predicted"] = predicted_first_shown(samples, period);
    return row;
}

// Cases of colour and of rounding in OVER. Colour 1 has one case only: its rows do not depend on
// the rounding.
struct ColorCase {
    double color;
    OverRounding over;
};
constexpr ColorCase color_cases[] = {
    {1.0, OverRounding::separate}, {0.5, OverRounding::separate}, {0.5, OverRounding::fused}};

Json measure_periods() {
    Progress progress("dithering: periods", 3 * 4 * 11);
    Json rows = Json::array();
    for (const auto& [color, over] : color_cases) {
        for (const int samples : dither_depths) {
            for (int period = 4; period <= 4096; period *= 2) {
                rows.push_back(measure_period(samples, period, color, over));
                progress.advance();
            }
        }
    }
    return rows;
}

Json measure_increment(const RampSetting& setting) {
    const Dither& dither = *setting.dither;
    Json row{{"samples", setting.samples},    {"period", dither.period},
             {"increment", dither.increment}, {"color", setting.color},
             {"dither_color", dither.color},  {"over", name_of(setting.emulation.over)}};
    row.update(study::to_json(error_of(composite_ramp(setting), exact_ramp(setting.color))));
    return row;
}

// Measures periods of N, and for larger increments also of N times the increment: a pattern of
// increment k shows an opacity of k / (255 P) or more.
Json measure_increments() {
    Progress progress("dithering: increments", 5 * 4 * 5);
    Json rows = Json::array();
    for (const auto& [color, over] : color_cases) {
        for (const bool dither_color : {false, true}) {
            // Colour 1 is code 255, which has no fraction to dither.
            if (color == 1 && dither_color) continue;
            for (const int samples : dither_depths) {
                for (const int increment : increments) {
                    RampSetting setting{.samples = samples, .color = color};
                    setting.emulation.over = over;
                    const int period = dither_period_for(samples);
                    setting.dither =
                        Dither{.period = period, .color = dither_color, .increment = increment};
                    rows.push_back(measure_increment(setting));
                    progress.advance();
                    if (increment == 1) continue;
                    setting.dither->period = period * increment;
                    rows.push_back(measure_increment(setting));
                }
            }
        }
    }
    return rows;
}

Json measure_spans() {
    Json rows = Json::array();
    for (const double code : {0.1, 0.5, 1.0 / 64}) {
        for (const int slabs : {1, 4, 9, 16, 64, 256}) {
            for (const int period : {4, 8, 9, 10, 11, 16, 64, 256, 1024}) {
                const SpanLoss loss = span_loss({code, slabs, Dither{.period = period}});
                rows.push_back({{"code", code},
                                {"slabs", slabs},
                                {"period", period},
                                {"lost", loss.lost},
                                {"mean_shift", loss.mean_shift},
                                {"largest_shift", loss.largest_shift},
                                {"sum_error", loss.sum_error}});
            }
        }
    }
    return rows;
}

// Returns the rows that have all keys and values of `wanted`.
std::vector<Json> select(const Json& rows, const Json& wanted) {
    std::vector<Json> found;
    for (const Json& row : rows) {
        const bool fits =
            std::all_of(wanted.items().begin(), wanted.items().end(),
                        [&](const auto& item) { return row[item.key()] == item.value(); });
        if (fits) found.push_back(row);
    }
    return found;
}

// Plots L2 of colour 1 against `key`, with one line for each sample depth.
std::string error_plot(const Json& rows, const std::string& title, const PlotAxis& x_axis,
                       const std::string& key) {
    LinePlot plot{title, x_axis, {"L2, in 1/255", 1, 256, true}};
    for (const int samples : dither_depths) {
        std::vector<double> x, y;
        for (const Json& row : rows) {
            if (row["samples"] != samples || row["color"] != 1.0) continue;
            if (row.contains("increment") && row["period"] != dither_period_for(samples)) continue;
            x.push_back(row[key]);
            y.push_back(row["l2"]);
        }
        plot.add(fmt::format("{} samples", samples), x, y);
    }
    return plot.svg();
}

void judge_periods(Findings& findings, const Json& periods) {
    bool holds = true;
    std::string needed;
    for (const int samples : dither_depths) {
        // Shortest period that shows the ramp's faintest column.
        int shortest = 0;
        for (const Json& row : select(periods, {{"samples", samples}, {"color", 1.0}})) {
            const int period = row["period"];
            if (period > samples) continue;
            holds = holds && row["first_column_shown"] == row["first_column_predicted"];
            if (shortest == 0 && row["first_column_shown"] == 1) shortest = period;
        }
        holds = holds && shortest == samples;
        needed += fmt::format("{}{} samples: {}", needed.empty() ? "" : ", ", samples, shortest);
    }
    findings.add(
        "There is a relationship of the smallest per-voxel value and the smallest value that a "
        "dithering pattern can capture that we have not yet fully explored, but it is clear that "
        "the size of the dithering period should be a function of the sample depth",
        holds,
        "a pattern of period P shows opacities of 1 / (255 P) a sample and more, in every ramp; "
        "the shortest period that shows a ray of opacity 1/255 is, for " +
            needed);
    const auto l2 = [&](int samples, int period) {
        return select(periods, {{"samples", samples}, {"period", period}, {"color", 1.0}})
            .front()["l2"]
            .get<double>();
    };
    findings.add("It is also not one that can be applied indefinitely and still see improvement.",
                 l2(1024, 4096) > 0.9 * l2(1024, 64),
                 fmt::format("L2 of 1024 samples is {:.1f} at period 4, {:.1f} at 64, {:.1f} at "
                             "4096: what is left is the pigeon hole",
                             l2(1024, 4), l2(1024, 64), l2(1024, 4096)));
}

void judge_increments(Findings& findings, const Json& rows) {
    bool holds = true;
    std::string measured;
    for (const int samples : dither_depths) {
        const auto l2 = [&](int increment) {
            return select(rows, {{"samples", samples},
                                 {"period", dither_period_for(samples)},
                                 {"increment", increment},
                                 {"color", 1.0}})
                .front()["l2"]
                .get<double>();
        };
        holds = holds && l2(8) < l2(1);
        measured += fmt::format("{}{:.1f} to {:.1f} at {} samples", measured.empty() ? "" : ", ",
                                l2(1), l2(8), samples);
    }
    findings.add("To deal with this, the dither increment must be larger than 1.", holds,
                 "against the pigeon hole an increment of 8 takes L2 from " + measured);
}

void judge_spans(Findings& findings, const Json& spans) {
    const auto span = [&](int period) {
        return select(spans, {{"code", 0.1}, {"slabs", 9}, {"period", period}}).front();
    };
    findings.add(
        "If the dithering period is less than 9, then all of the dithered values will be zero and "
        "no contribution is made.",
        span(4)["lost"] == 1.0 && span(8)["lost"] == 1.0 && span(9)["lost"] == 1.0,
        "9 samples of 0.1 are lost wherever they lie, with periods 4 and 8, and 9 too");
    const Json ten = span(10);
    findings.add(
        "If the dithering period is 10, such that one voxel will be dithered to a value of 1, it "
        "is also possible for the voxels not to contribute",
        ten["lost"] > 0 && ten["lost"] < 1,
        fmt::format("{:.0f} % of the places lose them", 100 * ten["lost"].get<double>()));
    findings.add(
        "the position at which boundary appears will correspond to the position of the "
        "single dithering up of the voxel value.",
        ten["largest_shift"] == 8,
        fmt::format("it appears {:.1f} slabs late in the mean, {} at most",
                    ten["mean_shift"].get<double>(), ten["largest_shift"].get<int>()));
}

}  // namespace

Json reproduce_dithering(const std::filesystem::path& folder) {
    const Json periods = measure_periods(), by_increment = measure_increments(),
               spans = measure_spans();
    study::write_text(folder / "dithering_periods.csv", csv_of_rows(periods));
    study::write_text(folder / "dithering_increments.csv", csv_of_rows(by_increment));
    study::write_text(folder / "dithering_spans.csv", csv_of_rows(spans));
    study::write_text(folder / "dithering_periods.svg",
                      error_plot(periods, "Dithering: error of the ramp against the period",
                                 {"period P", 4, 4096, true}, "period"));
    study::write_text(folder / "dithering_increments.svg",
                      error_plot(by_increment, "Dithering: error of the ramp against the increment",
                                 {"increment, with period N", 1, 16, true}, "increment"));
    Findings findings;
    judge_periods(findings, periods);
    judge_increments(findings, by_increment);
    judge_spans(findings, spans);
    Json values;
    values["files"] = {"dithering_periods.csv", "dithering_periods.svg", "dithering_increments.csv",
                       "dithering_increments.svg", "dithering_spans.csv"};
    values["periods"] = periods;
    values["increments"] = by_increment;
    values["spans"] = spans;
    values["caption"] =
        "L2 error of the ramp, composited from 64 to 4096 samples in 8 bits: over the period of "
        "dithering, and over its increment.";
    return findings.result(values);
}

}  // namespace lamina::papers
