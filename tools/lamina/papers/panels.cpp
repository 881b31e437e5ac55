// SPDX-License-Identifier: Apache-2.0
#include "papers/panels.h"

#include <algorithm>
#include <cmath>

#include "base/file_bytes.h"
#include "study/thumbnail.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

Json panel(const std::string& group, const std::string& label, const std::string& image) {
    return {{"group", group}, {"title", label}, {"caption", ""}, {"image", image}};
}

// The rows of a table; of curves, their errors.
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

void Panels::add(const std::string& group, const std::string& label, const CodedImage& picture) {
    panels_.push_back(panel(group, label, study::data_uri(picture)));
    // The page reserves the place of a picture before it is decoded, so that links do not miss.
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
    // An item that was skipped has no values.
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
