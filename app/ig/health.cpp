#include "health.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>

#include "trimtab/scene/gl_objects.h"

namespace trimtab::ig {
namespace {

/// The resident memory, kB; 0 if the system does not say it.
long memoryKb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  return 0;
}

/// The entries of a folder of /proc/self; reading it has a handle of its own.
long entries(const char* folder) {
  std::error_code error;
  long count = 0;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    ++count;
  return count;
}

void writeNumber(std::ostream& out, double value) {
  out << ',';
  if (std::isfinite(value)) out << value;
}

}  // namespace

Result<Health> Health::open(const std::filesystem::path& file) {
  Health health(file);
  health.stream_ << "second,memory_kb,handles,threads,gl_objects,gl_buffers,gl_textures,gl_framebuffers,"
                    "gl_renderbuffers,gl_vertex_arrays,gl_queries,gl_programs,gl_shaders,images,terrains,"
                    "latency_p50_ms,latency_p99_ms\n"
                 << std::flush;
  if (!health.stream_)
    return Finding{Severity::error, file.string(), {}, "a file that can be written", std::strerror(errno)};
  return health;
}

void Health::look(double now, std::uint64_t images, std::uint64_t terrains, const Session& session) {
  if (now < next_) return;
  if (start_ == 0) start_ = now;
  next_ = now + kPeriodS;
  const scene::GlObjects gl = scene::glObjectsOfContext();
  stream_ << now - start_ << ',' << memoryKb() << ',' << entries("/proc/self/fd") - 1 << ','
          << entries("/proc/self/task") << ',' << gl.total() << ',' << gl.buffers << ',' << gl.textures << ','
          << gl.framebuffers << ',' << gl.renderbuffers << ',' << gl.vertexArrays << ',' << gl.queries << ','
          << gl.programs << ',' << gl.shaders << ',' << images << ',' << terrains;
  writeNumber(stream_, session.latency().shown.median());
  writeNumber(stream_, session.latency().shown.quantile(0.99));
  stream_ << '\n' << std::flush;
}

Result<Done> Health::finish() {
  stream_.close();
  if (stream_) return Done{};
  return Finding{Severity::error, file_.string(), {}, "a file that can be written", "a full disk"};
}

}  // namespace trimtab::ig
