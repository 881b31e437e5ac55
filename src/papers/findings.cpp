// SPDX-License-Identifier: Apache-2.0
#include "papers/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lamina::papers {

using Json = nlohmann::ordered_json;

void Findings::add(std::string says, bool holds, std::string measured) {
    findings_.push_back({std::move(says), holds, std::move(measured)});
}

bool Findings::agree() const {
    return std::all_of(findings_.begin(), findings_.end(),
                       [](const Finding& f) { return f.holds; });
}

std::string Findings::note() const {
    if (agree()) {
        return findings_.size() == 1
                   ? "Agrees."
                   : fmt::format("Agrees: all {} statements hold.", findings_.size());
    }
    std::string text;
    for (const Finding& finding : findings_) {
        if (finding.holds) continue;
        text += fmt::format("{} \"{}\": {}.", text.empty() ? "Disagrees:" : "", finding.says,
                            finding.measured);
    }
    return text;
}

Json Findings::result(Json values, Json printed, const std::string& more) const {
    Json result;
    result["values"] = std::move(values);
    result["paper"] = Json::object();
    if (!printed.is_null()) result["paper"]["printed"] = std::move(printed);
    result["paper"]["says"] = Json::array();
    result["agrees"] = agree();
    result["note"] = note() + (more.empty() ? "" : " " + more);
    result["checks"] = Json::array();
    for (const Finding& finding : findings_) {
        result["paper"]["says"].push_back(finding.says);
        result["checks"].push_back(
            {{"says", finding.says}, {"holds", finding.holds}, {"measured", finding.measured}});
    }
    return result;
}

}  // namespace lamina::papers
