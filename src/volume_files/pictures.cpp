// SPDX-License-Identifier: Apache-2.0
#include <stdio.h>  // before jpeglib.h, which needs FILE

#include <jpeglib.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "image/png.h"
#include "volume_files/byte_readers.h"
#include "volume_files/isolated_process.h"
#include "volume_files/numbered_files.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Max bytes of samples for one byte of a file. PNG: deflate's (byte_readers.h), and samples of 1
// bit become bytes. JPEG: a block of 64 samples takes 2 bits or more (ITU-T T.81, F.1.2), or far
// less in scans of runs of empty blocks (G.1.2.2).
constexpr std::uint64_t most_png_expansion = gzip_expansion * 8, most_jpeg_expansion = 65536;

bool has_png_mark(const Path& path) {
    return file_beginning(path, 8) == "\x89PNG\r\n\x1a\n";
}

bool has_picture_mark(const Path& path) {
    return has_png_mark(path) || file_beginning(path, 3) == "\xff\xd8\xff";
}

// The form of a picture, as its header says it; all pictures of a stack have the same.
struct PictureKind {
    std::int64_t width = 0, height = 0;
    int channels = 1;     // grey, grey and alpha, RGB or RGBA
    int bits = 8;         // of a sample, as it is read: 8 or 16
    int stored_bits = 8;  // of a sample, as it is stored
    bool has_palette = false;

    bool operator==(const PictureKind&) const = default;
    std::string text() const {
        return fmt::format("{} x {} pixels of {} {}-bit samples", width, height, channels,
                           stored_bits);
    }
};

// Things that pictures say and that are not used. The first picture that says one counts.
struct PictureNotes {
    double height_of_pixels = 1;   // in their widths
    bool has_transparent = false;  // PNG's tRNS
    int orientation = 1;           // EXIF's; 1: the first pixel is at the top left
};

// Returns the number that bytes hold, the highest first.
std::int64_t big_number(std::string_view bytes) {
    return static_cast<std::int64_t>(number_of_bytes(bytes, true));
}

// Notes how far pixels of so many a length along x and y are from squares.
void note_densities(std::int64_t x, std::int64_t y, PictureNotes& notes) {
    constexpr double rounding = 1e-3;  // of whole pixels a metre
    const double ratio = x > 0 && y > 0 ? static_cast<double>(x) / static_cast<double>(y) : 1;
    if (notes.height_of_pixels == 1 && std::abs(ratio - 1) > rounding)
        notes.height_of_pixels = ratio;
}

// Notes the Orientation in EXIF data, which have the form of a TIFF file (CIPA DC-008, 4.6.4).
void note_orientation(std::string_view exif, PictureNotes& notes) {
    const auto number = [&](std::size_t at, std::size_t count) {
        return number_of_bytes(exif.substr(std::min(at, exif.size()), count),
                               !exif.starts_with("II"));
    };
    constexpr std::size_t entry_bytes = 12, orientation = 0x0112;
    const std::size_t first = number(4, 4), count = number(first, 2);
    for (std::size_t i = 0; i < count && notes.orientation == 1; ++i) {
        const std::size_t entry = first + 2 + i * entry_bytes;
        if (entry + entry_bytes > exif.size()) break;
        const std::size_t found = number(entry, 2) == orientation ? number(entry + 8, 2) : 1;
        if (found >= 1 && found <= 8) notes.orientation = static_cast<int>(found);
    }
}

