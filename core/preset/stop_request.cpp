#include "trimtab/preset/stop_request.h"

#include <atomic>

namespace trimtab {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

}  // namespace

void requestStop() {
  requested = true;
}

bool stopRequested() {
  return requested;
}

}  // namespace trimtab
