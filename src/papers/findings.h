// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::papers {

// What a paper says of one table or figure, statement by statement, each against what was measured.
class Findings {
  public:
    // `says`: the paper's own words. `measured`: what supports `holds`, in words and numbers.
    void add(std::string says, bool holds, std::string measured);

    bool agree() const;

    // {values, paper: {printed, says}, agrees, note, checks: [{says, holds, measured}]}. `agrees`:
    // every statement holds. `note` says so in words, names those that do not, and ends with
    // `more`. `printed`: the numbers that the paper prints; null for none.
    nlohmann::ordered_json result(nlohmann::ordered_json values,
                                  nlohmann::ordered_json printed = nullptr,
                                  const std::string& more = {}) const;

  private:
    struct Finding {
        std::string says;
        bool holds;
        std::string measured;
    };
    std::string note() const;

    std::vector<Finding> findings_;
};

}  // namespace lamina::papers
