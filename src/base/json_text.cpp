// SPDX-License-Identifier: Apache-2.0
#include "base/json_text.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "base/client.h"

namespace lamina {

namespace {

using Json = nlohmann::json;

// An input iterator for the parser that calls check_interrupt(). The parser copies it, so it writes
// how far it has come to a variable outside.
class Cursor {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Cursor(const char* at, const char*& farthest) : at_(at), farthest_(&farthest) {}
    reference operator*() const { return *at_; }
    Cursor& operator++() {
        *farthest_ = ++at_;
        if (reinterpret_cast<std::uintptr_t>(at_) % bytes_between_checks == 0) check_interrupt();
        return *this;
    }
    bool operator==(const Cursor& other) const { return at_ == other.at_; }

  private:
    static constexpr std::uintptr_t bytes_between_checks = 1u << 16;
    const char* at_;
    const char** farthest_;
};

// Builds the document from the parser's events. (nlohmann's own builder, if it has a callback,
// searches a list from its beginning after each object in it, which takes quadratic time.)
class Builder : public nlohmann::json_sax<Json> {
  public:
    explicit Builder(std::string_view text) : text_(text), farthest_(text.data()) {}

    Json build() {
        const char* const end = text_.data() + text_.size();
        Json::sax_parse(Cursor(text_.data(), farthest_), Cursor(end, farthest_), this);
        return std::move(root_);
    }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(Json::number_integer_t value) override { return add(value); }
    bool number_unsigned(Json::number_unsigned_t value) override { return add(value); }
    bool number_float(Json::number_float_t value, const std::string&) override {
        return add(value);
    }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Json::binary_t&) override { return false; }  // JSON has none

    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(std::string& name) override {
        const auto [member, added] = open_.back()->get_ref<Json::object_t&>().try_emplace(name);
        if (!added) stop(fmt::format("the key \"{}\" stands twice in one object", shortened(name)));
        member_ = &member->second;
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const Json::exception& problem) override {
        std::string message = problem.what();  // "[json.exception.parse_error.101] parse error ..."
        message = message.substr(std::min(message.size(), message.find("] ") + 2));
        if (!message.starts_with("parse error at line")) message = place() + ": " + message;
        throw JsonSyntaxError(one_line(shortened(message, most_of_message)));
    }

  private:
    // Bytes of the parser's message that are kept: it contains the last word, which may be long.
    static constexpr std::size_t most_of_message = 200;

    Json& put(Json&& value) {
        if (open_.empty()) return root_ = std::move(value);
        if (open_.back()->is_object()) return *member_ = std::move(value);
        return open_.back()->get_ref<Json::array_t&>().emplace_back(std::move(value));
    }
    bool add(Json value) {
        count();
        put(std::move(value));
        return true;
    }
    bool open(Json value) {
        count();
        if (open_.size() == most_json_depth)
            stop(fmt::format("nested more than {} deep", most_json_depth));
        open_.push_back(&put(std::move(value)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }
    void count() {
        if (++values_ > most_json_values)
            stop(fmt::format("more than {} values, expected fewer", most_json_values));
    }

    [[noreturn]] void stop(const std::string& problem) const { fail("{}: {}", place(), problem); }
    // Returns line and column of the byte that was read last.
    std::string place() const {
        const auto done = static_cast<std::size_t>(farthest_ - text_.data());
        const std::string_view read = text_.substr(0, done);
        const std::size_t line_start = read.rfind('\n') + 1;  // 0 in the first line
        return fmt::format("line {}, column {}", std::count(read.begin(), read.end(), '\n') + 1,
                           done - line_start);
    }

    std::string_view text_;
    const char* farthest_;
    Json root_;
    std::vector<Json*> open_;  // lists and objects that are not closed yet, innermost last
    Json* member_ = nullptr;   // the value of the key that was read last, in the innermost object
    std::size_t values_ = 0;
};

std::string bytes_of(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) fail("no such file");
    if (!std::filesystem::is_regular_file(file, error)) fail("not a file");
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) fail("cannot read: {}", error.message());
    if (bytes > most_json_bytes)
        fail("found {} bytes, expected at most {} in a JSON file", bytes, most_json_bytes);
    std::ifstream stream(file, std::ios::binary);
    std::string text(static_cast<std::size_t>(bytes), '\0');
    if (!stream || !stream.read(text.data(), static_cast<std::streamsize>(text.size())))
        fail("cannot read");
    return text;
}

constexpr int milliseconds_between_checks = 100;

// Waits until something can be read, or the other end is closed.
void wait_for_input() {
    for (;;) {
        check_interrupt();
        pollfd input{STDIN_FILENO, POLLIN, 0};
        const int ready = poll(&input, 1, milliseconds_between_checks);
        if (ready > 0 || (ready < 0 && errno != EINTR)) return;
    }
}

std::string text_of_stdin() {
    std::string text;
    std::array<char, 1 << 16> bytes{};
    for (;;) {
        wait_for_input();
        const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("cannot read: {}", std::strerror(errno));
        if (count == 0) return text;
        text.append(bytes.data(), static_cast<std::size_t>(count));
        if (text.size() > most_json_bytes)
            fail("found more than {} bytes, expected at most as many of JSON", most_json_bytes);
    }
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
    check_interrupt();
    return Builder(text).build();
}

nlohmann::json load_json(const std::filesystem::path& file) {
    std::string text;
    try {
        text = bytes_of(file);
        return parse_json(text);
    } catch (const JsonSyntaxError& problem) {
        const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
        const bool begins = first != text.npos && (text[first] == '{' || text[first] == '[');
        fail("{}: {}{}", file.string(), begins ? "" : "found no JSON: ", problem.what());
    } catch (const Error& problem) {
        fail("{}: {}", file.string(), problem.what());
    }
}

nlohmann::json load_json_from_stdin() {
    try {
        return parse_json(text_of_stdin());
    } catch (const Error& problem) {
        fail("{}: {}", stdin_name, problem.what());
    }
}

}  // namespace lamina
