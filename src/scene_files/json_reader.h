// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include "base/error.h"
#include "base/json_text.h"
#include "lamina/image_color_space.h"

namespace lamina {

// A key of a JSON file that is missing, unknown or has a bad value. `key`: its path,
// "render.slice.samples".
class KeyError : public Error {
  public:
    KeyError(std::string path, const std::string& message) : Error(message), key(std::move(path)) {}
    std::string key;
};

// A key for which no reader asked.
class UnknownKeyError : public KeyError {
  public:
    using KeyError::KeyError;
};

// Settings that the meaning of values depends on, beside their own text.
struct JsonContext {
    ImageColorSpace color_space = ImageColorSpace::linear;  // the space of colours
    bool volume_given = false, mesh_given = false;  // data in memory, which no key needs to name
};

// Reads one JSON object key by key and remembers which keys it was asked for. close() then rejects
// all other keys and suggests the nearest known key. Every error names the file and the path of the
// key, and says what was found and expected.
class JsonReader {
  public:
    // `file`: for messages and relative paths. Object and file must outlive the reader.
    JsonReader(const nlohmann::json& object, const std::filesystem::path& file,
               std::string path = "", const JsonContext& given_context = {});

    JsonContext context;  // readers of inner objects begin with the same one

    bool has(const std::string& key);
    JsonReader object(const std::string& key);  // an empty object when absent
    std::vector<JsonReader> objects(const std::string& key);
    // Throws KeyError if the key is missing.
    const nlohmann::json& value(const std::string& key);

    double number(const std::string& key);
    std::int64_t whole(const std::string& key, std::int64_t lo, std::int64_t hi);
    bool flag_or(const std::string& key, bool otherwise);
    std::string text(const std::string& key);
    glm::dvec3 vector(const std::string& key);
    // Returns a path of the file system. ${LAMINA_DATA} is expanded, and relative paths start at
    // the file's folder.
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

}  // namespace lamina
