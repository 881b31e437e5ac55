// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.10, section 7 (the file); PS3.3, C.7.6.3 (image pixel), C.11.1 (modality LUT).
#include "volume_files/dicom_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "base/content_hash.h"
#include "base/error.h"
#include "volume_files/byte_readers.h"
#include "volume_files/dicom_places.h"
#include "volume_files/stored_samples.h"

#ifdef LAMINA_HAS_GDCM
#include <gdcmImageReader.h>
#include <gdcmTrace.h>
#endif

namespace lamina {
namespace {

constexpr std::int64_t most_frames = 1 << 17;

#ifdef LAMINA_HAS_GDCM

// Writes a compressed image's byte_count() bytes to `to`. Throws Error, always without GDCM.
void decode_dicom(const DicomImage& image, char* to) {
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
    if (sizes[0] != image.columns || sizes[1] != image.rows || frames != image.frame_count) {
        fail("{}: found {} x {} x {} pixels, expected {} x {} x {}", name, sizes[0], sizes[1],
             frames, image.columns, image.rows, image.frame_count);
    }
    const std::size_t bytes = image.byte_count();
    const std::uint64_t there = std::filesystem::file_size(image.file);
    if (bytes / most_dicom_expansion > there || decoded.GetBufferLength() != bytes) {
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

// Returns a number of VR US or SS, read as US: it has a sign if pixels have.
double signed_if(const DicomElements& elements, double number) {
    return elements.whole(dicom_tag::pixel_sign) == 1 && number >= 1 << 15 ? number - (1 << 16)
                                                                           : number;
}

// SOP classes of objects without pixels (PS3.6, Annex A), by the beginning of their UIDs.
constexpr struct {
    std::string_view begin;
    const char *name, *advice;
} kinds_without_pixels[] = {
    {"1.2.840.10008.5.1.4.1.1.481.3", ", an RT structure set of contours",
     ": 3D Slicer saves it as a segmentation (.seg.nrrd)"},
    {"1.2.840.10008.5.1.4.1.1.481.", ", a radiotherapy plan or record", ""},
    {"1.2.840.10008.5.1.4.1.1.88.", ", a structured report", ""},
    {"1.2.840.10008.5.1.4.1.1.104.", ", a document", ""},
    {"1.2.840.10008.5.1.4.1.1.11.", ", a presentation state", ""},
    {"1.2.840.10008.5.1.4.1.1.9.", ", a waveform", ""},
    {"1.2.840.10008.5.1.4.1.1.66.5", ", surfaces", ": 3D Slicer saves them as a segmentation"},
    {"1.2.840.10008.5.1.4.1.1.66", ", a registration or raw data", ""}};

// Returns why a file is no volume, by its SOP class (PS3.6, Annex A) or its colours; else nothing.
std::string refusal_of(const DicomElements& elements) {
    const std::string kind = elements.text(dicom_tag::sop_class);
    // Segmentation and Label Map Segmentation; others of 66 (registrations, surfaces) have no
    // pixels.
    if (kind == "1.2.840.10008.5.1.4.1.1.66.4" || kind == "1.2.840.10008.5.1.4.1.1.66.7") {
        return "SOPClassUID: found a segmentation (DICOM SEG), expected an image: dcmqi's "
               "segimage2itkimage, or 3D Slicer, writes its labels to NRRD or NIfTI, which are "
               "read";
    }
    if (kind == "1.2.840.10008.5.1.4.1.1.77.1.6")
        return "SOPClassUID: found a whole-slide image, whose frames are tiles, expected slices";
    if (elements.text(dicom_tag::media_class) == "1.2.840.10008.1.3.10")
        return "found a DICOMDIR, a list of files, expected the folder that it lies in";
    if (elements.pixel_tag == 0) {
        const auto known = std::ranges::find_if(
            kinds_without_pixels, [&](const auto& one) { return kind.starts_with(one.begin); });
        return fmt::format("found no pixels (SOPClassUID {}{}), expected an image{}",
                           kind.empty() ? "is missing" : kind,
                           known == std::end(kinds_without_pixels) ? "" : known->name,
                           known == std::end(kinds_without_pixels) ? "" : known->advice);
    }
    const std::string colours = elements.text(dicom_tag::photometric);
    if (const auto samples = elements.whole(dicom_tag::samples_per_pixel); samples > 1) {
        return fmt::format(
            "SamplesPerPixel: found {} ({}), expected 1: pictures in colour are no "
            "volume",
            samples, colours);
    }
    if (colours == "PALETTE COLOR") {
        return "PhotometricInterpretation: found PALETTE COLOR, expected MONOCHROME2: pictures in "
               "colour are no volume";
    }
    return {};
}

// Reads the table that gives the values of samples: PS3.3, C.11.1.1.
void read_lut(const DicomElements& elements, DicomImage& image) {
    const auto table = dicom_tag::modality_lut;
    const std::string* const data = elements.find_in(table, 0, dicom_tag::lut_data);
    const auto form = elements.numbers_in(table, 0, dicom_tag::lut_descriptor);
    if (data == nullptr && form.empty()) return;
    const auto count = form.size() == 3 && form[0] > 0 ? static_cast<std::size_t>(form[0]) : 65536;
    if (form.size() == 3 && data != nullptr && form[2] <= 8 && data->size() < 2 * count) {
        for (const char byte : *data) image.lut.push_back(static_cast<unsigned char>(byte));
    } else {
        for (const double value : elements.numbers_in(table, 0, dicom_tag::lut_data))
            image.lut.push_back(static_cast<std::uint16_t>(value));
    }
    if (form.size() != 3 || image.lut.size() < count) {
        fail("{}: ModalityLUTSequence: found {} values, expected {} as its LUTDescriptor says",
             image.file.string(), image.lut.size(), count);
    }
    image.lut.resize(count);
    image.lut_first = signed_if(elements, form[1]);
}

// Sets type, bits, byte order and place of the pixels. Throws Error if they cannot be read.
void read_form(const DicomElements& elements, DicomImage& image) {
    const std::string name = image.file.string();
    const bool floats = elements.pixel_tag != dicom_tag::pixels;
    const std::int64_t allocated = elements.pixel_tag == dicom_tag::double_pixels
                                       ? 64
                                       : elements.whole(dicom_tag::bits_allocated);
    const bool is_signed = floats || elements.whole(dicom_tag::pixel_sign) == 1;
    if (allocated != 8 && allocated != 16 && allocated != 32 && !floats)
        fail("{}: BitsAllocated: found {}, expected 8, 16 or 32", name, allocated);
    if (floats && allocated != (elements.pixel_tag == dicom_tag::float_pixels ? 32 : 64))
        fail("{}: BitsAllocated: found {}, expected 32 for FloatPixelData", name, allocated);
    image.type = *number_type(static_cast<std::size_t>(allocated / 8), !floats, is_signed);
    image.stored_bits = floats ? allocated : elements.whole(dicom_tag::bits_stored);
    image.high_bit = floats ? allocated - 1 : elements.whole(dicom_tag::high_bit);
    if (image.stored_bits < 1 || image.stored_bits > allocated || image.high_bit >= allocated ||
        image.high_bit + 1 < image.stored_bits) {
        fail("{}: BitsStored and HighBit: found {} and {}, expected them within {} bits", name,
             image.stored_bits, image.high_bit, allocated);
    }
    image.big_endian = elements.big_endian;
    image.swapped_bytes = elements.big_endian && allocated == 8 && elements.pixel_form == "OW";
    image.transfer_syntax = elements.transfer_syntax;
    image.compressed = elements.encapsulated;
    image.pixels_begin = elements.pixels_begin;
    image.pixel_bytes = elements.pixel_bytes;
    const std::string& syntax = image.transfer_syntax;
    const bool plain = syntax == "1.2.840.10008.1.2" || syntax == "1.2.840.10008.1.2.1" ||
                       syntax == "1.2.840.10008.1.2.2";
    if (plain == image.compressed) {
        fail("{}: found pixels in {} piece with transfer syntax {}, expected {}", name,
             image.compressed ? "more than one" : "one", syntax, plain ? "one" : "several");
    }
    if (!image.compressed && image.pixel_bytes < image.byte_count()) {
        fail("{}: found {} bytes of pixels, expected {}", name, image.pixel_bytes,
             image.byte_count());
    }
    if (image.compressed &&
        static_cast<std::uint64_t>(image.frame_count) > std::filesystem::file_size(image.file)) {
        fail("{}: NumberOfFrames: found {}, more than the file has bytes", name, image.frame_count);
    }
    if (const auto from = elements.number(dicom_tag::padding); from && !floats) {
        const double to = elements.number(dicom_tag::padding_limit).value_or(*from);
        image.padding = std::minmax({signed_if(elements, *from), signed_if(elements, to)});
    }
}

// Extracts the number in the stored bits of each pixel: shifts it down and extends its sign.
template <typename Value>
void take_bits(const DicomImage& image, char* pixels, std::size_t count) {
    using Word = std::make_unsigned_t<Value>;
    const auto bits = static_cast<int>(8 * sizeof(Value));
    const int above = bits - 1 - static_cast<int>(image.high_bit);
    const int unused = bits - static_cast<int>(image.stored_bits);
    for (std::size_t i = 0; i < count; ++i) {
        Word word;
        std::memcpy(&word, pixels + i * sizeof(Word), sizeof(Word));
        const auto high = static_cast<Value>(static_cast<Word>(word << above));
        const auto value = static_cast<Value>(high >> unused);
        std::memcpy(pixels + i * sizeof(Word), &value, sizeof(Value));
    }
}

// Turns pixels as they lie in the file into numbers of image.type in native byte order.
void normalize(const DicomImage& image, char* pixels, std::size_t count) {
    const std::size_t bytes = bytes_of(image.type);
    const bool big = std::endian::native == std::endian::big;
    // In one thread: an isolated process starts no others (volume_files/isolated_process.h).
    for (std::size_t i = 0; i < count && image.big_endian != big; ++i)
        std::reverse(pixels + i * bytes, pixels + (i + 1) * bytes);
    if (image.swapped_bytes) {
        for (std::size_t i = 0; i + 1 < count; i += 2) std::swap(pixels[i], pixels[i + 1]);
    }
    if (image.stored_bits == static_cast<std::int64_t>(8 * bytes)) return;
    with_type(image.type, [&](auto zero) {
        if constexpr (std::is_integral_v<decltype(zero)>)
            take_bits<decltype(zero)>(image, pixels, count);
    });
}

// Returns the bytes of a frame in its file. Compressed pixels are those up to the end of their
// file.
std::string stored_pixels(const DicomImage& image, const DicomFrame& frame) {
    const std::size_t bytes = image.frame_bytes();
    const std::size_t before = image.compressed ? 0 : static_cast<std::size_t>(frame.index) * bytes;
    const OpenedFile file =
        open_to_read(image.file, static_cast<std::int64_t>(image.pixels_begin + before));
    std::string pixels(image.compressed ? bytes_left(file.get()) : bytes, '\0');
    pixels.resize(std::fread(pixels.data(), 1, pixels.size(), file.get()));
    return pixels;
}

}  // namespace

std::optional<DicomImage> read_dicom_image(const std::filesystem::path& file) {
    if (!has_dicom_mark(file)) return {};
    const DicomElements elements = read_dicom_elements(file);
    DicomImage image;
    image.file = file;
    image.series = elements.text(dicom_tag::series);
    image.description = elements.text(dicom_tag::series_description);
    image.instance_uid = elements.text(dicom_tag::sop_instance);
    image.rows = image.slice_rows = elements.whole(dicom_tag::rows);
    image.columns = image.slice_columns = elements.whole(dicom_tag::columns);
    const bool has_size = image.rows > 0 && image.columns > 0;
    if (has_size && elements.pixel_tag == 0)
        fail("{}: found no pixels before its end", file.string());
    image.refusal = refusal_of(elements);
    if (!image.refusal.empty()) return image;
    if (!has_size)
        fail("{}: found {} x {} pixels, expected some", file.string(), image.columns, image.rows);
    const double frames = elements.number(dicom_tag::frame_count).value_or(1);
    if (!(frames >= 1 && frames <= most_frames)) {
        fail("{}: NumberOfFrames: found {}, expected 1 to {}", file.string(), frames, most_frames);
    }
    image.frame_count = static_cast<std::int64_t>(frames);
    image.number = elements.number(dicom_tag::instance_number);
    image.location = elements.number(dicom_tag::slice_location);
    image.is_localizer =
        elements.text(dicom_tag::image_type).find("LOCALIZER") != std::string::npos;
    // Either says how an image is shown (PS3.3, C.7.6.3.1.2 and C.11.6.1.2), which a warning tells.
    if (elements.text(dicom_tag::photometric) == "MONOCHROME1")
        image.inverse = "PhotometricInterpretation MONOCHROME1";
    else if (elements.text(dicom_tag::lut_shape) == "INVERSE")
        image.inverse = "PresentationLUTShape INVERSE";
    read_form(elements, image);
    read_lut(elements, image);
    place_frames(elements, image);
    return image;
}

DicomPixels::DicomPixels(const DicomImage& image) : image_(image) {
    if (!image.compressed || image.frame_count == 1) return;
    decoded_.resize(image.byte_count());
    decode_dicom(image, decoded_.data());
}

void DicomPixels::read(std::int64_t frame, char* to) const {
    const std::size_t bytes = image_.frame_bytes();
    const std::size_t begin = static_cast<std::size_t>(frame) * bytes;
    if (!decoded_.empty()) {
        std::memcpy(to, decoded_.data() + begin, bytes);
        return;
    }
    if (image_.compressed) return decode_dicom(image_, to);
    const OpenedFile file =
        open_to_read(image_.file, static_cast<std::int64_t>(image_.pixels_begin + begin));
    const std::size_t found = std::fread(to, 1, bytes, file.get());
    if (found != bytes)
        fail("{}: found {} bytes of pixels, expected {}", image_.file.string(), found, bytes);
    normalize(image_, to, bytes / bytes_of(image_.type));
}

std::optional<std::uint64_t> pixel_hash(const DicomImage& image, const DicomFrame& frame) {
    if (image.compressed && image.frame_count > 1) return {};
    ContentHash hash;
    hash.add(stored_pixels(image, frame));
    return hash.word();
}

bool same_pixels(const DicomImage& a, const DicomFrame& in_a, const DicomImage& b,
                 const DicomFrame& in_b) {
    return a.compressed == b.compressed && a.frame_bytes() == b.frame_bytes() &&
           stored_pixels(a, in_a) == stored_pixels(b, in_b);
}

}  // namespace lamina