// Reads the chunks before a PNG file's pixels that say something of them (ISO/IEC 15948, 11.3).
void note_png(const Path& path, PictureNotes& notes) {
    const RandomAccessFile file(path);
    constexpr int most_chunks = 10000;
    constexpr std::size_t most_bytes = 65536;  // of a chunk, as EXIF data have in JPEG
    std::uint64_t at = 8;
    for (int chunk = 0; chunk < most_chunks; ++chunk) {
        std::string head(8, '\0'), data;
        if (file.read_some(at, head.data(), head.size()) < head.size()) break;
        const auto length = static_cast<std::size_t>(big_number(head.substr(0, 4)));
        const std::string kind = head.substr(4);
        if (kind == "IDAT" || kind == "IEND") break;
        if (kind == "pHYs" || kind == "eXIf") {
            data.resize(std::min(most_bytes, length));
            data.resize(file.read_some(at + 8, data.data(), data.size()));
        }
        const std::string_view bytes = data;
        notes.has_transparent |= kind == "tRNS";
        if (kind == "eXIf") note_orientation(bytes, notes);
        if (kind == "pHYs" && data.size() == 9)
            note_densities(big_number(bytes.substr(0, 4)), big_number(bytes.substr(4, 4)), notes);
        at += 12 + length;
    }
}

// Notes what an APP0 (JFIF) or APP1 segment (EXIF) says of a JPEG file's pixels.
void note_segment(std::string_view segment, PictureNotes& notes) {
    if (segment.starts_with(std::string_view("JFIF\0", 5)) && segment.size() >= 12)
        note_densities(big_number(segment.substr(8, 2)), big_number(segment.substr(10, 2)), notes);
    if (segment.starts_with(std::string_view("Exif\0\0", 6)))
        note_orientation(segment.substr(6), notes);
}

// Reads the chunk IHDR, the first of a PNG file (ISO/IEC 15948, 11.2.2).
PictureKind png_kind(const Path& path) {
    const std::string header = file_beginning(path, 26);
    const std::string_view bytes = header;
    constexpr int channels_of[] = {1, 0, 3, 3, 2, 0, 4};  // by colour type
    const int colour = header.size() < 26 ? 7 : static_cast<unsigned char>(header[25]);
    if (colour > 6 || channels_of[colour] == 0 || bytes.substr(12, 4) != "IHDR")
        fail("{}: cannot read as PNG: damaged or truncated header", path.string());
    const int bits = static_cast<unsigned char>(header[24]);
    return {big_number(bytes.substr(16, 4)),
            big_number(bytes.substr(20, 4)),
            channels_of[colour],
            bits == 16 ? 16 : 8,
            bits,
            colour == 3};
}

// Reads the frame header of a JPEG file (ITU-T T.81, B.2.2), which lies behind other segments.
PictureKind jpeg_kind(const Path& path, PictureNotes& notes) {
    const RandomAccessFile file(path);
    constexpr int most_segments = 10000;
    std::uint64_t at = 2;
    for (int segment = 0; segment < most_segments; ++segment) {
        std::string bytes(10, '\0');
        if (file.read_some(at, bytes.data(), bytes.size()) < bytes.size() || bytes[0] != '\xff')
            break;
        const auto marker = static_cast<unsigned char>(bytes[1]);
        if (marker == 0xff) {  // a fill byte
            ++at;
            continue;
        }
        const bool is_frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        const std::string_view found = bytes;
        if (!is_frame) {
            if (marker == 0xe0 || marker == 0xe1) {
                std::string content(static_cast<std::size_t>(big_number(found.substr(2, 2))), '\0');
                content.resize(file.read_some(at + 4, content.data(), content.size()));
                note_segment(content, notes);
            }
            at += 2 + static_cast<std::uint64_t>(big_number(found.substr(2, 2)));
            continue;
        }
        const int bits = found[4], components = found[9];
        if (bits != 8 || (components != 1 && components != 3)) {
            fail("{}: found {} components of {} bits, expected 1 (grey) or 3 (colours) of 8",
                 path.string(), components, bits);
        }
        return {big_number(found.substr(7, 2)), big_number(found.substr(5, 2)), components};
    }
    fail("{}: cannot read as JPEG: damaged or truncated header", path.string());
}

