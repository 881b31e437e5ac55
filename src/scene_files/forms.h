// SPDX-License-Identifier: Apache-2.0
// Forms of values under a key (scene_files/keys.h).
#pragma once

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/enum_words.h"
#include "lamina/auto.h"
#include "scene_files/keys.h"

namespace lamina {

Form<bool> flag_form();
Form<std::string> text_form();            // empty: left out
Form<std::filesystem::path> path_form();  // relative to the file; empty: left out
Form<glm::dvec3> vector_form();           // three finite numbers
Form<glm::dvec3> color_form();            // of the reader's colour space
Form<std::array<std::int64_t, 3>> sizes_form(std::int64_t most, const std::string& expected);

// The parts of the schema that several keys share ("$defs").
KeyJson vector_schema();
KeyJson color_schema();
KeyJson reference_to(const std::string& definition);

// A form whose values must pass `is_good`, or messages say what is expected.
template <typename T, typename Check>
Form<T> checked(Form<T> form, const Check& is_good, const std::string& expected) {
    form.read = [read = form.read, is_good, expected](JsonReader& reader, const std::string& key) {
        T value = read(reader, key);
        if (!is_good(value)) reader.reject(key, expected);
        return value;
    };
    return form;
}

// Limits of a number, as the schema has them.
struct Limits {
    std::optional<double> from = {}, above = {}, up_to = {}, below = {};

    bool contain(double number) const {
        return !(from && !(number >= *from)) && !(above && !(number > *above)) &&
               !(up_to && !(number <= *up_to)) && !(below && !(number < *below));
    }
};
// A number within limits, with what messages expect; without that text a rule of the table checks
// it.
Form<double> number_form(const Limits& limits = {}, const std::string& expected = "");

template <typename Whole>
Form<Whole> whole_form(std::int64_t least, std::int64_t most) {
    return {[least, most](JsonReader& reader, const std::string& key) {
                return static_cast<Whole>(reader.whole(key, least, most));
            },
            [](const Whole& value) { return KeyJson(value); },
            {{"type", "integer"}, {"minimum", least}, {"maximum", most}}};
}
Form<std::uint32_t> seed_form();

// One of these words. The first one must be the default.
template <typename Value>
Form<Value> words_form(const std::vector<std::pair<const char*, Value>>& words) {
    KeyJson listed = KeyJson::array();
    for (const auto& [word, value] : words) listed.push_back(word);
    return {[words](JsonReader& reader, const std::string& key) {
                return reader.choice<Value>(key, words);
            },
            [words](const Value& wanted) {
                for (const auto& [word, value] : words)
                    if (value == wanted) return KeyJson(word);
                return KeyJson();
            },
            {{"enum", std::move(listed)}}};
}
template <typename Enum>
Form<Enum> words_form() {
    return words_form<Enum>(enum_words<Enum>());
}

// A value that may be left out.
template <typename T>
Form<std::optional<T>> optional_form(const Form<T>& form) {
    return {[read = form.read](JsonReader& reader, const std::string& key) {
                return std::optional<T>(read(reader, key));
            },
            [write = form.write](const std::optional<T>& value) {
                return value ? write(*value) : KeyJson();
            },
            form.schema};
}

// A value of JSON's type `type`, or a word in its place. `expected`: for values of neither kind.
template <typename T>
Form<std::optional<T>> word_or_form(const std::string& word, const Form<T>& form,
                                    bool (nlohmann::json::*is_type)() const noexcept,
                                    const std::string& expected) {
    return {[=, read = form.read](JsonReader& reader, const std::string& key) -> std::optional<T> {
                const nlohmann::json& value = reader.value(key);
                if (value == word) return std::nullopt;
                if (!(value.*is_type)()) reader.reject(key, expected);
                return read(reader, key);
            },
            [word, write = form.write](const std::optional<T>& value) {
                return value ? write(*value) : KeyJson(word);
            },
            {{"oneOf", KeyJson::array({{{"const", word}}, form.schema})}}};
}

// A form in which "auto" stands for no value.
template <typename T>
Form<Auto<T>> automatic_if_none(const Form<std::optional<T>>& form) {
    return {[read = form.read](JsonReader& reader, const std::string& key) {
                const std::optional<T> value = read(reader, key);
                return value ? Auto<T>(*value) : Auto<T>(automatic);
            },
            [write = form.write](const Auto<T>& value) {
                return write(value.is_given() ? std::optional<T>(*value) : std::nullopt);
            },
            form.schema};
}
// "auto", or a value of JSON's type `type`.
template <typename T>
Form<Auto<T>> automatic_form(const Form<T>& form, bool (nlohmann::json::*is_type)() const noexcept,
                             const std::string& expected) {
    return automatic_if_none(word_or_form("auto", form, is_type, expected));
}
// "auto", or one of an enum's words. `initial`: the key's default.
template <typename Enum>
Form<Auto<Enum>> automatic_words_form(const Auto<Enum>& initial) {
    std::vector<std::pair<const char*, std::optional<Enum>>> words;
    for (const auto& [word, value] : enum_words<Enum>()) words.emplace_back(word, value);
    words.insert(initial.is_automatic() ? words.begin() : words.end(), {"auto", std::nullopt});
    return automatic_if_none(words_form<std::optional<Enum>>(words));
}

// A list of objects with the keys of a table. `what`: plural, for messages about more than `most`;
// without it a rule of the table checks the count. `extra`: of the schema.
template <typename Struct>
Form<std::vector<Struct>> list_form(const KeyTable<Struct>& (*table)(), std::size_t most,
                                    const std::string& what, const KeyJson& extra) {
    KeyJson schema{{"type", "array"}};
    schema.update(extra);
    schema["items"] = table().schema();
    return {[=](JsonReader& reader, const std::string& key) {
                std::vector<JsonReader> elements = reader.objects(key);
                if (!what.empty() && elements.size() > most) {
                    reader.fail_at(key, fmt::format("found {} {}, expected at most {}",
                                                    elements.size(), what, most));
                }
                std::vector<Struct> list(elements.size());
                for (std::size_t i = 0; i < list.size(); ++i) table().read(elements[i], list[i]);
                return list;
            },
            [table](const std::vector<Struct>& list) {
                if (list.empty()) return KeyJson();
                KeyJson json = KeyJson::array();
                for (const Struct& element : list) json.push_back(table().json(element));
                return json;
            },
            std::move(schema)};
}

}  // namespace lamina
