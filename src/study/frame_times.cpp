// SPDX-License-Identifier: Apache-2.0
#include "study/frame_times.h"

#include <fmt/chrono.h>
#include <sched.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>
#include <fstream>
#include <string>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/profile.h"
#include "base/progress.h"

namespace lamina::study {
namespace {

double cpu_milliseconds() {
    return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds) {
    assert(rounds >= 3);
    Progress progress(label, static_cast<std::int64_t>(frames.size()) * (rounds + 1));
    for (const TimedFrame& frame : frames) {
        frame.warm_up();
        progress.advance();
    }
    std::vector<std::vector<double>> ms(frames.size()), cpu(frames.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            check_interrupt();
            const double cpu_before = cpu_milliseconds();
            const Stopwatch watch;
            frames[i].draw();
            ms[i].push_back(watch.milliseconds());
            cpu[i].push_back(cpu_milliseconds() - cpu_before);
            progress.advance();
        }
    }
    std::vector<FrameTimes> times;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto [fastest, slowest] = std::minmax_element(ms[i].begin(), ms[i].end());
        times.push_back({median(ms[i]), median(cpu[i]), *fastest, *slowest, ms[i].size()});
    }
    return times;
}

nlohmann::ordered_json time_rows(const std::vector<TimedFrame>& frames,
                                 const std::vector<FrameTimes>& times) {
    auto rows = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        rows.push_back({{"technique", frames[i].name},
                        {"ms", times[i].ms},
                        {"ratio", times[i].ms / times[0].ms},
                        {"cpu_ms", times[i].cpu_ms},
                        {"cpu_ratio", times[i].cpu_ms / times[0].cpu_ms},
                        {"slowest_over_fastest", times[i].max / times[i].min}});
    }
    return rows;
}

namespace {

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    utsname names{};
    return uname(&names) == 0 ? names.machine : "unknown";
}

int processor_count() {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

}  // namespace

nlohmann::ordered_json describe_machine() {
    return {{"machine", processor_name()},
            {"processors", processor_count()},
            {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))}};
}

}  // namespace lamina::study
