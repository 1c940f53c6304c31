#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "support.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/format/database.h"

/// Baked scenes that programs of tests share.
namespace trimtab::test {

/// Waits while another program bakes the same into that folder: a second bake at once would be refused.
inline Result<std::shared_ptr<const terrain::Database>> openOrBakeInTurn(
    const std::filesystem::path& source, const std::filesystem::path& cacheFolder) {
  std::error_code ignored;
  std::filesystem::create_directories(cacheFolder, ignored);
  const auto file = cacheFolder / (source.filename().string() + ".turn");
  const int turn = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (turn < 0)
    return Finding{Severity::error, file.string(), "", "a file that can be written", std::strerror(errno)};
  while (::flock(turn, LOCK_EX) != 0 && errno == EINTR) {
  }
  auto opened = terrain::openOrBake(source, cacheFolder, {});
  ::close(turn);
  return opened;
}

/// Real data (a folder of the shared data's), baked once into a folder beside the temporary files.
inline Result<std::shared_ptr<const terrain::Database>> bakedOnce(const std::string& folder) {
  return openOrBakeInTurn(sharedDir() / "data" / folder,
                          std::filesystem::temp_directory_path() / "trimtab-scene-test");
}

}  // namespace trimtab::test
