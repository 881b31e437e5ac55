// SPDX-License-Identifier: Apache-2.0
#include "volume_files/foreign_files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "image/picture.h"
#include "mesh_files/mesh_file.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using namespace std::string_view_literals;
using Path = std::filesystem::path;

// A format that is not read. It is known by its first bytes or, if it has no mark of its own, by
// the file's name.
struct ForeignFormat {
    const char* name;
    std::size_t at;          // byte of `mark`
    std::string_view mark;   // empty: none
    const char* extensions;  // in lower case, between blanks
    const char* advice;
};

constexpr const char *bio_formats = "Fiji (Bio-Formats) saves it as OME-TIFF",
                     *slicer = "3D Slicer or ITK-SNAP saves it as NRRD",
                     *mrcfile = "the Python package mrcfile reads it, numpy.save writes .npy",
                     *scanco = "Fiji (its plugin for SCANCO) saves it as TIFF",
                     *numpy = "numpy.save writes arrays as .npy",
                     *surface =
                         "it has no volume; trimesh fills a closed one with voxels "
                         "(voxelized(pitch).fill().matrix), numpy.save writes .npy",
                     *pictures = "save its pictures as PNG or TIFF, such as by ImageMagick",
                     *unpack = "unpack it first", *download = "download the data that it leads to",
                     *points = "it has no volume; numpy.histogramdd counts points in voxels",
                     *bigdataviewer = "name the .h5 or .zarr that it describes",
                     *dataset = "xarray or cdo write NetCDF of it",
                     *as_raw = "it describes raw data, which --raw reads",
                     *with_size =
                         "give their size and type (--raw, or the keys size and type of a volume)",
                     *as_frames = "ffmpeg saves its frames as PNG (ffmpeg -i FILE f_%04d.png)";

