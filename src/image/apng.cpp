// SPDX-License-Identifier: Apache-2.0
#include "image/apng.h"

#include <zlib.h>

#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace lamina {
namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";

std::string big_endian(std::uint32_t value, int bytes = 4) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
        text += static_cast<char>(value >> shift & 255);
    return text;
}

using Chunks = std::vector<std::pair<std::string_view, std::string_view>>;  // type and content

Chunks chunks_of(std::string_view png) {
    constexpr std::size_t around = 12;  // bytes of length, type and check sum
    const auto require = [](bool good) {
        if (!good) fail("a frame is no whole PNG file");
    };
    require(png.substr(0, signature.size()) == signature);
    png.remove_prefix(signature.size());
    Chunks chunks;
    while (!png.empty()) {
        require(png.size() >= around);
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i)
            length = length << 8 | static_cast<unsigned char>(png[i]);
        require(length <= png.size() - around);
        chunks.emplace_back(png.substr(4, 4), png.substr(8, length));
        png.remove_prefix(around + length);
    }
    require(!chunks.empty() && chunks.front().first == "IHDR" && chunks.back().first == "IEND" &&
            chunks.front().second.size() == 13);
    return chunks;
}

}  // namespace

AnimatedPng::AnimatedPng(OutputFile& file, std::uint32_t frames, int rate)
    : file_(file), frames_(frames), rate_(rate) {}

void AnimatedPng::write_chunk(const std::string& type, const std::string& content) {
    const std::string body = type + content;
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    file_.write(big_endian(static_cast<std::uint32_t>(content.size())) + body +
                big_endian(static_cast<std::uint32_t>(sum)));
}

std::string AnimatedPng::next_number() {
    return big_endian(number_++);
}

void AnimatedPng::add(const std::string& png) {
    const Chunks chunks = chunks_of(png);
    const bool first = header_.empty();
    if (first) {
        header_ = chunks.front().second;
        file_.write(std::string(signature));
        write_chunk("IHDR", header_);
        write_chunk("acTL", big_endian(frames_) + big_endian(0));  // 0: for ever
        for (const auto& [type, content] : chunks)
            if (type == "sRGB") write_chunk("sRGB", std::string(content));
    } else if (chunks.front().second != header_) {
        fail("frames differ in size or kind: expected equal ones");
    }
    // The frame covers the picture, at (0, 0), for 1 / rate seconds, and replaces what was there.
    write_chunk("fcTL", next_number() + header_.substr(0, 8) + big_endian(0) + big_endian(0) +
                            big_endian(1, 2) + big_endian(static_cast<std::uint32_t>(rate_), 2) +
                            std::string(2, '\0'));
    for (const auto& [type, content] : chunks) {
        if (type != "IDAT") continue;
        if (first)
            write_chunk("IDAT", std::string(content));
        else
            write_chunk("fdAT", next_number() + std::string(content));
    }
}

void AnimatedPng::end() {
    write_chunk("IEND", "");
}

}  // namespace lamina
