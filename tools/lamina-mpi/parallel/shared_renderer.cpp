// SPDX-License-Identifier: Apache-2.0
#include "parallel/shared_renderer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/profile.h"
#include "plan/plan.h"

namespace lamina {
namespace {

// Number of rows with a common weight. All ranks exchange the weights, so there should be few.
constexpr int band = 8;

void clear_rows(const RowSpan& rows, Image& image) {
    if (rows.first < rows.end)
        std::fill(image.pixel(0, rows.first), image.pixel(0, rows.end), 0.0f);
}

// Return the formats of a rank's own pixels, and of composited pixels (docs/cluster.md).
FragmentFormat first_format(Wire wire) {
    if (wire == Wire::coded) return FragmentFormat::fixed8;
    return wire == Wire::half ? FragmentFormat::half : FragmentFormat::float32;
}
FragmentFormat later_format(Wire wire) {
    return wire == Wire::coded ? FragmentFormat::fixed16 : first_format(wire);
}

void add(const IndexBox& box, std::string& text) {
    for (const glm::dvec3& corner : {box.min, box.max})
        text += fmt::format(" {:a} {:a} {:a}", corner.x, corner.y, corner.z);
}

// Returns a hash of properties of the plan, and of the shares: ranks that draw one picture together
// must agree in them.
std::string digest_of(const SlicePlan& plan, const std::vector<IndexBox>& shares) {
    const TableRequest& table = plan.table.request;
    std::string text = fmt::format(
        "{} {} {} {} {} {} {} {} {:a} {} {} {:a} {:a} {:a} {:a} {} {}", plan.slabs,
        static_cast<int>(plan.classification), static_cast<int>(plan.sampling), plan.single_color,
        plan.nan_transparent, plan.nearest, plan.linear, plan.nothing_visible, plan.unit,
        table.scalar_nodes, table.length_layers, table.max_length, plan.opaque_depth,
        plan.curve_error, plan.most_bend, plan.bricks.size(), plan.clip.size());
    add(plan.drawn, text);
    for (const IndexBox& share : shares) add(share, text);
    ContentHash hash;
    hash.add(text);
    return hash.hex();
}

[[noreturn]] void refuse(const Scene& scene, const char* key, const std::string& found,
                         const char* expected) {
    fail("{}: {}: found {}, expected {}: several ranks draw one picture in float32",
         scene.file.string(), key, found, expected);
}

// Returns the scene with target float32. Throws Error if ranks cannot share it: OVER is
// associative in floats only; slabs that are rounded must be composited one by one, in order.
Scene checked(Scene scene) {
    if (scene.target.value_or(Target::float32) != Target::float32)
        refuse(scene, "render.target", name_of(scene.target), "float32");
    if (scene.slice.tree) refuse(scene, "render.slice.tree", "a tree", "none");
    if (scene.slice.dither) refuse(scene, "render.slice.dither", "dithering", "none");
    scene.target = Target::float32;
    return scene;
}

}  // namespace

// Lists the transfers of three exchanges. The ranks are divided into `groups_` groups of up to
// `size_` ranks that are contiguous in depth, and the picture's rows into `size_` parts.
// 1. in_group(): member i of each group composites part i of the group's pictures.
// 2. among_groups(): the owners of part i divide its rows among themselves, and each composites
//    its rows over all groups. (One group alone skips this.)
// 3. to_first(): rank 0 receives all composited rows.
// With groups, each of N ranks sends about 2 sqrt(N) messages instead of N.
class PictureComposer::Layout {
  public:
    Layout(const std::vector<int>& order, const std::vector<std::int64_t>& weights,
           int most_in_group)
        : order_(order) {
        const int count = static_cast<int>(order.size());
        size_ = count <= most_in_group
                    ? count
                    : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
        groups_ = (count + size_ - 1) / size_;
        for (const RowSpan& rows :
             divide_rows(weights, {0, static_cast<int>(weights.size())}, size_))
            rows_.push_back(divide_rows(weights, rows, groups_));
    }

    int groups() const { return groups_; }

    // Returns the transfers within the group of a rank.
    std::vector<Transfer> in_group(int rank) const {
        const auto place = std::ranges::find(order_, rank) - order_.begin();
        const int group = static_cast<int>(place) / size_;
        std::vector<Transfer> transfers;
        for (int part = 0; part < size_; ++part) {
            const RowSpan rows{rows_of(part).front().first, rows_of(part).back().end};
            for (int member = 0; member < members(group); ++member)
                transfers.push_back({rank_of(group, member), owner(group, part), rows});
        }
        return transfers;
    }

    std::vector<Transfer> among_groups() const {
        std::vector<Transfer> transfers;
        for (int part = 0; part < size_; ++part) {
            for (int to = 0; to < groups_; ++to) {
                for (int from = 0; from < groups_; ++from)
                    transfers.push_back({owner(from, part), owner(to, part), rows_of(part, to)});
            }
        }
        return transfers;
    }

    std::vector<Transfer> to_first() const {
        std::vector<Transfer> transfers;
        for (int part = 0; part < size_; ++part) {
            for (int group = 0; group < groups_; ++group)
                transfers.push_back({owner(group, part), 0, rows_of(part, group)});
        }
        return transfers;
    }

  private:
    int members(int group) const {
        return std::min(size_, static_cast<int>(order_.size()) - group * size_);
    }
    int rank_of(int group, int member) const {
        return order_[static_cast<std::size_t>(group * size_ + member)];
    }
    // Returns the rank that composites `part` in a group; the last group may have fewer members.
    int owner(int group, int part) const { return rank_of(group, part % members(group)); }
    const std::vector<RowSpan>& rows_of(int part) const {
        return rows_[static_cast<std::size_t>(part)];
    }
    const RowSpan& rows_of(int part, int group) const {
        return rows_of(part)[static_cast<std::size_t>(group)];
    }

