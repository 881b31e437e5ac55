// SPDX-License-Identifier: Apache-2.0
// The functions that libFuzzer calls. Each program has one target, LAMINA_FUZZ_TARGET.
#include <sys/mman.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "runs.h"

// The counters of clang's -fsanitize-coverage=inline-8bit-counters: how often code was reached.
extern "C" char __start___sancov_cntrs[], __stop___sancov_cntrs[];

// Shares the counters with the processes that isolate libraries, so that libFuzzer sees which code
// an input has reached there, too. Leaves out what shares a page with other variables.
extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto first = reinterpret_cast<std::uintptr_t>(__start___sancov_cntrs);
    const auto last = reinterpret_cast<std::uintptr_t>(__stop___sancov_cntrs);
    const std::uintptr_t begin = (first + page - 1) / page * page, end = last / page * page;
    if (begin >= end) return 0;
    char* const counters = __start___sancov_cntrs + (begin - first);
    const std::vector<char> before(counters, counters + (end - begin));
    if (mmap(counters, before.size(), PROT_READ | PROT_WRITE,
             MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != counters)
        std::abort();
    std::memcpy(counters, before.data(), before.size());
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // Inputs are so small that handing work to threads would take longer than the work.
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    lamina::fuzz::LAMINA_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
