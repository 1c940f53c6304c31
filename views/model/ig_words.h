// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <string_view>

#include "trimtab/frame/frame_levers.h"

namespace trimtab {
struct IgProfile;
}

namespace trimtab::views {

// What the profile of an image generator says of a lever. Without a profile it says nothing: this program's
// own image generator has every lever.

/// Returns "NAME does not have it" for the key of a lever; empty if it has it. An allowed error is also had
/// by whoever has an LOD scale.
QString lacksText(const IgProfile* ig, std::string_view lever);
/// Returns how the image generator knows a lever: "viewer: zFar, 5 to 80 km". Empty if it does not have it.
QString ownRangeText(const IgProfile* ig, std::string_view lever);
/// Returns what the image generator sets for an image: "viewer: zFar = 20 km". Empty if it does not have the
/// lever.
QString ownValueText(const IgProfile* ig, const FrameLeverRow& lever, const LeverChain& chain);

}  // namespace trimtab::views
