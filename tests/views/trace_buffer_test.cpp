// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/model/trace_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "trimtab/measure/cost_stages.h"

namespace trimtab::views {
namespace {

LiveFrame frameAt(double time, double ms, std::uint64_t packet = 0) {
  LiveFrame frame;
  frame.time = time;
  frame.input.state.packet = packet;
  frame.cost.total = ms;
  return frame;
}

TEST(TraceBuffer, columnsHoldTheExtremesOfTheirFrames) {
  TraceBuffer buffer(64 * 100);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> ms(0, 100);
  std::vector<float> all;
  for (int i = 0; i < 64 * 170 + 11; ++i) {
    all.push_back(i % 9 == 0 ? std::nanf("") : ms(random));
    buffer.append(frameAt(i * 0.01, all.back()));
  }
  std::vector<TraceBuffer::Column> columns;
  for (const std::size_t wanted : {1u, 3u, 40u, 700u, 100'000u}) {
    const std::uint64_t from = buffer.begin() + 5, to = buffer.end() - 3;
    buffer.columns(Trace::frame_ms, from, to, wanted, columns);
    ASSERT_FALSE(columns.empty());
    EXPECT_LE(columns.size(), 2 * wanted + 2) << wanted;
    float low = 1e9f, high = -1e9f;
    for (std::uint64_t f = from; f < to; ++f)
      if (!std::isnan(all[f])) {
        low = std::min(low, all[f]);
        high = std::max(high, all[f]);
      }
    float lowest = 1e9f, highest = -1e9f;
    for (const TraceBuffer::Column& c : columns)
      if (!std::isnan(c.low)) {
        lowest = std::min(lowest, c.low);
        highest = std::max(highest, c.high);
      }
    EXPECT_EQ(lowest, low) << wanted;
    EXPECT_EQ(highest, high) << wanted;
    // Frame by frame where there is a column for each.
    if (wanted > to - from) {
      ASSERT_EQ(columns.size(), to - from);
      for (std::uint64_t f = from; f < to; ++f) {
        const float drawn = columns[f - from].low;
        EXPECT_TRUE(drawn == all[f] || (std::isnan(drawn) && std::isnan(all[f]))) << f;
      }
    }
  }
}

TEST(TraceBuffer, keepsTheNewestFramesInTheirOrder) {
  TraceBuffer buffer(64 * 4);
  for (int i = 0; i < 1000; ++i) buffer.append(frameAt(i, i, static_cast<std::uint64_t>(i)));
  EXPECT_EQ(buffer.end(), 1000u);
  EXPECT_GE(buffer.begin(), 1000u - 64 * 4);
  EXPECT_LE(buffer.begin(), 1000u - 64 * 3);
  for (std::uint64_t f = buffer.begin(); f < buffer.end(); ++f) {
    EXPECT_EQ(buffer.time(f), static_cast<double>(f));
    EXPECT_EQ(buffer.value(Trace::frame_ms, f), static_cast<float>(f));
  }
}

TEST(TraceBuffer, findsFramesByTime) {
  TraceBuffer buffer;
  EXPECT_EQ(buffer.atOrAfter(3), 0u);
  for (int i = 0; i < 10; ++i) buffer.append(frameAt(i, 1));
  EXPECT_EQ(buffer.atOrAfter(-5), 0u);
  EXPECT_EQ(buffer.atOrAfter(3), 3u);
  EXPECT_EQ(buffer.atOrAfter(3.1), 4u);
  EXPECT_EQ(buffer.atOrAfter(9.5), 10u);
  EXPECT_EQ(buffer.nearest(3.4), 3u);
  EXPECT_EQ(buffer.nearest(3.6), 4u);
  EXPECT_EQ(buffer.nearest(99), 9u);
  EXPECT_EQ(buffer.nearest(-99), 0u);
}

TEST(TraceBuffer, aClockThatGoesBackGoesOnFromTheLastFrame) {
  TraceBuffer buffer;
  for (const double t : {10.0, 11.0, 0.0, 1.0, 2.0}) buffer.append(frameAt(t, 1));
  const double expected[] = {10, 11, 11, 12, 13};
  for (std::uint64_t f = 0; f < 5; ++f) EXPECT_EQ(buffer.time(f), expected[f]);
}

TEST(TraceBuffer, csvHoldsExactlyTheFramesOfTheRange) {
  TraceBuffer buffer;
  for (int i = 0; i < 100; ++i) {
    LiveFrame frame =
        frameAt(i * 0.1, i % 2 == 0 ? 0.1 + i : std::nan(""), static_cast<std::uint64_t>(1000 + i));
    frame.decision.totalMembership = 0.6;
    FrameResult result;
    result.visible.triangles = 123456;
    result.visible.vertices = 65432;
    frame.result = std::make_shared<const FrameResult>(result);
    frame.cost.symbology = 0.25;
    frame.decision.motion.rateDegPerS = 75.5;
    frame.levers.emplace().drawn.lodScale = 2;
    buffer.append(frame);
  }
  std::istringstream lines(buffer.csv(2.05, 3.0));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(
      line,
      "time_s,packet,altitude_membership,pitch_membership,total_membership,triangles,frame_ms,fps,cull_"
      "ms,draw_ms,"
      "gpu_ms,depth_map_width_px,line_of_sight_degps,lod_scale,select_ms,page_ms,occlusion_ms,blur_ms,"
      "weather_ms,symbology_ms,vertices,altitude_ft,pitch_deg,dynamic_scheme,band,tiles_drawn,tiles_outside,"
      "tiles_hidden,tiles_built,pages_read,page_read_mb,pages_waiting,above_ground_ft,roll_deg,speed_kt,"
      "climb_ftpmin,sight_rate_degps,visibility_m,load,allowed_error_px,render_scale,particle_density,"
      "blur_strength,far_km,predicted_ms,as_asked_ms,flip");
  int frame = 21;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string text; std::getline(cells, text, ',');) cell.push_back(text);
    ASSERT_GE(cell.size(), 21u);
    EXPECT_EQ(cell[20], "65432");
    EXPECT_EQ(cell[15], "") << "no page was made";
    EXPECT_EQ(cell[19], "0.25");
    EXPECT_EQ(cell[12], "75.5");
    EXPECT_EQ(cell[13], "2");
    EXPECT_EQ(std::stod(cell[0]), frame * 0.1);
    EXPECT_EQ(cell[1], std::to_string(1000 + frame));
    EXPECT_EQ(cell[4], "0.6");
    EXPECT_EQ(cell[5], "123456");
    EXPECT_EQ(cell[6].empty(), frame % 2 == 1) << "not measured is an empty cell";
    ++frame;
  }
  EXPECT_EQ(frame, 31) << "30 * 0.1 is 3.0, and the range is closed";
}

TEST(TraceBuffer, aFrameIsFoundByTimeOnlyWhereOneIsNear) {
  TraceBuffer buffer;
  EXPECT_EQ(buffer.at(0, 9), std::nullopt);
  for (int i = 0; i < 10; ++i) buffer.append(frameAt(10 + i * 0.1, 1));
  EXPECT_EQ(buffer.at(10.31, buffer.end()), 3u);
  EXPECT_EQ(buffer.at(11.3, buffer.end()), 9u);
  EXPECT_EQ(buffer.at(11.5, buffer.end()), std::nullopt);
  EXPECT_EQ(buffer.at(9, buffer.end()), std::nullopt);
  EXPECT_EQ(buffer.at(10.9, 5), 4u) << "frames from the given end on do not count";
  EXPECT_EQ(buffer.at(11.3, 5), std::nullopt);
}

TEST(TraceBuffer, statisticsAreThoseOfTheSortedFrames) {
  TraceBuffer buffer;
  for (int i = 0; i < 100; ++i)
    buffer.append(frameAt(i, i % 10 == 9 ? std::nan("") : (i * 37) % 100));  // 90 numbers
  std::vector<float> sorted;
  for (int i = 0; i < 100; ++i)
    if (i % 10 != 9) sorted.push_back(static_cast<float>((i * 37) % 100));
  std::sort(sorted.begin(), sorted.end());
  const TraceBuffer::Statistics all = buffer.statistics(Trace::frame_ms, 0, buffer.end());
  EXPECT_EQ(all.least, sorted.front());
  EXPECT_EQ(all.median, sorted[44]);
  EXPECT_EQ(all.p95, sorted[85]);
  EXPECT_EQ(all.largest, sorted.back());
  EXPECT_TRUE(std::isnan(buffer.statistics(Trace::gpu_ms, 9, 9).median));
}

TEST(TraceBuffer, anotherLengthKeepsTheNewestFramesAndTheirExtremes) {
  TraceBuffer buffer(64 * 10);
  for (int i = 0; i < 64 * 25 + 7; ++i) buffer.append(frameAt(i, i));
  for (const std::size_t frames : {64u * 20u, 64u * 4u}) {
    buffer.setCapacity(frames);
    EXPECT_EQ(buffer.end(), 64u * 25 + 7);
    for (std::uint64_t f = buffer.begin(); f < buffer.end(); ++f) ASSERT_EQ(buffer.time(f), double(f));
    std::vector<TraceBuffer::Column> columns;
    buffer.columns(Trace::frame_ms, buffer.begin(), buffer.end(), 1, columns);
    EXPECT_EQ(columns.front().low, static_cast<float>(buffer.begin()));
  }
  EXPECT_GE(buffer.begin(), 64u * 21) << "no more than the new length";
  EXPECT_LE(buffer.begin(), 64u * 22);
  buffer.append(frameAt(1e6, 5));
  EXPECT_EQ(buffer.value(Trace::frame_ms, buffer.end() - 1), 5);
}

TEST(TraceBuffer, countsWhatWasPagedAndUploadedSinceTheFrameBefore) {
  TraceBuffer buffer;
  const auto add = [&](std::uint64_t pages, std::uint64_t bytes, std::uint64_t built) {
    LiveFrame frame = frameAt(double(buffer.end()), 1);
    FrameResult result;
    result.paging.pagesRead = pages;
    result.paging.bytesRead = bytes;
    result.counters.tilesBuilt = built;
    frame.result = std::make_shared<const FrameResult>(result);
    buffer.append(frame);
  };
  add(3, 1'000'000, 10);
  add(5, 3'500'000, 10);
  add(1, 500'000, 2);  // another terrain: the counts start over
  EXPECT_EQ(buffer.value(Trace::pages_read, 1), 2);
  EXPECT_EQ(buffer.value(Trace::page_read_mb, 1), 2.5f);
  EXPECT_EQ(buffer.value(Trace::tiles_built, 1), 0);
  EXPECT_EQ(buffer.value(Trace::pages_read, 2), 1);
  EXPECT_EQ(buffer.value(Trace::tiles_built, 2), 2);
}

TEST(TraceBuffer, recordsTheLeversAsDrawnWhatTheArbiterPredictedAndWhatWasMeasured) {
  TraceBuffer buffer(128);
  buffer.append(frameAt(0, 10));
  LiveFrame frame = frameAt(1, 10);
  FrameLevers& levers = frame.levers.emplace().drawn;
  levers.errorPx = 2.5;
  levers.renderScale = 0.75;
  levers.particleShare = 0.8;
  levers.blurStrength = 0.3;
  levers.farM = 12'500;
  frame.decision.weather.density = 0.5;
  frame.hold.limitMs = 15;
  frame.hold.heldMs = {9, 3, 1, 0.5};
  frame.hold.askedMs = {20, 4, 1, 0.5};
  frame.flip = 0.0625;
  buffer.append(frame);
  levers.farM = std::numeric_limits<double>::infinity();
  frame.hold.limitMs = 0;
  frame.time = 2;
  buffer.append(frame);
  const Trace traces[]{Trace::allowed_error_px, Trace::render_scale, Trace::particle_density,
                       Trace::blur_strength,    Trace::far_km,       Trace::predicted_ms,
                       Trace::as_asked_ms,      Trace::flip};
  const float expected[]{2.5f, 0.75f, 0.4f, 0.3f, 12.5f, 13.5f, 25.5f, 0.0625f};
  for (std::size_t i = 0; i < std::size(traces); ++i) {
    EXPECT_TRUE(std::isnan(buffer.value(traces[i], 0))) << traceName(traces[i]) << " before the first image";
    EXPECT_EQ(buffer.value(traces[i], 1), expected[i]) << traceName(traces[i]);
  }
  EXPECT_TRUE(std::isnan(buffer.value(Trace::far_km, 2))) << "no cut";
  EXPECT_TRUE(std::isnan(buffer.value(Trace::predicted_ms, 2))) << "no budget";
}

TEST(TraceBuffer, aBankToTheLeftIsARollBelowZero) {
  TraceBuffer buffer;
  LiveFrame frame = frameAt(0, 10);
  frame.input.signalValues[Signal::roll] = 30;  // rules ask how far it banks, not where to
  for (const double roll : {-30.0, 330.0}) {
    frame.input.state.attitude.roll = Degrees{roll};
    buffer.append(frame);
    EXPECT_FLOAT_EQ(buffer.value(Trace::roll_deg, buffer.end() - 1), -30) << roll;
  }
}

TEST(TraceBuffer, stacksTheStagesUpToTheWholeFrame) {
  TraceBuffer buffer;
  LiveFrame frame;
  for (const CostStage& stage : kCostStages) frame.cost.*stage.ms = FrameCost::kNotMeasured;
  const CostField kUp[] = {&FrameCost::select, &FrameCost::page, &FrameCost::occlusion, &FrameCost::cull,
                           &FrameCost::draw};
  for (int without = -1; without < 5; ++without) {
    frame.time += 0.01;
    double sum = frame.cost.decide = 0.5;
    for (int i = 0; i < 5; ++i) {
      frame.cost.*kUp[i] = i == without ? FrameCost::kNotMeasured : 1 << i;
      if (i != without) sum += 1 << i;
    }
    frame.cost.total = sum;
    frame.cost.gpu = 100;  // beside them
    frame.cost.blur = 7;   // a part of draw
    buffer.append(frame);
    double edge = 0.5;
    for (std::size_t i = 0; i < kStack.size(); ++i) {
      const bool run = static_cast<int>(i) != without;
      if (run) edge += 1 << i;
      EXPECT_EQ(buffer.value(kStack[i].top, buffer.end() - 1), static_cast<float>(edge))
          << i << ' ' << without;
      const float stage = buffer.value(kStack[i].stage, buffer.end() - 1);
      EXPECT_EQ(std::isnan(stage), !run) << traceName(kStack[i].stage);
      if (run) {
        EXPECT_EQ(stage, static_cast<float>(1 << i));
      }
    }
  }
}

}  // namespace
}  // namespace trimtab::views
