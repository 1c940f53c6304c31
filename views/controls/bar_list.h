// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QString>
#include <QWidget>
#include <vector>

namespace trimtab::views {

/// Shows named values as horizontal bars, one per line.
class BarList : public QWidget {
  Q_OBJECT
 public:
  struct Bar {
    QString name;
    double value = 0;
    double top = 1;
    QString text;                    ///< beside the bar
    std::vector<double> ticks = {};  ///< marks, such as band edges
    int colour = 0;                  ///< index for seriesColour
    bool quiet = false;              ///< drawn grey: computed, but not in use
    QColor given = {};               ///< a colour that means the same elsewhere; if valid, it is used instead
    friend bool operator==(const Bar&, const Bar&) = default;
  };

  explicit BarList(QWidget* parent = nullptr);
  void setBars(std::vector<Bar> bars);

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int lineHeight() const;
  int nameWidth() const;
  int textWidth() const;

  std::vector<Bar> bars_;
};

}  // namespace trimtab::views
