// SPDX-License-Identifier: Apache-2.0
#include "study/picture_sheet.h"

#include <algorithm>
#include <cassert>

#include "base/atomic_file.h"
#include "image/png.h"
#include "image/srgb.h"

namespace lamina::study {
namespace {

constexpr int gap = 4;  // pixels

int extent(std::size_t count, int size) {
    return static_cast<int>(count) * (size + gap) - gap;
}

void paste(CodedImage& sheet, const CodedImage& picture, int column, int row) {
    for (int y = 0; y < picture.height; ++y) {
        std::copy_n(picture.codes.begin() + 3 * y * picture.width, 3 * picture.width,
                    sheet.codes.begin() + 3 * ((row + y) * sheet.width + column));
    }
}

}  // namespace

CodedImage shown(const Image& image, ImageColorSpace space) {
    CodedImage coded(image.width, image.height, 3, 8);
    for (std::size_t i = 0; i < coded.codes.size(); ++i)
        coded.codes[i] = display_code(static_cast<double>(image.rgba[i / 3 * 4 + i % 3]), space);
    return coded;
}

void write_sheet(const std::filesystem::path& path,
                 const std::vector<std::vector<CodedImage>>& rows) {
    const int width = rows.front().front().width, height = rows.front().front().height;
    std::size_t columns = 0;
    for (const auto& row : rows) columns = std::max(columns, row.size());
    CodedImage sheet(extent(columns, width), extent(rows.size(), height), 3, 8);
    std::fill(sheet.codes.begin(), sheet.codes.end(), std::uint16_t{255});
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (std::size_t column = 0; column < rows[row].size(); ++column) {
            const CodedImage& picture = rows[row][column];
            assert(picture.width == width && picture.height == height && picture.channels == 3);
            paste(sheet, picture, static_cast<int>(column) * (width + gap),
                  static_cast<int>(row) * (height + gap));
        }
    }
    AtomicFile png(path);
    write_png(png, sheet);
    png.commit();
}

void write_pictures(const std::filesystem::path& path, const std::vector<Image>& pictures) {
    std::vector<CodedImage> row;
    for (const Image& picture : pictures) row.push_back(shown(picture));
    write_sheet(path, {row});
}

}  // namespace lamina::study
