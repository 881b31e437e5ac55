// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina::papers {

// The pictures of a table or figure, each with its label, for the page of its paper. An item leaves
// them as the key "panels" somewhere in its result.
class Panels {
  public:
    // Pictures of a group stand under its name, which may be empty.
    void add(const std::string& group, const std::string& label, const CodedImage& picture);
    void add(const std::string& group, const std::string& label, const Image& picture);  // on black
    // In false colour, darkest at `scale` (in 1/255), with a colour bar. `framed`: it, as a
    // picture.
    void add_difference(const std::string& group, const std::string& label, const Difference& e,
                        double scale, const CodedImage& picture);

    // [{group, title, caption, image, width, height, scale and largest of differences}, ...]
    const nlohmann::ordered_json& json() const { return panels_; }

  private:
    nlohmann::ordered_json panels_ = nlohmann::ordered_json::array();
};

// Removes all keys "panels" from a result, at any depth, and returns them as one list.
nlohmann::ordered_json take_panels(nlohmann::ordered_json& result);

// The part of the page about one item (share/report): its checks against the paper, its claims, its
// panels and the plots (.svg) of its `files` that are in `folder` with the `caption` of its values,
// and its table. `result` without panels. Links to `item` lead there.
nlohmann::ordered_json page_section(const std::string& item, const nlohmann::ordered_json& result,
                                    nlohmann::ordered_json panels,
                                    const std::filesystem::path& folder);

}  // namespace lamina::papers
