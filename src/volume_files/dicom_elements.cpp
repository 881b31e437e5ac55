// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.5, section 7 (the data set), and PS3.10, section 7 (the file).
#include "volume_files/dicom_elements.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/opened_file.h"

namespace lamina {
namespace {

constexpr DicomTag transfer_syntax_tag = 0x00020010, pixel_data_tag = 0x7fe00010,
                   item_tag = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd,
                   shared_groups = 0x52009229, frame_groups = 0x52009230, position_tag = 0x00200032;
constexpr DicomTag kept_tags[] = {0x0008103e, 0x00180050, 0x00180088, 0x0020000e, 0x00200013,
                                  0x00200032, 0x00200037, 0x00280002, 0x00280008, 0x00280010,
                                  0x00280011, 0x00280030, 0x00280100, 0x00280101, 0x00280102,
                                  0x00280103, 0x00281052, 0x00281053};
constexpr std::uint32_t undefined = 0xffffffff;
constexpr int most_depth = 16;
constexpr std::size_t most_frames = 1 << 20;

class ElementReader {
  public:
    explicit ElementReader(const std::filesystem::path& path)
        : name_(path.string()), file_(open_to_read(path)), left_(bytes_left(file_.get())) {}

    DicomElements read() {
        skip(132);
        while (left_ > 0 && !found_pixels_) read_element(0, 0);
        if (!found_pixels_) fail("{}: found no pixels before its end", name_);
        return std::move(elements_);
    }

  private:
    struct Element {
        DicomTag tag = 0;
        std::string form;  // VR; empty where it is implicit
        std::uint32_t length = 0;
    };

    [[noreturn]] void fail_at(const Element& element, std::uint64_t found) const {
        fail("{}: truncated or damaged: element ({:04x},{:04x}) has {} bytes, the file {} more",
             name_, element.tag >> 16, element.tag & 0xffff, element.length, found);
    }

    void skip(std::uint64_t count) {
        if (count > left_)
            fail("{}: truncated: found {} bytes more, expected {}", name_, left_, count);
        fseeko(file_.get(), static_cast<off_t>(count), SEEK_CUR);
        left_ -= count;
    }

    std::string bytes(std::size_t count) {
        if (count > left_)
            fail("{}: truncated: found {} bytes more, expected {}", name_, left_, count);
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

    // Behind group 2 the file goes on as its transfer syntax says.
    Element read_head(int depth) {
        Element element;
        element.tag = read_tag();
        if (depth == 0 && in_meta_ && element.tag >> 16 != 2) {
            in_meta_ = false;
            fseeko(file_.get(), -4, SEEK_CUR);
            left_ += 4;
            take_syntax();
            element.tag = read_tag();
        }
        if (element.tag >> 16 == 0xfffe) {
            element.length = number(4);
            return element;
        }
        if (!explicit_) {
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
        } else if (sequence == frame_groups && element.tag == position_tag) {
            if (elements_.frame_positions.size() >= most_frames)
                fail("{}: found more than {} frames", name_, most_frames);
            elements_.frame_positions.push_back(std::move(value));
        } else {
            elements_.shared.emplace(element.tag, std::move(value));  // of the first frame
        }
    }

    // The items of a sequence, each with elements.
    void read_sequence(const Element& sequence, int depth, DicomTag top) {
        if (depth > most_depth) fail("{}: found sequences more than {} deep", name_, most_depth);
        if (sequence.length != undefined && sequence.length > left_) fail_at(sequence, left_);
        const bool was_explicit = explicit_;
        if (sequence.form == "UN") explicit_ = false;  // PS3.5, 6.2.2
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

    // Passes the end of an item of undefined length.
    bool at_item_end() {
        const DicomTag tag = read_tag();
        if (tag == item_end) {
            skip(4);
            return true;
        }
        fseeko(file_.get(), -4, SEEK_CUR);
        left_ += 4;
        return false;
    }

    std::string name_;
    OpenedFile file_;
    std::uint64_t left_;  // bytes of the file
    bool in_meta_ = true, explicit_ = true, big_endian_ = false;
    bool found_pixels_ = false;
    DicomElements elements_;
};

}  // namespace

const std::string& DicomElements::text(DicomTag tag) const {
    static const std::string none;
    for (const auto* const map : {&values, &shared}) {
        if (const auto found = map->find(tag); found != map->end()) return found->second;
    }
    return none;
}

std::vector<double> DicomElements::numbers(DicomTag tag) const {
    return dicom_numbers(text(tag));
}

double DicomElements::number(DicomTag tag, double otherwise) const {
    const auto found = numbers(tag);
    return found.size() == 1 ? found[0] : otherwise;
}

std::int64_t DicomElements::whole(DicomTag tag) const {
    const std::string& word = text(tag);
    if (word.size() < 2) return 0;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(word[i]); };
    return big_endian ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0);
}

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

bool has_dicom_mark(const std::filesystem::path& file) {
    return file_beginning(file, 132).find("DICM", 128) == 128;
}

DicomElements read_dicom_elements(const std::filesystem::path& file) {
    return ElementReader(file).read();
}

}  // namespace lamina
