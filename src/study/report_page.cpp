// SPDX-License-Identifier: Apache-2.0
#include "study/report_page.h"

#include <fmt/format.h>

#include <cassert>
#include <string_view>

#include "base/json_text.h"
#include "base/text.h"
#include "study/report_figures.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// Shows the control characters of all strings and keys.
Json printable_json(const Json& json) {
    if (json.is_string()) return printable(json.get_ref<const std::string&>());
    if (!json.is_structured()) return json;
    Json shown = json.is_array() ? Json::array() : Json::object();
    if (json.is_array()) {
        for (const Json& element : json) shown.push_back(printable_json(element));
    } else {
        for (const auto& [key, value] : json.items()) shown[printable(key)] = printable_json(value);
    }
    return shown;
}

std::string link_to(const std::string& anchor) {
    return fmt::format("<a href=\"#{0}\">{0}</a>: ", escaped_markup(anchor));
}

std::string findings_of(const Json& report) {
    std::string html;
    for (const Json& finding : report.at("findings")) {
        const bool linked = finding.is_object();
        const Json& text = linked ? finding.at("text") : finding;
        html += "<li>" + (linked ? link_to(finding.at("anchor").get<std::string>()) : "") +
                escaped_markup(text.get<std::string>()) + "</li>\n";
    }
    return html;
}

std::string summary_of(const Json& report) {
    if (!report.contains("summary")) return {};
    return "<p id=\"summary\">" + escaped_markup(report["summary"].get<std::string>()) + "</p>\n";
}

// "<" occurs only within strings of the JSON and is escaped there, so that no text can end the
// element or begin a comment.
std::string document_of(const Json& report) {
    std::string json;
    for (const char c : report.dump()) {
        if (c == '<')
            json += "\\u003c";
        else
            json += c;
    }
    return json;
}

std::string_view file_named(std::string_view name) {
    for (const EmbeddedFile& file : embedded_report_files()) {
        if (file.name == name) return file.text;
    }
    assert(!"page.html names a file that is not in share/report");
    return {};
}

}  // namespace

std::string report_page(const Json& given) {
    // The report goes through JSON text and back, so that it is UTF-8.
    const Json report = printable_json(Json::parse(json_text(given)));
    std::string page;
    std::string_view rest = file_named("page.html");
    // Inserted text is not searched, because it may hold "{{" itself.
    for (std::size_t at = rest.find("{{"); at != rest.npos; at = rest.find("{{")) {
        const std::size_t end = rest.find("}}", at);
        assert(end != rest.npos);
        const std::string_view name = rest.substr(at + 2, end - at - 2);
        page += rest.substr(0, at);
        if (name == "title")
            page += escaped_markup(report.at("title").get<std::string>());
        else if (name == "summary")
            page += summary_of(report);
        else if (name == "findings")
            page += findings_of(report);
        else if (name == "report")
            page += document_of(report);
        else
            page += file_named(name);
        rest.remove_prefix(end + 2);
    }
    page += rest;
    return page;
}

}  // namespace lamina::study
