// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom_elements.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <span>

#include "base/error.h"
#include "base/input_file.h"
#include "base/value_type.h"
#include "volume_files/byte_readers.h"

namespace lamina {
namespace {

namespace tags = dicom_tag;

constexpr DicomTag item_tag = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd;

// The elements that are kept, by how they code numbers: as text (VR DS, IS), as the digits of a
// time (TM, DT), or in binary of 2 (US, SS, AT), 4 (UL) or 8 bytes (FD).
constexpr DicomTag as_text[] = {tags::media_class,
                                tags::transfer_syntax,
                                tags::image_type,
                                tags::sop_class,
                                tags::sop_instance,
                                tags::series_description,
                                tags::slice_thickness,
                                tags::echo_time,
                                tags::echo_numbers,
                                tags::inversion_time,
                                tags::flip_angle,
                                tags::slice_spacing,
                                tags::trigger_time,
                                tags::imager_pixel_spacing,
                                tags::slice_locations,
                                tags::scanned_pixel_spacing,
                                tags::series,
                                tags::acquisition_number,
                                tags::instance_number,
                                tags::position,
                                tags::orientation,
                                tags::slice_location,
                                tags::temporal_identifier,
                                tags::photometric,
                                tags::frame_count,
                                tags::pixel_spacing,
                                tags::aspect_ratio,
                                tags::rescale_intercept,
                                tags::rescale_slope,
                                tags::csa_header,
                                tags::lut_shape,
                                tags::frame_offsets,
                                tags::dose_scale};
constexpr DicomTag as_time[] = {tags::acquisition_time, tags::frame_acquisition};
constexpr DicomTag as_us[] = {tags::mosaic_images,
                              tags::frame_acquisition_number,
                              tags::region_units_x,
                              tags::region_units_y,
                              tags::samples_per_pixel,
                              tags::frame_pointer,
                              tags::rows,
                              tags::columns,
                              tags::bits_allocated,
                              tags::bits_stored,
                              tags::high_bit,
                              tags::pixel_sign,
                              tags::padding,
                              tags::padding_limit,
                              tags::lut_descriptor,
                              tags::lut_data,
                              tags::time_slots,
                              tags::energy_windows,
                              tags::slice_vector};
constexpr DicomTag as_ul[] = {tags::temporal_index, tags::dimension_values};
constexpr DicomTag as_fd[] = {
    tags::effective_echo_time,  tags::diffusion_b,      tags::mosaic_normal, tags::trigger_delay,
    tags::real_world_intercept, tags::real_world_slope, tags::region_width,  tags::region_height};

// The kept elements that may be longer than others.
constexpr DicomTag long_elements[] = {tags::slice_locations, tags::csa_header,   tags::lut_data,
                                      tags::frame_offsets,   tags::slice_vector, tags::time_slots,
                                      tags::energy_windows};

// Sequences whose items are kept, and those inside them that hold what is used. In data sets with
// implicit VRs only their tags tell that they are sequences.
constexpr DicomTag kept_sequences[] = {tags::shared_groups, tags::frame_groups,   tags::detectors,
                                       tags::modality_lut,  tags::real_world_map, tags::regions};
constexpr DicomTag inner_sequences[] = {0x00189114,  // MR echo
                                        0x00189117,  // MR diffusion
                                        0x00189118,  // cardiac synchronization
                                        0x00209111,  // frame content
                                        0x00209113,  // plane position
                                        0x00209116,  // plane orientation
                                        0x00289110,  // pixel measures
                                        0x00289145,  // pixel value transformation
                                        tags::real_world_map};

bool is_in(std::span<const DicomTag> some, DicomTag tag) {
    return std::ranges::find(some, tag) != some.end();
}

bool is_kept(DicomTag tag) {
    return is_in(as_text, tag) || is_in(as_time, tag) || is_in(as_us, tag) || is_in(as_ul, tag) ||
           is_in(as_fd, tag);
}

const std::string* value_in(const DicomItem& item, DicomTag tag) {
    const auto found =
        std::ranges::find(item, tag, [](const auto& element) { return element.first; });
    return found == item.end() ? nullptr : &found->second;
}

constexpr std::uint32_t undefined = 0xffffffff;  // length: up to a delimiter
constexpr int most_depth = 16;                   // of sequences in sequences
constexpr std::size_t most_items = 1 << 17;      // of one sequence

// How a file begins, and the transfer syntax of one without group 2.
struct DicomStart {
    std::uint64_t first = 0;  // byte of the first element
    const char* syntax = nullptr;
};

std::optional<DicomStart> start_of(const std::filesystem::path& file) {
    using namespace std::string_view_literals;
    const std::string bytes = file_beginning(file, 132);
    if (bytes.find("DICM", 128) == 128) return DicomStart{132};
    if (bytes.starts_with("\2\0\0\0UL\4\0"sv)) return DicomStart{};
    if (bytes.size() < 8 || !bytes.starts_with("\x08\0"sv) || bytes[3] != 0) return {};
    const std::string_view form(bytes.data() + 4, 2);
    if (form == "UL" || form == "CS" || form == "UI" || form == "DA")
        return DicomStart{0, "1.2.840.10008.1.2.1"};
    // The length of an implicit element: that of a group length, a character set or an image type.
    if (form[0] >= 4 && form[0] <= 64 && form[1] == 0 && bytes[6] == 0 && bytes[7] == 0)
        return DicomStart{0, "1.2.840.10008.1.2"};
    return {};
}

// Reads the elements of a file up to its pixels.
class ElementReader {
  public:
    explicit ElementReader(const std::filesystem::path& path)
        : name_(path.string()), file_(open_to_read(path)), left_(bytes_left(file_.get())) {}

