// SPDX-License-Identifier: Apache-2.0
// Headers as in "OpenEXR File Layout": magic number, version, headers. Each is a list of attributes
// (name, type, both zero-ended, size, that many bytes) that an empty name ends.
#include "image/exr.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include "base/error.h"
#include "image/image_limits.h"

namespace lamina {

namespace {

constexpr std::uint32_t magic_number = 20000630;
constexpr std::uint32_t several_parts = 1u << 12;  // flag in the version number: several headers
constexpr std::size_t longest_name = 255;

// Attribute types of fixed size, with their size in bytes.
constexpr std::pair<std::string_view, std::uint32_t> sizes_of_types[] = {
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"m33f", 36},       {"m33d", 72},    {"m44f", 64},
    {"m44d", 128},      {"v2i", 8},      {"v2f", 8},
    {"v2d", 16},        {"v3i", 12},     {"v3f", 12},
    {"v3d", 24},        {"rational", 8}, {"lineOrder", 1},
    {"timecode", 8},    {"tiledesc", 9}, {"deepImageState", 1}};

// Reads the little-endian number of four bytes at `at`, all of which must exist.
std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 4; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

// Tells whether a channel list (name, zero, 16 bytes each; an empty name) ends with the value.
bool channels_fill(std::string_view value) {
    constexpr std::size_t channel_bytes = 16;
    std::size_t at = 0;
    while (at < value.size() && value[at] != '\0') {
        const std::size_t name_end = value.find('\0', at);
        if (name_end == value.npos) return false;
        at = name_end + 1 + channel_bytes;
    }
    return at + 1 == value.size();
}

// Tells whether the last of several strings (length, then bytes) ends exactly with the value.
bool strings_fill(std::string_view value) {
    std::uint64_t at = 0;
    while (at + 4 <= value.size()) at += 4 + std::uint64_t{number_at(value, at)};
    return at == value.size();
}

// Tells whether a preview (width, height, four bytes for each pixel) fills the value exactly.
bool preview_fills(std::string_view value) {
    if (value.size() < 8) return false;
    const std::uint64_t width = number_at(value, 0), height = number_at(value, 4);
    const std::uint64_t pixels = value.size() / 4 - 2;
    return value.size() % 4 == 0 && width <= pixels && height <= pixels && width * height == pixels;
}

bool fills(std::string_view type, std::string_view value) {
    if (type == "chlist") return channels_fill(value);
    if (type == "stringvector") return strings_fill(value);
    if (type == "floatvector") return value.size() % 4 == 0;
    if (type == "preview") return preview_fills(value);
    const auto* const sized =
        std::ranges::find(sizes_of_types, type, &std::pair<std::string_view, std::uint32_t>::first);
    return sized == std::end(sizes_of_types) || value.size() == sized->second;
}

// Checks headers. Throws Error if an attribute or table of tiles promises more than the file has,
// or a length does not fit its type: OpenEXR 3.1 would allocate up to 2 GiB, or read beyond it.
class HeaderWalk {
  public:
    HeaderWalk(const std::filesystem::path& path, std::uint64_t file_bytes)
        : name_(path.string()), stream_(path, std::ios::binary), file_bytes_(file_bytes) {}

    void check() {
        if (number() != magic_number) return;
        const bool several = (number() & several_parts) != 0;
        while (check_attributes() && several) check_tables();
        check_tables();
    }

  private:
    // Checks the attributes of one header. Returns false if the header is empty or the file ends.
    bool check_attributes() {
        window_.reset();
        tile_.reset();
        chunks_ = 0;
        bool any = false;
        for (std::string name = word(); !name.empty(); name = word()) {
            const std::string type = word();
            const std::uint32_t size = number();
            if (!stream_) return false;
            const std::uint64_t left = file_bytes_ - static_cast<std::uint64_t>(stream_.tellg());
            const std::string what = fmt::format("{}: attribute \"{}\" of type \"{}\"", name_,
                                                 one_line(name), one_line(type));
            if (size > left) fail("{}: promises {} bytes, the file has {} left", what, size, left);
            std::string value(size, '\0');
            stream_.read(value.data(), static_cast<std::streamsize>(size));
            if (!fills(type, value)) fail("{}: {} bytes are not what its type takes", what, size);
            remember(name, type, value);
            any = true;
        }
        return any;
    }

