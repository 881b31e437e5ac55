// SPDX-License-Identifier: Apache-2.0
#include "study/run_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/json_text.h"

namespace lamina::study {
namespace {

const nlohmann::json absent;

const nlohmann::json& setting_or_absent(const Settings& settings, const std::string& key) {
    const nlohmann::json* const found = find_setting(settings, key);
    return found == nullptr ? absent : *found;
}

bool has_all(const StudyFile::Drop& drop, const std::string& scene, const Settings& settings) {
    return std::all_of(drop.where.begin(), drop.where.end(), [&](const SweepAxis& axis) {
        const nlohmann::json found =
            axis.key == "scene" ? nlohmann::json(scene) : setting_or_absent(settings, axis.key);
        return std::find(axis.values.begin(), axis.values.end(), found) != axis.values.end();
    });
}

std::string name_of_value(const std::string& word, const nlohmann::json& value) {
    if (!value.is_object()) return fmt::format("{} {}", word, setting_text(value));
    std::string name = word;
    for (const auto& [key, each] : value.items())
        name += fmt::format(" {}", name_of_value(key, each));
    return name;
}

std::string run_id(const StudyRun& run, const StudyFile& file) {
    ContentHash hash;
    hash.add(file.scenes[run.scene].name);
    hash.add(context_of(run, file));
    hash.add(json_text(document_of(run, file)));
    if (file.reference) hash.add(name_of(*file.reference));
    return hash.hex();
}

std::vector<std::string> swept_keys(const StudyFile& file) {
    std::vector<std::string> keys;
    std::set<std::string> seen;
    for (const SweepGrid& grid : file.sweep) {
        for (const SweepAxis& axis : grid.axes) {
            if (seen.insert(axis.key).second) keys.push_back(axis.key);
        }
    }
    return keys;
}

// Expands the sweep into the runs of a list, and leaves out those that `drop` names.
class Lister {
  public:
    Lister(const StudyFile& file, RunList& list)
        : file_(file), list_(list), matched_(file.drops.size(), false) {
        for (const StudyFile::Drop& drop : file.drops) list.dropped.push_back({drop.because, 0});
        list.dropped.push_back({"the same as another run", 0});
    }
    void add(std::size_t scene, Settings settings) {
        bool is_dropped = false;
        for (std::size_t i = 0; i < file_.drops.size(); ++i) {
            if (!has_all(file_.drops[i], file_.scenes[scene].name, settings)) continue;
            matched_[i] = true;
            if (!is_dropped) ++list_.dropped[i].runs;
            is_dropped = true;
        }
        if (is_dropped) return;
        StudyRun run{{}, run_name(settings), scene, std::move(settings)};
        run.id = run_id(run, file_);
        if (ids_.insert(run.id).second)
            list_.runs.push_back(std::move(run));
        else
            ++list_.dropped.back().runs;
    }

    // Throws Error if a rule of `drop` matches no run: then its values must be mistaken.
    void check_drops() const {
        if (!file_.skipped.empty()) return;  // a rule may be about a skipped scene
        for (std::size_t i = 0; i < matched_.size(); ++i) {
            if (!matched_[i])
                fail("{}: drop.{}.where: no run has these values", file_.file.string(), i);
        }
    }

  private:
    const StudyFile& file_;
    RunList& list_;
    std::vector<bool> matched_;  // for each rule of `drop`
    std::set<std::string> ids_;
};

constexpr std::uint64_t most_counted = std::numeric_limits<std::int64_t>::max();

std::uint64_t runs_of_one_scene(const StudyFile& file) {
    std::uint64_t count = 0;
    for (const SweepGrid& grid : file.sweep) count = std::min(most_counted, count + grid.count());
    return count;
}

std::size_t find_baseline(const StudyFile& file, const RunList& list, std::size_t scene) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < list.runs.size(); ++i) {
        const StudyRun& run = list.runs[i];
        const auto is_set = [&](const auto& wanted) {
            return setting_or_absent(run.settings, wanted.first) == wanted.second;
        };
        if (run.scene != scene) continue;
        if (!file.baseline || std::all_of(file.baseline->begin(), file.baseline->end(), is_set))
            found.push_back(i);
    }
    const std::string& name = file.scenes[scene].name;
    if (found.empty()) {
        if (file.baseline)
            fail("{}: baseline: no run of scene \"{}\" has all of these values", file.file.string(),
                 name);
        fail("{}: drop: leaves no run of scene \"{}\"", file.file.string(), name);
    }
    if (file.baseline && found.size() > 1) {
        fail(
            "{}: baseline: found {} runs of scene \"{}\" ({}; {}; ...), expected values that one "
            "run alone has",
            file.file.string(), found.size(), name, list.runs[found[0]].name,
            list.runs[found[1]].name);
    }
    return found.front();
}