    DicomElements read() {
        const DicomStart start = start_of(name_).value_or(DicomStart{});
        skip(start.first);
        if (start.syntax != nullptr) {
            elements_.transfer_syntax = start.syntax;
            in_meta_ = false;
            take_syntax();
        }
        while (left_ > 0 && elements_.pixel_tag == 0) read_element(0, &elements_.values);
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
        return static_cast<std::uint32_t>(number_of_bytes(bytes(count), big_endian_));
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
        } else if (syntax == "1.2.840.10008.1.2.1.99") {
            fail(
                "{}: transfer syntax: found '{}' (deflated), expected one that is not: DCMTK's "
                "dcmconv +te writes the file so",
                name_, syntax);
        } else if (!syntax.starts_with("1.2.840.10008.1.2")) {
            fail("{}: transfer syntax: found '{}', expected one of DICOM images", name_,
                 one_line(syntax));
        }
    }

    // Reads an element. `item`: what keeps it; null: nothing does.
    void read_element(int depth, DicomItem* item) {
        const Element element = read_head(depth);
        const bool outside = depth == 0;
        if (outside && (element.tag == tags::pixels || element.tag == tags::float_pixels ||
                        element.tag == tags::double_pixels)) {
            elements_.pixel_tag = element.tag;
            elements_.pixel_form = element.form.empty() ? "OW" : element.form;
            elements_.encapsulated = element.length == undefined;
            elements_.pixels_begin = static_cast<std::uint64_t>(ftello(file_.get()));
            if (elements_.encapsulated) return;
            if (element.length > left_) fail_at(element, left_);
            elements_.pixel_bytes = element.length;
            return;
        }
        const bool kept = outside && is_in(kept_sequences, element.tag);
        const bool inner = !outside && is_in(inner_sequences, element.tag);
        if (element.form == "SQ" || element.length == undefined || kept || inner) {
            const bool is_private = (element.tag >> 16) % 2 == 1;
            read_sequence(element, depth + 1, outside || is_private ? nullptr : item,
                          kept ? &elements_.items[element.tag] : nullptr);
            return;
        }
        if (element.length > left_) fail_at(element, left_);
        keep_or_skip(element, item);
    }

    void keep_or_skip(const Element& element, DicomItem* item) {
        // Those of each frame are short, so that many frames do not take long.
        const std::uint32_t most_bytes = is_in(long_elements, element.tag) ? 1 << 20 : 1 << 10;
        if (item == nullptr || !is_kept(element.tag) || element.length > most_bytes)
            return skip(element.length);
        if (value_in(*item, element.tag) != nullptr) return skip(element.length);
        item->emplace_back(element.tag, bytes(element.length));
        if (element.tag == tags::transfer_syntax)
            elements_.transfer_syntax = elements_.text(element.tag);
    }

    // Reads the items of a sequence. Their elements go to new items of `items`, else to `item`.
    void read_sequence(const Element& sequence, int depth, DicomItem* item,
                       std::vector<DicomItem>* items) {
        if (depth > most_depth) fail("{}: found sequences more than {} deep", name_, most_depth);
        if (sequence.length != undefined && sequence.length > left_) fail_at(sequence, left_);
        const bool was_explicit = explicit_;
        if (sequence.form == "UN") explicit_ = false;  // inside, VRs are implicit: PS3.5, 6.2.2
        const std::uint64_t end = sequence.length == undefined ? 0 : left_ - sequence.length;
        while (sequence.length == undefined || left_ > end) {
            const Element head = read_head(depth);
            if (head.tag == sequence_end) break;
            if (head.tag != item_tag) {
                fail("{}: damaged: found element ({:04x},{:04x}) in a sequence, expected an item",
                     name_, head.tag >> 16, head.tag & 0xffff);
            }
            if (items != nullptr && items->size() >= most_items)
                fail("{}: found a sequence of more than {} items", name_, most_items);
            read_item(head, depth, items != nullptr ? &items->emplace_back() : item);
        }
        explicit_ = was_explicit;
        if (sequence.length != undefined && left_ != end) fail_at(sequence, left_);
    }

