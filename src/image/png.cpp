// SPDX-License-Identifier: Apache-2.0
#include "image/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include "base/error.h"
#include "image/image_limits.h"

namespace lamina {
namespace {

using Message = char[256];

void on_error(png_structp png, png_const_charp text) {
    std::snprintf(static_cast<char*>(png_get_error_ptr(png)), sizeof(Message), "%s", text);
    png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*text*/) {
}  // ignored: warnings are about chunks that do not change codes

// Calls `body`, which calls libpng; returns false if libpng leaves it by longjmp(). `body` must not
// own objects with destructors.
template <typename Body>
[[nodiscard]] bool succeeds(png_structp png, const Body& body) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    body();
    return true;
}

// Writes bytes. Unlike libpng's own function, its message says why a write fails.
void write_block(png_structp png, png_bytep bytes, std::size_t count) {
    auto* const stream = static_cast<std::FILE*>(png_get_io_ptr(png));
    if (std::fwrite(bytes, 1, count, stream) != count) png_error(png, std::strerror(errno));
}

// Appends bytes to a string.
void append_block(png_structp png, png_bytep bytes, std::size_t count) {
    bool appended = true;
    try {
        static_cast<std::string*>(png_get_io_ptr(png))
            ->append(reinterpret_cast<const char*>(bytes), count);
    } catch (const std::bad_alloc&) {
        appended = false;  // no exception may pass through libpng
    }
    if (!appended) png_error(png, "out of memory");
}

void flush_nothing(png_structp /*png*/) {}

// libpng's structures for writing or reading.
struct Png {
    bool writes;
    Message message = "";
    png_structp png = (writes ? png_create_write_struct : png_create_read_struct)(
        PNG_LIBPNG_VER_STRING, message, on_error, on_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);

    explicit Png(bool to_write) : writes(to_write) {}
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;
    ~Png() {
        writes ? png_destroy_write_struct(&png, &info)
               : png_destroy_read_struct(&png, &info, nullptr);
    }
};

int color_type(int channels) {
    constexpr int types[4] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                              PNG_COLOR_TYPE_RGB_ALPHA};
    return types[channels - 1];
}

// Stores one row of codes in `row` as PNG has them: 16-bit codes with the high byte first.
void pack_row(const CodedImage& image, const std::uint16_t* codes, std::vector<png_byte>& row) {
    png_byte* byte = row.data();
    for (int i = 0; i < image.width * image.channels; ++i) {
        if (image.bit_depth == 16) *byte++ = static_cast<png_byte>(codes[i] >> 8);
        *byte++ = static_cast<png_byte>(codes[i] & 255);
    }
}

// Encodes a PNG; `write` takes its bytes to `target`.
void encode(const std::string& name, const CodedImage& image, void* target, png_rw_ptr write) {
    check_image_size(name, image.width, image.height);
    Png writer(true);
    if (writer.info == nullptr) fail("{}: cannot write: out of memory", name);
    const std::size_t row_codes =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    std::vector<png_byte> row(row_codes * static_cast<std::size_t>(image.bit_depth / 8));
    const bool written = succeeds(writer.png, [&] {
        png_set_write_fn(writer.png, target, write, flush_nothing);
        png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
                     static_cast<png_uint_32>(image.height), image.bit_depth,
                     color_type(image.channels), PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_write_info(writer.png, writer.info);
        for (int y = 0; y < image.height; ++y) {
            pack_row(image, &image.codes[static_cast<std::size_t>(y) * row_codes], row);
            png_write_row(writer.png, row.data());
        }
        png_write_end(writer.png, writer.info);
    });
    if (!written) fail("{}: cannot write: {}", name, one_line(writer.message));
}

void unpack(const std::vector<png_byte>& bytes, CodedImage& image) {
    const png_byte* byte = bytes.data();
    for (std::uint16_t& code : image.codes) {
        code = *byte++;
        if (image.bit_depth == 16) code = static_cast<std::uint16_t>(code << 8 | *byte++);
    }
}

// Requests the expansions that turn every PNG into one of CodedImage's kinds.
void expand(Png& reader) {
    if (png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(reader.png);
    if (png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_GRAY)
        png_set_expand_gray_1_2_4_to_8(reader.png);
    if (png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) != 0)
        png_set_tRNS_to_alpha(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
}

// Says what a picture shows of a pixel: numbers between 0 and 1 unless they must be clamped.
struct ShownPixel {
    std::array<double, 4> value;  // red, green, blue; the opacity of straight alpha
    bool clamped;
};

ShownPixel shown_pixel(const std::array<float, 4>& rgba, const PngLook& look) {
    constexpr double rounding = 1.0 / 510;
    const double alpha = std::clamp(static_cast<double>(rgba[3]), 0.0, 1.0);
    ShownPixel shown{{0, 0, 0, alpha}, false};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double value = rgba[channel];
        // An associated colour above its opacity would need a straight colour above 1.
        if (!look.transparent)
            value += (1.0 - rgba[3]) * look.background[static_cast<glm::length_t>(channel)];
        const double most = look.transparent ? alpha : 1;
        shown.clamped = shown.clamped || value < -rounding || value > most + rounding;
        if (look.transparent) value = alpha > 0 ? value / alpha : 0;
        shown.value[channel] = value;
    }
    return shown;
}

