// SPDX-License-Identifier: Apache-2.0
// Tests tables of keys: reader, writer and schema of the made-up structs Lamp and Room.
#include "scene_files/keys.h"

#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

struct Lamp {
    int number = 3;
    double power = .5;
    Auto<double> range;
    std::optional<std::string> name;
    bool on = false;
    bool operator==(const Lamp&) const = default;
};

struct Room {
    Lamp lamp;
    std::vector<Lamp> more;
    std::optional<double> height;  // without a value: "open"
    bool operator==(const Room&) const = default;
};

const KeyTable<Lamp>& lamp_keys() {
    static const auto table = [] {
        KeyTable<Lamp> keys;
        keys.key("number", &Lamp::number, whole_form<int>(1, 9), "Of the lamp.").required();
        keys.key("power", &Lamp::power, number_form({.above = 0, .up_to = 1}, "0 to 1"));
        keys.key("range", &Lamp::range,
                 automatic_form(number_form(), &nlohmann::json::is_number, "a number or auto"));
        keys.key("name", &Lamp::name, optional_form(text_form()));
        keys.key("on", &Lamp::on, flag_form());
        keys.check([](JsonReader& reader, Lamp& lamp) {
            if (lamp.on && lamp.power < .1)
                reader.reject("power", "at least .1 of a lamp that is on");
        });
        return keys;
    }();
    return table;
}

const KeyTable<Room>& room_keys() {
    static const auto table = [] {
        KeyTable<Room> keys;
        keys.object("lamp", &Room::lamp, lamp_keys, "The first one.");
        keys.key("more", &Room::more, list_form(lamp_keys, 2, "lamps", {{"maxItems", 2}}));
        const Alternative<Room> open{
            [](const nlohmann::json& value) { return value == "open"; },
            [](JsonReader&, const std::string&, Room& room) { room.height.reset(); },
            [](const Room& room) { return !room.height; },
            [](const Room&) { return KeyJson("open"); },
            {{"const", "open"}}};
        const Alternative<Room> given{[](const nlohmann::json& value) { return value.is_number(); },
                                      [](JsonReader& reader, const std::string& key, Room& room) {
                                          room.height = reader.number(key);
                                      },
                                      [](const Room& room) { return room.height.has_value(); },
                                      [](const Room& room) { return KeyJson(*room.height); },
                                      {{"type", "number"}}};
        keys.variant("height", {open, given}, "\"open\" or a number").otherwise("open");
        return keys;
    }();
    return table;
}

Room read_room(const char* text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    const std::filesystem::path file = "room.json";
    JsonReader reader(json, file);
    Room room;
    room_keys().read(reader, room);
    return room;
}

TEST(Keys, AreReadAndWrittenBack) {
    const Room room = read_room(R"({"lamp": {"number": 7, "power": 0.25, "range": 2, "name": "a"},
                                    "more": [{"number": 1, "on": true}], "height": 3})");
    EXPECT_EQ(room.lamp, (Lamp{7, .25, 2., "a", false}));
    EXPECT_EQ(room.more, (std::vector<Lamp>{{1, .5, {}, {}, true}}));
    EXPECT_EQ(room.height, 3);
    const std::string text = room_keys().json(room).dump();
    EXPECT_EQ(read_room(text.c_str()), room);
    EXPECT_EQ(text, R"({"lamp":{"number":7,"power":0.25,"range":2.0,"name":"a","on":false},)"
                    R"("more":[{"number":1,"power":0.5,"range":"auto","on":true}],"height":3.0})");
}

TEST(Keys, KeepTheirDefaultsIfTheyAreLeftOut) {
    EXPECT_EQ(read_room(R"({"lamp": {"number": 3}})"), Room{});
    EXPECT_EQ(room_keys().json(Room{}).dump(),
              R"({"lamp":{"number":3,"power":0.5,"range":"auto","on":false},"height":"open"})");
}

TEST(Keys, MistakesNameFileAndPath) {
    const auto expect = [](const char* text, std::initializer_list<std::string> parts) {
        expect_error([&] { read_room(text); }, parts);
    };
    expect("{}", {"room.json: lamp.number: is missing, expected a whole number from 1 to 9"});
    expect(R"({"lamp": {"number": 3, "power": 2}})", {"lamp.power: found 2, expected 0 to 1"});
    expect(R"({"lamp": {"number": 3, "range": "x"}})",
           {"lamp.range: found \"x\", expected a number"});
    expect(R"({"lamp": {"number": 3, "power": 0.01, "on": true}})", {"lamp.power", "that is on"});
    expect(R"({"lamp": {"number": 3, "onn": true}})", {"lamp.onn: unknown key", "\"on\""});
    expect(R"({"lamp": {"number": 3}, "more": [{"number": 1}, {"number": 0}]})", {"more.1.number"});
    expect(R"({"lamp": {"number": 3}, "more": [{}, {}, {}]})",
           {"found 3 lamps, expected at most 2"});
    expect(R"({"lamp": {"number": 3}, "height": []})", {"height: found [], expected \"open\" or"});
}

TEST(Keys, DetermineTheSchema) {
    const nlohmann::json schema = room_keys().schema();
    const nlohmann::json& lamp = schema["properties"]["lamp"];
    EXPECT_EQ(lamp["description"], "The first one.");
    EXPECT_EQ(lamp["required"], nlohmann::json{"number"});
    EXPECT_EQ(lamp["additionalProperties"], false);
    EXPECT_EQ(lamp["properties"]["power"],
              nlohmann::json::parse(
                  R"({"type": "number", "exclusiveMinimum": 0, "maximum": 1, "default": 0.5})"));
    EXPECT_EQ(lamp["properties"]["range"]["default"], "auto");
    EXPECT_FALSE(lamp["properties"]["number"].contains("default"));
    EXPECT_FALSE(lamp["properties"]["name"].contains("default"));
    EXPECT_EQ(schema["properties"]["more"]["items"]["required"], nlohmann::json{"number"});
    EXPECT_EQ(schema["properties"]["height"]["oneOf"].size(), 2u);
}

}  // namespace
}  // namespace lamina
