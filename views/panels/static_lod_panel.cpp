// SPDX-License-Identifier: GPL-3.0-or-later
#include "static_lod_panel.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QLabel>
#include <QSlider>
#include <algorithm>

#include "views/controls/bar_list.h"
#include "views/controls/parameter_lines.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {
namespace {

QString count(std::uint64_t n) {
  return numberText(static_cast<double>(n), 0);
}

QString ratio(std::uint64_t faces, std::uint64_t triangles) {
  return triangles > 0 ? numberText(static_cast<double>(faces) / static_cast<double>(triangles), 2)
                       : QStringLiteral("-");
}

/// The published example beside this terrain, as a table that a screen reader reads row by row.
QString comparison(const StaticLodSummary& ours) {
  const PublishedStaticLod published;
  const auto row = [](const QString& name, const QString& theirs, const QString& here) {
    return QStringLiteral(
               "<tr><td>%1&nbsp;&nbsp;</td><td align='right'>%2&nbsp;&nbsp;</td>"
               "<td align='right'>%3</td></tr>")
        .arg(name, theirs, here);
  };
  QString text = QStringLiteral("<table>");
  text += row({}, StaticLodPanel::tr("<b>Published</b>"), StaticLodPanel::tr("<b>This terrain</b>"));
  text += row(StaticLodPanel::tr("Tiles"), QStringLiteral("1"), count(ours.tiles));
  text += row(StaticLodPanel::tr("Triangles"), count(published.triangles), count(ours.sourceTriangles));
  text +=
      row(StaticLodPanel::tr("n, a node"), count(published.trianglesPerNode), count(ours.trianglesPerNode));
  text += row(StaticLodPanel::tr("Levels"), count(published.levels), count(ours.levels));
  text += row(StaticLodPanel::tr("Faces of all nodes"), QStringLiteral("-"), count(ours.faces));
  text +=
      row(StaticLodPanel::tr("Different ones of these"), count(published.faces), count(ours.distinctFaces));
  text += row(StaticLodPanel::tr("Different faces a triangle"), ratio(published.faces, published.triangles),
              ratio(ours.distinctFaces, ours.sourceTriangles));
  text += row(StaticLodPanel::tr("Nodes, and locked above n"), QStringLiteral("-"),
              StaticLodPanel::tr("%1, %2").arg(count(ours.nodes), count(ours.lockedMinima)));
  text += row(StaticLodPanel::tr("Size"), QStringLiteral("-"),
              StaticLodPanel::tr("%1 MB").arg(numberText(static_cast<double>(ours.bytes) * 1e-6, 1)));
  return text + QStringLiteral("</table>");
}

}  // namespace

