// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::papers {

// The answer to a statement of a paper.
enum class Verdict {
    agrees,
    disagrees,
    // The statement is about data or machines of which something else stands in here: volumes and
    // meshes that are not to be had, times of graphics cards of 2004.
    untestable
};

// "agrees", "disagrees" or "cannot be tested here".
const char* name_of(Verdict verdict);

// The statements of a paper about one table or figure, each compared with measurements.
class Findings {
  public:
    // `says`: a sentence or a row of the paper, word for word; [...] marks an omission. `holds`:
    // whether the measurements support it. `measured`: these measurements in words and numbers.
    void add(std::string says, bool holds, std::string measured);

    // Adds a statement that cannot be tested here. `holds`: whether the stand-in behaves like that
    // all the same, which `measured` then says first.
    void add_untestable(std::string says, bool holds, std::string measured);

    // Adds a claim of lamina that the paper does not make. It does not count for the verdict.
    void add_own(std::string claim, bool holds, std::string measured);

    // Makes all statements of the paper untestable, because data are missing.
    void make_untestable();

    // Disagrees if one statement does, agrees if at least one does and none disagrees.
    Verdict verdict() const;

    // Returns {values, paper: {printed, says}, verdict, agrees, in_short, remark, note, checks:
    // [{says, verdict, measured}], own: [{claim, holds, measured}]}. `verdict`: the name of the
    // verdict, or "left open by the paper" if the paper says nothing. `agrees`: true, false, or
    // null for neither. `in_short` says the verdict in words and names the statements and the
    // claims that do not hold; `remark` is `more`; `note` is both, with what was measured.
    // `printed`: the numbers that the paper prints, or null for none.
    nlohmann::ordered_json result(nlohmann::ordered_json values,
                                  nlohmann::ordered_json printed = nullptr,
                                  const std::string& more = {}) const;

  private:
    struct Statement {
        std::string says;
        bool holds;
        bool testable;
        std::string measured;
        Verdict verdict() const;
    };
    struct Claim {
        std::string claim;
        bool holds;
        std::string measured;
    };
    std::ptrdiff_t count(Verdict verdict) const;
    // `in_full`: with what was measured.
    std::string note(bool in_full) const;
    std::string note_on_claims(bool in_full) const;

    std::vector<Statement> statements_;
    std::vector<Claim> claims_;
};

// One line that counts the verdicts on the items of a report, {item: result of Findings, ...}, and
// on the paper's statements about them.
std::string count_verdicts(const nlohmann::ordered_json& report);

}  // namespace lamina::papers
