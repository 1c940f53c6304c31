#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "bench_scene.h"
#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/passes/scale_up_pass.h"
#include "row.h"
#include "tests/core/hold/two_clock_flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"

/// Group `hold`: what holding a budget costs, and what building ahead of the images and scaling up win.

namespace trimtab::bench {
namespace {

constexpr double kImageS = 1.0 / 60, kAheadMs = 4;

/// A budget which every image fits, so that the arbiter only looks.
constexpr double kAmpleMs = 1000;

ValidatedParameters holding(double budgetMs, WeatherStep step = WeatherStep::clear) {
  TuningParameters p = *defaultParameters();
  p.weather.source = WeatherSource::preset;
  p.weather.step = step;
  p.hold.enabled = true;
  p.measure.budget = Milliseconds{budgetMs};
  return *validate(p);
}

/// An aircraft 2,000 ft above the ground in the middle of the terrain, at 120 m/s to the north.
class Flight {
 public:
  Flight(const std::shared_ptr<const terrain::Database>& terrain, BenchScene& bench,
         const ValidatedParameters& parameters = holding(kAmpleMs))
      : bench_(bench), session_(parameters) {
    session_.setGround(terrain);
    session_.setLoadIndex(scene::loadIndexOf(terrain));
    const FrameRequest start = bench.request();
    state_.position = start.eye;
    state_.attitude = start.attitude;
  }
  FrameRequest next() {
    state_.position.latitude = state_.position.latitude + Degrees{120 * kImageS / 111e3};
    return again();
  }
  /// Asks for an image of an eye that rests.
  FrameRequest again() {
    state_.time += kImageS;
    session_.fly(state_, state_.time);
    return *session_.request(state_.time, BenchScene::kWidth, BenchScene::kHeight);
  }
  FrameResult draw(const FrameRequest& request) {
    const FrameResult result = bench_.draw(request);
    session_.finished(result, state_.time);
    return result;
  }
  Session& session() { return session_; }

