// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "optics/colormap.h"
#include "render/pipeline.h"
#include "render/scene_data.h"
#include "scene/scene.h"
#include "volume/volume_data.h"

namespace lamina::study {

// Returns a hash of everything that an exact picture depends on beside its data: transfer function,
// camera, size, clip and lighting.
std::string picture_key(const Scene& scene);

std::string transfer_function_key(const TransferFunction& transfer_function);

// Return a hash of the contents of data, independent of file names.
std::string content_of(const Volume& volume);
std::string content_of(const SceneMesh& mesh);
std::string content_of(const Colormap& colormap);

// A tetrahedral mesh, with the tracer's pictures of it. The mesh that a scene names is ignored:
// this one is traced.
class TracedMesh {
  public:
    explicit TracedMesh(SceneMesh mesh);
    explicit TracedMesh(SceneData data);  // must have a mesh

    const SceneMesh& mesh() const { return *mesh_; }
    const TetMesh& tets() const { return mesh_->mesh; }
    const SceneData& data() const { return data_; }

    TracedPicture trace(const Scene& scene);
    // Returns the tracer's picture, made once for each picture_key().
    const PreciseImage& exact(const Scene& scene);

  private:
    SceneData data_;
    std::shared_ptr<const SceneMesh> mesh_;       // that of data_
    std::map<std::string, PreciseImage> traced_;  // by picture_key()
};

// A mesh made from a volume, with the time that making it took.
struct MadeMesh {
    SceneData data;
    double ms = 0;
};

// Return names of data: paths, or formulas of generated data.
std::string volume_name(const Scene& scene);
std::string mesh_name(const Scene& scene);

// Volumes and meshes of scenes. Each is loaded or made once, when it is first needed. Throws Error
// if that fails.
class DataStore {
  public:
    struct StoredVolume {
        std::shared_ptr<const VolumeData> data;
        std::string content;  // content_of()
    };
    struct StoredMesh {
        TracedMesh data;
        std::string content;
        double ms = 0;  // time to read or make it
    };
    const StoredVolume& volume(const Scene& scene);
    StoredMesh& mesh(const Scene& scene);
    SceneData data_of(const Scene& scene);
    // Returns the scene with an open colour map stretched over the range of its data.
    Scene closed(Scene scene);
    void clear();

    // Keeps meshes that are made from volumes in this folder, as ID.vtu and ID.json, from now on,
    // and takes them from there if they exist. The numbers that a later process reads are the same,
    // bit for bit.
    void keep_meshes(const std::filesystem::path& folder) { kept_ = folder; }

  private:
    MadeMesh read_or_make(const Scene& scene);

    std::filesystem::path kept_;  // empty: meshes are not kept
    std::map<std::string, std::unique_ptr<StoredVolume>> volumes_;
    std::map<std::string, std::unique_ptr<StoredMesh>> meshes_;
};

// A tracer's picture of a scene.
struct Reference {
    // Hash of everything it depends on: data, transfer function, camera, size, tolerance.
    std::string id;
    TraceOf of = TraceOf::volume;
    double error_estimate = 0;  // the tracer's own estimate, in 1/255
    double ms = 0;              // time that tracing took
    PreciseImage image;
};

// Traced pictures, each made once. If there is a folder, they are kept there as ID.npy and ID.json
// for later studies. Damaged files are made again.
class ReferenceStore {
  public:
    using Say = std::function<void(const std::string&)>;

    ReferenceStore() = default;  // keeps references in memory only
    // `say` gets a message for each reference that is made again.
    ReferenceStore(std::filesystem::path folder, Say say)
        : folder_(std::move(folder)), say_(std::move(say)) {}

    // Returns the reference for the scene's volume or its mesh, as `of` says. Throws Error. The
    // result is valid until clear().
    const Reference& get(const Scene& scene, TraceOf of, DataStore& data);
    void clear() { references_.clear(); }  // frees the memory; files stay

    // Returns true if the folder has an intact reference of this id. If not, get() will trace it
    // again.
    bool is_kept(const std::string& id);

    // Load a reference, or its error estimate, from `folder`. Throw Error if it is missing or
    // damaged.
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
