#pragma once

#include "trimtab/frame/frame_request.h"

namespace trimtab {

/// Writes into a request what the policy of its decision sets: the allowed screen-space error, the far cut,
/// the density of particles, the blur and the render scale. The occlusion and the LOD scale are part of the
/// decision already. Without a policy nothing changes.
void applyLevers(const PolicyOutcome& policy, FrameRequest& request);

}  // namespace trimtab
