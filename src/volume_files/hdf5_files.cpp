// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

// Largest depth of groups in groups that is searched: real files have few, and time grows with the
// square of it. Links may lead to links as often.
constexpr int most_groups = 64;
constexpr std::size_t most_names = 1000;

Hdf5Handle opened(const std::string& file) {
    Hdf5Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (handle.valid()) return handle;
    if (!is_hdf5(file)) fail("{}: found no signature of HDF5, expected an HDF5 file", file);
    fail("{}: truncated or damaged HDF5 file", file);
}

// The data of a soft or external link.
std::string link_value(hid_t group, const std::string& name, std::size_t bytes) {
    std::string value(bytes, '\0');
    if (H5Lget_val(group, name.c_str(), value.data(), bytes, H5P_DEFAULT) < 0) return {};
    return value;
}

// Opens a group of a group, but follows no soft and no external link.
Hdf5Handle hard_group(hid_t parent, const std::string& name) {
    H5L_info_t info;
    const bool is_hard =
        H5Lget_info(parent, name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD;
    return {is_hard ? H5Gopen2(parent, name.c_str(), H5P_DEFAULT) : -1, H5Gclose};
}

struct FoundLinks {
    std::vector<std::string> sets, links;  // data sets in the file, links into other files
    std::set<haddr_t> known;               // addresses of data sets
    bool too_deep = false;
};

// Notes the path of a data set or an external link. H5Lvisit() calls this for each link in the
// file, until it returns 1.
herr_t note_link(hid_t file, const char* name, const H5L_info_t* info, void* data) {
    auto& found = *static_cast<FoundLinks*>(data);
    const std::string path = std::string("/") + name;
    found.too_deep = std::ranges::count(path, '/') > most_groups + 1;
    if (found.too_deep) return 1;
    H5O_info_t object;
    if (info->type == H5L_TYPE_EXTERNAL) {
        found.links.push_back(path);
    } else if (info->type == H5L_TYPE_HARD &&
               H5Oget_info_by_name(file, name, &object, H5P_DEFAULT) >= 0 &&
               object.type == H5O_TYPE_DATASET && found.known.insert(object.addr).second) {
        found.sets.push_back(path);
    }
    return found.sets.size() + found.links.size() < most_names ? 0 : 1;
}

FoundLinks links_in(hid_t file, const std::string& name) {
    FoundLinks found;
    H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_link, &found);
    if (found.too_deep) {
        fail(
            "{}: found groups in groups more than {} deep, expected fewer, or the name of an "
            "array, as in {}:/GROUP/ARRAY",
            name, most_groups, name);
    }
    return found;
}

}  // namespace

Hdf5Files::Hdf5Files(const std::string& file)
    : name_(file), paths_{file}, access_(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown here, not printed
    add_lzf_filter();
    for (const char* const folder : {"HDF5_EXT_PREFIX", "HDF5_VDS_PREFIX", "HDF5_EXTFILE_PREFIX"})
        unsetenv(folder);
    // The folder of the file that names others: libhdf5 looks there first, as found() does.
    H5Pset_virtual_prefix(access_.id(), "${ORIGIN}");
    H5Pset_efile_prefix(access_.id(), "${ORIGIN}");
    files_.emplace(file, opened(file));
}

bool Hdf5Files::has(const std::string& path) const {
    const std::size_t last = path.rfind('/');
    const Hdf5Handle parent = group(path.substr(0, last));
    return parent.valid() && H5Lexists(parent.id(), path.substr(last + 1).c_str(), H5P_DEFAULT) > 0;
}

Hdf5Handle Hdf5Files::group(const std::string& path) const {
    Hdf5Handle group(H5Gopen2(file(), "/", H5P_DEFAULT), H5Gclose);
    for (std::size_t begin = 0; group.valid();) {
        begin = path.find_first_not_of('/', begin);
        if (begin == path.npos) break;
        const std::size_t end = std::min(path.find('/', begin), path.size());
        group = hard_group(group.id(), path.substr(begin, end - begin));
        begin = end;
    }
    return group;
}

// Returns the path of a file that the file `from` names, as libhdf5 looks for it
// (H5Lcreate_external in its reference manual): as it is if absolute, else, or if there is none,
// from the folder of `from`.
std::string Hdf5Files::found(const std::string& from, const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(from).parent_path();
    std::filesystem::path path = folder / name;
    std::error_code unreadable;
    if (std::filesystem::path(name).is_absolute() && !std::filesystem::exists(path, unreadable))
        path = folder / std::filesystem::path(name).filename();
    if (std::ranges::find(paths_, path.string()) == paths_.end()) paths_.push_back(path.string());
    expect_allowed(path);
    if (const char* const reason = why_not_regular(path))
        fail("{}: {}: {} names it", path.string(), reason, from);
    return path.string();
}

