// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtk_xml.h"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <new>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

constexpr std::uint8_t bad = 255, padding = 64;  // in `digits`, for other characters and '='

constexpr std::array<std::uint8_t, 256> digits = [] {
    std::array<std::uint8_t, 256> table{};
    table.fill(bad);
    constexpr std::string_view alphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
    for (std::size_t i = 0; i < alphabet.size(); ++i) {
        table[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    }
    return table;
}();

// Decodes the bytes of a binary array, raw or base64. Base64 may be several texts, each with
// padding at its end, because VTK encodes the header and the compressed blocks separately.
class EncodedBytes {
  public:
    // `what`: names the file and the array in messages.
    EncodedBytes(const VtkXmlSource& source, std::string what)
        : source_(source), text_(source.text), what_(std::move(what)) {}

    // Returns an upper bound on the number of bytes that can still be read.
    std::uint64_t at_most_left() const {
        return source_.base64 ? left() / 4 * 3 + decoded_count_ : left();
    }
    std::uint64_t used() const { return before_ + position_; }  // bytes of the source
    // Reads `count` decoded bytes. Throws Error if there are fewer, or if they are not base64.
    void read(char* bytes, std::size_t count) {
        if (count > at_most_left()) {
            fail("{}: found {} bytes, expected {}", what_, at_most_left(), count);
        }
        if (!source_.base64) {
            source_.file->read(source_.begin + before_, bytes, count);
            before_ += count;
            return;
        }
        for (std::size_t done = 0; done < count;) {
            if (decoded_count_ == 0) done += decode_whole_groups(bytes + done, count - done);
            if (done == count) return;
            if (decoded_count_ == 0 && !decode_four()) {
                fail("{}: found {} bytes of base64, expected {}", what_, done, count);
            }
            const std::size_t some = std::min(decoded_count_, count - done);
            std::memcpy(bytes + done, decoded_ + decoded_at_, some);
            decoded_at_ += some;
            decoded_count_ -= some;
            done += some;
        }
    }

  private:
    std::uint64_t left() const { return source_.left() - used(); }

    // Reads the next bytes of the file into the window. Returns false at the end of the source.
    bool read_on() {
        constexpr std::uint64_t window_bytes = 1 << 20;
        if (source_.file == nullptr) return false;
        before_ += text_.size();
        position_ = 0;
        window_ = ByteBuffer(std::min(left(), window_bytes));
        source_.file->read(source_.begin + before_, window_.data(), window_.size());
        text_ = window_.text();
        return !text_.empty();
    }

    // Decodes the next four digits to decoded_. Returns false at the end of the source.
    bool decode_four() {
        std::array<std::uint8_t, 4> digit{};
        for (std::size_t i = 0; i < 4;) {
            if (position_ == text_.size() && !read_on()) {
                if (i == 0) return false;
                fail("{}: the base64 text ends within a group of four characters", what_);
            }
            const char c = text_[position_++];
            if (TextReader::is_blank(c)) continue;
            digit[i] = digits[static_cast<unsigned char>(c)];
            if (digit[i] == bad || (digit[i] == padding && i < 2)) {
                fail("{}: found {}, expected base64", what_,
                     next_word(TextReader(text_.substr(position_ - 1))));
            }
            ++i;
        }
        const auto bits = static_cast<std::uint32_t>((digit[0] & 63) << 18 | (digit[1] & 63) << 12 |
                                                     (digit[2] & 63) << 6 | (digit[3] & 63));
        decoded_count_ = digit[2] == padding ? 1 : digit[3] == padding ? 2 : 3;
        for (std::size_t i = 0; i < 3; ++i) decoded_[i] = static_cast<char>(bits >> (16 - 8 * i));
        decoded_at_ = 0;
        return true;
    }

    // Decodes groups of four digits until one has a blank or padding. Returns the number of bytes.
    std::size_t decode_whole_groups(char* bytes, std::size_t count) {
        const auto* at = reinterpret_cast<const unsigned char*>(text_.data()) + position_;
        const std::size_t groups = std::min(count / 3, (text_.size() - position_) / 4);
        std::size_t done = 0;
        for (; done < groups; ++done, at += 4) {
            const std::uint32_t a = digits[at[0]], b = digits[at[1]], c = digits[at[2]],
                                d = digits[at[3]];
            if ((a | b | c | d) > 63) break;
            const std::uint32_t bits = a << 26 | b << 20 | c << 14 | d << 8;
            const std::uint32_t in_order = __builtin_bswap32(bits);
            std::memcpy(bytes + 3 * done, &in_order, 3);
        }
        position_ += 4 * done;
        return 3 * done;
    }

    VtkXmlSource source_;
    ByteBuffer window_;      // a part of the source, if that is in a file
    std::string_view text_;  // the source's, or the window's
    std::string what_;
    std::uint64_t before_ = 0;  // bytes of the source before the text
    std::size_t position_ = 0;  // in the text
    char decoded_[3] = {};      // the last decoded_count_ of these are not read yet
    std::size_t decoded_count_ = 0;
    std::size_t decoded_at_ = 0;
};

// Decodes exactly block.size() bytes. Returns how many `stored` bytes it took, or -1 if it cannot.
using Decode = std::int64_t (*)(std::span<const char> stored, std::span<char> block);

std::int64_t decode_zlib(std::span<const char> stored, std::span<char> block) {
    uLongf size = block.size(), used = stored.size();
    const int result = uncompress2(reinterpret_cast<Bytef*>(block.data()), &size,
                                   reinterpret_cast<const Bytef*>(stored.data()), &used);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    return result == Z_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

std::int64_t decode_lz4(std::span<const char> stored, std::span<char> block) {
    if (!std::in_range<int>(std::max(stored.size(), block.size()))) return -1;
    const auto size = static_cast<int>(block.size()), used = static_cast<int>(stored.size());
    return LZ4_decompress_safe(stored.data(), block.data(), used, size) == size ? used : -1;
}

// vtkLZMADataCompressor writes .xz streams.
std::int64_t decode_lzma(std::span<const char> stored, std::span<char> block) {
    std::uint64_t most_memory = std::uint64_t{256} << 20;  // xz -9 takes 65 MiB
    std::size_t used = 0, size = 0;
    const lzma_ret result = lzma_stream_buffer_decode(
        &most_memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(stored.data()), &used,
        stored.size(), reinterpret_cast<std::uint8_t*>(block.data()), &size, block.size());
    if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
    return result == LZMA_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

// How a VTK XML file compresses the blocks of its arrays.
struct VtkXmlCompressor {
    const char* name;              // of VTK's class
    const char* word;              // for messages
    std::uint64_t most_expansion;  // bytes that one stored byte gives
    Decode decode;
};

// Deflate codes at most 258 bytes in 2 bits (zlib, "Technical details": 1032:1), LZ4 255 in 8, LZMA
// 273 in a few adapted bits, each of .02 bits at least: below 2^15.
constexpr VtkXmlCompressor compressors[] = {
    {"vtkZLibDataCompressor", "zlib", 1032, decode_zlib},
    {"vtkLZ4DataCompressor", "LZ4", 255, decode_lz4},
    {"vtkLZMADataCompressor", "LZMA", 1 << 15, decode_lzma}};

std::uint64_t read_header_word(EncodedBytes& bytes, const VtkXmlEncoding& encoding) {
    char word[8];
    bytes.read(word, bytes_of(encoding.header_type));
    return values_from_bytes<std::uint64_t>(encoding.header_type, word, 1, encoding.swap_bytes)[0];
}

void check_length(std::uint64_t found, std::uint64_t expected, const std::string& what) {
    if (found == expected) return;
    fail("{}: found {} bytes in its header, expected {}", what, found, expected);
}

ByteBuffer read_plain(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::uint64_t expected,
                      const std::string& what) {
    check_length(read_header_word(bytes, encoding), expected, what);
    if (expected > bytes.at_most_left()) {
        fail("{}: found {} bytes before the end of the file's data, expected {}", what,
             bytes.at_most_left(), expected);
    }
    ByteBuffer values(expected);
    bytes.read(values.data(), values.size());
    return values;
}

struct Block {
    std::uint64_t stored = 0, size = 0;
};

// Reads the header of compressed data: the number of blocks, the size of each but the last, the
// size of the last if it is not full (else 0), then the stored size of each.
std::vector<Block> read_blocks(EncodedBytes& bytes, const VtkXmlEncoding& encoding,
                               const VtkXmlCompressor& compressor, std::uint64_t expected,
                               const std::string& what) {
    const std::uint64_t count = read_header_word(bytes, encoding);
    const std::uint64_t full = read_header_word(bytes, encoding);
    const std::uint64_t last = read_header_word(bytes, encoding);
    if (count > bytes.at_most_left() / bytes_of(encoding.header_type)) {
        fail("{}: the header promises {} compressed blocks, the file holds {} bytes after it", what,
             count, bytes.at_most_left());
    }
    std::vector<Block> blocks(count);
    std::uint64_t stored = 0, size = 0;
    bool overflow = false;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        Block& block = blocks[i];
        block.size = i + 1 == blocks.size() && last > 0 ? last : full;
        block.stored = read_header_word(bytes, encoding);
        overflow |= __builtin_add_overflow(stored, block.stored, &stored);
        overflow |= __builtin_add_overflow(size, block.size, &size);
        if (block.size / compressor.most_expansion > block.stored) {
            fail("{}: block {} promises {} bytes out of {} of {} data, more than {} can hold", what,
                 i + 1, block.size, block.stored, compressor.word, compressor.word);
        }
    }
    if (overflow) fail("{}: damaged header: the sizes of its blocks have no sum", what);
    check_length(size, expected, what);
    if (stored > bytes.at_most_left()) {
        fail(
            "{}: found {} bytes before the end of the file's data, expected {} of compressed "
            "blocks",
            what, bytes.at_most_left(), stored);
    }
    return blocks;
}

ByteBuffer read_compressed(EncodedBytes& bytes, const VtkXmlEncoding& encoding,
                           std::uint64_t expected, const std::string& what) {
    const auto* const compressor =
        std::ranges::find(compressors, encoding.compressor, &VtkXmlCompressor::name);
    if (compressor == std::end(compressors)) {
        fail(
            "{}: compressor: found '{}', expected 'vtkZLibDataCompressor', 'vtkLZ4DataCompressor', "
            "'vtkLZMADataCompressor' or none",
            what, one_line(encoding.compressor));
    }
    const std::vector<Block> blocks = read_blocks(bytes, encoding, *compressor, expected, what);
    ByteBuffer values(expected);
    std::string packed;
    std::size_t done = 0;
    std::uint64_t surplus = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        check_interrupt();
        packed.resize(blocks[i].stored);
        bytes.read(packed.data(), packed.size());
        const std::int64_t used =
            compressor->decode(packed, values.span().subspan(done, blocks[i].size));
        if (used < 0) {
            fail("{}: damaged {} data in block {} of {}", what, compressor->word, i + 1,
                 blocks.size());
        }
        done += blocks[i].size;
        surplus += packed.size() - static_cast<std::size_t>(used);
    }
    if (surplus > 0) {
        say("{}: found {} bytes behind the {} data of its {} blocks, expected none: "
            "they are not used",
            what, surplus, compressor->word, blocks.size());
    }
    return values;
}

// Reads `count` values of `type` from binary data, as vtkXMLDataParser does: a header (the length,
// or those of the compressed blocks), then the values, in the file's byte order. Checks lengths
// before it takes memory, and moves the source past them. Throws Error. `what`: for messages.
ByteBuffer read_vtk_xml_bytes(VtkXmlSource& source, const VtkXmlEncoding& encoding, ValueType type,
                              std::int64_t count, const std::string& what) {
    if (count == 0) return {};
    std::uint64_t expected = 0;
    if (__builtin_mul_overflow(static_cast<std::uint64_t>(count), bytes_of(type), &expected)) {
        fail("{}: the file promises {} values, more than any file holds", what, count);
    }
    EncodedBytes bytes(source, what);
    ByteBuffer values = encoding.compressor.empty()
                            ? read_plain(bytes, encoding, expected, what)
                            : read_compressed(bytes, encoding, expected, what);
    source.skip(bytes.used());
    return values;
}

constexpr std::string_view appended_tag = "<AppendedData", appended_end = "</AppendedData",
                           last_tag = "</VTKFile";
constexpr std::size_t no_place = std::string_view::npos;

// Tells if appended data are raw. `tag`: their opening tag, from "<" to ">".
bool says_raw(std::string_view tag) {
    pugi::xml_document document;
    const std::string element = std::string(tag.substr(0, tag.size() - 1)) + "/>";
    document.load_buffer(element.data(), element.size(), pugi::parse_escapes);
    return std::string_view(document.first_child().attribute("encoding").value()) == "raw";
}

// Returns the place of the underscore before appended data; `after`: the end of their tag.
std::size_t underscore(std::string_view text, std::size_t after) {
    const std::size_t mark = text.find_first_not_of(" \t\r\n", after);
    return mark != no_place && text[mark] == '_' ? mark : no_place;
}

void warn_behind_end(const std::string& name, std::string_view text) {
    constexpr std::string_view end = "</VTKFile>";
    const std::size_t place = text.rfind(end);
    if (place != no_place) warn_of_surplus(name, text.substr(place + end.size()), end.data());
}

// Most tags and attributes, which take some 100 bytes of memory each.
constexpr std::ptrdiff_t most_marks = 1'000'000;

// Sets `text` to the text in an element. VTK's writer may put information keys before or after it;
// parts are then joined into the string that is returned.
std::string text_of(pugi::xml_node node, std::string_view& text) {
    std::string joined;
    int parts = 0;
    for (const pugi::xml_node child : node.children()) {
        if (child.type() != pugi::node_pcdata && child.type() != pugi::node_cdata) continue;
        if (parts++ > 0) joined.append(text).append(" ");
        text = child.value();
    }
    if (parts > 1) joined.append(text);
    return parts > 1 ? joined : std::string();
}

std::string said(const char* value) {
    return *value == '\0' ? "''" : next_word(TextReader(value));
}

void swap_words(ValueType type, ByteBuffer& bytes) {
    const std::size_t word = bytes_of(type);
    for (std::size_t i = 0; i < bytes.size(); i += word)
        std::reverse(bytes.data() + i, bytes.data() + i + word);
}

}  // namespace

