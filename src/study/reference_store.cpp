// SPDX-License-Identifier: Apache-2.0
#include "study/reference_store.h"

#include <utility>

#include "base/content_hash.h"
#include "base/enum_words.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "image/npy.h"
#include "render/traced_picture.h"
#include "scene_files/json_reader.h"
#include "study/data_store.h"
#include "study/result_files.h"

namespace lamina::study {
namespace {

constexpr double units = 255;  // of errors, in full scale

std::string key_of(const Scene& scene, TraceOf of, DataStore& data) {
    ContentHash hash;
    hash.add(picture_key(scene));
    if (of == TraceOf::volume) {
        hash.add(data.volume(scene).content);
        hash.add(scene.trace_tolerance);
    } else {
        hash.add(data.mesh(scene).content);
    }
    return hash.hex();
}

Reference traced(const Scene& scene, TraceOf of, DataStore& data) {
    const Stopwatch watch;
    const auto made = [&](auto result) {
        return Reference{
            {}, of, units * result.error_estimate, watch.milliseconds(), std::move(result.image)};
    };
    if (of == TraceOf::mesh) return made(data.mesh(scene).data.trace(scene));
    SceneData volume(data.volume(scene).data);
    return made(trace_picture(as_trace(scene, TraceOf::volume), volume));
}

std::string content_of(const PreciseImage& image) {
    ContentHash hash;
    hash.add(static_cast<double>(image.width));
    hash.add(image.rgba.data(), image.rgba.size() * sizeof(image.rgba[0]));
    return hash.hex();
}

// Loads all but the picture, and returns what names the picture.
std::pair<Reference, std::string> load_facts(const std::filesystem::path& folder,
                                             const std::string& id) {
    const std::filesystem::path file = folder / (id + ".json");
    const nlohmann::json document = load_json(file);
    JsonReader reader(document, file);
    Reference reference;
    reference.id = id;
    reference.of = reader.choice<TraceOf>("of", enum_words<TraceOf>());
    reference.error_estimate = reader.number("error_estimate");
    reference.ms = reader.number("ms");
    return {std::move(reference), reader.text("picture")};
}

}  // namespace

Reference ReferenceStore::load(const std::filesystem::path& folder, const std::string& id) {
    auto [reference, content] = load_facts(folder, id);
    const std::filesystem::path file = folder / (id + ".npy");
    reference.image = read_npy(file);
    const std::string found = content_of(reference.image);
    if (found != content) {
        fail("{}: found a picture of hash {}, expected {} as {}.json says", file.string(), found,
             content, id);
    }
    return std::move(reference);
}

double ReferenceStore::error_estimate(const std::filesystem::path& folder, const std::string& id) {
    return load_facts(folder, id).first.error_estimate;
}

// Returns nothing if the reference cannot be read, which is said once.
std::optional<Reference> ReferenceStore::find(const std::string& id) {
    if (lost_.contains(id)) return std::nullopt;
    try {
        return load(folder_, id);
    } catch (const Error& error) {
        say_(fmt::format("{}: the reference is traced again", error.what()));
        lost_.insert(id);
        return std::nullopt;
    }
}

bool ReferenceStore::is_kept(const std::string& id) {
    return find(id).has_value();
}

Reference ReferenceStore::make(const std::string& id, const Scene& scene, TraceOf of,
                               DataStore& data) const {
    std::optional<AtomicFile> picture;  // first: a file that cannot be written fails at once
    if (!folder_.empty()) picture.emplace(folder_ / (id + ".npy"));
    Reference reference = traced(scene, of, data);
    reference.id = id;
    if (!picture) return reference;
    // The picture is written before the facts, so that a reference with a .json is complete.
    write_npy(*picture, reference.image);
    picture->commit();
    const nlohmann::ordered_json facts{{"of", name_of(reference.of)},
                                       {"error_estimate", reference.error_estimate},
                                       {"ms", reference.ms},
                                       {"picture", content_of(reference.image)}};
    write_text(folder_ / (id + ".json"), json_text(facts) + "\n");
    return reference;
}

const Reference& ReferenceStore::get(const Scene& scene, TraceOf of, DataStore& data) {
    const std::string id = key_of(scene, of, data);
    const auto known = references_.find(id);
    if (known != references_.end()) return known->second;
    std::optional<Reference> reference;
    if (!folder_.empty() && std::filesystem::exists(folder_ / (id + ".json"))) reference = find(id);
    if (!reference) reference = make(id, scene, of, data);
    return references_.emplace(id, std::move(*reference)).first->second;
}

}  // namespace lamina::study
