#include "app/harness/store.h"
#include "app/link/recording.h"
#include "injection.h"
#include "tests/core/scene/terrain/synthetic_terrain.h"
#include "trimtab/hold/cost_model_file.h"
#include "trimtab/host/encoder.h"
#include "trimtab/measure/trace_file.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/format/page_file.h"

/// What programs write while they run, beside presets and bakes.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::Injection;

std::vector<CapturedDatagram> datagrams() {
  std::vector<CapturedDatagram> all;
  for (int i = 0; i < 3; ++i) {
    AircraftState state;
    state.time = i;
    state.position = {Degrees{36.6}, Degrees{128.3 + 0.01 * i}, Metres{2000}};
    all.push_back({1.0 + i, "127.0.0.1:1", "127.0.0.1:2", encodeNativeFdm(state)});
  }
  return all;
}

/// A person plays a recording that was cut off and puts it away.
std::string putAway(const fs::path& part, const std::function<bool()>& reads) {
  std::error_code error;
  if (!fs::exists(part, error)) return {};
  const bool good = fs::file_size(part, error) <= 24 || reads();
  fs::remove(part, error);
  return good ? "" : "what was kept cannot be read";
}

TEST_F(Injection, ofARecordingOfAFeed) {
  for (const char* ending : {"pcap", "csv"}) {
    const std::string name = std::string("r.") + ending;
    const auto write = [&](const fs::path& folder) -> Findings {
      auto begun = link::Recording::begin(folder / name);
      if (!begun) return begun.findings();
      link::Recording recording = std::move(begun).value();
      for (const CapturedDatagram& datagram : datagrams())
        if (auto added = recording.add({datagram}); !added) return recording.kept(added.findings());
      const auto done = recording.finish();
      return done ? Findings{} : done.findings();
    };
    writes(("recording as " + std::string(ending)).c_str(),
           {.begin = [&](const fs::path& folder) { test::writeFile(folder / name, "the old one"); },
            .work = write,
            .mayStay =
                [&](const std::string& file) {
                  return file == name + ".part" || file.starts_with("." + name + ".trimtab-");
                },
            .between =
                [&](const fs::path& folder) {
                  const fs::path part = folder / (name + ".part");
                  return putAway(part, [&] { return readPcap(part).ok(); });
                }});
  }
}

TEST_F(Injection, ofATrace) {
  writes("trace", {.begin = [](const fs::path& folder) { test::writeFile(folder / "t.csv", "the old one"); },
                   .work = [](const fs::path& folder) -> Findings {
                     auto trace = TraceFile::open(folder / "t.csv");
                     if (!trace) return trace.findings();
                     const std::vector<TraceRow> row(1);
                     Findings why;
                     for (int i = 0; i < 3; ++i)
                       if (const auto written = trace->write(row); !written) why = written.findings();
                     const auto done = trace->finish();
                     if (!why.empty() && done)
                       return {{Severity::error, "t.csv", "", "no whole trace", "one without its rows"}};
                     return done ? Findings{} : done.findings();
                   },
                   .mayStay = [](const std::string& file) { return file == "t.csv.part"; },
                   .between =
                       [](const fs::path& folder) {
                         const fs::path part = folder / "t.csv.part";
                         return putAway(part, [&] { return readTrace(part).ok(); });
                       }});
}

TEST_F(Injection, ofTheResultsOfABench) {
  harness::Plan plan;
  plan.terrain = std::make_shared<const test::SyntheticTerrain>(
      1, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}},
      [](int column, int) { return column; });
  plan.terrainName = "test";
  plan.presets = {{"default", defaultParameters()}};
  Flight flight;
  flight.states.resize(2);
  plan.flights = {{"flight", flight}};
  harness::Unit unit;
  unit.name = {"flight", "default", "proposed"};
  unit.frames.resize(1);
  unit.frames[0].repeatsMs = {1, 2};
  writes("results of a bench",
         {.begin = [](const fs::path&) {},
          .work = [&](const fs::path& folder) -> Findings {
            const auto store = harness::Store::open(folder / "out", plan, "machine");
            if (!store) return store.findings();
            for (std::size_t row = 0; row < 2; ++row)
              if (!store->frame(0, row))
                if (const auto done = store->writeFrame(0, row, {unit}); !done) return done.findings();
            const auto done = store->write("results.json", "{}");
            return done ? Findings{} : done.findings();
          },
          // A run goes on where it was stopped.
          .mayStay = [](const std::string& file) { return file.find(".trimtab-") != std::string::npos; },
          .inSteps = true});
}

TEST_F(Injection, ofACostModel) {
  const CostModel model;
  writes("cost model", {.begin = [](const fs::path& folder) { test::writeFile(folder / "m.json", "{}"); },
                        .work =
                            [&](const fs::path& folder) {
                              const auto done = writeCostModel(folder / "m.json", "machine", model);
                              return done ? Findings{} : done.findings();
                            },
                        .mayStay = [](const std::string& file) { return file.starts_with(".m.json."); }});
}

TEST_F(Injection, ofPages) {
  for (const bool unnamed : {true, false})
    writes(unnamed ? "pages" : "pages, without unnamed files",
           {.begin = [](const fs::path& folder) { test::writeFile(folder / "p.pages", "the old one"); },
            .work = [](const fs::path& folder) -> Findings {
              auto writer = terrain::PageFileWriter::create(folder / "p.pages");
              if (!writer) return writer.findings();
              for (std::uint64_t key = 0; key < 3; ++key)
                if (auto done = (*writer)->add(key, std::vector<std::byte>(100 * key)); !done)
                  return done.findings();
              const auto done = (*writer)->finish();
              return done ? Findings{} : done.findings();
            },
            .mayStay = [](const std::string& file) { return file.starts_with(".p.pages.trimtab-"); },
            .unnamed = unnamed});
}

}  // namespace
}  // namespace trimtab
