#include "gpu_timer.h"

#include <limits>

#include "gl_api.h"

namespace trimtab::scene {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}

GpuTimer::GpuTimer(std::size_t spans) : milliseconds_(spans, kNone) {
  for (Frame& frame : frames_) {
    frame.spans.resize(spans);
    for (Span& span : frame.spans) {
      glGenQueries(1, &span.begin);
      glGenQueries(1, &span.end);
    }
  }
}

GpuTimer::~GpuTimer() {
  for (Frame& frame : frames_)
    for (Span& span : frame.spans) {
      glDeleteQueries(1, &span.begin);
      glDeleteQueries(1, &span.end);
    }
}

void GpuTimer::beginFrame() {
  collect();
  Frame& frame = frames_[next_];
  open_ = !frame.pending;  // the GPU is that far behind: this frame goes without
  if (!open_) return;
  frame.last = 0;
  for (Span& span : frame.spans) span.ended = false;
}

void GpuTimer::begin(std::size_t span) {
  if (open_) glQueryCounter(frames_[next_].spans[span].begin, GL_TIMESTAMP);
}

void GpuTimer::end(std::size_t span) {
  if (!open_) return;
  Frame& frame = frames_[next_];
  glQueryCounter(frame.spans[span].end, GL_TIMESTAMP);
  frame.spans[span].ended = true;
  frame.last = frame.spans[span].end;
}

void GpuTimer::endFrame() {
  if (!open_ || frames_[next_].last == 0) return;
  frames_[next_].pending = true;
  next_ = (next_ + 1) % frames_.size();
  open_ = false;
}

void GpuTimer::collect() {
  for (std::size_t i = 0; i < frames_.size(); ++i) {  // oldest first
    Frame& frame = frames_[(next_ + i) % frames_.size()];
    if (!frame.pending) continue;
    // Stamps arrive in order: with the last one all are there.
    GLint available = 0;
    glGetQueryObjectiv(frame.last, GL_QUERY_RESULT_AVAILABLE, &available);
    if (!available) return;
    for (std::size_t s = 0; s < frame.spans.size(); ++s) {
      milliseconds_[s] = kNone;
      if (!frame.spans[s].ended) continue;
      GLuint64 from = 0, to = 0;
      glGetQueryObjectui64v(frame.spans[s].begin, GL_QUERY_RESULT, &from);
      glGetQueryObjectui64v(frame.spans[s].end, GL_QUERY_RESULT, &to);
      milliseconds_[s] = static_cast<double>(to - from) * 1e-6;
    }
    frame.pending = false;
  }
}

}  // namespace trimtab::scene
