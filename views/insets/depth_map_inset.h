// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>

namespace trimtab::views {

/// The depth map of the last frame as an image with a caption, or the reason why there is none.
class DepthMapInset : public QWidget {
  Q_OBJECT
 public:
  explicit DepthMapInset(QWidget* parent = nullptr);

  void setImage(const QImage& image, const QString& caption);
  void setReason(const QString& why);

  QSize sizeHint() const override { return {320, 200}; }
  QSize minimumSizeHint() const override { return {160, 90}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QImage image_;
  QString text_;
};

}  // namespace trimtab::views
