// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.10, section 7 (the file); PS3.5, section 7 (the data set); PS3.3, C.7.6.2 (image
// plane), C.7.6.3 (image pixel), C.11.1 (rescale).
#include "volume_files/dicom_image.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/byte_readers.h"
#include "volume_files/stored_samples.h"

#ifdef LAMINA_HAS_GDCM
#include <gdcmImageReader.h>
#include <gdcmTrace.h>
#endif

namespace lamina {
namespace {

// A data element's group and number: 0x00280010 is (0028,0010).
using DicomTag = std::uint32_t;

// Returns the numbers of a text, separated by backslashes; none if it holds anything else.
std::vector<double> dicom_numbers(std::string_view text) {
    const std::size_t last = text.find_last_not_of(std::string_view(" \0", 2));
    text = text.substr(0, last == std::string_view::npos ? 0 : last + 1);
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        while (at < end && (*at == ' ' || *at == '+')) ++at;
        double number = 0;
        const auto [stop, problem] = std::from_chars(at, end, number);
        if (problem != std::errc{} || !std::isfinite(number)) return {};
        numbers.push_back(number);
        at = stop;
        while (at < end && *at == ' ') ++at;
        if (at == end) break;
        if (*at++ != '\\') return {};
    }
    return numbers;
}

// The contents of a DICOM file, without its pixels.
struct DicomElements {
    std::string transfer_syntax;
    bool big_endian = false;    // byte order of the data set
    bool encapsulated = false;  // the pixels are compressed
    // Values of the elements in kept_tags. `values`: those outside of sequences. `shared`: the
    // first ones in the sequences for all frames or for each frame (shared_groups, frame_groups).
    std::map<DicomTag, std::string> values, shared;
    std::vector<std::string> frame_positions;  // ImagePositionPatient of each frame
    std::uint64_t pixels_begin = 0;            // offset in the file
    std::uint64_t pixel_bytes = 0;             // 0 if they are encapsulated
    std::string pixel_form;                    // VR of the pixels: "OB", "OW"

    // Returns the element's value outside of sequences, else that in `shared`, else an empty text.
    std::string text(DicomTag tag) const {
        for (const auto* const map : {&values, &shared}) {
            if (const auto found = map->find(tag); found != map->end()) return found->second;
        }
        return {};
    }

    std::vector<double> numbers(DicomTag tag) const { return dicom_numbers(text(tag)); }

    double number(DicomTag tag, double otherwise) const {
        const auto found = numbers(tag);
        return found.size() == 1 ? found[0] : otherwise;
    }

    // Returns the whole number in an element of two bytes (VR US); 0 if the file lacks it.
    std::int64_t whole(DicomTag tag) const {
        const std::string word = text(tag);
        if (word.size() < 2) return 0;
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(word[i]); };
        return big_endian ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0);
    }
};

constexpr DicomTag transfer_syntax_tag = 0x00020010, pixel_data_tag = 0x7fe00010,
                   item_tag = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd,
                   shared_groups = 0x52009229, frame_groups = 0x52009230;
constexpr DicomTag series_description = 0x0008103e, slice_thickness = 0x00180050,
                   slice_spacing = 0x00180088, series_uid = 0x0020000e,
                   instance_number = 0x00200013, image_position = 0x00200032,
                   image_orientation = 0x00200037, samples_per_pixel = 0x00280002,
                   frame_count = 0x00280008, row_count = 0x00280010, column_count = 0x00280011,
                   pixel_spacing = 0x00280030, bits_allocated = 0x00280100,
                   bits_stored = 0x00280101, highest_bit = 0x00280102, pixel_sign = 0x00280103,
                   rescale_intercept = 0x00281052, rescale_slope = 0x00281053;
constexpr DicomTag kept_tags[] = {
    series_description, slice_thickness,   slice_spacing,     series_uid,  instance_number,
    image_position,     image_orientation, samples_per_pixel, frame_count, row_count,
    column_count,       pixel_spacing,     bits_allocated,    bits_stored, highest_bit,
    pixel_sign,         rescale_intercept, rescale_slope};
constexpr std::uint32_t undefined = 0xffffffff;  // length: up to a delimiter
constexpr int most_depth = 16;                   // of sequences in sequences
constexpr std::size_t most_frames = 1 << 20;

// Reads the elements of a file up to its pixels. Throws Error if it is truncated or damaged.
class ElementReader {
  public:
    explicit ElementReader(const std::filesystem::path& path)
        : name_(path.string()), file_(open_to_read(path)), left_(bytes_left(file_.get())) {}