using Json = nlohmann::ordered_json;

Settings settings_from(const nlohmann::json& json) {
    Settings settings;
    for (const auto& [key, value] : json.items()) settings.emplace_back(key, value);
    return settings;
}

// Reads the settings that all runs share. Lists of earlier versions lack them.
void read_shared_settings(const nlohmann::json& document, RunList& list) {
    list.base = settings_from(document.value("base", nlohmann::json::object()));
    for (const nlohmann::json& each : document.value("own", nlohmann::json::array()))
        list.own.push_back(settings_from(each));
    list.own.resize(list.scenes.size());
}

}  // namespace

std::string run_name(const Settings& settings) {
    // These values, and lists of factors, explain themselves. Others are named after the last
    // component of their key.
    static const std::set<std::string> plain{"target", "method", "context", "classification"};
    std::string name;
    for (const auto& [key, value] : settings) {
        if (value.is_null()) continue;
        const std::string word = key.substr(key.rfind('.') + 1);
        const bool alone = plain.contains(word) || value.is_array();
        name += fmt::format("{}{}", name.empty() ? "" : ", ",
                            alone ? setting_text(value) : name_of_value(word, value));
    }
    return name.empty() ? "as the scene" : name;
}

std::string RunList::id() const {
    ContentHash hash;
    for (const StudyRun& run : runs) hash.add(run.id);
    for (const std::size_t baseline : baselines) hash.add(runs[baseline].id);
    hash.add(fmt::format("{} {}", rounds, frames));
    return hash.hex();
}

std::uint64_t run_count(const StudyFile& file) {
    const std::uint64_t count = runs_of_one_scene(file);
    const std::size_t scenes = file.scenes.size();
    return scenes > 0 && count > most_counted / scenes ? most_counted : count * scenes;
}

nlohmann::json document_of(const StudyRun& run, const StudyFile& file) {
    nlohmann::json document = file.scenes[run.scene].document;
    Settings settings = run.settings;
    std::erase_if(settings, [](const auto& setting) { return setting.first == "context"; });
    try {
        apply_settings(settings, document);
    } catch (const Error& error) {
        fail("{}: sweep: {}", file.file.string(), error.what());
    }
    return document;
}

std::string context_of(const StudyRun& run, const StudyFile& file) {
    const nlohmann::json* const own = find_setting(run.settings, "context");
    return own == nullptr || own->is_null() ? file.context : setting_text(*own);
}

RunList list_runs(const StudyFile& file) {
    if (run_count(file) > most_runs) {
        fail("{}: sweep: found {} runs, expected at most {}", file.file.string(), run_count(file),
             most_runs);
    }
    RunList list;
    list.title = file.title;
    list.base = file.base;
    list.swept = swept_keys(file);
    list.rounds = file.rounds;
    list.frames = file.frames;
    Lister lister(file, list);
    for (std::size_t scene = 0; scene < file.scenes.size(); ++scene) {
        list.scenes.push_back(file.scenes[scene].name);
        list.own.push_back(file.scenes[scene].own);
        for (const SweepGrid& grid : file.sweep) {
            for (std::uint64_t n = 0; n < grid.count(); ++n) lister.add(scene, grid.settings(n));
        }
    }
    lister.check_drops();
    std::erase_if(list.dropped, [](const RunList::Dropped& each) { return each.runs == 0; });
    const std::uint64_t runs_of_scene = runs_of_one_scene(file);
    for (const StudyFile::Skipped& skipped : file.skipped)
        list.dropped.push_back({skipped.because, runs_of_scene});
    for (std::size_t scene = 0; scene < file.scenes.size(); ++scene)
        list.baselines.push_back(find_baseline(file, list, scene));
    return list;
}

