// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <deque>
#include <optional>

namespace trimtab::views {

/// What happened beside the frames that a TraceBuffer holds, on its clock in seconds: stretches in which the
/// host was silent or a trace was recorded, and changes of the decision.
class PlotMarks {
 public:
  enum class Kind { host_silent, recording };
  struct Span {
    Kind kind;
    double from = 0;
    std::optional<double> to;  ///< unset while it lasts
  };
  struct Change {
    double time = 0;
    QString text;
  };
  static constexpr std::size_t kMost = 10'000;  ///< of each; the oldest are dropped

  /// Begins or ends a stretch. Does nothing if it has begun, or ended, already.
  void set(Kind kind, bool on, double time);
  bool lasts(Kind kind) const;
  void addChange(double time, const QString& text);
  void clear();

  const std::deque<Span>& spans() const { return spans_; }
  const std::deque<Change>& changes() const { return changes_; }
  /// Returns the change nearest to a time, if one is within `reach` seconds; else null.
  const Change* changeNear(double time, double reach) const;

 private:
  std::deque<Span> spans_;
  std::deque<Change> changes_;
};

}  // namespace trimtab::views
