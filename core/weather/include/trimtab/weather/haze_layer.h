#pragma once

#include "trimtab/units/sphere.h"

/// A layer of haze around a spherical earth: extinction is one number up to its top and 0 above. All heights
/// are above mean sea level.
namespace trimtab {

/// The contrast that is left at the meteorological optical range, the distance that is reported as visibility
/// (WMO-No. 8, volume I, chapter 9; ICAO Annex 3, appendix 3).
inline constexpr double kOpticalRangeContrast = 0.05;

/// No ground on earth is higher, metres.
inline constexpr double kHighestGroundM = 9000;

/// Returns the part of a straight ray, metres, that lies in the layer. `rise` is the sine of its elevation
/// above the horizontal at the eye; `lengthM` may be infinite. air.glsl and sky.frag.glsl compute the same.
/// A level ray needs no case of its own, because the earth's curvature ends it.
double lengthInLayer(double eyeM, double rise, double lengthM, double topM);

/// Returns a distance from the eye, metres, beyond which ground can change no channel of any pixel by more
/// than 1/255, wherever the eye looks; infinite if there is none, or if it is farther than 400 km.
///
/// Ground at height g and distance d is seen through at least the share (top - g) / (eye - g), or
/// (top - eye) / (g - eye), of d, because a straight ray never rises above the line that joins the heights of
/// its ends. That share is least for the highest ground. Of a colour exp(-extinction * share * d) is left,
/// and of the sky behind it less. Both are mixed with the same fog, so the images with and without the ground
/// differ by at most that. 100 m are added to both heights: an eye climbs while its decision is drawn, and
/// the earth is no sphere.
///
/// Returns infinity also for an extinction that is not above 0, and for any height that is not a number. An
/// infinite extinction gives 0.
double safeFarM(double extinctionPerM, double topM, double eyeM, double highestGroundM = kHighestGroundM);

}  // namespace trimtab
