#include "trimtab/scene/gpu_timer.h"

#include <limits>

#include "trimtab/scene/gl_api.h"

namespace trimtab::scene {

GpuTimer::GpuTimer() : milliseconds_(std::numeric_limits<double>::quiet_NaN()) {
  for (Frame& frame : frames_) {
    glGenQueries(1, &frame.begin);
    glGenQueries(1, &frame.end);
  }
}

GpuTimer::~GpuTimer() {
  for (Frame& frame : frames_) {
    glDeleteQueries(1, &frame.begin);
    glDeleteQueries(1, &frame.end);
  }
}

void GpuTimer::begin() {
  collect();
  open_ = !frames_[next_].pending;  // the GPU is that far behind: this frame goes without
  if (open_) glQueryCounter(frames_[next_].begin, GL_TIMESTAMP);
}

void GpuTimer::end() {
  if (!open_) return;
  glQueryCounter(frames_[next_].end, GL_TIMESTAMP);
  frames_[next_].pending = true;
  next_ = (next_ + 1) % frames_.size();
}

void GpuTimer::collect() {
  for (std::size_t i = 0; i < frames_.size(); ++i) {  // oldest first
    Frame& frame = frames_[(next_ + i) % frames_.size()];
    if (!frame.pending) continue;
    GLint available = 0;
    glGetQueryObjectiv(frame.end, GL_QUERY_RESULT_AVAILABLE, &available);
    if (!available) return;
    GLuint64 from = 0, to = 0;
    glGetQueryObjectui64v(frame.begin, GL_QUERY_RESULT, &from);
    glGetQueryObjectui64v(frame.end, GL_QUERY_RESULT, &to);
    milliseconds_ = static_cast<double>(to - from) * 1e-6;
    frame.pending = false;
  }
}

}  // namespace trimtab::scene
