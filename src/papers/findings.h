// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::papers {

// The statements of a paper about one table or figure, each compared with measurements.
class Findings {
  public:
    // `says`: the paper's own words. `holds`: whether the measurements support them. `measured`:
    // these measurements in words and numbers.
    void add(std::string says, bool holds, std::string measured);

    bool agree() const;

    // Returns {values, paper: {printed, says}, agrees, note, checks: [{says, holds, measured}]}.
    // `agrees`: whether every statement holds. `note` says so in words, names the statements that
    // do not hold, and ends with `more`. `printed`: the numbers that the paper prints, or null for
    // none.
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
