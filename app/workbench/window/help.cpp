// SPDX-License-Identifier: GPL-3.0-or-later
#include "help.h"

#include <QAction>
#include <QDialog>
#include <QDialogButtonBox>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QTextBrowser>
#include <QVBoxLayout>

namespace trimtab::workbench {
namespace {

void showText(QWidget* parent, const QString& title, const QString& markdown) {
  auto* dialog = new QDialog(parent);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(title);
  dialog->resize(860, 640);
  auto* text = new QTextBrowser(dialog);
  text->setMarkdown(markdown);
  text->setOpenExternalLinks(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  auto* layout = new QVBoxLayout(dialog);
  layout->addWidget(text);
  layout->addWidget(buttons);
  dialog->show();
}

}  // namespace

void showKeys(QWidget* parent, const QMenuBar& menus) {
  QString text = QObject::tr(
      "## Free camera\n\nThese work while the view has the focus and neither a host nor a flight moves the "
      "aircraft.\n\n"
      "| Keys | What they do |\n|---|---|\n"
      "| drag with the left button | look around |\n| wheel | faster, slower |\n"
      "| W, S | ahead, back |\n| A, D | left, right |\n| E or Page Up, Q or Page Down | up, down |\n"
      "| arrow keys | turn and tilt |\n\n"
      "## Every plot\n\n| Keys | What they do |\n|---|---|\n"
      "| Ctrl and the wheel, plus, minus | zoom; the wheel alone scrolls the dock |\n\n"
      "## Plots\n\n| Keys | What they do |\n|---|---|\n"
      "| click | explain the frame beside the median of those shown; a paused flight goes there |\n"
      "| W, Shift+W | next and previous frame that took long |\n| Space, F | pause; follow the newest frame "
      "|\n"
      "| left, right | move the view, or with cursors the one chosen by A or B |\n"
      "| menu key, right click | add and remove signals and plots |\n\n"
      "## Run time against error\n\n| Keys | What they do |\n|---|---|\n"
      "| left, right | in the plot the point before or after; along the flight the frame, with Shift ten |\n"
      "| L, F | logarithmic frame time; fit the view |\n| W, Shift+W | next and previous worst frame |\n\n"
      "## Policy\n\n| Keys | What they do |\n|---|---|\n"
      "| Tab, Shift+Tab | next and previous point of the term |\n| Page Up, Page Down | other terms |\n"
      "| arrow keys | move the point, with Shift ten times as far |\n"
      "| Ctrl+Left, Ctrl+Right | move the point to one of another term |\n"
      "| Enter | type the term's numbers |\n| Insert, Delete | add and remove a point, a term, a rule |\n"
      "| A, Ctrl+Delete | in the plot add and remove a term |\n"
      "| Ctrl+C, Ctrl+V | copy a shape to another term |\n| Ctrl+D | duplicate a term or rule |\n"
      "| F2, Space | edit a cell, switch a rule on or off |\n| Alt+Up, Alt+Down | move a rule |\n"
      "| F3, Shift+F3 | find a rule |\n| Ctrl+Tab, Ctrl+Shift+Tab | next and previous page |\n\n"
      "## Commands\n\n| Keys | What they do |\n|---|---|\n");
  for (const QMenu* menu : menus.findChildren<QMenu*>())
    for (const QAction* action : menu->actions()) {
      if (action->shortcut().isEmpty()) continue;
      text += QStringLiteral("| %1 | %2 |\n")
                  .arg(action->shortcut().toString(QKeySequence::NativeText),
                       QString(action->text()).remove('&').remove(QStringLiteral("...")));
    }
  showText(parent, QObject::tr("Keys and mouse"), text);
}

void showAbout(QWidget* parent, const scene::GlReport& gl) {
  QMessageBox::about(
      parent, QObject::tr("About Trimtab"),
      QObject::tr("<h3>Trimtab %1</h3><p>Tune culling and level of detail of flight simulator image "
                  "generators while you watch what each setting does.</p><p>The workbench is free software "
                  "under the GNU General Public License, version 3 or later; the library that image "
                  "generators link is under the MIT licence.</p><p>OpenGL: %2, %3%4</p><p>Terrain: %5</p>")
          .arg(QStringLiteral(TRIMTAB_VERSION), QString::fromStdString(gl.renderer).toHtmlEscaped(),
               QString::fromStdString(gl.version).toHtmlEscaped(),
               gl.software ? QObject::tr(" (software)") : QString(),
               QString::fromStdString(gl.drawing).toHtmlEscaped()));
}

}  // namespace trimtab::workbench
