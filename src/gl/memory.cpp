// SPDX-License-Identifier: Apache-2.0
#include "gl/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

#include "base/error.h"

namespace lamina::gl {
namespace {

std::atomic<std::int64_t> total{0};
constexpr std::int64_t mebibyte = 1 << 20;

}  // namespace

std::int64_t bytes_allocated() {
    return total;
}

void require_memory_left(std::int64_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    std::int64_t pages = 0;
    if (!(std::ifstream("/proc/self/statm") >> pages)) return;
    const std::int64_t left = static_cast<std::int64_t>(limit.rlim_cur) - pages * getpagesize();
    if (left >= bytes) return;
    fail(
        "OpenGL: the limit on this process's memory (ulimit -v) leaves {} MiB, expected {}: raise "
        "it, or do without OpenGL: --context cpu",
        left / mebibyte, bytes / mebibyte);
}

AllocatedBytes::AllocatedBytes(std::int64_t count) : count_(count) {
    total += count_;
}

AllocatedBytes::~AllocatedBytes() {
    total -= count_;
}

}  // namespace lamina::gl
