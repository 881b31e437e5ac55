// SPDX-License-Identifier: Apache-2.0
#pragma once

// Fills shapes with exact coverage of pixels, by arithmetic that gives the same bits on every
// machine: sums, products, quotients and square roots of doubles.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <vector>

#include "lamina/image.h"

namespace lamina {

// Closed polygons; x to the right and y down, in pixels from the picture's upper left corner.
class Outline {
  public:
    void move_to(const glm::dvec2& point) { contours_.push_back({point}); }
    void line_to(const glm::dvec2& point) { contours_.back().push_back(point); }
    // Adds a quadratic Bezier curve as lines that stay within 1/50 of a pixel of it.
    void curve_to(const glm::dvec2& control, const glm::dvec2& end);
    const std::vector<std::vector<glm::dvec2>>& contours() const { return contours_; }

  private:
    std::vector<std::vector<glm::dvec2>> contours_;
};

struct Rectangle {
    double left = 0, top = 0, width = 0, height = 0;

    double right() const { return left + width; }
    double bottom() const { return top + height; }
};

Outline outline_of(const Rectangle& rectangle);
// Returns the outline of a straight line from `a` to `b` with square ends.
Outline line_outline(const glm::dvec2& a, const glm::dvec2& b, double thickness);
// Returns the outline of an ellipse, of 48 edges: of a disk if both radii are equal.
Outline disk_outline(const glm::dvec2& center, double radius);

// Colour in the picture's space, not associated.
struct Paint {
    glm::dvec3 color{0};
    double opacity = 1;
    // Edges are blended in linear light, in which thin dark strokes look thinner, and thin light
    // ones bolder, than in display values: coverage is changed to make up for that.
    enum class Edges { as_covered, of_dark_text, of_light_text } edges = Edges::as_covered;
};

// An associated RGBA picture that shapes are laid over.
class Canvas {
  public:
    Canvas(int width, int height, ImageColorSpace space);

    int width() const { return layer_->width; }
    int height() const { return layer_->height; }
    ImageColorSpace space() const { return layer_->space; }

    // Lays a shape over the picture. Parts outside of it are cut off. Where contours overlap,
    // orientations add up: holes are the other way round.
    void fill(const Outline& path, const Paint& paint);
    void fill(const Rectangle& rectangle, const Paint& paint) {
        fill(outline_of(rectangle), paint);
    }
    void line(const glm::dvec2& a, const glm::dvec2& b, double thickness, const Paint& paint) {
        fill(line_outline(a, b, thickness), paint);
    }

    std::shared_ptr<const Image> take() { return std::move(layer_); }

  private:
    void lay(int column, int row, double coverage, const Paint& paint);

    std::shared_ptr<Image> layer_;
    std::vector<double> areas_;  // of rows of the shape that is filled; zeros between shapes
};

}  // namespace lamina
