// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "volume_files/dicom_image.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Sets the frames of an image: their places, orientations, spacings and scales, and what tells
// phases apart. columns, rows and frame_count must be set before. Throws Error.
void place_frames(const DicomElements& elements, DicomImage& image);

// Places the images of a series if no file gives a place, as in secondary captures and exports of
// microscopic CT: by SliceLocation, else in the order of InstanceNumber, and says so. Does nothing
// if these do not tell all slices apart.
void place_by_numbers(std::vector<DicomImage>& images, const std::string& name);

// Cuts a Siemens mosaic, an image that holds slices as tiles, into its slices, whose number and
// normal its CSA header has. Sets image.refusal if that is missing. Does nothing to other images.
// Throws Error if the header is damaged.
void cut_mosaic(const DicomElements& elements, DicomImage& image);

// The place of a slice, and its name in messages.
struct SlicePlace {
    glm::dvec3 position;
    std::string name;
};

// A straight line on which slices lie: the first one's place and the step from each to the next.
struct SliceLine {
    glm::dvec3 first, step;

    // Returns the slice that lies farthest off its place on the line, and how far, in mm.
    std::pair<const SlicePlace*, double> worst(const std::vector<SlicePlace>& slices) const;
};

// Fits a line to the places by least squares, and says how far it moves slices if that is more than
// rounding. Throws Error if slices are missing or lie more than 5 % of their distance off the line.
// `words`: the attribute that gives the places.
SliceLine fitted_line(const std::vector<SlicePlace>& slices, const std::string& file,
                      const char* words);

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
