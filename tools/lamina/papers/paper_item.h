// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina::papers {

// One table or figure of a paper: `reproduce`, or `draw` if it needs a context. Either writes its
// CSV and plots, which are among `files`, into the existing `folder` and returns {values, paper,
// verdict, note, ...} (see Findings::result). If there are panels (Panels) or plots, `values` has
// them and a `caption`. Errors are in units of 1/255. A `Stage`, made from the capabilities of the
// current context, holds data that several items share.
template <typename Stage>
struct PaperItem {
    std::string name;
    std::vector<std::string> files;
    nlohmann::ordered_json (*reproduce)(const std::filesystem::path& folder) = nullptr;
    nlohmann::ordered_json (*draw)(const std::filesystem::path& folder, Stage& stage) = nullptr;
};

// The verdict on a statement of a paper.
enum class Verdict {
    agrees,
    disagrees,
    // The statement needs data or machines that are not available: volumes and meshes that are
    // lost, graphics cards of 2004. Stand-ins replace them here.
    untestable
};

// Returns "agrees", "disagrees" or "cannot be tested here".
const char* name_of(Verdict verdict);

// The statements of a paper about one table or figure, each compared with measurements.
class Findings {
  public:
    // `says`: a sentence or a row of the paper, word for word; [...] marks an omission. `holds`:
    // true if the measurements support it. `measured`: these measurements in words and numbers.
    void add(std::string says, bool holds, std::string measured);

    // Adds a statement that cannot be tested here. `holds`: true if the stand-in nevertheless
    // behaves as the statement says.
    void add_untestable(std::string says, bool holds, std::string measured);

    // Adds a claim about lamina that the paper does not make. It does not affect the verdict.
    void add_own(std::string claim, bool holds, std::string measured);

    // Makes all statements of the paper untestable, because data are missing.
    void make_untestable();

    // Returns "disagrees" if a statement disagrees; else "agrees" if at least one agrees.
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
    // `in_full`: with measurements.
    std::string note(bool in_full) const;
    std::string note_on_claims(bool in_full) const;

    std::vector<Statement> statements_;
    std::vector<Claim> claims_;
};

// Returns a line that counts the verdicts on the items of a report, {item: result of Findings,
// ...}, and those on the paper's statements.
std::string count_verdicts(const nlohmann::ordered_json& report);

// The pictures of a table or figure with their labels, for the paper's page. An item puts them
// under a key "panels" anywhere in its result.
class Panels {
  public:
    // Adds a picture to a group; the group's name may be empty.
    void add(const std::string& group, const std::string& label, const CodedImage& picture);
    void add(const std::string& group, const std::string& label, const Image& picture);  // on black
    // Adds a difference in false colour, whose scale ends at `scale` (in 1/255), with a colour bar.
    // `picture`: the difference as shown.
    void add_difference(const std::string& group, const std::string& label, const Difference& e,
                        double scale, const CodedImage& picture);

    // Returns [{group, title, caption, image, width, height, scale and largest of differences},
    // ...].
    const nlohmann::ordered_json& json() const { return panels_; }

  private:
    nlohmann::ordered_json panels_ = nlohmann::ordered_json::array();
};

// Removes all keys "panels" from a result, at any depth, and returns their contents as one list.
nlohmann::ordered_json take_panels(nlohmann::ordered_json& result);

// Returns the section of the page (share/report) about one item: its checks against the paper, its
// claims, its panels, the plots (.svg) among its files in `folder`, with the `caption` of its
// values, and its table. `result` has no panels. Links to `item` lead to the section.
nlohmann::ordered_json page_section(const std::string& item, const nlohmann::ordered_json& result,
                                    nlohmann::ordered_json panels,
                                    const std::filesystem::path& folder);

}  // namespace lamina::papers