    DicomElements read() {
        skip(132);  // the preamble of 128 bytes and "DICM"
        while (left_ > 0 && !found_pixels_) read_element(0, 0);
        if (!found_pixels_) fail("{}: found no pixels before its end", name_);
        return std::move(elements_);
    }

  private:
    struct Element {
        DicomTag tag = 0;
        std::string form;  // VR; empty if it is implicit
        std::uint32_t length = 0;
    };

    [[noreturn]] void fail_at(const Element& element, std::uint64_t found) const {
        fail("{}: truncated or damaged: element ({:04x},{:04x}) has {} bytes, the file {} more",
             name_, element.tag >> 16, element.tag & 0xffff, element.length, found);
    }

    void expect(std::uint64_t count) const {
        if (count > left_)
            fail("{}: truncated: found {} bytes more, expected {}", name_, left_, count);
    }

    void skip(std::uint64_t count) {
        expect(count);
        fseeko(file_.get(), static_cast<off_t>(count), SEEK_CUR);
        left_ -= count;
    }

    void step_back() {
        fseeko(file_.get(), -4, SEEK_CUR);
        left_ += 4;
    }

    std::string bytes(std::size_t count) {
        expect(count);
        std::string text(count, '\0');
        if (std::fread(text.data(), 1, count, file_.get()) != count)
            fail("{}: cannot be read", name_);
        left_ -= count;
        return text;
    }

