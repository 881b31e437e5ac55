// SPDX-License-Identifier: Apache-2.0
#include "gl/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "gl/current_context.h"

namespace lamina::gl {
namespace {

constexpr std::int64_t mebibyte = 1 << 20;

}  // namespace

std::int64_t bytes_allocated() {
    Context* const context = current_context();
    return context != nullptr ? context->counts().bytes_allocated : 0;
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
    current_context()->counts().bytes_allocated += count_;
}

AllocatedBytes::~AllocatedBytes() {
    if (count_ != 0) current_context()->counts().bytes_allocated -= count_;
}

}  // namespace lamina::gl
