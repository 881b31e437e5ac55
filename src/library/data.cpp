// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "lamina/info.h"
#include "lamina/mesh.h"
#include "lamina/volume.h"
#include "mesh_files/mesh_file.h"
#include "meshing/volume_mesh.h"
#include "render/file_report.h"
#include "volume/labels.h"
#include "volume/min_max_bricks.h"
#include "volume/nrrd_writer.h"
#include "volume_files/stored_samples.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

void expect_suffix(const std::filesystem::path& file, const char* suffix) {
    if (file.extension() != suffix) {
        fail("{}: found the suffix \"{}\", expected {}", file.string(), file.extension().string(),
             suffix);
    }
}

}  // namespace

Volume load_volume(const std::filesystem::path& file, const VolumeRequest& request,
                   const std::filesystem::path& only_below, std::vector<std::string>* warnings) {
    const OnlyBelowScope scope(only_below);
    std::vector<std::string> said;
    return keep_warnings(warnings == nullptr ? said : *warnings,
                         [&] { return read_volume(file, request); });
}

std::string describe_file(const std::filesystem::path& file, const VolumeRequest& request,
                          const std::filesystem::path& only_below,
                          std::vector<std::string>* warnings) {
    const OnlyBelowScope scope(only_below);
    std::vector<std::string> said;
    return keep_warnings(warnings == nullptr ? said : *warnings,
                         [&] { return json_text(file_report(file.string(), request)); });
}

Volume label_volume(const Grid& grid, const std::string& type, std::shared_ptr<const void> samples,
                    std::vector<std::string>* warnings) {
    const auto found = value_type_of(type);
    if (!found) fail("type: found \"{}\", expected one of {}", type, value_type_list());
    Grid voxels = grid;
    voxels.lookup = VolumeLookup::nearest;
    const StoredSamples numbers{"array", *found, std::const_pointer_cast<void>(samples)};
    std::vector<std::string> said;
    return keep_warnings(warnings == nullptr ? said : *warnings,
                         [&] { return drawn_volume(voxels, numbers, voxels.lookup); });
}

bool look_like_labels(const Volume& volume) {
    if (!volume.in_memory()) return false;
    const LabelSigns signs =
        volume.type() == SampleType::float32
            ? label_signs(volume.grid().size, ValueType::float32, volume.data())
            : label_signs(volume);
    if (!signs.are_labels()) return false;
    const ValueRange range = measure_bricks(volume).whole;
    return range.hi - range.lo > 1;
}

MeshData load_mesh_data(const std::filesystem::path& file,
                        const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_mesh(file);
}

void save_volume(const Volume& volume, const std::filesystem::path& file) {
    expect_suffix(file, ".nrrd");
    AtomicFile output(file);
    write_nrrd(output, volume);
    output.commit();
}

void save_mesh(const MeshData& mesh, const std::filesystem::path& file) {
    expect_suffix(file, ".vtu");
    AtomicFile output(file);
    write_vtu(output, mesh);
    output.commit();
}

MadeMesh make_mesh(const Volume& volume, const MeshSettings& settings,
                   const TransferFunction* transfer_function, std::stop_token stop,
                   const ProgressCallback& progress) {
    ProgressListener listener{progress};
    const ClientScope scope({std::move(stop), nullptr, &listener});
    MadeMesh made;
    made.mesh = make_volume_mesh(volume, settings, transfer_function, made.report);
    return made;
}

}  // namespace lamina
