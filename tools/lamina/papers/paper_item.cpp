// SPDX-License-Identifier: Apache-2.0
#include "papers/paper_item.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/enum_words.h"
#include "base/input_file.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* left_open = "left open by the paper";

// Returns "1 statement", "2 statements".
std::string counted(std::ptrdiff_t count, const char* noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// Returns a sentence in quotation marks, without its final full stop, and the measurement, if any.
std::string quoted(std::string says, const std::string& measured) {
    if (says.ends_with('.') && !says.ends_with("..")) says.pop_back();
    return fmt::format("\"{}\"{}{}", says, measured.empty() ? "" : ": ", measured);
}

// Returns "3 agree, 1 disagrees, 2 cannot be tested here", without verdicts that do not occur.
std::string verdicts_text(const std::map<std::string, int>& counts) {
    struct Words {
        const char *verdict, *of_one, *of_more;
    };
    constexpr Words all_words[] = {{"agrees", "agrees", "agree"},
                                   {"disagrees", "disagrees", "disagree"},
                                   {"cannot be tested here", nullptr, nullptr},
                                   {left_open, "is left open by it", "are left open by it"}};
    std::string text;
    for (const auto& [verdict, of_one, of_more] : all_words) {
        const auto found = counts.find(verdict);
        if (found == counts.end()) continue;
        const char* const words = found->second == 1 ? of_one : of_more;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", found->second,
                            words == nullptr ? verdict : words);
    }
    return text;
}

Json panel(const std::string& group, const std::string& label, const std::string& image) {
    return {{"group", group}, {"title", label}, {"caption", ""}, {"image", image}};
}

// Returns the rows of a table or, for curves, their errors.
Json rows_of(const Json& values) {
    if (values.contains("rows")) return values["rows"];
    Json rows = Json::array();
    if (!values.contains("errors")) return rows;
    for (const auto& [name, norms] : values["errors"].items()) {
        rows.push_back({{"curve", name}});
        rows.back().update(norms);
    }
    return rows;
}

}  // namespace

const char* name_of(Verdict verdict) {
    return word_of(verdict, {"agrees", "disagrees", "cannot be tested here"});
}

Verdict Findings::Statement::verdict() const {
    if (!testable) return Verdict::untestable;
    return holds ? Verdict::agrees : Verdict::disagrees;
}

void Findings::add(std::string says, bool holds, std::string measured) {
    statements_.push_back({std::move(says), holds, true, std::move(measured)});
}

void Findings::add_untestable(std::string says, bool holds, std::string measured) {
    statements_.push_back({std::move(says), holds, false, std::move(measured)});
}

void Findings::add_own(std::string claim, bool holds, std::string measured) {
    claims_.push_back({std::move(claim), holds, std::move(measured)});
}

void Findings::make_untestable() {
    for (Statement& statement : statements_) statement.testable = false;
}

std::ptrdiff_t Findings::count(Verdict verdict) const {
    return std::count_if(statements_.begin(), statements_.end(),
                         [&](const Statement& s) { return s.verdict() == verdict; });
}

Verdict Findings::verdict() const {
    if (count(Verdict::disagrees) > 0) return Verdict::disagrees;
    return count(Verdict::agrees) > 0 ? Verdict::agrees : Verdict::untestable;
}

std::string Findings::note_on_claims(bool in_full) const {
    std::string text;
    for (const Claim& claim : claims_) {
        if (claim.holds) continue;
        text += fmt::format(" Ours does not hold, {}.",
                            quoted(claim.claim, in_full ? claim.measured : ""));
    }
    return text;
}

std::string Findings::note(bool in_full) const {
    if (statements_.empty()) return "The paper leaves this open.";
    const auto all = static_cast<std::ptrdiff_t>(statements_.size());
    const std::ptrdiff_t agree = count(Verdict::agrees), untestable = count(Verdict::untestable);
    if (untestable == all) {
        const auto here = std::count_if(statements_.begin(), statements_.end(),
                                        [](const Statement& s) { return s.holds; });
        const std::string shown = all > 1
                                      ? fmt::format("shows {} of {} statements", here, all)
                                      : fmt::format("{} it", here == 1 ? "shows" : "does not show");
        return fmt::format("Cannot be tested here; what stands in {}.", shown);
    }
    if (agree == all)
        return all == 1 ? "Agrees." : fmt::format("Agrees: all {} statements hold.", all);
    if (agree + untestable == all)
        return fmt::format("Agrees: {} of {} hold, the others cannot be tested here.", agree,
                           counted(all, "statement"));
    std::string text = "Disagrees:";
    for (const Statement& statement : statements_) {
        if (statement.verdict() != Verdict::disagrees) continue;
        text += fmt::format(" {}.", quoted(statement.says, in_full ? statement.measured : ""));
    }
    return text;
}