    const std::vector<int>& order_;
    int size_ = 1, groups_ = 1;
    std::vector<std::vector<RowSpan>> rows_;  // by part, then by group
};

void PictureComposer::compose(const std::vector<int>& order, Image& picture) {
    bytes_sent_ = messages_sent_ = 0;
    if (ranks_.count() == 1) return;
    const RowSpan all{0, picture.height};
    const ActiveRuns runs(picture, all);
    const Layout layout(order, row_weights(runs, picture.height), most_in_group_);
    of_group_.resize(picture.width, picture.height);
    exchange(layout.in_group(ranks_.number()), first_format(wire_), picture, &runs, of_group_);
    if (layout.groups() > 1) {
        composed_.resize(picture.width, picture.height);
        exchange(layout.among_groups(), later_format(wire_), of_group_, nullptr, composed_);
    } else {
        std::swap(of_group_, composed_);
    }
    exchange(layout.to_first(), later_format(wire_), composed_, nullptr, picture);
}

std::vector<std::int64_t> PictureComposer::row_weights(const ActiveRuns& runs, int rows) const {
    std::vector<std::int64_t> bands(static_cast<std::size_t>((rows + band - 1) / band));
    for (int row = 0; row < rows; ++row)
        bands[static_cast<std::size_t>(row / band)] += runs.pixels(row);
    MPI_Allreduce(MPI_IN_PLACE, bands.data(), static_cast<int>(bands.size()), MPI_INT64_T, MPI_SUM,
                  ranks_.comm());
    std::vector<std::int64_t> weights;
    for (int row = 0; row < rows; ++row)
        weights.push_back(bands[static_cast<std::size_t>(row / band)]);
    return weights;
}

void PictureComposer::exchange(const std::vector<Transfer>& transfers, FragmentFormat format,
                               const Image& picture, const ActiveRuns* runs, Image& result) {
    const auto with_runs = [&](const RowSpan& rows, const auto& use) {
        if (runs != nullptr) return use(*runs);
        use(ActiveRuns(picture, rows));
    };
    const int own = ranks_.number();
    std::vector<std::vector<std::byte>> sent;
    std::vector<MPI_Request> requests;
    for (const Transfer& transfer : transfers) {
        if (transfer.from != own || transfer.to == own) continue;
        std::vector<std::byte>& bytes = sent.emplace_back();
        with_runs(transfer.rows, [&](const ActiveRuns& known) {
            encode_rows(picture, known, transfer.rows, format, bytes);
        });
        bytes_sent_ += static_cast<std::int64_t>(bytes.size());
        ++messages_sent_;
        MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, transfer.to, 0,
                  ranks_.comm(), &requests.emplace_back());
    }
    std::vector<std::byte> bytes;
    RowSpan begun;
    for (const Transfer& transfer : transfers) {
        if (transfer.to != own) continue;
        if (transfer.rows != begun) {
            begun = transfer.rows;
            clear_rows(begun, result);
        }
        if (transfer.from == own) {
            with_runs(transfer.rows, [&](const ActiveRuns& known) {
                put_rows_behind(picture, known, transfer.rows, result);
            });
            continue;
        }
        receive(transfer.from, bytes);
        put_rows_behind(bytes, transfer.rows, format, result);
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void PictureComposer::receive(int rank, std::vector<std::byte>& bytes) const {
    MPI_Status status;
    MPI_Probe(rank, 0, ranks_.comm(), &status);
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    bytes.resize(static_cast<std::size_t>(size));
    MPI_Recv(bytes.data(), size, MPI_BYTE, rank, 0, ranks_.comm(), MPI_STATUS_IGNORE);
}

SharedRenderer::SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                               const OmissionSwitch& omissions, bool many_frames,
                               std::shared_ptr<TableCache> tables)
    : ranks_(ranks),
      own_(checked(scene), std::move(data),
           {.context = ContextChoice::cpu,
            .omissions = omissions,
            .many_frames = many_frames,
            .share = {ranks.number(), ranks.count()},
            .tables = std::move(tables)}),
      composer_(ranks, wire) {}

void SharedRenderer::check_plan() {
    const std::string own = digest_of(own_.plan().slice, own_.renderer().shares());
    std::string of_first = own;
    ranks_.broadcast(of_first);
    agree(ranks_, [&] {
        if (own == of_first) return;
        fail("{}: ranks plan different pictures: expected the same data on all machines",
             own_.asked().file.string());
    });
}

void SharedRenderer::draw(const std::optional<Camera>& camera) {
    std::vector<int> order;
    RankReport report;
    agree(ranks_, [&] {
        Stage drawing("share");
        if (camera) own_.set_camera(*camera);
        own_.draw_frame();
        own_.read(picture_);
        order = own_.renderer().front_to_back();
        report.draw_ms = drawing.end();
    });
    Stage compositing("composite");
    do_or_abort(ranks_, [&] { composer_.compose(order, picture_); });
    report.composite_ms = compositing.end();
    report.threads = own_.capabilities().threads;
    report.segments = own_.renderer().renderer().fragments();
    report.bytes_sent = composer_.bytes_sent();
    report.messages_sent = composer_.messages_sent();
    report.peak_memory = static_cast<std::int64_t>(peak_resident_memory());
    gethostname(report.machine.data(), report.machine.size() - 1);
    reports_.resize(ranks_.leads() ? static_cast<std::size_t>(ranks_.count()) : 0);
    MPI_Gather(&report, sizeof report, MPI_BYTE, reports_.data(), sizeof report, MPI_BYTE, 0,
               ranks_.comm());
}

}  // namespace lamina
