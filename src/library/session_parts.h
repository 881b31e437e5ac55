// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task_arena.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/client.h"
#include "choice/value_distribution.h"
#include "lamina/session.h"
#include "render/pipeline.h"

namespace lamina {

// Throws Error if there is no such view: scene files are checked for that when they are read.
void check_view(const Camera& camera, int width, int height);

// A session: the pipeline of its scene with a client's own settings, such as threads, a folder that
// it may read, and its warnings.
struct Session::Parts {
    Parts(Scene scene, const SessionOptions& options);
    ~Parts();

    // Calls work() for the session's client: in its threads, with its warnings kept.
    template <typename Work>
    void run(const Work& work, std::stop_token stop = {}, const ProgressCallback& progress = {}) {
        const WarningTaker taker = [this](const std::string& text) { keep_warning(text); };
        ProgressListener listener{progress};
        threads.execute([&] {
            const ClientScope scope({std::move(stop), &taker, &listener, only_below});
            work();
        });
    }

    void keep_warning(const std::string& text);
    ValueHistogram histogram(int bins);

    std::shared_ptr<const std::filesystem::path> only_below;
    tbb::task_arena threads;
    std::mutex keeping;
    std::vector<std::string> warnings;
    std::unique_ptr<Pipeline> pipeline;
    // the data of the last histogram
    std::weak_ptr<const void> counted;
    ValueDistribution counts;
    Image picture;
    FrameStatistics statistics, trace_statistics;
};

}  // namespace lamina
