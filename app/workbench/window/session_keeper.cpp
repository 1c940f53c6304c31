// SPDX-License-Identifier: GPL-3.0-or-later
#include "session_keeper.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QMenu>
#include <QStandardPaths>
#include <algorithm>

#include "app/workbench/controllers/controllers.h"
#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "trimtab/host/log_look.h"
#include "trimtab/preset/preset.h"
#include "views/model/draft.h"
#include "views/model/snapshots.h"
#include "workspaces.h"

namespace trimtab::workbench {
namespace {

constexpr std::size_t kViewKeys = 9;
constexpr auto kRecent = "session";

QString sessionFilter() {
  return SessionKeeper::tr("Sessions (*%1)").arg(QLatin1String(kSessionEnding));
}

}  // namespace

SessionKeeper::SessionKeeper(const Workplace& workplace, const Controllers& controllers,
                             Workspaces& workspaces, views::Snapshots& snapshots)
    : QObject(&workplace.window),
      at_(workplace),
      by_(controllers),
      workspaces_(workspaces),
      snapshots_(snapshots) {
  // A terrain that was opened has placed the camera by now.
  connect(by_.terrain.get(), &TerrainController::opened, this, [this] {
    if (placeSoon_) place(*placeSoon_);
    placeSoon_.reset();
  });
}

QString SessionKeeper::lastFile() {
  return QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + QStringLiteral("/last") +
         QLatin1String(kSessionEnding);
}

SavedSession SessionKeeper::current() const {
  SavedSession session;
  session.terrain = by_.terrain->askedFor();
  const Document& document = by_.document->document();
  const auto shipped = shippedPresets();
  const std::string& name = at_.draft.preset().name;
  if (!document.file().isEmpty())
    session.preset = document.file();
  else if (std::find(shipped.begin(), shipped.end(), name) != shipped.end())
    session.preset = QString::fromStdString(name);
  if (session.preset.isEmpty() || at_.draft.isDirty())
    if (const Result<std::string> edits = document.editsText())
      session.draft = QString::fromStdString(*edits);
  session.imageGenerator = at_.draft.imageGeneratorFile();
  session.flight = by_.flight->flightDock().file();
  session.flightColumns = QString::fromStdString(columnMapText(by_.flight->flightDock().columns()));
  if (!session.flight.isEmpty()) session.flightPositionS = by_.flight->flightDock().position();
  if (const link::Receiver* receiver = at_.feed.receiver()) session.listenPort = receiver->port();
  session.workspace = workspaces_.names()[workspaces_.current()];
  const FreeCamera& camera = at_.viewport.camera();
  session.eye = SavedView{{}, camera.position(), camera.attitude()};
  session.views = views_;
  session.snapshots.emplace();
  for (int slot = 0; slot < views::Snapshots::kCount; ++slot) {
    const TuningParameters* const values = snapshots_.values(slot);
    if (values == nullptr) continue;
    Preset preset;
    preset.name = snapshots_.title(slot).toStdString();
    preset.parameters = *values;
    if (const Result<std::string> text = presetText(preset))
      session.snapshots->push_back({slot, snapshots_.name(slot), QString::fromStdString(*text)});
  }
  return session;
}

bool SessionKeeper::open(const QString& file) {
  const Result<SavedSession> read = readSession(file);
  if (!read) {
    at_.messages.add(tr("The session cannot be opened: %1").arg(file), read.findings());
    return false;
  }
  if (!by_.document->mayLoseEdits()) return false;
  const SavedSession& session = *read;
  if (file != lastFile()) {
    file_ = QFileInfo(file).absoluteFilePath();
    rememberRecent(QLatin1String(kRecent), file_);
  }
  if (session.draft)
    by_.document->openEdits(session.preset, *session.draft, file);
  else if (!session.preset.isEmpty())
    by_.document->open(session.preset);
  if (session.imageGenerator.isEmpty())
    by_.ig->takeAway();
  else
    by_.ig->open(session.imageGenerator);
  if (const int index = int(workspaces_.names().indexOf(session.workspace)); index >= 0)
    workspaces_.show(index);
  by_.flight->flightDock().close();
  std::optional<ColumnMap> columns;
  if (!session.flightColumns.isEmpty()) columns = *parseColumnMap(session.flightColumns.toStdString());
  if (!session.flight.isEmpty() && by_.flight->open(session.flight, columns))
    by_.flight->flightDock().seek(session.flightPositionS);
  if (session.listenPort)
    by_.flight->listen(*session.listenPort);
  else
    at_.feed.closeHost();
  views_ = session.views;
  emit viewsChanged();
  if (session.snapshots) restore(*session.snapshots);
  placeSoon_ = session.eye;
  if (session.terrain.isEmpty())
    by_.terrain->openSample();
  else
    by_.terrain->open(session.terrain);
  return true;
}

bool SessionKeeper::saveTo(const QString& file) {
  const Result<Done> written = writeSession(file, current());
  if (!written) {
    at_.messages.add(tr("The session cannot be saved: %1").arg(file), written.findings());
    return false;
  }
  file_ = QFileInfo(file).absoluteFilePath();
  rememberRecent(QLatin1String(kRecent), file_);
  at_.messages.add(tr("The session is saved: %1").arg(file_), written.findings());
  if (at_.draft.isDirty())
    at_.messages.note(
        tr("The session holds the unsaved edits of the preset; Ctrl+S writes them to its file"));
  return true;
}

void SessionKeeper::askOpen() {
  const QString file = QFileDialog::getOpenFileName(&at_.window, tr("Open session"), file_, sessionFilter());
  if (!file.isEmpty()) open(file);
}

void SessionKeeper::askSave() {
  QFileDialog dialog(&at_.window, tr("Save session"), file_, sessionFilter());
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QLatin1String(kSessionEnding).mid(1));
  if (dialog.exec() == QDialog::Accepted) saveTo(dialog.selectedFiles().constFirst());
}