    std::uint32_t number(std::size_t count) {
        const std::string word = bytes(count);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t at = big_endian_ ? i : count - 1 - i;
            value = value << 8 | static_cast<unsigned char>(word[at]);
        }
        return value;
    }

    DicomTag read_tag() {
        const std::uint32_t group = number(2);
        return group << 16 | number(2);
    }

    // Reads tag, VR and length of an element. Elements of group 2 have explicit VRs and
    // little-endian numbers; those after them are coded as the transfer syntax says.
    Element read_head(int depth) {
        Element element;
        element.tag = read_tag();
        if (depth == 0 && in_meta_ && element.tag >> 16 != 2) {
            in_meta_ = false;
            step_back();
            take_syntax();
            element.tag = read_tag();
        }
        if (element.tag >> 16 == 0xfffe || !explicit_) {
            element.length = number(4);
            return element;
        }
        element.form = bytes(2);
        static constexpr std::string_view long_forms = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
        if (long_forms.find(element.form) != std::string_view::npos) {
            skip(2);
            element.length = number(4);
        } else {
            const auto upper = [](char c) { return c >= 'A' && c <= 'Z'; };
            if (!std::ranges::all_of(element.form, upper)) {
                fail(
                    "{}: damaged: element ({:04x},{:04x}) has the form '{}', expected two capitals",
                    name_, element.tag >> 16, element.tag & 0xffff, one_line(element.form));
            }
            element.length = number(2);
        }
        return element;
    }

    // Sets explicit_ and big_endian_ by the transfer syntax. Throws Error if that cannot be read.
    void take_syntax() {
        const std::string& syntax = elements_.transfer_syntax;
        if (syntax == "1.2.840.10008.1.2") {
            explicit_ = false;
        } else if (syntax == "1.2.840.10008.1.2.2") {
            big_endian_ = elements_.big_endian = true;
        } else if (syntax == "1.2.840.10008.1.2.1.99" || !syntax.starts_with("1.2.840.10008.1.2")) {
            fail("{}: transfer syntax: found '{}', expected one of images that is not deflated",
                 name_, one_line(syntax));
        }
    }

    // Reads an element. `sequence`: the tag of the outermost sequence that holds it; 0: none does.
    void read_element(int depth, DicomTag sequence) {
        const Element element = read_head(depth);
        if (element.tag == pixel_data_tag && depth == 0) {
            found_pixels_ = true;
            elements_.pixel_form = element.form.empty() ? "OW" : element.form;
            elements_.encapsulated = element.length == undefined;
            elements_.pixels_begin = static_cast<std::uint64_t>(ftello(file_.get()));
            if (elements_.encapsulated) return;
            if (element.length > left_) fail_at(element, left_);
            elements_.pixel_bytes = element.length;
            return;
        }
        const bool groups = element.tag == shared_groups || element.tag == frame_groups;
        if (element.form == "SQ" || element.length == undefined || (groups && depth == 0)) {
            read_sequence(element, depth + 1, depth == 0 ? element.tag : sequence);
            return;
        }
        if (element.length > left_) fail_at(element, left_);
        keep_or_skip(element, depth, sequence);
    }

    // Keeps the value of an element in kept_tags (DicomElements::values, shared); skips others.
    void keep_or_skip(const Element& element, int depth, DicomTag sequence) {
        constexpr std::uint32_t most_bytes = 1 << 12;
        const bool kept = std::ranges::count(kept_tags, element.tag) > 0;
        const bool wanted =
            element.tag == transfer_syntax_tag ||
            (kept && (depth == 0 || sequence == shared_groups || sequence == frame_groups));
        if (!wanted || element.length > most_bytes) return skip(element.length);
        std::string value = bytes(element.length);
        if (element.tag == transfer_syntax_tag) {
            elements_.transfer_syntax =
                value.substr(0, value.find_last_not_of(std::string(" \0", 2)) + 1);
        } else if (depth == 0) {
            elements_.values[element.tag] = std::move(value);
        } else if (sequence == frame_groups && element.tag == image_position) {
            if (elements_.frame_positions.size() >= most_frames)
                fail("{}: found more than {} frames", name_, most_frames);
            elements_.frame_positions.push_back(std::move(value));
        } else {
            elements_.shared.emplace(element.tag, std::move(value));  // the first frame's is kept
        }
    }

    // Reads the items of a sequence, each of elements. `top`: the tag of the outermost sequence.
    void read_sequence(const Element& sequence, int depth, DicomTag top) {
        if (depth > most_depth) fail("{}: found sequences more than {} deep", name_, most_depth);
        if (sequence.length != undefined && sequence.length > left_) fail_at(sequence, left_);
        const bool was_explicit = explicit_;
        if (sequence.form == "UN") explicit_ = false;  // inside, VRs are implicit: PS3.5, 6.2.2
        const std::uint64_t end = sequence.length == undefined ? 0 : left_ - sequence.length;
        while (sequence.length == undefined || left_ > end) {
            const Element item = read_head(depth);
            if (item.tag == sequence_end) break;
            if (item.tag != item_tag) {
                fail("{}: damaged: found element ({:04x},{:04x}) in a sequence, expected an item",
                     name_, item.tag >> 16, item.tag & 0xffff);
            }
            read_item(item, depth, top);
        }
        explicit_ = was_explicit;
        if (sequence.length != undefined && left_ != end) fail_at(sequence, left_);
    }

    void read_item(const Element& item, int depth, DicomTag top) {
        if (item.length != undefined && item.length > left_) fail_at(item, left_);
        const std::uint64_t end = item.length == undefined ? 0 : left_ - item.length;
        while (item.length == undefined || left_ > end) {
            if (item.length == undefined && at_item_end()) return;
            read_element(depth, top);
        }
        if (item.length != undefined && left_ != end) fail_at(item, left_);
    }

    // Tells if an item of undefined length ends here, and then moves past its end.
    bool at_item_end() {
        const DicomTag tag = read_tag();
        if (tag == item_end) {
            skip(4);
            return true;
        }
        step_back();
        return false;
    }

    std::string name_;
    OpenedFile file_;
    std::uint64_t left_;  // bytes from here to the end of the file
    bool in_meta_ = true, explicit_ = true, big_endian_ = false;
    bool found_pixels_ = false;
    DicomElements elements_;
};

#ifdef LAMINA_HAS_GDCM

// Writes a compressed image's byte_count() bytes to `to`. Throws Error, always without GDCM.
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

std::optional<glm::dvec3> place_of(const std::vector<double>& numbers) {
    if (numbers.size() != 3) return {};
    return glm::dvec3(numbers[0], numbers[1], numbers[2]);
}

std::string trimmed(const std::string& text) {
    const std::size_t end = text.find_last_not_of(std::string(" \0", 2));
    return end == std::string::npos ? "" : one_line(text.substr(0, end + 1));
}

