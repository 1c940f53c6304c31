#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/host/decoder.h"
#include "trimtab/measure/trace_file.h"
#include "trimtab/rig/fit_flight.h"
#include "trimtab/session/session.h"
#include "trimtab/trimtab.h"

/// What stands behind the handles of the C interface. They have C names and are known only in this folder.

struct trimtab_findings {
  trimtab::Findings all;
};

struct trimtab_preset {
  trimtab::ValidatedParameters parameters;
};

struct trimtab_profile {
  trimtab::IgProfile profile;
};

struct trimtab_fit {
  trimtab::IgFit fit;
};

/// A fit while it is flown.
struct trimtab_fitting {
  trimtab_fitting(const trimtab::IgProfile& profile, std::string target)
      : flight(profile), file(std::move(target)) {}
  trimtab::FitFlight flight;
  std::string file;
  std::optional<trimtab::FrameRequest> view;  ///< that is drawn again and again
  std::size_t written = 0;                    ///< views in the file
  bool requested = false;                     ///< an image that is not finished yet
  bool byEnvironment = false;                 ///< nobody asks how it ended
};

struct trimtab_session {
  explicit trimtab_session(const trimtab::ValidatedParameters& parameters);

  /// Forgets the image, because a state has been decided after it. A fit stays in its view.
  void decided() {
    chain.reset();
    if (fitting) return;
    image.reset();
  }
  const trimtab::FrameDecision& decision() const { return image ? image->decision : session.decision(); }
  const trimtab::LeverChain& levers();
  void writeRows(bool all);

  trimtab::Session session;
  trimtab::HostDecoder decoder;
  trimtab::Datagram datagram;  ///< the last one; kept so that its sender's name needs no allocation
  /// Why the last datagram led to no state; null if it did, or if it came from another sender.
  std::optional<trimtab::Finding> trimtab::HostStatistics::*unused = nullptr;
  std::optional<trimtab::FrameRequest> image;
  std::optional<trimtab::LeverChain> chain;  ///< of the newest state, once it is asked for
  std::optional<trimtab::TraceFile> trace;
  std::vector<trimtab::TraceRow> rows;
  std::optional<trimtab::IgProfile> profile;
  std::optional<trimtab_fitting> fitting;
};

namespace trimtab::c {

/// Runs `work` and keeps its exceptions from the caller, who may be written in any language. Files and
/// packets are reported by findings, so all that is left to throw is a lack of memory.
template <class Work>
trimtab_status guarded(const Work& work) noexcept {
  try {
    return work();
  } catch (...) {
    return TRIMTAB_FAILED;
  }
}

/// Copies a struct that the caller's version may have made shorter or longer: what is missing stays as it is
/// in `ours`. Returns false for null and for a size that no version has.
template <class Struct>
bool copyIn(Struct& ours, const Struct* theirs, std::size_t firstSize) {
  if (theirs == nullptr || theirs->size < firstSize) return false;
  std::memcpy(&ours, theirs, std::min(theirs->size, sizeof ours));
  return true;
}

/// Copies as much to the caller's struct as it has fields for, and leaves its size and what follows as they
/// are.
template <class Struct>
bool copyOut(Struct* theirs, Struct ours, std::size_t firstSize) {
  if (theirs == nullptr || theirs->size < firstSize) return false;
  ours.size = theirs->size;
  std::memcpy(theirs, &ours, std::min(theirs->size, sizeof ours));
  return true;
}

/// Sizes of the structs in version 1. They never change: a struct that grows keeps its last field of then.
inline constexpr std::size_t kFindingSize = offsetof(trimtab_finding, found) + sizeof(const char*),
                             kStateSize = offsetof(trimtab_state, view_top_deg) + sizeof(double),
                             kImageSize = offsetof(trimtab_image, near_m) + sizeof(double),
                             kFrameSize = offsetof(trimtab_frame, nodes) + sizeof(std::uint64_t),
                             kLeverSize = offsetof(trimtab_lever, unit) + sizeof(const char*),
                             kOwnLeverSize = offsetof(trimtab_own_lever, neutral) + sizeof(double),
                             kDecisionSize = offsetof(trimtab_decision, near_far_ratio) + sizeof(double);

/// Hands findings over, if the caller wants them.
void give(trimtab_findings** to, Findings findings);
/// Writes a line as snprintf does, and returns its whole length.
std::size_t give(char* text, std::size_t capacity, std::string_view line);

/// Gives a new session the profile of the environment, and begins its fit.
trimtab_status beginByEnvironment(trimtab_session& session);
/// Ends the fit of a session that is freed. One that the environment began says on standard error what is
/// wrong.
void endWithSession(trimtab_session& session);
/// Requests the image of a fit, which stays in its view; and takes what it cost.
std::optional<FrameRequest> requestOf(trimtab_session& session, double now, int widthPx, int heightPx);
void finishFitted(trimtab_session& session, const FrameCost& cost, double load);

trimtab_state unknownState();
AircraftState toState(const trimtab_state& state);

}  // namespace trimtab::c
