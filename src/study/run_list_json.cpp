// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/error.h"
#include "study/run_list.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

Json settings_to_json(const Settings& settings) {
    Json json = Json::object();
    for (const auto& [key, value] : settings) json[key] = value;
    return json;
}

}  // namespace

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
    Json json{{"study", list.id()},       {"title", list.title},         {"rounds", list.rounds},
              {"frames", list.frames},    {"scenes", list.scenes},       {"swept", list.swept},
              {"dropped", Json::array()}, {"baselines", list.baselines}, {"data", Json::array()},
              {"runs", Json::array()}};
    for (const RunList::Data& data : list.data)
        json["data"].push_back({{"name", data.name}, {"content", data.content}});
    for (const RunList::Dropped& dropped : list.dropped)
        json["dropped"].push_back({{"because", dropped.because}, {"runs", dropped.runs}});
    for (const StudyRun& run : list.runs) {
        json["runs"].push_back({{"id", run.id},
                                {"name", run.name},
                                {"scene", run.scene},
                                {"settings", settings_to_json(run.settings)}});
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
        document.at("title").get_to(list.title);
        document.at("rounds").get_to(list.rounds);
        document.at("frames").get_to(list.frames);
        document.at("scenes").get_to(list.scenes);
        document.at("swept").get_to(list.swept);
        document.at("baselines").get_to(list.baselines);
        for (const nlohmann::json& each : document.at("dropped"))
            list.dropped.push_back({each.at("because"), each.at("runs")});
        for (const nlohmann::json& each : document.at("data"))
            list.data.push_back({each.at("name"), each.at("content")});
        for (const nlohmann::json& each : document.at("runs")) {
            StudyRun run{each.at("id"), each.at("name"), each.at("scene"), {}};
            for (const auto& [key, value] : each.at("settings").items())
                run.settings.emplace_back(key, value);
            if (run.scene >= list.scenes.size()) fail("a run names scene {}", run.scene);
            list.runs.push_back(std::move(run));
        }
        for (const std::size_t baseline : list.baselines) {
            if (baseline >= list.runs.size()) fail("a baseline is run {}", baseline);
        }
        if (list.baselines.size() != list.scenes.size() || list.id() != document.at("study"))
            fail("its runs are not those that it was written with");
        return list;
    } catch (const nlohmann::json::exception& error) {
        fail("{}: not a list of runs that lamina study wrote: {}", file.string(), error.what());
    } catch (const Error& error) {
        fail("{}: not a list of runs that lamina study wrote: {}", file.string(), error.what());
    }
}

}  // namespace lamina::study
