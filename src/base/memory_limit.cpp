// SPDX-License-Identifier: Apache-2.0
#include "base/memory_limit.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <string>

namespace lamina {
namespace {

std::atomic<std::uint64_t> told_limit{0}, default_limit{0};  // 0: none

std::uint64_t measure_machine_memory() {
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    std::uint64_t bytes = page * static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
    // "max", or no such file, where the control group has no limit.
    std::uint64_t group = 0;
    if (std::ifstream("/sys/fs/cgroup/memory.max") >> group) bytes = std::min(bytes, group);
    return bytes;
}

}  // namespace

std::uint64_t machine_memory() {
    static const std::uint64_t bytes = measure_machine_memory();
    return bytes;
}

std::uint64_t memory_limit() {
    if (const std::uint64_t told = told_limit.load(); told > 0) return told;
    const std::uint64_t usual = default_limit.load();
    return usual > 0 ? usual : machine_memory() / 2;
}

void set_memory_limit(std::uint64_t bytes) {
    told_limit.store(bytes);
}

void set_default_memory_limit(std::uint64_t bytes) {
    default_limit.store(bytes);
}

bool memory_limit_is_told() {
    return told_limit.load() > 0;
}

std::uint64_t resident_memory() {
    std::uint64_t pages = 0, resident = 0;
    if (!(std::ifstream("/proc/self/statm") >> pages >> resident)) return 0;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_memory() {
    std::ifstream status("/proc/self/status");
    const std::string name = "VmHWM:";
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(name)) return std::stoull(line.substr(name.size())) * 1024;  // KiB
    return 0;
}

std::uint64_t memory_left() {
    const std::uint64_t allowed = memory_limit() + own_memory, taken = resident_memory();
    return allowed - std::min(allowed, taken);
}

}  // namespace lamina
