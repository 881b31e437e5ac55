// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace lamina::view {

// Asks for the name of a file, over everything else.
class PathPrompt {
  public:
    // `take` gets the name and returns what is wrong with it, for which it is asked for again, or
    // an empty text.
    using Take = std::function<std::string(const std::string&)>;
    void ask(std::string title, std::string path, Take take);
    void draw();  // once a frame
    bool open() const { return open_; }

  private:
    std::string title_, path_, wrong_;
    Take take_;
    bool open_ = false, first_frame_ = false;
};

}  // namespace lamina::view
