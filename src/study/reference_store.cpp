// SPDX-License-Identifier: Apache-2.0
#include "study/reference_store.h"

#include <utility>

#include "base/atomic_file.h"
#include "base/content_hash.h"
#include "base/json_text.h"
#include "base/stopwatch.h"
#include "image/npy.h"
#include "reference/volume_tracer.h"
#include "scene/json_reader.h"
#include "study/picture_key.h"
#include "study/text_file.h"

namespace lamina {
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

Reference trace(const Scene& scene, TraceOf of, DataStore& data) {
    const Stopwatch watch;
    const auto made = [&](auto result) {
        return Reference{
            {}, of, units * result.error_estimate, watch.milliseconds(), std::move(result.image)};
    };
    if (of == TraceOf::mesh) return made(data.mesh(scene).data.trace(scene));
    return made(trace_volume(data.volume(scene).data.volume(), scene.transfer_function,
                             View(scene.camera, scene.width, scene.height),
                             {scene.trace_tolerance}));
}

// All but the picture.
Reference load_facts(const std::filesystem::path& folder, const std::string& id) {
    const std::filesystem::path file = folder / (id + ".json");
    const nlohmann::json document = load_json(file);
    JsonReader reader(document, file);
    Reference reference;
    reference.id = id;
    reference.of =
        reader.choice<TraceOf>("of", {{"volume", TraceOf::volume}, {"mesh", TraceOf::mesh}});
    reference.error_estimate = reader.number("error_estimate");
    reference.ms = reader.number("ms");
    return reference;
}

}  // namespace

Reference ReferenceStore::load(const std::filesystem::path& folder, const std::string& id) {
    Reference reference = load_facts(folder, id);
    reference.image = read_npy(folder / (id + ".npy"));
    return reference;
}

double ReferenceStore::error_estimate(const std::filesystem::path& folder, const std::string& id) {
    return load_facts(folder, id).error_estimate;
}

// The picture first: what has its .json is complete.
void ReferenceStore::keep(const Reference& reference) const {
    AtomicFile picture(folder_ / (reference.id + ".npy"));
    write_npy(picture, reference.image);
    picture.commit();
    const nlohmann::ordered_json facts{{"of", reference.of == TraceOf::volume ? "volume" : "mesh"},
                                       {"error_estimate", reference.error_estimate},
                                       {"ms", reference.ms}};
    write_text(folder_ / (reference.id + ".json"), json_text(facts) + "\n");
}

const Reference& ReferenceStore::get(const Scene& scene, TraceOf of, DataStore& data) {
    const std::string id = key_of(scene, of, data);
    const auto found = references_.find(id);
    if (found != references_.end()) return found->second;
    if (!folder_.empty() && std::filesystem::exists(folder_ / (id + ".json")))
        return references_.emplace(id, load(folder_, id)).first->second;
    Reference reference = trace(scene, of, data);
    reference.id = id;
    if (!folder_.empty()) keep(reference);
    return references_.emplace(id, std::move(reference)).first->second;
}

}  // namespace lamina
