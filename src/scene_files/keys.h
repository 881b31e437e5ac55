// SPDX-License-Identifier: Apache-2.0
// Tables of the keys of JSON objects, one table for each struct (docs/architecture.md, "Keys"), and
// the forms of the keys' values. Reader, writer and schema of a struct are made from its table.
#pragma once

#include <fmt/format.h>
#include <array>
#include <cassert>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/json_text.h"
#include "lamina/image.h"
#include "lamina/settings.h"

namespace lamina {

// A key of a JSON file, by its path ("render.slice.samples"), is missing, unknown or bad.
class KeyError : public Error {
  public:
    KeyError(std::string path, const std::string& message) : Error(message), key(std::move(path)) {}
    std::string key;
};

// A key that no reader asked for: it is unknown.
class UnknownKeyError : public KeyError {
  public:
    using KeyError::KeyError;
};

// Context on which the meaning of a value depends, beside its own text.
struct JsonContext {
    ImageColorSpace color_space = ImageColorSpace::linear;  // colours are numbers in this space
    bool volume_given = false, mesh_given = false;          // data in memory; no key names them
};

// Reads one JSON object key by key; close() rejects keys that nobody asked for and suggests the
// nearest known one. Every error names file and key, and says what was found and expected.
class JsonReader {
  public:
    // `file`: for messages and relative paths. Object and file must outlive the reader.
    JsonReader(const nlohmann::json& object, const std::filesystem::path& file,
               std::string path = "", const JsonContext& given_context = {});

    JsonContext context;  // readers of inner objects begin with a copy

    bool has(const std::string& key);
    JsonReader object(const std::string& key);  // an empty object if the key is absent
    std::vector<JsonReader> objects(const std::string& key);
    const nlohmann::json& value(const std::string& key);  // throws KeyError if it is missing

    double number(const std::string& key);
    std::int64_t whole(const std::string& key, std::int64_t lo, std::int64_t hi);
    bool flag(const std::string& key);
    std::string text(const std::string& key);
    glm::dvec3 vector(const std::string& key);
    // Returns a path: ${LAMINA_DATA} expands, and relative paths start at the file's folder.
    std::filesystem::path path_of(const std::string& key);

    // Returns the value of one of the listed words, or of the first word if the key is absent.
    template <typename Choice>
    Choice choice(const std::string& key,
                  const std::vector<std::pair<const char*, Choice>>& choices) {
        if (!has(key)) return choices.front().second;
        std::string words;
        for (const auto& [word, chosen] : choices) {
            if (value(key) == word) return chosen;
            words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", word);
        }
        reject(key, "one of " + words);
    }

    void close() const;  // throws UnknownKeyError for a key that nobody asked for
    [[noreturn]] void reject(const std::string& key, const std::string& expected);
    [[noreturn]] void fail_at(const std::string& key, const std::string& message) const;

    const std::filesystem::path& file() const { return file_; }
    // Returns file and path of the object, as messages begin: "scene.json: render.slice".
    std::string place() const;

  private:
    std::string path_to(const std::string& key) const;

    const nlohmann::json& object_;
    const std::filesystem::path& file_;
    std::string path_;
    std::set<std::string> asked_;
};

// Reads a colour (docs/scene.md): three numbers of the reader's colour space, or display values,
// which are converted to it: "#rrggbb", a CSS name, or {"srgb": [r, g, b]}. Throws KeyError.
glm::dvec3 read_color(JsonReader& reader, const std::string& key);

using KeyJson = nlohmann::ordered_json;

// The form of a value of type T under a key: how it is read, written and described in the schema.
template <typename T>
struct Form {
    // Reads the key. Throws KeyError if the key is missing or its value is bad.
    std::function<T(JsonReader& reader, const std::string& key)> read;
    std::function<KeyJson(const T& value)> write;  // returns null to leave the key out
    KeyJson schema;
};

// A key, and how it sets members of Struct.
template <typename Struct>
struct Key {
    std::string name;  // empty: no key, but a check of what was read before
    KeyJson schema;    // with description and default
    bool required = false;
    std::function<void(JsonReader& reader, Struct& object)> read;
    std::function<void(const Struct& object, KeyJson& json)> write;
    // Reads a key that must be given: throws KeyError if it is missing.
    std::function<void(JsonReader& reader, Struct& object)> read_required = {};
};

// One of several forms of a key. `reads`: tells whether a value in a file has this form. `writes`:
// tells whether an object is written in it.
template <typename Struct>
struct Alternative {
    std::function<bool(const nlohmann::json& value)> reads;
    std::function<void(JsonReader& reader, const std::string& key, Struct& object)> read;
    std::function<bool(const Struct& object)> writes;
    std::function<KeyJson(const Struct& object)> write;
    KeyJson schema;
};

// The keys of a struct in their order. If a key is left out, its member keeps its initial value.
template <typename Struct>
class KeyTable {
  public:
    // Adds a key. `access`: a pointer to a member, or a function that returns a reference to one.
    template <typename Access, typename T>
    KeyTable& key(const std::string& name, const Access& access, const Form<T>& form,
                  const std::string& description = "") {
        const Struct initial{};
        Key<Struct> added{name, described(form.schema, description), false, {}, {}};
        if (const KeyJson value = form.write(std::invoke(access, initial)); is_default(value))
            added.schema["default"] = value;
        added.read = [name, access, read = form.read](JsonReader& reader, Struct& object) {
            if (reader.has(name)) std::invoke(access, object) = read(reader, name);
        };
        added.read_required = [name, access, read = form.read](JsonReader& reader, Struct& object) {
            std::invoke(access, object) = read(reader, name);
        };
        added.write = [name, access, write = form.write](const Struct& object, KeyJson& json) {
            KeyJson value = write(std::invoke(access, object));
            if (!value.is_null()) json[name] = std::move(value);
        };
        return add(std::move(added));
    }