std::string vtk_xml_type(const std::filesystem::path& path) {
    const std::string beginning = file_beginning(path, 4096);
    const std::size_t tag = beginning.find("<VTKFile");
    if (tag == std::string::npos ||
        beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf") != beginning.find('<'))
        return {};
    pugi::xml_document document;
    const std::string element = beginning.substr(tag, beginning.find('>', tag) - tag) + "/>";
    document.load_buffer(element.data(), element.size());
    return document.first_child().attribute("type").value();
}

VtkXmlText::VtkXmlText(const std::filesystem::path& path)
    : name_(path.string()), file_(path), bytes_(file_.size()) {
    read_beginning();
    const std::size_t tag = text().find(appended_tag);
    if (tag != no_place)
        cut_off_appended(tag);
    else
        warn_behind_end(name_, text());
}

// Reads up to the beginning of appended data, or to the end.
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

// Finds the end of the appended data, which is near the file's end.
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

VtkXmlFile::VtkXmlFile(const std::filesystem::path& path, const char* grid_type)
    : name_(path.string()), text_(path) {
    parse(text_.xml(), grid_type);
}

void VtkXmlFile::parse(std::span<char> xml, const char* grid_type) {
    const std::ptrdiff_t marks =
        std::count_if(xml.begin(), xml.end(), [](char c) { return c == '<' || c == '='; });
    if (marks > most_marks) {
        fail("{}: found {} tags and attributes, expected at most {}", name_, marks, most_marks);
    }
    if (std::string_view(xml.data(), xml.size()).find("<VTKFile") == std::string::npos) {
        fail("{}: not a VTK XML file: no <VTKFile> in it", name_);
    }
    const pugi::xml_parse_result result = document_.load_buffer_inplace(
        xml.data(), xml.size(), pugi::parse_escapes | pugi::parse_cdata, pugi::encoding_utf8);
    if (!result) {
        fail("{}: truncated or damaged XML at byte {} of {}: {}", name_, result.offset, xml.size(),
             result.description());
    }
    read_root(document_.child("VTKFile"), grid_type);
}

void VtkXmlFile::read_root(pugi::xml_node root, const char* grid_type) {
    const std::string type = root.attribute("type").value();
    if (type != grid_type) {
        fail("{}: VTKFile type: found {}, expected '{}'", name_, said(type.c_str()), grid_type);
    }
    grid_ = root.child(grid_type);
    if (!grid_) fail("{}: no <{}> in it", name_, grid_type);
    const std::string order = root.attribute("byte_order").as_string("LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian") {
        fail("{}: byte_order: found {}, expected 'LittleEndian' or 'BigEndian'", name_,
             said(order.c_str()));
    }
    encoding_.swap_bytes = (order == "BigEndian") != (std::endian::native == std::endian::big);
    const std::string header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64") {
        fail("{}: header_type: found {}, expected 'UInt32' or 'UInt64'", name_,
             said(header.c_str()));
    }
    encoding_.header_type = header == "UInt32" ? ValueType::uint32 : ValueType::uint64;
    encoding_.compressor = root.attribute("compressor").value();
    if (!text_.has_appended()) return;
    const std::string appended = root.child("AppendedData").attribute("encoding").value();
    if (appended != "raw" && appended != "base64") {
        fail("{}: AppendedData encoding: found {}, expected 'raw' or 'base64'", name_,
             said(appended.c_str()));
    }
}

