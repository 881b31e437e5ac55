// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/text.h"
#include "named_output.h"
#include "scene_files/json_reader.h"
#include "scene_files/scene_reader.h"

namespace lamina {

Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit) {
    const bool piped = options.file == standard_stream;
    const std::string file = piped ? stdin_name : options.file;
    const VolumeRequest request = request_of(options.raw);
    if (piped && request.raw) throw UsageError("--raw: found -, expected a volume's file");
    document = piped ? load_json_from_stdin() : scene_document(file, request);
    std::vector<std::string> keys;
    const auto apply = [&](const std::string& key, const std::string& value) {
        // A volume is written as an object if it has more settings than its path.
        const bool of_volume = key.starts_with("volume.") && document.contains("volume");
        if (of_volume && document["volume"].is_string())
            document["volume"] = {{"path", document["volume"]}};
        set_key(document, key, value);
        keys.push_back(key);
    };
    (void)JsonReader(document, file);  // a scene is an object: keys of a list could not be set
    std::vector<std::string> settings = more;
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    for (const std::string& setting : settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos) {
            throw UsageError(fmt::format("--set {}: expected KEY=VALUE, as in render.target=fixed8",
                                         shortened(setting)));
        }
        apply(setting.substr(0, equals), setting.substr(equals + 1));
    }
    if (!options.method.empty()) apply("render.method", options.method);
    if (edit) edit(document);
    try {
        return read_scene(document, file);
    } catch (const KeyError& error) {
        for (const std::string& key : keys) {
            if (error.key == key || key.starts_with(error.key + ".") ||
                error.key.starts_with(key + ".")) {
                throw UsageError(error.what());
            }
        }
        throw;
    }
}

nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document) {
    nlohmann::ordered_json result = scene_json(scene);
    result["render"] = document.value("render", nlohmann::json::object());
    result["render"]["method"] = name_of(scene.method);
    return result;
}

}  // namespace lamina
