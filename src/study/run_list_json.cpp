// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/error.h"
#include "study/run_list.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

Settings settings_from(const nlohmann::json& json) {
    Settings settings;
    for (const auto& [key, value] : json.items()) settings.emplace_back(key, value);
    return settings;
}

// Reads what all runs share. A list of an earlier version does not say it.
void read_shared_settings(const nlohmann::json& document, RunList& list) {
    list.base = settings_from(document.value("base", nlohmann::json::object()));
    for (const nlohmann::json& each : document.value("own", nlohmann::json::array()))
        list.own.push_back(settings_from(each));
    list.own.resize(list.scenes.size());
}

}  // namespace

nlohmann::ordered_json settings_json(const Settings& settings) {
    Json json = Json::object();
    for (const auto& [key, value] : settings) json[key] = value;
    return json;
}

void list_data(const std::vector<StudyData>& data, DataStore& store, RunList& list) {
    const std::vector<std::string> contents = contents_of(data, store);
    for (std::size_t i = 0; i < data.size(); ++i) list.data.push_back({data[i].name, contents[i]});
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
