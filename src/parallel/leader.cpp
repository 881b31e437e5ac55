// SPDX-License-Identifier: Apache-2.0
#include "parallel/leader.h"

#include <fmt/ranges.h>

#include <utility>

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "parallel/agreement.h"
#include "parallel/command.h"
#include "scene_files/scene_json.h"

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

int Leader::open(const Scene& scene, std::shared_ptr<const VolumeData> volume,
                 const OmissionSwitch& omissions, bool many_frames) {
    auto renderer =
        std::make_unique<SharedRenderer>(ranks_, wire_, scene, std::move(volume), omissions);
    Command command{
        .kind = Command::Kind::open, .scene = next_, .wire = wire_, .many_frames = many_frames};
    if (memory_limit() != memory_before_) command.memory_limit = memory_limit();
    tell(ranks_, command);
    std::string name = scene.file.string(), text = json_text(scene_json(scene));
    std::string kept = omissions.none ? "all" : fmt::format("{}", fmt::join(omissions.kept, " "));
    for (std::string* const sent : {&name, &text, &kept}) ranks_.broadcast(*sent);
    agree(ranks_, [&] { renderer->set_up(many_frames); });
    renderer->check_plan();
    renderers_.emplace(next_, std::move(renderer));
    return next_++;
}

void Leader::draw(int scene, const Camera& camera) {
    tell(ranks_, {.kind = Command::Kind::draw, .scene = scene, .camera = camera});
    renderer(scene).draw(camera);
}

void Leader::close(int scene) {
    tell(ranks_, {.kind = Command::Kind::close, .scene = scene});
    renderers_.erase(scene);
}

}  // namespace lamina
