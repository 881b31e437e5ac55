// SPDX-License-Identifier: Apache-2.0
#include "study/report_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "image/coded_image.h"
#include "image/png.h"

namespace lamina::study {
namespace {

bool is_number(const std::string& cell) {
    double number = 0;
    const char* const end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, number);
    return stop == end && error != std::errc::invalid_argument;
}

// Tells whether a spreadsheet would evaluate the cell as a formula, which may even start programs.
// An apostrophe in front makes it text.
bool is_formula(const std::string& cell) {
    return !cell.empty() && std::string_view("=+-@\t\r").find(cell[0]) != std::string::npos &&
           !is_number(cell);
}

// Returns a cell of CSV. RFC 4180: a cell with a comma, a quote or a line end is put in quotes.
std::string quoted(const std::string& cell) {
    if (is_formula(cell)) return quoted("'" + cell);
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string text = "\"";
    for (const char c : cell) {
        if (c == '"') text += '"';
        text += c;
    }
    return text + '"';
}

std::string base64(const std::string& bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j)
            group =
                group << 8 | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[group >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

// Calls visit(column, row) for the pixels of a square of step x step pixels that are in the
// picture.
template <typename Visit>
void for_each_in_square(int column, int row, int step, int width, int height, const Visit& visit) {
    for (int y = row * step; y < std::min((row + 1) * step, height); ++y) {
        for (int x = column * step; x < std::min((column + 1) * step, width); ++x) visit(x, y);
    }
}

int squares(int pixels, int step) {
    return (pixels + step - 1) / step;
}

using Json = nlohmann::ordered_json;

// Replaces control characters in all strings and keys by visible text.
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

// Returns the JSON of the report for a <script> element. "<" occurs only within strings, and is
// escaped there, so that no text can end the element or begin a comment.
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

void write_text(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

CsvTable::CsvTable(const std::vector<std::string>& columns) : columns_(columns.size()) {
    add_row(columns);
}

void CsvTable::add_row(const std::vector<std::string>& cells) {
    assert(cells.size() == columns_);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) text_ += ',';
        text_ += quoted(cells[i]);
    }
    text_ += '\n';
}

nlohmann::ordered_json to_json(const ErrorNorms& norms) {
    return {{"linf", norms.linf}, {"l1", norms.mean}, {"l2", norms.l2}};
}

nlohmann::ordered_json to_json(const ImageError& error) {
    nlohmann::ordered_json channels;
    for (std::size_t i = 0; i < error.channels.size(); ++i)
        channels[error.channels[i]] = to_json(error.of_channel[i]);
    return {{"channels", channels}, {"all", to_json(error.all)}};
}

CodedImage shown(const Image& image, ImageColorSpace space) {
    CodedImage coded(image.width, image.height, 3, 8);
    for (std::size_t i = 0; i < coded.codes.size(); ++i)
        coded.codes[i] = display_code(static_cast<double>(image.rgba[i / 3 * 4 + i % 3]), space);
    return coded;
}

int reduction(int width, int height, int largest) {
    return squares(std::max(width, height), largest);
}

Image reduced(const Image& image, int step) {
    Image small(squares(image.width, step), squares(image.height, step));
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            double sum[4] = {}, count = 0;
            for_each_in_square(column, row, step, image.width, image.height, [&](int x, int y) {
                for (int i = 0; i < 4; ++i) sum[i] += static_cast<double>(image.pixel(x, y)[i]);
                ++count;
            });
            for (int i = 0; i < 4; ++i)
                small.pixel(column, row)[i] = static_cast<float>(sum[i] / count);
        }
    }
    return small;
}

Difference reduced(const Difference& difference, int step) {
    const std::size_t channels = difference.channels.size();
    Difference small{
        squares(difference.width, step), squares(difference.height, step), difference.channels, {}};
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            const double* worst = nullptr;
            double largest = -1;
            for_each_in_square(
                column, row, step, difference.width, difference.height, [&](int x, int y) {
                    const auto pixel =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(difference.width) +
                        static_cast<std::size_t>(x);
                    const double* const e = &difference.e[channels * pixel];
                    for (std::size_t i = 0; i < channels; ++i) {
                        if (std::abs(e[i]) <= largest) continue;
                        largest = std::abs(e[i]);
                        worst = e;
                    }
                });
            small.e.insert(small.e.end(), worst, worst + channels);
        }
    }
    return small;
}

std::string data_uri(const CodedImage& image) {
    return data_uri("image/png", encode_png(image));
}

std::string data_uri(const std::string& type, const std::string& bytes) {
    return "data:" + type + ";base64," + base64(bytes);
}

std::string escaped_markup(const std::string& text) {
    std::string markup;
    for (const char c : text) {
        if (c == '&')
            markup += "&amp;";
        else if (c == '<')
            markup += "&lt;";
        else if (c == '>')
            markup += "&gt;";
        else
            markup += c;
    }
    return markup;
}

std::string report_page(const Json& given) {
    // JSON text and back replaces bytes that are not UTF-8.
    const Json report = printable_json(Json::parse(json_text(given)));
    std::string page;
    std::string_view rest = file_named("page.html");
    // Inserted text is not searched: it may contain "{{".
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
