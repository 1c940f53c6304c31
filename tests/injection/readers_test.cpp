#include <sstream>

#include "injection.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/hold/cost_model_file.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace_file.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/store.h"

/// These tests read what a program reads at its start and while it flies.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::Injection;

TEST_F(Injection, ofReadingAPreset) {
  reads("reading a preset", {[](const fs::path& folder) {
                               Preset preset;
                               preset.parameters.lod.scale = Ratio{2};
                               const auto text = presetText(preset);
                               test::writeFile(folder / "p.json", *text);
                             },
                             [](const fs::path& folder) -> Result<std::string> {
                               const auto preset = loadPreset((folder / "p.json").string());
                               if (!preset) return preset.findings();
                               const auto text = presetText(*preset);
                               if (!text) return text.findings();
                               return *text;
                             }});
}

TEST_F(Injection, ofReadingARecordingAndATrace) {
  reads("reading a recording",
        {[](const fs::path& folder) {
           const CapturedDatagram one{1, "127.0.0.1:1", "127.0.0.1:2", std::vector<std::byte>(100)};
           EXPECT_TRUE(writePcap(folder / "r.pcap", {&one, 1}));
         },
         [](const fs::path& folder) -> Result<std::string> {
           const auto read = readPcap(folder / "r.pcap");
           if (!read) return read.findings();
           return std::to_string(read->size()) + toString(read.findings());
         }});
  reads("reading a trace", {[](const fs::path& folder) {
                              auto trace = TraceFile::open(folder / "t.csv");
                              EXPECT_TRUE(trace->write(std::vector<TraceRow>(3)) && trace->finish());
                            },
                            [](const fs::path& folder) -> Result<std::string> {
                              const auto rows = readTrace(folder / "t.csv");
                              if (!rows) return rows.findings();
                              std::string text;
                              for (const TraceRow& row : *rows) appendTraceRow(text, row);
                              return text;
                            }});
}

TEST_F(Injection, ofReadingACostModel) {
  reads("reading a cost model", {[](const fs::path& folder) {
                                   EXPECT_TRUE(writeCostModel(folder / "m.json", "machine", CostModel()));
                                 },
                                 [](const fs::path& folder) -> Result<std::string> {
                                   const auto state = readCostModel(folder / "m.json", "machine");
                                   if (!state) return state.findings();
                                   return "band " + std::to_string(state->processor.band);
                                 }});
}

TEST_F(Injection, ofReadingPages) {
  reads("reading pages", {[](const fs::path& folder) {
                            auto writer = terrain::PageFileWriter::create(folder / "p.pages");
                            for (std::uint64_t key = 0; key < 3; ++key)
                              EXPECT_TRUE((*writer)->add(key, std::vector<std::byte>(100 * key + 7)));
                            EXPECT_TRUE((*writer)->finish());
                          },
                          [](const fs::path& folder) -> Result<std::string> {
                            const auto file = terrain::PageFile::open(folder / "p.pages");
                            if (!file) return file.findings();
                            std::string text;
                            for (std::uint64_t key = 0; key < 3; ++key) {
                              const auto blob = (*file)->read(key);
                              if (!blob) return blob.findings();
                              text += std::to_string(blob->size()) + ' ';
                            }
                            return text;
                          }});
}

/// What an image could show of the whole database, as text.
Result<std::string> everythingIn(const fs::path& folder) {
  const auto opened = terrain::Database::open(folder);
  if (!opened) return opened.findings();
  const terrain::Database& database = **opened;
  std::ostringstream text;
  text << database.info().checksum << ' ';
  terrain::TileMesh mesh;
  for (std::uint32_t node = 0; node < database.index().size(); ++node) {
    database.buildTile(node, mesh);
    text << terrain::checksum({reinterpret_cast<const char*>(mesh.vertices.data()),
                               mesh.vertices.size() * sizeof mesh.vertices[0]})
         << ' ';
  }
  if (Findings damage = database.damage(); !damage.empty()) return damage;
  if (Findings damage = database.checkAll(); !damage.empty()) return damage;
  return text.str();
}

TEST_F(Injection, ofReadingADatabase) {
  reads("reading a database", {[](const fs::path& folder) {
                                 test::ScratchDir source;
                                 test::RasterRecipe recipe;
                                 recipe.columns = 40;
                                 recipe.rows = 34;
                                 recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
                                 terrain::BakeOptions options;
                                 options.sources = {test::writeRaster(source / "ground.tif", recipe)};
                                 options.output = folder / "db";
                                 EXPECT_TRUE(terrain::bake(options));
                               },
                               [](const fs::path& folder) { return everythingIn(folder / "db"); }, 3});
}

}  // namespace
}  // namespace trimtab
