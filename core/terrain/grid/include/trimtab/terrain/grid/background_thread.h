#pragma once

#include <sys/resource.h>

namespace trimtab::terrain {

/// From now on the calling thread gives way to those that draw: where all of them want a core it gets a tenth
/// of what one of them gets. Linux keeps this by thread.
inline void giveWayToPictures() {
  constexpr int kTenth = 10;
  ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + kTenth);
}

}  // namespace trimtab::terrain
