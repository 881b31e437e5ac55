// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "bindings.h"
#include "drawn.h"

namespace lamina::python {

// A session for the threads of a Python program: its calls take turns. Call without the GIL, which
// another thread may need to end its turn.
class SharedSession {
  public:
    template <typename... Data>
    SharedSession(const Scene& scene, const SessionOptions& options, const Data&... data)
        : session_(scene, data..., options) {}

    Drawn draw(std::stop_token stop, const ProgressCallback& progress);
    Drawn trace(std::stop_token stop, const ProgressCallback& progress);
    Scene resolved_scene();
    std::string explanation();

    template <typename Work>
    auto change(const Work& work) {
        const std::lock_guard turn(turn_);
        return work(session_);
    }

  private:
    // The memory of the last picture where nobody else has it, else new one.
    std::shared_ptr<Image> free_picture();

    std::mutex turn_;
    Session session_;
    std::shared_ptr<Image> picture_;
};

}  // namespace lamina::python
