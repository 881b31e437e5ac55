// SPDX-License-Identifier: Apache-2.0
// `lamina render` with several processes that draw each picture together. Rank 0 reads the command
// line; the other ranks follow its Leader.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/large_stack.h"
#include "parallel/leader.h"
#include "parallel/ranks.h"
#include "program.h"
#include "render_output.h"
#include "shared_frames.h"

namespace {

using namespace lamina;

int lead(const Ranks& ranks, int argc, char** argv) {
    Leader leader(ranks);
    const auto add_verbs = [&](CLI::App& app, int&) {
        auto wire = std::make_shared<std::string>(name_of(Wire::float32));
        RenderExtras extras;
        extras.check = [&leader, wire](const Scene& scene, const Auto<ContextChoice>& context) {
            leader.set_wire(wire_of(*wire));
            check_shared(scene, context);
        };
        extras.make_frames = [&leader](const Scene& scene, SceneData& data,
                                       const PipelineOptions& options) {
            return std::make_unique<SharedFrames>(leader, scene, data, options);
        };
        extras.add_statistics = [&leader](nlohmann::ordered_json& json) {
            if (!leader.first_reports().empty()) json["ranks"] = to_json(leader.first_reports());
        };
        CLI::App& verb = add_render_with(app, extras);
        verb.description("Render a volume to a picture, with each rank drawing its part of it");
        verb.footer("The shortest: mpirun -n 4 lamina-mpi render head.nrrd -o head.png");
        verb.add_option("--wire", *wire,
                        "How pixels travel between ranks: float32 (16 bytes), half (8), coded (5, "
                        "then 8: off by at most half a step of 8 bits)")
            ->option_text("float32|half|coded");
    };
    return run_command_line(
        {"lamina-mpi", "lamina-mpi: lamina render on several processes or machines",
         "A first picture: mpirun -n 4 lamina-mpi render head.nrrd -o head.png\n"
         "What a verb takes: lamina-mpi VERB --help",
         add_verbs},
        argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
    // Several threads call MPI, but never two at once: MPI_THREAD_SERIALIZED is enough.
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) {
        std::fputs("lamina: expected an MPI with MPI_THREAD_SERIALIZED\n", stderr);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    int exit_code = 0;
    {
        const Ranks ranks(MPI_COMM_WORLD);
        const RankResources resources(ranks);
        if (ranks.leads()) {
            exit_code = lead(ranks, argc, argv);
        } else {
            exit_code = with_large_stack([&] {
                run_follower(ranks);
                return 0;
            });
        }
    }
    MPI_Finalize();
    return exit_code;
}
