#include <cmath>

#include "app/plot/svg.h"
#include "html_sections.h"
#include "html_style.h"
#include "html_text.h"
#include "report.h"
#include "run.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/preset/preset.h"

namespace trimtab::harness {
namespace {

using plot::escaped;

struct Link {
  const char *id, *title;
};
constexpr Link kSections[]{{"pareto", "Frame time against error"},
                           {"summary", "Summary"},
                           {"stages", "Stages"},
                           {"flight", "Along the flight"},
                           {"skips", "Skips"},
                           {"ratios", "Paired comparisons"},
                           {"worst", "Worst frames"}};

std::string orNone(const std::vector<std::string>& words) {
  return words.empty() ? "none" : joined(words);
}

/// What no picture may lose, told before anything else.
std::string defects(const ReportModel& model) {
  std::string html;
  for (const Quantity& q : quantities()) {
    if (q.kind != Quantity::Kind::error || !q.whole || !model.measured(q)) continue;
    double sum = 0;
    std::size_t frames = 0, bad = 0;
    std::vector<std::string> units;
    for (const Unit& unit : model.results.units) {
      const std::size_t before = bad;
      for (const MeasuredFrame& frame : unit.frames) {
        ++frames;
        if (const double value = q.of(frame); value > 0) sum += value, ++bad;
      }
      if (bad > before) units.push_back(unitText(unit.name));
    }
    const std::string of = counted(frames, "frame");
    html += bad == 0 ? paragraph("No " + std::string(q.label) + " in " + of + ".", "fine")
                     : paragraph("\xe2\x9a\xa0 " + std::string(q.label) + ": " + wholeText(sum) + " in " +
                                     std::to_string(bad) + " of " + of + " (" + joined(units) +
                                     "). Culling must never change a pixel.",
                                 "alarm");
  }
  return html;
}

}  // namespace

std::string headSection(const ReportModel& model) {
  const Results& r = model.results;
  std::vector<std::string> cases;
  for (const std::string& method : model.cases) cases.push_back(caseText(method));
  std::string html = "<header>\n<h1>Run time against error: " +
                     escaped(r.terrain.empty() ? std::string("no terrain") : r.terrain) +
                     "</h1>\n<dl class=\"facts\">";
  const auto fact = [&](const char* name, const std::string& text) {
    html += std::string("<dt>") + name + "</dt><dd>" + escaped(text) + "</dd>\n";
  };
  fact("flights", orNone(model.flights));
  fact("presets", orNone(model.presets));
  fact("cases", orNone(cases));
  std::size_t frames = 0;
  for (const Unit& unit : r.units) frames += unit.frames.size();
  fact("pictures", std::to_string(r.widthPx) + " x " + std::to_string(r.heightPx) + " px, " +
                       counted(frames, "frame") + " of " + counted(r.units.size(), "unit") +
                       " (a flight, a preset, a case), each drawn " + counted(r.repeats, "time") +
                       " for its cost");
  if (std::isfinite(r.budgetMs)) fact("budget", roundedText(r.budgetMs) + " ms a frame");
  fact("machine", r.machine);
  fact("Trimtab", r.version);
  html += "</dl>\n";
  if (!r.notes.empty()) {
    html += "<ul>";
    for (const std::string& note : r.notes) html += "<li>" + escaped(note) + "</li>\n";
    html += "</ul>\n";
  }
  html += defects(model) + "<nav>";
  for (const Link& link : kSections)
    html += std::string("<a href=\"#") + link.id + "\">" + link.title + "</a>\n";
  return html + "</nav>\n</header>\n";
}

Result<std::string> htmlReport(const Results& results, const std::filesystem::path& folder) {
  const ReportModel model(results);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
      // Nothing is fetched from anywhere, whoever opens it.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\"/>\n<title>" +
      escaped("Run time against error: " + results.terrain) + "</title>\n<style>" + kStyle +
      "</style>\n</head>\n<body>\n";
  page += headSection(model);
  page += "<main>\n";
  for (const auto& part :
       {paretoSection, summarySection, stagesSection, flightSection, skipsSection, comparisonSection})
    page += part(model);
  page += worstSection(model, folder) + "</main>\n";
  page += "<footer>" + sizeText(page.size()) +
          " in one file; every number of every frame is in frames.csv and results.json "
          "beside it.</footer>\n<script>" +
          std::string(kScript) + "</script>\n</body>\n</html>\n";
  return page;
}

Result<Done> writeReport(const Results& results, const std::filesystem::path& folder) {
  const Result<std::string> page = htmlReport(results, folder);
  if (!page) return page.findings();
  if (const auto written = writeAtomically(folder / "report.html", *page); !written) return written;
  return writeAtomically(folder / "pareto.svg", paretoPlot(results));
}

}  // namespace trimtab::harness
