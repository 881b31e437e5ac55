// SPDX-License-Identifier: Apache-2.0
#include "study/machine.h"

#include <sched.h>
#include <sys/utsname.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>

#include <fmt/chrono.h>

namespace lamina::study {
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
