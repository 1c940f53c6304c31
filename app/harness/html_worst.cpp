#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "app/plot/svg.h"
#include "html_sections.h"
#include "html_text.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::harness {
namespace {

/// Widths that pictures are tried at, so that the page can still be sent to somebody.
constexpr int kWidthsPx[]{640, 480, 320};
constexpr std::size_t kRoomBytes = 12'000'000;

/// Means of the pixels that each smaller one covers.
scene::RgbaPicture scaled(const scene::RgbaPicture& picture, int widthPx) {
  if (picture.widthPx <= widthPx) return picture;
  const int heightPx = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(picture.heightPx) * widthPx / picture.widthPx)));
  scene::RgbaPicture out{widthPx, heightPx, {}};
  out.rgba.reserve(static_cast<std::size_t>(widthPx) * static_cast<std::size_t>(heightPx) * 4);
  const auto from = [](int i, int all, int of) {
    return static_cast<int>(static_cast<std::int64_t>(i) * of / all);
  };
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < widthPx; ++x) {
      const int x0 = from(x, widthPx, picture.widthPx), y0 = from(y, heightPx, picture.heightPx);
      const int x1 = std::max(x0 + 1, from(x + 1, widthPx, picture.widthPx));
      const int y1 = std::max(y0 + 1, from(y + 1, heightPx, picture.heightPx));
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u)
            sum += picture.rgba[static_cast<std::size_t>((v * picture.widthPx + u) * 4 + c)];
        const int count = (x1 - x0) * (y1 - y0);
        out.rgba.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
    }
  return out;
}

/// A picture's file that lies in the folder; none for a path that leads out of it.
std::optional<std::filesystem::path> within(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path relative(name);
  if (name.empty() || relative.is_absolute()) return {};
  for (const auto& part : relative)
    if (part == "..") return {};
  return folder / relative;
}

struct Embedded {
  std::string png;  ///< empty: `problem` says why
  std::string problem;
  int widthPx = 0, heightPx = 0;
};

/// Pictures by file name, at the largest width at which they all have room.
class Pictures {
 public:
  Pictures(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    for (const int width : kWidthsPx) {
      pictures_.clear();
      seen_.clear();
      total_ = 0;
      widthPx_ = width;
      for (const std::string& name : names)
        if (!pictures_.contains(name)) add(name, load(folder, name, width));
      if (total_ <= kRoomBytes) return;
    }
  }
  const Embedded& of(const std::string& name) const { return pictures_.at(name); }
  int widthPx() const { return widthPx_; }
  std::size_t bytes() const { return total_; }

 private:
  static Embedded load(const std::filesystem::path& folder, const std::string& name, int widthPx) {
    const auto file = within(folder, name);
    if (!file) return {{}, name.empty() ? "no picture was kept" : "is no file of this folder"};
    const auto picture = scene::readPng(*file);
    if (!picture) return {{}, picture.findings()[0].found};
    const scene::RgbaPicture small = scaled(*picture, widthPx);
    const auto png = scene::encodePng(small.rgba, small.widthPx, small.heightPx);
    if (!png) return {{}, png.findings()[0].found};
    return {*png, {}, small.widthPx, small.heightPx};
  }

  /// Twins are shown once.
  void add(const std::string& name, Embedded picture) {
    if (seen_.insert(std::hash<std::string>{}(picture.png)).second)
      total_ += (picture.png.size() + 2) / 3 * 4;
    pictures_.emplace(name, std::move(picture));
  }

  std::map<std::string, Embedded> pictures_;
  std::set<std::size_t> seen_;
  std::size_t total_ = 0;
  int widthPx_ = 0;
};

/// Units whose pictures of a frame are the same to the byte are shown together.
struct Shown {
  const MeasuredFrame* frame = nullptr;
  const WorstFrame* worst = nullptr;
  std::vector<const Unit*> units;
  std::vector<std::string> why;
};

bool isWorse(const Shown& a, const Shown& b) {
  const auto key = [](const Shown& s) { return std::isnan(s.frame->error.flip) ? -1 : s.frame->error.flip; };
  if (key(a) != key(b)) return key(a) > key(b);
  return a.frame->cost.total > b.frame->cost.total;
}

/// A frame may be the worst in more than one way: "longest frame, largest FLIP".
std::vector<std::string> partsOf(const std::string& why) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= why.size();) {
    const std::size_t end = std::min(why.find(", ", at), why.size());
    parts.push_back(why.substr(at, end - at));
    at = end + 2;
  }
  return parts;
}

