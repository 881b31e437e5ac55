// SPDX-License-Identifier: Apache-2.0
#include "script.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include "lamina/error.h"

namespace lamina::view {
namespace {

struct Usage {
    std::size_t least, most;  // words that follow
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

}  // namespace lamina::view
