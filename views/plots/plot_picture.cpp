// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot_picture.h"

#include <qcustomplot.h>

#include <QBuffer>
#include <QFileInfo>
#include <QList>
#include <QPaintEngine>
#include <QPixmap>
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "trimtab/preset/preset.h"

namespace trimtab::views {
namespace {

constexpr double kPngScale = 2;

QByteArray number(double value) {
  return QByteArray::number(value, 'f', 2);
}

QByteArray colourText(const QColor& colour, const char* what) {
  QByteArray text = QByteArray(" ") + what + "=\"" + colour.name().toLatin1() + '"';
  if (colour.alpha() < 255) text += QByteArray(" ") + what + "-opacity=\"" + number(colour.alphaF()) + '"';
  return text;
}

/// Writes what a QPainter draws as elements of SVG. Clips are rectangles, which is all that plots use.
class SvgEngine : public QPaintEngine {
 public:
  SvgEngine() : QPaintEngine(AllFeatures) {}
  QByteArray body;

  bool begin(QPaintDevice*) override { return true; }
  bool end() override {
    flush();
    return true;
  }
  Type type() const override { return User; }
  void drawPixmap(const QRectF&, const QPixmap&, const QRectF&) override {}

  void updateState(const QPaintEngineState& now) override {
    flush();
    if (now.state() & DirtyPen) pen_ = now.pen();
    if (now.state() & DirtyBrush) brush_ = now.brush();
    if (now.state() & DirtyTransform) transform_ = now.transform();
    if (now.state() & DirtyClipRegion) clip(QRectF(now.clipRegion().boundingRect()), now.clipOperation());
    if (now.state() & DirtyClipPath) clip(now.clipPath().boundingRect(), now.clipOperation());
  }

  void drawPath(const QPainterPath& path) override {
    flush();
    QByteArray d;
    for (int i = 0; i < path.elementCount(); ++i) {
      const QPainterPath::Element e = path.elementAt(i);
      d += e.type == QPainterPath::MoveToElement    ? "M"
           : e.type == QPainterPath::LineToElement  ? "L"
           : e.type == QPainterPath::CurveToElement ? "C"
                                                    : " ";
      d += number(e.x) + ' ' + number(e.y);
    }
    add("path d=\"" + d + '"', brush_);
  }

  void drawPolygon(const QPointF* points, int count, PolygonDrawMode mode) override {
    const bool open = mode == PolylineMode;
    // Fast polylines come segment by segment: one element for all that hang together.
    if (open && count == 2) {
      if (line_.isEmpty() || line_.back() != points[0]) {
        flush();
        line_ << points[0];
      }
      line_ << points[1];
      return;
    }
    flush();
    addPoints(points, count, open);
  }

  void drawTextItem(const QPointF& at, const QTextItem& item) override {
    flush();
    const QFont font = item.font();
    const double size = font.pixelSize() > 0 ? font.pixelSize() : font.pointSizeF() * 96 / 72;
    QByteArray text = "text x=\"" + number(at.x()) + "\" y=\"" + number(at.y()) + "\" font-size=\"" +
                      number(size) + "\" font-family=\"" + font.family().toHtmlEscaped().toUtf8() +
                      ", sans-serif\"";
    if (font.bold()) text += " font-weight=\"bold\"";
    write(text + colourText(pen_.color(), "fill"), item.text().toHtmlEscaped().toUtf8());
  }

 private:
  void flush() {
    const QList<QPointF> line = std::exchange(line_, {});
    if (!line.isEmpty()) addPoints(line.constData(), int(line.size()), true);
  }

  void addPoints(const QPointF* points, int count, bool open) {
    QByteArray at;
    for (int i = 0; i < count; ++i) at += number(points[i].x()) + ',' + number(points[i].y()) + ' ';
    add((open ? "polyline points=\"" : "polygon points=\"") + at.trimmed() + '"', open ? QBrush() : brush_);
  }

  void clip(const QRectF& rect, Qt::ClipOperation how) {
    const QRectF onDevice = transform_.mapRect(rect);
    if (how == Qt::NoClip)
      clip_ = {};
    else if (how == Qt::IntersectClip && clip_)
      clip_ = clip_->intersected(onDevice);
    else
      clip_ = onDevice;
  }