std::int64_t VtkXmlFile::count_in(pugi::xml_node node, const char* attribute,
                                  const std::string& what) const {
    const char* const text = node.attribute(attribute).value();
    TextReader reader(text);
    std::int64_t count = 0;
    if (!reader.read(count) || !reader.at_end() || count < 0) {
        fail("{}: {}: found {}, expected a whole number >= 0", what, attribute,
             node.attribute(attribute) ? said(text) : "none");
    }
    return count;
}

std::int64_t VtkXmlFile::components_of(pugi::xml_node array, const std::string& what) const {
    if (!array.attribute("NumberOfComponents")) return 1;
    const std::int64_t count = count_in(array, "NumberOfComponents", what);
    return count == 0 ? 1 : count;  // VTK takes 0 for 1
}

ValueType VtkXmlFile::type_of(pugi::xml_node array, const std::string& what) const {
    const char* const text = array.attribute("type").value();
    for (const ValueType type : value_types)
        if (std::string_view(vtk_name_of(type)) == text) return type;
    fail("{}: type: found {}, expected Int8 ... UInt64, Float32 or Float64", what, said(text));
}

VtkXmlSource VtkXmlFile::appended_at(pugi::xml_node array, const std::string& what) const {
    if (!text_.has_appended())
        fail("{}: format 'appended', but the file has no AppendedData", what);
    const std::int64_t offset = count_in(array, "offset", what);
    VtkXmlSource source = text_.appended();
    if (static_cast<std::uint64_t>(offset) > source.left()) {
        fail("{}: offset: found {}, the file has {} bytes of appended data", what, offset,
             source.left());
    }
    source.skip(static_cast<std::uint64_t>(offset));
    return source;
}

