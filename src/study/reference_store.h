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

// What a tracer makes of a scene.
struct Reference {
    std::string id;  // of all that it depends on: data, transfer function, camera, size, tolerance
    TraceOf of = TraceOf::volume;
    double error_estimate = 0;  // the tracer's own, in 1/255
    double ms = 0;              // that tracing took
    PreciseImage image;
};

// Traced pictures, each made once; with a folder kept there as ID.npy and ID.json, where later
// studies of the same content find them. What is damaged there is made again.
class ReferenceStore {
  public:
    using Say = std::function<void(const std::string&)>;

    ReferenceStore() = default;  // in memory alone
    // `say` gets a message for each that is made again.
    ReferenceStore(std::filesystem::path folder, Say say)
        : folder_(std::move(folder)), say_(std::move(say)) {}

    // As `of` asks: of the scene's volume or of its mesh. Throws Error. The reference stays until
    // clear().
    const Reference& get(const Scene& scene, TraceOf of, DataStore& data);
    void clear() { references_.clear(); }  // from memory

    // One that was made before is whole in the folder; where not, it will be made again.
    bool is_kept(const std::string& id);

    // As kept in `folder`; throws Error where it is not there, or not as it was written.
    static Reference load(const std::filesystem::path& folder, const std::string& id);
    static double error_estimate(const std::filesystem::path& folder, const std::string& id);

  private:
    std::optional<Reference> find(const std::string& id);
    Reference make(const std::string& id, const Scene& scene, TraceOf of, DataStore& data) const;

    std::filesystem::path folder_;
    Say say_;
    std::set<std::string> lost_;  // that was said
    std::map<std::string, Reference> references_;
};

}  // namespace lamina::study