// A JPEG file that libjpeg decodes. Its errors, which leave libjpeg by longjmp(), become Errors.
class JpegFile {
  public:
    explicit JpegFile(const Path& path) : name_(path.string()), file_(open_to_read(path)) {
        state_.err = jpeg_std_error(&errors_);
        state_.client_data = this;
        errors_.error_exit = [](j_common_ptr state) {
            auto* const self = static_cast<JpegFile*>(state->client_data);
            state->err->format_message(state, self->message_);
            std::longjmp(self->leave_, 1);
        };
        // Warnings are about data that are damaged or end too early.
        errors_.emit_message = [](j_common_ptr state, int level) {
            if (level < 0) state->err->error_exit(state);
        };
        jpeg_create_decompress(&state_);
        guarded([&] {
            jpeg_stdio_src(&state_, file_.get());
            jpeg_read_header(&state_, TRUE);
        });
        state_.out_color_space = state_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    }
    JpegFile(const JpegFile&) = delete;
    JpegFile& operator=(const JpegFile&) = delete;
    ~JpegFile() { jpeg_destroy_decompress(&state_); }

    // Reads one channel of all pixels, row by row, of a picture that jpeg_kind() has found.
    void read(const PictureKind& kind, int channel, char* to) {
        // A damaged file may have a second frame, to which libjpeg comes by another way.
        if (PictureKind{state_.image_width, state_.image_height, state_.num_components} != kind) {
            fail("{}: damaged: libjpeg finds {} x {} pixels of {} samples, expected {}", name_,
                 state_.image_width, state_.image_height, state_.num_components, kind.text());
        }
        const auto channels = static_cast<std::size_t>(state_.num_components);
        std::vector<JSAMPLE> row(state_.image_width * channels);
        JSAMPROW rows[] = {row.data()};
        guarded([&] { jpeg_start_decompress(&state_); });
        while (state_.output_scanline < state_.output_height) {
            guarded([&] { jpeg_read_scanlines(&state_, rows, 1); });
            for (std::size_t x = 0; x < state_.image_width; ++x)
                *to++ = static_cast<char>(row[x * channels + static_cast<std::size_t>(channel)]);
        }
        guarded([&] { jpeg_finish_decompress(&state_); });
    }

  private:
    // Calls libjpeg in `body`, which must own no objects with destructors. It is not inlined,
    // because longjmp() would leave its caller's variables undefined.
    template <typename Body>
    [[gnu::noinline]] void guarded(const Body& body) {
        if (setjmp(leave_) != 0) fail("{}: cannot read as JPEG: {}", name_, one_line(message_));
        body();
    }

    std::string name_;
    OpenedFile file_;
    jpeg_decompress_struct state_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf leave_{};
    char message_[JMSG_LENGTH_MAX] = "";
};

// Reads one channel of a picture, row by row.
void read_picture(const Path& path, const PictureKind& kind, int channel, char* to) {
    check_interrupt();
    if (!has_png_mark(path)) return JpegFile(path).read(kind, channel, to);
    const CodedImage image = read_png(path);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = static_cast<std::size_t>(channel); i < image.codes.size(); i += channels) {
        if (kind.bits == 16) std::memcpy(to, &image.codes[i], 2);
        if (kind.bits == 8) *to = static_cast<char>(image.codes[i]);
        to += kind.bits / 8;
    }
}

// Returns the kind of all files, and what they say beside it. Throws Error if they differ, or if
// one cannot hold its samples.
PictureKind kind_of_pictures(const std::vector<Path>& files, PictureNotes& notes) {
    PictureKind first;
    for (const Path& path : files) {
        check_interrupt();
        const bool png = has_png_mark(path);
        const PictureKind kind = png ? png_kind(path) : jpeg_kind(path, notes);
        if (png) note_png(path, notes);
        if (&path == &files[0]) first = kind;
        if (kind != first) {
            fail("{}: found {}, expected {} as in {}", path.string(), kind.text(), first.text(),
                 files[0].filename().string());
        }
        const StoredAxis axes[] = {kind.width, kind.height, kind.channels};
        const std::size_t bytes =
            stored_bytes(path.string(), axes, static_cast<std::size_t>(kind.bits / 8));
        const std::uint64_t stored = std::filesystem::file_size(path);
        if (bytes == 0 || bytes / (png ? most_png_expansion : most_jpeg_expansion) > stored) {
            fail("{}: found {} ({} bytes), which {} bytes of a file cannot hold", path.string(),
                 kind.text(), bytes, stored);
        }
    }
    return first;
}