// Counts the bytes of appended data that arrays take. Throws Error if these are more than the file
// has: arrays that share bytes would let a small file fill all memory.
void VtkXmlFile::count_appended(std::uint64_t bytes, const std::string& what) const {
    appended_used_ += bytes;
    if (appended_used_ > text_.appended().left()) {
        fail(
            "{}: offset: the arrays up to this one take {} bytes of appended data, the file has {}",
            what, appended_used_, text_.appended().left());
    }
}

// Counts and limits the values of all arrays: zlib packs a thousand equal bytes into one, each may
// become 8 bytes, and a small file could fill all memory. Real meshes stay far below the limit.
void VtkXmlFile::count_kept(std::int64_t count, const std::string& what) const {
    constexpr std::uint64_t most_expansion = 256;
    values_kept_ += static_cast<std::uint64_t>(count);
    if (values_kept_ / most_expansion > text_.byte_count() / sizeof(double) + 1) {
        fail(
            "{}: the arrays up to this one promise {} values, {} bytes each, more than {} times "
            "the file's {} bytes",
            what, values_kept_, sizeof(double), most_expansion, text_.byte_count());
    }
}

std::int64_t VtkXmlFile::value_count(std::int64_t tuples, std::int64_t components,
                                     const std::string& what) const {
    std::int64_t count = 0;
    if (__builtin_mul_overflow(tuples, components, &count)) {
        fail("{}: the file promises {} tuples of {} values, more than any file holds", what, tuples,
             components);
    }
    return count;
}

