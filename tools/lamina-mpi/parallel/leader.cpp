// SPDX-License-Identifier: Apache-2.0
#include "parallel/leader.h"

#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "base/client.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/process.h"
#include "parallel/ranks.h"
#include "plan/plan.h"
#include "render/draw_context.h"
#include "scene_files/scene_reader.h"
#include "volume_files/volume_file.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

// Text for OmissionSwitch::none. Otherwise the text lists OmissionSwitch::kept.
constexpr const char* all_omissions = "all";

// A scene and the user's choice of omissions, as texts that rank 0 broadcasts.
class SceneMessage {
  public:
    SceneMessage() = default;  // on the other ranks, before it arrives
    SceneMessage(const Scene& scene, const OmissionSwitch& omissions);

    void broadcast(const Ranks& ranks);

    Scene scene() const;  // throws Error
    OmissionSwitch omissions() const;
    // Returns the folder that must contain all data files (base/client.h); empty if any may.
    const std::string& only_below() const { return only_below_; }

  private:
    std::string name_, text_;  // path of the scene file; the scene as JSON
    // Absolute path of the volume. JSON cannot hold every file name, so it is sent separately.
    std::string volume_;
    std::string forbidden_omissions_;
    std::string only_below_;
};

// A command of rank 0 to the other ranks, sent as bytes. Each comment names the kinds of commands
// that use the member.
struct Command {
    enum class Kind { open, draw, close, end };

    Kind kind = Kind::end;
    int scene = 0;                        // open, draw, close: number of the scene
    Wire wire = Wire::float32;            // open
    unsigned long long memory_limit = 0;  // open: bytes, 0: unchanged
    bool many_frames = false;             // open
    bool in_files = false;                // open: the volume stays in its files
    bool has_camera = false;              // draw: `camera` replaces the last one
    Camera camera{};                      // draw
};
static_assert(std::is_trivially_copyable_v<Command>);

std::string path_of_volume(const Scene& scene) {
    const VolumeFile* const file = scene.volume_file();
    return file == nullptr ? "" : std::filesystem::absolute(file->path).string();
}

SceneMessage::SceneMessage(const Scene& scene, const OmissionSwitch& omissions)
    : name_(scene.file.string()),
      text_(json_text(scene_json(scene))),
      volume_(path_of_volume(scene)),
      forbidden_omissions_(omissions.none ? all_omissions
                                          : fmt::format("{}", fmt::join(omissions.kept, " "))) {
    if (const auto folder = ClientScope::current().only_below) only_below_ = folder->string();
}

void SceneMessage::broadcast(const Ranks& ranks) {
    for (std::string* const sent : {&name_, &text_, &volume_, &forbidden_omissions_, &only_below_})
        ranks.broadcast(*sent);
}

Scene SceneMessage::scene() const {
    Scene scene = read_scene(parse_json(text_), name_);
    if (VolumeFile* const file = scene.volume_file()) file->path = volume_;
    return scene;
}

OmissionSwitch SceneMessage::omissions() const {
    OmissionSwitch omissions;
    omissions.none = forbidden_omissions_ == all_omissions;
    std::istringstream names(forbidden_omissions_);
    for (std::string name; !omissions.none && names >> name;) omissions.kept.insert(name);
    return omissions;
}

void send(const Ranks& ranks, Command command) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(&command, sizeof command, MPI_BYTE, 0, ranks.comm(), &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
}

// Waits for a command, which may take minutes while rank 0 reads data. Sleeps between tests,
// because MPI's own wait would occupy a processor that other ranks need.
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

// Tells whether the volume of a scene stays in its files.
bool stays_in_files(const Scene& scene, SceneData& data) {
    return scene.volume_file() != nullptr && !scene.draws_mesh() &&
           !data.volume(scene)->volume.in_memory();
}

// Opens a volume in memory or in its files, as rank 0 has it. Rank 0 decides, because it opened the
// volume before it chose whether there is light, which takes memory. Its warnings are rank 0's,
// too.
SceneData opened(const Scene& scene, bool in_files) {
    const VolumeFile* const file = scene.volume_file();
    if (file == nullptr || scene.draws_mesh()) return {};
    VolumeUse use;
    if (in_files) use.residence = VolumeUse::Residence::in_files;
    Warnings said;
    return keep_warnings(said,
                         [&] { return SceneData(open_volume(file->path, file->selection, use)); });
}

std::unique_ptr<SharedRenderer> open(const Ranks& ranks, const Command& command,
                                     const SceneMessage& message,
                                     const std::shared_ptr<TableCache>& tables) {
    std::unique_ptr<SharedRenderer> renderer;
    agree(ranks, [&] {
        restrict_instructions_as_asked();
        if (command.memory_limit > 0) set_memory_limit(command.memory_limit);
        const Scene scene = message.scene();
        renderer = std::make_unique<SharedRenderer>(
            ranks, command.wire, scene, opened(scene, command.in_files), message.omissions(),
            command.many_frames, tables);
        renderer->set_up();
    });
    renderer->check_plan();
    return renderer;
}

class Follower {
  public:
    explicit Follower(const Ranks& ranks) : ranks_(ranks) {}

    // Carries out a command. Returns false after the last one.
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
                    ->draw(command.has_camera ? std::optional(command.camera) : std::nullopt);
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
    std::filesystem::path only_below_;  // the same for all scenes of a command line
    std::map<int, std::unique_ptr<SharedRenderer>> renderers_;
};

}  // namespace

Leader::~Leader() {
    send(ranks_, {});
}

int Leader::open(const Scene& scene, SceneData data, const OmissionSwitch& omissions,
                 bool many_frames) {
    const bool in_files = stays_in_files(scene, data);
    auto renderer = std::make_unique<SharedRenderer>(ranks_, wire_, scene, std::move(data),
                                                     omissions, many_frames, tables_);
    Command command{.kind = Command::Kind::open,
                    .scene = next_,
                    .wire = wire_,
                    .memory_limit = memory_limit_is_given() ? memory_limit() : 0,
                    .many_frames = many_frames,
                    .in_files = in_files};
    SceneMessage message(scene, omissions);
    send(ranks_, command);
    message.broadcast(ranks_);
    agree(ranks_, [&] { renderer->set_up(); });
    renderer->check_plan();
    renderers_.emplace(next_, std::move(renderer));
    return next_++;
}

void Leader::draw(int scene, const std::optional<Camera>& camera) {
    send(ranks_, {.kind = Command::Kind::draw,
                  .scene = scene,
                  .has_camera = camera.has_value(),
                  .camera = camera.value_or(Camera())});
    renderer(scene).draw(camera);
    if (first_reports_.empty()) first_reports_ = renderer(scene).reports();
}

void Leader::close(int scene) {
    send(ranks_, {.kind = Command::Kind::close, .scene = scene});
    renderers_.erase(scene);
}

void run_follower(const Ranks& ranks) {
    make_streams_safe();
    Progress::set_quiet(true);
    Follower follower(ranks);
    for (;;) {
        const Command command = next_command(ranks);
        try {
            if (!follower.follow(command)) return;
        } catch (const Error&) {
            // All ranks know of the error (agree()), and rank 0 decides what follows.
        }
    }
}

}  // namespace lamina
