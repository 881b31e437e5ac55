// SPDX-License-Identifier: Apache-2.0
#include "annotation/annotation_layer.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "annotation/color_bar.h"
#include "annotation/numbers.h"
#include "annotation/scale_bar.h"
#include "annotation/world_lines.h"
#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr double title_size = 1.35;  // in ems
// Plates under texts: the share of the picture that they hide, and their margin in ems.
constexpr double plate_opacity = 0.75, plate_margin = 0.4;

// Calls check(key, annotation) for each annotation of a scene.
template <typename Check>
void for_each(const Annotations& all, const Check& check) {
    const std::pair<const char*, const std::optional<Annotation>*> named[] = {
        {"colorbar", &all.colorbar}, {"labels", &all.labels}, {"scale_bar", &all.scale_bar},
        {"axes", &all.axes},         {"box", &all.box},       {"title", &all.title}};
    for (const auto& [key, annotation] : named)
        if (*annotation) check(fmt::format("image.annotations.{}", key), **annotation);
    for (std::size_t i = 0; i < all.texts.size(); ++i)
        check(fmt::format("image.annotations.texts.{}", i), all.texts[i]);
}

void check(const Annotations& annotations) {
    for_each(annotations, [](const std::string& key, const Annotation& each) {
        check_text(key + ".text", each.text);
        check_text(key + ".format", each.format);
        if (!(each.size >= Annotation::least_size && each.size <= Annotation::largest_size)) {
            fail("{}.size: found {}, expected a number from {} to {}", key, each.size,
                 Annotation::least_size, Annotation::largest_size);
        }
        if (each.format.empty()) return;
        if (const auto mistake = mistake_in_format(each.format))
            fail("{}.format: {}", key, *mistake);
    });
}

// Ranks of blocks (docs/annotations.md, "Small pictures").
enum Rank { title_rank, colors_rank, scale_rank, axes_rank, texts_rank };

// Tells whether the transfer function shows any value of the data.
bool anything_shows(const Scene& scene, const AnnotatedData& data) {
    return data.range.empty() ||
           !scene.transfer_function->transparent(data.range.lo, data.range.hi);
}

// Makes the blocks of a scene in the order in which those of one place stand.
std::vector<Block> blocks_of(Pen& pen, const Scene& scene, const AnnotatedData& data) {
    const Annotations& wanted = scene.annotations;
    const double em = pen.style.em;
    std::vector<Block> blocks;
    const auto add = [&](Rank rank, Block block) {
        block.rank = rank;
        blocks.push_back(std::move(block));
    };
    if (wanted.title) {
        add(title_rank, text_block(pen, *wanted.title, title_size * em * wanted.title->size,
                                   "image.annotations.title", AnnotationPosition::top));
    }
    const std::size_t after_title = blocks.size();
    if (wanted.scale_bar) add(scale_rank, scale_bar(pen, *wanted.scale_bar, scene, data));
    if (wanted.axes) add(axes_rank, axes_triad(pen, *wanted.axes, scene, data));
    for (std::size_t i = 0; i < wanted.texts.size(); ++i) {
        add(texts_rank, text_block(pen, wanted.texts[i], em * wanted.texts[i].size,
                                   fmt::format("image.annotations.texts.{}", i),
                                   AnnotationPosition::bottom_left));
    }
    std::vector<Block> colors;
    const auto height = [&](const Annotation& of) {
        return free_height(blocks, of.position.value_or(AnnotationPosition::right), pen.style);
    };
    const bool both = wanted.colorbar && wanted.labels;
    if (wanted.colorbar && !(both && data.are_labels) && anything_shows(scene, data)) {
        colors.push_back(
            color_bar(pen, *wanted.colorbar, scene, data, height(*wanted.colorbar)).block);
    }
    if (wanted.labels && data.are_labels)
        colors.push_back(label_legend(pen, *wanted.labels, scene, data, height(*wanted.labels)));
    for (Block& block : colors) block.rank = colors_rank;
    blocks.insert(blocks.begin() + static_cast<std::ptrdiff_t>(after_title),
                  std::make_move_iterator(colors.begin()), std::make_move_iterator(colors.end()));
    return blocks;
}

// Tells whether the picture shows something in a rectangle.
template <typename Real>
bool shows(const RgbaImage<Real>& picture, const Rectangle& place) {
    const auto inside = [](double at, int end) {
        return static_cast<int>(std::clamp(at, 0.0, double(end)));
    };
    const int left = inside(place.left, picture.width),
              right = inside(place.right(), picture.width);
    const int top = inside(place.top, picture.height),
              bottom = inside(place.bottom(), picture.height);
    for (int row = top; row < bottom; ++row) {
        for (int column = left; column < right; ++column)
            if (picture.pixel(column, row)[3] > 0) return true;
    }
    return false;
}

