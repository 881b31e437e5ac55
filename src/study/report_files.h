// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/input_file.h"
#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina::study {

// Writes a file through AtomicFile, so that it is complete or unchanged. Throws Error.
void write_text(const std::filesystem::path& path, const std::string& text);

// A table in CSV: a line of column names, then one line for each row.
class CsvTable {
  public:
    explicit CsvTable(const std::vector<std::string>& columns);
    // Adds a row with as many cells as columns, as text.
    void add_row(const std::vector<std::string>& cells);
    const std::string& text() const { return text_; }

  private:
    std::size_t columns_;
    std::string text_;
};

// Returns norms as {linf, l1, l2}, in 1/255.
nlohmann::ordered_json to_json(const ErrorNorms& norms);

// Returns errors as {channels: {R: norms, ...}, all: norms}, as `lamina compare --json` prints
// them.
nlohmann::ordered_json to_json(const ImageError& error);

// Returns the picture as 8-bit sRGB codes, three channels, on black, as a PNG has it.
CodedImage shown(const Image& image, ImageColorSpace space = ImageColorSpace::linear);

// Returns the divisor by which the sides are reduced to at most `largest` pixels.
int reduction(int width, int height, int largest = 256);

// Returns the picture reduced by means over squares of `step` x `step` pixels.
Image reduced(const Image& image, int step);
// Returns the difference reduced to the largest |e| of each square, so that no error is averaged
// away.
Difference reduced(const Difference& difference, int step);

// Returns an RGB picture of 8 bits as "data:image/png;base64,...".
std::string data_uri(const CodedImage& image);
// Returns bytes of a media type as "data:...;base64,...".
std::string data_uri(const std::string& type, const std::string& bytes);

// Escapes the characters <, > and & of a text that stands between tags of HTML or SVG.
std::string escaped_markup(const std::string& text);

// Returns the files of share/report, sorted by name. cmake/EmbedFiles.cmake generates this
// function.
std::span<const EmbeddedFile> embedded_report_files();

// Returns one HTML page that shows a report (results.json of a study or a cross-check). It is made
// from page.html of share/report, with its style, its scripts and the report inside, and makes no
// network requests. Without JavaScript it shows title, summary and findings. Bytes that are not
// UTF-8 are shown as U+FFFD, and control characters as \n, \t and \xNN. `report` has "title" and
// "findings": a list of strings, or of {anchor, text} if the finding links to the section `anchor`
// (letters, digits and _). Its "summary", one line, may be missing.
std::string report_page(const nlohmann::ordered_json& report);

}  // namespace lamina::study
