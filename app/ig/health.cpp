#include "health.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "trimtab/preset/file_io.h"
#include "trimtab/scene/gl_objects.h"

namespace trimtab::ig {
namespace {

constexpr std::string_view kHeader =
    "second,memory_kb,handles,threads,gl_objects,gl_buffers,gl_textures,gl_framebuffers,gl_renderbuffers,"
    "gl_vertex_arrays,gl_queries,gl_programs,gl_shaders,images,terrains,latency_p50_ms,latency_p99_ms\n";

/// Returns the resident memory, kB; 0 if the system does not say it.
long memoryKb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  return 0;
}

/// Counts the entries of a folder of /proc/self; reading it has a handle of its own.
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
  if (auto may = canReplace(file); !may) return may.findings();
  if (auto may = canMake(file); !may) return may.findings();
  return Health(file);
}

void Health::look(double now, std::uint64_t images, std::uint64_t terrains, const Session& session) {
  if (now < next_) return;
  if (start_ == 0) start_ = now;
  next_ = now + kPeriodS;
  const scene::GlObjects gl = scene::glObjectsOfContext();
  std::ostringstream row;
  row << now - start_ << ',' << memoryKb() << ',' << entries("/proc/self/fd") - 1 << ','
      << entries("/proc/self/task") << ',' << gl.total() << ',' << gl.buffers << ',' << gl.textures << ','
      << gl.framebuffers << ',' << gl.renderbuffers << ',' << gl.vertexArrays << ',' << gl.queries << ','
      << gl.programs << ',' << gl.shaders << ',' << images << ',' << terrains;
  writeNumber(row, session.latency().shown.median());
  writeNumber(row, session.latency().shown.quantile(0.99));
  row << '\n';
  write(row.str());
}

void Health::write(const std::string& row) {
  if (hasError(findings_)) return;
  const auto keep = [this](const auto& result) {
    findings_.insert(findings_.end(), result.findings().begin(), result.findings().end());
    return result.ok();
  };
  if (file_) {
    keep(file_->append(row));
    return;
  }
  auto made = Unfinished::file(path_);
  if (!keep(made) || !keep(made->append(kHeader)) || !keep(made->append(row)) || !keep(made->putInPlace()))
    return;
  file_.emplace(std::move(made).value());
}

Result<Done> Health::finish() {
  if (hasError(findings_)) return findings_;
  return {Done{}, findings_};
}

}  // namespace trimtab::ig