std::vector<Shown> shownOf(const ReportModel& model, const Pictures& pictures) {
  std::vector<Shown> all;
  const auto same = [&](const std::string& a, const std::string& b) {
    return pictures.of(a).png == pictures.of(b).png && pictures.of(a).problem == pictures.of(b).problem;
  };
  for (const Unit& unit : model.results.units)
    for (const WorstFrame& worst : unit.worst) {
      if (worst.frame >= unit.frames.size()) continue;
      const MeasuredFrame& frame = unit.frames[worst.frame];
      const auto twin = std::find_if(all.begin(), all.end(), [&](const Shown& s) {
        return s.units[0]->name.flight == unit.name.flight && s.frame->row == frame.row &&
               same(s.worst->reference, worst.reference) && same(s.worst->ours, worst.ours) &&
               same(s.worst->difference, worst.difference);
      });
      Shown& shown = twin != all.end() ? *twin : all.emplace_back(Shown{&frame, &worst, {}, {}});
      if (std::find(shown.units.begin(), shown.units.end(), &unit) == shown.units.end())
        shown.units.push_back(&unit);
      for (const std::string& why : partsOf(worst.why))
        if (std::find(shown.why.begin(), shown.why.end(), why) == shown.why.end()) shown.why.push_back(why);
    }
  std::stable_sort(all.begin(), all.end(), isWorse);
  return all;
}

std::string figure(const Pictures& pictures, const std::string& name, const char* caption) {
  const Embedded& picture = pictures.of(name);
  std::string html = "<figure>";
  if (picture.png.empty())
    html += "<p class=\"absent\">" +
            plot::escaped(name.empty() ? picture.problem : name + ": " + picture.problem) + "</p>";
  else
    html += "<img alt=\"" + std::string(caption) + "\" width=\"" + std::to_string(picture.widthPx) +
            "\" height=\"" + std::to_string(picture.heightPx) + "\" src=\"data:image/png;base64," +
            base64(picture.png) + "\"/>";
  return html + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string numbersOf(const MeasuredFrame& frame) {
  std::string html = "<dl class=\"numbers\">";
  for (const Quantity& q : quantities()) {
    if (q.kind == Quantity::Kind::cost && q.stage != StageKind::total) continue;
    const double value = q.of(frame);
    if (std::isnan(value)) continue;
    const bool bad = q.kind == Quantity::Kind::error && q.whole && value > 0;
    html += "<div><dt>" + plot::escaped(q.label) + "</dt><dd" + (bad ? " class=\"bad\"" : "") + ">" +
            plot::escaped(numberText(value, q)) + ' ' + plot::escaped(q.unit) + "</dd></div>";
  }
  return html + "</dl>\n";
}

std::string entry(const Pictures& pictures, const Shown& shown) {
  std::vector<std::string> names;
  for (const Unit* unit : shown.units) names.push_back(unitText(unit->name));
  std::string html = "<article>\n<h3>" + plot::escaped(joined(shown.why)) + ": " +
                     plot::escaped(shown.units[0]->name.flight) + " at " +
                     plot::escaped(roundedText(shown.frame->timeS)) + " s</h3>\n" +
                     paragraph(joined(names), "units") + "<div class=\"three\">\n" +
                     figure(pictures, shown.worst->reference, "reference") +
                     figure(pictures, shown.worst->ours, "this preset") +
                     figure(pictures, shown.worst->difference, "difference") + "</div>\n";
  if (shown.units.size() > 1)
    html += paragraph("The pictures are the same to the byte; numbers are " + names[0] + "'s.", "none");
  return html + numbersOf(*shown.frame) + "</article>\n";
}

}  // namespace

std::string worstSection(const ReportModel& model, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const Unit& unit : model.results.units)
    for (const WorstFrame& worst : unit.worst)
      names.insert(names.end(), {worst.reference, worst.ours, worst.difference});
  const Pictures pictures(folder, names);
  std::string body;
  for (const Shown& shown : shownOf(model, pictures)) body += entry(pictures, shown);
  if (body.empty())
    body = paragraph("No frame was kept as pictures.", "none");
  else
    body = paragraph("Worst first, by FLIP. Pictures are " + sizeText(pictures.bytes()) +
                     " of this page, at most " + std::to_string(pictures.widthPx()) +
                     " px wide; whole ones lie beside results.json.") +
           body;
  return section("worst", "Worst frames", body);
}

}  // namespace trimtab::harness