template <typename Binary, typename Text>
auto VtkXmlFile::decoded(pugi::xml_node array, std::int64_t count, const std::string& what,
                         const Binary& binary, const Text& in_text) const {
    const std::string format = array.attribute("format").as_string("ascii");
    if (format == "appended") {
        VtkXmlSource source = appended_at(array, what);
        const std::uint64_t from = source.left();
        auto values = binary(source);
        count_appended(from - source.left(), what);
        return values;
    }
    std::string_view text;
    const std::string joined = text_of(array, text);
    if (!joined.empty()) text = joined;
    if (format == "binary") {
        VtkXmlSource source{.text = text};
        auto values = binary(source);
        warn_of_surplus(what, source.text, "its base64 data");
        return values;
    }
    if (format != "ascii") {
        fail("{}: format: found {}, expected 'ascii', 'binary' or 'appended'", what,
             said(format.c_str()));
    }
    TextReader reader(text);
    auto values = in_text(reader);
    if (!reader.at_end()) {
        fail("{}: found more than the {} values expected: {}", what, count, next_word(reader));
    }
    return values;
}

template <typename To>
std::vector<To> VtkXmlFile::values(pugi::xml_node array, std::int64_t tuples,
                                   std::int64_t components, const std::string& what) const {
    const std::int64_t count = value_count(tuples, components, what);
    count_kept(count, what);
    const ValueType type = type_of(array, what);
    if (std::is_same_v<To, std::int64_t> && !is_integer(type)) {
        fail("{}: type: found {}, expected an integer type", what, vtk_name_of(type));
    }
    return decoded(
        array, count, what,
        [&](VtkXmlSource& source) {
            const ByteBuffer bytes = read_vtk_xml_bytes(source, encoding_, type, count, what);
            return values_from_bytes<To>(type, bytes.text().data(), static_cast<std::size_t>(count),
                                         encoding_.swap_bytes);
        },
        [&](TextReader& reader) { return read_text_values<To>(reader, type, count, what); });
}