constexpr ForeignFormat formats_not_read[] = {
    {"an MRC or CCP4 map", 208, "MAP ", " .mrc .mrcs .ccp4 .st .ali .preali ", mrcfile},
    {"an MRC or CCP4 map", 212, "DD\0\0"sv, "", mrcfile},
    {"an Amira or Avizo file", 0, "# AmiraMesh", "", "Amira and Avizo save it as NRRD"},
    {"an Amira or Avizo file", 0, "# Avizo", "", "Amira and Avizo save it as NRRD"},
    {"a Gatan Digital Micrograph file", 0, "", " .dm3 .dm4 ", bio_formats},
    {"a Zeiss CZI file", 0, "ZISRAWFILE", "", bio_formats},
    {"a Leica file", 0, "", " .lif .lof .xlef ", bio_formats},
    {"a Nikon ND2 file", 0, "\xda\xce\xbe\x0a", "", bio_formats},
    {"an Olympus file", 0, "OLYMPUSRAWFORMAT", " .oir .oif .vsi ", bio_formats},
    {"an OLE container, as Olympus OIB, Zeiss ZVI and TXRM files are", 0,
     "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "", bio_formats},
    {"a Bio-Rad or KLB file", 0, "", " .pic .klb ", bio_formats},
    {"a DeltaVision file", 0, "", " .dv .r3d ", bio_formats},
    {"an Image Cytometry Standard (ICS) file", 0, "\t\nics_version", " .ics .ids ", bio_formats},
    {"a SlideBook file", 0, "", " .sld .sldy ", bio_formats},
    {"the description of a BigDataViewer volume", 0, "<SpimData", "", bigdataviewer},
    {"a FITS file", 0, "SIMPLE  =", "", "astropy reads it, numpy.save writes .npy"},
    {"an OpenVDB file", 0, " BDV", " .nvdb ",
     "pyopenvdb copies it to an array, numpy.save writes .npy"},
    {"a MATLAB file before version 7.3", 0, "MATLAB 5.0", "", "save(..., '-v7.3') writes HDF5"},
    {"an HDF4 file", 0, "\x0e\x03\x13\x01", "", "h4toh5 makes HDF5 of it"},
    {"a GRIB file", 0, "GRIB", " .grb .grib .grib2 ", dataset},
    {"a FreeSurfer volume", 0, "", " .mgh .mgz ", "mri_convert makes NIfTI of it"},
    {"an AFNI data set", 0, "", " .head .brik ", "3dAFNItoNIFTI makes NIfTI of it"},
    {"an Interfile header", 0, "!INTERFILE", " .hv ", slicer},
    {"a Philips PAR/REC header", 0, "# === DATA DESCRIPTION FILE", "",
     "dcm2niix makes NIfTI of it"},
    {"an Inrimage file", 0, "#INRIMAGE-4#{", "", slicer},
    {"a SCANCO ISQ file", 0, "CTDATA-HEADER_V1", "", scanco},
    {"a SCANCO AIM file", 0, "AIMDATA_V", " .aim ", scanco},
    {"a GIPL file", 0, "", " .gipl ", slicer},
    {"an ECAT file", 0, "MATRIX7", "", "nibabel makes NIfTI of it"},
    {"an OpenDX file", 0, "", " .dx ", "ParaView or VTK save it as .vti"},
    {"an AVS field", 0, "# AVS", " .fld ", "ParaView saves it as .vti"},
    {"a Gaussian cube file", 0, "", " .cube .cub ", "ParaView saves it as .vti"},
    {"a SEG-Y file", 0, "", " .sgy .segy ", "segyio reads it, numpy.save writes .npy"},
    {"a description of raw data", 0, "ObjectFileName:", " .vgi ", as_raw},
    {"an ERDAS Imagine file", 0, "EHFA_HEADER_TAG", "", "gdal_translate makes TIFF of it"},
    {"an ENVI header", 0, "ENVI", "", as_raw},
    {"a BOV header", 0, "", " .bov ", as_raw},
    {"a PVM volume", 0, "PVM", "", as_raw},
    {"a CImg file", 0, "", " .cimg .cimgz ", "G'MIC saves it as a float TIFF (-o FILE.tif)"},
    {"a MagicaVoxel file", 0, "VOX ", " .vox ", numpy},
    {"a surface", 0, "", " .ply .stl .obj .off .gii .3mf .fbx .dae .iges .igs .step .stp ",
     surface},
    {"a surface", 0, "glTF", " .gltf ", surface},
    {"a cloud of points", 0, "# .PCD", " .pcd .e57 ", points},
    {"a cloud of points", 0, "LASF", " .las .laz ", points},
    {"a table of text", 0, "", " .csv .tsv .xyz ", numpy},
    {"a table", 0, "PAR1", " .parquet .feather .arrow .xlsx ", numpy},
    {"arrays of safetensors", 0, "", " .safetensors ", numpy},
    {"a LabVIEW TDMS file", 0, "TDSm", "", "nptdms reads it, numpy.save writes .npy"},
    {"a state of ParaView", 0, "<ParaView>", " .pvsm ", "name the data that it shows"},
    {"a Python pickle or PyTorch file", 0, "", " .pkl .pickle .pt .pth ", numpy},
    {"an OpenEXR picture", 0, "\x76\x2f\x31\x01", "", pictures},
    {"a film", 4, "ftyp", " .mp4 .mov .mkv .webm .avi .wmv .mpg ", as_frames},
    {"a JPEG 2000 picture", 0, "\xff\x4f\xff\x51", "", pictures},
    {"a JPEG 2000 picture", 0, "\0\0\0\x0cjP  "sv, "", pictures},
    {"a WebP picture", 8, "WEBP", "", pictures},
    {"a GIF picture", 0, "GIF8", "", pictures},
    {"a picture", 0, "", " .bmp .pgm .ppm .pnm .pfm .tga ", pictures},
    {"samples without a header", 0, "", " .raw .vol .bin .dat .data ", with_size},
    {"a Git LFS pointer", 0, "version https://git-lfs", "", "git lfs pull fetches the data"},
    {"a web page", 0, "<!DOCTYPE html", "", download},
    {"a web page", 0, "<!doctype html", "", download},
    {"a web page", 0, "<html", "", download},
    {"a ZIP archive", 0, "PK\3\4", "", unpack},
    {"a gzip file", 0, "\x1f\x8b", "", unpack},
    {"a bzip2 file", 0, "BZh", "", unpack},
    {"an xz file", 0, "\xfd\x37zXZ", "", unpack},
    {"a zstd file", 0, "\x28\xb5\x2f\xfd", "", unpack},
    {"a 7z archive", 0, "7z\xbc\xaf\x27\x1c", "", unpack},
    {"a RAR archive", 0, "Rar!\x1a", "", unpack},
    {"a tar archive", 257, "ustar", "", unpack}};

// Names of entries by their kind, "NRRD" or "meshes"; those of all else are under "".
using NamesByKind = std::map<std::string_view, std::vector<std::string>>;

// Entries that are looked at, so that the message comes at once: of a folder, and of each in it.
constexpr std::size_t most_looked_at = 64, most_looked_below = 8;

std::string_view kind_of(const Path& path) {
    try {
        const std::string_view format = volume_format_of(path);
        return format.empty() && is_mesh_file(path) ? "meshes" : format;
    } catch (const Error&) {
        return {};  // the client may not open it (base/input_file.h)
    }
}

std::vector<Path> entries_of(const Path& folder, std::size_t most) {
    std::vector<Path> entries;
    std::error_code error;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        if (!entry->path().filename().string().starts_with('.')) entries.push_back(entry->path());
    }
    std::ranges::sort(entries);
    if (entries.size() > most) entries.resize(most);
    return entries;
}

