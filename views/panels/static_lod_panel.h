// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <cstdint>
#include <optional>
#include <vector>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QCheckBox;
class QLabel;
class QSlider;

namespace trimtab::views {

class BarList;

/// What the dock shows about a terrain's static trees.
struct StaticLodSummary {
  std::uint32_t trianglesPerNode = 0, levels = 0;
  std::size_t tiles = 0, nodes = 0;
  std::uint64_t sourceTriangles = 0, faces = 0, distinctFaces = 0, lockedMinima = 0, bytes = 0;
  std::vector<std::uint64_t> facesOfLevel;  ///< from the root
};

/// The published figures of document E's example.
struct PublishedStaticLod {
  std::uint64_t triangles = 30987, trianglesPerNode = 2000, levels = 4, faces = 126520;
};

/// The page Static LOD: the trees, what of them is drawn now, and document E's picture with its levels.
class StaticLodPanel : public QWidget {
  Q_OBJECT
 public:
  explicit StaticLodPanel(Draft& draft, QWidget* parent = nullptr);

  /// Shows the trees of a terrain. If it has none, the dock says how to get some.
  void setTrees(std::optional<StaticLodSummary> trees);
  void showFrame(const LiveFrame& frame);

  /// Returns the level that is drawn by itself, 0 at the roots; -1 if each node is drawn by its distance.
  int depth() const;
  bool picture() const;

 signals:
  void overlayChanged(int depth, bool picture);

 private:
  void refresh();
  void announce();
  void sayLevel();

  QLabel *state_, *table_, *level_;
  QWidget* body_;
  BarList* drawn_;
  QCheckBox *single_, *picture_;
  QSlider* slider_;
  std::optional<StaticLodSummary> trees_;
  LiveFrame frame_;
  Throttle throttle_;
};

}  // namespace trimtab::views
