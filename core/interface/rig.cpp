#include <cstdio>
#include <cstdlib>

#include "core/interface/handles.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/rig/fitted_preset.h"
#include "trimtab/rig/limited_preset.h"

using namespace trimtab;

namespace trimtab::c {
namespace {

/// So many more views are worth writing the file again.
constexpr std::size_t kViewsAWrite = 5;

/// Writes what the views so far say.
Findings write(trimtab_fitting& fitting) {
  const Result<IgFit> fit = fitting.flight.result();
  if (!fit) return fit.findings();
  fitting.written = fitting.flight.views();
  return writeAtomically(fitting.file, fitText(*fit)).findings();
}

Result<Done> begin(trimtab_session& session, const char* file, bool byEnvironment) {
  auto may = canReplace(file);
  if (may) may = canMake(file);
  if (!may) return may;
  session.fitting.emplace(*session.profile, file);
  session.fitting->byEnvironment = byEnvironment;
  session.session.keepRows(false);  // what a fit draws is not what was decided
  return may;
}

/// Ends the fit, writes its file, and returns what is wrong with it.
Findings end(trimtab_session& session) {
  Findings all = write(*session.fitting);
  if (const Result<IgFit> fit = session.fitting->flight.result(); fit && !hasError(all))
    all = checkFit(*fit, *session.profile, session.fitting->file).findings();
  session.fitting.reset();
  session.decided();
  session.session.keepRows(session.trace.has_value());
  return all;
}

void print(const Findings& findings) {
  if (!findings.empty()) std::fprintf(stderr, "%s\n", toString(findings).c_str());
}

}  // namespace

void endWithSession(trimtab_session& session) {
  if (!session.fitting) return;
  const bool byEnvironment = session.fitting->byEnvironment;
  const Findings all = end(session);
  if (byEnvironment) print(all);
}

trimtab_status beginByEnvironment(trimtab_session& session) {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  if (*set("TRIMTAB_PROFILE") == '\0') return TRIMTAB_OK;
  const Result<IgProfile> read = loadIgProfile(set("TRIMTAB_PROFILE"));
  print(read.findings());
  if (!read) return TRIMTAB_REFUSED;
  session.profile = *read;
  if (*set("TRIMTAB_FIT") == '\0') return TRIMTAB_OK;
  const Result<Done> begun = begin(session, set("TRIMTAB_FIT"), true);
  print(begun.findings());
  return begun ? TRIMTAB_OK : TRIMTAB_REFUSED;
}

std::optional<FrameRequest> requestOf(trimtab_session& session, double now, int widthPx, int heightPx) {
  if (!session.fitting) return session.session.request(now, widthPx, heightPx);
  trimtab_fitting& fitting = *session.fitting;
  if (!fitting.view || !fitting.flight.staysInView())
    fitting.view = session.session.request(now, widthPx, heightPx);
  if (fitting.view) fitting.flight.setLevers(*fitting.view);
  fitting.requested = fitting.view.has_value();
  return fitting.view;
}

void finishFitted(trimtab_session& session, const FrameCost& cost, double load) {
  trimtab_fitting& fitting = *session.fitting;
  if (!std::exchange(fitting.requested, false)) return;
  fitting.flight.finished(*fitting.view, cost, load);
  // A program that is killed leaves what it has; what cannot be written is said at the end.
  if (fitting.flight.views() >= fitting.written + kViewsAWrite) static_cast<void>(write(fitting));
}

}  // namespace trimtab::c

trimtab_status trimtab_profile_load(const char* file, trimtab_profile** profile,
                                    trimtab_findings** findings) {
  if (file == nullptr || profile == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    Result<IgProfile> read = loadIgProfile(file);
    c::give(findings, read.findings());
    if (!read) return TRIMTAB_REFUSED;
    *profile = new trimtab_profile{std::move(read).value()};
    return TRIMTAB_OK;
  });
}

void trimtab_profile_free(trimtab_profile* profile) {
  delete profile;
}

std::size_t trimtab_profile_lever_count(const trimtab_profile* profile) {
  return profile == nullptr ? 0 : profile->profile.levers.size();
}

trimtab_status trimtab_profile_lever(const trimtab_profile* profile, std::size_t i, trimtab_own_lever* out) {
  if (i >= trimtab_profile_lever_count(profile)) return TRIMTAB_MISUSE;
  const IgLever& l = profile->profile.levers[i];
  const trimtab_own_lever lever{0,         l.names().key.data(), l.ownKey.c_str(), l.ownUnit.c_str(),
                                l.own.low, l.own.high,           l.ownNeutral};
  return c::copyOut(out, lever, c::kOwnLeverSize) ? TRIMTAB_OK : TRIMTAB_MISUSE;
}

