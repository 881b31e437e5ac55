// SPDX-License-Identifier: Apache-2.0
// Keys of JSON objects, from one table a struct (docs/architecture.md, "Keys"): the reader, the
// writer and the schema come from it.
#pragma once

#include <cassert>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scene_files/json_reader.h"

namespace lamina {

using KeyJson = nlohmann::ordered_json;

// How a value of type T stands under a key.
template <typename T>
struct Form {
    // The key is there, or must be: throws KeyError otherwise.
    std::function<T(JsonReader& reader, const std::string& key)> read;
    std::function<KeyJson(const T& value)> write;  // null: the key is left out
    KeyJson schema;
};

// A key and the members of Struct that it sets.
template <typename Struct>
struct Key {
    std::string name;  // empty: a check at this place
    KeyJson schema;    // with description and default
    bool required = false;
    std::function<void(JsonReader& reader, Struct& object)> read;
    std::function<void(const Struct& object, KeyJson& json)> write;
    // Reads the key although it may be missing, which is a mistake then.
    std::function<void(JsonReader& reader, Struct& object)> read_required = {};
};

// One of several forms that a key may have, told apart by the value.
template <typename Struct>
struct Alternative {
    std::function<bool(const nlohmann::json& value)> reads;
    std::function<void(JsonReader& reader, const std::string& key, Struct& object)> read;
    std::function<bool(const Struct& object)> writes;
    std::function<KeyJson(const Struct& object)> write;
    KeyJson schema;
};

// The keys of a struct, in the order in which they are read and written. A member whose
// key is left out keeps its initial value, which is the key's default.
template <typename Struct>
class KeyTable {
  public:
    // `access`: a pointer to a member, or what returns a reference to one.
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

    // Adds an object with the keys of a table. It may be left out: then its rules are checked all
    // the same. It is always written.
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
    // Adds an object whose keys are this struct's own.
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

    // The following are about the key that was added last.
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

    // Checks what was read so far: rules between keys.
    KeyTable& check(std::function<void(JsonReader& reader, Struct& object)> rule) {
        return add({"", {}, false, std::move(rule), [](const Struct&, KeyJson&) {}});
    }

    // Adds the keys of a member that stand in the object itself.
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

    // Adds keys to the schema beside those of the properties.
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
    // An object or a list has the defaults of its own keys.
    static bool is_default(const KeyJson& value) {
        return !value.is_null() && !value.is_object() && !(value.is_array() && value.empty());
    }

    std::vector<Key<Struct>> keys_;
    std::vector<std::pair<std::string, KeyJson>> more_;
};

// Form of a struct: an object with the keys of a table. `table` makes it, for the first one who
// asks.
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

}  // namespace lamina
