// SPDX-License-Identifier: Apache-2.0
#include "work/saving.h"

#include <chrono>
#include <exception>
#include <utility>

#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

void write(const std::filesystem::path& file, const Shown& shown) {
    const Scene& scene = *shown.resolved;
    if (file.extension() == ".json") return save_scene(scene, file);
    const std::map<std::string, std::string> attributes = {{"scene", scene_text(scene)},
                                                           {"plan", shown.explanation},
                                                           {"renderer", shown.statistics.drawn_by}};
    if (scene.method == Method::trace)
        save_picture(*shown.truth, file, scene.png_look(), attributes);
    else
        save_picture(*shown.full, file, scene.png_look(), attributes);
}

}  // namespace

bool can_save(const std::filesystem::path& file) {
    const std::filesystem::path suffix = file.extension();
    return suffix == ".json" || suffix == ".exr" || suffix == ".png" || suffix == ".npy";
}

void Saving::save(const std::filesystem::path& file, std::shared_ptr<const Shown> shown) {
    ++unfinished_;
    std::erase_if(running_, [](const std::future<void>& running) {
        return running.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    running_.push_back(std::async(std::launch::async, [this, file, shown = std::move(shown)] {
        Result result{file, {}};
        try {
            write(file, *shown);
        } catch (const std::exception& error) {
            result.failure = error.what();
        }
        {
            const std::lock_guard lock(mutex_);
            results_.push_back(std::move(result));
        }
        wake_();
    }));
}

std::vector<Saving::Result> Saving::take_results() {
    const std::lock_guard lock(mutex_);
    unfinished_ -= results_.size();
    return std::exchange(results_, {});
}

}  // namespace lamina::view
