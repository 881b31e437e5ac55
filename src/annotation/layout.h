// SPDX-License-Identifier: Apache-2.0
#pragma once

// Blocks of annotations, and their places in the picture.

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "annotation/annotation_layer.h"
#include "annotation/canvas.h"
#include "annotation/font.h"
#include "lamina/annotations.h"
#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina {

// Colours and sizes that suit a picture.
struct AnnotationStyle {
    explicit AnnotationStyle(const Scene& scene);

    // Tells whether a rectangle lies in the picture.
    bool holds(const Rectangle& place) const {
        return place.left >= 0 && place.top >= 0 && place.right() <= width &&
               place.bottom() <= height;
    }
    // Returns a colour of display values, 0..1, as a number of the picture's space.
    glm::dvec3 shade(const glm::dvec3& display) const;
    Paint text_paint(double opacity = 1) const;
    Paint line_paint(double opacity = 1) const { return {ink, opacity, Paint::Edges::as_covered}; }
    // Thickness of lines in pixels, for text of this size.
    double thickness(double size) const { return size / 12 > 1 ? size / 12 : 1; }

    int width, height;
    ImageColorSpace space;
    bool dark_ink;          // on a light background
    glm::dvec3 ink, paper;  // of text and lines, and of what lies under them: the background
    double em;              // size of normal text, in pixels
    double gap;             // distance from the picture's edges and between blocks, in pixels
};

// Largest width of a name or unit of a file, in ems.
constexpr double widest_name = 9;

// How far from the anchor a text begins: at its left end, its middle or its right end.
enum class Align { left, center, right };

// Draws text and lines of a style. Without a canvas it only measures.
class Pen {
  public:
    Pen(const AnnotationStyle& of_picture, Font& of_text, Canvas* canvas)
        : style(of_picture), font(of_text), canvas_(canvas) {}

    double width(std::string_view text, double size) { return font.width(text, size); }
    // Shortens a name or unit of a file, which may have any length, to `widest_name`.
    std::string fitted_name(std::string_view name, double size) {
        return font.fitted(name, size, widest_name * size);
    }
    // Writes a line of text on the base line through `anchor`, which moves to a whole row.
    void text(std::string_view line, const glm::dvec2& anchor, double size,
              Align align = Align::left);
    // Writes it vertically centred about `anchor`.
    void text_beside(std::string_view line, const glm::dvec2& anchor, double size,
                     Align align = Align::left);
    Canvas& canvas() { return *canvas_; }

    const AnnotationStyle& style;
    Font& font;

  private:
    Canvas* canvas_;
};

// Something that is drawn into a rectangle of the picture.
struct Block {
    std::string key;  // of the scene, for messages
    AnnotationPosition position = AnnotationPosition::top_left;
    glm::dvec2 size{0};      // pixels
    bool makes_room = true;  // an automatic camera leaves room for it
    std::function<void(Pen&, const glm::dvec2& top_left)> draw;
    // Rank: blocks of lower numbers go first where not all of them fit.
    int rank = 0;
    // Largest size in any view, so that what fits does not change in a film; `size` is not larger.
    glm::dvec2 largest{0};
    std::string note = {};  // what is not shown as asked, for a warning; empty: nothing
};

bool overlap(const Rectangle& a, const Rectangle& b);

// Sets blocks to their places: those of one place stand below each other, in their order.
std::vector<Rectangle> placed(const std::vector<Block>& blocks, const AnnotationStyle& style);

// Takes the blocks out that reach beyond the picture or overlap one of lower rank, of equal ranks
// the first stays; and those without room of their own that reach beyond the picture's middle.
// Returns their keys.
std::vector<std::string> take_misfits(std::vector<Block>& blocks, const AnnotationStyle& style);

// Returns the height in the middle of a side of the picture that blocks above and below leave to
// one that stands there.
double free_height(const std::vector<Block>& blocks, AnnotationPosition side,
                   const AnnotationStyle& style);

PictureMargins margins_of(const std::vector<Block>& blocks, const AnnotationStyle& style);

std::vector<std::string_view> lines_of(std::string_view text);  // parted by "\n" or "\r\n"

// Makes a block of lines of text. Lines that are wider than the picture are written smaller, as far
// as letters can be read, and then cut.
Block text_block(Pen& pen, const Annotation& annotation, double size, const std::string& key,
                 AnnotationPosition position);

}  // namespace lamina
