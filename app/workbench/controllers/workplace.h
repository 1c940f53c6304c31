// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QWidget;

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

class Feed;
class MessagePanel;
class ViewPause;
class Viewport;

/// What every controller works with. The window owns all of it, and it outlives the controllers.
struct Workplace {
  views::Draft& draft;     ///< the parameters that are being edited
  Feed& feed;              ///< who moves the aircraft, and the session that decides
  Viewport& viewport;      ///< draws the terrain
  ViewPause& pause;        ///< stops the viewport while something measures times
  MessagePanel& messages;  ///< reports what went wrong
  QWidget& window;         ///< the parent of dialogs
};

}  // namespace trimtab::workbench
