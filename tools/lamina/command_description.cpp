// SPDX-License-Identifier: Apache-2.0
#include "command_description.h"

#include <algorithm>
#include <sstream>

namespace lamina {
namespace {

// Returns the words of "slice|project|trace". In "NAME|FILE" capitals are placeholders: no list.
std::vector<std::string> choices_of(const std::string& value) {
    if (value.find('|') == std::string::npos) return {};
    std::vector<std::string> choices;
    std::istringstream words(value);
    for (std::string word; std::getline(words, word, '|');) choices.push_back(word);
    const auto placeholder = [](const std::string& word) {
        return std::any_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
    };
    return std::any_of(choices.begin(), choices.end(), placeholder) ? std::vector<std::string>()
                                                                    : choices;
}

std::string value_of(const CLI::Option& option) {
    if (!option.get_option_text().empty()) return option.get_option_text();
    return option.get_type_size() != 0 ? option.get_type_name() : "";
}

OptionDescription describe(const CLI::Option& option) {
    OptionDescription result;
    result.text = option.get_description();
    result.group = option.get_group();
    result.positional = option.get_positional();
    if (result.positional) {
        result.names = {option.get_single_name()};
    } else {
        for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
    }
    result.optional_value = option.get_expected_min() == 0 && !option.get_fnames().empty();
    result.value = result.optional_value ? "NAME" : value_of(option);
    result.choices = choices_of(result.value);
    return result;
}

}  // namespace

CommandDescription describe(const CLI::App& app) {
    CommandDescription result;
    const CLI::App* const parent = app.get_parent();
    result.name = (parent != nullptr ? parent->get_name() + " " : "") + app.get_name();
    result.text = app.get_description();
    result.footer = app.get_footer();
    for (const CLI::Option* const option : app.get_options())
        result.options.push_back(describe(*option));
    for (const CLI::App* const verb : app.get_subcommands([](const CLI::App*) { return true; }))
        result.verbs.push_back(describe(*verb));
    return result;
}

}  // namespace lamina
