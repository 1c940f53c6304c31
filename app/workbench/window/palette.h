// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <QString>
#include <functional>
#include <vector>

class QLineEdit;
class QTreeWidget;

namespace trimtab::workbench {

/// One thing that the palette finds.
struct PaletteEntry {
  QString text, kind;
  QString hint;  ///< a shortcut, or where a file is
  std::function<void()> run;
};

/// Finds commands, docks, parameters, presets, terrains and flights by a few letters of their names. It needs
/// no mouse: arrows choose, Enter runs, Escape closes.
class Palette : public QDialog {
  Q_OBJECT

 public:
  using Source = std::function<std::vector<PaletteEntry>()>;

  Palette(Source source, QWidget* parent);
  /// Shows it over the window, empty, with what there is to find now.
  void begin();
  QLineEdit& input() { return *input_; }
  QTreeWidget& list() { return *list_; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void find();
  void runCurrent();

  Source source_;
  std::vector<PaletteEntry> entries_;
  QLineEdit* input_;
  QTreeWidget* list_;
};

}  // namespace trimtab::workbench
