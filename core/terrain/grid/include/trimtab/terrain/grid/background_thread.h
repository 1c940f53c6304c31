#pragma once

#include <sys/resource.h>

namespace trimtab::terrain {

/// Lowers the priority of the calling thread below that of threads that draw: if all want a core, it gets
/// about a tenth of a drawing thread's time. Linux keeps this value per thread.
inline void giveWayToPictures() {
  constexpr int kTenth = 10;
  ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + kTenth);
}

}  // namespace trimtab::terrain
