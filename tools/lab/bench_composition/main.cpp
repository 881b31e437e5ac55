// SPDX-License-Identifier: Apache-2.0
// Times compositing of the ranks' pictures of one scene, by lamina-mpi's direct send and by IceT,
// in interleaved rounds, and measures the error of each. Rank 0 writes a line of JSON.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/arithmetic.h"
#include "base/json_text.h"
#include "icet_compositor.h"
#include "parallel/ranks.h"
#include "parallel/shared_renderer.h"
#include "render/pipeline.h"
#include "scene_files/scene_reader.h"

namespace {

using namespace lamina;

constexpr int rounds = 15;

struct Contestant {
    const char* name;
    std::function<void(Image&)> compose;
    std::function<std::int64_t()> bytes_sent;
    std::vector<double> milliseconds;
    std::int64_t bytes = 0;
    double linf = 0, bias = 0;
};

PreciseImage all_together(const Ranks& ranks, const std::vector<int>& order, const Image& own) {
    const int size = static_cast<int>(own.rgba.size());
    std::vector<float> all(ranks.leads() ? own.rgba.size() * order.size() : 0);
    MPI_Gather(own.rgba.data(), size, MPI_FLOAT, all.data(), size, MPI_FLOAT, 0, ranks.comm());
    PreciseImage sum(own.width, own.height);
    for (const int rank : ranks.leads() ? order : std::vector<int>()) {
        const float* const picture = all.data() + static_cast<std::size_t>(rank) * own.rgba.size();
        for (std::size_t i = 0; i < own.rgba.size(); i += 4) {
            const double left = 1 - sum.rgba[i + 3];
            for (std::size_t channel = 0; channel < 4; ++channel)
                sum.rgba[i + channel] += left * double{picture[i + channel]};
        }
    }
    return sum;
}

void run_round(const Ranks& ranks, const Image& own, const PreciseImage& truth, Contestant& one) {
    Image picture = own;
    MPI_Barrier(ranks.comm());
    const double start = MPI_Wtime();
    one.compose(picture);
    const double took = 1000 * (MPI_Wtime() - start);
    double slowest = 0;
    MPI_Reduce(&took, &slowest, 1, MPI_DOUBLE, MPI_MAX, 0, ranks.comm());
    const std::int64_t sent = one.bytes_sent();
    MPI_Reduce(&sent, &one.bytes, 1, MPI_INT64_T, MPI_SUM, 0, ranks.comm());
    one.milliseconds.push_back(slowest);
    if (!ranks.leads()) return;
    one.linf = one.bias = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        const double error = 255 * (double{picture.rgba[i]} - truth.rgba[i]);
        one.linf = std::max(one.linf, std::abs(error));
        one.bias += error / static_cast<double>(picture.rgba.size());
    }
}

void bench(const Ranks& ranks, const char* file) {
    const Scene scene = read_scene(scene_document(file), file);
    Pipeline pipeline(scene, {},
                      {.context = ContextChoice::cpu, .share = {ranks.number(), ranks.count()}});
    Image own;
    pipeline.draw_frame();
    pipeline.read(own);
    const std::vector<int> order = pipeline.renderer().front_to_back();
    const PreciseImage truth = all_together(ranks, order, own);

    std::vector<std::unique_ptr<PictureComposer>> composers;
    std::vector<std::unique_ptr<IcetCompositor>> icet;
    std::vector<Contestant> contestants;
    for (const Wire wire : {Wire::float32, Wire::half, Wire::coded}) {
        auto& composer = *composers.emplace_back(std::make_unique<PictureComposer>(ranks, wire));
        contestants.push_back({name_of(wire),
                               [&](Image& it) { composer.compose(order, it); },
                               [&] { return composer.bytes_sent(); },
                               {}});
    }
    for (const auto format : {IcetCompositor::Format::float32, IcetCompositor::Format::bytes}) {
        auto& compositor =
            *icet.emplace_back(std::make_unique<IcetCompositor>(format, own.width, own.height));
        contestants.push_back(
            {format == IcetCompositor::Format::float32 ? "IceT float32" : "IceT bytes",
             [&](Image& it) { compositor.compose(order, it); },
             [&] { return compositor.bytes_sent(); },
             {}});
    }
    for (int round = 0; round < rounds; ++round)
        for (Contestant& one : contestants) run_round(ranks, own, truth, one);
    if (!ranks.leads()) return;
    nlohmann::ordered_json report{{"ranks", ranks.count()}};
    for (const Contestant& one : contestants) {
        report[one.name] = {{"ms", median(one.milliseconds)},
                            {"bytes", one.bytes},
                            {"linf", one.linf},
                            {"bias", one.bias}};
    }
    std::printf("%s\n", json_text(report).c_str());
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    if (argc != 2) {
        std::fprintf(stderr, "usage: mpirun -n N bench_composition SCENE.json\n");
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    try {
        const Ranks ranks(MPI_COMM_WORLD);
        const RankResources resources(ranks);
        bench(ranks, argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_composition: %s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
    return 0;
}
