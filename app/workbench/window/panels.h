// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace trimtab::views {
class BandsEditor;
class BudgetPanel;
class CullingPanel;
class Draft;
class MotionPanel;
class ParameterTable;
class PlotsPanel;
class PolicyPanel;
class StaticLodPanel;
class SymbologyPanel;
class TerrainPanel;
class WeatherPanel;
}  // namespace trimtab::views

namespace trimtab::workbench {

class ChangesDock;
class DockLayout;
class Feed;
class FitPage;
class FlightDock;
class HostDock;
class LeveragePage;
class MessagePanel;
class SearchPage;
class ViewPause;
struct Controllers;

/// The contents of those docks that the window and its controllers use. The docks own them.
struct Panels {
  views::PolicyPanel* policy = nullptr;
  views::BandsEditor* bands = nullptr;
  views::CullingPanel* culling = nullptr;
  views::TerrainPanel* terrain = nullptr;
  views::StaticLodPanel* staticLod = nullptr;
  views::WeatherPanel* weather = nullptr;
  views::SymbologyPanel* symbology = nullptr;
  views::MotionPanel* motion = nullptr;
  views::BudgetPanel* budget = nullptr;
  views::ParameterTable* parameters = nullptr;
  HostDock* host = nullptr;
  FlightDock* flight = nullptr;
  views::PlotsPanel* plots = nullptr;
  MessagePanel* messages = nullptr;
  ChangesDock* changes = nullptr;
  // Made once there are controllers, which they need.
  LeveragePage* leverage = nullptr;
  SearchPage* search = nullptr;
  FitPage* fit = nullptr;
};

/// Makes every dock but Run time against error and every page but Leverage, Find and Fit, which need
/// controllers.
Panels makePanels(DockLayout& docks, views::Draft& draft, Feed& feed);
/// Adds the three pages that run programs over what the window shows, once their docks are there. The view
/// pauses meanwhile.
void addRunPages(DockLayout& docks, Panels& panels, const Controllers& by, views::Draft& draft,
                 ViewPause& pause);

}  // namespace trimtab::workbench
