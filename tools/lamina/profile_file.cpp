// SPDX-License-Identifier: Apache-2.0
#include "profile_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_text.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr int process = 1;

Json metadata(const char* name, int row, const char* key, const Json& value) {
    return {{"name", name}, {"ph", "M"}, {"pid", process}, {"tid", row}, {"args", {{key, value}}}};
}

std::string name_of_row(int row) {
    if (row == Profile::opengl_row) return "OpenGL";
    if (row == Profile::first_row) return "main thread";
    return fmt::format("worker {}", row - Profile::first_row);
}

double microseconds(std::int64_t nanoseconds) {
    return 1e-3 * static_cast<double>(nanoseconds);
}

Json counts_of(const Profile::Span& span) {
    Json counts = Json::object();
    for (const Profile::Count& count : span.counts) {
        if (count.name != nullptr) counts[count.name] = count.value;
    }
    return counts;
}

Json event(const Profile::Span& span, std::int64_t start_ns) {
    return {{"name", span.name},
            {"ph", "X"},
            {"pid", process},
            {"tid", span.row},
            {"ts", microseconds(span.begin_ns - start_ns)},
            {"dur", microseconds(span.end_ns - span.begin_ns)},
            {"args", counts_of(span)}};
}

}  // namespace

std::int64_t ProfileFile::write(const std::string& title, const std::string& context) {
    Json other{{"context", context}};
    if (profile_.spans_left_out() > 0) other["spans_left_out"] = profile_.spans_left_out();
    file_->write("{\"displayTimeUnit\":\"ms\",\"otherData\":" + json_text(other) +
                 ",\"traceEvents\":[\n");
    // Events are written one after the other: a document of all would take twenty times the memory
    // of the spans.
    file_->write(json_text(metadata("process_name", Profile::first_row, "name", title)));
    const auto write_event = [&](const Json& event) { file_->write(",\n" + json_text(event)); };
    const auto has_spans = [&](int row) {
        return std::ranges::any_of(profile_.spans(),
                                   [&](const Profile::Span& span) { return span.row == row; });
    };
    for (int row = 0; row < profile_.row_count(); ++row) {
        if (!has_spans(row)) continue;
        write_event(metadata("thread_name", row, "name", name_of_row(row)));
        // The row of OpenGL comes below those of the host.
        const int place = row == Profile::opengl_row ? profile_.row_count() : row;
        write_event(metadata("thread_sort_index", row, "sort_index", place));
    }
    for (const Profile::Span& span : profile_.spans()) write_event(event(span, start_ns_));
    file_->write("\n]}\n");
    file_->commit();
    return profile_.spans_left_out();
}

}  // namespace lamina
