// SPDX-License-Identifier: Apache-2.0
#include "parallel/followers.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <thread>

#include "base/client.h"
#include "base/error.h"
#include "base/memory_limit.h"
#include "base/progress.h"
#include "base/standard_streams.h"
#include "base/unreachable.h"
#include "parallel/agreement.h"
#include "parallel/command.h"
#include "parallel/scene_message.h"
#include "parallel/shared_renderer.h"
#include "render/context_choice.h"

namespace lamina {
namespace {

// Rank 0 may take minutes to read and to choose. MPI itself waits with a processor at full load,
// which other ranks need.
Command next_command(const Ranks& ranks) {
    Command command;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(&command, sizeof command, MPI_BYTE, 0, ranks.comm(), &request);
    for (int arrived = 0, tries = 0;; ++tries) {
        MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
        if (arrived != 0) return command;
        if (tries > 1000) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
}

std::unique_ptr<SharedRenderer> open(const Ranks& ranks, const Command& command,
                                     const SceneMessage& message,
                                     const std::shared_ptr<TableCache>& tables) {
    std::unique_ptr<SharedRenderer> renderer;
    agree(ranks, [&] {
        restrict_instructions_as_asked();
        if (command.memory_limit > 0) set_memory_limit(command.memory_limit);
        const Scene scene = message.scene();
        renderer =
            std::make_unique<SharedRenderer>(ranks, command.wire, scene, SceneData(),
                                             message.omissions(), command.many_frames, tables);
        renderer->set_up();
    });
    renderer->check_plan();
    return renderer;
}

class Follower {
  public:
    explicit Follower(const Ranks& ranks) : ranks_(ranks) {}

    // Does one thing. False: that was all.
    bool follow(const Command& command) {
        switch (command.kind) {
            case Command::Kind::open: {
                SceneMessage message;
                message.broadcast(ranks_);
                only_below_ = message.only_below();
                const OnlyBelowScope below(only_below_);
                renderers_[command.scene] = open(ranks_, command, message, tables_);
                return true;
            }
            case Command::Kind::draw: {
                const OnlyBelowScope below(only_below_);
                renderers_.at(command.scene)
                    ->draw(command.turned ? std::optional(command.camera) : std::nullopt);
                return true;
            }
            case Command::Kind::close:
                renderers_.erase(command.scene);
                return true;
            case Command::Kind::end:
                return false;
        }
        unreachable_enum();
    }

  private:
    const Ranks& ranks_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    std::filesystem::path only_below_;  // of all scenes: the program has one command line
    std::map<int, std::unique_ptr<SharedRenderer>> renderers_;
};

}  // namespace

void run_follower(const Ranks& ranks) {
    make_streams_safe();
    Progress::set_quiet(true);
    Follower follower(ranks);
    for (;;) {
        const Command command = next_command(ranks);
        try {
            if (!follower.follow(command)) return;
        } catch (const Error&) {
            // All ranks know of it, and rank 0 decides what follows.
        }
    }
}

}  // namespace lamina
