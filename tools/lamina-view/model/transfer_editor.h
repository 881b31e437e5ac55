// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <vector>

#include "lamina/color.h"
#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "model/transfer_curves.h"

namespace lamina::view {

// A point of one of the two curves of a transfer function, by its index.
struct TransferHandle {
    enum class Curve { density, color };

    Curve curve = Curve::density;
    std::size_t index = 0;

    friend auto operator<=>(const TransferHandle&, const TransferHandle&) = default;
};

// A shift of points: by `values` along the scalar axis, by `places` (SymlogAxis) along the other.
struct TransferShift {
    double values = 0, places = 0;
};

// Returns the curves with some points moved together, as far as they can without passing others or
// leaving the axis; extinctions stay >= 0. Coordinates that do not move stay bit for bit.
TransferCurves moved(const TransferCurves& curves, const std::set<TransferHandle>& points,
                     const TransferShift& shift, const SymlogAxis& axis);

// Returns the curves with each value v moved to pivot + (v - pivot) * factor + shift; factor > 0.
TransferCurves windowed(const TransferCurves& curves, double factor, double pivot, double shift);

// Returns the curves with all extinctions multiplied by `factor` > 0, at most the largest double.
TransferCurves attenuated(const TransferCurves& curves, double factor);

// Recomputes the knots (DensityPoint::inside) of the slope from a point to the next one.
void follow_slope(std::vector<DensityPoint>& points, std::size_t index);

// Edits a transfer function, which is valid at any time: a change that would make it invalid, or
// give it more points than scene files may have, returns false and changes nothing. Points that an
// edit does not concern keep their numbers bit for bit.
class TransferEditor {
  public:
    using Curve = TransferHandle::Curve;

    TransferEditor();  // begins with TransferCurves()

    const TransferCurves& curves() const { return curves_; }
    const TransferFunction& function() const { return function_; }
    // World length that opacities refer to, > 0. Setting it changes no extinction.
    double unit_length() const { return unit_length_; }
    void set_unit_length(double length);

    // Take another function, or an earlier state. Points that do not exist in it are deselected.
    void take(const TransferFunction& function);
    void restore(const TransferCurves& curves);

    const std::set<TransferHandle>& selection() const { return selection_; }
    bool is_selected(const TransferHandle& point) const { return selection_.contains(point); }
    void select_only(const TransferHandle& point);
    void toggle(const TransferHandle& point);
    void clear_selection() { selection_.clear(); }
    void select_all(Curve curve);
    // Selects points of extinction in a rectangle, in addition to those selected before.
    void select_within(double value_lo, double value_hi, double extinction_lo,
                       double extinction_hi);

    // True: a colour at the value of a selected point of extinction moves with it.
    bool colors_move_along = true;
    // move(), window() and attenuate() change the state that begin_move() has stored, so each call
    // between begin_move() and end_move() replaces the call before.
    void begin_move();
    bool is_moving() const { return start_.has_value(); }
    bool move(const TransferShift& shift, const SymlogAxis& axis);
    bool window(double factor, double pivot, double shift);
    bool attenuate(double factor);  // multiplies all extinctions
    void end_move() { start_.reset(); }
    void cancel_move();

    // Add points, which are then selected. A new colour stop has the curve's colour at its value.
    bool add_density(double value, double extinction);
    bool add_color(double value);
    // Adds a second point at the same value.
    bool make_step(const TransferHandle& point);
    bool remove_selected();  // keeps one point of each curve

    bool set_value(const TransferHandle& point, double value);  // limited by its neighbours
    bool set_extinction(std::size_t index, double extinction);
    bool set_opacity(std::size_t index, double opacity);  // over unit_length()
    bool set_smooth(std::size_t index, bool smooth);
    bool set_color(std::size_t index, const glm::dvec3& color);
    // Sets the colour at a value, with a new stop if there is none.
    bool paint(double value, const glm::dvec3& color);

    // Makes opacity over unit_length(), or extinction, linear from the selected points to the next
    // ones, or everywhere if no point is selected.
    bool set_opacity_linear(bool opacity);
    bool set_palette(bool palette);
    bool set_density(const std::vector<DensityPoint>& points);  // replaces the extinction curve
    // Takes the map's colours, stretched over [lo, hi] unless the map has a range of its own; also
    // its opacities if `opacities` and it has any.
    bool recolor(Colormap map, double lo, double hi, bool opacities);

    // Converts all colours to the numbers of another space (converted_color() in scene_keys.h).
    bool convert_colors(ImageColorSpace from, ImageColorSpace to);

  private:
    template <typename Change>
    bool change(const Change& apply);
    bool put(const TransferCurves& curves);  // false if they are invalid
    void follow_around(TransferCurves& curves, std::size_t index) const;
    std::set<TransferHandle> moving_points() const;

    TransferCurves curves_;
    TransferFunction function_;
    bool of_codes_ = false;
    std::string labels_;  // TransferFunction::labels()
    double unit_length_ = 1;
    std::set<TransferHandle> selection_;
    std::optional<TransferCurves> start_;  // the state at begin_move()
    std::set<TransferHandle> moving_;      // points that move() moves
};

}  // namespace lamina::view
