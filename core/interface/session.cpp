#include "trimtab/session/session.h"

#include "core/interface/handles.h"
#include "trimtab/decision/decide.h"

using namespace trimtab;

trimtab_session::trimtab_session(const ValidatedParameters& parameters)
    : session(parameters), decoder(HostChoice(parameters->host)) {
  // No form of a terrain is known: the budget goes by the triangles that the caller reports.
  session.setLoadIndex(std::make_shared<const LoadIndex>());
}

const LeverChain& trimtab_session::levers() {
  if (image) return image->levers;
  if (!chain) chain = leversOf(session.decision(), *session.parameters());
  return *chain;
}

/// Moves what is complete to the trace. A trace that cannot be written says so when it is finished.
void trimtab_session::writeRows(bool all) {
  if (!trace) return;
  rows.clear();
  session.takeRows(rows, all);
  static_cast<void>(trace->write(rows).ok());
}

trimtab_status trimtab_session_create(const trimtab_preset* preset, trimtab_session** session) {
  if (preset == nullptr || session == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    auto made = std::make_unique<trimtab_session>(preset->parameters);
    const trimtab_status begun = c::beginByEnvironment(*made);
    if (begun == TRIMTAB_OK) *session = made.release();
    return begun;
  });
}

void trimtab_session_free(trimtab_session* session) {
  if (session != nullptr) {
    trimtab_session_trace_finish(session, nullptr);
    c::guarded([&] { return c::endWithSession(*session), TRIMTAB_OK; });
  }
  delete session;
}

trimtab_status trimtab_session_set_preset(trimtab_session* session, const trimtab_preset* preset) {
  if (session == nullptr || preset == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->session.setParameters(preset->parameters);
    session->decided();
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_restart(trimtab_session* session) {
  if (session == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->session.restart();
    session->decoder.reset();
    session->unused = nullptr;
    session->decided();
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_fly(trimtab_session* session, const trimtab_state* state) {
  trimtab_state given = c::unknownState();
  if (session == nullptr || !c::copyIn(given, state, c::kStateSize)) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->session.fly(c::toState(given));
    session->decided();
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_receive(trimtab_session* session, const trimtab_state* state, double arrivalS,
                                       double nowS) {
  trimtab_state given = c::unknownState();
  if (session == nullptr || !c::copyIn(given, state, c::kStateSize)) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    const ReceivedState received{c::toState(given), arrivalS, nowS};
    session->session.receive({&received, 1});
    session->decided();
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_datagram(trimtab_session* session, const void* bytes, std::size_t length,
                                        const char* from, double arrivalS, double nowS) {
  if (session == nullptr || bytes == nullptr || from == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->datagram.bytes = {static_cast<const std::byte*>(bytes), length};
    session->datagram.arrival = arrivalS;
    session->datagram.from = from;
    const std::uint64_t bad = session->decoder.statistics().bad,
                        notForUs = session->decoder.statistics().notForUs;
    const std::optional<AircraftState> state = session->decoder.accept(session->datagram);
    session->datagram.bytes = {};  // they are the caller's
    session->unused = nullptr;
    if (!state) {
      const HostStatistics& after = session->decoder.statistics();
      session->unused = after.bad > bad             ? &HostStatistics::newestBad
                        : after.notForUs > notForUs ? &HostStatistics::newestNotForUs
                                                    : &HostStatistics::newestUnused;
      return TRIMTAB_NOTHING;
    }
    const ReceivedState received{*state, arrivalS, nowS, session->decoder.symbols()};
    session->session.receive({&received, 1});
    session->decided();
    return TRIMTAB_OK;
  });
}

const char* trimtab_session_link(const trimtab_session* session, double nowS) {
  return session == nullptr ? "" : toText(session->session.linkState(nowS)).data();
}

std::int32_t trimtab_session_needs_image(const trimtab_session* session, double nowS) {
  return session != nullptr && (session->fitting || session->session.needsImage(nowS)) ? 1 : 0;
}

trimtab_status trimtab_session_request(trimtab_session* session, double nowS, std::int32_t windowWidthPx,
                                       std::int32_t windowHeightPx, trimtab_image* image) {
  if (session == nullptr || windowWidthPx < 1 || windowHeightPx < 1) return TRIMTAB_MISUSE;
  if (image != nullptr && image->size < c::kImageSize) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->image = c::requestOf(*session, nowS, windowWidthPx, windowHeightPx);
    if (!session->image) return TRIMTAB_NOTHING;
    const FrameRequest& r = *session->image;
    if (image != nullptr)
      c::copyOut(
          image,
          {0, r.time, r.eye.latitude.value(), r.eye.longitude.value(), r.eye.height.value(),
           r.attitude.heading.value(), r.attitude.pitch.value(), r.attitude.roll.value(), r.view.widthPx,
           r.view.heightPx, r.view.left, r.view.right, r.view.bottom, r.view.top, r.view.nearM},
          c::kImageSize);
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_frame_clear(trimtab_frame* frame) {
  constexpr double kUnknown = FrameCost::kNotMeasured;
  return c::copyOut(frame, {0, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, 0, 0, 0},
                    c::kFrameSize)
             ? TRIMTAB_OK
             : TRIMTAB_MISUSE;
}

trimtab_status trimtab_session_finished(trimtab_session* session, const trimtab_frame* frame, double nowS) {
  trimtab_frame given{};
  if (session == nullptr || !c::copyIn(given, frame, c::kFrameSize)) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    FrameResult result;
    result.cost.total = given.total_ms;
    result.cost.select = given.select_ms;
    result.cost.occlusion = given.occlusion_ms;
    result.cost.cull = given.cull_ms;
    result.cost.draw = given.draw_ms;
    result.cost.gpu = given.gpu_ms;
    result.visible.triangles = given.triangles;
    constexpr double kMostLoad = 1e15;  // what is longer or negative is no time, and would not convert
    if (session->profile)
      result.visible.triangles = static_cast<std::uint64_t>(
          std::clamp(loadOf(*session->profile, static_cast<double>(given.triangles),
                            static_cast<double>(given.nodes), workMs(result.cost)),
                     0.0, kMostLoad));
    result.visible.vertices = given.vertices;
    result.tilesInCut = given.nodes;
    if (session->fitting) {
      c::finishFitted(*session, result.cost, static_cast<double>(result.visible.triangles));
      return TRIMTAB_OK;
    }
    session->session.finished(result, nowS);
    session->writeRows(false);
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_no_image(trimtab_session* session) {
  if (session == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->session.noPicture();
    session->writeRows(false);
    session->decided();
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_trace_start(trimtab_session* session, const char* file,
                                           trimtab_findings** findings) {
  if (session == nullptr || file == nullptr || session->trace) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    Result<TraceFile> opened = TraceFile::open(file);
    c::give(findings, opened.findings());
    if (!opened) return TRIMTAB_REFUSED;
    session->trace.emplace(std::move(opened).value());
    session->session.keepRows(!session->fitting);
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_trace_finish(trimtab_session* session, trimtab_findings** findings) {
  if (session == nullptr || !session->trace) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    session->writeRows(true);
    session->session.keepRows(false);
    const Result<Done> finished = session->trace->finish();
    session->trace.reset();
    c::give(findings, finished.findings());
    return finished ? TRIMTAB_OK : TRIMTAB_REFUSED;
  });
}
