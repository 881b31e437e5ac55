// SPDX-License-Identifier: Apache-2.0
#include "measurements.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

namespace lamina::view {
namespace {

double cpu_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

nlohmann::json summary(std::vector<double> ms) {
    if (ms.empty()) return {{"n", 0}};
    std::ranges::sort(ms);
    const auto at = [&](double share) {
        return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
    };
    return {{"n", ms.size()}, {"median", at(.5)}, {"p90", at(.9)}, {"max", ms.back()}};
}

}  // namespace

void Measurements::start() {
    latencies_.clear();
    frames_.clear();
    cpu_seconds_ = cpu_seconds();
    seconds_ = now_seconds();
}

std::string Measurements::text(const std::string& name, const Shown& shown) const {
    const double seconds = now_seconds() - seconds_;
    const std::optional<double> expected = shown.plan.error.known();
    const nlohmann::ordered_json line = {
        {"name", name},
        {"seconds", seconds},
        {"cpu_percent", 100 * (cpu_seconds() - cpu_seconds_) / seconds},
        {"input_to_picture_ms", summary(latencies_)},
        {"frame_ms", summary(frames_)},
        {"share_traced", shown.share_traced},
        {"linf", shown.error.linf},
        {"l2", shown.error.l2},
        {"expected", expected ? nlohmann::ordered_json(*expected) : nlohmann::ordered_json()}};
    return line.dump();
}

}  // namespace lamina::view
