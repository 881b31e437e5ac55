// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace lamina::fuzz {

// What is tried with inputs of any kind: a reader, and what its results go into. Errors of type
// lamina::Error are what bad input is to end in; run() lets all else through: other exceptions,
// Violation (violation.h) among them, are findings, and so are whatever sanitizers report.
struct FuzzTarget {
    const char* name;  // of its folder in corpus/
    void (*run)(std::string_view input);
    // Mutations of its corpus in the ordinary tests.
    int mutations = 2000;
};

// Of readers that start a process for each input, which takes some 30 ms.
constexpr int few_mutations = 100;

std::span<const FuzzTarget> fuzz_targets();

}  // namespace lamina::fuzz
