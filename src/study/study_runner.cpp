// SPDX-License-Identifier: Apache-2.0
#include "study/study_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "image/difference.h"
#include "image/exr.h"
#include "study/result_files.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// Renderers are kept for the next round while all of them together take less. Beyond that they are
// made each time.
constexpr std::int64_t kept_bytes = std::int64_t{1} << 30;

}  // namespace

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
    } catch (const Error& error) {
        fail("{}: holds records that lamina study did not write: {}",
             folder.journal(shard.number, shard.count).string(), error.what());
    } catch (const std::exception&) {
        fail("{}: holds records that lamina study did not write: {}",
             folder.journal(shard.number, shard.count).string(), strange_record);
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

// A power cut may keep a record and lose its picture.
bool StudyRunner::has_pictures(const std::string& run, const nlohmann::json& drawn) {
    const auto [found, added] =
        kept_references_.try_emplace(drawn.at("reference").get<std::string>());
    if (added) found->second = references_.is_kept(found->first);
    return found->second && std::filesystem::exists(folder_.picture(run));
}

// Runs that are still to be timed need their baseline timed in the same session.
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

// Runs of one context follow one another, because making an OpenGL context takes longer than a
// frame.
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

// `runs`: of the scene whose first round is done.
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

// An error in one run does not stop the others. A failure to write does.
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
    frames.draw();  // a second time: the stages of a first frame are those of cold memory
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
    frames.draw();  // the warm-up: other runs have filled the caches
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
    std::erase_if(frames_, [](const auto& kept) { return !kept.second.on_tiles(); });
}

}  // namespace lamina::study
