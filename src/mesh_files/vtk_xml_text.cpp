// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtk_xml_text.h"

#include <algorithm>
#include <pugixml.hpp>

#include "base/error.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

constexpr std::string_view appended_tag = "<AppendedData", appended_end = "</AppendedData",
                           last_tag = "</VTKFile";
constexpr std::size_t no_place = std::string_view::npos;

// `tag`: from its "<" to its ">".
bool says_raw(std::string_view tag) {
    pugi::xml_document document;
    const std::string element = std::string(tag.substr(0, tag.size() - 1)) + "/>";
    document.load_buffer(element.data(), element.size(), pugi::parse_escapes);
    return std::string_view(document.first_child().attribute("encoding").value()) == "raw";
}

// The place of the underscore before appended data; `after`: their tag.
std::size_t underscore(std::string_view text, std::size_t after) {
    const std::size_t mark = text.find_first_not_of(" \t\r\n", after);
    return mark != no_place && text[mark] == '_' ? mark : no_place;
}

void warn_behind_end(const std::string& name, std::string_view text) {
    constexpr std::string_view end = "</VTKFile>";
    const std::size_t place = text.rfind(end);
    if (place != no_place) warn_of_surplus(name, text.substr(place + end.size()), end.data());
}

}  // namespace

VtkXmlText::VtkXmlText(const std::filesystem::path& path)
    : name_(path.string()), file_(path), bytes_(file_.size()) {
    read_beginning();
    const std::size_t tag = text().find(appended_tag);
    if (tag != no_place)
        cut_off_appended(tag);
    else
        warn_behind_end(name_, text());
}

// Until there are appended data, or to the end.
void VtkXmlText::read_beginning() {
    constexpr std::size_t first_step = std::size_t{1} << 16, largest_step = std::size_t{1} << 26;
    std::size_t tag = no_place, searched = 0;
    while (read_ < bytes_.size()) {
        const std::size_t wanted =
            std::min({bytes_.size() - read_, std::max(read_, first_step), largest_step});
        const std::size_t got = file_.read_some(read_, bytes_.data() + read_, wanted);
        read_ += got;
        if (got < wanted) return;  // another process has shortened the file meanwhile
        if (tag == no_place) tag = text().find(appended_tag, searched);
        searched = read_ - std::min(read_, appended_tag.size());
        if (tag == no_place) continue;
        const std::size_t end = text().find('>', tag);
        if (end != no_place && underscore(text(), end + 1) != no_place) return;
    }
}

std::span<char> VtkXmlText::xml() {
    return has_appended_ ? std::span<char>(xml_) : bytes_.span().first(read_);
}

void VtkXmlText::cut_off_appended(std::size_t tag) {
    const std::size_t tag_end = text().find('>', tag);
    const std::size_t mark = tag_end == no_place ? tag_end : underscore(text(), tag_end + 1);
    if (mark == no_place) fail("{}: AppendedData: no underscore before its data", name_);
    has_appended_ = true;
    xml_ = std::string(text().substr(0, tag_end + 1)) + "</AppendedData></VTKFile>";
    appended_.base64 = !says_raw(text().substr(tag, tag_end + 1 - tag));
    find_end(mark);
}

// Their end is near the file's.
void VtkXmlText::find_end(std::uint64_t mark) {
    constexpr std::uint64_t usual_end = 1 << 12;
    const std::uint64_t most = file_.size() - mark - 1;
    for (std::uint64_t length = std::min(usual_end, most);; length = most) {
        ByteBuffer bytes(length);
        const std::uint64_t begin = file_.size() - length;
        bytes.shorten(file_.read_some(begin, bytes.data(), length));
        const std::size_t end = bytes.text().rfind(appended_end);
        if (end != no_place && bytes.text().find(last_tag, end) != no_place) {
            warn_behind_end(name_, bytes.text());
            appended_.file = &file_;
            appended_.begin = mark + 1;
            appended_.end = begin + end;
            return;
        }
        if (length == most) break;
    }
    fail("{}: truncated: no </AppendedData> and </VTKFile> after its {} bytes of appended data",
         name_, most);
}

}  // namespace lamina
