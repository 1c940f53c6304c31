// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>
#include <array>

namespace trimtab::workbench {

/// Shows two images of one view: either as one image with a divider that a person drags or moves by keys, or
/// side by side.
class SplitPicture : public QWidget {
  Q_OBJECT

 public:
  explicit SplitPicture(QWidget* parent = nullptr);

  void show(const QImage& left, const QImage& right);
  void setNames(const QString& left, const QString& right);
  void setBeside(bool beside);
  const QImage& picture(int side) const { return pictures_[std::size_t(side)]; }
  /// The share of the width that shows the left image.
  double divider() const { return divider_; }
  void setDivider(double share);

  QSize sizeHint() const override { return {640, 400}; }
  QSize minimumSizeHint() const override { return {240, 140}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  QRect pictureRect() const;
  void describe();

  std::array<QImage, 2> pictures_;
  std::array<QString, 2> names_;
  double divider_ = 0.5;
  bool beside_ = false;
};

}  // namespace trimtab::workbench