void warn_of_codes(const std::string& name, const PictureKind& kind) {
    if (kind.channels > 2)
        say("{}: its pixels are colours{}, which are read as channels", name,
            kind.has_palette ? " of a palette" : "");
    if (kind.stored_bits < 8 && !kind.has_palette)
        say("{}: its {} bits of grey are stretched to 0 to 255", name, kind.stored_bits);
}

void warn_of_notes(const std::string& name, const PictureNotes& notes) {
    if (notes.height_of_pixels != 1)
        say("{}: it says that pixels are {:.4g} times as high as wide, which is not "
            "used: \"spacing\" in the volume sets distances",
            name, notes.height_of_pixels);
    if (notes.has_transparent) say("{}: its transparent colours (PNG's tRNS) are not used", name);
    if (notes.orientation != 1)
        say("{}: its Orientation {} says that the first pixel is not at the top left: "
            "pixels are in the order in which they are stored",
            name, notes.orientation);
}

}  // namespace

bool is_pictures(const Path& path) {
    if (!std::filesystem::is_directory(path)) return has_picture_mark(path);
    const std::vector<Path> files = files_in_folder(path);
    return 2 * std::ranges::count_if(files, has_picture_mark) > std::ssize(files);
}

Volume open_pictures(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    const std::string name = path.string();
    const std::vector<Path> files = files_of_pictures(path);
    if (files.empty()) fail("{}: found no PNG or JPEG file in the folder", name);
    warn_of_series(name, "PNG or JPEG", files);
    PictureNotes notes;
    const PictureKind kind = kind_of_pictures(files, notes);
    const StoredAxis channel = taken_axis(name, "channel", request.channel, kind.channels);
    warn_of_codes(name, kind);
    warn_of_notes(name, notes);
    say_taken(name, {&channel, 1});
    if (use.contents != nullptr && kind.channels > 1) {
        use.contents->is_colour = kind.channels > 2;
        use.contents->channels = {"red", "green", "blue", "alpha"};
        if (kind.channels == 2) use.contents->channels = {"grey", "alpha"};
        use.contents->channels.resize(static_cast<std::size_t>(kind.channels));
    }
    const StoredAxis sizes[] = {kind.width, kind.height, std::ssize(files)};
    const auto word = static_cast<std::size_t>(kind.bits / 8);
    const std::size_t bytes = stored_bytes(name, sizes, word), each = bytes / files.size();
    expect_room(name, bytes, use, "pictures are read as a whole");
    StoredSamples samples{name, word == 1 ? ValueType::uint8 : ValueType::uint16, nullptr};
    // Decoders take up to 16 bytes for a pixel of a few pictures (CodedImage, libjpeg's scans).
    const std::size_t decoded = bytes * static_cast<std::size_t>(kind.channels);
    const std::size_t largest = each * static_cast<std::size_t>(kind.channels) + 16 * each;
    const auto read = [&](std::size_t first, std::size_t end, char* to) {
        for (std::size_t i = first; i < end; ++i)
            read_picture(files[i], kind, static_cast<int>(*channel.taken), to + i * each);
    };
    samples.bytes =
        isolated_bytes(name, "libpng or libjpeg", bytes, decoded, largest, files.size(), read);
    return drawn_volume(plain_grid({kind.width, kind.height, std::ssize(files)}), samples,
                        use.lookup);
}

std::vector<Path> files_of_pictures(const Path& path) {
    return known_files_in(path, has_picture_mark);
}

}  // namespace lamina
