// SPDX-License-Identifier: Apache-2.0
#include "work/saving.h"

#include <chrono>
#include <exception>
#include <utility>

#include "lamina/picture_file.h"
#include "lamina/scene_text.h"

namespace lamina::view {
namespace {

void write(const std::filesystem::path& file, const Shown& shown) {
    const Scene& scene = *shown.resolved;
    if (file.extension() == ".json") return save_scene(scene, file);
    const std::map<std::string, std::string> attributes = {{"scene", scene_text(scene)},
                                                           {"plan", shown.explanation},
                                                           {"renderer", shown.statistics.drawn_by}};
    if (scene.method == Method::trace)
        save_picture(*shown.truth, file, scene.background, scene.color_space, attributes);
    else
        save_picture(*shown.full, file, scene.background, scene.color_space, attributes);
}

}  // namespace

bool can_save(const std::filesystem::path& file) {
    const std::filesystem::path suffix = file.extension();
    return suffix == ".json" || suffix == ".exr" || suffix == ".png" || suffix == ".npy";
}

void Saving::save(const std::filesystem::path& file, std::shared_ptr<const Shown> shown) {
    running_.push_back(std::async(std::launch::async, [=, wake = wake_, shown = std::move(shown)] {
        Result result{file, {}};
        try {
            write(file, *shown);
        } catch (const std::exception& error) {
            result.failure = error.what();
        }
        wake();
        return result;
    }));
}

std::vector<Saving::Result> Saving::take_results() {
    std::vector<Result> results;
    std::erase_if(running_, [&](std::future<Result>& running) {
        if (running.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        results.push_back(running.get());
        return true;
    });
    return results;
}

}  // namespace lamina::view
