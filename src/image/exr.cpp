// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>

#include "base/error.h"
#include "image/exr_header.h"
#include "image/finite.h"
#include "image/image_limits.h"

namespace lamina {
namespace {

constexpr const char* space_attribute = "color_space";
constexpr const char* rgba_names[4] = {"R", "G", "B", "A"};
constexpr std::size_t pixel_bytes = 4 * sizeof(float);

// Lets OpenEXR write through an OutputFile.
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
    for (int channel = 0; channel < 4; ++channel) {
        header.channels().insert(rgba_names[channel], Imf::Channel(Imf::FLOAT));
        pixels.insert(rgba_names[channel], slice(image, channel, header.dataWindow(), 0));
    }
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(pixels);
    output.writePixels(image.height);
}

struct Contents {
    std::string names;  // of all channels, for messages
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
    // Deflate reaches 1032:1. The rest of the allowance is for lossy codecs.
    check_file_can_hold(name, found.bytes_per_pixel * static_cast<std::uint64_t>(width * height),
                        file_bytes, 1 << 16);

    Image image(static_cast<int>(width), static_cast<int>(height));
    Imf::FrameBuffer pixels;
    if (found.grey) pixels.insert("Y", slice(image, 0, window, 0));
    for (int channel = found.grey ? 3 : 0; channel < 4; ++channel) {
        pixels.insert(rgba_names[channel], slice(image, channel, window, channel == 3 ? 1 : 0));
    }
    input.setFrameBuffer(pixels);
    input.readPixels(window.min.y, window.max.y);
    if (found.grey) {
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
            image.rgba[i + 1] = image.rgba[i + 2] = image.rgba[i];
        }
    }
    return image;
}

// Calls read(bytes of the file), and turns what OpenEXR throws into Error.
template <typename Read>
auto read_with(const std::filesystem::path& path, const Read& read) {
    const std::uint64_t file_bytes = length_of_file(path);
    check_exr_header(path, file_bytes);
    // Makes OpenEXR refuse such headers before it takes memory for its own tables.
    Imf::Header::setMaxImageSize(max_image_side, max_image_side);
    Imf::Header::setMaxTileSize(max_image_side, max_image_side);
    try {
        return read(file_bytes);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        std::string why = one_line(error.what());
        const std::size_t begin = why.find("\". ");  // after: Cannot read image file "NAME".
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
    // OpenEXR writes its table of lines in a destructor and swallows what goes wrong there.
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

}  // namespace lamina
