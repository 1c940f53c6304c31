// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "policy_draft.h"
#include "policy_live.h"
#include "term_edit.h"
#include "views/editors/point_plot.h"

namespace trimtab::views {

/// The terms of one signal as curves. The characteristic points of the selected term are dragged, nudged and
/// snapped to those of other terms. A mark rides on each curve at the live value, whose last seconds run out
/// below the axis.
class TermPlot : public PointPlot {
  Q_OBJECT
 public:
  TermPlot(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent = nullptr);

  Signal signal() const { return signal_; }
  void setSignal(Signal signal);
  /// Returns the selected term's line in the draft; -1 for none.
  int term() const { return term_; }
  /// Selects a term and one of its points alone.
  void selectTerm(int term, int point = -1);
  /// Returns the points of the selected term.
  std::vector<EditPoint> points() const override;
  void showLive(const PolicyLive& live);
  /// Returns the colour of a term of this signal, by its place among them.
  static QColor colourOf(std::size_t place, const QPalette& palette);

  QSize sizeHint() const override { return {420, 230}; }
  QSize minimumSizeHint() const override { return {160, 130}; }

 public slots:
  void removeSelected() override;
  void copyShape();
  void pasteShape();

 signals:
  void addAsked();        ///< the person wants a new term
  void duplicateAsked();  ///< the person wants a copy of the selected term
  void removeAsked();     ///< the person wants the selected term gone
  void dragged();         ///< a point was moved by mouse or keys

 protected:
  bool editable() const override { return termAt(term_) != nullptr; }
  void hold() override;
  void moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) override;
  void insertAt(double x, double y) override;
  bool removePoints(const std::vector<std::size_t>& gone) override;
  void selectElsewhere(QPointF pixel, bool control) override;
  Qt::CursorShape cursorElsewhere(QPointF pixel) const override;
  std::optional<double> snapped(double x) const override;
  double keyStep() const override { return nudgeStep(view()) / 10; }
  QString readoutOf(double x, int point) const override;
  QString describe() const override;
  Range wholeView() const override { return viewOf(signal_, policy_.policy().terms); }
  void addToMenu(QMenu& menu) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void restyle() override;
  void redraw() override;

 private:
  /// The graphs and items of the plot.
  struct Parts {
    QList<QCPGraph*> curves, marks;
    QCPCurve* trail = nullptr;
    QCPItemStraightLine *live = nullptr, *limits[2] = {nullptr, nullptr};
    QCPItemText* empty = nullptr;
  };

  void makeItems();
  void drawCurves();
  void readGhosts();
  void drawGhosts(const QVector<double>& at);
  void placeLive();
  void drawTrail();
  const PolicyTerm* termAt(int line) const;
  bool hasPoints() const;
  int curveAt(QPointF pixel) const;
  std::vector<double> othersX() const;
  void put(const PolicyTerm& term, const QString& undoText, MergeToken token = 0);
  void snapTo(int side);
  void stepTerm(int by);

  PolicyDraft& policy_;
  const PolicyTrack& track_;
  Signal signal_ = Signal::altitude;
  int term_ = -1;
  PolicyTerm heldTerm_;
  double value_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t drawnTrack_ = 0;
  /// The sound terms of all signals, in the order of kGhosts.
  std::array<std::vector<PolicyTerm>, 2> ghostTerms_;
  Parts parts_;
};

}  // namespace trimtab::views