StaticLodPanel::StaticLodPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      state_(new QLabel),
      table_(new QLabel),
      level_(new QLabel),
      body_(new QWidget),
      drawn_(new BarList),
      single_(new QCheckBox(tr("Show &one level, whatever the distance"))),
      picture_(new QCheckBox(tr("As in the &published picture"))),
      slider_(new QSlider(Qt::Horizontal)),
      throttle_(this, [this] { refresh(); }) {
  for (QLabel* label : {state_, level_}) label->setWordWrap(true);
  table_->setTextFormat(Qt::RichText);
  table_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  table_->setToolTip(
      tr("<p>A face that several nodes have is one different face. The document's rule, at least n/2 and at "
         "most n triangles in a leaf, is kept here. Its example contradicts it: by the rule it has 16 leaves "
         "and 5 levels; the published 4 levels are those of 8 leaves of more than n.%1</p>")
          .arg(documentsHtml("E")));
  drawn_->setAccessibleName(tr("Triangles drawn, by level"));
  slider_->setAccessibleName(tr("Level, from the roots to the leaves"));
  slider_->setPageStep(1);
  slider_->setTickPosition(QSlider::TicksBelow);
  slider_->setTickInterval(1);
  single_->setToolTip(tr("All trees at one level; leaves where a tree ends above it"));
  picture_->setToolTip(
      tr("<p>Faces light grey, edges red, edges that may not change in their level black: borders between "
         "nodes, tiles and holes.%1</p>")
          .arg(documentsHtml("E")));

  auto* inside = new QVBoxLayout(body_);
  inside->setContentsMargins(0, 0, 0, 0);
  inside->addWidget(new QLabel(tr("<b>Triangles drawn now, of those in the level</b>")));
  inside->addWidget(drawn_);
  inside->addWidget(new QLabel(tr("<b>Level to level</b>")));
  inside->addWidget(single_);
  inside->addWidget(slider_);
  inside->addWidget(level_);
  inside->addWidget(picture_);
  inside->addWidget(table_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(state_);
  layout->addWidget(new ParameterLines(draft, "static_lod."));
  layout->addWidget(body_);
  layout->addStretch(1);

  connect(single_, &QCheckBox::toggled, this, &StaticLodPanel::announce);
  connect(picture_, &QCheckBox::toggled, this, &StaticLodPanel::announce);
  connect(slider_, &QSlider::valueChanged, this, [this] {
    // Whoever moves it wants to see the level.
    if (single_->isChecked()) return announce();
    single_->setChecked(true);
  });
  setTrees(std::nullopt);
}

void StaticLodPanel::setTrees(std::optional<StaticLodSummary> trees) {
  const QSignalBlocker quiet(slider_);
  trees_ = std::move(trees);
  frame_ = {};
  body_->setVisible(trees_.has_value());
  if (trees_) {
    slider_->setRange(0, std::max(0, static_cast<int>(trees_->levels) - 1));
    table_->setText(comparison(*trees_));
  }
  refresh();
  announce();
}

int StaticLodPanel::depth() const {
  return trees_ && single_->isChecked() ? slider_->value() : -1;
}

bool StaticLodPanel::picture() const {
  return trees_ && picture_->isChecked();
}

void StaticLodPanel::announce() {
  sayLevel();
  emit overlayChanged(depth(), picture());
}

void StaticLodPanel::sayLevel() {
  if (!trees_) return level_->clear();
  const auto depth = static_cast<std::size_t>(slider_->value());
  const std::uint64_t faces = depth < trees_->facesOfLevel.size() ? trees_->facesOfLevel[depth] : 0;
  const QString place = depth == 0                    ? tr(" (roots)")
                        : depth + 1 == trees_->levels ? tr(" (leaves: the scenery as it is)")
                                                      : QString();
  const QString text =
      tr("Level %1 of 0 to %2%3: %4 faces").arg(depth).arg(slider_->maximum()).arg(place, count(faces));
  level_->setText(text);
  slider_->setAccessibleDescription(text);
  slider_->setToolTip(text);
}

void StaticLodPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  throttle_.request();
}

void StaticLodPanel::refresh() {
  if (!trees_) {
    state_->setText(tr(
        "This terrain has no static trees. FlightGear scenery has: File > Open terrain folder, and choose a "
        "folder with .stg or .btg.gz files. It is built into trees once and kept."));
    return;
  }
  const StaticLodFrame& now = frame_.drawn().staticLod;
  std::uint64_t drawn = 0, nodes = 0;
  for (std::size_t d = 0; d < StaticLodFrame::kDepths; ++d) drawn += now.triangles[d], nodes += now.nodes[d];
  state_->setText(
      now.drawn
          ? tr("The static trees are drawn: %1 triangles in %2 nodes.").arg(count(drawn), count(nodes))
          : tr("The tiled levels are drawn. Choose “Static trees” below to draw the trees by distance."));
  std::vector<BarList::Bar> bars;
  const std::size_t levels = std::min<std::size_t>(trees_->facesOfLevel.size(), StaticLodFrame::kDepths);
  for (std::size_t d = 0; d < levels; ++d) {
    const QString name = d == 0            ? tr("0, roots")
                         : d + 1 == levels ? tr("%1, leaves").arg(d)
                                           : QString::number(d);
    const std::uint64_t faces = std::max<std::uint64_t>(trees_->facesOfLevel[d], 1);
    bars.push_back({name,
                    static_cast<double>(now.triangles[d]),
                    static_cast<double>(faces),
                    tr("%1 of %2").arg(count(now.triangles[d]), count(trees_->facesOfLevel[d])),
                    {},
                    0,
                    !now.drawn});
  }
  drawn_->setBars(std::move(bars));
}

}  // namespace trimtab::views
