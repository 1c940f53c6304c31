// SPDX-License-Identifier: GPL-3.0-or-later
#include "pause_button.h"

#include <QPushButton>

#include "app/workbench/jobs/child_run.h"

namespace trimtab::workbench {

QPushButton* makePauseButton(ChildRun& run, QWidget* parent) {
  auto* button = new QPushButton(parent);
  const auto show = [button, &run] {
    button->setVisible(run.running());
    button->setText(run.pauseAsked() ? QObject::tr("Go &on") : QObject::tr("&Pause"));
    button->setToolTip(
        run.pauseAsked() ? QObject::tr("Goes on with the next image")
                         : QObject::tr("Stops after the image in hand, so that no time has the pause in it, "
                                       "and leaves the processor to others"));
  };
  QObject::connect(button, &QPushButton::clicked, &run, [&run, show] {
    run.pauseAsked() ? run.goOn() : run.pause();
    show();
  });
  QObject::connect(&run, &ChildRun::workingChanged, button, show);
  show();
  return button;
}

}  // namespace trimtab::workbench