VtkXmlValues VtkXmlFile::stored_values(pugi::xml_node array, std::int64_t tuples,
                                       std::int64_t components, const std::string& what) const {
    const std::int64_t count = value_count(tuples, components, what);
    const ValueType type = type_of(array, what);
    const auto words = static_cast<std::size_t>(count);
    return decoded(
        array, count, what,
        [&](VtkXmlSource& source) {
            VtkXmlValues values{type, read_vtk_xml_bytes(source, encoding_, type, count, what)};
            if (encoding_.swap_bytes) swap_words(type, values.bytes);
            return values;
        },
        [&](TextReader& reader) {
            VtkXmlValues values{type, {}};
            const auto store = [&](const auto& numbers) {
                values.bytes = ByteBuffer(words * bytes_of(type));
                with_type(type, [&](auto zero) {
                    for (std::size_t i = 0; i < words; ++i) {
                        const auto value = static_cast<decltype(zero)>(numbers[i]);
                        std::memcpy(values.bytes.data() + i * sizeof value, &value, sizeof value);
                    }
                });
            };
            if (type == ValueType::uint64)
                store(read_text_values<std::uint64_t>(reader, type, count, what));
            else if (is_integer(type))
                store(read_text_values<std::int64_t>(reader, type, count, what));
            else
                store(read_text_values<double>(reader, type, count, what));
            return values;
        });
}

template std::vector<double> VtkXmlFile::values(pugi::xml_node, std::int64_t, std::int64_t,
                                                const std::string&) const;
template std::vector<std::int64_t> VtkXmlFile::values(pugi::xml_node, std::int64_t, std::int64_t,
                                                      const std::string&) const;

}  // namespace lamina
