// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "lamina/image.h"
#include "model/scene_keys.h"
#include "panels/panel.h"

namespace lamina::view {

// The control of a value that is no group: shows `value` (of the scene's file) at the cursor, as
// wide as the line. Returns another value if the user gave one; the scene's reader judges it.
std::optional<nlohmann::ordered_json> setting_control(const SettingNode& node,
                                                      const nlohmann::ordered_json& value,
                                                      ImageColorSpace space);

// A control for every key of the scene file (model/scene_keys.h), grouped as there. Keys that
// change nothing in the current scene are grey, with the reason.
class SettingsPanel : public Panel {
  public:
    const char* title() const override { return "Settings"; }
    void draw(PanelContext& context) override;

    // The paths that were drawn last, without numbers: tests compare them with the schema.
    const std::set<std::string>& drawn() const { return drawn_; }
    bool all_open = false;  // groups that are closed otherwise are drawn too

  private:
    using Json = nlohmann::ordered_json;

    void draw_parts(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_node(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_leaf(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_group(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_list(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_either(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_transfer_function(const SettingNode& node);
    bool draw_switch(const SettingNode& node, const std::string& path, PanelContext& context);
    void draw_label(const SettingNode& node, const std::string& reason);
    bool passes(const SettingNode& node) const;
    Json value_at(const std::string& path) const;
    Json start_of(const SettingNode& node, const std::string& path, PanelContext& context) const;
    void set(const std::string& path, const Json& value, PanelContext& context);

    Json settings_;  // of the scene as it is drawn
    std::set<std::string> drawn_;
    ImGuiTextFilter filter_;
    std::string message_path_, message_;  // of the value that was refused last
};

}  // namespace lamina::view
