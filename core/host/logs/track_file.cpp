#include "track_file.h"

#include <algorithm>
#include <array>

#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr const char* kHeader = "time,latitude_deg,longitude_deg,altitude_m\n";

struct Track {
  std::string table = kHeader;
  std::size_t points = 0, incomplete = 0;

  void add(std::string_view time, std::optional<double> latitude, std::optional<double> longitude,
           std::optional<double> altitude) {
    if (time.empty() || !latitude || !longitude || !altitude) {
      ++incomplete;
      return;
    }
    ++points;
    table.append(time) += ',';
    table += numberText(*latitude) + ',' + numberText(*longitude) + ',' + numberText(*altitude) + '\n';
  }
};

std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  if (from == std::string_view::npos) return std::nullopt;
  text.remove_prefix(from + begin.size());
  const std::size_t to = text.find(end);
  if (to == std::string_view::npos) return std::nullopt;
  return trimmed(text.substr(0, to));
}

std::optional<double> numberIn(const std::optional<std::string_view>& text) {
  return text ? readNumber(*text) : std::nullopt;
}

/// Returns an attribute of a tag, in quotes of either kind.
std::optional<std::string_view> attribute(std::string_view tag, const std::string& name) {
  const auto value = between(tag, ' ' + name + "=\"", "\"");
  return value ? value : between(tag, ' ' + name + "='", "'");
}

Track trackOfGpx(std::string_view text) {
  constexpr std::string_view kPoint = "<trkpt";
  Track track;
  for (std::size_t at = text.find(kPoint); at != std::string_view::npos;) {
    const std::size_t next = text.find(kPoint, at + kPoint.size());
    const std::string_view point = text.substr(at, next - at), tag = point.substr(0, point.find('>'));
    std::string time(between(point, "<time>", "</time>").value_or(""));
    // Points have whole lines of the table.
    if (time.find_first_of(",\n\r\"") != std::string::npos) time.clear();
    track.add(time, numberIn(attribute(tag, "lat")), numberIn(attribute(tag, "lon")),
              numberIn(between(point, "<ele>", "</ele>")));
    at = next;
  }
  return track;
}

/// Reads digits of an IGC record, of which `whole` are degrees and the rest thousandths of minutes.
std::optional<double> angleIn(std::string_view digits, std::size_t whole, bool negative) {
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  const auto degrees = readNumber(digits.substr(0, whole)), minutes = readNumber(digits.substr(whole));
  if (!degrees || !minutes) return std::nullopt;
  const double angle = *degrees + *minutes / 60000;
  return negative ? -angle : angle;
}

/// B, hhmmss, ddmmmmmN, dddmmmmmE, A or V, five digits of pressure altitude and five of GNSS altitude.
Track trackOfIgc(std::string_view text) {
  Track track;
  while (!text.empty()) {
    const std::string_view line = takeLine(text);
    if (!line.starts_with('B') || line.size() < 35) continue;
    const std::string_view clock = line.substr(1, 6);
    std::string time(clock.substr(0, 2));
    time.append(":").append(clock.substr(2, 2)).append(":").append(clock.substr(4, 2));
    if (clock.find_first_not_of("0123456789") != std::string_view::npos) time.clear();
    const auto altitude = [&line](std::size_t at) { return readNumber(line.substr(at, 5)); };
    const bool fixed = line[24] == 'A';
    track.add(time, angleIn(line.substr(7, 7), 2, line[14] == 'S'),
              angleIn(line.substr(15, 8), 3, line[23] == 'W'), fixed ? altitude(30) : altitude(25));
  }
  return track;
}

bool isIgc(std::string_view text) {
  const std::string_view begin = text.substr(0, 65536);
  return text.starts_with('A') && text.find_first_of("\r\n") < 80 && text.find_first_of(", ;\t") > 4 &&
         (begin.find("\nHFDTE") != std::string_view::npos ||
          begin.find("\nHFDATE") != std::string_view::npos);
}

}  // namespace

std::optional<Result<std::string>> tableOfTrack(std::string_view text, const std::string& where) {
  text = withoutByteOrderMark(text);
  const bool gpx = trimmed(text.substr(0, 4096)).starts_with('<') &&
                   text.substr(0, 4096).find("<gpx") != std::string_view::npos;
  if (!gpx && !isIgc(text)) return std::nullopt;
  Track track = gpx ? trackOfGpx(text) : trackOfIgc(text);
  const char* kind = gpx ? "points of a GPX track" : "fixes of an IGC log";
  if (track.points == 0)
    return Finding{Severity::error, where, "", std::string(kind) + " with time, place and height",
                   std::to_string(track.incomplete) + ", all of which lack one of them"};
  Findings findings{{Severity::note, where, "", "",
                     std::string(kind) + ": " + std::to_string(track.points) +
                         (gpx ? "" : "; heights are GNSS heights where the receiver had them")}};
  if (track.incomplete > 0)
    findings.push_back({Severity::warning, where, "", std::string(kind) + " with time, place and height",
                        std::to_string(track.incomplete) + " that lack one of them: they are left out"});
  return Result<std::string>(std::move(track.table), std::move(findings));
}

}  // namespace trimtab
