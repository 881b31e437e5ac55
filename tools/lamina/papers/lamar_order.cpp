// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, section 4.2, on the order of compositing: "front-to-back compositing produces higher
// quality imagery than back-to-front".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/client.h"
#include "base/parallel.h"
#include "compositing/codes.h"
#include "lamina/scene.h"
#include "papers/figure_files.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr int ray_samples = 256;
constexpr int ray_count = 512;
constexpr int largest_codes[] = {1, 2, 4, 8, 16, 32, 64, 128};
// L2 errors that differ by less than this share count as equal.
constexpr double same_share = 0.05;

struct Profile {
    const char* name;
    // Returns the largest opacity code of sample i; m is the largest of the ray.
    int (*largest)(int i, int m);
};
const Profile profiles[] = {
    {"even", [](int, int m) { return m; }},
    {"haze in front", [](int i, int m) { return i < ray_samples / 2 ? std::max(1, m / 32) : m; }},
    {"haze behind", [](int i, int m) { return i < ray_samples / 2 ? m : std::max(1, m / 32); }},
    {"one in 16", [](int i, int m) { return i % 16 == 0 ? m : 0; }},
};

struct OrderCase {
    const Profile* profile;
    int largest;         // in codes of 8 bits
    bool random_colors;  // otherwise white
    bool whole_codes;    // opacities are whole codes, so only OVER rounds; otherwise they are
                         // truncated, too
    OverRounding over;
};

double uniform(SplitMix64& random) {
    return static_cast<double>(random.next() >> 11) * 0x1p-53;
}

std::vector<RaySample> random_ray(const OrderCase& order_case, std::uint64_t seed) {
    SplitMix64 random(seed);
    std::vector<RaySample> ray(ray_samples);
    for (int i = 0; i < ray_samples; ++i) {
        const int m = order_case.profile->largest(i, order_case.largest);
        const double code = uniform(random), color = uniform(random);
        ray[static_cast<std::size_t>(i)] = {
            order_case.random_colors ? std::floor(256 * color) / 255 : 1.0,
            (order_case.whole_codes ? std::floor((m + 1) * code) : m * code) / 255};
    }
    return ray;
}

double exact_color(const std::vector<RaySample>& ray) {
    double color = 0, transparency = 1;
    for (const RaySample& sample : ray) {
        color += transparency * sample.alpha * sample.color;
        transparency *= 1 - sample.alpha;
    }
    return 255 * color;
}

struct OrderErrors {
    ErrorNorms front_to_back, back_to_front;
};

OrderErrors measure_orders(const OrderCase& order_case) {
    Curve exact(ray_count), front(ray_count), back(ray_count);
    const Emulation emulation{.over = order_case.over};
    parallel_for(ray_count, 8, [&](std::int64_t i) {
        const auto at = static_cast<std::size_t>(i);
        const std::vector<RaySample> ray = random_ray(order_case, 1000 + at);
        exact[at] = exact_color(ray);
        front[at] = composite_straight(ray, emulation, {}, Order::front_to_back).color;
        back[at] = composite_straight(ray, emulation, {}, Order::back_to_front).color;
    });
    return {error_of(front, exact), error_of(back, exact)};
}

// Numbers of cases in which one order is better by L2, or both are equal.
struct Score {
    int front = 0, equal = 0, back = 0;
    const char* add(const OrderErrors& errors) {
        const double f = errors.front_to_back.l2, b = errors.back_to_front.l2;
        if (f < (1 - same_share) * b) return ++front, "front_to_back";
        if (b < (1 - same_share) * f) return ++back, "back_to_front";
        return ++equal, "equal";
    }
    Json to_json() const {
        return {{"front_to_back", front}, {"equal", equal}, {"back_to_front", back}};
    }
};

std::vector<OrderCase> order_cases() {
    std::vector<OrderCase> cases;
    for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
        for (const bool random_colors : {false, true}) {
            for (const bool whole_codes : {true, false}) {
                for (const Profile& profile : profiles) {
                    for (const int largest : largest_codes) {
                        cases.push_back({&profile, largest, random_colors, whole_codes, over});
                    }
                }
            }
        }
    }
    return cases;
}

// Plots the cases with an even profile, random colours and truncated opacities.
class OrderPlot {
  public:
    void add(const OrderCase& order_case, const OrderErrors& errors) {
        if (order_case.profile != profiles || !order_case.random_colors || order_case.whole_codes)
            return;
        auto& curves = order_case.over == OverRounding::separate ? separate_ : fused_;
        curves.x.push_back(order_case.largest);
        curves.front.push_back(errors.front_to_back.l2);
        curves.back.push_back(errors.back_to_front.l2);
    }
    std::string svg() const {
        const auto highest = [](const Curve& c) { return *std::max_element(c.begin(), c.end()); };
        const double high = std::max({highest(separate_.front), highest(separate_.back),
                                      highest(fused_.front), highest(fused_.back)});
        LinePlot plot{"Order of compositing: 256 random samples in 8 bits",
                      {"largest opacity code of a sample", 1, 128, true},
                      {"L2 error of colour, in 1/255", 0, high}};
        plot.add("back to front", separate_.x, separate_.back);
        plot.add("front to back", separate_.x, separate_.front);
        plot.add("back to front, fused", fused_.x, fused_.back);
        plot.add("front to back, fused", fused_.x, fused_.front);
        return plot.svg();
    }

