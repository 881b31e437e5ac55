// SPDX-License-Identifier: Apache-2.0
#include "script_player.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "lamina/error.h"
#include "viewer.h"
#include "window.h"

namespace lamina::view {
namespace {

struct Usage {
    std::size_t least, most;  // words after the command
    const char* text;
};

const std::map<std::string, Usage> usages = {
    {"click", {2, 4, "click X Y [shift] [control]"}},
    {"doubleclick", {2, 2, "doubleclick X Y"}},
    {"drag", {5, 8, "drag left|right|middle X Y TO_X TO_Y [STEPS [MS]] [shift]"}},
    {"key", {1, 3, "key NAME [shift] [control]"}},
    {"measure", {1, 1, "measure start|NAME"}},
    {"move", {2, 2, "move X Y"}},
    {"open", {1, 1, "open FILE"}},
    {"press", {1, 2, "press left|right|middle [shift]"}},
    {"quit", {0, 0, "quit"}},
    {"release", {1, 1, "release left|right|middle"}},
    {"save", {1, 1, "save FILE"}},
    {"screenshot", {1, 1, "screenshot FILE.png"}},
    {"set", {2, 2, "set coarse|trace|panels on|off"}},
    {"size", {2, 2, "size WIDTH HEIGHT"}},
    {"type", {1, 1000, "type TEXT"}},
    {"wait", {1, 2, "wait full|saved|truth|MS, or wait file FILE"}},
    {"wheel", {1, 1, "wheel STEPS"}}};

const std::map<std::string, int> keys = {{"Backspace", GLFW_KEY_BACKSPACE},
                                         {"Delete", GLFW_KEY_DELETE},
                                         {"Down", GLFW_KEY_DOWN},
                                         {"End", GLFW_KEY_END},
                                         {"Enter", GLFW_KEY_ENTER},
                                         {"Escape", GLFW_KEY_ESCAPE},
                                         {"F1", GLFW_KEY_F1},
                                         {"Home", GLFW_KEY_HOME},
                                         {"Left", GLFW_KEY_LEFT},
                                         {"Right", GLFW_KEY_RIGHT},
                                         {"Space", GLFW_KEY_SPACE},
                                         {"Tab", GLFW_KEY_TAB},
                                         {"Up", GLFW_KEY_UP}};

PointerButton button_of(const ScriptCommand& command) {
    const std::string& name = command.words[0];
    if (name == "left") return PointerButton::left;
    if (name == "right") return PointerButton::right;
    if (name == "middle") return PointerButton::middle;
    command.fail("left, right or middle");
}

bool has(const ScriptCommand& command, const char* word) {
    return std::ranges::find(command.words, word) != command.words.end();
}

bool on(const ScriptCommand& command) {
    const std::string& word = command.words[1];
    if (word != "on" && word != "off") command.fail("on or off");
    return word == "on";
}

}  // namespace

void ScriptCommand::fail(const std::string& expected) const {
    std::string found = name;
    for (const std::string& word : words) found += " " + word;
    throw Error(fmt::format("{}: found \"{}\", expected {}", where, found, expected));
}

double ScriptCommand::number(std::size_t word) const {
    const std::string& text = words.at(word);
    double number = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc() || end != text.data() + text.size())
        fail(fmt::format("a number instead of \"{}\"", text));
    return number;
}

std::vector<ScriptCommand> load_script(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw Error(fmt::format("{}: cannot be read", file.string()));
    std::vector<ScriptCommand> commands;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        ScriptCommand command{fmt::format("{}:{}", file.string(), ++number), {}, {}};
        if (!(words >> command.name) || command.name.starts_with('#')) continue;
        for (std::string word; words >> word;) command.words.push_back(word);
        const auto usage = usages.find(command.name);
        if (usage == usages.end()) {
            std::string names;
            for (const auto& [name, known] : usages) names += (names.empty() ? "" : ", ") + name;
            command.fail("one of " + names);
        }
        const std::size_t count = command.words.size();
        if (count < usage->second.least || count > usage->second.most)
            command.fail(usage->second.text);
        commands.push_back(std::move(command));
    }
    return commands;
}

int key_of(const ScriptCommand& command, const std::string& name) {
    const bool letter = name.size() == 1 &&
                        ((name[0] >= 'A' && name[0] <= 'Z') || (name[0] >= '0' && name[0] <= '9'));
    if (letter) return name[0];
    const auto known = keys.find(name);
    if (known != keys.end()) return known->second;
    std::string names = "A to Z, 0 to 9";
    for (const auto& [key, number] : keys) names += ", " + key;
    command.fail("a key: " + names);
}

ScriptPlayer::ScriptPlayer(std::vector<ScriptCommand> commands, Window& window, Viewer& viewer)
    : commands_(std::move(commands)), window_(window), viewer_(viewer) {}

void ScriptPlayer::advance(double seconds) {
    if (waiting_) {
        looked_ = true;
        if (!waiting_(seconds)) return;
        looked_ = false;
        waiting_ = nullptr;
    }
    if (actions_.empty() && next_ < commands_.size()) begin(commands_[next_++], seconds);
    if (actions_.empty()) return;
    const auto action = std::move(actions_.front());
    actions_.pop_front();
    action();
}

