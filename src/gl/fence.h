// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::gl {

// A point in the stream of commands that can be waited for.
class Fence {
  public:
    Fence() = default;
    ~Fence();
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;

    void set();   // here
    void wait();  // until all commands before it are complete; returns at once where it was not set

  private:
    void* sync_ = nullptr;
};

}  // namespace lamina::gl
