#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "loop.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab::ig {
namespace {

std::string milliseconds(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.3f ms", value);
  return text;
}

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// Returns what was asked for and drawn of each lever, and in how many images each step was the last to
/// change it.
nlohmann::ordered_json leversJson(const LeverTally& tally) {
  nlohmann::ordered_json levers;
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    nlohmann::ordered_json& lever = levers[std::string(kFrameLeverRows[i].key)];
    lever = {{"asked_mean", number(tally.askedMean(i))}, {"drawn_mean", number(tally.drawnMean(i))}};
    for (std::size_t s = 0; s < kLeverSteps; ++s)
      lever["changed_by"][std::string(toText(static_cast<LeverStep>(s)))] =
          tally.changedBy(i, static_cast<LeverStep>(s));
  }
  return levers;
}

/// Says who changed levers, and in how many frames: "; levers: Allowed error by policy in 120 frames".
std::string leversText(const LeverTally& tally) {
  std::string text;
  for (const LeverStep step : {LeverStep::motion, LeverStep::weather, LeverStep::policy, LeverStep::budget})
    for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i)
      if (const std::uint64_t images = tally.changedBy(i, step); images > 0)
        text += (text.empty() ? "; levers: " : ", ") + std::string(kFrameLeverRows[i].label) + " by " +
                std::string(toText(step)) + " in " + std::to_string(images) + " frames";
  return text;
}

std::uint64_t heldAs(const Summary& s, HoldReason reason) {
  return s.held[static_cast<std::size_t>(reason)];
}

/// Says what the arbiter could not do, and how often it acted; empty if it was off.
std::string heldText(const Summary& s) {
  if (heldAs(s, HoldReason::off) == s.frames) return {};
  std::string text = "; budget held: lowered in " + std::to_string(heldAs(s, HoldReason::lowered)) +
                     " frames, out of reach in " + std::to_string(heldAs(s, HoldReason::out_of_reach));
  const auto append = [&](const char* what, HoldReason reason) {
    if (heldAs(s, reason) > 0) text += what + std::to_string(heldAs(s, reason));
  };
  append(", cost not known yet in ", HoldReason::cost_unknown);
  append(", no budget in ", HoldReason::no_budget);
  append(", predictions not trusted in ", HoldReason::not_trusted);
  return text;
}

/// Adds what of a sender's datagrams could not be used, and why.
void addUnusable(nlohmann::ordered_json& json, const HostStatistics& sender) {
  json["bad"] = sender.bad;
  json["not_for_us"] = sender.notForUs;
  if (sender.bad > 0) json["first_bad"] = {{"reason", sender.firstBadReason}, {"hex", sender.firstBadHex}};
  if (sender.newestBad) json["newest_bad"] = toString(*sender.newestBad);
  if (sender.newestNotForUs) json["newest_not_for_us"] = toString(*sender.newestNotForUs);
}

}  // namespace

std::string summaryLine(const Summary& s, const Feed& feed) {
  std::string text = std::to_string(s.frames) + " frames, " + std::to_string(s.packets) + " packets";
  if (const std::optional<HostStatistics> host = feed.statistics()) {
    text += ", lost " + (host->lost ? std::to_string(*host->lost) : std::string("unknown"));
    const auto append = [&text](const char* name, std::uint64_t count) {
      if (count > 0) text += std::string(", ") + name + ' ' + std::to_string(count);
    };
    append("late", host->reordered);
    append("repeated", host->repeated);
    append("implausible", host->implausible);
    const std::optional<link::Senders> senders = feed.senders();
    if (senders) append("of refused senders", senders->refused);
    append("for someone else", host->notForUs);
    text += ", bad " + std::to_string(host->bad) + ", dropped " + std::to_string(feed.dropped());
    for (const HostStatistics& other : senders ? senders->others : std::vector<HostStatistics>{})
      text += "; beside it " + other.from + " with " + std::to_string(other.received) + " datagrams, bad " +
              std::to_string(other.bad);
    text += "; kernel to decoded p99 " + milliseconds(s.decodedP99Ms);
  }
  if (std::isfinite(s.shownP99Ms))
    text += "; packet to finished picture p99 " + milliseconds(s.shownP99Ms) + " (" +
            shortNumber(s.shownP99Ms / s.medianFrameMs) +
            " frames; overtaken packets too: " + milliseconds(s.everyP99Ms) + ")";
  if (s.damagedPlaces > 0) text += "; terrain damaged in " + std::to_string(s.damagedPlaces) + " places";
  return text + "; frame median " + milliseconds(s.medianFrameMs) + ", p99 " + milliseconds(s.p99FrameMs) +
         ", " + std::to_string(s.overBudget) + " over budget" + heldText(s) + leversText(s.levers);
}

