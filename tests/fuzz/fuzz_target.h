// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace lamina::fuzz {

// A fuzzed reader, with the code that uses its results. Bad input must end in a lamina::Error,
// which run() catches. Other exceptions, Violation (violation.h) included, propagate and count as
// findings, and so do reports of sanitizers.
struct FuzzTarget {
    const char* name;  // the target's folder in corpus/
    void (*run)(std::string_view input);
    // Number of mutated corpus inputs that the ordinary tests try (mutations_test.cpp).
    int mutations = 2000;
};

// FuzzTarget::mutations for readers that start a process per input (30 ms).
constexpr int few_mutations = 100;

// Lists all targets (fuzz_target.cpp).
std::span<const FuzzTarget> fuzz_targets();

}  // namespace lamina::fuzz
