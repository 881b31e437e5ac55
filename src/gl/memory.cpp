// SPDX-License-Identifier: Apache-2.0
#include "gl/memory.h"

#include <atomic>

namespace lamina::gl {
namespace {

std::atomic<std::int64_t> total{0};

}  // namespace

std::int64_t bytes_allocated() {
    return total;
}

AllocatedBytes::AllocatedBytes(std::int64_t count) : count_(count) {
    total += count_;
}

AllocatedBytes::~AllocatedBytes() {
    total -= count_;
}

}  // namespace lamina::gl
