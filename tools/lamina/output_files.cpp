// SPDX-License-Identifier: Apache-2.0
#include "output_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "image/film_file.h"
#include "image/picture.h"
#include "mesh_files/mesh_file.h"
#include "scene/given_transfer.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Identity = std::pair<dev_t, ino_t>;

// Returns device and inode of a file, equal for all its names; nothing if there is no such file.
std::optional<Identity> identity_of(const std::filesystem::path& path) {
    struct stat found = {};
    if (stat(path.c_str(), &found) != 0) return std::nullopt;
    return Identity(found.st_dev, found.st_ino);
}

using Paths = std::vector<std::filesystem::path>;

void append(Paths& files, const Paths& more) {
    files.insert(files.end(), more.begin(), more.end());
}

std::optional<PictureFormat> format_of(const std::string& word) {
    if (word == "exr") return PictureFormat::exr;
    if (word == "png") return PictureFormat::png;
    if (word == "npy") return PictureFormat::npy;
    return std::nullopt;
}

}  // namespace

std::unique_ptr<OutputFile> open_named(const std::string& name) {
    if (name == standard_stream) return std::make_unique<PipedFile>();
    return std::make_unique<AtomicFile>(name);
}

void expect_different_files(const std::vector<std::filesystem::path>& read,
                            const std::vector<std::filesystem::path>& written) {
    std::map<Identity, std::filesystem::path> kept;
    for (const std::filesystem::path& path : read) {
        if (const auto identity = identity_of(path)) kept.emplace(*identity, path);
    }
    std::set<std::filesystem::path> made;
    for (const std::filesystem::path& path : written) {
        if (path.empty()) continue;
        const bool piped = path == standard_stream;
        const auto identity = piped ? std::nullopt : identity_of(path);
        const auto found = identity ? kept.find(*identity) : kept.end();
        if (found != kept.end()) {
            throw UsageError(
                fmt::format("{}: would replace {}, which is read: expected different files",
                            path.string(), found->second.string()));
        }
        std::error_code ignored;
        if (!made.insert(std::filesystem::weakly_canonical(path, ignored)).second) {
            throw UsageError(fmt::format("{}: would be written twice: expected different files",
                                         piped ? "-, stdout" : path.string()));
        }
    }
}

void expect_own_folder(const std::filesystem::path& folder, const std::string& verb,
                       const std::vector<std::string>& names,
                       const std::vector<std::filesystem::path>& read, bool force) {
    std::vector<std::filesystem::path> written{folder / OwnFiles::list_name};
    for (const std::string& name : names) written.push_back(folder / name);
    expect_different_files(read, written);
    if (!force) OwnFiles(folder, verb).expect_own(names);
}

Paths files_of(const Scene& scene) {
    Paths files{scene.file};
    const std::filesystem::path colormap = colormap_file_of(scene);
    if (!colormap.empty()) files.push_back(colormap);
    if (const VolumeFile* const volume = scene.volume_file())
        append(files, files_of_volume(volume->path, volume->selection));
    if (const MeshFile* const mesh = scene.mesh_file()) append(files, files_of_mesh(mesh->path));
    return files;
}

PictureFormat picture_format(const std::string& output, const std::string& format) {
    const bool piped = output == standard_stream;
    if (piped && format.empty())
        throw UsageError("-o -: expected --format png, exr or npy, too: a pipe has no suffix");
    if (!piped && !format.empty()) {
        throw UsageError(fmt::format(
            "--format {}: only with -o -; the suffix of {} gives its format", format, output));
    }
    const std::string suffix = std::filesystem::path(output).extension().string();
    const auto found = format_of(piped ? format : suffix.substr(suffix.empty() ? 0 : 1));
    if (found) return *found;
    if (piped) throw UsageError(fmt::format("--format {}: expected one of png, exr, npy", format));
    std::error_code unknown;
    if (std::filesystem::is_directory(output, unknown)) {
        throw UsageError(fmt::format(
            "-o {}: is a folder, expected a file that ends in .png, .exr or .npy", output));
    }
    throw UsageError(fmt::format("-o {}: {}; films end in {}", output, refusal_of_suffix(suffix),
                                 film_suffixes));
}

}  // namespace lamina
