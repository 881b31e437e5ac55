// SPDX-License-Identifier: Apache-2.0
#include "annotation/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

// Rows of a shape whose areas are in memory at once: 33 MB in a picture of 65,536 columns.
constexpr int most_rows = 64;

// Largest distance of a curve from its lines, in pixels.
constexpr double flatness = 0.02;

// Returns about linear_from_srgb(stored), within .002, without powers, whose last bits differ
// between libraries.
double light_of(double stored) {
    return stored * (stored * (stored * 0.305306011 + 0.682171111) + 0.012522878);
}

double blended_coverage(double coverage, const Paint& paint, ImageColorSpace space) {
    if (space == ImageColorSpace::display) return coverage;
    switch (paint.edges) {
        case Paint::Edges::as_covered:
            return coverage;
        case Paint::Edges::of_dark_text:
            return 1 - light_of(1 - coverage);
        case Paint::Edges::of_light_text:
            return light_of(coverage);
    }
    return coverage;
}

// A part of the picture, columns and rows from first to end, end not included.
struct Part {
    int left, top, right, bottom;

    int width() const { return right - left; }
};

Part part_of(const Outline& path, int width, int height) {
    glm::dvec2 least(INFINITY), most(-INFINITY);
    for (const auto& contour : path.contours()) {
        for (const glm::dvec2& point : contour) {
            least = glm::min(least, point);
            most = glm::max(most, point);
        }
    }
    const auto inside = [](double place, int size) {
        return static_cast<int>(std::clamp(place, 0.0, double(size)));
    };
    return {inside(std::floor(least.x), width), inside(std::floor(least.y), height),
            inside(std::ceil(most.x), width), inside(std::ceil(most.y), height)};
}

// Tells whether a sum of edges is an area: sums that cancel leave rounding errors.
bool covers(double area) {
    return std::abs(area) > 1e-9;
}

// The area of a shape in each pixel, by edges: an edge that goes down by dy in a row of pixels adds
// dy to the area of all pixels right of it, and its share to those that it crosses. Sums along a
// row are then areas, with the sign of the shape's orientation. `areas`: memory of zeros, which
// sweep() leaves as such; `part` has at most `most_rows` rows.
class Areas {
  public:
    Areas(const Part& part, std::vector<double>& areas) : part_(part), areas_(areas) {
        // One more a row takes what edges beyond the right end add.
        const std::size_t size = static_cast<std::size_t>(part.width() + 1) *
                                 static_cast<std::size_t>(part.bottom - part.top);
        if (areas_.size() < size) areas_.resize(size, 0.0);
        touched_.fill({part.width(), -1});
    }

    void edge(glm::dvec2 a, glm::dvec2 b) {
        if (a.y == b.y) return;
        const double sign = a.y < b.y ? 1 : -1;
        if (sign < 0) std::swap(a, b);
        const double slope = (b.x - a.x) / (b.y - a.y);
        const int first =
            std::max(part_.top, static_cast<int>(std::floor(std::clamp(a.y, -1.0, 1e6))));
        for (int row = first; row < part_.bottom && row < b.y; ++row) {
            const double from = std::max(a.y, double(row)), to = std::min(b.y, double(row + 1));
            if (!(to > from)) continue;
            in_row(row, sign * (to - from), a.x + (from - a.y) * slope, a.x + (to - a.y) * slope);
        }
    }

    // Calls cover(column, area) for the pixels of a row that edges cross and for those between
    // them, and sets the row's memory to zeros.
    template <typename Cover>
    void sweep(int row, const Cover& cover) {
        const Touched touched = touched_[static_cast<std::size_t>(row - part_.top)];
        double* const areas = at(row);
        double area = 0;
        int column = touched.first;
        for (; column <= touched.last && column < part_.width(); ++column) {
            area += areas[column];
            cover(part_.left + column, area);
        }
        if (touched.first <= touched.last)
            std::fill(areas + touched.first, areas + touched.last + 1, 0.0);
        // Edges beyond the picture's right end would close the shape.
        if (!covers(area)) return;
        for (; column < part_.width(); ++column) cover(part_.left + column, area);
    }

  private:
    struct Touched {
        int first, last;  // columns of the part
    };

    void touch(int row, int first, int last) {
        Touched& touched = touched_[static_cast<std::size_t>(row - part_.top)];
        touched.first = std::min(touched.first, first);
        touched.last = std::max(touched.last, last);
    }

    double* at(int row) const {
        return areas_.data() + static_cast<std::size_t>(row - part_.top) *
                                   static_cast<std::size_t>(part_.width() + 1);
    }