// Opens the file `name` that the file `from` names; returns its path.
std::string Hdf5Files::linked(const std::string& from, const std::string& name) {
    std::string path = found(from, name);
    if (!files_.contains(path)) files_.emplace(path, opened(path));
    return path;
}

// Opens a data set of an open file. libhdf5 follows hard links only; this follows all others.
Hdf5Handle Hdf5Files::open_in(const std::string& file, const std::string& path, int depth) {
    if (depth > most_groups)
        fail("{}: found links that lead to links more than {} times", file, most_groups);
    Hdf5Handle group(H5Gopen2(files_.at(file).id(), "/", H5P_DEFAULT), H5Gclose);
    for (std::size_t begin = 0; group.valid();) {
        begin = path.find_first_not_of('/', begin);
        if (begin == path.npos) break;
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string part = path.substr(begin, end - begin), rest = path.substr(end);
        H5L_info_t info;
        if (H5Lget_info(group.id(), part.c_str(), &info, H5P_DEFAULT) < 0) break;
        if (info.type == H5L_TYPE_SOFT) {
            const std::string target = link_value(group.id(), part, info.u.val_size).c_str();
            const bool absolute = target.starts_with('/');
            return open_in(file, (absolute ? "" : path.substr(0, begin) + "/") + target + rest,
                           depth + 1);
        }
        if (info.type == H5L_TYPE_EXTERNAL) {
            const std::string value = link_value(group.id(), part, info.u.val_size);
            const char *other = nullptr, *object = nullptr;
            if (H5Lunpack_elink_val(value.data(), value.size(), nullptr, &other, &object) < 0)
                break;
            return open_in(linked(file, other), std::string(object) + rest, depth + 1);
        }
        if (info.type != H5L_TYPE_HARD) break;
        if (rest.find_first_not_of('/') == rest.npos) {
            Hdf5Handle set(H5Dopen2(group.id(), part.c_str(), access_.id()), H5Dclose);
            if (set.valid() && checked_.emplace(file, path).second)
                expect_samples(file, set.id(), depth);
            return set;
        }
        group = hard_group(group.id(), part);
        begin = end;
    }
    return {-1, H5Dclose};
}

Hdf5Handle Hdf5Files::open_set(const std::string& path) {
    paths_.resize(1);
    checked_.clear();
    return open_beside(path);
}

// Throws Error unless the files that the samples of a data set of `file` are in can be opened.
void Hdf5Files::expect_samples(const std::string& file, hid_t set, int depth) {
    const Hdf5Handle properties(H5Dget_create_plist(set), H5Pclose);
    char name_of_file[4096] = {}, path[4096] = {};
    for (int i = 0; i < H5Pget_external_count(properties.id()); ++i) {
        H5Pget_external(properties.id(), static_cast<unsigned>(i), sizeof name_of_file - 1,
                        name_of_file, nullptr, nullptr);
        found(file, name_of_file);
    }
    if (!is_virtual(set)) return;
    std::size_t count = 0;
    H5Pget_virtual_count(properties.id(), &count);
    std::set<std::pair<std::string, std::string>> known;
    for (std::size_t i = 0; i < count; ++i) {
        H5Pget_virtual_filename(properties.id(), i, name_of_file, sizeof name_of_file);
        H5Pget_virtual_dsetname(properties.id(), i, path, sizeof path);
        if (!known.emplace(name_of_file, path).second) continue;
        const std::string other = name_of_file;
        if ((other + path).find("%b") != other.npos) {
            fail("{}: found a virtual data set with a pattern of names, \"{}\", expected names",
                 file, one_line(other));
        }
        const std::string source = other == "." ? file : linked(file, other);
        if (!open_in(source, path, depth + 1).valid())
            fail("{}: found no data set \"{}\", which {} names", source, one_line(path), file);
    }
}

std::vector<std::string> Hdf5Files::arrays() {
    FoundLinks links = links_in(file(), name());
    links.sets.insert(links.sets.end(), links.links.begin(), links.links.end());
    std::vector<std::string> others;  // whose types are not read
    std::erase_if(links.sets, [&](const std::string& path) {
        try {
            const Hdf5Handle set = open_beside(path);
            if (set.valid() && can_be_volume(set.id())) return false;
            if (set.valid() && has_axes_of_volume(set.id())) others.push_back(path);
            return true;
        } catch (const Error&) {
            return false;  // the Error is thrown when the array is read
        }
    });
    // A link that leads nowhere, and a type that is not read, are named when they are read.
    if (links.sets.empty()) return links.links.empty() ? others : links.links;
    return links.sets;
}

void Hdf5Files::find_files(const std::string& path) {
    FoundLinks links;
    if (path.empty())
        links = links_in(file(), name());
    else
        links.links.push_back(path);
    links.links.insert(links.links.end(), links.sets.begin(), links.sets.end());
    for (const std::string& one : links.links) {
        try {
            open_beside(one);
        } catch (const Error&) {
        }
    }
}

}  // namespace lamina
