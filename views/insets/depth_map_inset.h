// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>

class QPushButton;

namespace trimtab::views {

/// The depth map of the last frame as a picture with a caption, or the reason why there is none.
class DepthMapInset : public QWidget {
  Q_OBJECT
 public:
  explicit DepthMapInset(QWidget* parent = nullptr);

  void setPicture(const QImage& image, const QString& caption);
  void setReason(const QString& why);
  /// Shows a button that leads to where the reason can be changed; an empty text removes it.
  void setLead(const QString& text);

  QSize sizeHint() const override { return {320, 200}; }
  QSize minimumSizeHint() const override { return {160, 90}; }

 signals:
  void leadFollowed();

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  void placeLead();

  QImage image_;
  QString text_;
  QPushButton* lead_;
};

}  // namespace trimtab::views
