// SPDX-License-Identifier: Apache-2.0
#include "study/study_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <numeric>
#include <utility>

#include "base/client.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "image/difference.h"
#include "image/exr.h"
#include "render/draw_context.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_reader.h"
#include "study/report_files.h"

namespace lamina::study {
namespace {

using Kind = StudyData::Kind;

std::string content_of(const StudyData& data, DataStore& store) {
    try {
        if (data.kind == Kind::volume) return store.volume(data.drawn).content;
        if (data.kind == Kind::mesh) return store.mesh(data.drawn).content;
        return study::content_of(read_paraview_colormap(colormap_file_of(data.drawn)));
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception&) {
        return {};
    }
}

// Adds the data that a run of scene `number` draws, and those of its reference, unless they are
// listed already. For a mesh made from a volume, the volume is added.
void add_data(std::size_t number, const Scene& drawn, TraceOf reference,
              std::vector<StudyData>& data) {
    const auto add = [&](Kind kind, const std::string& name) {
        StudyData found{kind, name, number, drawn};
        if (std::find(data.begin(), data.end(), found) == data.end())
            data.push_back(std::move(found));
    };
    const bool needs_mesh = drawn.draws_mesh() || reference == TraceOf::mesh;
    const bool needs_volume = !drawn.draws_mesh() || reference == TraceOf::volume ||
                              (needs_mesh && drawn.made_mesh() != nullptr);
    if (needs_volume && drawn.has_volume()) add(Kind::volume, volume_name(drawn));
    if (needs_mesh && drawn.mesh_file() != nullptr) add(Kind::mesh, mesh_name(drawn));
    const std::filesystem::path colormap = colormap_file_of(drawn);
    if (!colormap.empty()) add(Kind::colormap, colormap.string());
}

void check_file(const std::filesystem::path& path, const StudyFile::SceneEntry& scene) {
    if (!std::filesystem::exists(path))
        fail("scene \"{}\": {}: no such file", scene.name, path.string());
}

void check_context(const std::string& word, const StudyFile& study) {
    if (!is_context(word)) {
        fail("{}: context: found \"{}\", expected {}", study.file.string(), word, context_words());
    }
}

TraceOf reference_of(const Scene& scene, const StudyFile& file) {
    if (file.reference) return *file.reference;
    return scene.method == Method::project ? TraceOf::mesh : TraceOf::volume;
}

// Returns the scene of a run. Throws KeyError if no run can be measured with it: it has the method
// "trace", or lacks the data of the reference.
Scene scene_of(const StudyRun& run, const StudyFile& file) {
    Scene scene = read_scene(document_of(run, file), file.scenes[run.scene].file);
    const std::string name = scene.file.string();
    if (scene.method == Method::trace) {
        throw KeyError("render.method",
                       fmt::format("{}: render.method: found \"trace\", expected \"slice\" or "
                                   "\"project\": the tracer is what runs are measured against",
                                   name));
    }
    const char* const automatic = chooses_transfer_function(scene) ? "transfer_function"
                                  : scene.camera.is_automatic()    ? "camera"
                                                                   : nullptr;
    if (automatic != nullptr) {
        throw KeyError(automatic,
                       fmt::format("{0}: {1}: is \"auto\" or missing, expected an object {{...}}: "
                                   "the runs of a study share one ('lamina scene {0} -o NEW.json' "
                                   "writes what would be chosen)",
                                   name, automatic));
    }
    const TraceOf reference = reference_of(scene, file);
    if (!(reference == TraceOf::volume ? scene.has_volume() : scene.has_mesh())) {
        const char* const data = name_of(reference);
        throw KeyError(
            data, fmt::format("{}: the reference is a {}'s, and the scene has none", name, data));
    }
    return scene;
}

using Json = nlohmann::ordered_json;

// Renderers are kept for the next round while all of them together take at most this many bytes;
// beyond it, renderers are dropped and made again in each round.
constexpr std::int64_t kept_bytes = std::int64_t{1} << 30;

}  // namespace

std::vector<StudyData> check_runs(const RunList& list, const StudyFile& study) {
    struct Outcome {
        std::size_t runs = 0, failed = 0;
        std::string message;
    };
    std::vector<Outcome> outcomes(list.scenes.size());
    std::vector<StudyData> data;
    for (const StudyRun& run : list.runs) {
        const StudyFile::SceneEntry& entry = study.scenes[run.scene];
        Outcome& outcome = outcomes[run.scene];
        ++outcome.runs;
        check_context(context_of(run, study), study);
        try {
            const Scene scene = scene_of(run, study);
            if (const VolumeFile* const file = scene.volume_file()) check_file(file->path, entry);
            if (const MeshFile* const file = scene.mesh_file()) check_file(file->path, entry);
            add_data(run.scene, scene, reference_of(scene, study), data);
        } catch (const UnknownKeyError& error) {
            fail("{}: {}", study.file.string(), error.what());
        } catch (const KeyError& error) {
            if (outcome.failed++ == 0) outcome.message = error.what();
        } catch (const Error& error) {  // a missing file
            fail("{}: {}", study.file.string(), error.what());
        }
    }
    for (const Outcome& outcome : outcomes) {
        if (outcome.failed == outcome.runs)
            fail("{}: no run can be drawn: {}", study.file.string(), outcome.message);
    }
    return data;
}

void list_data(const std::vector<StudyData>& data, DataStore& store, RunList& list) {
    std::map<std::pair<Kind, std::string>, std::string> known;
    for (const StudyData& each : data) {
        // Only one scene's data are in memory at a time.
        if (each.scene != data.front().scene) store.clear();
        const auto [found, added] = known.try_emplace({each.kind, each.name});
        if (added) found->second = content_of(each, store);
        list.data.push_back({each.name, found->second});
    }
    if (!data.empty() && data.back().scene != data.front().scene) store.clear();
}

StudyRunner::StudyRunner(const RunList& list, const StudyFile& file, const StudyFolder& folder,
                         Shard shard, const nlohmann::ordered_json& begin, DataStore data,
                         ReferenceStore::Say say)
    : list_(list),
      file_(file),
      folder_(folder),
      shard_(shard),
      journal_(folder.journal(shard.number, shard.count)),
      done_(list.runs.size(), Done{std::vector<char>(static_cast<std::size_t>(list.rounds)),
                                   std::vector<char>(static_cast<std::size_t>(list.rounds))}),
      data_(std::move(data)),
      say_(std::move(say)),
      references_(folder.references(), say_),
      contexts_([this] { drop_opengl(); }) {
    try {
        take_over(journal_.found());
    } catch (const std::exception& error) {
        fail("{}: holds records that lamina study did not write: {}",
             folder.journal(shard.number, shard.count).string(), strange_record(error));
    }
    journal_.append(begin);
}

void StudyRunner::take_over(const std::vector<nlohmann::json>& records) {
    if (!records.empty() && !records.front().contains("begin"))
        fail("line 1 does not say how a process began");
    std::map<std::string, std::size_t> number_of;
    for (std::size_t i = 0; i < list_.runs.size(); ++i) number_of[list_.runs[i].id] = i;
    for (const nlohmann::json& record : records) {
        session_ += record.contains("begin") ? 1 : 0;
        const auto found = number_of.find(record.value("run", ""));
        if (found == number_of.end()) continue;
        Done& done = done_[found->second];
        if (record.contains("drawn")) done.drawn = has_pictures(found->first, record["drawn"]);
        if (record.contains("round")) done.rounds.at(record["round"].get<std::size_t>()) = 1;
    }
    time_baselines_again();
}

// Tells whether the run's picture and reference exist: after a power cut a record may exist without
// them.
bool StudyRunner::has_pictures(const std::string& run, const nlohmann::json& drawn) {
    const auto [found, added] =
        kept_references_.try_emplace(drawn.at("reference").get<std::string>());
    if (added) found->second = references_.is_kept(found->first);
    return found->second && std::filesystem::exists(folder_.picture(run));
}

// Marks baselines to be timed again: runs that are still to be timed are compared with a baseline
// of the same session.
void StudyRunner::time_baselines_again() {
    for (std::size_t run = 0; run < list_.runs.size(); ++run) {
        if (!is_wanted(run) || is_finished(run)) continue;
        std::vector<char>& again = done_[list_.baselines[list_.runs[run].scene]].again;
        std::fill(again.begin(), again.end(), char{1});
    }
}

bool StudyRunner::is_wanted(std::size_t run) const {
    return shard_.has(run) || list_.baselines[list_.runs[run].scene] == run;
}

bool StudyRunner::is_finished(std::size_t run) const {
    const Done& done = done_[run];
    return done.failed ||
           (done.drawn && std::count(done.rounds.begin(), done.rounds.end(), 0) == 0);
}

std::size_t StudyRunner::wanted() const {
    std::size_t count = 0;
    for (std::size_t run = 0; run < list_.runs.size(); ++run) count += is_wanted(run) ? 1 : 0;
    return count;
}

std::size_t StudyRunner::finished() const {
    std::size_t count = 0;
    for (std::size_t run = 0; run < list_.runs.size(); ++run)
        count += is_wanted(run) && is_finished(run) ? 1 : 0;
    return count;
}

// Returns the runs to do, those of one context after one another: making an OpenGL context takes
// longer than a frame.
std::vector<std::size_t> StudyRunner::runs_of(std::size_t scene) const {
    std::vector<std::size_t> runs;
    for (std::size_t run = 0; run < list_.runs.size(); ++run) {
        if (list_.runs[run].scene == scene && is_wanted(run)) runs.push_back(run);
    }
    std::stable_sort(runs.begin(), runs.end(), [&](std::size_t a, std::size_t b) {
        return context_of(list_.runs[a], file_) < context_of(list_.runs[b], file_);
    });
    return runs;
}

void StudyRunner::run() {
    Progress progress(list_.title, static_cast<std::int64_t>(wanted() - finished()) * list_.rounds);
    for (std::size_t scene = 0; scene < list_.scenes.size(); ++scene) run_scene(scene, progress);
}

void StudyRunner::run_scene(std::size_t scene, Progress& progress) {
    std::vector<std::size_t> runs = runs_of(scene);
    std::erase_if(runs, [&](std::size_t run) {
        const std::vector<char>& again = done_[run].again;
        return is_finished(run) && std::count(again.begin(), again.end(), 1) == 0;
    });
    for (int round = 0; round < list_.rounds; ++round) {
        for (const std::size_t run : runs) {
            check_interrupt();
            const Stopwatch watch;
            timing_ms_ = 0;
            if (!done_[run].failed) visit(run, round);
            if (round == 0)
                time_left_.add_first(watch.seconds(), timing_ms_ / 1000);
            else
                time_left_.add_later(watch.seconds());
            progress.advance();
        }
        if (round == 0 && !runs.empty()) say_time_left(scene, runs.size());
    }
    frames_.clear();
    references_.clear();
    data_.clear();
}

// Says how long the rest takes. `runs`: number of runs of the scene whose first round is done.
void StudyRunner::say_time_left(std::size_t scene, std::size_t runs) const {
    std::size_t unseen = 0;  // runs of later scenes
    for (std::size_t run = 0; run < list_.runs.size(); ++run)
        unseen += list_.runs[run].scene > scene && is_wanted(run) && !is_finished(run) ? 1 : 0;
    const auto later_rounds = static_cast<std::size_t>(list_.rounds - 1);
    const double seconds = time_left_.of(unseen, later_rounds * (runs + unseen));
    if (unseen + later_rounds > 0)
        say_(fmt::format("{}: first round of {} runs done: about {} left of all",
                         list_.scenes[scene], runs, duration_text(seconds)));
}

// Draws and times one run in one round. An error in a run is recorded and does not stop the others;
// a failure to write does.
void StudyRunner::visit(std::size_t run, int round) {
    Done& done = done_[run];
    const auto number = static_cast<std::size_t>(round);
    const bool timed = done.rounds[number] != 0 && done.again[number] == 0;
    if (done.drawn && timed) return;
    Measured measured;
    try {
        StudyFrames& frames = frames_of(run);
        if (!done.drawn) measure_picture(run, frames, measured);
        if (!timed) measured.records.push_back(time_round(run, round, frames));
        drop_if_full(run);
    } catch (const Interrupted&) {
        throw;
    } catch (const WriteError&) {
        throw;
    } catch (const std::bad_alloc&) {
        return give_up(run, "out of memory");
    } catch (const std::exception& error) {
        return give_up(run, one_line(error_text(error)));
    }
    record(run, round, measured);
}

void StudyRunner::give_up(std::size_t run, const std::string& why) {
    frames_.erase(run);
    journal_.append({{"run", list_.runs[run].id}, {"failed", why}});
    done_[run].failed = true;
}

void StudyRunner::record(std::size_t run, int round, const Measured& measured) {
    if (measured.picture) {
        AtomicFile file(folder_.picture(list_.runs[run].id));
        write_exr(file, *measured.picture, {}, measured.space);
        file.commit();
    }
    for (const Json& record : measured.records) journal_.append(record);
    done_[run].drawn = true;
    done_[run].rounds[static_cast<std::size_t>(round)] = 1;
    done_[run].again[static_cast<std::size_t>(round)] = 0;
}

void StudyRunner::drop_if_full(std::size_t run) {
    const auto total = [](std::int64_t sum, const auto& kept) { return sum + kept.second.bytes(); };
    if (std::accumulate(frames_.begin(), frames_.end(), std::int64_t{0}, total) > kept_bytes)
        frames_.erase(run);
}

StudyFrames& StudyRunner::frames_of(std::size_t run) {
    const Capabilities& capabilities = contexts_.use(context_of(list_.runs[run], file_));
    const auto found = frames_.find(run);
    if (found != frames_.end()) return found->second;
    return frames_
        .try_emplace(run, data_.closed(scene_of(list_.runs[run], file_)), data_, capabilities,
                     tables_)
        .first->second;
}

void StudyRunner::measure_picture(std::size_t run, StudyFrames& frames, Measured& measured) {
    frames.draw();  // drawn a second time: the first frame's times are those of cold caches
    const Image image = frames.picture();
    const Scene& scene = frames.scene();
    const Reference& reference = references_.get(scene, reference_of(scene, file_), data_);
    const ImageError error = image_error(image, reference.image);
    Json drawn = to_json(error);
    drawn["reference"] = reference.id;
    drawn["renderer"] = renderer_and_threads(contexts_.use(context_of(list_.runs[run], file_)));
    drawn["bytes_gpu"] = frames.bytes_gpu();
    drawn["bytes_host"] = frames.bytes_host();
    drawn["stages"] = frames.stages_ms();
    drawn["stages"]["set_up"] = frames.set_up_ms();
    drawn["first_ms"] = frames.first_ms();
    measured.picture = image;
    measured.space = scene.color_space;
    measured.records.push_back({{"run", list_.runs[run].id}, {"drawn", drawn}});
}

nlohmann::ordered_json StudyRunner::time_round(std::size_t run, int round, StudyFrames& frames) {
    const Stopwatch all;
    const auto timed = [](const auto& draw) {
        const Stopwatch watch;
        draw();
        return watch.milliseconds();
    };
    std::vector<double> moving, still;
    frames.draw();  // warms up caches that other runs have filled
    for (int i = 0; i < list_.frames; ++i) still.push_back(timed([&] { frames.draw(); }));
    for (int i = 1; i <= list_.frames; ++i)
        moving.push_back(timed([&] { frames.draw_turned(degrees_per_frame * i); }));
    timing_ms_ = all.milliseconds();
    return {{"run", list_.runs[run].id},
            {"session", session_},
            {"round", round},
            {"frame_ms", moving},
            {"still_ms", still}};
}

void StudyRunner::drop_opengl() {
    std::erase_if(frames_, [](const auto& kept) { return !kept.second.on_cpu(); });
}

}  // namespace lamina::study
