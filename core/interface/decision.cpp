#include "trimtab/decision/decide.h"

#include "core/interface/handles.h"
#include "trimtab/measure/trace.h"
#include "trimtab/motion/head_motion.h"

using namespace trimtab;

std::size_t trimtab_lever_count() {
  return kFrameLeverRows.size();
}

trimtab_status trimtab_lever_get(std::size_t i, trimtab_lever* out) {
  if (i >= kFrameLeverRows.size()) return TRIMTAB_MISUSE;
  const FrameLeverRow& row = kFrameLeverRows[i];
  return c::copyOut(out, {0, row.key.data(), row.label.data(), row.unit.data()}, c::kLeverSize)
             ? TRIMTAB_OK
             : TRIMTAB_MISUSE;
}

std::size_t trimtab_lever_find(const char* key) {
  if (key == nullptr) return kFrameLeverRows.size();
  const auto at = std::find_if(kFrameLeverRows.begin(), kFrameLeverRows.end(),
                               [&](const FrameLeverRow& row) { return row.key == key; });
  return static_cast<std::size_t>(at - kFrameLeverRows.begin());
}

trimtab_status trimtab_session_levers(trimtab_session* session, trimtab_step step, double* values,
                                      std::size_t count) {
  if (session == nullptr || values == nullptr || count > kFrameLeverRows.size() ||
      static_cast<std::size_t>(step) >= kLeverSteps)
    return TRIMTAB_MISUSE;
  if (!session->session.hasState()) return TRIMTAB_NOTHING;
  const FrameLevers& levers = session->levers().after(static_cast<LeverStep>(step));
  for (std::size_t i = 0; i < count; ++i) values[i] = valueOf(levers, kFrameLeverRows[i]);
  return TRIMTAB_OK;
}

trimtab_status trimtab_session_lever(trimtab_session* session, const char* key, double* value,
                                     trimtab_step* step) {
  const std::size_t at = trimtab_lever_find(key);
  if (session == nullptr || value == nullptr || at == kFrameLeverRows.size()) return TRIMTAB_MISUSE;
  if (!session->session.hasState()) return TRIMTAB_NOTHING;
  const LeverChain& chain = session->levers();
  *value = valueOf(chain.drawn, kFrameLeverRows[at]);
  if (step != nullptr) *step = static_cast<trimtab_step>(lastChange(chain, kFrameLeverRows[at]));
  return TRIMTAB_OK;
}

trimtab_status trimtab_session_decision(trimtab_session* session, trimtab_decision* out) {
  if (session == nullptr) return TRIMTAB_MISUSE;
  if (!session->session.hasState()) return TRIMTAB_NOTHING;
  const FrameDecision& d = session->decision();
  const OcclusionResolution occlusion = session->levers().drawn.occlusion.value_or(OcclusionResolution{});
  const trimtab_decision decision{
      0,
      toText(d.scheme).data(),
      toText(d.reason).data(),
      toText(d.motion.reason).data(),
      toText(d.weather.reason).data(),
      toText(d.weather.farReason).data(),
      toText(session->image ? session->image->hold.reason : HoldReason::off).data(),
      toText(d.weather.precipitation).data(),
      d.band,
      d.weather.fogged,
      occlusion.widthPx,
      occlusion.heightPx,
      d.altitudeFt,
      d.totalMembership,
      d.motion.blur.remainingMs,
      d.weather.density,
      d.weather.extinctionPerM,
      d.weather.visibilityM,
      d.weather.layerTopM,
      d.weather.nearFarRatio};
  return c::copyOut(out, decision, c::kDecisionSize) ? TRIMTAB_OK : TRIMTAB_MISUSE;
}

namespace {

/// Writes the line that `work` makes; an empty one if there is no memory for it.
template <class Work>
std::size_t lineOf(char* text, std::size_t capacity, const Work& work) noexcept {
  try {
    return c::give(text, capacity, work());
  } catch (...) {
    return c::give(text, capacity, "");
  }
}

}  // namespace

std::size_t trimtab_session_explain(trimtab_session* session, char* text, std::size_t capacity) {
  return lineOf(text, capacity, [&]() -> std::string {
    if (session == nullptr || !session->session.hasState()) return {};
    return explain(session->decision(), session->session.parameters());
  });
}

std::size_t trimtab_session_explain_lever(trimtab_session* session, const char* key, char* text,
                                          std::size_t capacity) {
  return lineOf(text, capacity, [&]() -> std::string {
    const std::size_t at = trimtab_lever_find(key);
    if (session == nullptr || at == kFrameLeverRows.size() || !session->session.hasState()) return {};
    return explain(session->levers(), kFrameLeverRows[at]);
  });
}

std::size_t trimtab_session_explain_host(const trimtab_session* session, char* text, std::size_t capacity) {
  return lineOf(text, capacity, [&]() -> std::string {
    if (session == nullptr || session->unused == nullptr) return {};
    const std::optional<Finding>& why = session->decoder.statistics().*session->unused;
    return why ? toString(*why) : std::string("the datagram is not of the host that is followed");
  });
}
