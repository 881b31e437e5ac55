// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace lamina::view {

// Input fields, as wide as SetNextItemWidth() says. They return true, and change the value, once
// Enter, Tab or a click elsewhere ends the input.
bool typed_number(const char* id, double& number);
bool typed_text(const char* id, const char* hint, std::string& text);

// Asks for the name of a file, in a window above all others.
class PathPrompt {
  public:
    // Called with the name. Returns why it is refused, after which it is asked for again, or an
    // empty text.
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
