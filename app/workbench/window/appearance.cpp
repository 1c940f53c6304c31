// SPDX-License-Identifier: GPL-3.0-or-later
#include "appearance.h"

#include <QActionGroup>
#include <QApplication>
#include <QMenu>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QSettings>
#include <QStyleFactory>
#include <QStyleOption>
#include <QToolTip>
#include <array>
#include <utility>

namespace trimtab::workbench {
namespace {

const QString kKey = QStringLiteral("window/appearance");

struct Colours {
  QRgb window, base, alternate, text, button, quiet, highlight, highlighted, link, tip, tipText;
};
constexpr Colours kLight{0xffefefef, 0xffffffff, 0xfff5f5f5, 0xff000000, 0xffefefef, 0xff787878,
                         0xff2f7fd0, 0xffffffff, 0xff0057ae, 0xffffffdc, 0xff000000};
constexpr Colours kDark{0xff2b2b2e, 0xff1e1e20, 0xff262629, 0xffe6e6e6, 0xff38383c, 0xff8c8c90,
                        0xff2a6db0, 0xffffffff, 0xff6cb2f5, 0xff3c3c40, 0xffe6e6e6};

QPalette paletteOf(const Colours& c) {
  QPalette palette(QColor::fromRgb(c.button), QColor::fromRgb(c.window));
  for (const auto& [role, colour] : {std::pair{QPalette::Window, c.window},
                                     {QPalette::Base, c.base},
                                     {QPalette::AlternateBase, c.alternate},
                                     {QPalette::WindowText, c.text},
                                     {QPalette::Text, c.text},
                                     {QPalette::ButtonText, c.text},
                                     {QPalette::Button, c.button},
                                     {QPalette::PlaceholderText, c.quiet},
                                     {QPalette::Highlight, c.highlight},
                                     {QPalette::HighlightedText, c.highlighted},
                                     {QPalette::Link, c.link},
                                     {QPalette::ToolTipBase, c.tip},
                                     {QPalette::ToolTipText, c.tipText}})
    palette.setColor(role, QColor::fromRgb(colour));
  for (const QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, QColor::fromRgb(c.quiet));
  return palette;
}

/// Fusion outlines boxes with a colour darker than the window, which nobody sees on a dark one: this style
/// outlines them with a part of the text's colour.
class SeenBoxes : public QProxyStyle {
 public:
  SeenBoxes() : QProxyStyle(QStringLiteral("fusion")) {}
  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    const bool round = element == PE_IndicatorRadioButton;
    if (!round && element != PE_IndicatorCheckBox && element != PE_IndicatorItemViewItemCheck) return;
    const auto group = (option->state & State_Enabled) ? QPalette::Active : QPalette::Disabled;
    QColor outline = option->palette.color(group, QPalette::Text);
    outline.setAlphaF(0.6F);
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing, round);
    painter->setPen(outline);
    painter->setBrush(Qt::NoBrush);
    const QRect box = option->rect.adjusted(0, 0, -1, -1);
    round ? painter->drawEllipse(box) : painter->drawRect(box);
    painter->restore();
  }
};

/// Makes the style of the program: that of the desktop, Fusion, or Fusion for dark colours.
QStyle* styleOf(Appearance appearance, const QString& desktopStyle) {
  switch (appearance) {
    case Appearance::system:
      return QStyleFactory::create(desktopStyle);
    case Appearance::light:
      return QStyleFactory::create(QStringLiteral("fusion"));
    case Appearance::dark:
      break;
  }
  return new SeenBoxes;
}

}  // namespace

void apply(Appearance appearance) {
  static const QString desktopStyle = QApplication::style()->name();
  static Appearance applied = Appearance::system;
  // A desktop's style may paint with colours of its own, whatever the palette says.
  if (std::exchange(applied, appearance) != appearance)
    QApplication::setStyle(styleOf(appearance, desktopStyle));
  const QPalette palette = appearance == Appearance::system
                               ? QPalette()
                               : paletteOf(appearance == Appearance::dark ? kDark : kLight);
  QApplication::setPalette(palette);
  QToolTip::setPalette(appearance == Appearance::system ? QApplication::palette() : palette);
}

void addAppearances(QMenu& menu) {
  const int chosen = QSettings().value(kKey, 0).toInt();
  auto* group = new QActionGroup(&menu);
  const std::array names{QMenu::tr("As the &desktop"), QMenu::tr("&Light"), QMenu::tr("Dar&k")};
  for (int i = 0; i < int(names.size()); ++i) {
    QAction* const action = group->addAction(names[std::size_t(i)]);
    action->setCheckable(true);
    action->setChecked(i == chosen);
    QObject::connect(action, &QAction::triggered, &menu, [i] {
      QSettings().setValue(kKey, i);
      apply(static_cast<Appearance>(i));
    });
  }
  menu.addActions(group->actions());
}

void applyChosen() {
  const int chosen = QSettings().value(kKey, 0).toInt();
  if (chosen > 0 && chosen <= int(Appearance::dark)) apply(static_cast<Appearance>(chosen));
}

}  // namespace trimtab::workbench
