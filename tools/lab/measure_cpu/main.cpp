// SPDX-License-Identifier: Apache-2.0
// Measures what limits the cpu engine on this machine: arithmetic, gathers by cache level and
// bandwidth, of one core and of all that the process may run on.
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <barrier>
#include <bit>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "measure_cpu/kernels.h"
#include "simd/instruction_set.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

// The work that one thread does again and again. Its result keeps the compiler from leaving it out.
using Kernel = std::function<float(int thread)>;

volatile float sink;

constexpr double shortest_run = 0.05;  // seconds
constexpr int runs = 5;

// Returns the time from the first thread's start to the last one's end. Each thread reads the clock
// itself, because on a busy machine others may run in between.
double seconds_of(const Kernel& kernel, int threads, std::int64_t times) {
    std::barrier start(threads);
    const Stopwatch watch;
    std::vector<double> begins(static_cast<std::size_t>(threads)), ends = begins;
    std::vector<std::thread> crew;
    for (int thread = 0; thread < threads; ++thread) {
        crew.emplace_back([&, thread] {
            const auto number = static_cast<std::size_t>(thread);
            start.arrive_and_wait();
            begins[number] = watch.seconds();
            float sum = 0;
            for (std::int64_t i = 0; i < times; ++i) sum += kernel(thread);
            ends[number] = watch.seconds();
            sink = sum;
        });
    }
    for (std::thread& member : crew) member.join();
    return *std::ranges::max_element(ends) - *std::ranges::min_element(begins);
}

// Returns the units a second of all threads together; a call of the kernel does `units`. It is the
// best of some runs, which other processes disturb least.
double rate(const Kernel& kernel, int threads, double units) {
    std::int64_t times = 1;
    while (seconds_of(kernel, threads, times) < shortest_run) times *= 2;
    double best = 1e300;
    for (int run = 0; run < runs; ++run) best = std::min(best, seconds_of(kernel, threads, times));
    return static_cast<double>(times) * units * threads / best;
}

struct Measurement {
    std::string name, unit;
    double one, all;  // cores
};

class Machine {
  public:
    explicit Machine(int threads) : threads_(threads), lanes_(float_lanes()) {}

    std::vector<Measurement> measure() {
        measure_arithmetic();
        const std::size_t first = cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32 << 10);
        const std::size_t second = cache_bytes(_SC_LEVEL2_CACHE_SIZE, 1 << 20);
        const std::size_t third = cache_bytes(_SC_LEVEL3_CACHE_SIZE, 16 << 20);
        measure_gathers("L1", first / 2);
        measure_gathers("L2", second / 2);
        // All threads share the third level.
        measure_gathers("L3", std::max(2 * second, third / 4 / static_cast<std::size_t>(threads_)));
        measure_gathers("memory", memory_bytes);
        measure_bandwidth();
        return measurements_;
    }

  private:
    static constexpr std::size_t memory_bytes = std::size_t{256} << 20;  // of a thread

    static std::size_t cache_bytes(int name, std::size_t otherwise) {
        const long bytes = sysconf(name);
        return bytes > 0 ? static_cast<std::size_t>(bytes) : otherwise;
    }

    void add(const std::string& name, const std::string& unit, double scale, double units,
             const Kernel& kernel) {
        measurements_.push_back(
            {name, unit, scale * rate(kernel, 1, units), scale * rate(kernel, threads_, units)});
    }

    void measure_arithmetic() {
        constexpr std::int64_t rounds = 10000;
        const double operations = static_cast<double>(rounds) * chains * lanes_;
        add("float32 multiply, then add", "Gflop/s", 1e-9, 2 * operations,
            [](int) { return multiply_and_add(rounds, 0.25f, 1.0f); });
        add("float32 division", "G/s", 1e-9, operations, [](int) { return divide(rounds, 1.5f); });
    }

    // `bytes` is the size of each thread's table, rounded down to a power of two.
    void measure_gathers(const std::string& level, std::size_t bytes) {
        const std::vector<std::vector<float>> tables(
            static_cast<std::size_t>(threads_),
            std::vector<float>(std::bit_floor(bytes / sizeof(float)), 1.0f));
        const auto table = [&](int thread) {
            return std::span<const float>(tables[static_cast<std::size_t>(thread)]);
        };
        constexpr std::int64_t rounds = 20000;
        const double numbers = static_cast<double>(rounds) * gathers * lanes_;
        const std::string size = fmt::format("{} ({} KiB)", level, tables[0].size() / 256);
        add("gather anywhere in " + size, "G/s", 1e-9, numbers,
            [&](int thread) { return gather_anywhere(table(thread), rounds); });
        // A call passes over the whole table if that takes longer.
        const std::int64_t over_all = std::max<std::int64_t>(
            rounds, static_cast<std::int64_t>(tables[0].size()) / (16 * gathers));
        add("gather 4 x 4 blocks in " + size, "G/s", 1e-9,
            static_cast<double>(over_all) * gathers * lanes_,
            [&](int thread) { return gather_blocks(table(thread), over_all); });
    }

    void measure_bandwidth() {
        constexpr std::size_t count = memory_bytes / sizeof(float) / 2;
        std::vector<std::vector<float>> numbers(3 * static_cast<std::size_t>(threads_),
                                                std::vector<float>(count, 1.0f));
        const auto array = [&](int thread, int which) -> std::vector<float>& {
            return numbers[static_cast<std::size_t>(3 * thread + which)];
        };
        add("memory: read", "GB/s", 1e-9, count * sizeof(float),
            [&](int thread) { return read_all(array(thread, 0)); });
        add("memory: a = b + c / 2", "GB/s", 1e-9, 3.0 * count * sizeof(float), [&](int thread) {
            triad(array(thread, 0), array(thread, 1), array(thread, 2));
            return array(thread, 0)[0];
        });
    }

    int threads_, lanes_;
    std::vector<Measurement> measurements_;
};

void run(const std::string& json_file) {
    const int threads = tbb::this_task_arena::max_concurrency();
    const std::string renderer = renderer_and_threads(cpu_capabilities());
    const std::vector<Measurement> measurements = Machine(threads).measure();
    nlohmann::ordered_json json{{"engine", renderer}, {"threads", threads}};
    fmt::print("{}\n{:44} {:>10} {:>10}\n", renderer, "", "one core",
               threads == 1 ? "" : fmt::format("{} cores", threads));
    for (const Measurement& m : measurements) {
        fmt::print("{:44} {:10.3g} {:10.3g} {}\n", m.name, m.one, m.all, m.unit);
        json["limits"].push_back(
            {{"name", m.name}, {"unit", m.unit}, {"one_core", m.one}, {"all_cores", m.all}});
    }
    if (json_file.empty()) return;
    AtomicFile file(json_file);
    file.write(json.dump(1) + "\n");
    file.commit();
}

}  // namespace
}  // namespace lamina

int main(int argc, char** argv) {
    CLI::App app("What this machine's cores can do at most, for the cpu engine");
    std::string json_file, instructions;
    app.add_option("--json", json_file, "Write the figures to this file, too");
    app.add_option("--instructions", instructions, "SSE4, AVX2, AVX3 or NEON instead of the best");
    CLI11_PARSE(app, argc, argv);
    try {
        if (!instructions.empty()) lamina::restrict_instructions(instructions);
        lamina::run(json_file);
    } catch (const lamina::UsageError& error) {
        fmt::print(stderr, "measure_cpu: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "measure_cpu: {}\n", error.what());
        return 1;
    }
    return 0;
}
