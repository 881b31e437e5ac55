// SPDX-License-Identifier: Apache-2.0
#include "reference/order_pixels.h"

#include "base/parallel.h"
#include "mesh/ray_walk.h"

namespace lamina {
namespace {

// Length of segments that count, as a share of the ray's length: see order_pixels.h.
constexpr double visible = 1e-12;

struct DrawnSegment {
    std::int32_t tet;
    double in, out;
};

// An order that is judged, with the place at which it draws each tet.
struct Judged {
    const VisibilityOrder* order;
    std::vector<std::int32_t> places;
    std::int32_t place(const DrawnSegment& segment) const { return places[segment.tet]; }
};

Judged judged(const VisibilityOrder* order) {
    Judged result{order, std::vector<std::int32_t>(order->order().size())};
    for (std::size_t i = 0; i < result.places.size(); ++i)
        result.places[order->order()[i]] = static_cast<std::int32_t>(i);
    return result;
}

class PixelJudge {
  public:
    PixelJudge(const TetMesh& mesh, const FaceTree& open_faces) : walk_(mesh, open_faces) {}

    // Returns whether the ray meets tets in front of the eye.
    bool look(const View::Ray& ray) {
        walk_.aim(ray.origin, ray.direction);
        walk_.list(listed_);
        double end = 0;
        for (const TetSegment& segment : listed_) end = std::max(end, segment.out.at);
        shortest_ = visible * end;
        segments_.clear();
        for (const TetSegment& segment : listed_) {
            const double in = std::max(segment.in.at, 0.0);
            if (segment.out.at - in > shortest_)
                segments_.push_back({segment.tet, in, segment.out.at});
        }
        by_end_ = segments_;
        std::sort(by_end_.begin(), by_end_.end(),
                  [](const DrawnSegment& a, const DrawnSegment& b) { return a.out < b.out; });
        return !segments_.empty();
    }

    // Returns whether a tet is drawn before one that lies wholly behind it. For each segment, by
    // ascending entry, first_drawn is the first place of all segments that end in front of it.
    bool wrong(const Judged& judged) const {
        std::int32_t first_drawn = std::numeric_limits<std::int32_t>::max();
        std::size_t left = 0;
        for (const DrawnSegment& segment : segments_) {
            while (left < by_end_.size() && is_behind(segment, by_end_[left]))
                first_drawn = std::min(first_drawn, judged.place(by_end_[left++]));
            if (first_drawn < judged.place(segment)) return true;
        }
        return false;
    }

    bool wrong_outside_cycles(const Judged& judged) const {
        for (const DrawnSegment& far : segments_) {
            for (const DrawnSegment& near : by_end_) {
                if (!is_behind(far, near)) break;
                if (judged.place(near) > judged.place(far)) continue;
                const std::int32_t cycle = judged.order->cycle_of(near.tet);
                if (cycle < 0 || cycle != judged.order->cycle_of(far.tet)) return true;
            }
        }
        return false;
    }

    bool overlapping() const { return walk_.overlapping(); }

  private:
    bool is_behind(const DrawnSegment& far, const DrawnSegment& near) const {
        return near.out <= far.in + 0.5 * shortest_;
    }

    RayWalk walk_;
    std::vector<TetSegment> listed_;
    std::vector<DrawnSegment> segments_, by_end_;
    double shortest_ = 0;
};

}  // namespace

std::vector<OrderPixels> judge_pixels(const TetMesh& mesh, const FaceTree& open_faces,
                                      const View& view,
                                      std::span<const VisibilityOrder* const> orders,
                                      const std::function<void()>& row_done) {
    std::vector<Judged> all;
    for (const VisibilityOrder* order : orders) all.push_back(judged(order));
    std::vector<std::vector<OrderPixels>> rows(static_cast<std::size_t>(view.height));
    parallel_for(view.height, 1, [&](std::int64_t row) {
        std::vector<OrderPixels>& found = rows[row];
        found.resize(all.size());
        PixelJudge judge(mesh, open_faces);
        for (int column = 0; column < view.width; ++column) {
            if (!judge.look(view.ray(column, static_cast<double>(row)))) continue;
            for (std::size_t i = 0; i < all.size(); ++i) {
                ++found[i].covered;
                if (!judge.wrong(all[i])) continue;
                ++found[i].wrong;
                if (!judge.wrong_outside_cycles(all[i])) continue;
                ++found[i].outside_cycles;
                found[i].overlapping += judge.overlapping();
            }
        }
        if (row_done) row_done();
    });
    std::vector<OrderPixels> sums(all.size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i].covered += row[i].covered;
            sums[i].wrong += row[i].wrong;
            sums[i].outside_cycles += row[i].outside_cycles;
            sums[i].overlapping += row[i].overlapping;
        }
    }
    return sums;
}

}  // namespace lamina
