#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/terrain/grid/no_source.h"
#include "trimtab/units/result.h"

/// Which source file the height of each post came from.
namespace trimtab::terrain {

inline constexpr const char* kSourcesName = "sources.runs";

/// The names of the sources, and for each row of posts the runs of columns that one source gave. Where
/// several sources are blended, the one with the largest share counts.
class PostSources {
 public:
  explicit PostSources(std::vector<std::string> names) : names_(std::move(names)) {}

  /// Appends a row, from the south: the number of the source of each post, or kNoSource.
  void addRow(std::span<const std::uint16_t> sources);
  const std::vector<std::string>& names() const { return names_; }
  std::size_t rows() const { return starts_.size() - 1; }
  /// Returns the number of the source of a post; kNoSource also beyond the rows.
  std::uint16_t at(std::uint32_t row, std::uint32_t column) const;

  /// Returns the bytes of the file (resources/docs/terrain-format.md).
  std::string encoded() const;
  /// Reads such bytes; returns none if they are not that.
  static std::optional<PostSources> decoded(std::string_view bytes);

 private:
  struct Run {
    std::uint32_t column;  ///< the first of it
    std::uint32_t source;
  };
  std::vector<std::string> names_;
  std::vector<std::uint64_t> starts_{0};  ///< of each row's runs, and the end of all
  std::vector<Run> runs_;
};

/// Reads the file of a database, about 8 bytes per run, and compares its checksum with the manifest's. The
/// result is empty if the database has none: it is of one kind of scenery, or of an earlier version.
Result<std::optional<PostSources>> readPostSources(const std::filesystem::path& database);

}  // namespace trimtab::terrain
