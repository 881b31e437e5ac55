// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/progress.h"
#include "base/stopwatch.h"
#include "gl/memory.h"
#include "gl/query.h"
#include "render_job.h"

namespace lamina {

// Draws the scene's own frame with a renderer on OpenGL and returns it; its time, that of reading
// it back, its memory and, where somebody will read them, its fragments go into the statistics.
template <typename Renderer>
Image draw_first_frame(Renderer& renderer, const char* label, const RenderRequest& request,
                       const View& view, RenderStats& stats) {
    const Stopwatch frame_watch;
    {
        Progress progress(label, renderer.step_count());
        if (request.count_fragments) {
            gl::Query query(gl::Query::Kind::samples_passed);
            query.begin();
            renderer.draw(view, &progress);
            query.end();
            stats.fragments = query.result();
        } else {
            renderer.draw(view, &progress);
        }
    }
    stats.frames_ms = {frame_watch.milliseconds()};
    const Stopwatch read_watch;
    Image image = renderer.read();
    stats.stages_ms["read"] = read_watch.milliseconds();
    stats.bytes_gpu = gl::bytes_allocated();
    return image;
}

}  // namespace lamina
