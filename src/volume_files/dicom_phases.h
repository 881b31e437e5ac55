// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "volume_files/dicom_image.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Returns the values of the attributes that may tell phases apart (DicomFrame::phase).
std::vector<std::pair<std::size_t, double>> phase_of(const DicomElements& elements,
                                                     std::size_t frame, std::size_t frames);

// A slice of a series: a frame of an image.
struct DicomSlice {
    const DicomImage* image;
    const DicomFrame* frame;

    std::string name() const;  // the file's, and the frame's number if the file has several
};

// Returns, of the slices at each place, the one of the time that the request names. `places` are
// the slices in order of their places. Slices that are at one place twice are taken once. Throws
// Error if places have different numbers of slices, or if nothing tells those at one place apart.
std::vector<DicomSlice> slices_of_time(std::vector<std::vector<DicomSlice>> places,
                                       const std::string& file, const VolumeRequest& request,
                                       VolumeContents* contents);

}  // namespace lamina
