// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/mesh.h"
#include "lamina/report.h"
#include "lamina/sampling.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "lamina/words.h"

namespace lamina {

// Options of a session that do not belong to the scene.
struct SessionOptions {
    Auto<ContextChoice> context;
    int threads = 0;  // largest number of threads of the session; 0: one for each processor
    // True if many pictures will be drawn: choices may then take longer to make each picture
    // quicker. Otherwise the time to the first one counts.
    bool many_frames = false;
    // Folder outside of which the session reads no data, whoever names them (docs/files.md). If
    // empty, it reads from anywhere.
    std::filesystem::path only_below = {};
    // Stops the constructor, which reads and measures the data: it throws Interrupted.
    std::stop_token stop = {};
};

// Called with each complete tile of a picture that is being traced. Pixels outside the complete
// tiles are undefined. Calls come as those of ProgressCallback do (lamina/error.h).
using TileCallback = std::function<void(const PictureTile&, const PreciseImage&)>;

// Draws pictures of a scene while camera, transfer function and settings change. When the next
// picture is asked for, the session repeats only the work that the changes make necessary:
//
//   camera              measures the view and plans; no upload, no table, no shader
//   size                that, and buffers of that size
//   transfer function   measures the data against it, makes tables; the volume stays where it is.
//                       A mesh that the session makes from a volume is made again, for it follows
//                       the transfer function
//   clip                measures the data against it, makes tables; a mesh is cut again
//   settings            all of that, and what is automatic is chosen again
//
// Automatic values ("auto" in scene files) are chosen for the first picture and kept; transfer
// function and camera (docs/first-picture.md) are chosen when the session gets the scene.
// resolved_scene() has all of them written out. With the cpu engine (ContextChoice::cpu) a
// picture is, bit for bit, the one that `lamina render` draws of that scene.
//
// Every call may throw Error. Sessions of several threads do not disturb each other; calls of one
// session must not overlap. Nothing is written to the standard streams, no signal is handled, and
// the caller's OpenGL context is left as it was.
class LAMINA_API Session {
  public:
    // Reads what the scene names as its data (docs/scene.md), or makes it.
    explicit Session(Scene scene, SessionOptions options = {});
    // Draws these data, and not those that the scene names. Volumes share their samples: nothing is
    // copied. A Scene{} whose transfer function and camera are `automatic` is enough.
    Session(Scene scene, Volume volume, SessionOptions options = {});
    // Draws `scene.scalar` of the mesh, or its first scalar at points.
    Session(Scene scene, MeshData mesh, SessionOptions options = {});
    ~Session();
    Session(Session&& other) noexcept;
    Session& operator=(Session&& other) noexcept;

    void set_camera(const Camera& camera);
    void set_size(int width, int height);  // pixels, 1 or more
    void set_transfer_function(const TransferFunction& transfer_function);
    // Takes the transfer function of another scene. A colour map without a range is stretched over
    // the data.
    void set_transfer_function_of(const Scene& like);
    void set_clip(const Clip& clip);
    // Takes another scene of the same data, of any method that can draw them. Files that it names
    // are not read.
    void set_scene(Scene scene);
    void choose_again();  // chooses all automatic values again
    // Changes the scene by words (lamina/words.h), on top of what it was asked for. What is chosen
    // with them, and all of camera, transfer function, lighting and clip, then counts as given.
    void adjust(const Words& words);

    // Return the scene: as it was asked for (scene()), with transfer function and camera chosen
    // (chosen_scene()), and with all automatic values chosen (resolved_scene()). Saved as a file
    // (docs/scene.md), it names the data by the files that the scene names: for `lamina render`, a
    // scene of data in memory must name files that hold the same data.
    const Scene& scene() const;
    const Scene& chosen_scene() const;
    const Scene& resolved_scene();
    void save_resolved_scene(const std::filesystem::path& file);

    PlanSummary plan();
    std::string explanation();  // the plan in words, line by line, and what is left out and why

    // Returns a complete picture, which is valid until the next call that draws. If the size stays,
    // the call allocates nothing. Throws Interrupted once a stop is requested; the next picture is
    // then drawn from the start. A scene of the method `trace` gives the truth, as trace() does.
    const Image& draw(std::stop_token stop = {}, const ProgressCallback& progress = {});
    // Draws into the caller's picture, whose memory is kept if it suffices. After an exception its
    // numbers are undefined.
    void draw(Image& picture, std::stop_token stop = {}, const ProgressCallback& progress = {});
    // Returns the truth: this view by the reference tracer, in double precision, to
    // `scene().trace_tolerance` of full scale. It takes seconds to minutes. `tile_done` gets the
    // tiles from the middle of the picture outwards, each pixel once.
    const PreciseImage& trace(std::stop_token stop = {}, const ProgressCallback& progress = {},
                              const TileCallback& tile_done = {});

    Grid::Bounds bounds();  // bounds of the data that are drawn, in world units
    // Returns a probe for the picture of the scene as it is now.
    PointProbe probe();

    // Returns the distribution of the values that the scene draws, over their finite range, in at
    // most `bins` (>= 1) intervals. If the values are whole numbers, each interval holds equally
    // many numbers. Of float32 data at most 2^21 samples are counted, evenly chosen. The session
    // counts the values only once.
    ValueHistogram histogram(int bins);

    const FrameStatistics& statistics() const;        // those of the last picture that was drawn
    const FrameStatistics& trace_statistics() const;  // those of the last one that was traced
    // Returns the warnings since the last call, each once: about data that a picture cannot show as
    // they are, and about pictures that show nothing or are saturated.
    std::vector<std::string> take_warnings();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace lamina