 private:
  BenchScene& bench_;
  Session session_;
  AircraftState state_;
};

/// The first image after the allowed error has doubled, over terrain of which nothing is on the GPU yet but
/// what the images before it drew.
double firstAtTwiceTheError(const std::shared_ptr<const terrain::Database>& terrain, BenchScene& bench,
                            bool ahead) {
  bench.use(terrain);
  Flight flight(terrain, bench);
  for (int i = 0; i < 30; ++i) {
    const FrameRequest request = flight.next();
    flight.draw(request);
    if (ahead) bench.renderer().buildAhead(flight.session().nodesAhead(request), kAheadMs);
  }
  FrameRequest coarser = flight.next();
  coarser.levers.drawn.errorPx *= 2;
  coarser.levers.drawn.treeErrorPx *= 2;
  return flight.draw(coarser).cost.total;
}

void exchange(Report& report, const std::shared_ptr<const terrain::Database>& terrain, BenchScene& bench) {
  const Pairs pairs = inTurn(
      report.quick() ? 3 : 9, [&](int) { return firstAtTwiceTheError(terrain, bench, true); },
      [&](int) { return firstAtTwiceTheError(terrain, bench, false); });
  report.add(ratioAtMost(
      0.9, rowOf(pairs, {.id = "hold.exchange",
                         .what = "first image at twice the allowed error, 1280 x 720, after 30 images with "
                                 "4 ms each of building ahead",
                         .peer = "the same without building ahead"})));
}

void look(Report& report, const std::shared_ptr<const terrain::Database>& terrain, BenchScene& bench) {
  constexpr int kImages = 30;
  const int runs = report.quick() ? 50 : 400;
  Flight flight(terrain, bench);
  std::vector<double> images;
  FrameResult drawn;
  for (int i = 0; i < kImages; ++i) images.push_back((drawn = flight.draw(flight.next())).cost.total);
  const double image = experiment::quantileOf(images, 0.5);
  // The requests of images that follow one another, without drawing them.
  const double request = leastSeconds(runs, [&] {
    keep(flight.next());
    flight.session().finished(drawn, 0);
  });
  FrameRequest last = flight.next();
  const double names = leastSeconds(runs, [&] { keep(flight.session().nodesAhead(last).size()); });
  // At rest and in rain there are most settings to choose from, and where none fits each is predicted.
  Flight rests(terrain, bench, holding(0.1, WeatherStep::rain_heavy));
  for (int i = 0; i < kImages; ++i) drawn = rests.draw(rests.again());
  const double search = leastSeconds(runs, [&] {
    keep(rests.again());
    rests.session().finished(drawn, 0);
  });
  const auto add = [&](const char* id, const char* what, double seconds) {
    report.add(ratioAtMost(0.02, {.id = id,
                                  .what = what,
                                  .value = 1e3 * seconds,
                                  .unit = "ms",
                                  .peer = "the median image, 1280 x 720",
                                  .peerValue = image,
                                  .peerFrom = "run"}));
  };
  add("hold.look", "a decision, a request, and the load of six views counted for every allowed error",
      request);
  add("hold.search", "the same for an eye at rest in heavy rain, with a budget that no setting fits", search);
  add("hold.ahead", "the nodes of coming images named", names);
}

/// Simulated flights: the same figures on every machine.
void twoClocks(Report& report) {
  test::TwoClockFlight flight;
  for (const test::TwoClockCase& c : test::twoClockCases()) {
    const test::TwoClockRun off = flight.fly(c, false), held = flight.fly(c, true);
    const auto add = [&](double goal, const char* which, double ms, const char* peer, double peerMs) {
      report.add(ratioAtMost(goal, {.id = "hold.two_clocks_" + c.id + which,
                                    .what = "99th percentile of held images on a simulated machine " + c.name,
                                    .value = ms,
                                    .unit = "ms",
                                    .peer = peer,
                                    .peerValue = peerMs,
                                    .peerFrom = "run"}));
    };
    if (!held.reachable.empty() && held.notTrusted == 0)
      add(1.1, "_reached", test::p99Of(held.reachable), "the budget, which some setting fits", c.budgetMs);
    if (!held.unreachable.empty())
      add(1.05, "_unreached", test::p99Of(held.unreachable), "the same not held, where no setting fits",
          test::p99Of(off.unreachable));
  }
}

void scaleUp(Report& report) {
  scene::FrameBuffer image;
  image.resize(BenchScene::kWidth, BenchScene::kHeight);
  scene::ScaleUpPass own(true), blit(false);
  for (const int percent : {50, 90}) {
    scene::FrameBuffer small;
    small.resize(BenchScene::kWidth * percent / 100, BenchScene::kHeight * percent / 100);
    const auto ms = [&](scene::ScaleUpPass& pass) {
      glFinish();
      const auto start = std::chrono::steady_clock::now();
      pass.draw(small, image);
      glFinish();
      return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    const Pairs pairs = inTurn(
        report.quick() ? 9 : 101, [&](int) { return ms(own); }, [&](int) { return ms(blit); });
    const std::string size = std::to_string(small.width()) + " x " + std::to_string(small.height());
    report.add(ratioAtMost(0.5, rowOf(pairs, {.id = "hold.scale_up_" + std::to_string(percent),
                                              .what = "an image of " + size + " scaled up to 1280 x 720",
                                              .peer = "the same by a linear blit of GL"})));
  }
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  const auto terrain = bench::sampleTerrain(40);
  if (!terrain) return 1;
  bench::BenchScene scene(terrain);
  if (report.wants("exchange") && scene.ready()) bench::exchange(report, terrain, scene);
  if (report.wants("look") && scene.ready()) bench::look(report, terrain, scene);
  if (report.wants("two_clocks")) bench::twoClocks(report);
  if (report.wants("scale_up") && scene.ready() && scene.softwareRasteriser()) bench::scaleUp(report);
  return report.finish();
}