std::string summaryJson(const Summary& s, const Feed& feed, const Options& options,
                        const scene::GlReport& gl) {
  nlohmann::ordered_json json;
  json["frames"] = s.frames;
  json["packets"] = s.packets;
  json["decision_changes"] = s.decisionChanges;
  json["jumps"] = s.jumps;
  json["depth_maps_drawn"] = s.depthMapsDrawn;
  json["horizons_built"] = s.horizonsBuilt;
  json["over_budget"] = s.overBudget;
  for (std::size_t i = 0; i < kHoldReasons; ++i) json["hold"][toText(static_cast<HoldReason>(i))] = s.held[i];
  json["levers"] = leversJson(s.levers);
  json["preset_reloads"] = s.presetReloads;
  json["terrain_reloads"] = s.terrainReloads;
  json["terrains_refused"] = s.terrainsRefused;
  json["damaged_places"] = s.damagedPlaces;
  json["presets_refused"] = s.presetsRefused;
  json["first_frame_unix_s"] =
      s.firstFrameTime > 0 ? nlohmann::ordered_json(s.firstFrameTime) : nlohmann::ordered_json();
  json["frame_median_ms"] = number(s.medianFrameMs);
  json["frame_p99_ms"] = number(s.p99FrameMs);
  for (std::size_t i = 0; i < kCostStages.size(); ++i) {
    const Distribution& stage = s.stages[i];
    json["stages_ms"][kCostStages[i].name] = {{"median", number(stage.median)},
                                              {"p95", number(stage.p95)},
                                              {"p99", number(stage.p99)},
                                              {"frames", stage.samples}};
  }
  json["decoded_p50_ms"] = number(s.decodedP50Ms);
  json["decoded_p99_ms"] = number(s.decodedP99Ms);
  json["picture_p50_ms"] = number(s.shownP50Ms);
  json["picture_p99_ms"] = number(s.shownP99Ms);
  json["picture_p99_frames"] = number(s.shownP99Ms / s.medianFrameMs);
  json["picture_every_p99_ms"] = number(s.everyP99Ms);
  if (const std::optional<HostStatistics> host = feed.statistics()) {
    json["host"] = {{"received", host->received},
                    {"states", host->states},
                    {"repeated", host->repeated},
                    {"reordered", host->reordered},
                    {"dropped", feed.dropped()}};
    json["host"]["from"] = host->from;
    json["host"]["implausible"] = host->implausible;
    if (const auto senders = feed.senders()) {
      json["host"]["sender"] = senders->allowed;
      json["host"]["refused_senders"] = senders->refused;
      if (senders->refused > 0) json["host"]["last_refused_sender"] = senders->lastRefused;
      for (const HostStatistics& other : senders->others) {
        nlohmann::ordered_json beside{
            {"from", other.from}, {"received", other.received}, {"states", other.states}};
        addUnusable(beside, other);
        json["host"]["other_senders"].push_back(std::move(beside));
      }
    }
    json["host"]["symbol_packets"] = host->symbolPackets;
    json["host"]["refused_packets"] = host->refusedPackets;
    if (host->refusedPackets > 0) json["host"]["first_refused_packet"] = host->firstRefusedReason;
    for (const IgnoredPackets& each : host->ignored)
      json["host"]["ignored_packets"][cigiPacketName(each.id)] = each.count;
    json["host"]["uncounted"] = host->uncounted;
    json["host"]["above_ground_doubted"] = s.groundDoubted;
    json["host"]["asked"] = feed.questions().asked;
    json["host"]["answered"] = feed.questions().answered;
    json["host"]["lost"] = host->lost ? nlohmann::ordered_json(*host->lost) : nlohmann::ordered_json();
    addUnusable(json["host"], *host);
  }
  json["preset"] = options.preset;
  json["terrain"] = options.terrain.string();
  json["gl"] = {{"vendor", gl.vendor},
                {"renderer", gl.renderer},
                {"version", gl.version},
                {"software", gl.software},
                {"drawing", gl.drawing}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace trimtab::ig
