// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QCheckBox;
class QLabel;
class QPushButton;

namespace trimtab::views {

/// The page Symbology: which symbols of the helmet display are shown, with colour, place and size, and the
/// switch for placing them in the image with the mouse.
class SymbologyPanel : public QWidget {
  Q_OBJECT
 public:
  static constexpr int kSymbols = 8;
  /// Returns "symbology.pitch_ladder" and so on, in the order of the rows and of Symbol.
  static const std::array<std::string_view, kSymbols> kPrefixes;

  explicit SymbologyPanel(Draft& draft, QWidget* parent = nullptr);
  void showFrame(const LiveFrame& frame);

  QPushButton& placeButton() { return *place_; }
  QCheckBox& showBox(int symbol) { return *show_[static_cast<std::size_t>(symbol)]; }

 public slots:
  /// Marks a row; -1 for none.
  void setSelected(int symbol);

 signals:
  void placingChanged(bool on);
  void selected(int symbol);

 private:
  void readFlags();
  bool eventFilter(QObject* watched, QEvent* event) override;

  Draft& draft_;
  QCheckBox* enabled_;
  QCheckBox* recolour_;
  QPushButton* place_;
  QLabel* counts_;
  QWidget* table_;
  std::array<QCheckBox*, kSymbols> show_{};
  LiveFrame frame_;
  Throttle throttle_;
};

}  // namespace trimtab::views