  void add(const QByteArray& shape, const QBrush& fill) {
    QByteArray look =
        fill.style() == Qt::NoBrush ? QByteArray(" fill=\"none\"") : colourText(fill.color(), "fill");
    if (pen_.style() != Qt::NoPen) {
      const double width = std::max(pen_.widthF(), 1.0);
      look += colourText(pen_.color(), "stroke") + " stroke-width=\"" + number(width) + '"';
      QByteArray dashes;
      for (const qreal dash : pen_.dashPattern()) dashes += number(dash * width) + ' ';
      if (!dashes.isEmpty()) look += " stroke-dasharray=\"" + dashes.trimmed() + '"';
    }
    write(shape + look, {});
  }

  void write(const QByteArray& element, const QByteArray& content) {
    QByteArray moved;
    if (!transform_.isIdentity())
      moved = " transform=\"matrix(" + number(transform_.m11()) + ' ' + number(transform_.m12()) + ' ' +
              number(transform_.m21()) + ' ' + number(transform_.m22()) + ' ' + number(transform_.dx()) +
              ' ' + number(transform_.dy()) + ")\"";
    const QByteArray name = element.left(element.indexOf(' '));
    const QByteArray drawn =
        '<' + element + moved + (content.isEmpty() ? QByteArray("/>") : '>' + content + "</" + name + '>');
    if (!clip_) {
      body += drawn + '\n';
      return;
    }
    // A group, because the clip is not moved by the transform of what it clips.
    if (clip_ != clipWritten_) {
      clipWritten_ = clip_;
      body += "<clipPath id=\"c" + QByteArray::number(++clips_) + "\"><rect x=\"" + number(clip_->x()) +
              "\" y=\"" + number(clip_->y()) + "\" width=\"" + number(clip_->width()) + "\" height=\"" +
              number(clip_->height()) + "\"/></clipPath>";
    }
    body += "<g clip-path=\"url(#c" + QByteArray::number(clips_) + ")\">" + drawn + "</g>\n";
  }

  QPen pen_;
  QBrush brush_;
  QTransform transform_;
  std::optional<QRectF> clip_, clipWritten_;
  QList<QPointF> line_;  ///< of segments that hang together, not yet written
  int clips_ = 0;
};

class SvgDevice : public QPaintDevice {
 public:
  explicit SvgDevice(const QSize& size) : size_(size) {}
  SvgEngine engine;
  QPaintEngine* paintEngine() const override { return const_cast<SvgEngine*>(&engine); }

 protected:
  int metric(PaintDeviceMetric what) const override {
    switch (what) {
      case PdmWidth:
        return size_.width();
      case PdmHeight:
        return size_.height();
      case PdmDpiX:
      case PdmDpiY:
      case PdmPhysicalDpiX:
      case PdmPhysicalDpiY:
        return 96;
      case PdmDevicePixelRatio:
        return 1;
      case PdmDevicePixelRatioScaled:
        return int(devicePixelRatioFScale());
      default:
        return QPaintDevice::metric(what);
    }
  }

 private:
  QSize size_;
};

}  // namespace

QByteArray svgOf(QCustomPlot& plot) {
  SvgDevice device(plot.size());
  {
    QCPPainter painter(&device);
    plot.toPainter(&painter, plot.width(), plot.height());
  }
  const QByteArray width = QByteArray::number(plot.width()), height = QByteArray::number(plot.height());
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + ' ' + height + "\">\n" + device.engine.body + "</svg>\n";
}

namespace {

Findings write(const QByteArray& bytes, const QString& file) {
  return writeAtomically(file.toStdString(), std::string_view(bytes.constData(), std::size_t(bytes.size())))
      .findings();
}

}  // namespace

Findings writePicture(QCustomPlot& plot, const QString& file) {
  if (file.endsWith(QLatin1String(".svg"), Qt::CaseInsensitive)) return write(svgOf(plot), file);
  return writePixmap(plot.toPixmap(0, 0, kPngScale), file);
}

Findings writePixmap(const QPixmap& picture, const QString& file) {
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  const QByteArray ending = QFileInfo(file).suffix().toUpper().toLatin1();
  if (!picture.save(&buffer, ending.isEmpty() ? "PNG" : ending.constData()))
    return {
        {Severity::error, file.toStdString(), {}, "a name that ends in .png or .jpg", ending.toStdString()}};
  return write(bytes, file);
}

}  // namespace trimtab::views