nlohmann::ordered_json settings_json(const Settings& settings) {
    Json json = Json::object();
    for (const auto& [key, value] : settings) json[key] = value;
    return json;
}

void match_data(RunList& list, const std::string& list_of, const RunList& other,
                const std::string& other_of) {
    if (list.data.size() != other.data.size()) {
        fail("{}: names {} data sets, expected the {} of {}", list_of, list.data.size(),
             other.data.size(), other_of);
    }
    for (std::size_t i = 0; i < list.data.size(); ++i) {
        RunList::Data& found = list.data[i];
        const RunList::Data& expected = other.data[i];
        if (found.content.empty()) found.content = expected.content;
        if (expected.content.empty() || found.content == expected.content) continue;
        fail(
            "{}: found data of hash {} ({}), expected {} ({}): results of different data do not "
            "go together",
            found.name, found.content, list_of, expected.content, other_of);
    }
}

nlohmann::ordered_json to_json(const RunList& list) {
    Json json{{"study", list.id()},       {"title", list.title},
              {"rounds", list.rounds},    {"frames", list.frames},
              {"scenes", list.scenes},    {"swept", list.swept},
              {"dropped", Json::array()}, {"baselines", list.baselines},
              {"data", Json::array()},    {"base", settings_json(list.base)},
              {"own", Json::array()},     {"runs", Json::array()}};
    for (const Settings& own : list.own) json["own"].push_back(settings_json(own));
    for (const RunList::Data& data : list.data)
        json["data"].push_back({{"name", data.name}, {"content", data.content}});
    for (const RunList::Dropped& dropped : list.dropped)
        json["dropped"].push_back({{"because", dropped.because}, {"runs", dropped.runs}});
    for (const StudyRun& run : list.runs) {
        json["runs"].push_back({{"id", run.id},
                                {"name", run.name},
                                {"scene", run.scene},
                                {"settings", settings_json(run.settings)}});
    }
    return json;
}

RunList run_list_from(const nlohmann::json& document, const std::filesystem::path& file) {
    if (document.is_object() && document.contains("study") && !document.contains("data")) {
        fail(
            "{}: found no \"data\", which says what was drawn: an older lamina wrote it; expected "
            "an empty folder, where the study begins anew",
            file.string());
    }
    try {
        RunList list;
        const auto required = [&](const char* key) -> const nlohmann::json& {
            if (!document.contains(key)) fail("it has no \"{}\"", key);
            return document.at(key);
        };
        required("title").get_to(list.title);
        required("rounds").get_to(list.rounds);
        required("frames").get_to(list.frames);
        required("scenes").get_to(list.scenes);
        read_shared_settings(document, list);
        required("swept").get_to(list.swept);
        required("baselines").get_to(list.baselines);
        for (const nlohmann::json& each : required("dropped"))
            list.dropped.push_back({each.at("because"), each.at("runs")});
        for (const nlohmann::json& each : required("data"))
            list.data.push_back({each.at("name"), each.at("content")});
        for (const nlohmann::json& each : required("runs")) {
            StudyRun run{each.at("id"), each.at("name"), each.at("scene"),
                         settings_from(each.at("settings"))};
            if (run.scene >= list.scenes.size()) fail("a run names scene {}", run.scene);
            list.runs.push_back(std::move(run));
        }
        for (const std::size_t baseline : list.baselines) {
            if (baseline >= list.runs.size()) fail("a baseline is run {}", baseline);
        }
        if (list.baselines.size() != list.scenes.size() || list.id() != required("study"))
            fail("its runs are not those that it was written with");
        return list;
    } catch (const nlohmann::json::exception&) {
        fail(
            "{}: not a list of runs that lamina study wrote: a key is missing or has a value of "
            "another kind",
            file.string());
    } catch (const Error& error) {
        fail("{}: not a list of runs that lamina study wrote: {}", file.string(), error.what());
    }
}

}  // namespace lamina::study
