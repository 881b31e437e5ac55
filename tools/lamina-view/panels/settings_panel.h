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

// Draws the control of a value that is no group: `value`, from the scene's file, as wide as the
// line. Returns the new value if the user changed it; it may be invalid.
std::optional<nlohmann::ordered_json> setting_control(const SettingNode& node,
                                                      const nlohmann::ordered_json& value,
                                                      ImageColorSpace space);

// Controls for all keys of the scene file (model/scene_keys.h), in the same groups. Keys that have
// no effect in the current scene are grey, with the reason.
class SettingsPanel : public Panel {
  public:
    const char* title() const override { return "Settings"; }
    void draw(PanelContext& context) override;

    // Returns the paths that were drawn last, without indices: tests compare them with the schema.
    const std::set<std::string>& drawn() const { return drawn_; }
    bool all_open = false;  // draws closed groups, too

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

    Json settings_;  // of the scene that is drawn
    std::set<std::string> drawn_;
    ImGuiTextFilter filter_;
    std::string message_path_, message_;  // of the last value that was refused
};

}  // namespace lamina::view
