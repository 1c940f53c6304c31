// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision_log.h"

#include <QStringList>

namespace trimtab::views {

namespace {

QString sizeText(const std::optional<OcclusionResolution>& size) {
  return size ? QStringLiteral("%1x%2").arg(size->widthPx).arg(size->heightPx) : QStringLiteral("none");
}

bool isInputAtFault(SchemeReason reason) {
  return reason == SchemeReason::invalid_input || reason == SchemeReason::altitude_unknown;
}

}  // namespace

bool isDecisionChange(const FrameDecision& before, const FrameDecision& now) {
  const bool faults = isInputAtFault(now.reason) || isInputAtFault(before.reason);
  return now.scheme != before.scheme || now.band != before.band ||
         now.occlusionResolution != before.occlusionResolution ||
         now.motion.lodScale != before.motion.lodScale || (faults && now.reason != before.reason);
}

QString changeText(const FrameDecision& before, const FrameDecision& now) {
  QStringList said;
  const auto schemeText = [](const FrameDecision& d) {
    return d.scheme == Scheme::dynamic ? sizeText(d.occlusionResolution) : QStringLiteral("frustum");
  };
  if (schemeText(before) != schemeText(now))
    said << QStringLiteral("%1 → %2").arg(schemeText(before), schemeText(now));
  else if (before.band != now.band)
    said << DecisionLog::tr("band %1").arg(now.band + 1);
  if (before.motion.lodScale != now.motion.lodScale)
    said << DecisionLog::tr("LOD scale of head motion %1 → %2")
                .arg(before.motion.lodScale)
                .arg(now.motion.lodScale);
  if (said.isEmpty()) said << DecisionLog::tr("input at fault, or no longer");
  return said.join(QStringLiteral(", "));
}

bool DecisionLog::isChange(const FrameDecision& d) const {
  return !last_ || isDecisionChange(*last_, d);
}

void DecisionLog::append(double time, std::uint64_t packet, const FrameDecision& decision,
                         const QString& reason) {
  if (static_cast<int>(entries_.size()) >= kCapacity) {
    // Many at once, so that a view does not move its rows with every line.
    constexpr int kAtOnce = kCapacity / 10;
    beginRemoveRows({}, 0, kAtOnce - 1);
    entries_.erase(entries_.begin(), entries_.begin() + kAtOnce);
    forgotten_ += kAtOnce;
    endRemoveRows();
  }
  const int row = static_cast<int>(entries_.size());
  beginInsertRows({}, row, row);
  entries_.push_back({time, packet, decision.scheme, decision.occlusionResolution, reason});
  last_ = decision;
  endInsertRows();
}

void DecisionLog::clear() {
  beginResetModel();
  entries_.clear();
  forgotten_ = 0;
  endResetModel();
}

int DecisionLog::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(entries_.size());
}

QStringList DecisionLog::cells(const Entry& e) const {
  return {QString::number(e.time, 'f', 3), QString::number(e.packet),
          e.scheme == Scheme::dynamic ? QStringLiteral("dynamic") : QStringLiteral("frustum"),
          sizeText(e.resolution), e.reason};
}

QVariant DecisionLog::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  if (role == Qt::DisplayRole || (role == Qt::ToolTipRole && index.column() == kReason))
    return cells(entries_[static_cast<std::size_t>(index.row())]).at(index.column());
  if (role == Qt::TextAlignmentRole)
    return QVariant((index.column() <= kPacket ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
  return {};
}

QVariant DecisionLog::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role == Qt::TextAlignmentRole && section == kReason) return QVariant(Qt::AlignLeft | Qt::AlignVCenter);
  if (role != Qt::DisplayRole || orientation != Qt::Horizontal) return {};
  const QStringList titles{tr("Time (s)"), tr("Packet"), tr("Scheme"), tr("Depth map"), tr("Reason")};
  return titles.at(section);
}

QString DecisionLog::toText(const QList<int>& rows) const {
  QString text = QStringLiteral("time_s\tpacket\tscheme\tdepth_map_px\treason\n");
  for (const int row : rows)
    if (row >= 0 && row < rowCount())
      text += cells(entries_[static_cast<std::size_t>(row)]).join(QLatin1Char('\t')) + QLatin1Char('\n');
  return text;
}

QString DecisionLog::toCsv() const {
  QString text = QStringLiteral("time_s,packet,scheme,depth_map_px,reason\n");
  for (const Entry& entry : entries_) {
    QStringList row = cells(entry);
    row.last() =
        QLatin1Char('"') + row.last().replace(QLatin1Char('"'), QStringLiteral("\"\"")) + QLatin1Char('"');
    text += row.join(QLatin1Char(',')) + QLatin1Char('\n');
  }
  return text;
}

}  // namespace trimtab::views