// Sets position, orientation and spacing of an image. Throws Error if these are invalid.
void read_place(const DicomElements& elements, DicomImage& image) {
    image.position = place_of(elements.numbers(image_position));
    for (const std::string& text : elements.frame_positions) {
        if (const auto place = place_of(dicom_numbers(text)))
            image.frame_positions.push_back(*place);
    }
    if (!image.position && !image.frame_positions.empty())
        image.position = image.frame_positions.front();
    if (const auto v = elements.numbers(image_orientation); v.size() == 6) {
        image.along_row = {v[0], v[1], v[2]};
        image.along_column = {v[3], v[4], v[5]};
    }
    const double row_length = glm::length(image.along_row),
                 column_length = glm::length(image.along_column),
                 cosine = glm::dot(image.along_row, image.along_column);
    if (!(std::abs(row_length - 1) < 1e-2 && std::abs(column_length - 1) < 1e-2 &&
          std::abs(cosine) < 1e-2)) {
        fail(
            "{}: ImageOrientationPatient: found {}, expected two vectors of length 1 at a right "
            "angle",
            image.file.string(), trimmed(elements.text(image_orientation)));
    }
    const auto spacing = elements.numbers(pixel_spacing);  // between rows, then between columns
    if (spacing.size() == 2) image.spacing = {spacing[1], spacing[0], 1};
    if (!(image.spacing.x > 0 && image.spacing.y > 0)) {
        fail("{}: PixelSpacing: found {}, expected numbers above 0", image.file.string(),
             trimmed(elements.text(pixel_spacing)));
    }
    const double thickness = elements.number(slice_thickness, 1);
    image.spacing.z = std::abs(elements.number(slice_spacing, thickness));
    if (image.spacing.z == 0) image.spacing.z = 1;
}

// Sets type, bits, byte order and place of the pixels. Throws Error if they cannot be read.
void read_form(const DicomElements& elements, DicomImage& image) {
    const std::string name = image.file.string();
    if (const auto samples = elements.whole(samples_per_pixel); samples > 1) {
        fail("{}: SamplesPerPixel: found {}, expected 1: pictures in colour are no volume", name,
             samples);
    }
    const std::int64_t allocated = elements.whole(bits_allocated);
    const bool is_signed = elements.whole(pixel_sign) == 1;
    if (allocated != 8 && allocated != 16 && allocated != 32)
        fail("{}: BitsAllocated: found {}, expected 8, 16 or 32", name, allocated);
    image.type = *number_type(static_cast<std::size_t>(allocated / 8), true, is_signed);
    image.stored_bits = elements.whole(bits_stored);
    image.high_bit = elements.whole(highest_bit);
    if (image.stored_bits < 1 || image.stored_bits > allocated || image.high_bit >= allocated ||
        image.high_bit + 1 < image.stored_bits) {
        fail("{}: BitsStored and HighBit: found {} and {}, expected them within {} bits", name,
             image.stored_bits, image.high_bit, allocated);
    }
    image.big_endian = elements.big_endian;
    image.swapped_bytes = elements.big_endian && allocated == 8 && elements.pixel_form == "OW";
    image.transfer_syntax = trimmed(elements.transfer_syntax);
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

}  // namespace

bool has_dicom_mark(const std::filesystem::path& file) {
    return file_beginning(file, 132).find("DICM", 128) == 128;
}

std::optional<DicomImage> read_dicom_image(const std::filesystem::path& file) {
    if (!has_dicom_mark(file)) return {};
    const DicomElements elements = ElementReader(file).read();
    DicomImage image;
    image.file = file;
    image.series = trimmed(elements.text(series_uid));
    image.description = trimmed(elements.text(series_description));
    image.rows = elements.whole(row_count);
    image.columns = elements.whole(column_count);
    if (image.rows == 0 || image.columns == 0)
        fail("{}: found {} x {} pixels, expected some", file.string(), image.columns, image.rows);
    const double number = elements.number(instance_number, 0);
    if (std::abs(number) < 1e15) image.instance = static_cast<std::int64_t>(number);
    const double frames = elements.number(frame_count, 1);
    if (!(frames >= 1 && frames <= (1 << 20)))
        fail("{}: NumberOfFrames: found {}, expected 1 to {}", file.string(), frames, 1 << 20);
    image.frames = static_cast<std::int64_t>(frames);
    image.slope = elements.number(rescale_slope, 1);
    image.intercept = elements.number(rescale_intercept, 0);
    if (image.slope == 0) fail("{}: RescaleSlope: found 0, expected another number", file.string());
    read_place(elements, image);
    read_form(elements, image);
    return image;
}

void read_dicom_pixels(const DicomImage& image, char* to) {
    if (image.compressed) return decode_dicom(image, to);
    const OpenedFile file = open_to_read(image.file, static_cast<std::int64_t>(image.pixels_begin));
    const std::size_t bytes = image.byte_count();
    const std::size_t found = std::fread(to, 1, bytes, file.get());
    if (found != bytes)
        fail("{}: found {} bytes of pixels, expected {}", image.file.string(), found, bytes);
    normalize(image, to, bytes / bytes_of(image.type));
}

}  // namespace lamina