    // Adds a piece of an edge within a row, which goes down by |height| from x0 to x1.
    void in_row(int row, double height, double x0, double x1) {
        const double end = part_.width();
        double lo = std::min(x0, x1) - part_.left, hi = std::max(x0, x1) - part_.left;
        double* const areas = at(row);
        if (hi <= 0) {
            areas[0] += height;
            return touch(row, 0, 0);
        }
        if (!(lo < end)) return;
        if (lo < 0) {  // the part left of the picture covers whole rows
            const double share = -lo / (hi - lo);
            areas[0] += height * share;
            touch(row, 0, 0);
            height -= height * share;
            lo = 0;
        }
        if (hi > end) {
            height *= (end - lo) / (hi - lo);
            hi = end;
        }
        const int first = std::min(static_cast<int>(lo), part_.width() - 1);
        touch(row, first, across(areas, first, height, lo, hi));
    }

    // Adds a piece from lo to hi, both between 0 and the width. Returns the last column that it
    // changes.
    static int across(double* areas, int first, double height, double lo, double hi) {
        if (hi <= first + 1) {
            const double right_of_it = first + 1 - 0.5 * (lo + hi);
            areas[first] += height * right_of_it;
            areas[first + 1] += height * (1 - right_of_it);
            return first + 1;
        }
        const double per_column = height / (hi - lo);
        double place = lo;
        int column = first;
        for (; place < hi; ++column) {
            const double next = std::min(hi, double(column + 1));
            const double piece = per_column * (next - place);
            const double right_of_it = column + 1 - 0.5 * (place + next);
            areas[column] += piece * right_of_it;
            areas[column + 1] += piece * (1 - right_of_it);
            place = next;
        }
        return column;
    }

    Part part_;
    std::vector<double>& areas_;
    std::array<Touched, most_rows> touched_{};  // of each row
};

}  // namespace

void Outline::curve_to(const glm::dvec2& control, const glm::dvec2& end) {
    const glm::dvec2 start = contours_.back().back();
    // A curve is at most |start - 2 control + end| / 8 away from its chord; n pieces divide that
    // by n^2.
    const double bend = glm::length(start - 2.0 * control + end) / 8;
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::sqrt(bend / flatness))), 1, 64);
    for (int i = 1; i <= pieces; ++i) {
        const double t = double(i) / pieces, s = 1 - t;
        line_to(s * s * start + 2 * s * t * control + t * t * end);
    }
}

Outline outline_of(const Rectangle& r) {
    Outline path;
    path.move_to({r.left, r.top});
    path.line_to({r.left, r.bottom()});
    path.line_to({r.right(), r.bottom()});
    path.line_to({r.right(), r.top});
    return path;
}

Outline line_outline(const glm::dvec2& a, const glm::dvec2& b, double thickness) {
    const double length = glm::length(b - a);
    const glm::dvec2 along =
        length > 0 ? (0.5 * thickness / length) * (b - a) : glm::dvec2(0.5 * thickness, 0);
    const glm::dvec2 across(-along.y, along.x);
    Outline path;
    path.move_to(a - across);
    path.line_to(b - across);
    path.line_to(b + across);
    path.line_to(a + across);
    return path;
}

Outline disk_outline(const glm::dvec2& center, double radius) {
    // Curves through the middles of the edges of a regular octagon around the circle; sqrt(2) - 1
    // is half an edge.
    const double half = (std::sqrt(2.0) - 1) * radius;
    const glm::dvec2 corners[] = {{radius, half},  {half, radius},   {-half, radius},
                                  {-radius, half}, {-radius, -half}, {-half, -radius},
                                  {half, -radius}, {radius, -half}};
    Outline path;
    path.move_to(center + 0.5 * (corners[7] + corners[0]));
    for (int i = 0; i < 8; ++i)
        path.curve_to(center + corners[i], center + 0.5 * (corners[i] + corners[(i + 1) % 8]));
    return path;
}

Canvas::Canvas(int width, int height, ImageColorSpace space)
    : layer_(std::make_shared<Image>(width, height)) {
    layer_->space = space;
}

void Canvas::fill(const Outline& path, const Paint& paint) {
    const Part part = part_of(path, width(), height());
    if (part.left >= part.right || part.top >= part.bottom) return;
    for (int top = part.top; top < part.bottom; top += most_rows) {
        const Part band{part.left, top, part.right, std::min(top + most_rows, part.bottom)};
        Areas areas(band, areas_);
        for (const auto& contour : path.contours()) {
            for (std::size_t i = 0; i < contour.size(); ++i)
                areas.edge(contour[i], contour[(i + 1) % contour.size()]);
        }
        for (int row = band.top; row < band.bottom; ++row) {
            areas.sweep(row, [&](int column, double area) {
                const double covered = std::min(std::abs(area), 1.0);
                if (covers(covered)) lay(column, row, covered > 1 - 1e-9 ? 1 : covered, paint);
            });
        }
    }
}

void Canvas::lay(int column, int row, double coverage, const Paint& paint) {
    const double share = paint.opacity * blended_coverage(coverage, paint, space());
    float* const rgba = layer_->pixel(column, row);
    for (int c = 0; c < 3; ++c)
        rgba[c] = static_cast<float>(share * paint.color[c] + (1 - share) * rgba[c]);
    rgba[3] = static_cast<float>(share + (1 - share) * rgba[3]);
}

}  // namespace lamina