  private:
    struct Curves {
        Curve x, front, back;
    };
    Curves separate_, fused_;
};

// Counts the columns of ramps of equal fragments that differ between the orders.
Json equal_fragments() {
    Json rows = Json::array();
    for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
        for (const double color : {1.0, 0.5}) {
            for (const int samples : {16, 64, 256, 1024}) {
                RampSetting setting{.samples = samples, .color = color};
                setting.emulation.over = over;
                const Curve back = composite_ramp(setting);
                setting.order = Order::front_to_back;
                const Curve front = composite_ramp(setting);
                int different = 0;
                for (std::size_t x = 0; x < back.size(); ++x) different += front[x] != back[x];
                const Curve exact = exact_ramp(color);
                rows.push_back({{"over", name_of(over)},
                                {"color", color},
                                {"samples", samples},
                                {"different_columns", different},
                                {"front_to_back", study::to_json(error_of(front, exact))},
                                {"back_to_front", study::to_json(error_of(back, exact))}});
            }
        }
    }
    return rows;
}

Json to_json(const OrderCase& order_case, const OrderErrors& errors, const char* better) {
    return {{"profile", order_case.profile->name},
            {"largest_code", order_case.largest},
            {"colors", order_case.random_colors ? "random" : "white"},
            {"opacities", order_case.whole_codes ? "whole codes" : "truncated"},
            {"over", name_of(order_case.over)},
            {"front_to_back", study::to_json(errors.front_to_back)},
            {"back_to_front", study::to_json(errors.back_to_front)},
            {"better", better}};
}

std::string csv_of(const Json& rows) {
    study::CsvTable csv({"profile", "largest_code", "colors", "opacities", "over", "ftb_linf",
                         "ftb_l1", "ftb_l2", "btf_linf", "btf_l1", "btf_l2", "better"});
    for (const Json& row : rows) {
        std::vector<std::string> cells;
        for (const auto& [key, value] : row.items()) {
            if (value.is_string()) cells.push_back(value.get<std::string>());
            if (value.is_number()) cells.push_back(value.dump());
            if (!value.is_object()) continue;
            for (const Json& norm : value)
                cells.push_back(fmt::format("{:.4f}", norm.get<double>()));
        }
        csv.add_row(cells);
    }
    return csv.text();
}

}  // namespace

Json reproduce_order(const std::filesystem::path& folder) {
    const std::vector<OrderCase> cases = order_cases();
    Progress progress("order", static_cast<std::int64_t>(cases.size()));
    Json rows = Json::array();
    Score all, white, colored;
    OrderPlot plot;
    for (const OrderCase& order_case : cases) {
        const OrderErrors errors = measure_orders(order_case);
        const char* const better = all.add(errors);
        (order_case.random_colors ? colored : white).add(errors);
        plot.add(order_case, errors);
        rows.push_back(to_json(order_case, errors, better));
        progress.advance();
    }
    study::write_text(folder / "order.csv", csv_of(rows));
    study::write_text(folder / "order.svg", plot.svg());
    Findings findings;
    findings.add(
        "It is \"common knowledge\" in the visualization community that front-to-back compositing "
        "produces higher quality imagery than back-to-front.",
        all.front == static_cast<int>(cases.size()),
        fmt::format("by L2 of {} random rays, front to back is better in {} cases, back to front "
                    "in {}, and {} are within {:.0f} % of each other",
                    ray_count, all.front, all.back, all.equal, 100 * same_share));
    Json values{
        {"files", {"order.csv", "order.svg"}}, {"samples", ray_samples}, {"rays", ray_count}};
    values["better"] = {
        {"all", all.to_json()}, {"white", white.to_json()}, {"random_colors", colored.to_json()}};
    values["equal_fragments"] = equal_fragments();
    values["random_rays"] = rows;
    values["caption"] =
        "Rays of 256 random samples in 8 bits, composited in both orders; further down is better. "
        "Curves that are not fused round each product of OVER by itself.";
    return findings.result(
        values, nullptr,
        "With white, the colour of a ray front to back is that of the mirrored ray back to front: "
        "haze in front gains from one order what haze behind it loses. With colours, each sample "
        "front to back is rounded after its attenuation, and many small ones vanish.");
}

}  // namespace lamina::papers