    void read_item(const Element& head, int depth, DicomItem* item) {
        if (head.length != undefined && head.length > left_) fail_at(head, left_);
        const std::uint64_t end = head.length == undefined ? 0 : left_ - head.length;
        while (head.length == undefined || left_ > end) {
            if (head.length == undefined && at_item_end()) return;
            read_element(depth, item);
        }
        if (head.length != undefined && left_ != end) fail_at(head, left_);
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
    DicomElements elements_;
};

// Returns the numbers of a binary value; none unless it consists of whole words.
std::vector<double> binary_numbers(ValueType type, std::string_view bytes, bool big_endian) {
    if (bytes.size() % bytes_of(type) != 0) return {};
    auto numbers =
        values_from_bytes<double>(type, bytes.data(), bytes.size() / bytes_of(type),
                                  big_endian != (std::endian::native == std::endian::big));
    const auto is_finite = [](double number) { return std::isfinite(number); };
    return std::ranges::all_of(numbers, is_finite) ? numbers : std::vector<double>();
}

// Returns the digits of a time as a number, such as 93015.5 for "093015.5". From those of a date
// and time, "20261129093015.5+0100", it leaves out century and zone, so that a double holds the
// fraction.
std::vector<double> time_of(std::string_view text) {
    const std::size_t whole = std::min(text.find_first_not_of("0123456789"), text.size());
    if (whole > 8) text.remove_prefix(2);
    double number = 0;
    const auto problem =
        std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed)
            .ec;
    return problem == std::errc{} ? std::vector{number} : std::vector<double>{};
}

}  // namespace

bool has_dicom_mark(const std::filesystem::path& file) {
    return start_of(file).has_value();
}

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

const std::string* DicomElements::find_in(DicomTag sequence, std::size_t item, DicomTag tag) const {
    const auto found = items.find(sequence);
    if (found == items.end() || item >= found->second.size()) return nullptr;
    return value_in(found->second[item], tag);
}

const std::string* DicomElements::find(DicomTag tag, std::size_t frame) const {
    if (const auto* const own = find_in(tags::frame_groups, frame, tag)) return own;
    if (const auto* const shared = find_in(tags::shared_groups, 0, tag)) return shared;
    return value_in(values, tag);
}

std::string DicomElements::text(DicomTag tag, std::size_t frame) const {
    const std::string* const found = find(tag, frame);
    if (found == nullptr) return {};
    const std::size_t end = found->find_last_not_of(std::string(" \0", 2));
    return end == std::string::npos ? "" : one_line(found->substr(0, end + 1));
}

std::vector<double> DicomElements::numbers_of(DicomTag tag, const std::string* value) const {
    if (value == nullptr) return {};
    if (is_in(as_us, tag)) return binary_numbers(ValueType::uint16, *value, big_endian);
    if (is_in(as_ul, tag)) return binary_numbers(ValueType::uint32, *value, big_endian);
    if (is_in(as_fd, tag)) return binary_numbers(ValueType::float64, *value, big_endian);
    return is_in(as_time, tag) ? time_of(*value) : dicom_numbers(*value);
}

std::vector<double> DicomElements::numbers(DicomTag tag, std::size_t frame) const {
    return numbers_of(tag, find(tag, frame));
}

std::vector<double> DicomElements::numbers_in(DicomTag sequence, std::size_t item,
                                              DicomTag tag) const {
    return numbers_of(tag, find_in(sequence, item, tag));
}

std::vector<double> DicomElements::number_of_frame(DicomTag tag, std::size_t frame,
                                                   std::size_t frames) const {
    const std::string* const value = find(tag);
    if (value == nullptr || value->size() != 2 * frames) return {};
    return binary_numbers(ValueType::uint16, std::string_view(*value).substr(2 * frame, 2),
                          big_endian);
}

std::optional<double> DicomElements::number(DicomTag tag, std::size_t frame) const {
    const auto found = numbers(tag, frame);
    return found.size() == 1 ? std::optional(found[0]) : std::nullopt;
}

std::int64_t DicomElements::whole(DicomTag tag) const {
    const auto found = numbers(tag);
    return found.empty() ? 0 : static_cast<std::int64_t>(found[0]);
}

DicomElements read_dicom_elements(const std::filesystem::path& file) {
    return ElementReader(file).read();
}

}  // namespace lamina
