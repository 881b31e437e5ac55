// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "base/client.h"
#include "base/process.h"
#include "shared_options.h"
#include "verbs.h"
#include "volume/volume_data.h"
#include "volume_files/bricked_copy.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

struct IndexOptions {
    std::string file;
    RawOptions raw;
    bool bricks = false;
    bool quiet = false;
};

void write_bricks(const IndexOptions& options) {
    const BrickedCopy copy = write_bricked_copy(options.file, request_of(options.raw));
    if (options.quiet) return;
    print_message("lamina: wrote {} ({} bytes in up to {} chunks)\n", copy.folder.string(),
                  copy.bytes, copy.chunks);
}

void run(const IndexOptions& options) {
    if (options.bricks) write_bricks(options);
    const Volume volume = open_volume(options.file, request_of(options.raw),
                                      {.residence = VolumeUse::Residence::in_files});
    const std::filesystem::path file = index_file_of(volume);
    expect_index_or_nothing(file);  // before measuring, which takes long
    const VolumeIndex index = measure_index(volume);
    write_index(volume, index, file);
    if (options.quiet) return;
    print_message("lamina: wrote {} ({} bytes, {} bricks of {}^3 cells, values from {} to {})\n",
                  file.string(), std::filesystem::file_size(file), index.bricks.ranges.size(),
                  MinMaxBricks::edge, index.bricks.whole.lo, index.bricks.whole.hi);
}

}  // namespace

void add_index(CLI::App& app, int&) {
    const auto options = std::make_shared<IndexOptions>();
    CLI::App* const verb = app.add_subcommand(
        "index", "Measure a volume once, for pictures of it that take less memory than it has");
    verb->footer(
        "Writes FILE.lamina-index beside the volume: the least and the largest value of each brick "
        "of 4^3 cells, and how often each value occurs. Without it the first picture of a volume "
        "that does not fit the memory (--memory) makes one in the cache folder "
        "($XDG_CACHE_HOME/lamina).");
    verb->add_option(
            "FILE", options->file,
            "A volume that can stay in its files (raw NRRD, MetaImage, NIfTI, NumPy, Zarr, "
            "HDF5, or with --raw); with --bricks any volume")
        ->required();
    add_raw_options(*verb, options->raw);
    add_memory_option(*verb);
    add_only_below_option(*verb);
    verb->add_flag("--bricks", options->bricks,
                   "Copy the volume in bricks to FILE.lamina-bricks, too: for files of which no "
                   "part can be read alone, because they are compressed as a whole; commands that "
                   "take --memory find it there");
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options] {
        Progress::set_quiet(options->quiet);
        run(*options);
    });
}

}  // namespace lamina
