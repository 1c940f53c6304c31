// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QPoint>
#include <QWidget>
#include <array>
#include <optional>
#include <vector>

namespace trimtab::workbench {

/// Two images of one view and how they differ.
struct ComparedImages {
  std::array<QImage, 2> images;
  QImage map;               ///< the differences in colours
  std::vector<float> flip;  ///< each pixel's FLIP, 0..1; row 0 is the lowest
};

/// Shows two images of one view: as one image with a divider that a person drags or moves by keys, side by
/// side, one alone, or as the map of their differences. Under the pointer it names the pixel and the values
/// of both. Over the viewport it lets through whatever it does not use, so that the view below still turns.
class SplitPicture : public QWidget {
  Q_OBJECT

 public:
  enum class Form { divided, beside, left, right, difference };

  explicit SplitPicture(QWidget* parent = nullptr);

  /// Makes it lie over its parent, a GlWidget, as large as that. While it has no image to show, only its text
  /// covers the parent.
  void layOverParent();
  void show(ComparedImages compared);
  /// Over a parent, old images are not shown: the live view below them is, with `text` at its edge.
  void setOld(bool old, const QString& text);
  bool old() const { return old_; }
  void setNames(const QString& left, const QString& right);
  void setForm(Form form);
  Form form() const { return form_; }
  const QImage& picture(int side) const { return compared_.images[std::size_t(side)]; }
  /// The share of the width that shows the left image.
  double divider() const { return divider_; }
  void setDivider(double share);
  /// Returns what the images have at this place of the widget: the pixel, both colours and their FLIP. Empty
  /// outside of the images.
  QString valuesAt(QPointF place) const;

  QSize sizeHint() const override { return {640, 400}; }
  QSize minimumSizeHint() const override { return {240, 140}; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  /// An image as it is painted: which one, where all of it would lie, and the part of that which shows.
  struct Part {
    const QImage* image;
    QRect whole, seen;
    QString name;
  };
  std::vector<Part> parts() const;
  QRect pictureRect(const QRect& within) const;
  int dividerX() const;
  void cover();
  bool seesThrough() const { return over_ && (old_ || empty()); }
  bool empty() const { return compared_.images[0].isNull() || compared_.images[1].isNull(); }
  bool nearDivider(QPointF place) const;
  std::optional<QPoint> pixelAt(QPointF place) const;
  QString pointerText() const;
  void paintDivider(QPainter& painter) const;
  QRect plateRect(const QString& text, Qt::Corner corner, const QRect& within) const;
  void paintPlate(QPainter& painter, const QString& text, Qt::Corner corner, const QRect& within) const;
  void describe();

  ComparedImages compared_;
  std::array<QString, 2> names_;
  QString oldText_;
  double divider_ = 0.5;
  Form form_ = Form::divided;
  bool over_ = false, old_ = false, dragging_ = false;
  std::optional<QPointF> pointer_;
};

}  // namespace trimtab::workbench
