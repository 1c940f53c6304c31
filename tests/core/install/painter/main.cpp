// Draws one image of a database with the installed library: painter DATABASE EXPORT PNG
#include <cstdio>
#include <cstdlib>

#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/preset.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/format/database.h"

namespace {

[[noreturn]] void refuse(const trimtab::Findings& findings) {
  std::fputs(trimtab::toString(findings).c_str(), stderr);
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace trimtab;
  if (argc != 4) return 2;
  const auto database = terrain::Database::open(argv[1]);
  if (!database) refuse(database.findings());
  const auto preset = loadPreset(argv[2]);
  if (!preset) refuse(preset.findings());
  const auto parameters = validate(preset->parameters);
  if (!parameters) refuse(parameters.findings());

  Session session(*parameters);
  const terrain::TerrainInfo& info = (*database)->info();
  AircraftState state;
  state.position = info.southWest;
  state.position.latitude = Degrees{(info.southWest.latitude + info.northEast.latitude).value() / 2};
  state.position.longitude = Degrees{(info.southWest.longitude + info.northEast.longitude).value() / 2};
  state.position.height = info.highest + Metres{300};
  session.look(state);

  const auto context = scene::Offscreen::create(320, 180);
  if (!context) refuse(context.findings());
  scene::Renderer renderer;
  if (const scene::GlReport gl = renderer.initialize(); !gl.usable) {
    std::fprintf(stderr, "this context lacks %s\n", gl.missing.c_str());
    return 1;
  }
  renderer.setTerrain(*database);
  auto request = session.request(0, 320, 180);
  request->waitForPages = request->reproducible = true;
  const FrameResult result = renderer.draw(*request, (*context)->framebuffer());
  const auto pixels = renderer.readPixels(320, 180);
  renderer.release();
  if (const auto written = scene::writePng(argv[3], pixels, 320, 180); !written) refuse(written.findings());
  std::printf("%llu triangles\n", static_cast<unsigned long long>(result.visible.triangles));
}
