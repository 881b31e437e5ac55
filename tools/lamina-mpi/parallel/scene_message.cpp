// SPDX-License-Identifier: Apache-2.0
#include "parallel/scene_message.h"

#include <fmt/ranges.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/client.h"
#include "base/json_text.h"
#include "scene_files/scene_json.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

std::string path_of_volume(const Scene& scene) {
    const VolumeFile* const file = scene.volume_file();
    return file == nullptr ? "" : std::filesystem::absolute(file->path).string();
}

}  // namespace

SceneMessage::SceneMessage(const Scene& scene, const OmissionSwitch& omissions)
    : name_(scene.file.string()),
      text_(json_text(scene_json(scene))),
      volume_(path_of_volume(scene)),
      kept_(omissions.none ? "all" : fmt::format("{}", fmt::join(omissions.kept, " "))) {
    if (const auto folder = ClientScope::current().only_below) only_below_ = folder->string();
}

void SceneMessage::broadcast(const Ranks& ranks) {
    for (std::string* const sent : {&name_, &text_, &volume_, &kept_, &only_below_})
        ranks.broadcast(*sent);
}

Scene SceneMessage::scene() const {
    Scene scene = read_scene(parse_json(text_), name_);
    if (VolumeFile* const file = scene.volume_file()) file->path = volume_;
    return scene;
}

OmissionSwitch SceneMessage::omissions() const {
    OmissionSwitch omissions;
    omissions.none = kept_ == "all";
    std::istringstream names(kept_);
    for (std::string name; !omissions.none && names >> name;) omissions.kept.insert(name);
    return omissions;
}

}  // namespace lamina
