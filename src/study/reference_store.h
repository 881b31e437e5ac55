// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lamina/image.h"
#include "study/data_store.h"

namespace lamina::study {

// A tracer's picture of a scene.
struct Reference {
    // Hash of all that it depends on: data, transfer function, camera, size, tolerance.
    std::string id;
    TraceOf of = TraceOf::volume;
    double error_estimate = 0;  // the tracer's own estimate, in 1/255
    double ms = 0;              // time that tracing took
    PreciseImage image;
};

// Traced pictures, each made once. With a folder they are kept there as ID.npy and ID.json, for
// later studies of the same content. Damaged files are made again.
class ReferenceStore {
  public:
    using Say = std::function<void(const std::string&)>;

    ReferenceStore() = default;  // keeps references in memory only
    // `say` gets a message for each reference that is made again.
    ReferenceStore(std::filesystem::path folder, Say say)
        : folder_(std::move(folder)), say_(std::move(say)) {}

    // The reference for the scene's volume or its mesh, as `of` says. Throws Error. The result is
    // valid until clear().
    const Reference& get(const Scene& scene, TraceOf of, DataStore& data);
    void clear() { references_.clear(); }  // from memory

    // Returns true if the folder has an intact reference that was made before. If not, it will be
    // made again.
    bool is_kept(const std::string& id);

    // Loads a reference from `folder`. Throws Error if it is missing or was changed.
    static Reference load(const std::filesystem::path& folder, const std::string& id);
    static double error_estimate(const std::filesystem::path& folder, const std::string& id);

  private:
    std::optional<Reference> find(const std::string& id);
    Reference make(const std::string& id, const Scene& scene, TraceOf of, DataStore& data) const;

    std::filesystem::path folder_;
    Say say_;
    std::set<std::string> lost_;  // references whose loss was reported
    std::map<std::string, Reference> references_;
};

}  // namespace lamina::study
