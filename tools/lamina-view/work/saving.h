// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "work/shown.h"

namespace lamina::view {

// Returns true if the suffix is .json (for the scene), or .exr, .png or .npy (for the picture).
bool can_save(const std::filesystem::path& file);

// Writes files of the shown picture, each in a thread of its own: the window does not wait.
class Saving {
  public:
    struct Result {
        std::filesystem::path file;
        std::string failure;  // empty: it was written
    };

    // `wake`: called when a result can be taken.
    explicit Saving(std::function<void()> wake) : wake_(std::move(wake)) {}
    // Saves the resolved scene or the full picture, even if the screen shows another picture.
    void save(const std::filesystem::path& file, std::shared_ptr<const Shown> shown);
    bool busy() const { return unfinished_ > 0; }  // true until all results are taken
    std::vector<Result> take_results();

  private:
    std::function<void()> wake_;
    std::size_t unfinished_ = 0;
    std::mutex mutex_;
    std::vector<Result> results_;
    std::vector<std::future<void>> running_;  // the destructor waits for them
};

}  // namespace lamina::view
