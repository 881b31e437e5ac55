// SPDX-License-Identifier: Apache-2.0
#include "panels/panel.h"
#include "panels/picture_panels.h"
#include "panels/precision_panels.h"
#include "panels/settings_panel.h"
#include "panels/transfer_panel.h"

namespace lamina::view {

std::vector<std::unique_ptr<Panel>> make_panels() {
    std::vector<std::unique_ptr<Panel>> panels;
    panels.push_back(std::make_unique<PicturePanel>());
    panels.push_back(std::make_unique<PlanPanel>());
    panels.push_back(std::make_unique<ErrorPanel>());
    panels.push_back(std::make_unique<ComparisonPanel>());
    panels.push_back(std::make_unique<FactorsPanel>());
    panels.push_back(std::make_unique<SettingsPanel>());
    panels.push_back(std::make_unique<TransferPanel>());
    panels.push_back(std::make_unique<AttemptsPanel>());
    panels.push_back(std::make_unique<FramesPanel>());
    return panels;
}

}  // namespace lamina::view
