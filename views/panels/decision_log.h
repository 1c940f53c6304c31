// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractTableModel>
#include <QString>
#include <deque>
#include <optional>

#include "trimtab/frame/frame.h"

namespace trimtab::views {

/// Reports whether `now` is another decision than `before`: another scheme, band, depth map size or LOD
/// scale, or input that becomes invalid. Being held by hysteresis is none.
bool isDecisionChange(const FrameDecision& before, const FrameDecision& now);
/// Returns what has changed, in a few words.
QString changeText(const FrameDecision& before, const FrameDecision& now);

/// Records every change of the decision with its time and reason, the newest last; the oldest are dropped
/// beyond a limit.
class DecisionLog : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kTime, kPacket, kScheme, kDepthMap, kReason, kColumns };
  static constexpr int kCapacity = 10000;

  using QAbstractTableModel::QAbstractTableModel;

  /// Reports whether `decision` is a change, so that a reason need be made for `append` only then.
  bool isChange(const FrameDecision& decision) const;
  void append(double time, std::uint64_t packet, const FrameDecision& decision, const QString& reason);
  void clear();
  std::uint64_t forgotten() const { return forgotten_; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

  /// Returns rows as text in the C locale with a header line, separated by tabs (for the clipboard) or as
  /// CSV.
  QString toText(const QList<int>& rows) const;
  QString toCsv() const;

 private:
  struct Entry {
    double time = 0;
    std::uint64_t packet = 0;
    Scheme scheme = Scheme::frustum;
    std::optional<OcclusionResolution> resolution;
    QString reason;
  };
  QStringList cells(const Entry& entry) const;

  std::deque<Entry> entries_;
  std::optional<FrameDecision> last_;
  std::uint64_t forgotten_ = 0;
};

}  // namespace trimtab::views
