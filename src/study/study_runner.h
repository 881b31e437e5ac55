// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/client.h"
#include "lamina/scene.h"
#include "study/data_store.h"
#include "study/run_list.h"
#include "study/study_frames.h"
#include "study/study_results.h"
#include "study/time_left.h"

namespace lamina::study {

// A volume, a mesh or a colour map that runs of a study draw.
struct StudyData {
    enum class Kind { volume, mesh, colormap };
    Kind kind;
    std::string name;   // its path, or its formula
    std::size_t scene;  // number of the scene in the study
    Scene drawn;        // scene of a run that draws it

    bool operator==(const StudyData& other) const {
        return kind == other.kind && scene == other.scene && name == other.name;
    }
};

// Reads the scene of every run and checks that its files exist. Throws Error if a file is missing,
// a key is unknown, or no run of a scene can be drawn. Other errors show when a run is drawn.
// Returns the data that the runs draw, each once.
std::vector<StudyData> check_runs(const RunList& list, const StudyFile& file);

// Adds the data to the list, with hashes of their contents. Each is read once. If data cannot be
// read, the hash is empty, and the runs that need them report the error. If all data belong to one
// scene, they stay in the store.
void list_data(const std::vector<StudyData>& data, DataStore& store, RunList& list);

// The runs that one of `count` processes does: those whose index leaves the remainder `number` - 1
// when divided by `count`.
struct Shard {
    int number = 1, count = 1;
    bool has(std::size_t run) const {
        return run % static_cast<std::size_t>(count) == static_cast<std::size_t>(number - 1);
    }
};

// Draws and measures the runs of a study, scene by scene. It goes in rounds A B C, A B C, ..., so
// that a slow phase of the machine affects all of them. A shard without a scene's baseline also
// times that baseline.
//
// The journal has these records, in any order (times in ms, errors in 1/255):
//   {"begin": {machine, processors, date, version, commit, command}}
//       one for every process
//   {"run", "session", "round", "frame_ms": [...], "still_ms": [...]}
//       one for every round; sessions number the processes, and rounds are neighbours in time only
//       within one session
//   {"run", "drawn": {...}}
//       picture and costs, once for every run, with first_ms, the time of the first picture
//   {"run", "failed": message}
//       instead of the others; the run is tried again when the study goes on
class StudyRunner {
  public:
    // `begin`: a record of where and how this process runs. `data`: may hold data of the first
    // scene already. `say`: called with messages about work that is done again, and, after the
    // first round of each scene, about the time left. Throws Error if the journal cannot be
    // written, or if another process is writing it.
    StudyRunner(const RunList& list, const StudyFile& file, const StudyFolder& folder, Shard shard,
                const nlohmann::ordered_json& begin, DataStore data, ReferenceStore::Say say);

    // Does all runs that the journal lacks. Throws Interrupted; and Error if records cannot be
    // written. Errors of single runs are recorded.
    void run();
    // Return the number of this shard's runs that are done, and of all of them.
    std::size_t finished() const;
    std::size_t wanted() const;

  private:
    struct Done {
        std::vector<char> rounds;  // rounds done, in any session
        std::vector<char> again;   // for a baseline: rounds to time in this session, too
        bool drawn = false, failed = false;
    };

    // Results of one visit to a run, before they are written to disk.
    struct Measured {
        std::optional<Image> picture;
        ImageColorSpace space = ImageColorSpace::linear;
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
    void say_time_left(std::size_t scene, std::size_t runs) const;
    StudyFrames& frames_of(std::size_t run);
    void measure_picture(std::size_t run, StudyFrames& frames, Measured& measured);
    nlohmann::ordered_json time_round(std::size_t run, int round, StudyFrames& frames);
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
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    ReferenceStore::Say say_;
    ReferenceStore references_;
    std::map<std::string, bool> kept_references_;  // by id: true if the reference was intact
    std::map<std::size_t, StudyFrames> frames_;    // kept for the next round
    DrawContexts contexts_;
    TimeLeft time_left_;
    double timing_ms_ = 0;  // time of the last call of time_round()
};

}  // namespace lamina::study
