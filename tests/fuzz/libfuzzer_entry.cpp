// SPDX-License-Identifier: Apache-2.0
// The function that libFuzzer calls. Each program has one target, LAMINA_FUZZ_TARGET.
#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "runs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // Inputs are so small that handing work to threads would take longer than the work.
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    lamina::fuzz::LAMINA_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
