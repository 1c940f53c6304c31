// SPDX-License-Identifier: GPL-3.0-or-later
#include "ig_words.h"

#include <QObject>

#include "theme.h"
#include "trimtab/rig/ig_profile.h"
#include "trimtab/units/number.h"

namespace trimtab::views {
namespace {

/// The lever of the image generator that ours moves; null if there is none.
const IgLever* movedBy(const IgProfile* ig, std::string_view lever) {
  if (ig == nullptr) return nullptr;
  return lever == rowOf(Lever::screen_space_error).key ? ig->errorLever() : ig->find(lever);
}

QString withUnit(const QString& number, const IgLever& lever) {
  return lever.ownUnit.empty() ? number : number + QLatin1Char(' ') + QString::fromStdString(lever.ownUnit);
}

QString igNumber(double value) {
  return QString::fromStdString(trimtab::numberText(value, 4));
}

}  // namespace

QString lacksText(const IgProfile* ig, std::string_view lever) {
  if (ig == nullptr || movedBy(ig, lever) != nullptr) return {};
  return QObject::tr("%1 does not have it").arg(QString::fromStdString(ig->name));
}

QString ownRangeText(const IgProfile* ig, std::string_view lever) {
  const IgLever* const own = movedBy(ig, lever);
  if (own == nullptr) return {};
  return QObject::tr("%1: %2, %3 to %4")
      .arg(QString::fromStdString(ig->name), QString::fromStdString(own->ownKey), igNumber(own->own.low),
           withUnit(igNumber(own->own.high), *own));
}

QString ownValueText(const IgProfile* ig, const FrameLeverRow& lever, const LeverChain& chain) {
  const IgLever* const own = movedBy(ig, lever.key);
  if (own == nullptr) return {};
  return QObject::tr("%1: %2 = %3")
      .arg(QString::fromStdString(ig->name), QString::fromStdString(own->ownKey),
           withUnit(igNumber(ownValue(*ig, *own, chain)), *own));
}

}  // namespace trimtab::views