    void remember(std::string_view name, std::string_view type, std::string_view value) {
        if (name == "dataWindow" && type == "box2i") {
            const auto edge = [&](std::size_t axis) {
                const auto low = static_cast<std::int32_t>(number_at(value, 4 * axis));
                const auto high = static_cast<std::int32_t>(number_at(value, 4 * axis + 8));
                return std::max<std::int64_t>(std::int64_t{high} - low + 1, 0);
            };
            window_ = {edge(0), edge(1)};
        } else if (name == "tiles" && type == "tiledesc") {
            tile_ = {number_at(value, 0), number_at(value, 4)};
        } else if (name == "chunkCount" && type == "int") {
            chunks_ = number_at(value, 0);
        }
    }

    // Throws Error if the file cannot hold the tables behind the headers: 8 bytes a tile or chunk.
    // Tiles along an edge are below 2^33, so products fit a double.
    void check_tables() const {
        double chunks = chunks_;
        if (window_ && tile_ && (*tile_)[0] > 0 && (*tile_)[1] > 0) {
            const auto along = [&](std::size_t axis) {
                return std::ceil(static_cast<double>((*window_)[axis]) /
                                 static_cast<double>((*tile_)[axis]));
            };
            chunks = std::max(chunks, along(0) * along(1));
        }
        if (8 * chunks > static_cast<double>(file_bytes_)) {
            fail("{}: promises {:.0f} tiles or other chunks, more than a file of {} bytes can hold",
                 name_, chunks, file_bytes_);
        }
    }

    std::string word() {
        std::string text;
        while (text.size() <= longest_name) {
            const int c = stream_.get();
            if (c <= 0) break;  // the zero behind a name, or the end of the file
            text += static_cast<char>(c);
        }
        return text;
    }

    std::uint32_t number() {
        std::array<char, 4> bytes{};
        stream_.read(bytes.data(), bytes.size());
        return number_at({bytes.data(), bytes.size()}, 0);
    }

    std::string name_;
    std::ifstream stream_;
    std::uint64_t file_bytes_;
    // Values of the header that was read last.
    std::optional<std::array<std::int64_t, 2>> window_, tile_;
    std::uint32_t chunks_ = 0;
};

constexpr const char* space_attribute = "color_space";
constexpr const char* rgba_names[4] = {"R", "G", "B", "A"};
// Channels of the layer of annotations. Readers of the picture leave them alone.
constexpr const char* annotation_names[4] = {"annotation.R", "annotation.G", "annotation.B",
                                             "annotation.A"};
constexpr std::size_t pixel_bytes = 4 * sizeof(float);

// Lets OpenEXR write into an OutputFile.
class FileStream : public Imf::OStream {
  public:
    explicit FileStream(OutputFile& file) : OStream(file.path().c_str()), file_(file) {}

    void write(const char bytes[], int count) override {
        try {
            file_.write(bytes, static_cast<std::size_t>(count));
        } catch (const Error&) {
            broken_ = true;
            throw;
        }
    }
    std::uint64_t tellp() override {
        const off_t position = ftello(file_.stream());
        if (position < 0) give_up();
        return static_cast<std::uint64_t>(position);
    }
    void seekp(std::uint64_t position) override {
        if (fseeko(file_.stream(), static_cast<off_t>(position), SEEK_SET) != 0) give_up();
    }
    bool broken() const { return broken_; }

  private:
    [[noreturn]] void give_up() {
        broken_ = true;
        fail("{}: cannot write: {}", file_.path().string(), std::strerror(errno));
    }

    OutputFile& file_;
    bool broken_ = false;
};

Imf::Slice slice(const Image& image, int channel, const Imath::Box2i& window, double fill) {
    return Imf::Slice::Make(Imf::FLOAT, image.rgba.data() + channel, window, pixel_bytes,
                            pixel_bytes * static_cast<std::size_t>(image.width), 1, 1, fill);
}

void write_pixels(FileStream& stream, const Image& image,
                  const std::map<std::string, std::string>& attributes, ImageColorSpace space) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 2;  // 1 % larger than by default, in three quarters of the time
    for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
    if (space != ImageColorSpace::linear)
        header.insert(space_attribute, Imf::StringAttribute(name_of(space)));
    Imf::FrameBuffer pixels;
    const auto add = [&](const Image& layer, const char* const(&names)[4]) {
        for (int channel = 0; channel < 4; ++channel) {
            header.channels().insert(names[channel], Imf::Channel(Imf::FLOAT));
            pixels.insert(names[channel], slice(layer, channel, header.dataWindow(), 0));
        }
    };
    add(image, rgba_names);
    if (image.annotations) add(*image.annotations, annotation_names);
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(pixels);
    output.writePixels(image.height);
}