void SessionKeeper::keepLast() {
  if (!by_.terrain->database()) return;
  QDir().mkpath(QFileInfo(lastFile()).path());
  SavedSession session = current();
  // The person has just been asked about the edits, and has given them up.
  session.draft.reset();
  // At the end there is nobody to tell; the session before it stays.
  (void)writeSession(lastFile(), session);
}

void SessionKeeper::keepView(const QString& name) {
  const FreeCamera& camera = at_.viewport.camera();
  const Seat seat =
      at_.viewport.cameraEnabled() ? Seat{camera.position(), camera.attitude()} : seatOf(at_.feed.session());
  const SavedView view{name, seat.position, seat.attitude};
  const auto same =
      std::find_if(views_.begin(), views_.end(), [&](const SavedView& each) { return each.name == name; });
  if (same != views_.end())
    *same = view;
  else
    views_.push_back(view);
  emit viewsChanged();
}

void SessionKeeper::forgetView(std::size_t index) {
  if (index >= views_.size()) return;
  views_.erase(views_.begin() + std::ptrdiff_t(index));
  emit viewsChanged();
}

void SessionKeeper::goToView(std::size_t index) {
  if (index >= views_.size()) return;
  if (!at_.viewport.cameraEnabled())
    return at_.messages.note(
        tr("A host or a flight moves the view: detach it (Ctrl+Shift+F) or freeze it (Ctrl+F) first"));
  place(views_[index]);
}

void SessionKeeper::place(const SavedView& view) {
  by_.flight->placeCamera(view.position, view.attitude);
}

void SessionKeeper::restore(const std::vector<SavedSnapshot>& snapshots) {
  for (int slot = 0; slot < views::Snapshots::kCount; ++slot) snapshots_.forget(slot);
  for (const SavedSnapshot& each : snapshots)
    if (const auto preset = parsePreset(each.preset.toStdString(), each.name.toStdString()))
      snapshots_.restore(each.slot, each.name, preset->parameters);
}

void SessionKeeper::askViewName() {
  bool good = false;
  const QString name = QInputDialog::getText(&at_.window, tr("Keep this view"), tr("Name"), QLineEdit::Normal,
                                             tr("View %1").arg(views_.size() + 1), &good);
  if (good && !name.trimmed().isEmpty()) keepView(name.trimmed());
}

void SessionKeeper::fillMenu(QMenu& menu) {
  connect(this, &SessionKeeper::viewsChanged, &menu, [this, &menu] { showViews(menu); });
  showViews(menu);
}

void SessionKeeper::showViews(QMenu& menu) {
  for (QMenu* old : menu.findChildren<QMenu*>(QString(), Qt::FindDirectChildrenOnly)) old->deleteLater();
  menu.clear();
  QAction* keep = menu.addAction(tr("&Keep this view..."), this, &SessionKeeper::askViewName);
  keep->setShortcut(tr("Ctrl+Shift+B"));
  if (views_.empty()) return;
  QMenu* forget = menu.addMenu(tr("&Forget a view"));
  menu.addSeparator();
  for (std::size_t i = 0; i < views_.size(); ++i) {
    QAction* go = menu.addAction(views_[i].name, this, [this, i] { goToView(i); });
    if (i < kViewKeys) go->setShortcut(tr("Alt+Shift+%1").arg(i + 1));
    // The menu is made anew meanwhile, which must not happen under the action that is running.
    connect(
        forget->addAction(views_[i].name), &QAction::triggered, this, [this, i] { forgetView(i); },
        Qt::QueuedConnection);
  }
}

}  // namespace trimtab::workbench