    // Adds a key that may have several forms; `expected` says which, for messages.
    KeyTable& variant(const std::string& name, const std::vector<Alternative<Struct>>& alternatives,
                      const std::string& expected, const std::string& description = "") {
        KeyJson forms = KeyJson::array();
        for (const Alternative<Struct>& one : alternatives) forms.push_back(one.schema);
        Key<Struct> added{
            name, described({{"oneOf", std::move(forms)}}, description), false, {}, {}};
        added.read = [name, alternatives, expected](JsonReader& reader, Struct& object) {
            if (!reader.has(name)) return;
            for (const Alternative<Struct>& one : alternatives)
                if (one.reads(reader.value(name))) return one.read(reader, name, object);
            reader.reject(name, expected);
        };
        added.write = [name, alternatives](const Struct& object, KeyJson& json) {
            for (const Alternative<Struct>& one : alternatives) {
                if (!one.writes(object)) continue;
                json[name] = one.write(object);
                return;
            }
        };
        return add(std::move(added));
    }

    // Adds a key whose value is an object with the keys of `table`. The object may be left out;
    // then the rules of its table are checked all the same. It is always written.
    template <typename Access, typename Part>
    KeyTable& object(const std::string& name, const Access& access,
                     const KeyTable<Part>& (*table)(), const std::string& description = "") {
        return add({name, described(table().schema(), description), false,
                    [name, access, table](JsonReader& reader, Struct& object) {
                        JsonReader inner = reader.object(name);
                        table().read(inner, std::invoke(access, object));
                    },
                    [name, access, table](const Struct& object, KeyJson& json) {
                        json[name] = table().json(std::invoke(access, object));
                    }});
    }
    // Adds a key whose value is an object whose keys set members of this struct itself.
    KeyTable& object(const std::string& name, const KeyTable& (*table)(),
                     const std::string& description = "") {
        return object(
            name, [](auto& self) -> auto& { return self; }, table, description);
    }

    KeyTable& add(Key<Struct> key) {
        keys_.push_back(std::move(key));
        return *this;
    }

    Key<Struct>& last() { return keys_.back(); }

    // Change the key added last: require it, set its default in the schema, or remove the default.
    KeyTable& required() {
        Key<Struct>& last = keys_.back();
        last.required = true;
        last.schema.erase("default");
        assert(last.read_required);
        last.read = last.read_required;
        return *this;
    }
    KeyTable& otherwise(KeyJson value) {
        keys_.back().schema["default"] = std::move(value);
        return *this;
    }
    KeyTable& without_default() {
        keys_.back().schema.erase("default");
        return *this;
    }

    // Adds a rule between keys, which is checked when the keys added before it have been read.
    KeyTable& check(std::function<void(JsonReader& reader, Struct& object)> rule) {
        return add({"", {}, false, std::move(rule), [](const Struct&, KeyJson&) {}});
    }

    // Adds the keys of a member that are written into the object itself, not into an inner one.
    template <typename Access, typename Part>
    KeyTable& part(const Access& access, const KeyTable<Part>& keys) {
        for (const Key<Part>& each : keys.keys()) {
            add({each.name, each.schema, each.required,
                 [access, each](JsonReader& reader, Struct& object) {
                     each.read(reader, std::invoke(access, object));
                 },
                 [access, each](const Struct& object, KeyJson& json) {
                     each.write(std::invoke(access, object), json);
                 }});
        }
        return *this;
    }

    // Adds an entry to the schema of the object, beside "properties".
    KeyTable& also(const std::string& name, KeyJson schema) {
        more_.emplace_back(name, std::move(schema));
        return *this;
    }

