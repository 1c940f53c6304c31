// SPDX-License-Identifier: GPL-3.0-or-later
#include "terms_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bar_cell.h"
#include "term_edit.h"
#include "term_plot.h"
#include "views/model/theme.h"

namespace trimtab::views {

TermsModel::TermsModel(PolicyDraft& policy, QObject* parent) : RowsModel(parent), policy_(policy) {
  refresh();
  connect(&policy_, &PolicyDraft::termsChanged, this, &TermsModel::refresh);
}

void TermsModel::setSignal(Signal signal) {
  if (signal == signal_) return;
  signal_ = signal;
  memberships_.clear();
  refresh();
}

void TermsModel::refresh() {
  lines_ = policy_.termsOf(signal_);
  for (std::size_t i = 0; i < policy_.terms().size(); ++i)
    if (!policy_.terms()[i].term) lines_.push_back(i);
  memberships_.resize(lines_.size(), std::numeric_limits<double>::quiet_NaN());
  refreshRows(static_cast<int>(lines_.size()));
}

int TermsModel::lineOf(int row) const {
  return row >= 0 && row < static_cast<int>(lines_.size())
             ? static_cast<int>(lines_[static_cast<std::size_t>(row)])
             : -1;
}

int TermsModel::rowOfLine(int line) const {
  const auto found = std::find(lines_.begin(), lines_.end(), static_cast<std::size_t>(line));
  return line < 0 || found == lines_.end() ? -1 : static_cast<int>(found - lines_.begin());
}

const PolicyDraft::TermLine& TermsModel::lineAt(int row) const {
  return policy_.terms()[lines_[static_cast<std::size_t>(row)]];
}

void TermsModel::showLive(const PolicyLive& live) {
  const double x = live.seen ? live.flight[signal_] : std::numeric_limits<double>::quiet_NaN();
  const Range range = rowOf(signal_).range;
  for (int row = 0; row < rowCount(); ++row) {
    const PolicyDraft::TermLine& line = lineAt(row);
    const double now = line.sound && !std::isnan(x)
                           ? shownShare(membershipOf(*line.term, std::clamp(x, range.low, range.high)))
                           : std::numeric_limits<double>::quiet_NaN();
    double& shown = memberships_[static_cast<std::size_t>(row)];
    if (now == shown || (std::isnan(now) && std::isnan(shown))) continue;
    shown = now;
    emit dataChanged(index(row, kNow), index(row, kNow));
  }
}

QVariant TermsModel::data(const QModelIndex& index, int role) const {
  // The plot hears of a term that was removed before this model does, and the table asks meanwhile.
  const int asked = index.isValid() ? lineOf(index.row()) : -1;
  if (asked < 0 || static_cast<std::size_t>(asked) >= policy_.terms().size()) return {};
  const PolicyDraft::TermLine& line = lineAt(index.row());
  const double now = memberships_[static_cast<std::size_t>(index.row())];
  if (role == Qt::DisplayRole || role == Qt::EditRole) {
    if (!line.term) return index.column() == kNumbers ? QString::fromStdString(line.text) : QString();
    switch (index.column()) {
      case kName:
        return QString::fromStdString(line.term->name);
      case kShape:
        return fromView(kTermShapes[static_cast<std::size_t>(line.term->shape)]);
      case kNumbers:
        return numbersText(*line.term);
      default:
        return std::isnan(now) ? QStringLiteral("–") : QString::number(now, 'f', 2);
    }
  }
  if (role == Qt::DecorationRole && index.column() == kName && line.term)
    return TermPlot::colourOf(static_cast<std::size_t>(index.row()), QPalette());
  if (role == kBarColourRole && line.term)
    return TermPlot::colourOf(static_cast<std::size_t>(index.row()), QPalette());
  if (role == kBarRole && index.column() == kNow && !std::isnan(now)) return now;
  if (role == Qt::ForegroundRole && !line.sound) return errorColour(QPalette());
  if (role == Qt::ToolTipRole) {
    if (!line.term) return tr("This line cannot be read: %1").arg(QString::fromStdString(line.text));
    const QString unit = fromView(rowOf(signal_).unit);
    if (index.column() == kNumbers)
      return numbersHelp(line.term->shape) + (unit.isEmpty() ? QString() : tr(", in %1").arg(unit));
    if (index.column() == kNow) return tr("Membership of the live value, 0 to 1");
    if (index.column() == kName) return tr("Type another name; the rules follow (F2)");
  }
  return {};
}

QVariant TermsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical || role != Qt::DisplayRole) return {};
  switch (section) {
    case kName:
      return tr("Term");
    case kShape:
      return tr("Shape");
    case kNumbers:
      return tr("Numbers") + inParentheses(rowOf(signal_).unit);
    default:
      return tr("Now");
  }
}

Qt::ItemFlags TermsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = RowsModel::flags(index);
  const bool readable = index.isValid() && lineAt(index.row()).term.has_value();
  flags.setFlag(Qt::ItemIsEditable, index.column() != kNow && readable);
  return flags;
}

std::optional<PolicyTerm> TermsModel::changed(const QModelIndex& index, const QString& text,
                                              QString& why) const {
  const PolicyDraft::TermLine& line = lineAt(index.row());
  if (!line.term) return std::nullopt;
  PolicyTerm term = *line.term;
  if (index.column() == kName) {
    term.name = text.trimmed().toStdString();
  } else if (index.column() == kShape) {
    const auto shape = std::find(kTermShapes.begin(), kTermShapes.end(), text.toStdString());
    if (shape == kTermShapes.end()) return std::nullopt;
    term = withShape(term, static_cast<TermShape>(shape - kTermShapes.begin()),
                     viewOf(signal_, policy_.policy().terms));
  } else {
    // A whole shape may be typed, or its numbers alone.
    if (auto shape = readShape(text.toStdString(), "")) {
      term.shape = shape->shape;
      term.numbers = shape->numbers;
    } else if (auto numbers = readNumbers(text)) {
      term.numbers = *numbers;
    } else {
      why = tr("“%1” is no list of numbers: %2.").arg(text, numbersHelp(term.shape));
      return std::nullopt;
    }
  }
  if (const Findings wrong = policy_.check(term, lines_[static_cast<std::size_t>(index.row())]);
      !wrong.empty()) {
    why = sentences(wrong);
    return std::nullopt;
  }
  return term;
}

QString TermsModel::refusal(const QModelIndex& index, const QString& text) const {
  QString why;
  changed(index, text, why);
  return why;
}

bool TermsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !index.isValid()) return false;
  QString why;
  const auto term = changed(index, value.toString(), why);
  if (!term) return false;
  const auto line = static_cast<std::size_t>(lineOf(index.row()));
  if (*term == *policy_.terms()[line].term) return true;
  if (index.column() == kName)
    policy_.renameTerm(line, term->name);
  else
    policy_.putTerm(line, *term, index.column() == kShape ? tr("Change Shape") : tr("Type Numbers"));
  return true;
}

}  // namespace trimtab::views
