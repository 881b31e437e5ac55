// SPDX-License-Identifier: Apache-2.0
#include "parallel/leader.h"

#include <utility>

#include "base/memory_limit.h"
#include "parallel/agreement.h"
#include "parallel/command.h"
#include "parallel/scene_message.h"

namespace lamina {
namespace {

void tell(const Ranks& ranks, Command command) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(&command, sizeof command, MPI_BYTE, 0, ranks.comm(), &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
}

}  // namespace

Leader::~Leader() {
    tell(ranks_, {});
}

int Leader::open(const Scene& scene, SceneData data, const OmissionSwitch& omissions,
                 bool many_frames) {
    auto renderer = std::make_unique<SharedRenderer>(ranks_, wire_, scene, std::move(data),
                                                     omissions, many_frames, tables_);
    Command command{.kind = Command::Kind::open,
                    .scene = next_,
                    .wire = wire_,
                    .memory_limit = memory_limit_is_told() ? memory_limit() : 0,
                    .many_frames = many_frames};
    SceneMessage message(scene, omissions);
    tell(ranks_, command);
    message.broadcast(ranks_);
    agree(ranks_, [&] { renderer->set_up(); });
    renderer->check_plan();
    renderers_.emplace(next_, std::move(renderer));
    return next_++;
}

void Leader::draw(int scene, const std::optional<Camera>& camera) {
    tell(ranks_, {.kind = Command::Kind::draw,
                  .scene = scene,
                  .turned = camera.has_value(),
                  .camera = camera.value_or(Camera())});
    renderer(scene).draw(camera);
    if (first_reports_.empty()) first_reports_ = renderer(scene).reports();
}

void Leader::close(int scene) {
    tell(ranks_, {.kind = Command::Kind::close, .scene = scene});
    renderers_.erase(scene);
}

}  // namespace lamina
