// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "study/draw_contexts.h"
#include "study/journal.h"
#include "study/reference_store.h"
#include "study/run_list.h"
#include "study/study_folder.h"
#include "study/study_frames.h"

namespace lamina::study {

// Which runs of a list a process does: those whose number leaves `number` - 1 when divided by
// `count`.
struct Shard {
    int number = 1, count = 1;
    bool has(std::size_t run) const {
        return run % static_cast<std::size_t>(count) == static_cast<std::size_t>(number - 1);
    }
};

// Draws and measures the runs of a study, scene by scene: in rounds A B C, A B C, ..., so that what
// slows the machine for a while slows all of them. A shard without a scene's baseline times it,
// too.
//
// Records of the journal, in any order (times in ms, errors in 1/255):
//   {"begin": {machine, processors, date, version, commit, command}}   of every process
//   {"run", "session", "round", "frame_ms": [...], "still_ms": [...]}   a round; sessions count the
//                                                             processes: only within one are rounds
//                                                             neighbours in time
//   {"run", "drawn": {...}}                                   picture and costs, once a run
//   {"run", "failed": message}                                instead of these; tried again when
//                                                             the study goes on
class StudyRunner {
  public:
    // `begin`: a record of where and how this process runs. `data`: may hold some of the first
    // scene's. `say`: for what is done again though it was done before. Throws Error where the
    // journal cannot be written, or another process writes it.
    StudyRunner(const RunList& list, const StudyFile& file, const StudyFolder& folder, Shard shard,
                const nlohmann::ordered_json& begin, DataStore data, ReferenceStore::Say say);

    // Does what the journal lacks. Throws Interrupted, and Error where records cannot be written;
    // whatever is wrong with a run alone is recorded.
    void run();
    // Of this shard, as far as the journal goes.
    std::size_t finished() const;
    std::size_t wanted() const;

  private:
    struct Done {
        std::vector<char> rounds;  // of them, in any session
        std::vector<char> again;   // of a baseline: to be timed in this session, too
        bool drawn = false, failed = false;
    };

    // Of one visit, not yet on the disk.
    struct Measured {
        std::optional<Image> picture;
        std::vector<nlohmann::ordered_json> records;
    };

    void take_over(const std::vector<nlohmann::json>& records);
    void time_baselines_again();
    bool has_pictures(const std::string& run, const nlohmann::json& drawn);
    bool is_wanted(std::size_t run) const;
    bool is_finished(std::size_t run) const;
    std::vector<std::size_t> runs_of(std::size_t scene) const;
    void run_scene(std::size_t scene, Progress& progress);
    void visit(std::size_t run, int round);
    StudyFrames& frames_of(std::size_t run);
    void measure_picture(std::size_t run, StudyFrames& frames, Measured& measured);
    nlohmann::ordered_json time_round(std::size_t run, int round, StudyFrames& frames) const;
    void record(std::size_t run, int round, const Measured& measured);
    void give_up(std::size_t run, const std::string& why);
    void drop_if_full(std::size_t run);
    void drop_opengl();

    const RunList& list_;
    const StudyFile& file_;
    const StudyFolder& folder_;
    Shard shard_;
    Journal journal_;
    std::int64_t session_ = 0;
    std::vector<Done> done_;
    DataStore data_;
    ReferenceStore references_;
    std::map<std::string, bool> kept_references_;  // as they were found, by id
    std::map<std::size_t, StudyFrames> frames_;    // that are kept for the next round
    DrawContexts contexts_;
};

}  // namespace lamina::study
