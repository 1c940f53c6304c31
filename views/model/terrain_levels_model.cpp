// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain_levels_model.h"

#include <QFont>
#include <cmath>

#include "theme.h"

namespace trimtab::views {
namespace {

QString count(std::uint64_t n) {
  return numberText(static_cast<double>(n), 0);
}

/// Three digits are enough to compare levels by.
QString metres(double value) {
  if (!std::isfinite(value)) return QStringLiteral("–");
  return numberText(value, value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3);
}

}  // namespace

void TerrainLevelsModel::setLevels(std::vector<TerrainLevel> levels, bool finestFirst) {
  levels_ = std::move(levels);
  finestFirst_ = finestFirst;
  drawn_ = {};
  refreshRows(static_cast<int>(levels_.size()));
}

void TerrainLevelsModel::setDrawn(const LevelsFrame& drawn) {
  if (drawn.nodes == drawn_.nodes && drawn.triangles == drawn_.triangles) return;
  drawn_ = drawn;
  if (rows() > 0) emit dataChanged(index(0, kDrawn), index(rows() - 1, kDrawn));
}

QString TerrainLevelsModel::text(const TerrainLevel& level, std::size_t number, int column) const {
  switch (column) {
    case kLevel: {
      const bool finest = number == (finestFirst_ ? 0 : levels_.size() - 1),
                 coarsest = number == (finestFirst_ ? levels_.size() - 1 : 0);
      return QString::number(number) + (finest ? tr(", finest") : coarsest ? tr(", coarsest") : QString());
    }
    case kNodes:
      return count(level.nodes);
    case kTriangles:
      return count(level.triangles);
    case kMaxError:
      return metres(level.maxErrorM);
    case kRmsError:
      return metres(level.rmsErrorM);
    case kSurfaceError:
      return metres(level.surfaceErrorM);
    case kSize:
      return level.bytes > 0
                 ? numberText(static_cast<double>(level.bytes) * 1e-3, level.bytes < 100'000 ? 1 : 0)
                 : QStringLiteral("–");
    default:
      return number < LevelsFrame::kLevels && drawn_.nodes[number] > 0
                 ? tr("%1 (%2)").arg(count(drawn_.nodes[number]), count(drawn_.triangles[number]))
                 : QStringLiteral("–");
  }
}

QVariant TerrainLevelsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const auto number = static_cast<std::size_t>(index.row());
  if (number >= levels_.size()) return {};
  if (role == Qt::DisplayRole) return text(levels_[number], number, index.column());
  if (role == Qt::TextAlignmentRole)
    return QVariant::fromValue(Qt::AlignVCenter |
                               (index.column() == kLevel ? Qt::AlignLeft : Qt::AlignRight));
  if (role == Qt::FontRole && number < LevelsFrame::kLevels && drawn_.nodes[number] > 0) {
    QFont bold;
    bold.setBold(true);
    return bold;
  }
  return {};
}

QVariant TerrainLevelsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  struct Heading {
    const char *text, *tip;
  };
  static constexpr Heading kHeadings[kColumns] = {
      {QT_TR_NOOP("Level"), QT_TR_NOOP("As colour by level shows them")},
      {QT_TR_NOOP("Nodes"), QT_TR_NOOP("Tiles or patches of the level")},
      {QT_TR_NOOP("Triangles"), QT_TR_NOOP("Of the whole level, each node by its finest mesh")},
      {QT_TR_NOOP("Max (m)"),
       QT_TR_NOOP("Largest vertical distance from the source at its posts: guaranteed, and never less than a "
                  "finer level's")},
      {QT_TR_NOOP("RMS (m)"), QT_TR_NOOP("Root mean square of the vertical distance, over all posts of "
                                         "the level")},
      {QT_TR_NOOP("Surface (m)"),
       QT_TR_NOOP("Largest vertical distance from the bilinear surface between the posts, measured")},
      {QT_TR_NOOP("kB"), QT_TR_NOOP("On disk; – where meshes are made when they are drawn")},
      {QT_TR_NOOP("Drawn now"), QT_TR_NOOP("Nodes in the image, and their triangles")}};
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumns) return {};
  if (role == Qt::DisplayRole) return tr(kHeadings[section].text);
  if (role == Qt::ToolTipRole) return tr(kHeadings[section].tip);
  return {};
}

}  // namespace trimtab::views