struct Contents {
    std::string names;  // names of all channels, for messages
    std::uint64_t bytes_per_pixel = 0;
    bool rgb = false;
    bool grey = false;
};

Contents contents(const Imf::ChannelList& channels) {
    Contents found;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        found.names += found.names.empty() ? "" : ", ";
        found.names += channel.name();
        found.bytes_per_pixel += channel.channel().type == Imf::HALF ? 2 : 4;
    }
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    found.rgb = has("R") && has("G") && has("B");
    // Y beside RY and BY is the luminance of a colour picture, not a grey one.
    found.grey = !has("R") && !has("G") && !has("B") && has("Y") && !has("RY") && !has("BY");
    return found;
}

ImageColorSpace space_of(const Imf::Header& header) {
    const auto* const attribute = header.findTypedAttribute<Imf::StringAttribute>(space_attribute);
    return attribute != nullptr && attribute->value() == name_of(ImageColorSpace::display)
               ? ImageColorSpace::display
               : ImageColorSpace::linear;
}

Image read_pixels(const std::string& name, std::uint64_t file_bytes) {
    Imf::InputFile input(name.c_str());
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_image_size(name, width, height);
    const Contents found = contents(input.header().channels());
    if (!found.rgb && !found.grey) {
        fail("{}: channels are {}; expected R, G, B and perhaps A, or Y", name,
             one_line(found.names));
    }
    // Largest compression that is believed: Deflate reaches 1032:1, lossy codecs more.
    check_file_can_hold(name, found.bytes_per_pixel * static_cast<std::uint64_t>(width * height),
                        file_bytes, 1 << 16);

    Image image(static_cast<int>(width), static_cast<int>(height));
    Imf::FrameBuffer pixels;
    if (found.grey) pixels.insert("Y", slice(image, 0, window, 0));
    for (int channel = found.grey ? 3 : 0; channel < 4; ++channel)
        pixels.insert(rgba_names[channel], slice(image, channel, window, channel == 3 ? 1 : 0));
    input.setFrameBuffer(pixels);
    input.readPixels(window.min.y, window.max.y);
    if (found.grey) {
        for (std::size_t i = 0; i < image.rgba.size(); i += 4)
            image.rgba[i + 1] = image.rgba[i + 2] = image.rgba[i];
    }
    return image;
}

// Checks headers, calls read(bytes in the file), turns OpenEXR's exceptions into Error.
template <typename Read>
auto read_with(const std::filesystem::path& path, const Read& read) {
    const std::uint64_t file_bytes = length_of_file(path);
    HeaderWalk(path, file_bytes).check();
    // OpenEXR then refuses larger images before it allocates its own tables.
    Imf::Header::setMaxImageSize(max_image_side, max_image_side);
    Imf::Header::setMaxTileSize(max_image_side, max_image_side);
    try {
        return read(file_bytes);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        std::string why = one_line(error.what());
        const std::size_t begin = why.find("\". ");  // skips: Cannot read image file "NAME".
        if (begin != std::string::npos) why.erase(0, begin + 3);
        fail("{}: cannot read as OpenEXR: {}", path.string(), why);
    }
}

}  // namespace

void write_exr(OutputFile& file, const Image& image,
               const std::map<std::string, std::string>& attributes, ImageColorSpace space) {
    const std::string name = file.path().string();
    check_image_size(name, image.width, image.height);
    require_finite(name, image);
    FileStream stream(file);
    try {
        write_pixels(stream, image, attributes, space);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail("{}: cannot write: {}", name, one_line(error.what()));
    }
    // OpenEXR writes its table of lines in a destructor, which ignores errors.
    if (stream.broken()) fail("{}: cannot write: the disk may be full", name);
}

Image read_exr(const std::filesystem::path& path) {
    return read_with(
        path, [&](std::uint64_t file_bytes) { return read_pixels(path.string(), file_bytes); });
}

ImageColorSpace color_space_of_exr(const std::filesystem::path& path) {
    return read_with(
        path, [&](std::uint64_t) { return space_of(Imf::InputFile(path.c_str()).header()); });
}

std::optional<std::string> attribute_of_exr(const std::filesystem::path& path,
                                            const std::string& name) {
    return read_with(path, [&](std::uint64_t) {
        const Imf::InputFile file(path.c_str());
        const auto* const found = file.header().findTypedAttribute<Imf::StringAttribute>(name);
        return found == nullptr ? std::nullopt : std::optional<std::string>(found->value());
    });
}

}  // namespace lamina