Json Findings::result(Json values, Json printed, const std::string& more) const {
    Json result;
    result["values"] = std::move(values);
    result["paper"] = Json::object();
    if (!printed.is_null()) result["paper"]["printed"] = std::move(printed);
    result["paper"]["says"] = Json::array();
    result["verdict"] = statements_.empty() ? left_open : name_of(verdict());
    const bool tested = !statements_.empty() && verdict() != Verdict::untestable;
    result["agrees"] = tested ? Json(verdict() == Verdict::agrees) : Json();
    result["in_short"] = note(false) + note_on_claims(false);
    result["remark"] = more;
    result["note"] = note(true) + note_on_claims(true) + (more.empty() ? "" : " " + more);
    result["checks"] = Json::array();
    for (const Statement& statement : statements_) {
        const char* const here = statement.testable ? ""
                                 : statement.holds  ? "It holds here: "
                                                    : "It does not hold here: ";
        result["paper"]["says"].push_back(statement.says);
        result["checks"].push_back({{"says", statement.says},
                                    {"verdict", name_of(statement.verdict())},
                                    {"measured", here + statement.measured}});
    }
    result["own"] = Json::array();
    for (const Claim& claim : claims_) {
        result["own"].push_back(
            {{"claim", claim.claim}, {"holds", claim.holds}, {"measured", claim.measured}});
    }
    return result;
}

std::string count_verdicts(const Json& report) {
    std::map<std::string, int> of_items, of_statements;
    std::ptrdiff_t statements = 0;
    for (const Json& result : report) {
        ++of_items[result.at("verdict")];
        for (const Json& check : result.at("checks")) ++of_statements[check.at("verdict")];
        statements += static_cast<std::ptrdiff_t>(result.at("checks").size());
    }
    std::string text = fmt::format("Of {} of the paper, {}.",
                                   counted(static_cast<std::ptrdiff_t>(report.size()), "item"),
                                   verdicts_text(of_items));
    if (statements > 0)
        text += fmt::format(" Of {}, {}.", counted(statements, "statement"),
                            verdicts_text(of_statements));
    return text;
}

void Panels::add(const std::string& group, const std::string& label, const CodedImage& picture) {
    panels_.push_back(panel(group, label, study::data_uri(picture)));
    // With its size, a page reserves the place of a picture before it is decoded, so links lead to
    // the right place.
    panels_.back()["width"] = picture.width;
    panels_.back()["height"] = picture.height;
}

void Panels::add(const std::string& group, const std::string& label, const Image& picture) {
    add(group, label, study::shown(picture));
}

void Panels::add_difference(const std::string& group, const std::string& label, const Difference& e,
                            double scale, const CodedImage& picture) {
    add(group, label, picture);
    double largest = 0;
    for (const double each : e.e) largest = std::max(largest, std::abs(each));
    panels_.back()["scale"] = scale;
    panels_.back()["largest"] = largest;
}

Json take_panels(Json& result) {
    Json panels = Json::array();
    if (result.is_object() && result.contains("panels")) {
        panels = std::move(result["panels"]);
        result.erase("panels");
    }
    if (result.is_structured()) {
        for (Json& part : result) {
            for (Json& each : take_panels(part)) panels.push_back(std::move(each));
        }
    }
    return panels;
}

Json page_section(const std::string& item, const Json& result, Json panels,
                  const std::filesystem::path& folder) {
    // A skipped item has no values.
    const Json& found = result.at("values");
    const Json values = found.is_object() ? found : Json::object();
    for (const Json& file : values.value("files", Json::array())) {
        const std::filesystem::path path = folder / file.get<std::string>();
        if (path.extension() != ".svg") continue;
        panels.push_back(panel("", path.stem().string(),
                               study::data_uri("image/svg+xml", read_file_bytes(path))));
    }
    return {{"scene", item},
            {"anchor", item},
            {"verdict", result.at("verdict")},
            {"note", result.at("remark")},
            {"caption", values.value("caption", "")},
            {"checks", result.at("checks")},
            {"own", result.at("own")},
            {"runs", Json::array()},
            {"pictures", std::move(panels)},
            {"rows", rows_of(values)}};
}

}  // namespace lamina::papers