std::optional<double> ScriptPlayer::next(double seconds) const {
    if (waiting_ && looked_) return until_ > 0 ? std::optional(until_) : std::nullopt;
    return seconds;
}

void ScriptPlayer::begin(const ScriptCommand& command, double seconds) {
    const std::string& name = command.name;
    if (name == "wait") return begin_wait(command, seconds);
    if (name == "drag") return begin_drag(command);
    if (name == "measure") return measure(command);
    if (name == "set") return set(command);
    if (name == "quit") return then([this] { window_.close(); });
    if (name == "open") return then([&] { viewer_.open(command.words[0]); });
    if (name == "screenshot") return then([&] { window_.take_screenshot(command.words[0]); });
    if (name == "save") {
        const std::string wrong = viewer_.save(command.words[0]);
        if (!wrong.empty()) command.fail(wrong);
        return;
    }
    if (name == "size") {
        const int width = static_cast<int>(command.number(0));
        const int height = static_cast<int>(command.number(1));
        return then([=, this] { window_.set_size(width, height); });
    }
    if (name == "key") {
        const int key = key_of(command, command.words[0]);
        const bool shift = has(command, "shift"), control = has(command, "control");
        then([=, this] { window_.key(key, true, shift, control); });
        return then([=, this] { window_.key(key, false, shift, control); });
    }
    if (name == "type") {
        std::string text = command.words[0];
        for (std::size_t i = 1; i < command.words.size(); ++i) text += " " + command.words[i];
        for (const char character : text)
            then([=, this] { window_.character(static_cast<unsigned char>(character)); });
        return;
    }
    begin_pointer(command);
}

void ScriptPlayer::begin_pointer(const ScriptCommand& command) {
    const std::string& name = command.name;
    if (name == "wheel") {
        const double steps = command.number(0);
        return then([=, this] { window_.wheel({0, steps}); });
    }
    if (name == "press") {
        const bool shift = has(command, "shift");
        const PointerButton button = button_of(command);
        return then([=, this] { window_.button(button, true, shift, false); });
    }
    if (name == "release") {
        const PointerButton button = button_of(command);
        return then([=, this] { window_.button(button, false, false, false); });
    }
    const glm::dvec2 place(command.number(0), command.number(1));
    then([=, this] { window_.move(place); });
    if (name == "move") return;
    const bool shift = has(command, "shift"), control = has(command, "control");
    for (int i = 0; i < (name == "doubleclick" ? 2 : 1); ++i) {
        then([=, this] { window_.button(PointerButton::left, true, shift, control); });
        then([=, this] { window_.button(PointerButton::left, false, shift, control); });
    }
}

void ScriptPlayer::begin_drag(const ScriptCommand& command) {
    const PointerButton button = button_of(command);
    const glm::dvec2 from(command.number(1), command.number(2));
    const glm::dvec2 to(command.number(3), command.number(4));
    const bool shift = has(command, "shift");
    const std::size_t numbers = command.words.size() - (shift ? 1 : 0);
    const int steps = numbers > 5 ? std::max(1, static_cast<int>(command.number(5))) : 10;
    const double pause = numbers > 6 ? command.number(6) / 1000 : 0;
    then([=, this] { window_.move(from); });
    then([=, this] { window_.button(button, true, shift, false); });
    for (int i = 1; i <= steps; ++i) {
        then([=, this] { window_.move(from + (static_cast<double>(i) / steps) * (to - from)); });
        if (pause > 0)
            then([=, this] {
                until_ = glfwGetTime() + pause;
                waiting_ = [this](double seconds) { return seconds >= until_; };
            });
    }
    then([=, this] { window_.button(button, false, shift, false); });
}

// Begins to wait. An error in the window ends the wait with Error.
void ScriptPlayer::begin_wait(const ScriptCommand& command, double seconds) {
    const std::string& what = command.words[0];
    until_ = 0;
    const auto until = [&](auto reached) {
        waiting_ = [this, where = command.where, reached](double) {
            if (viewer_.is_failed()) throw Error(fmt::format("{}: {}", where, viewer_.failure()));
            return reached();
        };
    };
    if (what == "full") return until([this] { return viewer_.is_full(); });
    if (what == "truth") return until([this] { return viewer_.is_truth(); });
    if (what == "saved") return until([this] { return !viewer_.is_saving(); });
    if (what == "file") {  // looked for every .05 s
        if (command.words.size() != 2) command.fail("wait file FILE");
        waiting_ = [this, file = command.words[1]](double now) {
            until_ = now + .05;
            return std::filesystem::exists(file);
        };
        return;
    }
    until_ = seconds + command.number(0) / 1000;
    waiting_ = [this](double now) { return now >= until_; };
}

void ScriptPlayer::measure(const ScriptCommand& command) {
    if (command.words[0] == "start") return measurements_.start();
    fmt::print("{}\n", measurements_.text(command.words[0], viewer_.shown()));
    std::fflush(stdout);
}

void ScriptPlayer::set(const ScriptCommand& command) {
    const std::string& what = command.words[0];
    const bool value = on(command);
    if (what == "coarse")
        viewer_.set_coarse(value);
    else if (what == "trace")
        viewer_.set_trace(value);
    else if (what == "panels")
        viewer_.show_panels(value);
    else
        command.fail("coarse, trace or panels");
}

}  // namespace lamina::view
