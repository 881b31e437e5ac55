// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom_codec.h"

#include "base/error.h"

#ifdef LAMINA_HAS_GDCM
#include <gdcmImageReader.h>
#include <gdcmTrace.h>
#endif

namespace lamina {

#ifdef LAMINA_HAS_GDCM

void decode_dicom(const DicomImage& image, char* to) {
    constexpr std::uint64_t most_expansion = 1 << 16;
    const std::string name = image.file.string();
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::ImageReader reader;
    reader.SetFileName(name.c_str());
    if (!reader.Read()) fail("{}: truncated or damaged DICOM image", name);
    const gdcm::Image& decoded = reader.GetImage();
    const unsigned* const sizes = decoded.GetDimensions();
    const std::int64_t frames = decoded.GetNumberOfDimensions() > 2 ? sizes[2] : 1;
    if (sizes[0] != image.columns || sizes[1] != image.rows || frames != image.frames) {
        fail("{}: found {} x {} x {} pixels, expected {} x {} x {}", name, sizes[0], sizes[1],
             frames, image.columns, image.rows, image.frames);
    }
    const std::size_t bytes = image.byte_count();
    const std::uint64_t there = std::filesystem::file_size(image.file);
    if (bytes / most_expansion > there || decoded.GetBufferLength() != bytes) {
        fail("{}: the header promises {} bytes of pixels, decoded are {}, of {} in the file", name,
             bytes, decoded.GetBufferLength(), there);
    }
    if (!decoded.GetBuffer(to)) fail("{}: damaged pixels", name);
}

#else

void decode_dicom(const DicomImage& image, char* /*to*/) {
    fail(
        "{}: found compressed pixels (transfer syntax {}), expected others: this build has no GDCM",
        image.file.string(), image.transfer_syntax);
}

#endif

}  // namespace lamina
