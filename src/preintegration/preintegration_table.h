// SPDX-License-Identifier: Apache-2.0
// Pre-integrated transfer functions (docs/numerics.md, section 5): tables over the scalar at the
// front of a segment, the scalar at its back, and its length. A TableRequest says which table;
// build_table() builds it, and a TableCache finds it again.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "lamina/settings.h"
#include "lamina/transfer_function.h"
#include "optics/segment_integral.h"

namespace lamina {

// The places of a table's nodes: on the transfer function's knots and equally spaced between two of
// them (knots: KnotTable), or equally spaced over the whole range (uniform: UniformTable).
enum class TableKind { knots, uniform };

// Says which table of a transfer function is wanted.
struct TableRequest {
    double lo = 0, hi = 1;  // scalars, lo <= hi, both finite
    // Longest segment in the transfer function's unit, >= 0; unused by a one-layer KnotTable.
    double max_length = 1;
    int scalar_nodes = 256;  // >= 2, of a UniformTable <= 4096; a KnotTable has about as many nodes
    int length_layers = 1;   // >= 1, of a UniformTable at most 64
    bool colored = true;     // may be false if transfer_function.single_color(lo, hi)
    bool lit = false;        // adds front parts (optics/segment_integral.h) to a coloured KnotTable
    TableKind kind = TableKind::knots;
    // UniformTable alone: the variants of Kraus, Qiao, Ebert 2004, section 3.
    LengthMapping mapping = LengthMapping::octave;
    TableStore store = TableStore::mean_extinction;
    TableFormat format = TableFormat::fixed16;
    TableConstruction construction = TableConstruction::exact;

    friend bool operator==(const TableRequest&, const TableRequest&) = default;
};

// A table: the request that it was built for, and its numbers.
struct PreintegrationTable {
    TableRequest request;
    glm::dvec3 single_color{0};  // the colour if the request is not coloured

    virtual ~PreintegrationTable() = default;
    // Returns the integral of a segment, in double precision, as shaders compute it in float32.
    virtual SegmentIntegral lookup(double front, double back, double length) const = 0;
    virtual std::int64_t byte_count() const = 0;  // memory

  protected:
    explicit PreintegrationTable(const TableRequest& asked) : request(asked) {}
};

// A table whose nodes are aligned with the transfer function's knots: within one linear piece the
// mean extinction is exactly bilinear, and nothing is interpolated across a step (for segments
// across one no table is right; the corner holds the mean of both sides). Its numbers are means
// over the segment, so opacity is exact at every length, and colour has a limit at length 0. Below,
// tbar is a segment's mean extinction, C its associated colour and alpha its opacity.
struct KnotTable : PreintegrationTable {
    struct Anchor {
        double value;
        int node;
    };

    // The S scalars of the nodes over [lo, hi], ascending. A step's value occurs twice.
    std::vector<double> nodes;
    // The nodes at lo, at the knots in (lo, hi) (steps twice), and at hi. Between two anchors are
    // one or more equally spaced cells. If lo == hi there is one node and one anchor.
    std::vector<Anchor> anchors;
    // L >= 1 lengths, equally spaced from lengths[0] = 0 (the limit) to max_length.
    std::vector<double> lengths;
    // S * S values tbar = optical depth / length, index back * S + front.
    std::vector<float> mean_extinction;
    // L * S * S * 3 values E = tbar * C / alpha, index ((layer * S + back) * S + front) * 3 +
    // channel; empty if not coloured. Look-ups use only pairs of nodes within one linear piece and
    // pairs of anchors. For all other pairs every layer holds the limit of length 0.
    std::vector<float> emission;
    // L * S * S * 4 values tbar * FrontParts / alpha of a lit table, first of the colour, then of
    // the opacity, indexed and interpolated as `emission`; empty if the table is not lit.
    std::vector<float> front_parts;

    // Builds in parallel, with progress. There are at most 1.5 * scalar_nodes + 3 * (knots in (lo,
    // hi) + 1) nodes. Throws Error if more than 1022 knots lie in (lo, hi) or the numbers would
    // exceed 1 GiB. Extinctions beyond the largest float are clamped to it.
    KnotTable(const TransferFunction& transfer_function, const TableRequest& asked);

    // Returns the node coordinate (whole at nodes) of a scalar, clamped; at a step the right node.
    double coordinate(double value) const;