trimtab_status trimtab_fit_load(const char* file, trimtab_fit** fit, trimtab_findings** findings) {
  if (file == nullptr || fit == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    Result<IgFit> read = loadIgFit(file);
    c::give(findings, read.findings());
    if (!read) return TRIMTAB_REFUSED;
    *fit = new trimtab_fit{std::move(read).value()};
    return TRIMTAB_OK;
  });
}

void trimtab_fit_free(trimtab_fit* fit) {
  delete fit;
}

trimtab_status trimtab_preset_adapt(const trimtab_preset* preset, const trimtab_profile* profile,
                                    const trimtab_fit* fit, trimtab_preset** adapted,
                                    trimtab_findings** findings) {
  if (preset == nullptr || profile == nullptr || adapted == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    const TuningParameters& from = *preset->parameters;
    const Result<TuningParameters> made = fit == nullptr
                                              ? limitedTo(profile->profile, from, "preset")
                                              : fittedTo(profile->profile, fit->fit, from, "preset");
    Findings all = made.findings();
    Result<ValidatedParameters> valid = Findings{};
    if (made) {
      valid = validate(*made);
      all.insert(all.end(), valid.findings().begin(), valid.findings().end());
    }
    c::give(findings, std::move(all));
    if (!valid) return TRIMTAB_REFUSED;
    *adapted = new trimtab_preset{*valid};
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_set_profile(trimtab_session* session, const trimtab_profile* profile,
                                           const trimtab_fit* fit) {
  if (session == nullptr || profile == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    if (session->fitting) return profile->profile == *session->profile ? TRIMTAB_OK : TRIMTAB_MISUSE;
    if (fit != nullptr && !checkFit(fit->fit, profile->profile, "")) return TRIMTAB_REFUSED;
    session->profile = profile->profile;
    if (fit != nullptr) {
      session->session.hold().setLoadShape(fit->fit.shape);
      session->session.hold().model().restore(fit->fit.cost);
    }
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_own_levers(trimtab_session* session, double* values, std::size_t count) {
  if (session == nullptr || values == nullptr || !session->profile || count > session->profile->levers.size())
    return TRIMTAB_MISUSE;
  if (!session->session.hasState()) return TRIMTAB_NOTHING;
  const LeverChain& chain = session->levers();
  for (std::size_t i = 0; i < count; ++i)
    values[i] = ownValue(*session->profile, session->profile->levers[i], chain);
  return TRIMTAB_OK;
}

trimtab_status trimtab_session_fit_start(trimtab_session* session, const char* file,
                                         trimtab_findings** findings) {
  if (session == nullptr || file == nullptr || !session->profile || session->fitting) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    const Result<Done> begun = c::begin(*session, file, false);
    c::give(findings, begun.findings());
    return begun ? TRIMTAB_OK : TRIMTAB_REFUSED;
  });
}

std::size_t trimtab_session_fit_views(const trimtab_session* session) {
  return session == nullptr || !session->fitting ? 0 : session->fitting->flight.views();
}

std::int32_t trimtab_session_fit_wants_picture(const trimtab_session* session) {
  return session != nullptr && session->fitting && session->fitting->flight.wantsPicture() ? 1 : 0;
}

trimtab_status trimtab_session_fit_picture(trimtab_session* session, const void* rgba, std::int32_t widthPx,
                                           std::int32_t heightPx) {
  if (session == nullptr || rgba == nullptr || widthPx < 1 || heightPx < 1) return TRIMTAB_MISUSE;
  if (!session->fitting) return TRIMTAB_NOTHING;
  return c::guarded([&] {
    const auto bytes =
        std::size_t{4} * static_cast<std::size_t>(widthPx) * static_cast<std::size_t>(heightPx);
    session->fitting->flight.picture({static_cast<const std::uint8_t*>(rgba), bytes}, widthPx, heightPx);
    return TRIMTAB_OK;
  });
}

trimtab_status trimtab_session_fit_finish(trimtab_session* session, trimtab_findings** findings) {
  if (session == nullptr || !session->fitting) return TRIMTAB_MISUSE;
  return c::guarded([&] {
    const Findings all = c::end(*session);
    c::give(findings, all);
    return hasError(all) ? TRIMTAB_REFUSED : TRIMTAB_OK;
  });
}