// Returns a pixel with the annotations laid over it.
std::array<float, 4> annotated_pixel(const Image& image, std::size_t pixel) {
    std::array<float, 4> rgba{};
    std::copy_n(&image.rgba[4 * pixel], 4, rgba.begin());
    if (!image.annotations) return rgba;
    const float* const over = &image.annotations->rgba[4 * pixel];
    if (over[3] == 0) return rgba;
    for (std::size_t c = 0; c < 4; ++c) rgba[c] = over[c] + (1 - over[3]) * rgba[c];
    return rgba;
}

}  // namespace

CodedPicture coded_picture(const std::string& name, const Image& image, const PngLook& look,
                           ImageColorSpace space) {
    check_image_size(name, image.width, image.height);
    require_finite(name, image);
    const std::size_t channels = look.transparent ? 4 : 3;
    CodedPicture coded{CodedImage(image.width, image.height, static_cast<int>(channels), look.bits),
                       0};
    std::uint16_t* code = coded.codes.codes.data();
    for (std::size_t pixel = 0; pixel < image.rgba.size() / 4; ++pixel) {
        const ShownPixel shown = shown_pixel(annotated_pixel(image, pixel), look);
        for (std::size_t channel = 0; channel < channels; ++channel) {
            // Opacity has no curve.
            *code++ = display_code(shown.value[channel],
                                   channel == 3 ? ImageColorSpace::display : space, look.bits);
        }
        coded.clamped_pixels += shown.clamped;
    }
    return coded;
}

std::size_t write_png(OutputFile& file, const Image& image, const PngLook& look,
                      ImageColorSpace space) {
    const CodedPicture coded = coded_picture(file.path().string(), image, look, space);
    write_png(file, coded.codes);
    return coded.clamped_pixels;
}

std::string encode_png(const Image& image, const PngLook& look, ImageColorSpace space) {
    return encode_png(coded_picture("picture", image, look, space).codes);
}

void write_png(OutputFile& file, const CodedImage& image) {
    encode(file.path().string(), image, file.stream(), write_block);
}

std::string encode_png(const CodedImage& image) {
    std::string encoded;
    encode("picture", image, &encoded, append_block);
    return encoded;
}

CodedImage read_png(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::uint64_t file_bytes = length_of_file(path);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (file == nullptr) fail("{}: cannot open: {}", name, std::strerror(errno));
    Png reader(false);
    if (reader.info == nullptr) fail("{}: cannot read: out of memory", name);
    const auto bad_file = [&] {
        fail("{}: cannot read as PNG: {}", name, one_line(reader.message));
    };

    const bool has_header = succeeds(reader.png, [&] {
        png_init_io(reader.png, file.get());
        png_set_user_limits(reader.png, max_image_side, max_image_side);
        // libpng allocates as much as some chunks ask for; those that change no codes are ignored.
        png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(reader.png, reader.info);
    });
    if (!has_header) bad_file();
    const std::int64_t height = png_get_image_height(reader.png, reader.info);
    check_image_size(name, png_get_image_width(reader.png, reader.info), height);
    // Deflate, the only codec of PNG, reaches 1032:1.
    check_file_can_hold(
        name, png_get_rowbytes(reader.png, reader.info) * static_cast<std::uint64_t>(height),
        file_bytes, 1032);

    if (!succeeds(reader.png, [&] { expand(reader); })) bad_file();
    CodedImage image(static_cast<int>(png_get_image_width(reader.png, reader.info)),
                     static_cast<int>(height), png_get_channels(reader.png, reader.info),
                     png_get_bit_depth(reader.png, reader.info));
    const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
    std::vector<png_byte> bytes(row_bytes * static_cast<std::size_t>(height));
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        rows.push_back(&bytes[y * row_bytes]);
    const bool complete = succeeds(reader.png, [&] {
        png_read_image(reader.png, rows.data());
        png_read_end(reader.png, nullptr);
    });
    if (!complete) bad_file();
    unpack(bytes, image);
    return image;
}

}  // namespace lamina
