// SPDX-License-Identifier: GPL-3.0-or-later
#include "gl_setup.h"

#include <QApplication>
#include <QIcon>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QSurfaceFormat>

namespace trimtab::workbench {

void prepareGl() {
  // The viewport has a window of its own; the docks beside it need none.
  QCoreApplication::setAttribute(Qt::AA_DontCreateNativeWidgetSiblings);
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(4, 5);
  format.setProfile(QSurfaceFormat::CompatibilityProfile);
  // Without this Qt asks for a forward-compatible context, in which every shader of a GL2 build fails.
  format.setOption(QSurfaceFormat::DeprecatedFunctions);
  format.setSwapInterval(1);
  QSurfaceFormat::setDefaultFormat(format);
}

QString checkGl() {
  QOffscreenSurface surface;
  surface.create();
  const auto usable = [&surface] {
    QOpenGLContext context;
    return context.create() && context.makeCurrent(&surface);
  };
  if (usable()) return {};
  // A driver without 4.5 compatibility may still give the highest it has.
  QSurfaceFormat format = QSurfaceFormat::defaultFormat();
  format.setVersion(2, 1);
  QSurfaceFormat::setDefaultFormat(format);
  return usable() ? QString() : QObject::tr("no OpenGL context can be made");
}

void nameApplication() {
  QCoreApplication::setOrganizationName(QStringLiteral("Trimtab"));
  QCoreApplication::setApplicationName(QStringLiteral("trimtab"));
  QCoreApplication::setApplicationVersion(QStringLiteral(TRIMTAB_VERSION));
  // A caret that blinks is painted twice a second: idle must cost nothing.
  QApplication::setCursorFlashTime(0);
  QGuiApplication::setWindowIcon(QIcon(QStringLiteral(":/trimtab/icons/trimtab.png")));
}

}  // namespace trimtab::workbench
