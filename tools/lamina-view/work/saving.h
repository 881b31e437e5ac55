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

// Returns true if a file of this name can be saved: .json (the scene), .exr, .png, .npy (the
// picture).
bool can_save(const std::filesystem::path& file);

// Writes files of the picture that is shown, each in a thread of its own, so that the window does
// not wait.
class Saving {
  public:
    struct Result {
        std::filesystem::path file;
        std::string failure;  // empty: it is written
    };

    // `wake` is called when a result is there.
    explicit Saving(std::function<void()> wake) : wake_(std::move(wake)) {}
    // The resolved scene, or the full picture, whatever is on the screen.
    void save(const std::filesystem::path& file, std::shared_ptr<const Shown> shown);
    bool busy() const { return unfinished_ > 0; }  // until its result is taken
    std::vector<Result> take_results();

  private:
    std::function<void()> wake_;
    std::size_t unfinished_ = 0;
    std::mutex mutex_;
    std::vector<Result> results_;
    std::vector<std::future<void>> running_;  // waits for them when it ends
};

}  // namespace lamina::view