// Returns characters as "U+6F22, U+5B57".
std::string code_points(const std::vector<char32_t>& characters) {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t i = 0; i < characters.size() && i < most; ++i)
        text += fmt::format("{}U+{:04X}", i == 0 ? "" : ", ", std::uint32_t(characters[i]));
    return characters.size() > most ? text + ", ..." : text;
}

void warn_of_misfits(const std::vector<std::string>& keys, const AnnotationStyle& style) {
    if (keys.empty()) return;
    warn(fmt::format(
        "{}: a picture of {} x {} has no room for {} beside what is more important, "
        "and {} left out; a smaller \"size\" or a larger picture holds {}",
        fmt::join(keys, ", "), style.width, style.height, keys.size() == 1 ? "it" : "them",
        keys.size() == 1 ? "it is" : "they are", keys.size() == 1 ? "it" : "them"));
}

// Reduces two opposite margins, so that the data keep at least two fifths of the picture.
void limit(double& low, double& high, double whole) {
    const double most = 0.6 * whole, sum = low + high;
    if (sum <= most) return;
    low *= most / sum;
    high *= most / sum;
}

}  // namespace

PictureMargins annotation_margins(const Scene& scene, const AnnotatedData& data) {
    if (!scene.annotations.any()) return {};
    check(scene.annotations);
    const AnnotationStyle style(scene);
    Font font;
    Pen pen(style, font, nullptr);
    Scene open = scene;
    open.camera = automatic;
    std::vector<Block> blocks = blocks_of(pen, open, data);
    take_misfits(blocks, style);
    PictureMargins margins = margins_of(blocks, style);
    if (scene.annotations.box) {  // numbers stand outside of it
        const double numbers = 2.5 * style.em * scene.annotations.box->size;
        for (double* const margin : {&margins.left, &margins.right, &margins.bottom})
            *margin += numbers;
    }
    limit(margins.left, margins.right, style.width);
    limit(margins.top, margins.bottom, style.height);
    return margins;
}

template <typename Real>
std::shared_ptr<const Image> annotation_layer(const Scene& scene, const AnnotatedData& data,
                                              const RgbaImage<Real>& picture) {
    if (!scene.annotations.any()) return nullptr;
    check(scene.annotations);
    if (scene.annotations.labels && !scene.annotations.colorbar && !data.are_labels) {
        warn(
            "image.annotations.labels: the data are no labels, so there is no legend of them "
            "(\"colorbar\" shows the colours of measured values)");
    }
    if (scene.annotations.colorbar && !anything_shows(scene, data)) {
        warn(
            "image.annotations.colorbar: there is no colour bar, for the transfer function shows "
            "none of the data's values");
    }
    const AnnotationStyle style(scene);
    Font font;
    Canvas canvas(scene.width, scene.height, scene.color_space);
    Pen pen(style, font, &canvas);
    // Covers what the picture shows in and around a rectangle, and lines of the box.
    const auto lay_plate = [&](const Rectangle& place, double margin) {
        const Rectangle plate{std::floor(place.left - margin), std::floor(place.top - margin),
                              std::ceil(place.width + 2 * margin),
                              std::ceil(place.height + 2 * margin)};
        if (scene.annotations.box || shows(picture, plate))
            canvas.fill(plate, {style.paper, plate_opacity});
    };
    std::vector<Block> blocks = blocks_of(pen, scene, data);
    warn_of_misfits(take_misfits(blocks, style), style);
    for (const Block& block : blocks)
        if (!block.note.empty()) warn(block.note);
    const std::vector<Rectangle> places = placed(blocks, style);
    if (scene.annotations.box) {
        std::vector<Rectangle> taken = places;
        draw_box(pen, *scene.annotations.box, scene, data, [&](const std::vector<Rectangle>& at) {
            for (const Rectangle& number : at) {
                const auto hits = [&](const Rectangle& other) { return overlap(number, other); };
                if (!style.holds(number) || std::ranges::any_of(taken, hits)) return false;
            }
            for (const Rectangle& number : at) lay_plate(number, plate_margin / 4 * style.em);
            taken.insert(taken.end(), at.begin(), at.end());
            return true;
        });
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        lay_plate(places[i], plate_margin * style.em);
        blocks[i].draw(pen, {places[i].left, places[i].top});
    }
    if (!font.missing().empty()) {
        warn(fmt::format(
            "image.annotations: the font DejaVu Sans lacks {}, and a box stands for each",
            code_points(font.missing())));
    }
    return canvas.take();
}

template std::shared_ptr<const Image> annotation_layer(const Scene&, const AnnotatedData&,
                                                       const Image&);
template std::shared_ptr<const Image> annotation_layer(const Scene&, const AnnotatedData&,
                                                       const PreciseImage&);

}  // namespace lamina
