// SPDX-License-Identifier: Apache-2.0
#include "study/report_page.h"

#include <cassert>
#include <string_view>

#include "base/json_text.h"
#include "study/report_files.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// Escapes a text that stands between tags.
std::string html_of(const std::string& text) {
    // The text goes through JSON and back, so that it is UTF-8.
    const std::string valid = Json::parse(json_text(Json(text))).get<std::string>();
    std::string html;
    for (const char c : valid) {
        if (c == '&')
            html += "&amp;";
        else if (c == '<')
            html += "&lt;";
        else if (c == '>')
            html += "&gt;";
        else
            html += c;
    }
    return html;
}

std::string findings_of(const Json& report) {
    std::string html;
    for (const Json& finding : report.at("findings")) {
        html += "<li>" + html_of(finding.get<std::string>()) + "</li>\n";
    }
    return html;
}

// "<" occurs only within strings of the JSON and is escaped there, so that no text can end the
// element or begin a comment.
std::string document_of(const Json& report) {
    std::string json;
    for (const char c : json_text(report)) {
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

std::string report_page(const Json& report) {
    std::string page;
    std::string_view rest = file_named("page.html");
    // Inserted text is not searched, because it may hold "{{" itself.
    for (std::size_t at = rest.find("{{"); at != rest.npos; at = rest.find("{{")) {
        const std::size_t end = rest.find("}}", at);
        assert(end != rest.npos);
        const std::string_view name = rest.substr(at + 2, end - at - 2);
        page += rest.substr(0, at);
        if (name == "title")
            page += html_of(report.at("title").get<std::string>());
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