    // Reads the object into `object`, and closes the reader. Throws KeyError.
    void read(JsonReader& reader, Struct& object) const {
        for (const Key<Struct>& key : keys_) key.read(reader, object);
        reader.close();
    }
    void write(const Struct& object, KeyJson& json) const {
        for (const Key<Struct>& key : keys_) key.write(object, json);
    }
    KeyJson json(const Struct& object) const {
        KeyJson json = KeyJson::object();
        write(object, json);
        return json;
    }
    KeyJson schema() const {
        KeyJson schema{{"type", "object"}, {"additionalProperties", false}};
        KeyJson required = KeyJson::array(), properties = KeyJson::object();
        for (const Key<Struct>& key : keys_) {
            if (key.name.empty()) continue;
            if (key.required) required.push_back(key.name);
            properties[key.name] = key.schema;
        }
        if (!required.empty()) schema["required"] = std::move(required);
        for (const auto& [name, value] : more_) schema[name] = value;
        schema["properties"] = std::move(properties);
        return schema;
    }
    const std::vector<Key<Struct>>& keys() const { return keys_; }

  private:
    static KeyJson described(const KeyJson& schema, const std::string& description) {
        KeyJson all = KeyJson::object();
        if (!description.empty()) all["description"] = description;
        all.update(schema);
        return all;
    }
    // Tells whether a value goes into the schema as a default. Objects do not: their keys do.
    static bool is_default(const KeyJson& value) {
        return !value.is_null() && !value.is_object() && !(value.is_array() && value.empty());
    }

    std::vector<Key<Struct>> keys_;
    std::vector<std::pair<std::string, KeyJson>> more_;
};

// table_of<add>() returns the table that the function void add(KeyTable<Struct>&) fills at the
// first use. struct_of() is declared only to find Struct.
template <typename Struct>
Struct struct_of(void (*add)(KeyTable<Struct>&));
template <auto add>
const KeyTable<decltype(struct_of(add))>& table_of() {
    static const auto table = [] {
        KeyTable<decltype(struct_of(add))> keys;
        add(keys);
        return keys;
    }();
    return table;
}

// The form of a struct: an object with the keys of `table`.
template <typename Struct>
Form<Struct> object_form(const KeyTable<Struct>& (*table)()) {
    return {[table](JsonReader& reader, const std::string& key) {
                Struct object;
                JsonReader inner = reader.object(key);
                table().read(inner, object);
                return object;
            },
            [table](const Struct& object) { return table().json(object); }, table().schema()};
}

Form<bool> flag_form();
Form<int> code_bits_form();               // 8 or 16
Form<std::string> text_form();            // an empty text is left out when it is written
Form<std::filesystem::path> path_form();  // relative to the file; an empty path is left out
Form<glm::dvec3> vector_form();           // three finite numbers
Form<glm::dvec3> color_form();            // in the reader's colour space
Form<std::array<std::int64_t, 3>> sizes_form(std::int64_t most, const std::string& expected);

// Parts of the schema that several keys share ("$defs"), and a reference to one of them.
KeyJson vector_schema();
KeyJson color_schema();
KeyJson reference_to(const std::string& definition);

// Adds a check: values must pass `is_good`; `expected` completes the message if they do not.
template <typename T, typename Check>
Form<T> checked(Form<T> form, const Check& is_good, const std::string& expected) {
    form.read = [read = form.read, is_good, expected](JsonReader& reader, const std::string& key) {
        T value = read(reader, key);
        if (!is_good(value)) reader.reject(key, expected);
        return value;
    };
    return form;
}

// Limits of a number, named as in the schema.
struct Limits {
    std::optional<double> from = {}, above = {}, up_to = {}, below = {};

    bool contain(double number) const {
        return !(from && !(number >= *from)) && !(above && !(number > *above)) &&
               !(up_to && !(number <= *up_to)) && !(below && !(number < *below));
    }
};
// The form of a number. `expected` completes messages; if empty, a rule of the table checks it.
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

// The form of a value that is one of these words. The first word must be the default.
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

// The form of a value that may be replaced by `word`, which stands for no value. `is_type` tells by
// the JSON type whether `form` may read a value. `expected` completes the message for others.
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

// Turns a form in which "auto" stands for no value into one of Auto<T>.
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
// The form of "auto" or a value; arguments as in word_or_form().
template <typename T>
Form<Auto<T>> automatic_form(const Form<T>& form, bool (nlohmann::json::*is_type)() const noexcept,
                             const std::string& expected) {
    return automatic_if_none(word_or_form("auto", form, is_type, expected));
}
// The form of "auto" or one of an enum's words. `initial`: the default of the key.
template <typename Enum>
Form<Auto<Enum>> automatic_words_form(const Auto<Enum>& initial) {
    std::vector<std::pair<const char*, std::optional<Enum>>> words;
    for (const auto& [word, value] : enum_words<Enum>()) words.emplace_back(word, value);
    words.insert(initial.is_automatic() ? words.begin() : words.end(), {"auto", std::nullopt});
    return automatic_if_none(words_form<std::optional<Enum>>(words));
}

// The form of a list of up to `most` objects with the keys of `table`. `what` names the objects in
// messages; if it is empty, a rule of the table checks their number. `extra`: more schema entries.
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
