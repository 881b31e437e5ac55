// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::gl {

// A point in the stream of OpenGL commands that the program can wait for.
class Fence {
  public:
    Fence() = default;
    ~Fence();
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;

    void set();  // places the fence at the current point
    // Waits until all commands before it are complete; returns at once where it was not set.
    void wait();

  private:
    void* sync_ = nullptr;
};

}  // namespace lamina::gl