// Lists what is in a folder and, unless `is_below`, what is in the folders in it.
NamesByKind contents_of(const Path& folder, bool is_below = false) {
    NamesByKind contents;
    for (const Path& entry : entries_of(folder, is_below ? most_looked_below : most_looked_at)) {
        std::error_code absent;
        const bool is_folder = std::filesystem::is_directory(entry, absent);
        const std::string name =
            one_line(shortened(entry.filename().string())) + (is_folder ? "/" : "");
        const std::string_view kind = kind_of(entry);
        NamesByKind inner;
        if (kind.empty() && is_folder && !is_below) inner = contents_of(entry, true);
        inner.erase("");
        for (const auto& [inner_kind, names] : inner)
            for (const std::string& each : names) contents[inner_kind].push_back(name + each);
        if (inner.empty()) contents[kind].push_back(name);
    }
    return contents;
}

// Returns the kinds, each with its first names: "DICOM (ct/), NRRD (a.nrrd, b.nrrd)".
std::string text_of(const NamesByKind& contents) {
    constexpr std::size_t most_examples = 3;
    std::vector<std::string> texts;
    for (const auto& [kind, names] : contents) {
        const std::span first(names.data(), std::min(names.size(), most_examples));
        texts.push_back(fmt::format("{} ({}{})", kind.empty() ? "unknown kinds" : kind,
                                    fmt::join(first, ", "),
                                    names.size() > most_examples ? ", ..." : ""));
    }
    return texts.empty() ? "nothing in it" : fmt::format("{}", fmt::join(texts, ", "));
}

// Returns the first of a folder's files if all have one extension; else nothing.
Path only_kind(const Path& folder) {
    const std::vector<Path> entries = entries_of(folder, most_looked_at);
    const auto differ = [&](const Path& entry) {
        return entry.extension() != entries[0].extension();
    };
    return entries.empty() || std::ranges::any_of(entries, differ) ? Path() : entries[0];
}

}  // namespace

void expect_no_foreign_file(const Path& path, bool is_named) {
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(path, unreadable)) return;
    if (std::filesystem::file_size(path, unreadable) == 0 && !unreadable)
        fail("{}: the file is empty", path.string());
    const std::string beginning = file_beginning(path, 512);
    const std::string extension = lower_suffix(path);
    for (const ForeignFormat& format : formats_not_read) {
        // A declaration of XML may stand in front of an element.
        const bool is_element = format.mark.starts_with('<') && beginning.starts_with('<');
        const bool is_marked =
            !format.mark.empty() && beginning.size() > format.at &&
            (std::string_view(beginning).substr(format.at).starts_with(format.mark) ||
             (is_element && beginning.find(format.mark) != beginning.npos));
        const bool has_name =
            !extension.empty() && std::string_view(format.extensions).find(" " + extension + " ") !=
                                      std::string_view::npos;
        if ((is_marked || has_name) && !(is_named && format.advice == unpack))
            fail("{}: found {}, which is not read: {}", path.string(), format.name, format.advice);
    }
}

void expect_no_folder(const Path& path) {
    std::error_code absent;
    if (!std::filesystem::is_directory(path, absent)) return;
    const NamesByKind contents = contents_of(path);
    if (const Path first = only_kind(path); !first.empty()) expect_no_foreign_file(first);
    const bool has_data = contents.size() > contents.count("");
    fail("{}: found a folder with {}, expected {}", path.string(), text_of(contents),
         has_data ? "the name of one of these" : "a volume: " + volume_format_names());
}

}  // namespace lamina