    // Twin of shaders/preintegration/knot_table.glsl. It interpolates bilinearly in the scalars and
    // linearly in length (clamped to max_length); then alpha = -expm1(-tbar * length) and C = alpha
    // * E / tbar. The table is smooth only within a linear piece, so a segment is cut at the first
    // and at the last anchor inside it. That makes up to three look-ups: two within a linear piece,
    // and between them one from anchor to anchor, which needs no interpolation in the scalars.
    SegmentIntegral lookup(double front, double back, double length) const override {
        return lookup_lit(front, back, length).whole;
    }
    // Looks up the front parts of lit tables, too.
    LitIntegral lookup_lit(double front, double back, double length) const;

    std::int64_t byte_count() const override;
};

// A table with equally spaced scalars (Kraus, Qiao, Ebert 2004); tbar and alpha: as in KnotTable.
struct UniformTable : PreintegrationTable {
    int channels = 4;  // a texel's numbers: 4 (rgb, tbar or alpha) or 1 (tbar or alpha)
    // Layers that are stored: 1 for mean extinction without colour, independent of length.
    int layers = 1;
    // Value = stored * scale; fixed formats store [0, 1], float16 stores values below 32768.
    float scale = 1;
    // Numbers of the texture, rounded to the format and not multiplied by `scale`. The index is
    // ((layer * nodes + back) * nodes + front) * channels + channel.
    std::vector<float> texels;

    // Builds on all cores, with progress. Throws Error if the texels would exceed 1 GiB as floats.
    // Extinctions beyond 1e30 over a length of max(1, max_length) are clamped to that: it is
    // opaque, and its products stay finite in float32.
    UniformTable(const TransferFunction& transfer_function, const TableRequest& asked);

    double length_of(int layer) const;
    // Returns 1 / length_of(1), a uniform of uniform_table.glsl; 0 for one layer or no length.
    double inverse_first_length() const;
    // Returns a length's layer coordinate, 0..layers - 1; lengths are clamped to max_length.
    double layer_of(double length) const;

    // Twin of shaders/preintegration/uniform_table.glsl: trilinear interpolation between texels.
    // With TableStore::opacity, optical_depth is -log1p(-alpha), which is +inf for alpha = 1.
    SegmentIntegral lookup(double front, double back, double length) const override;

    std::int64_t byte_count() const override;
};

// Builds what the request asks for, a KnotTable or a UniformTable.
std::shared_ptr<const PreintegrationTable> build_table(const TransferFunction& transfer_function,
                                                       const TableRequest& request);

// A plan's table. Request and transfer function determine it, so == leaves out the built table.
struct TablePlan {
    TableRequest request;  // lengths in the plan's units
    double error = 0;      // that the table was found to add to the picture, in 1/255
    // Null if nothing looks it up; otherwise a table of the request's kind.
    std::shared_ptr<const PreintegrationTable> built = nullptr;

    std::shared_ptr<const KnotTable> knot_table() const {
        return std::static_pointer_cast<const KnotTable>(built);
    }
    std::shared_ptr<const UniformTable> uniform_table() const {
        return std::static_pointer_cast<const UniformTable>(built);
    }

    friend bool operator==(const TablePlan& a, const TablePlan& b) {
        return a.request == b.request && a.error == b.error;
    }
};

// Builds tables, and finds them again by content: transfer function and request. The cache keeps
// the tables that were asked for last, at most 8 that take no more than `most_bytes` in all. A
// table that it has dropped is still found while somebody else holds it. Safe from any thread.
class TableCache {
  public:
    static constexpr std::size_t most_tables = 8;

    explicit TableCache(std::int64_t most_bytes = std::int64_t{1} << 30)
        : most_bytes_(most_bytes) {}
    TableCache(const TableCache&) = delete;
    TableCache& operator=(const TableCache&) = delete;

    // Returns the table of a request, found or built. Throws what build_table() throws. Requests
    // that differ only in values on which their table does not depend get one table: views that
    // differ in the longest segment share a KnotTable of one layer.
    std::shared_ptr<const PreintegrationTable> get(const TransferFunction& transfer_function,
                                                   const TableRequest& request);

  private:
    using TablePointer = std::shared_ptr<const PreintegrationTable>;

    struct Content {
        std::vector<double> knots;
        TableRequest request;
        friend bool operator==(const Content&, const Content&) = default;
    };
    struct Known {
        Content content;
        std::int64_t bytes;
        std::weak_ptr<const PreintegrationTable> table;
        TablePointer kept;  // null if only others hold it
    };

    // The lock must be held.
    TablePointer find(const Content& content);
    void keep_newest();

    std::int64_t most_bytes_;
    std::mutex mutex_;
    std::list<Known> known_;  // the one that was asked for last comes first
};

}  // namespace lamina
