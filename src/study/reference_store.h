// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "image/image.h"
#include "study/data_store.h"

namespace lamina {

// What a tracer makes of a scene.
struct Reference {
    std::string id;  // of all that it depends on: data, transfer function, camera, size, tolerance
    TraceOf of = TraceOf::volume;
    double error_estimate = 0;  // the tracer's own, in 1/255
    double ms = 0;              // that tracing took
    PreciseImage image;
};

// Traced pictures, each made once; with a folder kept there as ID.npy and ID.json, where later
// studies of the same content find them.
class ReferenceStore {
  public:
    ReferenceStore() = default;  // in memory alone
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // As `of` asks: of the scene's volume or of its mesh. Throws Error. The reference stays until
    // clear().
    const Reference& get(const Scene& scene, TraceOf of, DataStore& data);
    void clear() { references_.clear(); }  // from memory

    // As kept in `folder`; throws Error where it is not there.
    static Reference load(const std::filesystem::path& folder, const std::string& id);
    static double error_estimate(const std::filesystem::path& folder, const std::string& id);

  private:
    void keep(const Reference& reference) const;

    std::filesystem::path folder_;
    std::map<std::string, Reference> references_;
};

}  // namespace lamina
