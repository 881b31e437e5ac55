// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "slicing/pixel_box.h"
#include "slicing/tile_slabs.h"

namespace lamina {

// The data that slabs are computed from: the volume, the transfer function and its tables, and the
// rays of a view.
class TileSlabSource {
  public:
    // `plan` must outlive the source. The transfer function is in the plan's units, and so are
    // views; facts are in world units. `ready`: volume() of another source, which is used if it has
    // the right form.
    TileSlabSource(const Volume& volume, const TransferFunction& transfer_function,
                   const Facts& facts, const SlicePlan& plan,
                   std::shared_ptr<const TileVolume> ready);
    TileSlabSource(const TileSlabSource&) = delete;  // the slabs refer to its tables
    TileSlabSource& operator=(const TileSlabSource&) = delete;

    // Must be called after the plan changed in what belongs to a view.
    void take_plan();
    void set_view(const View& view, const Slabs& slabs);
    const TileSlabs& slabs() const { return slabs_; }
    const PixelBox& seen() const { return seen_; }  // pixels in which the view may show something

    const std::shared_ptr<const TileVolume>& volume() const { return volume_; }

    // Throws Error if the files of a volume that stays in them have changed.
    void check_unchanged() const;

    double upload_ms() const { return upload_ms_; }
    double table_ms() const { return table_ms_; }
    std::int64_t byte_count() const;

  private:
    void set_light();
    void set_rays(const View& view, const Slabs& slabs);
    void add_brick(std::size_t number, const View& view, const Slabs& slabs);
    void see(const TileBrickView& brick, const View& view);
    bool keep_to_share(const IndexBox& share, TileBrickView& brick) const;
    void load_pages(const View& view) const;

    const SlicePlan& plan_;
    Grid grid_;
    OccupiedBricks occupied_;
    ConstantBricks constant_;
    CellMap cells_;
    bool cells_leave_out_empty_ = false;  // differs between views
    std::optional<TileTransfer> transfer_;
    std::shared_ptr<const TileVolume> volume_;
    std::vector<std::uint32_t> shown_pages_;  // that hold something visible, of a paged volume
    std::optional<TileLight> light_;
    TileSlabs slabs_;
    PixelBox seen_;
    std::vector<std::size_t> order_;  // order of the bricks
    double upload_ms_ = 0, table_ms_ = 0;
};

}  // namespace lamina
