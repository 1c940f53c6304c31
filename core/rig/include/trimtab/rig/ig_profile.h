#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/frame/frame_levers.h"
#include "trimtab/units/range.h"
#include "trimtab/units/result.h"

/// Describes an image generator (IG) that is not ours: which levers it has, as what it knows them, and what
/// it reports of an image.
namespace trimtab {

/// One lever as the IG has it. `own` values are the IG's; ours are those of FrameLevers.
struct IgLever {
  std::size_t row = 0;  ///< in kFrameLeverRows
  std::string ownKey;   ///< as the IG calls it, for people
  std::string ownUnit;
  double factor = 1;      ///< own = factor x ours, or factor / ours if `inverse`
  bool inverse = false;   ///< a larger own value is finer where ours is coarser, as of an LOD bias
  Range own{0, 1};        ///< what the IG takes
  double ownNeutral = 1;  ///< what it draws without us

  double toOwn(double ours) const;  ///< within `own`; an unlimited distance is the end of the range
  double toOurs(double ownValue) const;
  double neutral() const { return toOurs(ownNeutral); }
  Range ours() const;
  const FrameLeverRow& names() const { return kFrameLeverRows[row]; }
  friend bool operator==(const IgLever&, const IgLever&);
};

/// What the IG reports of an image, by which the budget and the terms of a policy judge how much it draws.
enum class IgLoad : std::uint8_t {
  triangles,
  objects,  ///< draw calls or nodes: trimtab_frame::nodes
  time      ///< neither is known: the microseconds of the image stand for it
};

struct IgProfile {
  std::string name;
  IgLoad load = IgLoad::triangles;
  /// After a lever has moved, so many images do not count: they load levels, or their GPU time is not there.
  int settleImages = 1;
  std::vector<IgLever> levers;  ///< by `row`, rising

  /// Returns the lever with this key of kFrameLeverRows; null if the IG does not have it.
  const IgLever* find(std::string_view key) const;
  /// Returns the lever that an allowed error moves: its own, else the LOD scale, whose factor it is then;
  /// null if the IG has neither.
  const IgLever* errorLever() const;
  friend bool operator==(const IgProfile&, const IgProfile&) = default;
};

/// Reads a profile: JSON with `"format": "trimtab-ig-profile"`, whose members are those of IgProfile (see
/// resources/docs/integrating.md). Findings name line and key: levers that are unknown or come twice, ranges
/// without width or that exclude the neutral value, numbers that are not finite, factors not above 0.
Result<IgProfile> parseIgProfile(std::string_view text, const std::string& where);
Result<IgProfile> loadIgProfile(const std::filesystem::path& file);

/// Returns what the IG is to set for a lever of its profile, in its own unit and within its range. Where it
/// has no allowed error of its own, its LOD scale also takes the factor by which the error that is drawn
/// exceeds the preset's. It is the neutral value for a number that is not one.
double ownValue(const IgProfile& profile, const IgLever& lever, const LeverChain& chain);

/// Returns the load of an image as the profile counts it.
double loadOf(const IgProfile& profile, double triangles, double objects, double workMs);

}  // namespace trimtab
