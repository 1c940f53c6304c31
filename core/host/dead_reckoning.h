#pragma once

#include "trimtab/frame/frame.h"

namespace trimtab {

/// Returns the axes forward, right and down of a body that was turned from a frame's axes x, y and z by
/// `psi` about z, `theta` about the new y and `phi` about the new x, as a rotation from the frame.
Mat3 bodyAxes(Radians psi, Radians theta, Radians phi);
/// Returns an aircraft's forward, right and down as a rotation from ECEF, and the attitude that they mean at
/// a place. A vertical aircraft has no roll; its heading says where its right wing is.
Mat3 ecefToBody(const GeodeticPosition& position, const Attitude& attitude);
Attitude attitudeOf(const GeodeticPosition& position, const Mat3& ecefToBody);
/// Returns a velocity in ECEF, m/s, in the local horizon's axes.
Velocity overGround(const GeodeticPosition& position, Vec3 ecef);

}  // namespace trimtab
